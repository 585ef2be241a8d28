//! `arsc bench --rays`: primary and shadow rays alone, on one thread, in processor time.

use std::path::Path;

use arsc_assembly::{RayMeasurement, Sight, measure_rays};
use serde::Serialize;

use super::Args;
use super::processor::thread_seconds;
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
    csg: String,
    resolution: [u32; 2],
    primary_rays: usize,
    hits: u64,
    shadow_rays: u64,
    lit: u64,
    /// Processor time of each repetition.
    trace_seconds: Vec<f64>,
    /// Of the fastest repetition.
    rays_per_second: f64,
    tests_per_ray: f64,
    build_seconds: f64,
    primitives: usize,
    cells: usize,
    bytes: usize,
}

pub fn run(args: &Args) -> Exit {
    if args.sights.is_some() && args.scenes.len() > 1 {
        eprintln!("error: --sights takes one script");
        return Exit::CouldNotRun;
    }
    args.each(measure, rows)
}

fn measure(scene: &Path, args: &Args) -> Result<Line, Exit> {
    let compiled = compile(&args.scene_args(scene), true)?;
    bug::stage("bench");
    let machine = Machine::new(None, true);
    let settings = args.settings.to_settings();
    let measured =
        measure_rays(&compiled.ir, &settings, &machine, args.repeat, &thread_seconds).map_err(|e| failure(&e))?;
    if let Some(path) = &args.sights {
        arsc_image::write_whole(path, &grey_map(&measured)).map_err(|error| failure(&error))?;
    }
    Ok(Line {
        scene: compiled.name,
        csg: settings.strategy.unwrap_or_default().name().to_owned(),
        resolution: measured.resolution,
        primary_rays: measured.sights.len(),
        hits: measured.hits(),
        shadow_rays: measured.shadow_rays,
        lit: measured.lit(),
        rays_per_second: measured.rays() as f64 / measured.best_seconds(),
        tests_per_ray: measured.tests_per_ray,
        build_seconds: measured.scene.build_time.as_secs_f64(),
        primitives: measured.scene.primitives,
        cells: measured.scene.cells,
        bytes: measured.scene.bytes,
        trace_seconds: measured.seconds,
    })
}

/// Binary PGM: 0 nothing, 128 dark, 255 lit.
fn grey_map(measured: &RayMeasurement) -> Vec<u8> {
    let [width, height] = measured.resolution;
    let mut bytes = format!("P5\n{width} {height}\n255\n").into_bytes();
    bytes.extend(measured.sights.iter().map(|sight| match sight {
        Sight::Nothing => 0,
        Sight::Dark => 128,
        Sight::Lit => 255,
    }));
    bytes
}

fn rows(lines: &[Line]) -> Vec<Vec<String>> {
    let header = ["scene", "csg", "primitives", "cells", "memory", "build", "hits", "shadow rays", "lit", "tests/ray"];
    let header: Vec<String> = header.into_iter().chain(["CPU s", "rays/CPU-s"]).map(str::to_owned).collect();
    let cells = |line: &Line| {
        let best = line.trace_seconds.iter().copied().fold(f64::INFINITY, f64::min);
        vec![
            line.scene.clone(),
            line.csg.clone(),
            line.primitives.to_string(),
            line.cells.to_string(),
            format!("{}B", count(line.bytes as f64)),
            short(line.build_seconds),
            line.hits.to_string(),
            line.shadow_rays.to_string(),
            line.lit.to_string(),
            format!("{:.2}", line.tests_per_ray),
            short(best),
            count(line.rays_per_second),
        ]
    };
    std::iter::once(header).chain(lines.iter().map(cells)).collect()
}
