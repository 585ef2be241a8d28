//! Names of modules: declarations, imports, lookup, did-you-mean.

use indexmap::IndexMap;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Applicability, Diagnostic, Span, closest};
use arsc_syntax::ast::{self, ImportNames, ImportPath, ItemKind};

use super::Checker;
use crate::code::{FnId, GlobalId};
use crate::registry::{BuiltinId, Constant, PRELUDE};

#[derive(Default)]
pub(super) struct ModuleScope {
    pub defs: IndexMap<String, Def>,
}

pub(super) struct Def {
    pub span: Span,
    pub kind: DefKind,
    pub used: bool,
}

#[derive(Clone, Debug)]
pub(super) enum DefKind {
    Fn(FnId),
    Global(GlobalId),
    /// A `param`.
    Param(GlobalId),
    Type(usize),
    /// A whole module; `None` if it could not be loaded.
    Module(Option<usize>),
    /// A name of a module.
    Import {
        module: Option<usize>,
        name: String,
    },
}

/// What a name means.
#[derive(Clone, Copy)]
pub(super) enum Meaning {
    Fn(FnId),
    Global(GlobalId),
    Builtin(BuiltinId),
    Constant(&'static Constant),
    Type(usize),
    Module,
    /// Could not be loaded; reported.
    Missing,
}

impl<'a> Checker<'a> {
    /// Enters the names of every module.
    pub(super) fn declare(&mut self) {
        let modules = self.modules;
        for (index, module) in modules.iter().enumerate() {
            self.scopes.push(ModuleScope::default());
            let mut imports = module.imports.iter();
            for item in &module.ast.items {
                match &item.kind {
                    ItemKind::Import(import) => {
                        let target = imports.next().copied().flatten();
                        self.declare_import(index, import, target);
                    }
                    ItemKind::Fn(decl) => {
                        let id = self.new_fn(index, decl);
                        self.define(index, &decl.name, DefKind::Fn(id));
                    }
                    ItemKind::Let(decl) => self.declare_let(index, decl),
                    ItemKind::Param(param) => {
                        let id = self.new_param(index, param);
                        self.define(index, &param.name, DefKind::Param(id));
                    }
                    ItemKind::Type { name, ty } => {
                        let id = self.new_alias(index, name, ty);
                        self.define(index, name, DefKind::Type(id));
                    }
                    _ => {}
                }
            }
        }
    }

    pub(super) fn define(&mut self, module: usize, name: &ast::Ident, kind: DefKind) {
        if let Some(before) = self.scopes[module].defs.get(&name.name).map(|def| def.span) {
            let message = format!("`{}` is defined twice", name.name);
            let diagnostic = Diagnostic::new(codes::DUPLICATE_NAME, message);
            self.report(diagnostic.label(name.span, "the second").label(before, "the first"));
            return;
        }
        self.scopes[module].defs.insert(name.name.clone(), Def { span: name.span, kind, used: false });
    }

    fn declare_import(&mut self, index: usize, import: &ast::Import, target: Option<usize>) {
        match &import.names {
            ImportNames::Module(alias) => {
                if let Some(name) = alias.clone().or_else(|| implied_name(&import.path)) {
                    self.define(index, &name, DefKind::Module(target));
                }
            }
            ImportNames::Names(names) => {
                for import in names {
                    let kind = DefKind::Import { module: target, name: import.name.name.clone() };
                    self.define(index, import.alias.as_ref().unwrap_or(&import.name), kind);
                    if let Some(target) = target {
                        self.require_export(target, &import.name);
                    }
                }
            }
        }
    }

    /// Reports an import of what a module does not give. Modules come dependencies first, so its names are known.
    fn require_export(&mut self, target: usize, name: &ast::Ident) {
        if self.exported(target, &name.name).is_some() {
            return;
        }
        let module = self.modules[target].name.clone();
        let message = format!("`{module}` has no `{}`", name.name);
        let near = closest(&name.name, self.exports(target)).map(str::to_owned);
        let diagnostic = Diagnostic::new(codes::UNKNOWN_NAME, message).label(name.span, "not found there");
        self.report(with_suggestion(diagnostic, name.span, near.as_deref()));
    }

    /// Names that a module gives.
    fn exports(&self, module: usize) -> Vec<&str> {
        let own = self.scopes[module].defs.iter().filter(|(name, def)| !name.starts_with('_') && !def.is_import());
        let name = if self.is_std(module) { self.modules[module].name.as_str() } else { "" };
        own.map(|(name, _)| name.as_str()).chain(self.registry.names(name).map(|name| -> &str { name })).collect()
    }

    /// What a module gives under a name. A private name is not given.
    pub(super) fn exported(&mut self, module: usize, name: &str) -> Option<Meaning> {
        if name.starts_with('_') {
            return None;
        }
        if let Some(def) = self.scopes[module].defs.get_mut(name)
            && !def.is_import()
        {
            def.used = true;
            let kind = def.kind.clone();
            return Some(self.meaning(&kind));
        }
        if !self.is_std(module) {
            return None;
        }
        let home = &self.modules[module].name;
        self.registry.find(home, name).or_else(|| self.registry.find_prelude_of(home, name)).map(Meaning::Builtin)
    }

    fn meaning(&mut self, kind: &DefKind) -> Meaning {
        match kind {
            DefKind::Fn(id) => Meaning::Fn(*id),
            DefKind::Global(id) | DefKind::Param(id) => Meaning::Global(*id),
            DefKind::Type(id) => Meaning::Type(*id),
            DefKind::Module(Some(_)) => Meaning::Module,
            DefKind::Import { module: Some(module), name } => {
                let name = name.clone();
                self.exported(*module, &name).unwrap_or(Meaning::Missing)
            }
            DefKind::Module(None) | DefKind::Import { module: None, .. } => Meaning::Missing,
        }
    }

    /// What a name means at the top level of the current module.
    pub(super) fn global_meaning(&mut self, name: &str) -> Option<Meaning> {
        let module = self.cx.module;
        if let Some(def) = self.scopes[module].defs.get_mut(name) {
            def.used = true;
            let kind = def.kind.clone();
            return Some(self.meaning(&kind));
        }
        let own = self.is_std(module).then(|| self.registry.find(&self.modules[module].name, name)).flatten();
        if let Some(id) = own.or_else(|| self.registry.find(PRELUDE, name)) {
            return Some(Meaning::Builtin(id));
        }
        self.registry.constant(name).map(Meaning::Constant)
    }

    pub(super) fn unknown_name(&mut self, name: &str, span: Span) {
        let diagnostic = Diagnostic::new(codes::UNKNOWN_NAME, format!("`{name}` is not defined"))
            .label(span, "not found in this scope");
        if let Some(module) = self.registry.std_module_of(name) {
            let help = format!("it is in {module}: `import {module} {{ {name} }}`");
            self.report(diagnostic.help(help));
            return;
        }
        if matches!(name, "color" | "colour" | "pigment") {
            let help =
                "colours are materials: `shape |> with(lambert(rgb(0.8, 0.1, 0.1)))`, with `lambert` of std.material";
            self.report(diagnostic.help(help));
            return;
        }
        let module = &self.scopes[self.cx.module];
        let builtin = self.registry.names(PRELUDE).map(|name| -> &str { name });
        let candidates = self.cx.names().chain(module.defs.keys().map(String::as_str)).chain(builtin);
        let near = closest(name, candidates).map(str::to_owned);
        self.report(with_suggestion(diagnostic, span, near.as_deref()));
    }

    /// A member of a module, as in `material.lambert`.
    pub(super) fn member(&mut self, module: usize, name: &ast::Ident) -> Option<Meaning> {
        let found = self.exported(module, &name.name);
        if found.is_none() {
            self.require_export(module, name);
        }
        found
    }
}

impl Def {
    pub fn is_import(&self) -> bool {
        matches!(self.kind, DefKind::Module(_) | DefKind::Import { .. })
    }
}

pub(super) fn with_suggestion(diagnostic: Diagnostic, span: Span, near: Option<&str>) -> Diagnostic {
    match near {
        Some(near) => {
            diagnostic.help(format!("did you mean `{near}`?")).suggest(span, near, Applicability::MaybeIncorrect)
        }
        None => diagnostic,
    }
}

/// The name that `import std.material` or `import "parts/wheel.arsl"` introduces.
fn implied_name(path: &ImportPath) -> Option<ast::Ident> {
    match path {
        ImportPath::Std { segments, .. } => segments.last().cloned(),
        ImportPath::File { path, span } => {
            let stem = path.rsplit('/').next().unwrap_or(path).trim_end_matches(".arsl");
            let is_name = !stem.is_empty()
                && stem.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
                && !stem.starts_with(|c: char| c.is_ascii_digit());
            is_name.then(|| ast::Ident { name: stem.to_owned(), span: *span })
        }
    }
}
