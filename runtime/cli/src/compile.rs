//! From a script on disk to an IR, with its diagnostics shown.

use std::sync::Arc;

use arsc_diagnostics::SourceMap;
use arsc_driver::{Compiled, LoadError, Loader, Options};
use arsc_ir::Ir;
use sha2::{Digest, Sha256};

use crate::args::SceneArgs;
use crate::bug;
use crate::exit::Exit;
use crate::files::{ScriptFolder, read_script};
use crate::report::{self, Findings};

/// A script that compiled.
pub struct Scene {
    pub ir: Ir,
    has_scene: bool,
    /// Where findings of later stages point.
    pub sources: SourceMap,
    /// The file's name without extension; `scene` for standard input.
    pub name: String,
    /// Of the texts of the script and its imports, and of `--set`: the first 128 bits of SHA-256 in hexadecimal.
    pub hash: String,
}

/// Compiles. What there is to say is printed on standard error; the exit says why there is no scene. A library is
/// nothing to render or to probe.
pub fn compile(args: &SceneArgs, quiet: bool) -> Result<Scene, Exit> {
    let scene = with(args, quiet, arsc_driver::compile)?;
    if scene.has_scene {
        return Ok(scene);
    }
    eprintln!("error: {} has no `scene {{ … }}`", shown(args));
    Err(Exit::CouldNotRun)
}

/// Goes only as far as the IR that the script describes, before the optimiser.
pub fn lower(args: &SceneArgs, quiet: bool) -> Result<Scene, Exit> {
    with(args, quiet, arsc_driver::lower)
}

type Stages = fn(&str, Arc<str>, &dyn Loader, &Options) -> Compiled;

fn with(args: &SceneArgs, quiet: bool, stages: Stages) -> Result<Scene, Exit> {
    bug::stage("compile");
    let shown = shown(args);
    let mut options = Options::default();
    options.settings.clone_from(&args.set);
    options.lint_levels = args.lints.levels();
    args.limits.apply(&mut options);
    let text = match read_script(&args.scene) {
        Ok(text) => text,
        Err(error) => return Err(unreadable(&shown, &error, &options)),
    };
    let folder = ScriptFolder::of(&args.scene, &args.allow_read).map_err(|error| {
        eprintln!("error: cannot use the folder of {shown}, or one given with --allow-read: {error}");
        Exit::CouldNotRun
    })?;
    let compiled = stages(&shown, text, &folder, &options);
    let hash = hash(&compiled, &args.set);
    if compiled.has_errors() || !quiet {
        report::human(Findings::from(&compiled));
    }
    let (has_errors, has_scene) = (compiled.has_errors(), compiled.has_scene);
    match compiled.ir {
        Some(ir) if !has_errors => Ok(Scene { ir, has_scene, sources: compiled.sources, name: name(args), hash }),
        _ => Err(Exit::Findings),
    }
}

/// What people know the script by.
fn shown(args: &SceneArgs) -> String {
    if args.scene.as_os_str() == "-" { "<stdin>".into() } else { args.scene.display().to_string() }
}

/// A script that is no text is the author's business, one that cannot be opened is not.
fn unreadable(shown: &str, error: &LoadError, options: &Options) -> Exit {
    match arsc_driver::unreadable(shown, error, options) {
        Some(compiled) => {
            report::human(Findings::from(&compiled));
            Exit::Findings
        }
        None => {
            eprintln!("error: cannot read {shown}: {}", words(error));
            Exit::CouldNotRun
        }
    }
}

fn name(args: &SceneArgs) -> String {
    match args.scene.file_stem() {
        Some(stem) if args.scene.as_os_str() != "-" => stem.to_string_lossy().into_owned(),
        _ => "scene".into(),
    }
}

fn hash(compiled: &Compiled, set: &[(String, String)]) -> String {
    let mut hasher = Sha256::new();
    let mut add = |text: &str| {
        hasher.update((text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    };
    compiled.sources.iter().for_each(|(_, file)| add(&file.text));
    for (name, value) in set {
        add(name);
        add(value);
    }
    hasher.finalize()[..16].iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Why a text could not be read, for people.
pub fn words(error: &LoadError) -> String {
    match error {
        LoadError::NotFound => "there is no such file".into(),
        LoadError::NotText(offset) => format!("it is not UTF-8 text (byte {offset})"),
        LoadError::TooLarge { bytes } => format!("it is too large ({bytes} bytes or more)"),
        LoadError::Forbidden => "it lies outside of what may be read (see --allow-read)".into(),
        LoadError::Malformed(text) | LoadError::Other(text) => text.clone(),
    }
}
