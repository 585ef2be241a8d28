//! Lints on values: they see what a script computed, not how it was written.

use arsc_diagnostics::Diagnostic;
use arsc_diagnostics::codes::sema as codes;
use arsc_ir::Spectrum;
use arsc_spectral::WavelengthRange;

use super::{Eval, Machine};
use crate::code::Site;
use crate::value::Value;

/// Tables have rounding; a hair above one is not worth a word.
const ABOVE_ONE: f64 = 1.0 + 1e-6;

/// What is rendered unless `path_trace` says otherwise.
const RENDERED: WavelengthRange = WavelengthRange::VISIBLE;

/// Extremes over the rendered range, every 5 nm.
fn extremes(spectrum: &Spectrum) -> (f64, f64) {
    match spectrum {
        Spectrum::Constant(value) => return (*value, *value),
        // Within 0 and 1 by its formula.
        Spectrum::Sigmoid { .. } => return (0.0, 1.0),
        _ => {}
    }
    let mut extremes = (f64::INFINITY, f64::NEG_INFINITY);
    let mut lambda_nm = RENDERED.min_nm();
    while lambda_nm <= RENDERED.max_nm() {
        let value = spectrum.eval(lambda_nm);
        extremes = (extremes.0.min(value), extremes.1.max(value));
        lambda_nm += 5.0;
    }
    extremes
}

impl Machine<'_> {
    pub fn lint_reflectance(&mut self, value: &Value, site: &Site, arg: usize) {
        let (_, highest) = extremes(value.as_spectrum());
        if highest > ABOVE_ONE {
            let shown = (highest * 1e3).round() / 1e3;
            self.lint(
                Diagnostic::new(codes::REFLECTANCE_ABOVE_ONE, "the reflectance exceeds 1: the surface creates light")
                    .label(site.args[arg], format!("reaches {shown}"))
                    .help("keep reflectances within 0 and 1"),
            );
        }
    }

    /// A light that emits nothing that is rendered.
    pub fn lint_emission(&mut self, value: &Value, site: &Site, arg: usize) {
        let (_, highest) = extremes(value.as_spectrum());
        if highest <= 0.0 {
            self.lint(
                Diagnostic::new(codes::ZERO_POWER_LIGHT, "the light emits nothing")
                    .label(site.args[arg], "zero from 360nm to 830nm"),
            );
        }
    }

    pub fn lint_sun(&mut self, value: &Value, site: &Site, arg: usize) {
        if value.as_vec3().z < 0.0 {
            self.lint(
                Diagnostic::new(
                    codes::ZERO_POWER_LIGHT,
                    "the sun is below the horizon, where the sky model gives no light",
                )
                .label(site.args[arg], "this direction points down")
                .help("`sun` is the direction towards the sun"),
            );
        }
    }

    pub fn lint_wavelengths(&mut self, lambda_nm: &[f64], site: &Site, arg: usize) {
        let (first, last) = (lambda_nm[0], lambda_nm[lambda_nm.len() - 1]);
        if last < RENDERED.min_nm() || first > RENDERED.max_nm() {
            let diagnostic = Diagnostic::new(codes::INVISIBLE_SPECTRUM, "no sample lies in the rendered range")
                .label(site.args[arg], format!("from {first}nm to {last}nm"));
            let help =
                if last <= 2.5 { "are these micrometres? write nanometres" } else { "360nm to 830nm are rendered" };
            self.lint(diagnostic.help(help));
        }
    }

    /// A spectrum that must be positive wherever it is used.
    pub fn require_positive(&mut self, value: &Value, what: &str, site: &Site, arg: usize) -> Eval<()> {
        let (lowest, _) = extremes(value.as_spectrum());
        if lowest > 0.0 {
            return Ok(());
        }
        let message = format!("{what} must be positive from 360nm to 830nm");
        Err(site.fail_arg(arg, codes::OUT_OF_RANGE, message, "not positive everywhere"))
    }

    /// A spectrum that must not be negative anywhere.
    pub fn require_non_negative(&mut self, value: &Value, what: &str, site: &Site, arg: usize) -> Eval<()> {
        let (lowest, _) = extremes(value.as_spectrum());
        if lowest >= 0.0 {
            return Ok(());
        }
        let message = format!("{what} must not be negative from 360nm to 830nm");
        Err(site.fail_arg(arg, codes::OUT_OF_RANGE, message, "negative somewhere"))
    }

    /// Reports once per place; in std modules at the user's call.
    pub(crate) fn lint(&mut self, mut diagnostic: Diagnostic) {
        if let (Some(caller), Some(label)) = (self.std_caller, diagnostic.labels.first_mut()) {
            label.span = caller;
        }
        let known = |old: &Diagnostic| old.code == diagnostic.code && old.primary_span() == diagnostic.primary_span();
        if !self.diagnostics.iter().any(known) {
            self.diagnostics.push(diagnostic);
        }
    }
}
