//! `arsc ir`: the scene between the stages of the compiler, as text.

use std::fmt::Write as _;
use std::io::Write as _;

use arsc_ir::Ir;
use arsc_opt::{Options, PASSES, PassReport, optimise_observed};

use crate::args::SceneArgs;
use crate::compile;
use crate::exit::Exit;
use crate::report::{self, Findings};

/// Of a column of the table.
const WIDTH: usize = 16;
/// The name of the stage before the first pass.
const SOURCE: &str = "source";

#[derive(clap::Args, Clone, Debug)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// Prints a table of the passes: counts before and after each, and the rewrites that fired
    #[arg(long)]
    passes: bool,

    /// Prints the IR as it is after this pass; `source` is before the first. May be repeated
    #[arg(long, value_name = "NAME", value_parser = stage)]
    pass: Vec<String>,

    /// Prints the IR before the first and after each pass
    #[arg(long, conflicts_with = "pass")]
    each: bool,

    /// Runs only the passes that lead to the renderer's normal form
    #[arg(long)]
    no_optimise: bool,
}

fn stage(name: &str) -> Result<String, String> {
    let names = || std::iter::once(SOURCE).chain(PASSES.iter().map(|pass| pass.name));
    if names().any(|known| known == name) {
        return Ok(name.to_string());
    }
    Err(format!("there is no such pass; they are {}", names().collect::<Vec<_>>().join(", ")))
}

pub fn run(args: &Args) -> Exit {
    let scene = match compile::lower(&args.scene, false) {
        Ok(scene) => scene,
        Err(exit) => return exit,
    };
    let mut out = String::new();
    let mut show = |name: &str, ir: &Ir| {
        if args.each || args.pass.iter().any(|wanted| wanted == name) {
            let _ = write!(out, "# {name}\n{ir}\n");
        }
    };
    show(SOURCE, &scene.ir);
    let options = Options { optimise: !args.no_optimise, lint: false, ..Options::default() };
    let optimised = optimise_observed(scene.ir, &options, &mut show);
    if !optimised.diagnostics.is_empty() {
        report::human(Findings { diagnostics: &optimised.diagnostics, sources: &scene.sources });
        return Exit::Findings;
    }
    if args.passes {
        out.push_str(&table(&optimised.passes));
    } else if !args.each && args.pass.is_empty() {
        let _ = write!(out, "{}", optimised.ir);
    }
    // A reader that has seen enough, such as `head`, is no error.
    let _ = std::io::stdout().write_all(out.as_bytes());
    Exit::Clean
}

/// One line a pass: nodes by kind after it, with the change where there is one; its rewrites below.
fn table(passes: &[PassReport]) -> String {
    let mut text = format!("{:<22}", "pass");
    let heads = ["nodes", "leaves", "union", "inters", "diff", "group", "transf", "attr", "light", "env", "depth"];
    for head in heads {
        let _ = write!(text, "{head:>WIDTH$}");
    }
    text.push('\n');
    if let Some(first) = passes.first() {
        let _ = write!(text, "{SOURCE:<22}");
        for count in columns(&first.before) {
            let _ = write!(text, "{count:>WIDTH$}");
        }
        text.push('\n');
    }
    for pass in passes {
        let _ = write!(text, "{:<22}", pass.name);
        for (before, after) in columns(&pass.before).into_iter().zip(columns(&pass.after)) {
            let change = after as i64 - before as i64;
            let cell = if change == 0 { after.to_string() } else { format!("{after} ({change:+})") };
            let _ = write!(text, "{cell:>WIDTH$}");
        }
        text.push('\n');
        for (rewrite, times) in &pass.rewrites {
            let _ = writeln!(text, "    {rewrite} × {times}");
        }
    }
    text
}

fn columns(counts: &arsc_opt::Counts) -> [usize; 11] {
    [
        counts.total(),
        counts.leaves,
        counts.unions,
        counts.intersections,
        counts.differences,
        counts.groups,
        counts.transforms,
        counts.attributes,
        counts.lights,
        counts.environments,
        counts.depth,
    ]
}
