//! The compiler as a library: sources in, IR and diagnostics out. Free of IO; text arrives through [`Loader`].
//!
//! [`lower`] goes as far as the IR that the script describes, [`compile`] as far as the normal form that the renderer
//! takes. Both recurse over syntax trees up to [`arsc_syntax::MAX_DEPTH`] deep and over the script's own calls: call
//! them on a thread with a stack of [`STACK`] bytes.

mod assets;
mod graph;
pub mod levels;
mod loader;
mod paths;
pub mod stdlib;

pub use loader::{LoadError, Loader};

use std::collections::BTreeSet;
use std::sync::Arc;

use arsc_diagnostics::{Diagnostic, Severity, SourceFile, SourceId, SourceMap, codes};
use arsc_ir::Ir;
use arsc_sema::{Module, Setting};
use arsc_syntax::ast::{Item, ItemKind};

/// The stack that a compilation needs at its limits, in bytes.
pub const STACK: usize = 512 << 20;

/// What a compilation is asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// `--set name=value`, in order; a later one wins. The value is an expression of the language.
    pub settings: Vec<(String, String)>,
    pub limits: arsc_sema::Limits,
    /// Depth of imports.
    pub include_depth: usize,
    /// Bytes of one source text.
    pub source_bytes: usize,
    /// `--allow/--warn/--deny` by code or lint name, or [`levels::ALL_LINTS`]; later wins.
    pub lint_levels: Vec<(String, Severity)>,
    pub optimise: bool,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            settings: Vec::new(),
            limits: arsc_sema::Limits::default(),
            include_depth: 64,
            source_bytes: 16 << 20,
            lint_levels: Vec::new(),
            optimise: true,
        }
    }
}

/// What came out.
pub struct Compiled {
    /// `None` when an error stopped it.
    pub ir: Option<Ir>,
    /// The root script has a scene of its own; else it is a library.
    pub has_scene: bool,
    /// Sorted by source and position; lint levels and `allow` applied.
    pub diagnostics: Vec<Diagnostic>,
    pub sources: SourceMap,
    /// What each optimiser pass did, in order.
    pub passes: Vec<arsc_opt::PassReport>,
}

impl Compiled {
    pub fn has_errors(&self) -> bool {
        has_errors(&self.diagnostics)
    }
}

fn has_errors(diagnostics: &[Diagnostic]) -> bool {
    diagnostics.iter().any(Diagnostic::is_error)
}

/// From the root script to the renderer's normal form, with the lints of text, geometry and light. `name` is what
/// people know the script by; paths that it imports are relative to its folder, which is the loader's root.
pub fn compile(name: &str, text: Arc<str>, loader: &dyn Loader, options: &Options) -> Compiled {
    let mut front = Front::new(name, text, loader, options);
    let mut passes = Vec::new();
    if let Some(ir) = front.ir.take() {
        let opt = arsc_opt::Options { optimise: options.optimise, ..arsc_opt::Options::default() };
        let optimised = arsc_opt::optimise(ir, &opt);
        let failed = has_errors(&optimised.diagnostics);
        front.diagnostics.extend(optimised.diagnostics);
        passes = optimised.passes;
        front.ir = (!failed).then_some(optimised.ir);
    }
    front.finish(options, passes)
}

/// From the root script to the IR as the script describes it, before the optimiser.
pub fn lower(name: &str, text: Arc<str>, loader: &dyn Loader, options: &Options) -> Compiled {
    Front::new(name, text, loader, options).finish(options, Vec::new())
}

/// The outcome for a root script that is no text or too large; `None` for other errors, which are the environment's.
pub fn unreadable(name: &str, error: &LoadError, options: &Options) -> Option<Compiled> {
    let diagnostic = match error {
        LoadError::NotText(offset) => {
            Diagnostic::new(codes::syntax::NOT_TEXT, format!("the script `{name}` is not text"))
                .help(format!("byte {offset} is not UTF-8: a scene script is plain UTF-8 text"))
        }
        LoadError::TooLarge { bytes } => graph::too_large(name, *bytes, options.source_bytes),
        LoadError::NotFound | LoadError::Forbidden | LoadError::Malformed(_) | LoadError::Other(_) => return None,
    };
    let mut sources = SourceMap::default();
    sources.add(SourceFile::new(name, ""));
    Some(Compiled { ir: None, has_scene: false, diagnostics: vec![diagnostic], sources, passes: Vec::new() })
}

/// Everything before the optimiser.
struct Front {
    ir: Option<Ir>,
    sources: SourceMap,
    modules: Vec<Module>,
    diagnostics: Vec<Diagnostic>,
}

impl Front {
    fn new(name: &str, text: Arc<str>, loader: &dyn Loader, options: &Options) -> Front {
        let mut graph = graph::load(name, text, loader, options);
        let params = read_settings(&options.settings, &mut graph.sources, &mut graph.diagnostics);
        let mut ir = None;
        let mut diagnostics = graph.diagnostics;
        if !graph.modules.is_empty() {
            let assets = assets::LoaderAssets {
                loader,
                origins: &graph.origins,
                limit: options.source_bytes,
                meshes: Default::default(),
            };
            let sema =
                arsc_sema::Options { params, limits: options.limits.clone(), check_only: has_errors(&diagnostics) };
            let analysed = arsc_sema::analyse(&graph.modules, &assets, &sema);
            let caused = Caused::by(&diagnostics, &graph.sources);
            diagnostics.extend(analysed.diagnostics.into_iter().filter(|d| !caused.explains(d, &graph.sources)));
            ir = analysed.ir.filter(|_| !has_errors(&diagnostics));
        }
        Front { ir, sources: graph.sources, modules: graph.modules, diagnostics }
    }

    fn finish(self, options: &Options, passes: Vec<arsc_opt::PassReport>) -> Compiled {
        let mut diagnostics = levels::apply(self.diagnostics, &self.modules, &options.lint_levels);
        let place = |d: &Diagnostic| d.primary_span().map_or((SourceId(0), 0, 0), |s| (s.source, s.start, s.end));
        diagnostics.sort_by(|a, b| (place(a), a.code.id()).cmp(&(place(b), b.code.id())));
        diagnostics.dedup();
        let is_scene = |item: &Item| matches!(item.kind, ItemKind::Scene(_));
        let has_scene = self.modules.last().is_some_and(|root| root.ast.items.iter().any(is_scene));
        Compiled { ir: self.ir, has_scene, diagnostics, sources: self.sources, passes }
    }
}

/// What errors of the text and of modules make of what comes after them: one finding for each cause is enough.
struct Caused {
    /// Lines with an error: what else is wrong there may be its consequence.
    lines: BTreeSet<(SourceId, usize)>,
    /// Something is missing, so that what seems unused may not be.
    is_partial: bool,
}

impl Caused {
    fn by(diagnostics: &[Diagnostic], sources: &SourceMap) -> Caused {
        let lines = diagnostics.iter().filter_map(|diagnostic| line(diagnostic, sources)).collect();
        Caused { lines, is_partial: has_errors(diagnostics) }
    }

    fn explains(&self, diagnostic: &Diagnostic, sources: &SourceMap) -> bool {
        self.is_partial && diagnostic.code.is_lint()
            || line(diagnostic, sources).is_some_and(|line| self.lines.contains(&line))
    }
}

fn line(diagnostic: &Diagnostic, sources: &SourceMap) -> Option<(SourceId, usize)> {
    let span = diagnostic.primary_span()?;
    Some((span.source, sources.get(span.source).line_column(span.start).line))
}

/// Gives each `--set` a source of its own and reads its value.
fn read_settings(
    settings: &[(String, String)],
    sources: &mut SourceMap,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Setting> {
    let mut read = Vec::new();
    for (name, text) in settings {
        let source = sources.add(SourceFile::new(format!("--set {name}"), text.as_str()));
        let (value, found) = arsc_syntax::parse_expr(source, text);
        diagnostics.extend(found);
        read.push(Setting { name: name.clone(), value });
    }
    read
}
