//! Top-level `let` and `param`, and values given to params from outside.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span, closest};
use arsc_syntax::ast::{self, ExprKind, PatternKind};

use super::names::DefKind;
use super::{Checker, Progress};
use crate::Setting;
use crate::code::{Allowed, Code, Entry, Global, GlobalId};
use crate::types::Type;

/// Values of params given from outside, checked: which param, and the code of its value.
pub type Settings = Vec<(GlobalId, Entry)>;

#[derive(Clone, Copy)]
enum Decl<'a> {
    Let(&'a ast::Let),
    Param(&'a ast::Param),
    /// A name within the tuple pattern of another global.
    Part(GlobalId),
}

pub(super) struct GlobalState<'a> {
    decl: Decl<'a>,
    module: usize,
    progress: Progress,
    ty: Type,
    span: Span,
}

impl<'a> Checker<'a> {
    fn new_global(&mut self, module: usize, decl: Decl<'a>, name: &str, span: Span) -> GlobalId {
        let is_std = self.is_std(module);
        let entry = Entry { code: Code::Error, slots: 0, span };
        self.program.globals.push(Global { name: name.to_owned(), entry, part: None, allowed: None, is_std });
        self.globals.push(GlobalState { decl, module, progress: Progress::Unchecked, ty: Type::Error, span });
        GlobalId(self.globals.len() as u32 - 1)
    }

    pub(super) fn new_param(&mut self, module: usize, param: &'a ast::Param) -> GlobalId {
        self.new_global(module, Decl::Param(param), &param.name.name, param.default.span)
    }

    pub(super) fn declare_let(&mut self, module: usize, decl: &'a ast::Let) {
        match &decl.pattern.kind {
            PatternKind::Binding(name) => {
                let id = self.new_global(module, Decl::Let(decl), &name.name, decl.value.span);
                self.define(module, name, DefKind::Global(id));
            }
            _ => {
                let whole = self.new_global(module, Decl::Let(decl), "the tuple", decl.value.span);
                self.declare_parts(module, whole, &decl.pattern, &mut Vec::new());
            }
        }
    }

    fn declare_parts(&mut self, module: usize, whole: GlobalId, pattern: &'a ast::Pattern, path: &mut Vec<u32>) {
        match &pattern.kind {
            PatternKind::Binding(name) => {
                let id = self.new_global(module, Decl::Part(whole), &name.name, name.span);
                self.program.globals[id.0 as usize].part = Some((whole, path.clone()));
                self.define(module, name, DefKind::Global(id));
            }
            PatternKind::Tuple(parts) => {
                for (i, part) in parts.iter().enumerate() {
                    path.push(i as u32);
                    self.declare_parts(module, whole, part, path);
                    path.pop();
                }
            }
            PatternKind::Wildcard | PatternKind::Error => {}
            _ => self.error(codes::PATTERN, "a `let` needs a pattern that always fits", pattern.span, "may not fit"),
        }
    }

    /// The type of a global, found now if need be.
    pub(super) fn global_type(&mut self, id: GlobalId, used_at: Span) -> Type {
        if self.globals[id.0 as usize].progress == Progress::Running {
            let name = self.program.globals[id.0 as usize].name.clone();
            let message = format!("the value of `{name}` depends on itself");
            let diagnostic = Diagnostic::new(codes::CYCLIC_DEFINITION, message)
                .label(used_at, "needed here")
                .label(self.globals[id.0 as usize].span, "to find this");
            self.report(diagnostic);
            return Type::Error;
        }
        self.check_global(id);
        self.globals[id.0 as usize].ty.clone()
    }

    pub(super) fn check_global(&mut self, id: GlobalId) {
        let i = id.0 as usize;
        if self.globals[i].progress != Progress::Unchecked {
            return;
        }
        self.globals[i].progress = Progress::Running;
        let (decl, module, span) = (self.globals[i].decl, self.globals[i].module, self.globals[i].span);
        match decl {
            Decl::Let(decl) => {
                let (entry, ty) = self.typed_entry(module, decl.ty.as_ref(), &decl.value);
                self.check_shape_of_pattern(&decl.pattern, &ty);
                self.program.globals[i].entry = entry;
                self.globals[i].ty = ty;
            }
            Decl::Param(param) => {
                let (entry, ty) = self.typed_entry(module, param.ty.as_ref(), &param.default);
                self.program.globals[i].entry = entry;
                self.program.globals[i].allowed = param.range.as_ref().map(|range| self.allowed(module, range, &ty));
                self.globals[i].ty = ty;
            }
            Decl::Part(whole) => {
                let whole = self.global_type(whole, span);
                let path = self.program.globals[i].part.as_ref().map(|(_, path)| path.clone()).unwrap_or_default();
                self.globals[i].ty = path.iter().fold(whole, |ty, i| match ty {
                    Type::Tuple(parts) => parts.get(*i as usize).cloned().unwrap_or(Type::Error),
                    _ => Type::Error,
                });
            }
        }
        self.globals[i].progress = Progress::Done;
    }

    fn typed_entry(&mut self, module: usize, ty: Option<&'a ast::TypeExpr>, value: &'a ast::Expr) -> (Entry, Type) {
        let mut found = Type::Error;
        let entry = self.entry(module, value.span, |checker| match ty.map(|ty| checker.type_expr(ty)) {
            Some(ty) => {
                found = ty.clone();
                checker.expect(value, &ty)
            }
            None => {
                let value = checker.expr(value, None);
                found = checker.known(&value.ty);
                value.code
            }
        });
        (entry, found)
    }

    /// Reports a tuple pattern that does not have the shape of its value.
    fn check_shape_of_pattern(&mut self, pattern: &ast::Pattern, ty: &Type) {
        let PatternKind::Tuple(parts) = &pattern.kind else { return };
        match ty {
            Type::Tuple(types) if types.len() == parts.len() => {
                parts.iter().zip(types.iter()).for_each(|(part, ty)| self.check_shape_of_pattern(part, ty));
            }
            Type::Error => {}
            other => self.wrong_tuple(pattern.span, parts.len(), other),
        }
    }

    /// `in 1..=4096`, `in ["local", "tree"]`
    fn allowed(&mut self, module: usize, range: &'a ast::Expr, ty: &Type) -> Allowed {
        if let ExprKind::Range { start, end, inclusive } = &range.kind {
            let start = self.entry(module, start.span, |checker| checker.expect(start, ty));
            let end = self.entry(module, end.span, |checker| checker.expect(end, ty));
            return Allowed::Range { start, end, inclusive: *inclusive };
        }
        let list = Type::list(ty.clone());
        Allowed::OneOf(self.entry(module, range.span, |checker| checker.expect(range, &list)))
    }

    /// Checks values that are given to params of the root script; a later one wins.
    pub(super) fn check_settings(&mut self, settings: &[Setting]) -> Settings {
        let Some(root) = self.modules.len().checked_sub(1) else { return Vec::new() };
        let mut checked = Settings::new();
        for setting in settings {
            match self.scopes[root].defs.get(&setting.name).map(|def| def.kind.clone()) {
                Some(DefKind::Param(id)) => {
                    let ty = self.global_type(id, setting.value.span);
                    let entry = self.entry(root, setting.value.span, |checker| checker.expect(&setting.value, &ty));
                    checked.retain(|(old, _)| *old != id);
                    checked.push((id, entry));
                }
                _ => self.unknown_param(root, setting),
            }
        }
        checked
    }

    fn unknown_param(&mut self, root: usize, setting: &Setting) {
        let message = format!("the script has no param `{}`", setting.name);
        let diagnostic = Diagnostic::new(codes::UNKNOWN_PARAM, message).label(setting.value.span, "set here");
        let params: Vec<&str> = self.scopes[root]
            .defs
            .iter()
            .filter(|(_, def)| matches!(def.kind, DefKind::Param(_)))
            .map(|(name, _)| name.as_str())
            .collect();
        let diagnostic = match closest(&setting.name, params.iter().copied()) {
            Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
            None if params.is_empty() => diagnostic.help("it has no params at all"),
            None => diagnostic.help(format!("it has: {}", params.join(", "))),
        };
        self.report(diagnostic);
    }
}
