//! `arsc polvis`: polarisation in false colours.

use std::path::PathBuf;

use arsc_imaging::polarisation::{Overlay, Quantity, View, visualise};

use crate::exit::Exit;
use crate::pictures::{self, OutputArgs, named};

/// Draws the polarisation of a picture in false colours
///
/// The colours follow Wilkie and Weidlich 2010: degree in red, linear in cyan, circular in yellow, orientation in four
/// colours, right-handed in blue and left-handed in yellow.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// A polarised spectral picture, rendered with `polarised: true`
    input: PathBuf,

    #[command(flatten)]
    output: OutputArgs,

    /// What is drawn
    #[arg(short, long, default_value = "degree", value_parser = named(&Quantity::ALL, Quantity::name))]
    quantity: Quantity,

    /// At this wavelength [default: all, as the eye weighs them]
    #[arg(long, value_name = "WAVELENGTH", value_parser = pictures::wavelength)]
    wavelength: Option<f64>,

    /// The value with the full colour; less makes faint polarisation visible
    #[arg(long, value_name = "VALUE", default_value = "1", value_parser = pictures::positive)]
    max: f64,

    /// Draws false colours as bright as the picture (luminance), or over the picture in grey (picture)
    #[arg(long, default_value = "none", value_parser = named(&Overlay::ALL, Overlay::name))]
    overlay: Overlay,

    /// Draws no legend beside the picture
    #[arg(long)]
    no_legend: bool,
}

pub fn run(args: &Args) -> Exit {
    let view = View {
        quantity: args.quantity,
        wavelength_nm: args.wavelength,
        most: args.max,
        overlay: args.overlay,
        legend: !args.no_legend,
    };
    let written = pictures::Kind::of(&args.output.output).and_then(|_| {
        let picture = pictures::load(&args.input)?;
        let image = visualise(&picture, &view).map_err(|error| pictures::refused(&args.input, error))?;
        pictures::save_display(&args.output.output, &image, args.output.bits)
    });
    written.err().unwrap_or(Exit::Clean)
}
