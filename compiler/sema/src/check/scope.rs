//! Local names: frames of functions, scopes of blocks, captures of closures.

use std::rc::Rc;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast;

use super::{Checker, function::Signature};
use crate::code::Code;
use crate::types::Type;

/// Where checking stands: the module, and the functions that enclose the place, outermost first.
pub(super) struct Context {
    pub module: usize,
    pub frames: Vec<Frame>,
}

/// One function's names.
#[derive(Default)]
pub(super) struct Frame {
    scopes: Vec<Vec<Local>>,
    pub slots: u32,
    captures: Vec<Capture>,
    /// The name by which a local function may call itself.
    pub this: Option<Named>,
}

struct Local {
    named: Named,
    slot: u32,
    span: Span,
    used: bool,
    is_param: bool,
}

struct Capture {
    named: Named,
    /// How the enclosing function reaches it.
    outer: Code,
}

#[derive(Clone)]
pub(super) struct Named {
    pub name: String,
    pub ty: Type,
    /// For local functions: names and defaults of parameters.
    pub signature: Option<Rc<Signature>>,
}

/// A local name in use.
pub(super) struct Found {
    pub code: Code,
    pub ty: Type,
    pub signature: Option<Rc<Signature>>,
}

impl Context {
    pub fn new(module: usize) -> Context {
        Context { module, frames: Vec::new() }
    }

    pub fn push_frame(&mut self) {
        self.frames.push(Frame { scopes: vec![Vec::new()], ..Frame::default() });
    }

    pub fn frame(&mut self) -> &mut Frame {
        self.frames.last_mut().expect("local names stand in a frame")
    }

    /// Names in scope, for suggestions.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let locals = self.frames.iter().flat_map(|frame| frame.scopes.iter().flatten());
        locals.map(|local| local.named.name.as_str())
    }

    fn find(&mut self, depth: usize, name: &str) -> Option<Found> {
        let frame = &mut self.frames[depth];
        let local =
            frame.scopes.iter_mut().rev().flat_map(|scope| scope.iter_mut().rev()).find(|l| l.named.name == name);
        if let Some(local) = local {
            local.used = true;
            return Some(local.named.found(Code::Local(local.slot)));
        }
        if let Some(this) = frame.this.as_ref().filter(|this| this.name == name) {
            return Some(this.found(Code::This));
        }
        if let Some(i) = frame.captures.iter().position(|capture| capture.named.name == name) {
            return Some(frame.captures[i].named.found(Code::Captured(i as u32)));
        }
        let outer = self.find(depth.checked_sub(1)?, name)?;
        let named = Named { name: name.to_owned(), ty: outer.ty, signature: outer.signature };
        let captures = &mut self.frames[depth].captures;
        captures.push(Capture { named: named.clone(), outer: outer.code });
        Some(named.found(Code::Captured(captures.len() as u32 - 1)))
    }
}

impl Named {
    fn found(&self, code: Code) -> Found {
        Found { code, ty: self.ty.clone(), signature: self.signature.clone() }
    }
}

impl Checker<'_> {
    pub(super) fn local(&mut self, name: &str) -> Option<Found> {
        self.cx.find(self.cx.frames.len().checked_sub(1)?, name)
    }

    pub(super) fn push_scope(&mut self) {
        self.cx.frame().scopes.push(Vec::new());
    }

    pub(super) fn pop_scope(&mut self) {
        let scope = self.cx.frame().scopes.pop().unwrap_or_default();
        self.lint_unused_locals(&scope);
    }

    /// Ends a frame; gives its size.
    pub(super) fn pop_frame(&mut self) -> Frame {
        let mut frame = self.cx.frames.pop().unwrap_or_default();
        for scope in std::mem::take(&mut frame.scopes) {
            self.lint_unused_locals(&scope);
        }
        frame
    }

    fn lint_unused_locals(&mut self, scope: &[Local]) {
        if self.is_std(self.cx.module) {
            return;
        }
        for local in scope.iter().filter(|local| !local.used && !local.named.name.starts_with('_')) {
            let name = &local.named.name;
            let (code, what) =
                if local.is_param { (codes::UNUSED_PARAM, "parameter") } else { (codes::UNUSED_NAME, "name") };
            let lint = Diagnostic::new(code, format!("the {what} `{name}` is never used"));
            let lint = lint.label(local.span, "defined here").help(format!("remove it, or call it `_{name}`"));
            self.report(lint);
        }
    }

    /// Declares a local name and gives its slot.
    pub(super) fn declare_local(&mut self, name: &ast::Ident, ty: Type) -> u32 {
        self.declare_in_scope(name, ty, None, false)
    }

    pub(super) fn declare_param(&mut self, name: &ast::Ident, ty: Type) -> u32 {
        self.declare_in_scope(name, ty, None, true)
    }

    pub(super) fn declare_local_fn(&mut self, name: &ast::Ident, ty: Type, signature: Rc<Signature>) -> u32 {
        self.declare_in_scope(name, ty, Some(signature), false)
    }

    fn declare_in_scope(
        &mut self,
        name: &ast::Ident,
        ty: Type,
        signature: Option<Rc<Signature>>,
        is_param: bool,
    ) -> u32 {
        self.lint_shadowed(name);
        let frame = self.cx.frame();
        let slot = frame.slots;
        frame.slots += 1;
        let named = Named { name: name.name.clone(), ty, signature };
        let local = Local { named, slot, span: name.span, used: false, is_param };
        frame.scopes.last_mut().expect("a frame has a scope").push(local);
        slot
    }

    /// Declares a name of which nothing is known, so that its uses report nothing more.
    pub(super) fn declare_unknown(&mut self, name: &ast::Ident) {
        let named = Named { name: name.name.clone(), ty: Type::Error, signature: None };
        let local = Local { named, slot: 0, span: name.span, used: true, is_param: false };
        self.cx.frame().scopes.last_mut().expect("a frame has a scope").push(local);
    }

    /// A name that hides another one of the same function.
    fn lint_shadowed(&mut self, name: &ast::Ident) {
        if name.name.starts_with('_') || self.is_std(self.cx.module) {
            return;
        }
        let hidden = self.cx.frame().scopes.iter().flatten().rev().find(|local| local.named.name == name.name);
        if let Some(before) = hidden.map(|local| local.span) {
            let message = format!("`{}` hides another `{}` of the same function", name.name, name.name);
            let lint = Diagnostic::new(codes::SHADOWED_NAME, message);
            self.report(lint.label(name.span, "this one").label(before, "hides this one"));
        }
    }

    /// What a closure must copy from the enclosing frame when it is made.
    pub(super) fn captures(frame: Frame) -> Vec<Code> {
        frame.captures.into_iter().map(|capture| capture.outer).collect()
    }
}
