//! Expressions.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span, closest};
use arsc_syntax::ast::{self, ExprKind};

use super::names::{Meaning, with_suggestion};
use super::{Checker, Typed};
use crate::code::{Code, FnId};
use crate::registry::{BuiltinId, PRELUDE, choices};
use crate::types::{TextureKind, Type};
use crate::value::{Closure, Value};

impl Checker<'_> {
    /// Checks an expression. `hint` is the type that is wanted, for what needs to know it beforehand: lambdas, empty
    /// lists, names of choices. The result may have another type; [`Checker::expect`] converts.
    pub(super) fn expr(&mut self, expr: &ast::Expr, hint: Option<&Type>) -> Typed {
        if let Some(literal) = self.literal(expr) {
            return literal;
        }
        let found = self.compound(expr, hint);
        match found.ty {
            Type::List(_) | Type::Tuple(_) | Type::Record(_) | Type::Fn(_) => {
                Typed::new(found.code, self.bounded(found.ty, expr.span))
            }
            _ => found,
        }
    }

    fn compound(&mut self, expr: &ast::Expr, hint: Option<&Type>) -> Typed {
        match &expr.kind {
            ExprKind::Name(name) => self.name(name, hint),
            ExprKind::Tuple(elements) => self.tuple(elements, hint),
            ExprKind::Paren(inner) => self.expr(inner, hint),
            ExprKind::List(elements) => self.list(elements, hint),
            ExprKind::Record(fields) => self.record(fields, hint),
            ExprKind::Field { base, name } => self.field(base, name, hint),
            ExprKind::Index { base, index } => self.index(base, index),
            ExprKind::Call(call) => self.call(&call.callee, &call.args, None, expr.span),
            ExprKind::Pipe { value, call } => self.pipe(value, call, expr.span),
            ExprKind::Unary { op, op_span, operand } => self.unary(*op, *op_span, operand),
            ExprKind::Binary { op, op_span, left, right } => self.binary(*op, *op_span, left, right, expr.span),
            ExprKind::Range { start, end, inclusive } => self.range(start, end, *inclusive, expr.span),
            ExprKind::If { condition, then, otherwise } => {
                self.if_else(condition, then, otherwise.as_deref(), hint, expr.span)
            }
            ExprKind::Match { subject, arms } => self.match_value(subject, arms, hint, expr.span),
            ExprKind::For { pattern, list, filter, body } => {
                self.for_value(pattern, list, filter.as_deref(), body, hint, expr.span)
            }
            ExprKind::Block(block) => self.block(block, hint),
            ExprKind::Lambda { params, result, body } => self.lambda(params, result.as_ref(), body, hint),
            _ => Typed::error(),
        }
    }

    fn name(&mut self, name: &ast::Ident, hint: Option<&Type>) -> Typed {
        if let Some(hint) = hint
            && let Some((_, value)) = choices(&self.shallow(hint)).iter().find(|(choice, _)| *choice == name.name)
        {
            return Typed::new(Code::Const(value.clone()), self.shallow(hint));
        }
        if let Some(found) = self.local(&name.name) {
            return Typed::new(found.code, found.ty);
        }
        match self.global_meaning(&name.name) {
            Some(meaning) => self.value_of(meaning, name, hint),
            None => {
                self.unknown_value(name, hint);
                Typed::error()
            }
        }
    }

    fn unknown_value(&mut self, name: &ast::Ident, hint: Option<&Type>) {
        let known = hint.map(|hint| choices(&self.shallow(hint))).unwrap_or_default();
        if let Some(near) = closest(&name.name, known.iter().map(|(choice, _)| *choice)) {
            let diagnostic = Diagnostic::new(codes::UNKNOWN_NAME, format!("`{}` is not defined", name.name));
            let diagnostic = diagnostic.label(name.span, "not a choice here");
            return self.report(with_suggestion(diagnostic, name.span, Some(near)));
        }
        self.unknown_name(&name.name, name.span);
    }

    fn value_of(&mut self, meaning: Meaning, name: &ast::Ident, hint: Option<&Type>) -> Typed {
        match meaning {
            Meaning::Global(id) => {
                let ty = self.global_type(id, name.span);
                Typed::new(Code::Global(id, name.span), ty)
            }
            Meaning::Constant(constant) => Typed::new(Code::Const(constant.value.clone()), constant.ty.clone()),
            Meaning::Fn(id) => self.function_value(id, name.span, hint),
            Meaning::Builtin(id) => self.builtin_value(id, name.span, hint),
            Meaning::Module => {
                let message = format!("`{}` is a module, not a value", name.name);
                self.error(codes::NOT_A_VALUE, message, name.span, "a module");
                Typed::error()
            }
            Meaning::Type(_) => {
                let message = format!("`{}` is a type, not a value", name.name);
                self.error(codes::NOT_A_VALUE, message, name.span, "a type");
                Typed::error()
            }
            Meaning::Missing => Typed::error(),
        }
    }

    /// A function as a value: of as many parameters as are wanted, the others by default.
    fn function_value(&mut self, id: FnId, span: Span, hint: Option<&Type>) -> Typed {
        let Some(signature) = self.signature(id, span) else { return Typed::error() };
        let required = signature.params.iter().filter(|param| !param.has_default).count();
        let wanted = self.wanted_arity(hint).unwrap_or(signature.params.len());
        let arity = wanted.clamp(required, signature.params.len());
        let params = signature.params[..arity].iter().map(|param| param.ty.clone()).collect();
        let ty = Type::function(params, signature.result.clone().unwrap_or(Type::Error));
        Typed::new(Code::Closure { function: id, captures: Vec::new() }, ty)
    }

    fn builtin_value(&mut self, id: BuiltinId, span: Span, hint: Option<&Type>) -> Typed {
        let builtin = self.registry.builtin(id);
        if builtin.variadic {
            let message = format!("`{}` takes any number of arguments and cannot be passed as a value", builtin.name);
            let diagnostic = Diagnostic::new(codes::NOT_A_VALUE, message).label(span, "not called");
            self.report(diagnostic.help(format!("write a lambda: `fn(a, b) => {}(a, b)`", builtin.name)));
            return Typed::error();
        }
        if self.later(builtin, span) {
            return Typed::error();
        }
        let required = builtin.required();
        let arity = self.wanted_arity(hint).unwrap_or(required.max(1).min(builtin.params.len()));
        let arity = arity.clamp(required, builtin.params.len());
        let variables = self.variables(builtin);
        let of = |ty: &Type| super::convert::instantiate(ty, &variables);
        let params = builtin.params[..arity].iter().map(|param| of(&param.ty)).collect();
        let ty = Type::function(params, of(&builtin.result));
        Typed::new(Code::Const(Value::Fn(Closure::Builtin(id).into())), ty)
    }

    fn wanted_arity(&self, hint: Option<&Type>) -> Option<usize> {
        match self.shallow(hint?) {
            Type::Fn(wanted) => Some(wanted.params.len()),
            _ => None,
        }
    }

    fn field(&mut self, base: &ast::Expr, name: &ast::Ident, hint: Option<&Type>) -> Typed {
        if let Some(module) = self.module_named(base) {
            return match module {
                Some(module) => match self.member(module, name) {
                    Some(meaning) => self.value_of(meaning, name, hint),
                    None => Typed::error(),
                },
                None => Typed::error(),
            };
        }
        let base_value = self.expr(base, None);
        let ty = self.shallow(&base_value.ty);
        let varying = || Type::Texture(TextureKind::Float);
        let fields: Vec<(String, Type)> = match &ty {
            Type::Error => return Typed::error(),
            Type::Record(fields) => fields.to_vec(),
            Type::Vec2 => ["x", "y"].map(|name| (name.to_owned(), Type::Float)).to_vec(),
            Type::Texture(TextureKind::Vec2) => ["x", "y"].map(|name| (name.to_owned(), varying())).to_vec(),
            Type::Texture(TextureKind::Vec3) => ["x", "y", "z"].map(|name| (name.to_owned(), varying())).to_vec(),
            ty if ty.is_vec3_like() => ["x", "y", "z"].map(|name| (name.to_owned(), Type::Float)).to_vec(),
            _ => Vec::new(),
        };
        if let Some(i) = fields.iter().position(|(known, _)| *known == name.name) {
            return Typed::new(Code::Field(Box::new(base_value.code), i as u32), fields[i].1.clone());
        }
        if let Type::Infer(_) = ty {
            self.needs_type(base.span);
            return Typed::error();
        }
        let message = format!("{} has no field `{}`", ty.with_article(), name.name);
        let diagnostic = Diagnostic::new(codes::UNKNOWN_FIELD, message).label(name.span, "no such field");
        let near = closest(&name.name, fields.iter().map(|(name, _)| name.as_str()));
        let diagnostic = match (near, &ty) {
            (None, Type::Tuple(_)) => diagnostic.help("take a tuple apart by `let (a, b) = …`"),
            (None, Type::Record(_)) if fields.len() <= 8 => {
                let names: Vec<&str> = fields.iter().map(|(name, _)| name.as_str()).collect();
                diagnostic.help(format!("it has: {}", names.join(", ")))
            }
            (None, _) if self.registry.find(PRELUDE, &name.name).is_some() => {
                diagnostic.help(format!("functions are applied by `|>`: `value |> {}(…)`", name.name))
            }
            _ => with_suggestion(diagnostic, name.span, near),
        };
        self.report(diagnostic);
        Typed::error()
    }

    /// The module that a name stands for; the inner `None` is one that could not be loaded.
    pub(super) fn module_named(&mut self, base: &ast::Expr) -> Option<Option<usize>> {
        let ExprKind::Name(name) = &base.kind else { return None };
        if self.cx.names().any(|local| local == name.name) {
            return None;
        }
        match self.scopes[self.cx.module].defs.get(&name.name).map(|def| &def.kind) {
            Some(super::names::DefKind::Module(module)) => {
                let module = *module;
                self.global_meaning(&name.name);
                Some(module)
            }
            _ => None,
        }
    }

    fn index(&mut self, base: &ast::Expr, index: &ast::Expr) -> Typed {
        let list = self.expr(base, None);
        let at = self.expect(index, &Type::Int);
        let element = match self.shallow(&list.ty) {
            Type::Error => return Typed::error(),
            Type::List(element) => self.shallow(&element),
            Type::Infer(_) => {
                self.needs_type(base.span);
                return Typed::error();
            }
            other => {
                let message = format!("only lists have elements by index, but this is {}", other.with_article());
                self.error(codes::TYPE_MISMATCH, message, base.span, "not a list");
                return Typed::error();
            }
        };
        Typed::new(Code::Index { base: Box::new(list.code), index: Box::new(at), span: index.span }, element)
    }

    fn range(&mut self, start: &ast::Expr, end: &ast::Expr, inclusive: bool, span: Span) -> Typed {
        let start = Box::new(self.expect(start, &Type::Int));
        let end = Box::new(self.expect(end, &Type::Int));
        Typed::new(Code::Range { start, end, inclusive, span }, Type::list(Type::Int))
    }

    pub(super) fn needs_type(&mut self, span: Span) {
        let diagnostic =
            Diagnostic::new(codes::NEEDS_TYPE, "the type of this must be known here").label(span, "unknown type");
        self.report(diagnostic.help("write the types of the lambda's parameters: `fn(x: float) => …`"));
    }
}
