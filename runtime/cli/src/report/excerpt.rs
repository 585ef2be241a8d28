//! The part of a script that is shown with a finding, as miette wants it.
//!
//! Two hazards are kept from miette: it panics on labels behind column 65 535, and it prints every line of a label
//! whatever its length. So a label is cut to its first lines, and a long line to the part around the label.

use arsc_diagnostics::{Label, SourceFile, Span};
use miette::{LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

/// Lines longer than this (bytes) are cut.
const LONG_LINE: usize = 400;
/// What is left of a long line, on each side of the label's start (bytes).
const KEPT: usize = 40;
/// Labels of more lines than this are cut to their first line.
const TALL_LABEL: usize = 8;

/// The text behind a finding, with its labels in that text's offsets.
pub enum Excerpt<'a> {
    Whole { file: &'a SourceFile, labels: Vec<LabeledSpan> },
    Cut { name: &'a str, text: String, line: usize, column: usize, labels: Vec<LabeledSpan> },
}

impl<'a> Excerpt<'a> {
    /// For labels that all lie in `file`; the first is the primary one.
    pub fn new(file: &'a SourceFile, labels: &[&Label]) -> Excerpt<'a> {
        let is_long = |span: Span| {
            let (first, last) = (file.line_column(span.start).line, file.line_column(span.end).line);
            let lines = [first.saturating_sub(1).max(1), first, first + 1, last, last + 1];
            lines.iter().any(|&line| line <= file.line_count() && file.line_range(line).len() > LONG_LINE)
        };
        if labels.iter().any(|label| is_long(label.span)) {
            return Excerpt::cut(file, labels);
        }
        let labels = labels.iter().enumerate().map(|(i, label)| {
            let span = shortened(file, label.span);
            labelled(i == 0, &label.text, span.start as usize, span.len())
        });
        Excerpt::Whole { file, labels: labels.collect() }
    }

    /// The primary label's line alone, cut around it.
    fn cut(file: &'a SourceFile, labels: &[&Label]) -> Excerpt<'a> {
        let Some(label) = labels.first() else {
            return Excerpt::Cut { name: &file.name, text: String::new(), line: 0, column: 0, labels: Vec::new() };
        };
        let start = label.span.start as usize;
        let place = file.line_column(label.span.start);
        let line = file.line_range(place.line);
        let (mut from, mut to) = (start.saturating_sub(KEPT).max(line.start), (start + KEPT).min(line.end).max(start));
        while !file.text.is_char_boundary(from) {
            from -= 1;
        }
        while !file.text.is_char_boundary(to) {
            to += 1;
        }
        let (before, after) = (if from > line.start { "… " } else { "" }, if to < line.end { " …" } else { "" });
        let text = format!("{before}{}{after}", &file.text[from..to]);
        let offset = before.len() + start - from;
        let length = (label.span.end as usize).min(to) - start;
        let labels = vec![labelled(true, &label.text, offset, length)];
        Excerpt::Cut { name: &file.name, text, line: place.line - 1, column: place.column - 1, labels }
    }

    pub fn labels(&self) -> &[LabeledSpan] {
        match self {
            Excerpt::Whole { labels, .. } | Excerpt::Cut { labels, .. } => labels,
        }
    }
}

fn labelled(primary: bool, text: &str, offset: usize, length: usize) -> LabeledSpan {
    let text = Some(text.to_string());
    if primary {
        LabeledSpan::new_primary_with_span(text, (offset, length))
    } else {
        LabeledSpan::new(text, offset, length)
    }
}

/// A label of many lines is shown on its first.
fn shortened(file: &SourceFile, span: Span) -> Span {
    let (first, last) = (file.line_column(span.start).line, file.line_column(span.end).line);
    if last - first < TALL_LABEL {
        return span;
    }
    Span { end: file.line_range(first).end.max(span.start as usize) as u32, ..span }
}

impl SourceCode for Excerpt<'_> {
    fn read_span<'s>(
        &'s self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'s> + 's>, MietteError> {
        match self {
            Excerpt::Cut { name, text, line, column, .. } => {
                if span.offset() + span.len() > text.len() {
                    return Err(MietteError::OutOfBounds);
                }
                let all = SourceSpan::from((0, text.len()));
                let column = if lines_before == 0 { *column } else { 0 };
                Ok(Box::new(MietteSpanContents::new_named(name.to_string(), text.as_bytes(), all, *line, column, 1)))
            }
            Excerpt::Whole { file, .. } => read_lines(file, span, lines_before, lines_after),
        }
    }
}

/// Whole lines from the line table: miette's own search would begin at the start of the file each time.
fn read_lines<'s>(
    file: &'s SourceFile,
    span: &SourceSpan,
    lines_before: usize,
    lines_after: usize,
) -> Result<Box<dyn SpanContents<'s> + 's>, MietteError> {
    let end = span.offset() + span.len();
    if end > file.text.len() {
        return Err(MietteError::OutOfBounds);
    }
    let place = file.line_column(span.offset() as u32);
    let first = place.line.saturating_sub(lines_before).max(1);
    let last = (file.line_column(end as u32).line + lines_after).min(file.line_count());
    let (from, to) = (file.line_range(first).start, file.line_range(last).end);
    let column = if lines_before == 0 { place.column - 1 } else { 0 };
    let data = &file.text.as_bytes()[from..to];
    let name = file.name.clone();
    Ok(Box::new(MietteSpanContents::new_named(
        name,
        data,
        (from, to - from).into(),
        first - 1,
        column,
        last - first + 1,
    )))
}
