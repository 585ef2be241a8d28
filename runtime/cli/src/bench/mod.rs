//! `arsc bench`: how fast whole scenes are ([`scenes`]), rays alone ([`rays`]), and the scenes of the thesis ([`thesis`]).

mod processor;
mod rays;
mod scenes;
mod thesis;
mod thesis_report;
mod thesis_scenes;

use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::args::SceneArgs;
use crate::check::LimitArgs;
use crate::exit::Exit;
use crate::failure::failure;
use crate::render::RenderSettings;

#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Table,
    Json,
}

/// Measures whole scenes: compiling, building, rays and samples per second; writes no pictures
#[derive(clap::Args, Debug)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Args {
    /// The scripts
    #[arg(required = true)]
    pub scenes: Vec<PathBuf>,

    /// Seconds of rays, and as many of paths, for each scene
    #[arg(long, value_name = "S", default_value_t = 2.0)]
    seconds: f64,

    /// Only rays, on one thread, in processor time: one through every pixel, one from each hit to the first point light
    #[arg(long)]
    rays: bool,

    /// With --rays: how often; the fastest counts
    #[arg(long, value_name = "N", default_value_t = 3, requires = "rays")]
    pub repeat: u32,

    /// With --rays: writes what each pixel sees as a PGM picture: 0 nothing, 128 dark, 255 lit
    #[arg(long, value_name = "FILE", requires = "rays")]
    pub sights: Option<PathBuf>,

    #[arg(long, value_enum, default_value = "table")]
    pub format: Format,

    #[command(flatten)]
    limits: LimitArgs,

    #[command(flatten)]
    pub settings: RenderSettings,

    #[command(subcommand)]
    what: Option<What>,
}

#[derive(clap::Subcommand, Debug)]
enum What {
    Thesis(thesis::Args),
}

impl Args {
    pub fn scene_args(&self, scene: &Path) -> SceneArgs {
        SceneArgs { scene: scene.to_owned(), limits: self.limits.clone(), ..SceneArgs::default() }
    }

    /// Measures every script, and prints all lines at the end.
    fn each<L: Serialize>(
        &self,
        measure: impl Fn(&Path, &Args) -> Result<L, Exit>,
        rows: impl Fn(&[L]) -> Vec<Vec<String>>,
    ) -> Exit {
        let lines: Result<Vec<L>, Exit> = self.scenes.iter().map(|scene| measure(scene, self)).collect();
        match lines {
            Err(exit) => exit,
            Ok(lines) if self.format == Format::Json => print_json(&lines),
            Ok(lines) => {
                print!("{}", aligned(&rows(&lines)));
                Exit::Clean
            }
        }
    }
}

pub fn run(args: &Args) -> Exit {
    match &args.what {
        Some(What::Thesis(args)) => thesis::run(args),
        None if args.rays => rays::run(args),
        None => scenes::run(args),
    }
}

fn print_json<T: Serialize>(value: &T) -> Exit {
    match serde_json::to_string_pretty(value) {
        Ok(text) => {
            println!("{text}");
            Exit::Clean
        }
        Err(error) => failure(&error),
    }
}

/// Rows of equal length as lines of text, the first column to the left.
fn aligned(rows: &[Vec<String>]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows.first().map_or(0, Vec::len)).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = format!("{:<1$}", row[0], widths[0]);
        for (cell, width) in row.iter().zip(&widths).skip(1) {
            line += &format!("  {cell:>width$}");
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}
