//! `arsc bench SCENE…`: how fast whole scenes are.

use std::path::Path;
use std::time::Instant;

use serde::Serialize;

use super::Args;
use crate::bug;
use crate::compile::compile;
use crate::exit::Exit;
use crate::failure::failure;
use crate::host::Machine;
use crate::progress::count;
use crate::statistics::short;

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
    args.each(measure, rows)
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

fn rows(lines: &[Line]) -> Vec<Vec<String>> {
    let header =
        ["scene", "primitives", "cells", "memory", "compile", "build", "camera rays/s", "hits", "samples/s", "threads"];
    let cells = |line: &Line| {
        vec![
            line.scene.clone(),
            line.primitives.to_string(),
            line.cells.to_string(),
            format!("{}B", count(line.bytes as f64)),
            short(line.compile_seconds),
            short(line.build_seconds),
            count(line.camera_rays_per_second),
            format!("{:.0} %", 100.0 * line.hit_share),
            count(line.samples_per_second),
            line.threads.to_string(),
        ]
    };
    std::iter::once(header.map(str::to_owned).to_vec()).chain(lines.iter().map(cells)).collect()
}
