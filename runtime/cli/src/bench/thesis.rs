//! `arsc bench thesis`: the scenes of the thesis by its own ways of tracing CSG and by the default.
//!
//! Times are processor time of the whole process, so that other programs on the machine do not count; building is apart
//! from tracing. Compiling the script is in neither.

use std::path::PathBuf;

use arsc_assembly::Settings;
use arsc_ir::{Action, Ir, NodeId, NodeKind};
use serde::Serialize;

use super::processor::ProcessorClock;
use super::thesis_report;
use super::thesis_scenes::{SCENES, Stated, ThesisScene};
use crate::args::{self, SceneArgs};
use crate::compile::{compile, lower};
use crate::exit::Exit;
use crate::failure::failure;
use crate::host::Machine;
use crate::render::Csg;
use crate::{bug, progress};

#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Text,
    Csv,
    Json,
}

/// Measures the scenes of the thesis and prints its tables 4.1 to 4.5 with its own figures beside them
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Samples per pixel; the thesis took 128
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true)]
    samples: u32,

    /// Size of the pictures; the thesis' were 700x700
    #[arg(long, value_name = "WxH", default_value = "350x350", value_parser = args::resolution)]
    size: [u32; 2],

    /// Largest number of scattering events of a path
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    max_depth: u32,

    /// Threads [default: as many as the machine has]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// The folder of the scenes
    #[arg(long, value_name = "DIR", default_value = "scenes/gallery")]
    scenes: PathBuf,

    /// Only these figures, by how their numbers begin: 4.1a, 4.3
    #[arg(long, value_name = "FIGURE", value_delimiter = ',')]
    only: Vec<String>,

    /// Only these of the ways to trace CSG
    #[arg(long, value_enum, value_name = "CSG", value_delimiter = ',')]
    csg: Vec<Csg>,

    #[arg(long, value_enum, default_value = "text")]
    format: Format,

    /// Does not tell on standard error how it goes
    #[arg(short, long)]
    quiet: bool,
}

/// What was measured of one scene.
#[derive(Serialize)]
pub struct Row {
    pub figure: &'static str,
    pub table: u8,
    pub scene: String,
    /// Topmost CSG nodes, and these and primitives outside of them together.
    pub solids: usize,
    pub geometries: usize,
    pub runs: Vec<Run>,
    pub thesis: Vec<StatedRun>,
    /// Thousand camera paths per second of processor time that ART reached.
    pub art_paths: Option<f64>,
}

/// One render. Seconds are processor time.
#[derive(Serialize)]
pub struct Run {
    pub csg: &'static str,
    pub prepare_seconds: f64,
    pub trace_seconds: f64,
    pub camera_paths: u64,
}

/// Figures of the thesis, and the strategy of ours that works alike.
#[derive(Serialize)]
pub struct StatedRun {
    pub csg: &'static str,
    #[serde(flatten)]
    pub seconds: Stated,
}

impl Run {
    pub fn paths_per_second(&self) -> f64 {
        self.camera_paths as f64 / self.trace_seconds.max(1e-9)
    }
}

/// A scene that was not measured, and why.
#[derive(Serialize)]
pub struct Skipped {
    pub figure: &'static str,
    pub scene: String,
    pub why: String,
}

/// The whole record.
#[derive(Serialize)]
pub struct Record {
    pub samples: u32,
    pub size: [u32; 2],
    pub max_depth: u32,
    pub rows: Vec<Row>,
    pub skipped: Vec<Skipped>,
}

pub fn run(args: &Args) -> Exit {
    let mut record = Record {
        samples: args.samples,
        size: args.size,
        max_depth: args.max_depth,
        rows: Vec::new(),
        skipped: Vec::new(),
    };
    for scene in SCENES.iter().filter(|scene| args.wants(scene)) {
        if let Some(why) = args.missing(scene) {
            record.skipped.push(Skipped { figure: scene.figure, scene: title(scene), why });
            continue;
        }
        match measure(scene, args) {
            Ok(row) => record.rows.push(row),
            Err(exit) => return exit,
        }
    }
    if record.rows.is_empty() {
        eprintln!("error: none of the scenes is in {}", args.scenes.display());
        return Exit::CouldNotRun;
    }
    match args.format {
        Format::Text => print!("{}", thesis_report::text(&record)),
        Format::Csv => print!("{}", thesis_report::csv(&record)),
        Format::Json => return super::print_json(&record),
    }
    Exit::Clean
}

impl Args {
    fn wants(&self, scene: &ThesisScene) -> bool {
        self.only.is_empty() || self.only.iter().any(|figure| scene.figure.starts_with(figure.as_str()))
    }

    /// Why a scene cannot be measured.
    fn missing(&self, scene: &ThesisScene) -> Option<String> {
        if !self.scenes.join(format!("{}.arsl", scene.script)).exists() {
            return Some("the script is not there".into());
        }
        let mesh = scene.mesh.filter(|mesh| !self.scenes.join(mesh).exists())?;
        Some(format!("{mesh} is not there: meshes/fetch makes it"))
    }

    fn settings(&self) -> Settings {
        Settings {
            samples: Some(self.samples),
            max_depth: Some(self.max_depth),
            resolution: Some(self.size),
            threads: self.threads.map(usize::from),
            ..Settings::default()
        }
    }
}

/// The script, and what of it is set to a name.
fn title(scene: &ThesisScene) -> String {
    let values: Vec<&str> = scene.set.iter().map(|(_, value)| value.trim_matches('"')).collect();
    [&[scene.script], values.as_slice()].concat().join(" ")
}

fn measure(scene: &ThesisScene, args: &Args) -> Result<Row, Exit> {
    let set = scene.set.iter().map(|&(name, value)| (name.to_owned(), value.to_owned())).collect();
    let script = args.scenes.join(format!("{}.arsl", scene.script));
    let scene_args = SceneArgs { scene: script, set, ..SceneArgs::default() };
    let (solids, geometries) = topmost(&lower(&scene_args, true)?.ir);
    let mut ir = compile(&scene_args, true)?.ir;
    ir.actions.retain(|at| matches!(at.action, Action::PathTrace(_)));
    let wanted = |strategy: &arsc_accel::Strategy| {
        args.csg.is_empty() || args.csg.iter().any(|&csg| arsc_accel::Strategy::from(csg) == *strategy)
    };
    let mut runs = Vec::new();
    for strategy in scene.strategies().filter(wanted) {
        bug::stage("bench");
        let settings = Settings { strategy: Some(strategy), ..args.settings() };
        let clock = ProcessorClock(Machine::new(None, true));
        let outcome = arsc_assembly::run(&ir, &settings, &clock).map_err(|error| failure(&error))?;
        let Some(render) = outcome.renders.first() else { continue };
        let run = Run {
            csg: strategy.name(),
            prepare_seconds: render.build_seconds,
            trace_seconds: render.seconds,
            camera_paths: render.camera_paths,
        };
        if !args.quiet {
            let rate = progress::count(run.paths_per_second());
            eprintln!("{} {}, {}: {rate} paths per CPU second", scene.figure, title(scene), run.csg);
        }
        runs.push(run);
    }
    Ok(Row {
        figure: scene.figure,
        table: scene.table,
        scene: title(scene),
        solids,
        geometries,
        runs,
        thesis: scene.stated.iter().map(|&(csg, seconds)| StatedRun { csg: csg.name(), seconds }).collect(),
        art_paths: scene.art,
    })
}

/// Topmost CSG nodes of a scene before the optimiser, and these and free primitives together.
pub fn topmost(ir: &Ir) -> (usize, usize) {
    let (mut solids, mut geometries) = (0, 0);
    let mut open: Vec<NodeId> = ir.kind(ir.root).children().to_vec();
    while let Some(id) = open.pop() {
        match ir.kind(id) {
            NodeKind::Union(_) | NodeKind::Intersection(_) | NodeKind::Difference(_) => {
                solids += 1;
                geometries += 1;
            }
            NodeKind::Leaf(_) => geometries += 1,
            kind => open.extend(kind.children()),
        }
    }
    (solids, geometries)
}
