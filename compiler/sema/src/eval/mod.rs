//! Evaluation of the checked program under limits, building the IR.
//!
//! Pure and deterministic: values are immutable, the only state are the tables of the IR and the collectors of
//! `scene` and `actions` blocks. Every failure is a diagnostic at the place where it happened, with the calls
//! that led there as further labels.

mod call;
mod code;
mod collect;
mod lints;
mod operator;
mod params;
mod pattern;
mod tables;
mod texture;

use std::sync::Arc;

use rustc_hash::FxHashMap;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Code as DiagnosticCode, Diagnostic, SourceId, Span};
use arsc_geometry::DAffine3;
use arsc_ir::{Bsdf, Emitter, Leaf, Medium, Node, NodeId, NodeKind, Shape, Surface};
use arsc_spectral::{MerlBrdf, Raster};
use arsc_texture::ExpressionGraph;

use crate::code::{GlobalId, Program, Site};
use crate::meshes::ClosedOutcome;
use crate::value::{Closure, Value};
use crate::{Assets, Limits};

pub use call::default_value;
pub use operator::{add_values, finite, scale_value};
pub use tables::Table;
pub use texture::{Color, Texture, is_varying};

/// A value, or what went wrong.
pub type Eval<T = Value> = Result<T, Box<Diagnostic>>;

impl Site {
    /// A failure of the call as a whole.
    pub fn fail(&self, code: DiagnosticCode, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, message).label(self.span, "in this call")
    }

    /// A failure because of one argument.
    pub fn fail_arg(
        &self,
        arg: usize,
        code: DiagnosticCode,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Box<Diagnostic> {
        Box::new(Diagnostic::new(code, message).label(self.args[arg], label))
    }
}

enum GlobalState {
    Unknown,
    Running,
    Known(Value),
}

/// How deep expressions may nest at run time, calls included: bounds the native stack.
const MAX_DEPTH: usize = 20_000;

/// The evaluator.
pub struct Machine<'a> {
    program: &'a Program,
    pub assets: &'a dyn Assets,
    limits: &'a Limits,
    /// Values given by `--set`, by global.
    overrides: FxHashMap<GlobalId, Value>,
    globals: Vec<GlobalState>,
    stack: Vec<Value>,
    base: usize,
    closure: Option<std::sync::Arc<Closure>>,
    calls: usize,
    depth: usize,
    steps: u64,
    elements: u64,
    /// The call in the user's text that led into a std module.
    std_caller: Option<Span>,
    in_std: bool,
    collected: Vec<Value>,
    tables: FxHashMap<(SourceId, String), Arc<Table>>,
    pub(crate) pictures: FxHashMap<(SourceId, String), (Arc<str>, Arc<Raster>)>,
    pub(crate) brdfs: FxHashMap<(SourceId, String), (Arc<str>, Arc<MerlBrdf>)>,
    /// By path.
    pub(crate) closed_meshes: FxHashMap<Arc<str>, ClosedOutcome>,
    /// What varies over surfaces.
    pub expressions: ExpressionGraph,
    pub nodes: Vec<Node>,
    pub bsdfs: Vec<Bsdf>,
    pub emitters: Vec<Emitter>,
    pub media: Vec<Medium>,
    /// Lints found on the way.
    pub diagnostics: Vec<Diagnostic>,
}

impl<'a> Machine<'a> {
    pub fn new(program: &'a Program, assets: &'a dyn Assets, limits: &'a Limits) -> Machine<'a> {
        Machine {
            program,
            assets,
            limits,
            overrides: FxHashMap::default(),
            globals: program.globals.iter().map(|_| GlobalState::Unknown).collect(),
            stack: Vec::new(),
            base: 0,
            closure: None,
            calls: 0,
            depth: 0,
            steps: 0,
            elements: 0,
            std_caller: None,
            in_std: false,
            collected: Vec::new(),
            tables: FxHashMap::default(),
            pictures: FxHashMap::default(),
            brdfs: FxHashMap::default(),
            closed_meshes: FxHashMap::default(),
            expressions: ExpressionGraph::default(),
            nodes: Vec::new(),
            bsdfs: Vec::new(),
            emitters: Vec::new(),
            media: Vec::new(),
            diagnostics: Vec::new(),
        }
    }

    /// Counts one step.
    #[inline]
    fn step(&mut self, span: Span) -> Eval<()> {
        self.steps += 1;
        if self.steps > self.limits.steps {
            return Err(limit(span, "evaluation steps", self.limits.steps, "does this loop or recursion end?"));
        }
        Ok(())
    }

    /// Accounts for `count` elements of lists or strings before they are made.
    pub fn spend_elements(&mut self, count: usize, span: Span) -> Eval<()> {
        self.elements = self.elements.saturating_add(count as u64);
        self.steps = self.steps.saturating_add(count as u64 / 8);
        if self.elements > self.limits.elements {
            return Err(limit(span, "elements of lists", self.limits.elements, "make fewer or shorter lists"));
        }
        Ok(())
    }

    /// Appends a node; `span` is the expression that makes it, replaced by the user's call when in a std module.
    pub fn node(&mut self, kind: NodeKind, span: Span) -> Eval<NodeId> {
        if self.nodes.len() >= self.limits.nodes {
            return Err(limit(span, "nodes of the scene", self.limits.nodes as u64, "make fewer shapes"));
        }
        let origin = self.std_caller.unwrap_or(span);
        self.nodes.push(Node { kind, origin });
        Ok(NodeId(self.nodes.len() as u32 - 1))
    }

    pub fn solid(&mut self, shape: Shape, parent_from_object: DAffine3, site: &Site) -> Eval {
        if !parent_from_object.is_finite() {
            return Err(Box::new(site.fail(codes::ARITHMETIC, "the placement of this solid is not finite")));
        }
        let leaf = Leaf::Solid { shape, parent_from_object, material: None };
        self.node(NodeKind::Leaf(Box::new(leaf)), site.span).map(Value::Node)
    }

    pub fn surface(&mut self, surface: Surface, site: &Site) -> Eval {
        let leaf = Leaf::Surface { surface, parent_from_object: DAffine3::IDENTITY, material: None };
        self.node(NodeKind::Leaf(Box::new(leaf)), site.span).map(Value::Node)
    }

    /// Interns a bsdf against the last few: loops make the same one again and again.
    pub fn bsdf(&mut self, bsdf: Bsdf) -> u32 {
        intern(&mut self.bsdfs, bsdf)
    }

    pub fn emitter(&mut self, emitter: Emitter) -> u32 {
        intern(&mut self.emitters, emitter)
    }

    pub fn medium(&mut self, medium: Medium) -> u32 {
        intern(&mut self.media, medium)
    }
}

/// How many of the latest entries are compared.
const INTERN_WINDOW: usize = 16;

fn intern<T: PartialEq>(table: &mut Vec<T>, new: T) -> u32 {
    let first = table.len().saturating_sub(INTERN_WINDOW);
    if let Some(i) = table[first..].iter().rposition(|old| *old == new) {
        return (first + i) as u32;
    }
    table.push(new);
    table.len() as u32 - 1
}

fn limit(span: Span, what: &str, value: u64, help: &str) -> Box<Diagnostic> {
    let message = format!("the script exceeds the limit of {value} {what}");
    Box::new(Diagnostic::new(codes::LIMIT, message).label(span, "exceeded here").help(help))
}
