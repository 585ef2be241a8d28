//! Names, types and evaluation: from syntax trees to the IR.
//!
//! Two stages: *check* resolves names and types of every module without running anything; *evaluate* runs the
//! checked program under limits and collects the IR. Pure: text of data files arrives through [`Assets`].

mod actions;
mod check;
mod code;
mod data_files;
mod eval;
mod meshes;
mod reference;
mod registry;
mod types;
mod value;

pub use reference::reference;

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, SourceId, Span};
use arsc_geometry::TriangleMesh;
use arsc_ir::Ir;
use arsc_syntax::ast;

/// A parsed module whose imports have been found. Modules come dependencies first, the root script last.
pub struct Module {
    pub source: SourceId,
    /// `std.material`, or the path of the file.
    pub name: String,
    pub is_std: bool,
    pub ast: ast::Module,
    /// For each import item of the tree, in order: the index of its module, `None` if it could not be loaded (reported).
    pub imports: Vec<Option<usize>>,
}

/// Why a data file could not be had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AssetError {
    NotFound,
    NotText,
    TooLarge,
    Forbidden,
    /// It is there and is not what its format demands; the reason.
    Malformed(String),
    Other(String),
}

/// A mesh from a file.
#[derive(Clone, Debug)]
pub struct MeshFile {
    /// Relative to the root script's folder.
    pub path: Arc<str>,
    pub mesh: Arc<TriangleMesh>,
}

/// A data file as it is.
#[derive(Clone, Debug)]
pub struct DataFile {
    /// Relative to the root script's folder.
    pub path: Arc<str>,
    pub bytes: Arc<[u8]>,
}

/// Data files named in scripts, relative to the module that names them.
pub trait Assets {
    /// The text of a small table (a spectrum).
    fn text(&self, from: SourceId, path: &str) -> Result<Arc<str>, AssetError>;

    /// A triangle mesh. The same file gives the same mesh without being read again.
    fn mesh(&self, from: SourceId, path: &str) -> Result<MeshFile, AssetError>;

    /// The bytes of a file: an image, a grid of densities. Read anew each time.
    fn bytes(&self, _from: SourceId, _path: &str) -> Result<DataFile, AssetError> {
        Err(AssetError::NotFound)
    }
}

/// Ceilings on what a script may use. Exceeding one is a diagnostic.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Evaluation steps.
    pub steps: u64,
    /// Depth of function calls.
    pub recursion: usize,
    /// Nodes of the IR.
    pub nodes: usize,
    /// Elements of all lists and strings made.
    pub elements: u64,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits { steps: 100_000_000, recursion: 200, nodes: 2_000_000, elements: 10_000_000 }
    }
}

/// A value given to a `param` from outside. The driver has read it and reported its slips; its spans point into a
/// source of its own, named `--set samples`.
#[derive(Clone, Debug)]
pub struct Setting {
    pub name: String,
    pub value: ast::Expr,
}

/// What analysis is asked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `--set name=value`, in order; a later one wins.
    pub params: Vec<Setting>,
    pub limits: Limits,
    /// Check and do not evaluate: for a program that could not be read whole.
    pub check_only: bool,
}

/// What analysis gives.
pub struct Analysed {
    /// `None` when an error stopped it.
    pub ir: Option<Ir>,
    /// Errors and text lints; `allow` is not applied yet, but each lint's allowed regions are known to the driver.
    pub diagnostics: Vec<Diagnostic>,
}

/// Checks and evaluates a program. Dependencies come first in `modules`, the root script last.
///
/// Several errors are reported per run; evaluation starts only when checking found none. Recurses over the syntax
/// tree and over nested calls: callers give it a stack of 64 MiB.
pub fn analyse(modules: &[Module], assets: &dyn Assets, options: &Options) -> Analysed {
    let Some(root) = modules.last() else { return Analysed { ir: None, diagnostics: Vec::new() } };
    let check::Checked { program, settings, mut diagnostics } = check::check(modules, &options.params);
    if root.ast.items.is_empty() && !options.check_only {
        diagnostics.push(nothing_declared(root.source));
    }
    if options.check_only || diagnostics.iter().any(Diagnostic::is_error) {
        return Analysed { ir: None, diagnostics };
    }
    let mut machine = eval::Machine::new(&program, assets, &options.limits);
    let mut failures = machine.set_params(&settings);
    let ir = if failures.is_empty() {
        machine.build(root.ast.span).map_err(|more| failures.extend(more)).ok()
    } else {
        None
    };
    diagnostics.append(&mut machine.diagnostics);
    diagnostics.extend(failures);
    Analysed { ir, diagnostics }
}

fn nothing_declared(source: SourceId) -> Diagnostic {
    Diagnostic::new(codes::EMPTY_SCRIPT, "the script declares nothing")
        .label(Span::new(source, 0, 0), "no scene, no function, no value in this file")
        .help("begin with a scene: `scene { sphere() }`")
}
