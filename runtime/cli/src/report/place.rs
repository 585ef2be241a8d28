//! Where a span is, in the terms of the machine formats.

use arsc_diagnostics::{SourceMap, Span};

/// A span with lines and columns: one-based, columns in characters, the end exclusive.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Place {
    pub file: String,
    /// Byte offsets.
    pub start: u32,
    pub end: u32,
    pub line: usize,
    pub column: usize,
    pub end_line: usize,
    pub end_column: usize,
}

impl Place {
    pub fn of(sources: &SourceMap, span: Span) -> Place {
        let file = sources.get(span.source);
        let (from, to) = (file.line_column(span.start), file.line_column(span.end));
        Place {
            file: file.name.clone(),
            start: span.start,
            end: span.end,
            line: from.line,
            column: from.column,
            end_line: to.line,
            end_column: to.column,
        }
    }
}
