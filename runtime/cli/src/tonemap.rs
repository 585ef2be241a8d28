//! `arsc tonemap`: a picture for a display.

use std::path::PathBuf;

use arsc_image::Picture;
use arsc_imaging::{ImagingError, polariser, slice};
use arsc_spectral::adaptation::Adaptation;
use arsc_spectral::colour_space::ColourSpace;
use arsc_spectral::illuminant::white_point;
use arsc_spectral::tone::{Calibration, Curve, Gamut, ToneMap};
use clap::builder::PossibleValuesParser;

use crate::exit::Exit;
use crate::pictures::{self, ExposureArgs, OutputArgs, named};

/// Maps a picture to what a display shows, as PNG, TIFF or EXR
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Spectral or RGB OpenEXR, PNG, TIFF, CSV of bands, ARTRAW
    input: PathBuf,

    #[command(flatten)]
    output: OutputArgs,

    #[command(flatten)]
    exposure: ExposureArgs,

    /// How highlights are brought into range
    #[arg(long, default_value = "shoulder", value_parser = PossibleValuesParser::new(Curve::NAMES))]
    curve: String,

    /// With --curve exponential: what the log-average becomes, between 0 and 1
    #[arg(long, value_name = "LUMINANCE", value_parser = share)]
    target: Option<f64>,

    /// With --curve calibrated: stops by which the average is moved
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = pictures::finite)]
    aperture: Option<f64>,

    /// With --curve calibrated: contrast in percent
    #[arg(long, value_name = "PERCENT", value_parser = pictures::positive)]
    contrast: Option<f64>,

    /// With --curve calibrated: the line itself, luminance Y becomes A Y^B
    #[arg(long, value_name = "A,B", value_parser = pictures::pair, conflicts_with_all = ["aperture", "contrast"])]
    line: Option<[f64; 2]>,

    /// The light that looks white: an illuminant such as D50, A or FL11, a temperature such as 3200K, or x,y
    #[arg(long, value_name = "WHITE", value_parser = white_point)]
    white: Option<[f64; 2]>,

    /// How colours are adapted to that white
    #[arg(long, default_value = "bradford", value_parser = named(&Adaptation::ALL, Adaptation::name))]
    adaptation: Adaptation,

    /// Lets colours lighter than the display's white pale until they are white at this L*
    #[arg(long, value_name = "L", num_args = 0..=1, require_equals = true, default_missing_value = "150", value_parser = lightness)]
    white_lightness: Option<f64>,

    /// What becomes of colours that the display cannot mix
    #[arg(long, default_value = "desaturate", value_parser = named(&Gamut::ALL, Gamut::name))]
    gamut: Gamut,

    /// The display's colour space; its ICC profile goes into the file
    #[arg(long, default_value = "srgb", value_parser = named(&ColourSpace::ALL, ColourSpace::name))]
    space: ColourSpace,

    /// Shows one wavelength of a spectral picture in grey, such as 550nm
    #[arg(long, value_name = "WAVELENGTH", value_parser = pictures::wavelength)]
    slice: Option<f64>,

    /// Puts a linear polariser before the picture: its angle from the horizontal, and its strength from 0 to 1
    #[arg(long, value_name = "ANGLE[,STRENGTH]", allow_hyphen_values = true, value_parser = pictures::polariser)]
    polariser: Option<(f64, f64)>,
}

fn share(text: &str) -> Result<f64, String> {
    pictures::positive(text).ok().filter(|n| *n < 1.0).ok_or_else(|| "expected a number between 0 and 1".into())
}

fn lightness(text: &str) -> Result<f64, String> {
    pictures::finite(text).ok().filter(|l| *l >= 100.0).ok_or_else(|| "expected an L* of at least 100".into())
}

pub fn run(args: &Args) -> Exit {
    let wanted = match args.tone_map() {
        Ok(wanted) => wanted,
        Err(text) => {
            eprintln!("error: {text}");
            return Exit::CouldNotRun;
        }
    };
    let written = pictures::Kind::of(&args.output.output).and_then(|_| {
        let picture = pictures::load(&args.input)?;
        let picture = args.prepared(picture).map_err(|error| pictures::refused(&args.input, error))?;
        let image = arsc_imaging::tone_map(&picture, &wanted);
        pictures::save_display(&args.output.output, &image, args.output.bits)
    });
    written.err().unwrap_or(Exit::Clean)
}

impl Args {
    fn tone_map(&self) -> Result<ToneMap, &'static str> {
        let is_calibrated = self.aperture.is_some() || self.contrast.is_some() || self.line.is_some();
        if self.target.is_some() && self.curve != "exponential" {
            return Err("--target goes with --curve exponential");
        }
        if is_calibrated && self.curve != "calibrated" {
            return Err("--aperture, --contrast and --line go with --curve calibrated");
        }
        let curve = match self.curve.as_str() {
            "linear" => Curve::Linear,
            "exponential" => Curve::Exponential { target: self.target },
            "calibrated" => Curve::Calibrated(Calibration {
                aperture: self.aperture.unwrap_or(Calibration::default().aperture),
                contrast: self.contrast.unwrap_or(Calibration::default().contrast),
                line: self.line,
            }),
            "aces" => Curve::Aces,
            "agx" => Curve::Agx,
            _ => Curve::Shoulder,
        };
        Ok(ToneMap {
            exposure: self.exposure.exposure().unwrap_or_default(),
            white: self.white,
            adaptation: self.adaptation,
            curve,
            white_lightness: self.white_lightness,
            gamut: self.gamut,
            space: self.space,
        })
    }

    fn prepared(&self, mut picture: Picture) -> Result<Picture, ImagingError> {
        if let Some((angle, strength)) = self.polariser {
            picture = polariser::linear_polariser(&picture, angle, strength)?;
        }
        match self.slice {
            Some(lambda_nm) => slice::slice(&picture, lambda_nm),
            None => Ok(picture),
        }
    }
}
