//! Patterns.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast::{self, PatternKind};

use super::Checker;
use crate::code::{Code, Pat};
use crate::types::Type;
use crate::value::Value;

impl Checker<'_> {
    /// A pattern of a `let` or a loop, which must always fit.
    pub(super) fn binding(&mut self, pattern: &ast::Pattern, ty: &Type) -> Pat {
        if let Some(span) = refutable(pattern) {
            let diagnostic = Diagnostic::new(codes::PATTERN, "a pattern that may not fit cannot stand here");
            self.report(diagnostic.label(span, "may not fit").help("use `match`"));
        }
        self.pattern(pattern, ty)
    }

    pub(super) fn pattern(&mut self, pattern: &ast::Pattern, ty: &Type) -> Pat {
        let ty = self.shallow(ty);
        match &pattern.kind {
            PatternKind::Wildcard => Pat::Any,
            PatternKind::Error => Pat::Error,
            PatternKind::Binding(name) => Pat::Bind(self.declare_local(name, ty)),
            PatternKind::Literal(literal) => match self.pattern_value(literal, &ty) {
                Some(Value::Bool(b)) => Pat::Bool(b),
                Some(Value::Int(i)) => Pat::Int(i),
                Some(Value::Float(x)) => Pat::Float(x),
                Some(Value::Str(text)) => Pat::Str(text.to_string()),
                _ => Pat::Error,
            },
            PatternKind::Range { start, end, inclusive } => {
                let bounds = (self.pattern_value(start, &ty), self.pattern_value(end, &ty));
                self.range_pattern(bounds, *inclusive, pattern.span)
            }
            PatternKind::Tuple(parts) => self.tuple_pattern(parts, &ty, pattern.span),
            PatternKind::Either(alternatives) => {
                let mut names = Vec::new();
                alternatives.iter().for_each(|alternative| bound(alternative, &mut names));
                if let Some(first) = names.first() {
                    let message = "alternatives of a pattern cannot bind names";
                    self.error(codes::PATTERN, message, first.span, "a name");
                    names.into_iter().for_each(|name| self.declare_unknown(name));
                    return Pat::Error;
                }
                Pat::Either(alternatives.iter().map(|alternative| self.pattern(alternative, &ty)).collect())
            }
        }
    }

    fn tuple_pattern(&mut self, parts: &[ast::Pattern], ty: &Type, span: Span) -> Pat {
        let types: Vec<Type> = match ty {
            Type::Tuple(types) if types.len() == parts.len() => types.to_vec(),
            Type::Error => vec![Type::Error; parts.len()],
            Type::Infer(_) => {
                let types: Vec<Type> = parts.iter().map(|_| self.fresh(None)).collect();
                self.convert(ty, &Type::tuple(types.clone()));
                types
            }
            other => {
                let other = self.known(other);
                self.wrong_tuple(span, parts.len(), &other);
                vec![Type::Error; parts.len()]
            }
        };
        Pat::Tuple(parts.iter().zip(&types).map(|(part, ty)| self.pattern(part, ty)).collect())
    }

    pub(super) fn wrong_tuple(&mut self, span: Span, parts: usize, ty: &Type) {
        let message = format!("a pattern of {parts} parts does not fit {}", ty.with_article());
        self.error(codes::PATTERN, message, span, format!("{parts} parts"));
    }

    fn pattern_value(&mut self, literal: &ast::Expr, ty: &Type) -> Option<Value> {
        match self.expect(literal, ty) {
            Code::Const(value) => Some(value),
            Code::Error => None,
            _ => {
                self.error(codes::PATTERN, "a pattern needs a literal", literal.span, "not a literal");
                None
            }
        }
    }

    fn range_pattern(&mut self, bounds: (Option<Value>, Option<Value>), inclusive: bool, span: Span) -> Pat {
        let (empty, pattern) = match bounds {
            (Some(Value::Int(start)), Some(Value::Int(end))) => {
                (start > end || start == end && !inclusive, Pat::IntRange { start, end, inclusive })
            }
            (Some(Value::Float(start)), Some(Value::Float(end))) => {
                (start > end || start == end && !inclusive, Pat::FloatRange { start, end, inclusive })
            }
            (None, _) | (_, None) => return Pat::Error,
            _ => {
                self.error(codes::PATTERN, "only numbers have ranges", span, "not numbers");
                return Pat::Error;
            }
        };
        if empty {
            self.error(codes::PATTERN, "this range contains nothing", span, "empty");
        }
        pattern
    }
}

/// Where a pattern may fail to fit.
fn refutable(pattern: &ast::Pattern) -> Option<Span> {
    match &pattern.kind {
        PatternKind::Wildcard | PatternKind::Binding(_) | PatternKind::Error => None,
        PatternKind::Tuple(parts) => parts.iter().find_map(refutable),
        _ => Some(pattern.span),
    }
}

/// The names that a pattern binds.
fn bound<'p>(pattern: &'p ast::Pattern, names: &mut Vec<&'p ast::Ident>) {
    match &pattern.kind {
        PatternKind::Binding(name) => names.push(name),
        PatternKind::Tuple(parts) | PatternKind::Either(parts) => parts.iter().for_each(|part| bound(part, names)),
        _ => {}
    }
}
