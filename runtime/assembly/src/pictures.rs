//! Actions on pictures: `arsc-imaging` does them, the host gives the files.

use std::path::Path;
use std::sync::Arc;

use arsc_denoise::{Denoiser, Features};
use arsc_image::{DisplayImage, Picture, SpectralImage};
use arsc_imaging::difference::{Difference, difference};
use arsc_imaging::polarisation::visualise;
use arsc_imaging::{ImagingError, combine, denoise, polariser, reshape, slice};
use arsc_ir::{ImageAction, ToneMap};

use crate::sequence::Item;
use crate::{AssemblyError, Host};

/// The picture for a display.
pub fn tone_map(image: &SpectralImage, tone: &ToneMap, slice_nm: Option<f64>) -> Result<DisplayImage, AssemblyError> {
    let size = [image.width, image.height];
    match slice_nm {
        None => Ok(arsc_imaging::tone_map_colours(size, &image.xyz, &image.metadata, tone)),
        Some(lambda_nm) => {
            let grey = slice::slice_of(image, lambda_nm);
            let grey = grey.map_err(|source| AssemblyError::Imaging { action: "tone_map", source })?;
            Ok(arsc_imaging::tone_map(&Picture::Colour(grey), tone))
        }
    }
}

/// What the action makes of the topmost picture, and of the one below where it takes two.
pub(crate) fn apply(
    action: &ImageAction,
    top: Arc<SpectralImage>,
    below: Option<Arc<SpectralImage>>,
    host: &dyn Host,
    denoiser: Option<&Path>,
) -> Result<Item, AssemblyError> {
    let top = Picture::Spectral(Arc::unwrap_or_clone(top));
    let below = || below.map(|image| Picture::Spectral(Arc::unwrap_or_clone(image)));
    let refused = |source: ImagingError| AssemblyError::Imaging { action: action.name(), source };
    let missing = || AssemblyError::Stack { action: action.name(), needs: "two spectral images", found: "one" };
    let made = match action {
        ImageAction::LinearPolariser { angle, strength } => polariser::linear_polariser(&top, *angle, *strength),
        ImageAction::Multiply { factor } => reshape::scaled(&top, *factor),
        ImageAction::Crop { rectangle } => reshape::crop(&top, *rectangle),
        ImageAction::Downscale { factor } => reshape::downscale(&top, *factor),
        ImageAction::Add => combine::add(&below().ok_or_else(missing)?, &top),
        ImageAction::Merge => combine::merge(&[below().ok_or_else(missing)?, top], None),
        ImageAction::Denoise => return denoised(&top, denoiser),
        ImageAction::DifferenceTo { path, question, most } => {
            let reference = read(path, host)?;
            let difference = difference(&reference, &top, question).map_err(refused)?;
            host.say(&said(path, &difference));
            return Ok(Item::Display(Arc::new(difference.picture(*most, true))));
        }
        ImageAction::VisualisePolarisation(view) => {
            return visualise(&top, view).map(|image| Item::Display(Arc::new(image))).map_err(refused);
        }
    };
    item(made.map_err(refused)?)
}

fn item(picture: Picture) -> Result<Item, AssemblyError> {
    match picture {
        Picture::Spectral(image) => Ok(Item::Spectral(Arc::new(image))),
        Picture::Colour(_) => Err(AssemblyError::NotNormal("an action took the spectrum from a picture")),
    }
}

fn denoised(picture: &Picture, library: Option<&Path>) -> Result<Item, AssemblyError> {
    let denoiser = Denoiser::load(library)?;
    let (albedo, normal) = denoise::features(picture);
    let features = Features { albedo: albedo.as_deref(), normal: normal.as_deref() };
    let size = [picture.width(), picture.height()];
    item(denoise::denoised(picture, |light| denoiser.denoise(size, light, features))?)
}

fn read(path: &str, host: &dyn Host) -> Result<Picture, AssemblyError> {
    let failed = |source| AssemblyError::Read { name: path.to_owned(), source };
    let bytes = host.read(path).map_err(failed)?;
    Picture::decode(&bytes).map_err(|error| failed(Box::new(error)))
}

fn said(path: &str, difference: &Difference) -> String {
    let statistics = difference.statistics();
    let (name, mean, greatest) = (difference.metric.name(), statistics.mean, statistics.greatest);
    let broken = match statistics.not_finite {
        0 => String::new(),
        count => format!(", {count} pixels that cannot be compared"),
    };
    format!("difference to {path}: {name} mean {mean:.6}, greatest {greatest:.6}{broken}")
}
