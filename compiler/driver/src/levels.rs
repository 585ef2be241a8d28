//! Lint levels: what `allow(…)`, `@allow(…)` and the command line make of a finding.
//!
//! The text has the last word: what a script allows is not reported, whatever the command line denies. Of several
//! settings on the command line the last one wins. Errors that are no lints cannot be changed.

use arsc_diagnostics::{Applicability, Code, Diagnostic, Severity, Span, closest, codes};
use arsc_sema::Module;
use arsc_syntax::ast::{Ident, ItemKind};
use arsc_syntax::visit::Node;

/// The name that stands for every lint, on the command line and in scripts.
pub const ALL_LINTS: &str = "warnings";

/// A lint that a piece of text allows.
struct Region {
    span: Span,
    /// `None`: all lints.
    lint: Option<Code>,
}

/// Applies the levels: drops what is allowed, sets the severity of the rest, and reports names that are no lints.
pub(crate) fn apply(
    diagnostics: Vec<Diagnostic>,
    modules: &[Module],
    levels: &[(String, Severity)],
) -> Vec<Diagnostic> {
    let mut regions = Vec::new();
    let mut unknown = Vec::new();
    for module in modules {
        for item in &module.ast.items {
            if let ItemKind::Allow(names) = &item.kind {
                allow(names, module.ast.span, &mut regions, &mut unknown);
            }
            collect(Node::Item(item), &mut regions, &mut unknown);
        }
    }
    let mut kept = Vec::with_capacity(diagnostics.len());
    for mut diagnostic in diagnostics.into_iter().chain(unknown) {
        if diagnostic.code.is_lint() {
            diagnostic.severity = level(&diagnostic, &regions, levels);
        }
        if diagnostic.severity != Severity::Allow {
            kept.push(diagnostic);
        }
    }
    kept
}

fn level(diagnostic: &Diagnostic, regions: &[Region], levels: &[(String, Severity)]) -> Severity {
    let code = diagnostic.code;
    let allowed = |region: &Region| {
        region.lint.is_none_or(|lint| lint == code)
            && diagnostic.primary_span().is_some_and(|span| region.span.contains(span))
    };
    if regions.iter().any(allowed) {
        return Severity::Allow;
    }
    let named = |name: &str| name == ALL_LINTS || name == code.name() || name == code.id();
    levels.iter().rev().find(|(name, _)| named(name)).map_or(diagnostic.severity, |(_, severity)| *severity)
}

fn collect(node: Node<'_>, regions: &mut Vec<Region>, unknown: &mut Vec<Diagnostic>) {
    match node {
        Node::Item(item) => allow(&item.allow, item.span, regions, unknown),
        Node::Stmt(stmt) => allow(&stmt.allow, stmt.span, regions, unknown),
        _ => {}
    }
    node.children(&mut |child| collect(child, regions, unknown));
}

fn allow(names: &[Ident], span: Span, regions: &mut Vec<Region>, unknown: &mut Vec<Diagnostic>) {
    for name in names {
        match lint(&name.name) {
            Ok(lint) => regions.push(Region { span, lint }),
            Err(help) => {
                let mut diagnostic =
                    Diagnostic::new(codes::driver::UNKNOWN_LINT, format!("there is no lint `{}`", name.name))
                        .label(name.span, "not a lint");
                diagnostic = match help {
                    UnknownLint::Meant(meant) => diagnostic.suggest(name.span, meant, Applicability::MaybeIncorrect),
                    UnknownLint::IsError => diagnostic.help("this is an error, and errors cannot be allowed"),
                    UnknownLint::Nothing => diagnostic.help("the lints are listed in docs/diagnostics"),
                };
                unknown.push(diagnostic);
            }
        }
    }
}

/// Why a name is no lint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnknownLint {
    /// Close to this one.
    Meant(&'static str),
    /// It is the code or name of an error.
    IsError,
    Nothing,
}

/// The lint with this name or code; `None` stands for all of them.
pub fn lint(name: &str) -> Result<Option<Code>, UnknownLint> {
    if name == ALL_LINTS {
        return Ok(None);
    }
    match codes::find(name) {
        Some(code) if code.is_lint() => Ok(Some(code)),
        Some(_) => Err(UnknownLint::IsError),
        None => {
            let lints = codes::all().filter(|code| code.is_lint()).map(|code| code.name());
            Err(closest(name, lints).map_or(UnknownLint::Nothing, UnknownLint::Meant))
        }
    }
}
