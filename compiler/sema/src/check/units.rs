//! Quantities that look as if they were written in another unit.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Applicability, Diagnostic, Span};
use arsc_syntax::ast::Unit;

use super::Checker;

/// Simple fractions of π, as people type them in radians.
const FRACTIONS: &[f64] = &[0.25, 1.0 / 3.0, 0.5, 2.0 / 3.0, 0.75, 1.0, 1.5, 2.0];

/// Nobody turns by this many radians; about eight turns.
const MANY_RADIANS: f64 = 50.0;

/// Outside of these a wavelength in nanometres is not optical at all.
const OPTICAL_NM: std::ops::RangeInclusive<f64> = 10.0..=1e6;

impl Checker<'_> {
    pub(super) fn lint_quantity(&mut self, value: f64, unit: Unit, span: Span) {
        let (what, help, replacement) = match unit {
            Unit::Deg if is_typed_pi_fraction(value) => {
                ("the angle looks like radians", "write `rad`", Some(format!("{value}rad")))
            }
            Unit::Rad if value.abs() >= MANY_RADIANS => {
                ("the angle looks like degrees", "write `deg`", Some(format!("{value}deg")))
            }
            Unit::Nm if value != 0.0 && !OPTICAL_NM.contains(&value.abs()) => {
                ("the wavelength is far from light", "wavelengths of light are 360nm to 830nm", None)
            }
            Unit::Kelvin if value < 0.0 => {
                ("the temperature is below absolute zero", "temperatures are in kelvin", None)
            }
            _ => return,
        };
        if self.is_std(self.cx.module) {
            return;
        }
        let lint = Diagnostic::new(codes::SUSPICIOUS_UNIT, what).label(span, "suspicious unit").help(help);
        self.report(match replacement {
            Some(text) => lint.suggest(span, text, Applicability::MaybeIncorrect),
            None => lint,
        });
    }
}

/// Fractions that are also recognised when written with two digits only: 1.57, 3.14, 6.28.
const COMMON: &[f64] = &[0.5, 1.0, 2.0];

/// A simple fraction of π, rounded or cut off: no plain number of degrees.
fn is_typed_pi_fraction(value: f64) -> bool {
    let value = value.abs();
    let two_digits = |x: f64| (x * 100.0).round() / 100.0;
    if two_digits(value) == value {
        return COMMON.iter().any(|fraction| two_digits(fraction * std::f64::consts::PI) == value);
    }
    FRACTIONS.iter().any(|fraction| (value - fraction * std::f64::consts::PI).abs() < 6e-4)
}
