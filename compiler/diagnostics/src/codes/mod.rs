//! The registry of diagnostic codes: one table per stage, each code once.
//!
//! Numbers: `E00xx` syntax, `E01xx` names and types, `E02xx` values and limits, `E03xx` action sequences, `E04xx` the
//! scene as a whole, `E05xx` modules, `E09xx` not implemented yet; `W00xx` lints on lint levels, `W01xx` lints of the
//! text, `W02xx` lints of the geometry and light.
//! A lint's name is what `allow(…)`, `--deny` and `--warn` take.

use std::fmt;

#[macro_use]
mod table;
pub mod driver;
pub mod geometry;
pub mod sema;
pub mod syntax;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Not reported.
    Allow,
    Warning,
    Error,
}

/// What stands in the registry about one code.
#[derive(Debug)]
pub struct CodeEntry {
    /// `E0101`, `W0203`: shown as `arsl::E0101`, and the name of its page in `docs/diagnostics/`.
    pub id: &'static str,
    /// The lint's name for `allow(…)`, or the error's short name.
    pub name: &'static str,
    pub summary: &'static str,
    pub severity: Severity,
}

/// A registered code.
#[derive(Clone, Copy)]
pub struct Code(pub &'static CodeEntry);

impl Code {
    pub fn id(self) -> &'static str {
        self.0.id
    }

    pub fn name(self) -> &'static str {
        self.0.name
    }

    pub fn summary(self) -> &'static str {
        self.0.summary
    }

    pub fn severity(self) -> Severity {
        self.0.severity
    }

    /// What `docs/diagnostics/` says about it: what it means, why it matters, a bad and a good example.
    pub fn page(self) -> Option<&'static str> {
        PAGES.iter().find(|(id, _)| *id == self.id()).map(|(_, page)| *page)
    }

    pub fn is_lint(self) -> bool {
        self.0.severity != Severity::Error
    }
}

impl PartialEq for Code {
    fn eq(&self, other: &Code) -> bool {
        self.0.id == other.0.id
    }
}

impl Eq for Code {}

impl fmt::Debug for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.id)
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "arsl::{}", self.0.id)
    }
}

/// The pages of `docs/diagnostics/`: id, and Markdown; ascending by id.
const PAGES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/pages.rs"));

/// Every registered code, in the order of the tables.
pub fn all() -> impl Iterator<Item = Code> {
    syntax::ALL.iter().chain(driver::ALL).chain(sema::ALL).chain(geometry::ALL).copied()
}

/// The code with this id (`E0101`) or lint name (`unused_name`).
pub fn find(id_or_name: &str) -> Option<Code> {
    all().find(|code| code.id() == id_or_name || code.name() == id_or_name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_and_names_are_unique_and_match_their_severity() {
        let codes: Vec<Code> = all().collect();
        for (i, a) in codes.iter().enumerate() {
            assert_eq!(a.is_lint(), a.id().starts_with('W'), "{a}");
            for b in &codes[i + 1..] {
                assert!(a.id() != b.id() && a.name() != b.name(), "{a} and {b} clash");
            }
        }
    }
}
