//! The format `human`: miette's drawing, or plain sentences where lines cannot be drawn.

use std::fmt;
use std::io::{self, IsTerminal, Write};

use arsc_diagnostics::{Applicability, Diagnostic, Label, Severity, SourceMap, Suggestion};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, SourceCode};

use super::excerpt::Excerpt;
use super::place::Place;
use super::{Findings, Totals};

/// Findings that are shown; the rest is counted.
const SHOWN: usize = 50;
/// A replacement longer than this (bytes) is not shown.
const LONG_REPLACEMENT: usize = 200;

/// How findings are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    pub colour: bool,
    pub unicode: bool,
    pub width: usize,
}

impl Style {
    /// What fits a stream: colour only on a terminal and without `NO_COLOR`, lines drawn in Unicode only where the
    /// locale is UTF-8, the width of `COLUMNS`.
    pub fn of(stream: &impl IsTerminal) -> Style {
        let variable = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].iter().find_map(|name| variable(name)).unwrap_or_default();
        let dumb = variable("TERM").is_some_and(|term| term == "dumb");
        Style {
            colour: stream.is_terminal() && variable("NO_COLOR").is_none() && !dumb,
            unicode: locale.to_ascii_lowercase().replace('-', "").contains("utf8"),
            width: variable("COLUMNS").and_then(|columns| columns.parse().ok()).unwrap_or(100).clamp(40, 200),
        }
    }

    fn handler(self) -> GraphicalReportHandler {
        let theme = match (self.colour, self.unicode) {
            (true, true) => GraphicalTheme::unicode(),
            (false, true) => GraphicalTheme::unicode_nocolor(),
            (true, false) => GraphicalTheme::ascii(),
            (false, false) => GraphicalTheme::none(),
        };
        GraphicalReportHandler::new_themed(theme)
            .with_width(self.width)
            .with_links(false)
            .with_context_lines(1)
            .with_wrap_lines(true)
    }
}

pub fn write(out: &mut dyn Write, style: &Style, all: &[Findings<'_>]) -> io::Result<()> {
    let handler = style.handler();
    let findings = all.iter().flat_map(|found| found.diagnostics.iter().map(|d| (d, found.sources)));
    for (diagnostic, sources) in findings.clone().take(SHOWN) {
        let mut text = String::new();
        // Only a failing formatter could fail here, and a string does not.
        let _ = handler.render_report(&mut text, &Report::new(diagnostic, sources));
        let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
        writeln!(out, "{}\n", lines.join("\n").trim_matches('\n'))?;
    }
    let totals = Totals::of(all);
    let hidden = findings.count().saturating_sub(SHOWN);
    match hidden {
        0 if totals.is_clean() => Ok(()),
        0 => writeln!(out, "{totals}"),
        hidden => writeln!(out, "{totals}; {hidden} of them not shown"),
    }
}

/// A finding as a report of miette.
struct Report<'a> {
    diagnostic: &'a Diagnostic,
    excerpt: Option<Excerpt<'a>>,
    help: Option<String>,
}

impl<'a> Report<'a> {
    fn new(diagnostic: &'a Diagnostic, sources: &'a SourceMap) -> Report<'a> {
        let primary = diagnostic.primary_span();
        // miette draws one source: labels in others are told in the help.
        let (drawn, told): (Vec<&Label>, Vec<&Label>) =
            diagnostic.labels.iter().partition(|label| primary.is_some_and(|span| span.source == label.span.source));
        let excerpt = primary.map(|span| Excerpt::new(sources.get(span.source), &drawn));
        let told = match excerpt {
            Some(Excerpt::Cut { .. }) => diagnostic.labels.iter().skip(1).collect(),
            _ => told,
        };
        Report { diagnostic, excerpt, help: help(diagnostic, sources, &told) }
    }
}

fn help(diagnostic: &Diagnostic, sources: &SourceMap, told: &[&Label]) -> Option<String> {
    let mut parts: Vec<String> = diagnostic.help.iter().cloned().collect();
    // Help that shows the replacement already needs no second line.
    let shown = |replacement: &str| {
        let word = replacement.trim();
        diagnostic.help.as_ref().is_some_and(|help| !word.is_empty() && help.contains(word))
    };
    let suggestions = diagnostic.suggestions.iter().filter(|suggestion| !shown(&suggestion.replacement));
    parts.extend(suggestions.filter_map(|suggestion| suggested(suggestion, sources)));
    parts.extend(told.iter().map(|label| {
        let place = Place::of(sources, label.span);
        format!("{}:{}:{}: {}", place.file, place.line, place.column, label.text)
    }));
    (!parts.is_empty()).then(|| parts.join("\n"))
}

fn suggested(suggestion: &Suggestion, sources: &SourceMap) -> Option<String> {
    let (old, new) = (sources.text(suggestion.span), suggestion.replacement.as_str());
    if old.len().max(new.len()) > LONG_REPLACEMENT {
        return None;
    }
    Some(match (old, new, suggestion.applicability) {
        ("", new, _) => format!("insert `{new}`"),
        (old, "", _) => format!("remove `{old}`"),
        (old, new, Applicability::Safe) => format!("replace `{old}` with `{new}`"),
        (_, new, Applicability::MaybeIncorrect) => format!("did you mean `{new}`?"),
    })
}

impl fmt::Debug for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.diagnostic, f)
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl std::error::Error for Report<'_> {}

impl miette::Diagnostic for Report<'_> {
    fn code<'s>(&'s self) -> Option<Box<dyn fmt::Display + 's>> {
        let code = self.diagnostic.code;
        let kind = if self.diagnostic.severity == Severity::Error { "error" } else { "warning" };
        Some(match code.is_lint() {
            true => Box::new(format!("{kind} {code} ({})", code.name())),
            false => Box::new(format!("{kind} {code}")),
        })
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(if self.diagnostic.is_error() { miette::Severity::Error } else { miette::Severity::Warning })
    }

    fn help<'s>(&'s self) -> Option<Box<dyn fmt::Display + 's>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        // Without labels there is nothing to show.
        self.excerpt.as_ref().map(|excerpt| excerpt as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.excerpt.as_ref().map(|excerpt| Box::new(excerpt.labels().iter().cloned()) as _)
    }
}
