//! `arsc bench`: how fast whole scenes are. Rays alone: [`crate::bench_rays`].

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;

use crate::args::SceneArgs;
use crate::check::LimitArgs;
use crate::compile::compile;
use crate::exit::Exit;
use crate::failure::failure;
use crate::host::Machine;
use crate::progress::count;
use crate::render::RenderSettings;
use crate::statistics::short;
use crate::{bench_rays, bug};

#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Table,
    Json,
}

/// Measures whole scenes: compiling, building, rays and samples per second; writes no pictures
#[derive(clap::Args, Debug)]
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
}

impl Args {
    pub fn scene_args(&self, scene: &Path) -> SceneArgs {
        SceneArgs { scene: scene.to_owned(), limits: self.limits.clone(), ..SceneArgs::default() }
    }
}

#[derive(Serialize)]
struct Line {
    scene: String,
    threads: usize,
    primitives: usize,
    cells: usize,
    bytes: usize,
    compile_seconds: f64,
    build_seconds: f64,
    camera_rays_per_second: f64,
    hit_share: f64,
    samples_per_second: f64,
}

pub fn run(args: &Args) -> Exit {
    if args.rays {
        return bench_rays::run(args);
    }
    if !(args.seconds.is_finite() && args.seconds >= 0.0) {
        eprintln!("error: --seconds wants a number that is not negative");
        return Exit::CouldNotRun;
    }
    let mut lines = Vec::new();
    for scene in &args.scenes {
        match measure(scene, args) {
            Ok(line) => lines.push(line),
            Err(exit) => return exit,
        }
    }
    match args.format {
        Format::Table => table(&lines),
        Format::Json => match serde_json::to_string_pretty(&lines) {
            Ok(text) => println!("{text}"),
            Err(error) => return failure(&error),
        },
    }
    Exit::Clean
}

fn measure(scene: &Path, args: &Args) -> Result<Line, Exit> {
    let start = Instant::now();
    let compiled = compile(&args.scene_args(scene), true)?;
    let compile_seconds = start.elapsed().as_secs_f64();
    bug::stage("bench");
    let machine = Machine::new(None, true);
    let settings = args.settings.to_settings();
    let measured = arsc_assembly::measure(&compiled.ir, &settings, &machine, args.seconds).map_err(|e| failure(&e))?;
    Ok(Line {
        scene: compiled.name,
        threads: measured.threads,
        primitives: measured.scene.primitives,
        cells: measured.scene.cells,
        bytes: measured.scene.bytes,
        compile_seconds,
        build_seconds: measured.build_seconds,
        camera_rays_per_second: measured.camera_rays_per_second,
        hit_share: measured.hit_share,
        samples_per_second: measured.samples_per_second,
    })
}

fn table(lines: &[Line]) {
    let header = ["scene", "primitives", "cells", "memory", "compile", "build", "camera rays/s", "hits", "samples/s"];
    let cells = |line: &Line| {
        [
            line.scene.clone(),
            line.primitives.to_string(),
            line.cells.to_string(),
            format!("{}B", count(line.bytes as f64)),
            short(line.compile_seconds),
            short(line.build_seconds),
            count(line.camera_rays_per_second),
            format!("{:.0} %", 100.0 * line.hit_share),
            count(line.samples_per_second),
        ]
    };
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    rows.extend(lines.iter().map(|line| cells(line).to_vec()));
    print_table(&rows);
    if let Some(line) = lines.first() {
        println!("{} threads", line.threads);
    }
}

/// Prints rows of equal length, the first column to the left.
pub fn print_table(rows: &[Vec<String>]) {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows.first().map_or(0, Vec::len)).map(width).collect();
    for row in rows {
        let mut text = format!("{:<1$}", row[0], widths[0]);
        for (cell, width) in row.iter().zip(&widths).skip(1) {
            text += &format!("  {cell:>width$}");
        }
        println!("{text}");
    }
}
