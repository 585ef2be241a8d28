//! `arsc image`: looks into pictures, cuts, shrinks, adds, merges and converts them.

use std::path::{Path, PathBuf};

use arsc_image::{Depth, Picture};
use arsc_imaging::{ImagingError, combine, probe, reshape, summary};
use clap::Subcommand;

use crate::args;
use crate::exit::Exit;
use crate::failure::failure;
use crate::pictures::{self, OutputArgs};

/// Looks into pictures, cuts, shrinks, adds, merges and converts them
#[derive(clap::Args, Debug)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Says what pictures hold: size, bands, channels, luminances, metadata
    Info {
        #[arg(required = true)]
        pictures: Vec<PathBuf>,
    },
    /// Prints what a pixel holds, and plots its spectrum
    Pixel {
        input: PathBuf,

        /// Pixels from the upper left corner
        #[arg(value_name = "X,Y", value_parser = place)]
        place: [u32; 2],

        /// Plots the spectrum into an .svg or .png file
        #[arg(long, value_name = "FILE")]
        plot: Option<PathBuf>,
    },
    /// Cuts out a rectangle
    Crop {
        input: PathBuf,

        /// Pixels from the upper left corner, the end excluded
        #[arg(value_name = "X0,Y0,X1,Y1", value_parser = args::crop)]
        rectangle: [u32; 4],

        #[command(flatten)]
        output: OutputArgs,
    },
    /// Averages squares of N times N pixels
    Downscale {
        input: PathBuf,

        #[arg(value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
        factor: u32,

        #[command(flatten)]
        output: OutputArgs,
    },
    /// Adds the light of two pictures, as of two lamps of one scene
    Add {
        first: PathBuf,
        second: PathBuf,

        #[command(flatten)]
        output: OutputArgs,
    },
    /// Averages renders of one scene with different seeds, each by its samples
    Merge {
        #[arg(required = true)]
        pictures: Vec<PathBuf>,

        /// One weight for each picture instead of its samples
        #[arg(long, value_name = "W,…", value_delimiter = ',', value_parser = pictures::finite)]
        weights: Option<Vec<f64>>,

        #[command(flatten)]
        output: OutputArgs,
    },
    /// Writes a picture in another format: spectra between EXR and CSV, ARTRAW to EXR, colours between EXR, PNG and TIFF
    Convert {
        input: PathBuf,

        /// Multiplies radiances and colours
        #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = pictures::positive)]
        multiply: f64,

        #[command(flatten)]
        output: OutputArgs,
    },
}

pub fn run(args: &Args) -> Exit {
    let done = match &args.command {
        Command::Info { pictures } => pictures.iter().try_for_each(|path| info(path)),
        Command::Pixel { input, place, plot } => pixel(input, *place, plot.as_deref()),
        Command::Crop { input, rectangle, output } => one(input, output, |picture| reshape::crop(&picture, *rectangle)),
        Command::Downscale { input, factor, output } => {
            one(input, output, |picture| reshape::downscale(&picture, *factor))
        }
        Command::Add { first, second, output } => {
            several(&[first, second], output, |pictures| combine::add(&pictures[0], &pictures[1]))
        }
        Command::Merge { pictures, weights, output } => {
            let paths: Vec<&PathBuf> = pictures.iter().collect();
            several(&paths, output, |pictures| combine::merge(pictures, weights.as_deref()))
        }
        Command::Convert { input, multiply, output } => {
            one(
                input,
                output,
                |picture| {
                    if *multiply == 1.0 { Ok(picture) } else { reshape::scaled(&picture, *multiply) }
                },
            )
        }
    };
    done.err().unwrap_or(Exit::Clean)
}

/// `X,Y`
fn place(text: &str) -> Result<[u32; 2], String> {
    let numbers = text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    numbers.ok_or_else(|| "expected X,Y, for example 320,240".into())
}

fn one(
    input: &Path,
    output: &OutputArgs,
    change: impl FnOnce(Picture) -> Result<Picture, ImagingError>,
) -> Result<(), Exit> {
    pictures::Kind::of(&output.output)?;
    let picture = change(pictures::load(input)?).map_err(|error| pictures::refused(input, error))?;
    pictures::save_picture(&output.output, &picture, output.bits)
}

fn several(
    inputs: &[&PathBuf],
    output: &OutputArgs,
    join: impl FnOnce(&[Picture]) -> Result<Picture, ImagingError>,
) -> Result<(), Exit> {
    pictures::Kind::of(&output.output)?;
    let loaded: Vec<Picture> = inputs.iter().map(|path| pictures::load(path)).collect::<Result<_, _>>()?;
    let picture = join(&loaded).map_err(|error| failure(&error))?;
    pictures::save_picture(&output.output, &picture, output.bits)
}

fn info(path: &Path) -> Result<(), Exit> {
    let picture = pictures::load(path)?;
    let mut text = format!("{}: {}", path.display(), summary(&picture));
    for (name, value) in picture.metadata() {
        text.push_str(&format!("{name}: {value}\n"));
    }
    pictures::print(&text);
    Ok(())
}

fn pixel(path: &Path, place: [u32; 2], plot: Option<&Path>) -> Result<(), Exit> {
    const SIZE: [usize; 2] = [720, 400];
    let picture = pictures::load(path)?;
    let pixel = probe::pixel(&picture, place).map_err(|error| pictures::refused(path, error))?;
    pictures::print(&pixel.to_string());
    let Some(file) = plot else { return Ok(()) };
    let drawn = probe::spectrum_plot(&pixel, SIZE).ok_or_else(|| pictures::refused(path, ImagingError::NoSpectrum))?;
    if file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        pictures::save(file, drawn.to_svg().as_bytes())
    } else {
        pictures::save_display(file, &drawn.to_pixels(), Depth::Eight)
    }
}
