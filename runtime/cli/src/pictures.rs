//! Pictures named on the command line: read whatever they are, written as their names say.

use std::fmt;
use std::io::Write;
use std::path::{Path, PathBuf};

use arsc_image::{Depth, DisplayImage, Picture};
use arsc_imaging::ImagingError;
use arsc_spectral::tone::{Curve, Exposure, Gamut, ToneMap};
use clap::builder::{PossibleValuesParser, TypedValueParser};

use crate::exit::Exit;
use crate::failure::failure;
use crate::files;

type Cause = Box<dyn std::error::Error + Send + Sync>;

/// What failed with which picture.
#[derive(Debug)]
pub struct PictureError {
    what: &'static str,
    path: PathBuf,
    source: Cause,
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.what, self.path.display())
    }
}

impl std::error::Error for PictureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&*self.source)
    }
}

/// Prints why not, if it cannot be read.
pub fn load(path: &Path) -> Result<Picture, Exit> {
    let failed = |source: Cause| failure(&PictureError { what: "cannot read", path: path.to_owned(), source });
    let bytes = files::read_picture(path).map_err(|error| failed(Box::new(error)))?;
    Picture::decode(&bytes).map_err(|error| failed(Box::new(error)))
}

/// Says what cannot be done with the picture at `path`.
pub fn refused(path: &Path, error: ImagingError) -> Exit {
    failure(&PictureError { what: "cannot use", path: path.to_owned(), source: Box::new(error) })
}

/// Writes the whole file or nothing, and says so.
pub fn save(path: &Path, bytes: &[u8]) -> Result<(), Exit> {
    arsc_image::write_whole(path, bytes).map_err(|error| failure(&error))?;
    print(&format!("wrote {}\n", path.display()));
    Ok(())
}

/// A reader that has seen enough, such as `head`, is no error.
pub fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// Kinds of files that pictures are written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Exr,
    Png,
    Tiff,
    Csv,
}

impl Kind {
    /// By the extension.
    pub fn of(path: &Path) -> Result<Kind, Exit> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            Some("exr") => Ok(Kind::Exr),
            Some("png") => Ok(Kind::Png),
            Some("tif" | "tiff") => Ok(Kind::Tiff),
            Some("csv") => Ok(Kind::Csv),
            _ => {
                eprintln!("error: pictures are written as .exr, .png, .tif or .csv, not as {}", path.display());
                Err(Exit::CouldNotRun)
            }
        }
    }
}

/// Writes what a display shows as PNG, TIFF or, in linear components, as EXR.
pub fn save_display(path: &Path, image: &DisplayImage, depth: Depth) -> Result<(), Exit> {
    let bytes = match Kind::of(path)? {
        Kind::Exr => arsc_image::encode_display_exr(image),
        Kind::Png => arsc_image::encode_png(image, depth),
        Kind::Tiff => arsc_image::encode_tiff(image, depth),
        Kind::Csv => {
            eprintln!("error: a picture for a display is written as .png, .tif or .exr, not as {}", path.display());
            return Err(Exit::CouldNotRun);
        }
    };
    save(path, &bytes.map_err(|error| failure(&error))?)
}

/// Writes everything that the picture holds as EXR, its bands as CSV, or what a display shows of it as PNG or TIFF.
pub fn save_picture(path: &Path, picture: &Picture, depth: Depth) -> Result<(), Exit> {
    let bytes = match (Kind::of(path)?, picture) {
        (Kind::Exr, _) => picture.encode_exr(),
        (Kind::Csv, Picture::Spectral(image)) => arsc_image::encode_csv(image).map(String::into_bytes),
        (Kind::Csv, Picture::Colour(_)) => return Err(refused(path, ImagingError::NoSpectrum)),
        (Kind::Png | Kind::Tiff, _) => return save_display(path, &shown(picture), depth),
    };
    save(path, &bytes.map_err(|error| failure(&error))?)
}

/// As it is where a display can show it, else tone mapped.
fn shown(picture: &Picture) -> DisplayImage {
    let as_it_is =
        ToneMap { exposure: Exposure::Ev(0.0), curve: Curve::Linear, gamut: Gamut::Clip, ..ToneMap::default() };
    let wanted = if arsc_imaging::is_display(picture) { as_it_is } else { ToneMap::default() };
    arsc_imaging::tone_map(picture, &wanted)
}

/// Where the result goes.
#[derive(clap::Args, Clone, Debug)]
pub struct OutputArgs {
    /// The file to write; its extension says the kind
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,

    /// Bits of each component of a PNG or TIFF file
    #[arg(long, value_name = "N", default_value = "8", value_parser = bits())]
    pub bits: Depth,
}

pub fn bits() -> impl TypedValueParser<Value = Depth> {
    let depth = |text: String| if text == "16" { Depth::Sixteen } else { Depth::Eight };
    PossibleValuesParser::new(["8", "16"]).map(depth)
}

/// How bright.
#[derive(clap::Args, Clone, Copy, Debug)]
#[group(multiple = false)]
pub struct ExposureArgs {
    /// Exposure in stops: radiances are multiplied by 2^EV [default: the log-average becomes 0.18]
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = finite)]
    ev: Option<f64>,

    /// The log-average luminance becomes this, of the display's white
    #[arg(long, value_name = "LUMINANCE", value_parser = positive)]
    key: Option<f64>,

    /// This percentile of the luminances becomes the display's white; 100 scales to unity
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    percentile: Option<f64>,

    /// Multiplies radiances; at 1 the equal-energy radiance 1 W m-2 sr-1 nm-1 is the display's white
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    scale: Option<f64>,
}

impl ExposureArgs {
    pub fn exposure(self) -> Option<Exposure> {
        let scale = self.scale.map(|scale| Exposure::Ev(scale.log2()));
        let percentile = self.percentile.map(Exposure::Percentile);
        self.ev.map(Exposure::Ev).or(self.key.map(Exposure::Key)).or(percentile).or(scale)
    }
}

/// One of the values, by its name.
pub fn named<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names: Vec<&'static str> = all.iter().map(|value| name(*value)).collect();
    PossibleValuesParser::new(names).map(move |text: String| {
        let found = all.iter().find(|value| name(**value) == text);
        *found.unwrap_or(&all[0])
    })
}

pub fn finite(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|n: &f64| n.is_finite()).ok_or_else(|| "expected a number".into())
}

pub fn positive(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|n| *n > 0.0).ok_or_else(|| "expected a number greater than 0".into())
}

fn percent(text: &str) -> Result<f64, String> {
    let text = text.trim().trim_end_matches('%');
    positive(text).ok().filter(|n| *n <= 100.0).ok_or_else(|| "expected a percentage, at most 100".into())
}

/// `550nm` or `550`.
pub fn wavelength(text: &str) -> Result<f64, String> {
    let number = text.trim().strip_suffix("nm").unwrap_or(text);
    positive(number).map_err(|_| "expected a wavelength such as 550nm".into())
}

/// `ANGLE` or `ANGLE,STRENGTH`, the angle as 45deg, 45 or 0.8rad, the strength from 0 to 1. Gives radians.
pub fn polariser(text: &str) -> Result<(f64, f64), String> {
    let (angle, strength) = text.split_once(',').unwrap_or((text, "1"));
    let angle = angle.trim();
    let radians = match angle.strip_suffix("rad") {
        Some(number) => finite(number).ok(),
        None => finite(angle.strip_suffix("deg").unwrap_or(angle)).ok().map(f64::to_radians),
    };
    let strength = finite(strength).ok().filter(|s| (0.0..=1.0).contains(s));
    radians.zip(strength).ok_or_else(|| "expected ANGLE or ANGLE,STRENGTH such as 45deg,1".into())
}

/// `A,B`
pub fn pair(text: &str) -> Result<[f64; 2], String> {
    let numbers = text.split_once(',').and_then(|(a, b)| Some([finite(a).ok()?, finite(b).ok()?]));
    numbers.ok_or_else(|| "expected two numbers with a comma between them".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_read_and_slips_refused() {
        assert_eq!((wavelength("550nm"), wavelength(" 550 ")), (Ok(550.0), Ok(550.0)));
        assert_eq!(polariser("90deg,0.5"), Ok((90f64.to_radians(), 0.5)));
        assert_eq!((polariser("0.5rad"), polariser("-45")), (Ok((0.5, 1.0)), Ok(((-45f64).to_radians(), 1.0))));
        assert_eq!((percent("99.5%"), pair("1, 2")), (Ok(99.5), Ok([1.0, 2.0])));
        for slip in ["", "nm", "0", "-5nm", "nan", "inf"] {
            assert!(wavelength(slip).is_err(), "{slip}");
        }
        for slip in ["", "a", "45,2", "45,-0.1", "45,", ",1"] {
            assert!(polariser(slip).is_err(), "{slip}");
        }
        assert!(percent("101").is_err() && percent("0").is_err() && pair("1").is_err());
    }
}
