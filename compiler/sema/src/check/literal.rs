//! Literals, tuples, lists, records.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast::{self, ExprKind, Unit};

use super::convert::record;
use super::{Checker, Typed};
use crate::code::Code;
use crate::types::Type;
use crate::value::Value;

impl Checker<'_> {
    /// `None` if the expression is no literal.
    pub(super) fn literal(&mut self, expr: &ast::Expr) -> Option<Typed> {
        let (value, ty) = match &expr.kind {
            ExprKind::Bool(b) => (Value::Bool(*b), Type::Bool),
            ExprKind::Int(i) => (Value::Int(*i), Type::Int),
            ExprKind::Float(x) => (Value::Float(*x), Type::Float),
            ExprKind::Str(text) => (Value::str(text.as_str()), Type::Str),
            ExprKind::Quantity { value, unit } => {
                self.lint_quantity(*value, *unit, expr.span);
                let (x, ty) = match unit {
                    Unit::Deg => (value.to_radians(), Type::Angle),
                    Unit::Rad => (*value, Type::Angle),
                    Unit::Nm => (*value, Type::Wavelength),
                    Unit::Kelvin => (*value, Type::Temperature),
                };
                (Value::Float(x), ty)
            }
            _ => return None,
        };
        Some(Typed::new(Code::Const(value), ty))
    }

    pub(super) fn tuple(&mut self, elements: &[ast::Expr], hint: Option<&Type>) -> Typed {
        let hint = hint.map(|hint| self.shallow(hint));
        let hints: Option<Vec<Type>> = match &hint {
            Some(Type::Tuple(hints)) if hints.len() == elements.len() => Some(hints.to_vec()),
            _ => None,
        };
        let mut codes = Vec::with_capacity(elements.len());
        let mut types = Vec::with_capacity(elements.len());
        for (i, element) in elements.iter().enumerate() {
            let element = self.expr(element, hints.as_ref().map(|hints| &hints[i]));
            codes.push(element.code);
            types.push(element.ty);
        }
        Typed::new(folded(codes, Code::Tuple, |values| Value::Tuple(values.into())), Type::tuple(types))
    }

    pub(super) fn list(&mut self, elements: &[ast::Expr], hint: Option<&Type>) -> Typed {
        let hint = hint.map(|hint| self.shallow(hint));
        // A hint with unknown parts would take the first element's type, not that of all.
        let element_hint = match hint {
            Some(Type::List(element)) if !self.has_unknown(&element) => Some(self.known(&element)),
            _ => None,
        };
        let mut found = Vec::with_capacity(elements.len());
        for element in elements {
            found.push((self.expr(element, element_hint.as_ref()), element.span));
        }
        let Some(ty) = self.common(&mut found, element_hint.as_ref(), "elements of a list") else {
            return Typed::error();
        };
        let codes = found.into_iter().map(|(element, at)| self.coerce(element, &ty, at, None)).collect();
        Typed::new(folded(codes, Code::List, Value::list), Type::list(ty))
    }

    /// The common type of several values; reports the first that does not agree with those before it.
    pub(super) fn common(&mut self, found: &mut [(Typed, Span)], hint: Option<&Type>, what: &str) -> Option<Type> {
        let Some((first, first_span)) = found.first() else {
            return Some(hint.cloned().unwrap_or_else(|| self.fresh(None)));
        };
        let (mut ty, first_span) = (first.ty.clone(), *first_span);
        for (next, span) in &found[1..] {
            ty = match self.join(&ty, &next.ty) {
                Some(joined) => joined,
                None => {
                    let (a, b) = (self.known(&ty), self.known(&next.ty));
                    let message = format!("{what} must have one type, but these are `{a}` and `{b}`");
                    let diagnostic = Diagnostic::new(codes::TYPE_MISMATCH, message)
                        .label(*span, format!("this is {}", b.with_article()))
                        .label(first_span, format!("this is {}", a.with_article()));
                    self.report(diagnostic);
                    return None;
                }
            };
        }
        // Lists of numbers where vectors or floats are wanted are converted once, element by element.
        if let Some(hint) = hint
            && found.iter().all(|(element, _)| self.convert(&element.ty, hint).is_some())
        {
            return Some(hint.clone());
        }
        Some(ty)
    }

    pub(super) fn record(&mut self, fields: &[(ast::Ident, ast::Expr)], hint: Option<&Type>) -> Typed {
        let hint = hint.map(|hint| self.shallow(hint));
        let mut found: Vec<(String, Typed)> = Vec::with_capacity(fields.len());
        for (name, value) in fields {
            if found.iter().any(|(known, _)| *known == name.name) {
                let message = format!("the field `{}` is given twice", name.name);
                self.error(codes::DUPLICATE_NAME, message, name.span, "the second");
                continue;
            }
            let wanted = match &hint {
                Some(Type::Record(types)) => types.iter().find(|(known, _)| *known == name.name).map(|(_, ty)| ty),
                _ => None,
            };
            let value = self.expr(value, wanted);
            found.push((name.name.clone(), value));
        }
        found.sort_by(|a, b| a.0.cmp(&b.0));
        let ty = record(found.iter().map(|(name, value)| (name.clone(), value.ty.clone())).collect());
        let codes = found.into_iter().map(|(_, value)| value.code).collect();
        Typed::new(folded(codes, Code::Tuple, |values| Value::Tuple(values.into())), ty)
    }
}

/// One constant where every part is one.
fn folded(codes: Vec<Code>, make: fn(Vec<Code>) -> Code, value: fn(Vec<Value>) -> Value) -> Code {
    if !codes.iter().all(|code| matches!(code, Code::Const(_))) {
        return make(codes);
    }
    let constant = |code| match code {
        Code::Const(value) => Some(value),
        _ => None,
    };
    Code::Const(value(codes.into_iter().filter_map(constant).collect()))
}
