//! `arsc check`: everything that can be said about scripts without rendering them.

use std::path::{Path, PathBuf};

use arsc_diagnostics::Severity;
use arsc_driver::levels::{self, ALL_LINTS, UnknownLint};
use arsc_driver::{Compiled, Options};

use crate::compile::words;
use crate::exit::Exit;
use crate::files::{self, ScriptFolder};
use crate::report::{self, Findings, Format, Style, Totals};

/// Which findings are reported, and how seriously.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct LintArgs {
    /// Does not report a lint; `warnings` names all of them. A lint's own name counts before `warnings`, allow before
    /// warn, warn before deny
    #[arg(long, value_name = "LINT", value_parser = lint)]
    pub allow: Vec<String>,

    /// Reports a lint as a warning
    #[arg(long, value_name = "LINT", value_parser = lint)]
    pub warn: Vec<String>,

    /// Reports a lint as an error
    #[arg(long, value_name = "LINT", value_parser = lint)]
    pub deny: Vec<String>,
}

impl LintArgs {
    /// In the order that the driver wants: later wins.
    pub fn levels(&self) -> Vec<(String, Severity)> {
        let kinds = [(&self.deny, Severity::Error), (&self.warn, Severity::Warning), (&self.allow, Severity::Allow)];
        let all = kinds.iter().flat_map(|(names, severity)| names.iter().map(|name| (name.clone(), *severity)));
        let (general, own): (Vec<_>, Vec<_>) = all.partition(|(name, _)| name == ALL_LINTS);
        general.into_iter().chain(own).collect()
    }
}

/// The name of a lint.
fn lint(name: &str) -> Result<String, String> {
    match levels::lint(name) {
        Ok(_) => Ok(name.to_string()),
        Err(UnknownLint::Meant(meant)) => Err(format!("there is no such lint; did you mean `{meant}`?")),
        Err(UnknownLint::IsError) => Err("this is an error, and errors have no level".to_string()),
        Err(UnknownLint::Nothing) => Err("there is no such lint; `arsc explain` lists them".to_string()),
    }
}

/// What a script may use. The defaults are generous; exceeding one is a finding.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct LimitArgs {
    /// Steps of evaluation
    #[arg(long, value_name = "N")]
    pub max_steps: Option<u64>,

    /// Depth of function calls
    #[arg(long, value_name = "N")]
    pub max_recursion: Option<usize>,

    /// Nodes of the scene
    #[arg(long, value_name = "N")]
    pub max_nodes: Option<usize>,

    /// Elements of all lists and strings
    #[arg(long, value_name = "N")]
    pub max_elements: Option<u64>,

    /// Depth of imports
    #[arg(long, value_name = "N")]
    pub max_imports: Option<usize>,
}

impl LimitArgs {
    /// Sets those that were given.
    pub fn apply(&self, options: &mut Options) {
        let limits = &mut options.limits;
        limits.steps = self.max_steps.unwrap_or(limits.steps);
        limits.recursion = self.max_recursion.unwrap_or(limits.recursion);
        limits.nodes = self.max_nodes.unwrap_or(limits.nodes);
        limits.elements = self.max_elements.unwrap_or(limits.elements);
        options.include_depth = self.max_imports.unwrap_or(options.include_depth);
    }
}

#[derive(clap::Args, Debug)]
pub struct Args {
    /// The scripts, or `-` for standard input
    #[arg(required = true)]
    scenes: Vec<PathBuf>,

    /// How findings are written
    #[arg(long, value_enum, default_value_t)]
    format: Format,

    /// Sets a `param` of the scripts; the value is an expression such as 512, 45deg or "text"
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = crate::args::assignment)]
    set: Vec<(String, String)>,

    /// Lets the scripts read files below DIR too, besides their own folders
    #[arg(long, value_name = "DIR")]
    allow_read: Vec<PathBuf>,

    #[command(flatten)]
    lints: LintArgs,

    #[command(flatten)]
    limits: LimitArgs,
}

pub fn run(args: &Args) -> Exit {
    let mut options = Options { settings: args.set.clone(), lint_levels: args.lints.levels(), ..Options::default() };
    args.limits.apply(&mut options);
    let mut all = Vec::new();
    let mut could_run = true;
    for scene in &args.scenes {
        match check(scene, &args.allow_read, &options) {
            Ok(findings) => all.push(findings),
            Err(reason) => {
                eprintln!("error: cannot read {}: {reason}", scene.display());
                could_run = false;
            }
        }
    }
    let stdout = std::io::stdout();
    let style = Style::of(&stdout);
    let all: Vec<Findings> = all.iter().map(Findings::from).collect();
    if let Err(error) = report::write(&mut stdout.lock(), args.format, &style, &all)
        && error.kind() != std::io::ErrorKind::BrokenPipe
    {
        eprintln!("error: cannot write the findings: {error}");
        could_run = false;
    }
    match (could_run, Totals::of(&all).is_clean()) {
        (false, _) => Exit::CouldNotRun,
        (true, false) => Exit::Findings,
        (true, true) => Exit::Clean,
    }
}

/// The findings of one script, or why it cannot be read at all.
fn check(scene: &Path, allow_read: &[PathBuf], options: &Options) -> Result<Compiled, String> {
    let name = shown_name(scene);
    let text = match files::read_script(scene) {
        Ok(text) => text,
        Err(error) => {
            let compiled = arsc_driver::unreadable(&name, &error, options);
            return compiled.ok_or_else(|| words(&error));
        }
    };
    let folder = ScriptFolder::of(scene, allow_read).map_err(|error| error.to_string())?;
    Ok(arsc_driver::compile(&name, text, &folder, options))
}

/// What a script is called in findings.
fn shown_name(scene: &Path) -> String {
    if scene == Path::new("-") { "<stdin>".to_string() } else { scene.display().to_string() }
}
