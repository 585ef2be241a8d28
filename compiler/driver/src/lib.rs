//! The compiler as a library: sources in, IR and diagnostics out. Free of IO; text arrives through [`Loader`].

mod loader;

pub use loader::{LoadError, Loader};

use arsc_diagnostics::{Diagnostic, Severity, SourceMap};
use arsc_ir::Ir;

/// Ceilings on what a script may use. Exceeding one is a diagnostic.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Evaluation steps.
    pub steps: u64,
    /// Depth of function calls.
    pub recursion: usize,
    /// Nodes of the IR.
    pub nodes: usize,
    /// Depth of imports.
    pub include_depth: usize,
    /// Bytes of one source text.
    pub source_bytes: usize,
    /// Elements of all lists and strings alive at once.
    pub elements: usize,
}

/// What a compilation is asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// `--set name=value`, in order.
    pub params: Vec<(String, String)>,
    pub limits: Limits,
    /// `--allow/--warn/--deny` by code or lint name; later wins.
    pub lint_levels: Vec<(String, Severity)>,
    pub optimise: bool,
}

/// What came out.
pub struct Compiled {
    /// `None` when an error stopped it.
    pub ir: Option<Ir>,
    /// Sorted by source and position; lint levels and `allow` applied.
    pub diagnostics: Vec<Diagnostic>,
    pub sources: SourceMap,
}
