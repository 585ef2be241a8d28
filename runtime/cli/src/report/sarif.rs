//! The format `sarif`: the Static Analysis Results Interchange Format, OASIS standard 2.1.0.

use std::fmt::Write as _;
use std::io::{self, Write};

use arsc_diagnostics::{Applicability, Code, Diagnostic, Label, Severity, SourceMap, Span};
use serde_json::{Value, json};

use super::Findings;
use super::place::Place;

pub fn write(out: &mut dyn Write, all: &[Findings<'_>]) -> io::Result<()> {
    let mut codes: Vec<Code> = all.iter().flat_map(|found| found.diagnostics.iter().map(|d| d.code)).collect();
    codes.sort_by_key(|code| code.id());
    codes.dedup();
    let results: Vec<Value> = all
        .iter()
        .flat_map(|found| found.diagnostics.iter().map(|diagnostic| result(diagnostic, found.sources, &codes)))
        .collect();
    let document = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "arsc",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": codes.iter().map(|code| rule(*code)).collect::<Vec<_>>(),
            } },
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    });
    serde_json::to_writer_pretty(&mut *out, &document)?;
    writeln!(out)
}

fn rule(code: Code) -> Value {
    let page = code.page().unwrap_or(code.summary());
    json!({
        "id": code.id(),
        "name": code.name(),
        "shortDescription": { "text": code.summary() },
        "help": { "text": page, "markdown": page },
        "defaultConfiguration": { "level": level(code.severity()) },
    })
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Allow => "none",
    }
}

fn result(diagnostic: &Diagnostic, sources: &SourceMap, codes: &[Code]) -> Value {
    let mut message = diagnostic.message.clone();
    if let Some(help) = &diagnostic.help {
        let _ = write!(message, "\nhelp: {help}");
    }
    let mut labels = diagnostic.labels.iter();
    let mut value = json!({
        "ruleId": diagnostic.code.id(),
        "ruleIndex": codes.iter().position(|code| *code == diagnostic.code),
        "level": level(diagnostic.severity),
        "message": { "text": message },
        "locations": labels.next().map(|label| location(label, sources)).into_iter().collect::<Vec<_>>(),
    });
    let related: Vec<Value> = labels.map(|label| location(label, sources)).collect();
    if !related.is_empty() {
        value["relatedLocations"] = Value::Array(related);
    }
    let fixes: Vec<Value> = diagnostic
        .suggestions
        .iter()
        .map(|suggestion| {
            let certainty = match suggestion.applicability {
                Applicability::Safe => "safe",
                Applicability::MaybeIncorrect => "may be incorrect",
            };
            json!({
                "description": { "text": format!("replace with `{}` ({certainty})", suggestion.replacement) },
                "artifactChanges": [{
                    "artifactLocation": artifact(sources, suggestion.span),
                    "replacements": [{
                        "deletedRegion": region(sources, suggestion.span),
                        "insertedContent": { "text": suggestion.replacement },
                    }],
                }],
            })
        })
        .collect();
    if !fixes.is_empty() {
        value["fixes"] = Value::Array(fixes);
    }
    value
}

fn location(label: &Label, sources: &SourceMap) -> Value {
    json!({
        "physicalLocation": {
            "artifactLocation": artifact(sources, label.span),
            "region": region(sources, label.span),
        },
        "message": { "text": label.text },
    })
}

fn artifact(sources: &SourceMap, span: Span) -> Value {
    json!({ "uri": uri(&sources.get(span.source).name) })
}

fn region(sources: &SourceMap, span: Span) -> Value {
    let place = Place::of(sources, span);
    json!({
        "startLine": place.line,
        "startColumn": place.column,
        "endLine": place.end_line,
        "endColumn": place.end_column,
        "byteOffset": place.start,
        "byteLength": place.end - place.start,
    })
}

/// A relative or absolute reference by RFC 3986: what is no path character is percent-encoded.
fn uri(name: &str) -> String {
    let mut uri = String::new();
    for byte in name.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte) {
            uri.push(byte as char);
        } else {
            let _ = write!(uri, "%{byte:02X}");
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_references() {
        assert_eq!(uri("scenes/a b.arsl"), "scenes/a%20b.arsl");
        assert_eq!(uri("<stdin>"), "%3Cstdin%3E");
        assert_eq!(uri("/tmp/ä.arsl"), "/tmp/%C3%A4.arsl");
    }
}
