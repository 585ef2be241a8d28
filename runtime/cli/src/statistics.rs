//! `arsc render --stats`: what was built for tracing, and how fast it went.

use arsc_assembly::{Outcome, RenderReport};
use serde::Serialize;

use crate::progress::{count, percent, seconds};

#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Text,
    Json,
}

/// Of one render; times in seconds.
#[derive(Serialize)]
struct Statistics {
    csg: &'static str,
    solids: usize,
    instances: usize,
    surfaces: usize,
    primitives: usize,
    cells: usize,
    /// Mean over camera rays of the leaves and surfaces that were tested.
    tests_per_ray: Option<f64>,
    bytes: usize,
    bytes_per_primitive: f64,
    build_seconds: f64,
    build_milliseconds_per_primitive: f64,
    /// Lights and tables included.
    prepare_seconds: f64,
    render_seconds: f64,
    camera_paths: u64,
    /// Per pixel.
    fewest_samples: u32,
    most_samples: u32,
    /// Relative, of the picture.
    noise: Option<f64>,
    samples_per_second: f64,
}

impl Statistics {
    fn new(render: &RenderReport) -> Statistics {
        let scene = &render.scene;
        let build_seconds = scene.build_time.as_secs_f64();
        let each = |value: f64| value / (scene.primitives as f64).max(1.0);
        Statistics {
            csg: render.strategy.name(),
            solids: scene.solids,
            instances: scene.instances,
            surfaces: scene.surfaces,
            primitives: scene.primitives,
            cells: scene.cells,
            tests_per_ray: render.tests_per_ray,
            bytes: scene.bytes,
            bytes_per_primitive: each(scene.bytes as f64),
            build_seconds,
            build_milliseconds_per_primitive: each(1e3 * build_seconds),
            prepare_seconds: render.build_seconds,
            render_seconds: render.seconds,
            camera_paths: render.camera_paths,
            fewest_samples: render.samples.0,
            most_samples: render.samples.1,
            noise: render.noise,
            samples_per_second: render.camera_paths as f64 / render.seconds.max(1e-9),
        }
    }

    fn print(&self) {
        eprintln!("csg            {}", self.csg);
        eprintln!("solids         {} and {} instances", self.solids, self.instances);
        eprintln!("surfaces       {}", self.surfaces);
        eprintln!("primitives     {} in {} cells", self.primitives, self.cells);
        if let Some(tests) = self.tests_per_ray {
            eprintln!("tests          {tests:.2} per camera ray");
        }
        let (bytes, each) = (count(self.bytes as f64), count(self.bytes_per_primitive));
        eprintln!("memory         {bytes}B for tracing, {each}B per primitive");
        let each = self.build_milliseconds_per_primitive;
        eprintln!("build          {}, {each:.3} ms per primitive", short(self.build_seconds));
        eprintln!("prepare        {}, with lights and tables", short(self.prepare_seconds));
        eprintln!("render         {}", seconds(self.render_seconds));
        let (paths, rate) = (count(self.camera_paths as f64), count(self.samples_per_second));
        eprintln!("camera paths   {paths} ({rate} samples/s)");
        eprintln!("samples        {} to {} per pixel", self.fewest_samples, self.most_samples);
        if let Some(noise) = self.noise {
            eprintln!("noise          {}", percent(noise));
        }
    }
}

/// Milliseconds below a second.
pub fn short(s: f64) -> String {
    if s < 1.0 { format!("{:.1} ms", 1e3 * s) } else { seconds(s) }
}

/// Text goes to standard error, JSON (a list, one entry for each render) to standard output.
pub fn print(outcome: &Outcome, format: Format) {
    let all: Vec<Statistics> = outcome.renders.iter().map(Statistics::new).collect();
    match format {
        Format::Text => all.iter().for_each(Statistics::print),
        Format::Json => match serde_json::to_string_pretty(&all) {
            Ok(text) => println!("{text}"),
            Err(error) => eprintln!("error: {error}"),
        },
    }
}
