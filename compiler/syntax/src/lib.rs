//! Text of `.arsl` to a syntax tree.
//!
//! [`parse`] never fails: what it cannot read becomes an error node and a diagnostic, and reading goes on with
//! the next statement. This is the only crate that names a pest type; the grammar is `grammar/arsl.pest`.
//!
//! Stages: `scan` (comments, brackets, quotes, limits), the grammar (with error productions and an error rule per
//! statement), `build` (pairs to tree, precedence, literals), `diagnose` (why a statement did not match). Each takes
//! time and memory linear in the text. Nothing recurses deeper than [`MAX_NESTING`] levels of brackets and
//! recursive keywords; the tree itself, with its chains of operators, is at most [`MAX_DEPTH`] deep.

pub mod ast;
mod build;
mod diagnose;
mod grammar;
mod scan;
pub mod visit;

use arsc_diagnostics::{Diagnostic, SourceId};

/// How deep brackets, blocks and expressions without brackets (`fn(x) => fn(y) => …`) may be nested.
pub const MAX_NESTING: usize = 256;

/// How deep the syntax tree may be: a chain `a + b + c` of `n` operators is `n` deep, as are chains of `|>`, `else
/// if`, calls and prefixes. Who recurses over the tree needs a stack for this many frames.
pub const MAX_DEPTH: usize = 2_000;

/// How many findings a text can have; what is beyond is read and not reported.
pub const MAX_FINDINGS: usize = 10_000;

/// A syntax tree and what was wrong with the text.
#[derive(Clone, Debug)]
pub struct Parsed {
    pub module: ast::Module,
    /// In the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads a source text. Never fails and never panics, whatever the text.
pub fn parse(source: SourceId, text: &str) -> Parsed {
    build::module(source, text)
}

/// Reads a text that is one expression, such as the value of `--set name=value`. [`ast::ExprKind::Error`] stands for
/// what could not be read.
pub fn parse_expr(source: SourceId, text: &str) -> (ast::Expr, Vec<Diagnostic>) {
    build::expression(source, text)
}
