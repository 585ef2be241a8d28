//! The compiler as a library: sources in, IR and diagnostics out. Free of IO; text arrives through [`Loader`].

mod loader;

pub use loader::{LoadError, Loader};

use arsc_diagnostics::{Diagnostic, Severity, SourceMap};
use arsc_ir::Ir;

/// What a compilation is asked for.
#[derive(Clone, Debug)]
pub struct Options {
    pub sema: arsc_sema::Options,
    /// Depth of imports.
    pub include_depth: usize,
    /// Bytes of one source text.
    pub source_bytes: usize,
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
    /// What each optimiser pass did, in order.
    pub passes: Vec<arsc_opt::PassReport>,
}
