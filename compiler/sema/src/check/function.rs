//! Functions: signatures, bodies on demand, lambdas and local functions.

use std::rc::Rc;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast;

use super::scope::{Context, Named};
use super::{Checker, Progress, Typed};
use crate::code::{Code, FnId, Function};
use crate::types::Type;

/// Parameters of a function with a name.
pub(super) struct Signature {
    pub name: String,
    pub params: Vec<SignatureParam>,
    /// `None` until inferred.
    pub result: Option<Type>,
}

#[derive(Clone)]
pub(super) struct SignatureParam {
    pub name: String,
    pub ty: Type,
    pub has_default: bool,
}

pub(super) struct FnState<'a> {
    decl: &'a ast::FnDecl,
    module: usize,
    progress: Progress,
    signature: Option<Rc<Signature>>,
}

impl<'a> Checker<'a> {
    pub(super) fn new_fn(&mut self, module: usize, decl: &'a ast::FnDecl) -> FnId {
        let is_std = self.is_std(module);
        let id = self.reserve_fn(&decl.name.name, is_std);
        // Functions of modules are declared before any body is checked, so the two tables agree on ids.
        debug_assert_eq!(self.fns.len(), id.0 as usize);
        self.fns.push(FnState { decl, module, progress: Progress::Unchecked, signature: None });
        id
    }

    fn reserve_fn(&mut self, name: &str, is_std: bool) -> FnId {
        let function = Function { name: name.to_owned(), defaults: Vec::new(), slots: 0, body: Code::Error, is_std };
        self.program.functions.push(function);
        FnId(self.program.functions.len() as u32 - 1)
    }

    pub(super) fn check_fn(&mut self, id: FnId) {
        let i = id.0 as usize;
        if self.fns[i].progress != Progress::Unchecked {
            return;
        }
        let (decl, module) = (self.fns[i].decl, self.fns[i].module);
        self.fns[i].progress = Progress::Running;
        let outer = std::mem::replace(&mut self.cx, Context::new(module));
        self.cx.push_frame();
        let (params, defaults) = self.params(&decl.params, None, true);
        let result = decl.result.as_ref().map(|ty| self.type_expr(ty));
        let name = decl.name.name.clone();
        self.fns[i].signature =
            Some(Rc::new(Signature { name: name.clone(), params: params.clone(), result: result.clone() }));
        let body = self.body(&decl.body, result.as_ref());
        let frame = self.pop_frame();
        self.cx = outer;
        let function = &mut self.program.functions[i];
        (function.defaults, function.slots, function.body) = (defaults, frame.slots as usize, body.code);
        let result = Some(result.unwrap_or(body.ty));
        self.fns[i].signature = Some(Rc::new(Signature { name, params, result }));
        self.fns[i].progress = Progress::Done;
    }

    /// The signature of a function, its result inferred if need be. `None`: it is being inferred; reported.
    pub(super) fn signature(&mut self, id: FnId, used_at: Span) -> Option<Rc<Signature>> {
        self.check_fn(id);
        let state = &self.fns[id.0 as usize];
        let decl = state.decl;
        let known = state.signature.clone().filter(|signature| signature.result.is_some());
        if known.is_none() {
            let name = &decl.name.name;
            let message = format!("the result type of `{name}` cannot be inferred, for it calls itself");
            let diagnostic = Diagnostic::new(codes::NEEDS_TYPE, message)
                .label(decl.name.span, "needs a result type")
                .label(used_at, "called here before its result is known")
                .help(format!("write it: `fn {name}(…) -> solid {{ … }}`"));
            let repeated =
                |old: &Diagnostic| old.code == codes::NEEDS_TYPE && old.primary_span() == Some(decl.name.span);
            if !self.diagnostics.iter().any(repeated) {
                self.report(diagnostic);
            }
        }
        known
    }

    /// Declares parameters in the current frame. `hints`: types known from where a lambda is used.
    fn params(
        &mut self,
        params: &[ast::FnParam],
        hints: Option<&[Type]>,
        must_know: bool,
    ) -> (Vec<SignatureParam>, Vec<Option<Code>>) {
        let mut signature: Vec<SignatureParam> = Vec::new();
        let mut defaults = Vec::new();
        for (i, param) in params.iter().enumerate() {
            let written = param.ty.as_ref().map(|ty| self.type_expr(ty));
            let default = param.default.as_ref().map(|default| match &written {
                Some(ty) => Typed::new(self.expect(default, ty), ty.clone()),
                None => self.expr(default, None),
            });
            let ty = match (written, &default, hints.and_then(|hints| hints.get(i))) {
                (Some(ty), ..) => ty,
                (None, Some(default), _) => default.ty.clone(),
                (None, None, Some(hint)) => hint.clone(),
                (None, None, None) if must_know => self.untyped_param(param),
                (None, None, None) => self.fresh(None),
            };
            if signature.iter().any(|known| known.name == param.name.name) {
                let message = format!("two parameters are called `{}`", param.name.name);
                self.error(codes::DUPLICATE_NAME, message, param.name.span, "the second");
            }
            self.declare_param(&param.name, ty.clone());
            let has_default = default.is_some();
            signature.push(SignatureParam { name: param.name.name.clone(), ty, has_default });
            defaults.push(default.map(|default| default.code));
        }
        (signature, defaults)
    }

    fn untyped_param(&mut self, param: &ast::FnParam) -> Type {
        let name = &param.name.name;
        let diagnostic = Diagnostic::new(codes::NEEDS_TYPE, format!("the parameter `{name}` needs a type"))
            .label(param.name.span, "no type")
            .help(format!("write `{name}: float`, or whatever it is"));
        self.report(diagnostic);
        Type::Error
    }

    fn body(&mut self, body: &ast::Expr, result: Option<&Type>) -> Typed {
        match result {
            Some(ty) => Typed::new(self.expect(body, ty), ty.clone()),
            None => {
                let body = self.expr(body, None);
                let ty = self.known(&body.ty);
                Typed::new(body.code, ty)
            }
        }
    }

    /// `fn(x) => …`; `hint` is the function type that is wanted.
    pub(super) fn lambda(
        &mut self,
        params: &[ast::FnParam],
        result: Option<&ast::TypeExpr>,
        body: &ast::Expr,
        hint: Option<&Type>,
    ) -> Typed {
        let wanted = hint.map(|hint| self.shallow(hint));
        let wanted = match &wanted {
            Some(Type::Fn(wanted)) if wanted.params.len() == params.len() => Some(wanted.clone()),
            _ => None,
        };
        self.cx.push_frame();
        let hints: Option<Vec<Type>> = wanted.as_ref().map(|w| w.params.iter().map(|ty| self.known(ty)).collect());
        let (signature, defaults) = self.params(params, hints.as_deref(), false);
        let result = result.map(|ty| self.type_expr(ty));
        let body = match (&result, &wanted) {
            (Some(_), _) => self.body(body, result.as_ref()),
            (None, Some(wanted)) => {
                let wanted = self.known(&wanted.result);
                self.expr(body, Some(&wanted))
            }
            (None, None) => self.body(body, None),
        };
        let is_std = self.is_std(self.cx.module);
        let id = self.reserve_fn("", is_std);
        self.finish_closure(id, defaults, body.code);
        let captures = Checker::captures(self.pop_frame());
        let params = signature.into_iter().map(|param| param.ty).collect();
        let ty = Type::function(params, result.unwrap_or(body.ty));
        Typed::new(Code::Closure { function: id, captures }, ty)
    }

    fn finish_closure(&mut self, id: FnId, defaults: Vec<Option<Code>>, body: Code) {
        let slots = self.cx.frame().slots as usize;
        let function = &mut self.program.functions[id.0 as usize];
        (function.defaults, function.slots, function.body) = (defaults, slots, body);
    }

    /// A function declared within a block: a closure bound to its name.
    pub(super) fn local_fn(&mut self, decl: &ast::FnDecl) -> Code {
        self.cx.push_frame();
        let (params, defaults) = self.params(&decl.params, None, true);
        let result = decl.result.as_ref().map(|ty| self.type_expr(ty));
        let name = decl.name.name.clone();
        let types: Vec<Type> = params.iter().map(|param| param.ty.clone()).collect();
        if let Some(result) = &result {
            let signature =
                Rc::new(Signature { name: name.clone(), params: params.clone(), result: Some(result.clone()) });
            let ty = Type::function(types.clone(), result.clone());
            self.cx.frame().this = Some(Named { name: name.clone(), ty, signature: Some(signature) });
        }
        let body = self.body(&decl.body, result.as_ref());
        let is_std = self.is_std(self.cx.module);
        let id = self.reserve_fn(&name, is_std);
        self.finish_closure(id, defaults, body.code);
        let captures = Checker::captures(self.pop_frame());
        let result = result.unwrap_or(body.ty);
        let ty = Type::function(types, result.clone());
        let signature = Rc::new(Signature { name, params, result: Some(result) });
        let slot = self.declare_local_fn(&decl.name, ty, signature);
        let value = Box::new(Code::Closure { function: id, captures });
        Code::Let { pattern: crate::code::Pat::Bind(slot), value }
    }
}
