//! The `arsc` command: arguments, reporting, exit codes. No logic.
//!
//! Each subcommand is a module with an `Args` and a `run`. All files are reached through [`files`]; the compiler and the
//! renderer see traits. Work happens on a thread with a large stack, because compiler and CSG trees recurse; a panic
//! there is a bug of arsc, reported by [`bug`].

mod args;
mod bench;
mod bug;
mod check;
mod compile;
mod denoise;
mod diff;
mod exit;
mod explain;
mod failure;
mod files;
mod host;
mod image;
mod interrupt;
mod ir;
mod pictures;
mod polvis;
mod probe;
mod progress;
mod render;
mod report;
mod statistics;
mod tonemap;

use clap::{Parser, Subcommand};

use exit::Exit;

#[derive(Parser)]
#[command(name = "arsc", version, about = "Compiles and renders .arsl scene scripts", after_help = exit::HELP)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Checks scripts: syntax, types, limits, and lints of text, geometry and light
    Check(check::Args),
    /// Explains the code of a finding
    Explain(explain::Args),
    /// Prints the scene as the compiler sees it, between its passes
    Ir(ir::Args),
    Render(render::Args),
    Probe(probe::Args),
    Bench(bench::Args),
    Tonemap(tonemap::Args),
    Diff(diff::Args),
    Polvis(polvis::Args),
    Image(image::Args),
    Denoise(denoise::Args),
}

fn main() -> std::process::ExitCode {
    let cli = Cli::parse();
    let exit = bug::guarded(arsc_driver::STACK, move || run(cli));
    exit.into()
}

fn run(cli: Cli) -> Exit {
    match cli.command {
        Command::Check(args) => check::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Ir(args) => ir::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Probe(args) => probe::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Tonemap(args) => tonemap::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Polvis(args) => polvis::run(&args),
        Command::Image(args) => image::run(&args),
        Command::Denoise(args) => denoise::run(&args),
    }
}
