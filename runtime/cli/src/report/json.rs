//! The format `json`: one document with every finding. Field names are stable; new ones may be added.

use std::io::{self, Write};

use arsc_diagnostics::{Applicability, Diagnostic, Severity, SourceMap};
use serde::Serialize;

use super::place::Place;
use super::{Findings, Totals};

#[derive(Serialize)]
struct Document<'a> {
    version: u32,
    errors: usize,
    warnings: usize,
    findings: Vec<Finding<'a>>,
}

#[derive(Serialize)]
struct Finding<'a> {
    /// `arsl::E0101`
    code: String,
    name: &'static str,
    severity: &'static str,
    message: &'a str,
    /// The script that was checked. The place itself may be in a module that it imports.
    script: &'a str,
    /// Where it is: the first label's place.
    place: Option<Place>,
    labels: Vec<Label<'a>>,
    help: Option<&'a str>,
    suggestions: Vec<Suggestion<'a>>,
}

#[derive(Serialize)]
struct Label<'a> {
    text: &'a str,
    place: Place,
}

#[derive(Serialize)]
struct Suggestion<'a> {
    place: Place,
    replacement: &'a str,
    /// `safe`, or `maybe-incorrect`
    applicability: &'static str,
}

pub fn write(out: &mut dyn Write, all: &[Findings<'_>]) -> io::Result<()> {
    let Totals { errors, warnings } = Totals::of(all);
    let findings = all.iter().flat_map(|found| found.diagnostics.iter().map(|d| finding(d, found.sources))).collect();
    serde_json::to_writer_pretty(&mut *out, &Document { version: 1, errors, warnings, findings })?;
    writeln!(out)
}

fn finding<'a>(diagnostic: &'a Diagnostic, sources: &'a SourceMap) -> Finding<'a> {
    Finding {
        code: diagnostic.code.to_string(),
        name: diagnostic.code.name(),
        severity: severity(diagnostic.severity),
        message: &diagnostic.message,
        script: sources.iter().next().map_or("", |(_, root)| &root.name),
        place: diagnostic.primary_span().map(|span| Place::of(sources, span)),
        labels: diagnostic
            .labels
            .iter()
            .map(|label| Label { text: &label.text, place: Place::of(sources, label.span) })
            .collect(),
        help: diagnostic.help.as_deref(),
        suggestions: diagnostic
            .suggestions
            .iter()
            .map(|suggestion| Suggestion {
                place: Place::of(sources, suggestion.span),
                replacement: &suggestion.replacement,
                applicability: match suggestion.applicability {
                    Applicability::Safe => "safe",
                    Applicability::MaybeIncorrect => "maybe-incorrect",
                },
            })
            .collect(),
    }
}

fn severity(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Allow => "allow",
    }
}
