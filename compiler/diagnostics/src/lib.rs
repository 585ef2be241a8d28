//! Source text, spans, diagnostics and the registry of their codes.
//!
//! Every stage of the compiler returns its best value plus a list of [`Diagnostic`]s; nothing here prints.
//! Invariants: spans are byte offsets into one source, `start <= end`, on character boundaries; a code stands
//! in the registry ([`codes`]) once and has a page in `docs/diagnostics/`.
//! Not here: rendering for people and machines, which lives in the command line.

pub mod codes;
mod diagnostic;
mod source;
mod suggest;

pub use codes::{Code, Severity};
pub use diagnostic::{Applicability, Diagnostic, Label, Suggestion};
pub use source::{LineColumn, SourceFile, SourceId, SourceMap, Span, Spanned};
pub use suggest::closest;
