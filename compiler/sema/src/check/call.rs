//! Calls and pipes.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast::{self, ExprKind};

use super::args::{Given, Matched, Slot, given};
use super::convert::instantiate;
use super::function::Signature;
use super::names::Meaning;
use super::{Checker, Typed};
use crate::code::{Code, FnId, Site};
use crate::registry::{Builtin, BuiltinId, Default, Implementation};
use crate::types::{Class, FnType, Type};
use crate::value::Value;

impl Checker<'_> {
    /// `value |> f(a)` is `f(value, a)`; `value |> f` is `f(value)`.
    pub(super) fn pipe(&mut self, value: &ast::Expr, call: &ast::Expr, span: Span) -> Typed {
        match &call.kind {
            ExprKind::Call(inner) => self.call(&inner.callee, &inner.args, Some(value), call.span),
            ExprKind::Error => {
                self.expr(value, None);
                Typed::error()
            }
            _ => self.call(call, &[], Some(value), span),
        }
    }

    pub(super) fn call(
        &mut self,
        callee: &ast::Expr,
        args: &[ast::Arg],
        piped: Option<&ast::Expr>,
        span: Span,
    ) -> Typed {
        let given = given(piped, args);
        match self.callee_meaning(callee) {
            Some(Meaning::Builtin(id)) => self.call_builtin(id, &given, span),
            Some(Meaning::Fn(id)) => match self.signature(id, callee.span) {
                Some(signature) => self.call_fn(id, &signature, &given, span),
                None => self.call_unknown(&given),
            },
            Some(Meaning::Missing) => self.call_unknown(&given),
            Some(_) | None => self.call_value(callee, &given, span),
        }
    }

    /// Checks the arguments of a call that makes no sense, for what is wrong within them.
    fn call_unknown(&mut self, given: &[Given<'_>]) -> Typed {
        for arg in given {
            if !matches!(arg.value.kind, ExprKind::Lambda { .. }) {
                self.expr(arg.value, None);
            }
        }
        Typed::error()
    }

    /// What a callee means if it is a function with a name.
    fn callee_meaning(&mut self, callee: &ast::Expr) -> Option<Meaning> {
        match &callee.kind {
            ExprKind::Paren(inner) => self.callee_meaning(inner),
            ExprKind::Name(name) => {
                if self.cx.names().any(|local| local == name.name) {
                    return None;
                }
                let meaning = self.global_meaning(&name.name);
                if meaning.is_none() && !self.is_this(&name.name) {
                    self.unknown_name(&name.name, name.span);
                    return Some(Meaning::Missing);
                }
                meaning
            }
            ExprKind::Field { base, name } => match self.module_named(base)? {
                Some(module) => Some(self.member(module, name).unwrap_or(Meaning::Missing)),
                None => Some(Meaning::Missing),
            },
            _ => None,
        }
    }

    /// A local function that is being defined.
    fn is_this(&self, name: &str) -> bool {
        self.cx.frames.iter().any(|frame| frame.this.as_ref().is_some_and(|this| this.name == name))
    }

    fn call_value(&mut self, callee: &ast::Expr, given: &[Given<'_>], span: Span) -> Typed {
        let local = match &callee.kind {
            ExprKind::Name(name) => self.local(&name.name),
            _ => None,
        };
        let (code, ty, signature) = match local {
            Some(found) => (found.code, found.ty, found.signature),
            None => {
                let found = self.expr(callee, None);
                (found.code, found.ty, None)
            }
        };
        match self.shallow(&ty) {
            Type::Fn(function) => match signature {
                Some(signature) => self.call_local(code, &signature, given, span),
                None => self.call_closure(code, &function, given, span),
            },
            Type::Error => self.call_unknown(given),
            Type::Infer(_) => {
                self.needs_type(callee.span);
                self.call_unknown(given)
            }
            other => {
                let message = format!("{} cannot be called", other.with_article());
                let diagnostic = Diagnostic::new(codes::NOT_CALLABLE, message).label(callee.span, "not a function");
                self.report(diagnostic);
                self.call_unknown(given)
            }
        }
    }

    fn call_fn(&mut self, id: FnId, signature: &Signature, given: &[Given<'_>], span: Span) -> Typed {
        match self.signature_args(signature, given, span) {
            Some(args) => {
                let ty = signature.result.clone().unwrap_or(Type::Error);
                Typed::new(Code::CallFn { function: id, args, span }, ty)
            }
            None => Typed::error(),
        }
    }

    fn call_local(&mut self, callee: Code, signature: &Signature, given: &[Given<'_>], span: Span) -> Typed {
        let ty = signature.result.clone().unwrap_or(Type::Error);
        match self.signature_args(signature, given, span) {
            Some(args) => Typed::new(Code::CallValue { callee: Box::new(callee), args, span }, ty),
            None => Typed::error(),
        }
    }

    fn signature_args(&mut self, signature: &Signature, given: &[Given<'_>], span: Span) -> Option<Vec<Code>> {
        let slots: Vec<Slot<'_>> =
            signature.params.iter().map(|param| Slot { name: &param.name, required: !param.has_default }).collect();
        let function = format!("`{}`", signature.name);
        let Some(matched) = self.match_args(&function, &slots, false, given, span) else {
            self.call_unknown(given);
            return None;
        };
        let mut args = Vec::with_capacity(slots.len());
        for (param, given) in signature.params.iter().zip(&matched.by_param) {
            args.push(match given.first() {
                Some(arg) => {
                    let found = self.expr(arg.value, Some(&param.ty));
                    let role = format!("`{}` of {function}", param.name);
                    self.coerce(found, &param.ty, arg.value.span, Some(&role))
                }
                None => Code::Const(Value::Missing),
            });
        }
        Some(args)
    }

    /// A function value knows its parameters by position only.
    fn call_closure(&mut self, callee: Code, function: &FnType, given: &[Given<'_>], span: Span) -> Typed {
        let result = self.known(&function.result);
        if let Some(name) = given.iter().find_map(|arg| arg.name) {
            let message = "a function value takes its arguments by position";
            self.error(codes::WRONG_ARGUMENTS, message, name.span, "a name");
            return Typed::new(Code::Error, result);
        }
        if given.len() != function.params.len() {
            let message =
                format!("the function takes {} arguments, but {} are given", function.params.len(), given.len());
            self.error(codes::WRONG_ARGUMENTS, message, span, format!("{} arguments", given.len()));
            return Typed::new(Code::Error, result);
        }
        let params = function.params.clone();
        let args = given.iter().zip(&params).map(|(arg, ty)| self.expect(arg.value, ty)).collect();
        let result = self.known(&function.result);
        Typed::new(Code::CallValue { callee: Box::new(callee), args, span }, result)
    }

    /// Fresh variables for a generic signature.
    pub(super) fn variables(&mut self, builtin: &Builtin) -> Vec<Type> {
        builtin.bounds.iter().map(|class| self.fresh(Some(*class).filter(|class| *class != Class::Any))).collect()
    }

    /// Reports a capability that is not there yet.
    pub(super) fn later(&mut self, builtin: &Builtin, span: Span) -> bool {
        let Implementation::Later(what) = builtin.implementation else { return false };
        let diagnostic = Diagnostic::new(codes::NOT_IMPLEMENTED, format!("{what} is not implemented yet"));
        self.report(diagnostic.label(span, format!("`{}` is checked, but cannot be rendered", builtin.name)));
        true
    }

    fn call_builtin(&mut self, id: BuiltinId, given: &[Given<'_>], span: Span) -> Typed {
        let builtin = self.registry.builtin(id);
        let function = format!("`{}`", builtin.name);
        let last = builtin.params.len().wrapping_sub(1);
        let slots: Vec<Slot<'_>> = builtin
            .params
            .iter()
            .enumerate()
            .map(|(i, param)| {
                let required = matches!(param.default, Default::Required) && !(builtin.variadic && i == last);
                Slot { name: param.name, required }
            })
            .collect();
        let Some(matched) = self.match_args(&function, &slots, builtin.variadic, given, span) else {
            return self.call_unknown(given);
        };
        self.typed_call(id, builtin, &matched, span)
    }

    fn typed_call(&mut self, id: BuiltinId, builtin: &'static Builtin, matched: &Matched<'_>, span: Span) -> Typed {
        let variables = self.variables(builtin);
        let mut found: Vec<Vec<(Typed, Span)>> = matched.by_param.iter().map(|_| Vec::new()).collect();
        // Lambdas last: by then the other arguments have told the types of their parameters.
        for lambdas in [false, true] {
            for (i, given) in matched.by_param.iter().enumerate() {
                let wanted = instantiate(&builtin.params[i].ty, &variables);
                for arg in given {
                    if is_function(&wanted) == lambdas {
                        let value = self.argument(arg.value, &wanted, &builtin.params[i].ty, &variables);
                        found[i].push((value, arg.value.span));
                    }
                }
            }
        }
        let mut overload = (id, builtin, variables);
        if found.iter().flatten().any(|(value, _)| self.known(&value.ty).holds_texture())
            && let Some((id, builtin)) = self.registry.texture_overload(builtin)
        {
            let variables = self.variables(builtin);
            for (param, values) in builtin.params.iter().zip(&found) {
                if let Type::Var(i) = param.ty {
                    values.iter().for_each(|(value, _)| self.join_variable(&variables[usize::from(i)], &value.ty));
                }
            }
            overload = (id, builtin, variables);
        }
        let (id, builtin, variables) = overload;
        let mut args = Vec::with_capacity(found.len());
        let mut spans = Vec::with_capacity(found.len());
        for (i, values) in found.into_iter().enumerate() {
            let param = &builtin.params[i];
            let wanted = instantiate(&param.ty, &variables);
            spans.push(values.first().map_or(span, |(_, at)| *at));
            let role = format!("`{}` of `{}`", param.name, builtin.name);
            let mut codes: Vec<Code> =
                values.into_iter().map(|(value, at)| self.coerce_argument(value, &wanted, at, &role)).collect();
            args.push(if builtin.variadic && i + 1 == builtin.params.len() {
                Code::List(codes)
            } else {
                codes.pop().unwrap_or_else(|| Code::Const(crate::eval::default_value(&param.default)))
            });
        }
        let result = self.known(&instantiate(&builtin.result, &variables));
        if self.later(builtin, span) {
            return Typed::new(Code::Error, result);
        }
        let site = Box::new(Site { span, args: spans.into() });
        Typed::new(Code::CallBuiltin { builtin: id, args, site }, result)
    }

    /// Checks one argument; what it tells about type variables is joined with what is known.
    fn argument(&mut self, value: &ast::Expr, wanted: &Type, declared: &Type, variables: &[Type]) -> Typed {
        let hint = (!matches!(declared, Type::Var(_) | Type::AnyOf(_))).then_some(wanted);
        let value = self.expr(value, hint);
        if let Type::Var(i) = declared {
            self.join_variable(&variables[usize::from(*i)], &value.ty);
        } else if self.mentions_variable(declared) {
            // The conversion itself is made later; here it only binds variables.
            let ty = value.ty.clone();
            self.convert(&ty, wanted);
        }
        value
    }

    fn join_variable(&mut self, variable: &Type, ty: &Type) {
        let Type::Infer(i) = variable else { return };
        let class = self.infer[*i as usize].1;
        let (ty, _) = self.promoted(&self.known(ty), class);
        match self.infer[*i as usize].0.clone() {
            None => {
                self.convert(&ty, variable);
            }
            Some(before) => {
                let joined = self.join(&before, &ty);
                if let Some(joined) = joined.filter(|joined| class.is_none_or(|class| class.contains(joined))) {
                    self.infer[*i as usize].0 = Some(joined);
                }
            }
        }
    }

    fn mentions_variable(&self, ty: &Type) -> bool {
        let mut found = matches!(ty, Type::Var(_));
        ty.map(&mut |part| {
            found |= self.mentions_variable(part);
            part.clone()
        });
        found
    }

    fn coerce_argument(&mut self, value: Typed, wanted: &Type, span: Span, role: &str) -> Code {
        if let Type::AnyOf(class @ (Class::UnionOperand | Class::SolidOperand)) = wanted {
            let found = self.known(&value.ty);
            if !class.contains(&found) && Class::Geometry.contains(&found) {
                self.not_a_solid(&found, span);
                return Code::Error;
            }
        }
        self.coerce(value, wanted, span, Some(role))
    }
}

fn is_function(ty: &Type) -> bool {
    matches!(ty, Type::Fn(_))
}
