//! `arsc bench`: how fast whole scenes are.

use std::path::PathBuf;
use std::time::Instant;

use serde::Serialize;

use crate::args::SceneArgs;
use crate::bug;
use crate::compile::compile;
use crate::exit::Exit;
use crate::failure::failure;
use crate::host::Machine;
use crate::progress::{count, seconds};
use crate::render::RenderSettings;

#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Table,
    Json,
}

/// Measures whole scenes: compiling, building, rays and samples per second; writes no pictures
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The scripts
    #[arg(required = true)]
    scenes: Vec<PathBuf>,

    /// Seconds of rays, and as many of paths, for each scene
    #[arg(long, value_name = "S", default_value_t = 2.0)]
    seconds: f64,

    #[arg(long, value_enum, default_value = "table")]
    format: Format,

    #[command(flatten)]
    settings: RenderSettings,
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

fn measure(scene: &std::path::Path, args: &Args) -> Result<Line, Exit> {
    let start = Instant::now();
    let arguments = SceneArgs { scene: scene.to_owned(), ..SceneArgs::default() };
    let compiled = compile(&arguments, true)?;
    let compile_seconds = start.elapsed().as_secs_f64();
    bug::stage("bench");
    let machine = Machine::new(&compiled.folder, None, true);
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
    let mut rows = vec![header.map(str::to_owned)];
    rows.extend(lines.iter().map(cells));
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    for row in &rows {
        let mut text = format!("{:<1$}", row[0], widths[0]);
        for (cell, width) in row.iter().zip(&widths).skip(1) {
            text += &format!("  {cell:>width$}");
        }
        println!("{text}");
    }
    if let Some(line) = lines.first() {
        println!("{} threads", line.threads);
    }
}

/// Milliseconds below a second.
fn short(s: f64) -> String {
    if s < 1.0 { format!("{:.1} ms", 1e3 * s) } else { seconds(s) }
}
