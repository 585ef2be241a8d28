//! From pest's pairs to the syntax tree.
//!
//! The file is given to the grammar one item at a time, so that the memory for pairs is that of the largest item.
//! Every function takes the pair of the rule that it is named after. Expressions come with the depth of their tree,
//! which is limited here because all who come later recurse over it.

mod chain;
mod expr;
mod item;
mod literal;
mod pattern;
mod stmt;
mod types;

use std::borrow::Cow;

use arsc_diagnostics::{Applicability, Diagnostic, SourceId, Span, codes};
use pest::Parser;

use crate::ast::{Expr, ExprKind, Ident, Module};
use crate::grammar::{Grammar, Pair, Rule};
use crate::{MAX_FINDINGS, Parsed, diagnose, scan};

/// Reads a file.
pub(crate) fn module(source: SourceId, text: &str) -> Parsed {
    let found = scan::scan(source, text);
    let readable = masked(text, &found.masked);
    let mut builder = Builder::new(source, &readable, found.diagnostics);
    let mut items = Vec::new();
    if !found.unreadable {
        let mut start = 0;
        for stop in found.stops {
            while start < stop
                && let Some(end) = builder.top(start, stop, &found.comments, &mut items)
            {
                start = end;
            }
            start = stop;
        }
    }
    let span = Span::new(source, 0, text.len());
    let docs = item::module_docs(text, &found.comments);
    let comments = found.comments.into_iter().map(|span| crate::ast::Comment { span }).collect();
    Parsed { module: Module { docs, items, comments, span }, diagnostics: builder.finish() }
}

/// Reads one expression.
pub(crate) fn expression(source: SourceId, text: &str) -> (Expr, Vec<Diagnostic>) {
    let found = scan::scan(source, text);
    let span = Span::new(source, 0, text.len());
    let readable = masked(text, &found.masked);
    let mut builder = Builder::new(source, &readable, found.diagnostics);
    let mut expr = Expr { kind: ExprKind::Error, span };
    if !found.unreadable {
        match Grammar::parse(Rule::strict_expr, &readable) {
            Ok(mut pairs) => {
                let inner = pairs.next().and_then(|strict| strict.into_inner().next());
                if let Some(pair) = inner {
                    expr = builder.expr(pair).0;
                }
            }
            Err(_) => builder.unreadable(Rule::strict_expr, 0, text.len()),
        }
    }
    (expr, builder.finish())
}

/// The text with another character, one that no rule takes, in the place of some brackets.
fn masked<'t>(text: &'t str, brackets: &[usize]) -> Cow<'t, str> {
    let mut text = Cow::Borrowed(text);
    for &at in brackets {
        text.to_mut().replace_range(at..at + 1, "\u{1}");
    }
    text
}

pub(crate) struct Builder<'t> {
    source: SourceId,
    text: &'t str,
    /// Where the text given to the grammar starts: pest counts from there.
    base: usize,
    diagnostics: Vec<Diagnostic>,
    /// Starts of what the scan has reported, ascending: a statement that holds one needs no second report.
    reported: Vec<u32>,
    /// Where the last statement ended that another one followed on the same line: that one needs no second report.
    crowded_at: Option<usize>,
    /// A tree too deep has been reported in this item: once is enough.
    too_deep: bool,
}

impl<'t> Builder<'t> {
    fn new(source: SourceId, text: &'t str, diagnostics: Vec<Diagnostic>) -> Builder<'t> {
        let mut reported: Vec<u32> = diagnostics.iter().filter_map(|d| d.primary_span()).map(|s| s.start).collect();
        reported.sort_unstable();
        Builder { source, text, base: 0, diagnostics, reported, crowded_at: None, too_deep: false }
    }

    fn finish(mut self) -> Vec<Diagnostic> {
        self.diagnostics.sort_by_key(|d| d.primary_span().map_or(0, |span| span.start));
        self.diagnostics
    }

    fn span(&self, pair: &Pair<'t>) -> Span {
        let span = pair.as_span();
        Span::new(self.source, self.base + span.start(), self.base + span.end())
    }

    /// Where the pair starts, as an empty span.
    fn start(&self, pair: &Pair<'t>) -> Span {
        let start = self.base + pair.as_span().start();
        Span::new(self.source, start, start)
    }

    fn ident(&self, pair: Pair<'t>) -> Ident {
        Ident { name: pair.as_str().to_string(), span: self.span(&pair) }
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        if self.diagnostics.len() < MAX_FINDINGS {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Reports a statement or item that the grammar could not read, unless the scan has already said why.
    fn unreadable(&mut self, rule: Rule, start: usize, end: usize) {
        let first = self.reported.partition_point(|&at| (at as usize) < start);
        let is_full = self.diagnostics.len() >= MAX_FINDINGS;
        if is_full || self.follows_crowded(start) || self.reported.get(first).is_some_and(|&at| (at as usize) < end) {
            return;
        }
        let diagnostic = diagnose::diagnose(self.source, self.text, rule, start, end);
        self.report(diagnostic);
    }

    /// Whether what starts here is the second of two statements on one line, which has been reported.
    fn follows_crowded(&self, start: usize) -> bool {
        self.crowded_at.is_some_and(|end| end <= start && self.text[end..start].trim().is_empty())
    }

    /// A zero-width error production for a comma: reported at the end of what stands before it.
    fn missing_comma(&mut self, before: Span) {
        let at = Span::new(self.source, before.end as usize, before.end as usize);
        let diagnostic =
            Diagnostic::new(codes::syntax::MISSING_COMMA, "a comma is missing").label(at, "expected `,` here");
        let (before, after) = self.text.split_at(before.end as usize);
        self.report(match diagnose::parted_unit(before, after.trim_start()) {
            Some(help) => diagnostic.help(help),
            None => diagnostic.suggest(at, ",", Applicability::MaybeIncorrect),
        });
    }
}
