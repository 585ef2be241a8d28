//! `arsc render`: runs a script's action sequence.

use std::path::{Path, PathBuf};

use arsc_assembly::{Outcome, RenderReport, Settings};
use arsc_ir::{Action, Ir};

use crate::args::{self, SceneArgs};
use crate::compile::{Scene, compile};
use crate::exit::Exit;
use crate::failure::failure;
use crate::files::{Output, ScriptFolder};
use crate::host::Machine;
use crate::progress::{percent, seconds};
use crate::{bug, interrupt, statistics};

/// How CSG is traced; all give the same picture.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Csg {
    /// Cells with simplified trees as Embree primitives (the default)
    Local,
    /// One KD tree over all leaves of the scene, no Embree; whole trees at the end of the ray
    Native,
    /// Embree finds the leaves along the ray; whole trees afterwards
    Collect,
    /// Each solid an Embree primitive: its operator tree with bounding boxes
    Tree,
    /// Each solid an Embree primitive: a KD tree over its leaves
    Kd,
    /// `kd` for solids with mesh operands, `tree` for the others
    Hybrid,
    /// As `kd`, but only what changes along the ray is evaluated
    Incremental,
}

impl From<Csg> for arsc_accel::Strategy {
    fn from(csg: Csg) -> arsc_accel::Strategy {
        match csg {
            Csg::Local => arsc_accel::Strategy::Local,
            Csg::Native => arsc_accel::Strategy::Native,
            Csg::Collect => arsc_accel::Strategy::Collect,
            Csg::Tree => arsc_accel::Strategy::Tree,
            Csg::Kd => arsc_accel::Strategy::Kd,
            Csg::Hybrid => arsc_accel::Strategy::Hybrid,
            Csg::Incremental => arsc_accel::Strategy::Incremental,
        }
    }
}

/// Values that override the script's.
#[derive(clap::Args, Clone, Debug)]
pub struct RenderSettings {
    /// Threads [default: as many as the machine has]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub threads: Option<u16>,

    /// Samples per pixel; with --noise or --time, at most
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true)]
    pub samples: Option<u32>,

    /// Goes on until the relative noise of pixels is this, such as 0.01 or 1%; quiet parts get fewer samples
    #[arg(long, value_name = "SHARE", value_parser = args::noise, allow_hyphen_values = true)]
    pub noise: Option<f64>,

    /// Ends each render after this time, such as 60s or 5min; the picture then depends on the machine
    #[arg(long, value_name = "TIME", value_parser = args::duration, allow_hyphen_values = true)]
    pub time: Option<f64>,

    /// Largest number of scattering events of a path
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_536), allow_negative_numbers = true)]
    pub max_depth: Option<u32>,

    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", value_parser = args::resolution)]
    pub resolution: Option<[u32; 2]>,

    /// Renders only these pixels, from the upper left corner, the end excluded; the rest stays black
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = args::crop, allow_hyphen_values = true)]
    pub crop: Option<[u32; 4]>,

    /// Seed of all random numbers
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// How CSG is traced
    #[arg(long, value_enum)]
    pub csg: Option<Csg>,

    /// Most cells for all solids together: with fewer the picture is the same, and slower
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub max_cells: Option<usize>,

    /// Most memory for cells, such as 500M
    #[arg(long, value_name = "SIZE", value_parser = args::size, allow_negative_numbers = true)]
    pub max_cell_memory: Option<usize>,
}

impl RenderSettings {
    fn budget(&self) -> arsc_accel::Budget {
        let unlimited = arsc_accel::Budget::UNLIMITED;
        arsc_accel::Budget {
            cells: self.max_cells.unwrap_or(unlimited.cells),
            bytes: self.max_cell_memory.unwrap_or(unlimited.bytes),
        }
    }

    pub fn to_settings(&self) -> Settings {
        Settings {
            samples: self.samples,
            noise: self.noise,
            time_limit: self.time,
            max_depth: self.max_depth,
            seed: self.seed,
            resolution: self.resolution,
            crop: self.crop,
            strategy: self.csg.map(Into::into),
            budget: self.budget(),
            threads: self.threads.map(usize::from),
            ..Settings::default()
        }
    }
}

/// Renders a scene: runs its action sequence, by default a path trace written as spectral EXR and PNG
#[derive(clap::Args, Debug)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// Folder for the pictures, or one picture: a path that ends in .exr, .png, .tif or .csv
    #[arg(short, long, value_name = "DIR|FILE", default_value = ".")]
    output: PathBuf,

    #[command(flatten)]
    settings: RenderSettings,

    /// Prints nothing but errors
    #[arg(short, long)]
    quiet: bool,

    /// Prints what was built for tracing, times and rates at the end
    #[arg(long, value_enum, value_name = "FORMAT", num_args = 0..=1, require_equals = true, default_missing_value = "text")]
    stats: Option<statistics::Format>,

    /// Leaves timings and the command line out of the pictures: equal renders give equal files
    #[arg(long)]
    reproducible: bool,
}

pub fn run(args: &Args) -> Exit {
    let scene = match compile(&args.scene, args.quiet) {
        Ok(scene) => scene,
        Err(exit) => return exit,
    };
    let output = Output::new(&args.output);
    if let Err(exit) = check_output(&output, &scene) {
        return exit;
    }
    interrupt::install();
    bug::stage("render");
    let machine =
        Machine::new(Some(&output), args.quiet).reading(ScriptFolder::of(&args.scene.scene, &args.scene.allow_read));
    let settings = settings(args, &scene);
    bug::seed(settings.seed.unwrap_or_else(|| script_seed(&scene.ir)));
    match arsc_assembly::run(&scene.ir, &settings, &machine) {
        Ok(outcome) => conclude(args, &outcome),
        Err(error) => failure(&error),
    }
}

fn settings(args: &Args, scene: &Scene) -> Settings {
    let mut metadata = vec![
        ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("sceneHash".to_owned(), scene.hash.clone()),
    ];
    if !args.reproducible {
        let words: Vec<String> = std::env::args_os().skip(1).map(|a| a.to_string_lossy().into_owned()).collect();
        metadata.push(("commandLine".to_owned(), format!("arsc {}", words.join(" "))));
    }
    let timings = !args.reproducible;
    let statistics = args.stats.is_some();
    let denoiser = crate::denoise::library();
    Settings { scene_name: scene.name.clone(), metadata, timings, statistics, denoiser, ..args.settings.to_settings() }
}

fn script_seed(ir: &Ir) -> u64 {
    let seed = |action: &Action| match action {
        Action::PathTrace(trace) => Some(trace.sampling.seed),
        Action::AmbientOcclusion { sampling, .. } | Action::Preview { sampling, .. } => Some(sampling.seed),
        _ => None,
    };
    ir.actions.iter().find_map(|at| seed(&at.action)).unwrap_or(0)
}

/// Finds out before the render whether its pictures can be written, and whether the one asked for is among them.
fn check_output(output: &Output, scene: &Scene) -> Result<(), Exit> {
    if let Output::Folder(folder) = output
        && let Some(kind) = foreign_picture(folder)
    {
        eprintln!("error: pictures are written as .exr, .png, .tif or .csv, not as .{kind}");
        return Err(Exit::CouldNotRun);
    }
    let actions = arsc_assembly::actions(&scene.ir, &scene.name);
    let names = actions.iter().filter_map(Action::output);
    let mut places = Vec::new();
    for name in names {
        if let Some(place) = output.place(name).map_err(|error| failure(&error))? {
            arsc_image::check_writable(&place).map_err(|error| failure(&error))?;
            places.push(place);
        }
    }
    if let Output::File(file) = output
        && places.len() != 1
    {
        let kind = file.extension().map(Path::new).unwrap_or(Path::new("")).display();
        eprintln!("error: the script writes {} .{kind} pictures, not one: give -o a folder", places.len());
        return Err(Exit::CouldNotRun);
    }
    Ok(())
}

/// The extension of a path that means a picture of a kind that is not written, unless it is a folder.
fn foreign_picture(path: &Path) -> Option<String> {
    let kind = path.extension()?.to_str()?.to_ascii_lowercase();
    let is_known = ["jpg", "jpeg", "hdr", "pfm", "bmp", "gif", "webp", "ppm", "tga"].contains(&&*kind);
    (is_known && !path.is_dir()).then_some(kind)
}

/// How many samples a render took that decided so itself.
fn say_samples(render: &RenderReport, args: &Args) {
    let (fewest, most) = render.samples;
    if fewest == most && args.settings.noise.is_none() && args.settings.time.is_none() {
        return;
    }
    let samples = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
    let noise = render.noise.map_or(String::new(), |noise| format!(", noise {}", percent(noise)));
    eprintln!("{samples} samples per pixel in {}{noise}", seconds(render.seconds));
}

fn conclude(args: &Args, outcome: &Outcome) -> Exit {
    if let Some(format) = args.stats {
        statistics::print(outcome, format);
    }
    let rejected: u64 = outcome.renders.iter().map(|render| render.rejected).sum();
    if rejected > 0 {
        eprintln!("warning: {rejected} samples were not finite or negative and were left out");
    }
    if !args.quiet {
        outcome.renders.iter().for_each(|render| say_samples(render, args));
        for path in &outcome.written {
            println!("wrote {}", path.display());
        }
    }
    if outcome.interrupted {
        let most = outcome.renders.last().map_or(0, |render| render.samples.1);
        let fate =
            if outcome.written.is_empty() { "nothing was written" } else { "what had been rendered was written" };
        eprintln!("interrupted after {most} samples per pixel: {fate}");
        return Exit::Interrupted;
    }
    Exit::Clean
}
