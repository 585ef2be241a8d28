//! Checking: names, types, arguments; lowering to [`crate::code`].
//!
//! Definitions are checked on demand, each once, so that their order in a module does not matter. An expression
//! that is wrong gets [`Type::Error`], which silences whatever follows from it.

mod args;
mod block;
mod call;
mod choice;
mod convert;
mod exhaustive;
mod expr;
mod function;
mod globals;
mod literal;
mod names;
mod operator;
mod pattern;
mod scope;
mod texture;
mod typeexpr;
mod units;
mod unused;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Code as DiagnosticCode, Diagnostic, Span};
use arsc_syntax::ast;

use crate::code::{Code, Entry, FnId, GlobalId, Program};
use crate::registry::Registry;
use crate::types::{Class, Type};
use crate::{Module, Setting};

pub use globals::Settings;

/// Code and its type.
struct Typed {
    code: Code,
    ty: Type,
}

impl Typed {
    fn new(code: Code, ty: Type) -> Typed {
        Typed { code, ty }
    }

    fn error() -> Typed {
        Typed { code: Code::Error, ty: Type::Error }
    }
}

/// Progress of a definition that is checked on demand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Progress {
    Unchecked,
    Running,
    Done,
}

/// The checker.
pub struct Checker<'a> {
    modules: &'a [Module],
    registry: &'static Registry,
    scopes: Vec<names::ModuleScope>,
    fns: Vec<function::FnState<'a>>,
    globals: Vec<globals::GlobalState<'a>>,
    types: Vec<typeexpr::TypeState<'a>>,
    cx: scope::Context,
    infer: Vec<(Option<Type>, Option<Class>)>,
    program: Program,
    diagnostics: Vec<Diagnostic>,
}

/// What checking gives.
pub struct Checked {
    pub program: Program,
    pub settings: Settings,
    pub diagnostics: Vec<Diagnostic>,
}

/// Checks all modules; the last is the root script.
pub fn check(modules: &[Module], settings: &[Setting]) -> Checked {
    let mut checker = Checker {
        modules,
        registry: Registry::get(),
        scopes: Vec::new(),
        fns: Vec::new(),
        globals: Vec::new(),
        types: Vec::new(),
        cx: scope::Context::new(0),
        infer: Vec::new(),
        program: Program::default(),
        diagnostics: Vec::new(),
    };
    checker.declare();
    for i in 0..checker.types.len() {
        checker.resolve_alias(i);
    }
    for i in 0..checker.fns.len() {
        checker.check_fn(FnId(i as u32));
    }
    for i in 0..checker.globals.len() {
        checker.check_global(GlobalId(i as u32));
    }
    checker.check_blocks();
    let settings = checker.check_settings(settings);
    checker.lint_unused_definitions();
    Checked { program: checker.program, settings, diagnostics: checker.diagnostics }
}

impl<'a> Checker<'a> {
    fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    fn error(&mut self, code: DiagnosticCode, message: impl Into<String>, span: Span, label: impl Into<String>) {
        self.report(Diagnostic::new(code, message).label(span, label));
    }

    fn is_std(&self, module: usize) -> bool {
        self.modules[module].is_std
    }

    /// Scene, camera and actions of the root; elsewhere they only serve to run the module by itself.
    fn check_blocks(&mut self) {
        let modules = self.modules;
        for (index, module) in modules.iter().enumerate() {
            let is_root = index + 1 == modules.len();
            let mut first: [Option<Span>; 3] = [None; 3];
            for item in &module.ast.items {
                let (slot, what) = match &item.kind {
                    ast::ItemKind::Scene(_) => (0, "scene"),
                    ast::ItemKind::Camera(_) => (1, "camera"),
                    ast::ItemKind::Actions(_) => (2, "action sequence"),
                    _ => continue,
                };
                if let Some(before) = first[slot] {
                    let message = format!("the script has two {what}s");
                    let diagnostic = Diagnostic::new(codes::DUPLICATE_BLOCK, message);
                    self.report(diagnostic.label(item.span, "the second").label(before, "the first"));
                    continue;
                }
                first[slot] = Some(item.span);
                let entry = self.block_item(index, item);
                if is_root {
                    match slot {
                        0 => self.program.scene = Some(entry),
                        1 => self.program.camera = Some(entry),
                        _ => self.program.actions = Some(entry),
                    }
                }
            }
        }
    }

    fn block_item(&mut self, module: usize, item: &'a ast::Item) -> Entry {
        self.entry(module, item.span, |checker| match &item.kind {
            ast::ItemKind::Scene(block) => checker.collect_block(block, block::Collects::Shapes),
            ast::ItemKind::Actions(block) => checker.collect_block(block, block::Collects::Actions),
            ast::ItemKind::Camera(expr) => checker.expect(expr, &Type::Camera),
            _ => Code::Error,
        })
    }

    /// Checks code that runs in a frame of its own.
    fn entry(&mut self, module: usize, span: Span, check: impl FnOnce(&mut Checker<'a>) -> Code) -> Entry {
        let outer = std::mem::replace(&mut self.cx, scope::Context::new(module));
        self.cx.push_frame();
        let code = check(self);
        let frame = self.pop_frame();
        self.cx = outer;
        Entry { code, slots: frame.slots as usize, span }
    }
}
