//! `arsc denoise`: takes the noise out of a picture.

use std::path::{Path, PathBuf};

use arsc_denoise::{DenoiseError, Denoiser, Features};
use arsc_image::Picture;
use arsc_imaging::denoise::{denoised, features};

use crate::exit::Exit;
use crate::failure::failure;
use crate::pictures::{self, OutputArgs};

/// The variable that names the library, where it is not installed for the whole system.
pub const LIBRARY: &str = "ARSC_OIDN_LIBRARY";

/// Takes the noise out of a picture, by Intel Open Image Denoise where it is installed
///
/// Light, spectrum and polarisation are filtered, guided by the channels albedo.R, .G, .B and normal.X, .Y, .Z where
/// the picture has them. The library is looked for when it is needed: with --library, in the environment variable
/// ARSC_OIDN_LIBRARY, or where the system keeps its libraries.
#[derive(clap::Args, Debug)]
pub struct Args {
    input: PathBuf,

    #[command(flatten)]
    output: OutputArgs,

    /// The file libOpenImageDenoise.so; its code is run
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
}

/// The library that the environment names.
pub fn library() -> Option<PathBuf> {
    std::env::var_os(LIBRARY).filter(|path| !path.is_empty()).map(PathBuf::from)
}

pub fn run(args: &Args) -> Exit {
    let library = args.library.clone().or_else(library);
    let written = pictures::Kind::of(&args.output.output).and_then(|_| {
        let picture = pictures::load(&args.input)?;
        let clean = filtered(&picture, library.as_deref()).map_err(|error| failure(&error))?;
        pictures::save_picture(&args.output.output, &clean, args.output.bits)
    });
    written.err().unwrap_or(Exit::Clean)
}

fn filtered(picture: &Picture, library: Option<&Path>) -> Result<Picture, DenoiseError> {
    let denoiser = Denoiser::load(library)?;
    let (albedo, normal) = features(picture);
    let features = Features { albedo: albedo.as_deref(), normal: normal.as_deref() };
    denoised(picture, |light| denoiser.denoise([picture.width(), picture.height()], light, features))
}
