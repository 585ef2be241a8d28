//! Findings for people and machines.
//!
//! `human` draws them with miette, `json` and `sarif` write documents. Locations are one-based lines and columns in
//! characters, and byte offsets where a format has them.

mod excerpt;
mod human;
mod json;
mod place;
mod sarif;

use std::io::{self, Write};

use arsc_diagnostics::{Diagnostic, Severity, SourceMap};
use arsc_driver::Compiled;

pub use human::Style;

/// How findings are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// For reading: excerpts of the script with labels
    #[default]
    Human,
    /// One JSON document
    Json,
    /// SARIF 2.1.0, for code hosts and editors
    Sarif,
}

/// What was found in one script and what it imports.
#[derive(Clone, Copy)]
pub struct Findings<'a> {
    pub diagnostics: &'a [Diagnostic],
    pub sources: &'a SourceMap,
}

impl<'a> From<&'a Compiled> for Findings<'a> {
    fn from(compiled: &'a Compiled) -> Findings<'a> {
        Findings { diagnostics: &compiled.diagnostics, sources: &compiled.sources }
    }
}

/// Shows findings to whoever looks at standard error.
pub fn human(findings: Findings) {
    let stderr = io::stderr();
    let style = Style::of(&stderr);
    // Nobody is left to be told that standard error cannot be written.
    let _ = human::write(&mut stderr.lock(), &style, &[findings]);
}

/// How many findings of each kind there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    pub errors: usize,
    pub warnings: usize,
}

impl Totals {
    pub fn of(all: &[Findings<'_>]) -> Totals {
        let mut totals = Totals::default();
        for diagnostic in all.iter().flat_map(|findings| findings.diagnostics) {
            match diagnostic.severity {
                Severity::Error => totals.errors += 1,
                Severity::Warning => totals.warnings += 1,
                Severity::Allow => {}
            }
        }
        totals
    }

    pub fn is_clean(self) -> bool {
        self == Totals::default()
    }
}

impl std::fmt::Display for Totals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let plural = |n: usize| if n == 1 { "" } else { "s" };
        match (self.errors, self.warnings) {
            (0, 0) => f.write_str("no findings"),
            (e, 0) => write!(f, "{e} error{}", plural(e)),
            (0, w) => write!(f, "{w} warning{}", plural(w)),
            (e, w) => write!(f, "{e} error{}, {w} warning{}", plural(e), plural(w)),
        }
    }
}

/// Writes all findings in a format.
pub fn write(out: &mut dyn Write, format: Format, style: &Style, all: &[Findings<'_>]) -> io::Result<()> {
    match format {
        Format::Human => human::write(out, style, all),
        Format::Json => json::write(out, all),
        Format::Sarif => sarif::write(out, all),
    }
}
