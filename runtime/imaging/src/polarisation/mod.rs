//! Polarisation in false colours.
//!
//! After Wilkie and Weidlich 2010, "A standardised polarisation visualisation for images" (SCCG): the degree in red; the
//! type, linear in cyan and circular in yellow; the orientation of the linear part as a mixture of four colours; the
//! chirality of the circular part, right-handed in blue and left-handed in yellow. Everything can be seen alone or laid
//! over the picture. The Stokes parameters are those of one wavelength, or of all bands as the eye weighs them.
//! Their frame is the picture's: S1 > 0 is horizontal, S2 > 0 rises to the right, S3 > 0 is right-handed.

use arsc_image::{DisplayImage, Picture, SpectralImage, band_weights};
use arsc_spectral::Observer;
use arsc_spectral::tone::{Display, ToneMap};

use crate::draw::{Colour, ColourMap, Entry, beside, blank, scale_bar, swatches};
use crate::slice::neighbours;
use crate::{ImagingError, luminances};

pub use arsc_spectral::pictures::{Overlay, Quantity, View};

const RED: Colour = [1.0, 0.0, 0.0];
const CYAN: Colour = [0.0, 0.95, 0.95];
const YELLOW: Colour = [0.98, 0.95, 0.05];
const BLUE: Colour = [0.15, 0.35, 1.0];
const GREEN: Colour = [0.0, 0.85, 0.1];

/// The picture of a quantity. Pixels without light are black.
pub fn visualise(picture: &Picture, view: &View) -> Result<DisplayImage, ImagingError> {
    if !view.most.is_finite() || view.most <= 0.0 {
        return Err(ImagingError::Arguments("the value of the full colour must be greater than 0".into()));
    }
    let Picture::Spectral(spectral) = picture else { return Err(ImagingError::NoSpectrum) };
    let stokes = stokes(spectral, view.wavelength_nm)?;
    let mut image = blank(picture.width(), picture.height(), [0.0; 3]);
    image.metadata = picture.metadata().to_vec();
    let grey = (view.overlay != Overlay::None).then(|| greys(picture));
    for (i, (colour, stokes)) in image.rgb.iter_mut().zip(&stokes).enumerate() {
        let Some([s1, s2, s3]) = relative(*stokes) else { continue };
        let shown = false_colour(view.quantity, [s1, s2, s3].map(|s| s / view.most));
        *colour = match (view.overlay, &grey) {
            (Overlay::Luminance, Some(grey)) => shown.map(|c| c * grey[i]),
            (Overlay::Picture, Some(grey)) => {
                let strength = (strength(view.quantity, [s1, s2, s3]) / view.most).min(1.0) as f32;
                shown.map(|c| grey[i] * (1.0 - strength) + c * strength)
            }
            _ => shown,
        };
    }
    Ok(if view.legend { beside(&image, &legend(view, image.height)) } else { image })
}

/// S0 to S3 per pixel, at a wavelength or weighed by the eye.
pub fn stokes(image: &SpectralImage, wavelength_nm: Option<f64>) -> Result<Vec<[f64; 4]>, ImagingError> {
    let Some(stokes) = &image.stokes else { return Err(ImagingError::NotPolarised) };
    let bands = image.bands();
    let weights: Vec<f64> = match wavelength_nm {
        Some(lambda_nm) => {
            let ((low, high), t) = neighbours(image, lambda_nm)?;
            let mut weights = vec![0.0; bands];
            weights[low] += 1.0 - f64::from(t);
            weights[high] += f64::from(t);
            weights
        }
        None => band_weights(&image.band_edges_nm, Observer::Cie1931).iter().map(|w| w[1]).collect(),
    };
    let weighed = |values: &dyn Fn(usize) -> f32| {
        weights.iter().enumerate().map(|(band, weight)| weight * f64::from(values(band))).sum::<f64>()
    };
    let pixel = |(radiance, stokes): (&[f32], &[[f32; 3]])| {
        let part = |i: usize| weighed(&|band| stokes[band][i]);
        [weighed(&|band| radiance[band]), part(0), part(1), part(2)]
    };
    Ok(image.radiance.chunks_exact(bands).zip(stokes.chunks_exact(bands)).map(pixel).collect())
}

/// S1, S2, S3 of S0; `None` without light.
fn relative([s0, s1, s2, s3]: [f64; 4]) -> Option<[f64; 3]> {
    let relative = [s1 / s0, s2 / s0, s3 / s0];
    (s0 > 0.0 && relative.iter().all(|s| s.is_finite())).then_some(relative)
}

/// How much there is to see of a quantity, from 0 to 1.
fn strength(quantity: Quantity, [s1, s2, s3]: [f64; 3]) -> f64 {
    match quantity {
        Quantity::Degree | Quantity::Type => s1.hypot(s2).hypot(s3),
        Quantity::Linear | Quantity::Orientation => s1.hypot(s2),
        Quantity::Circular | Quantity::Chirality | Quantity::S3 => s3.abs(),
        Quantity::S1 => s1.abs(),
        Quantity::S2 => s2.abs(),
    }
}

/// The map of a quantity that is one number.
fn map(quantity: Quantity) -> Option<ColourMap> {
    match quantity {
        Quantity::Degree => Some(ColourMap::To(RED)),
        Quantity::Linear => Some(ColourMap::To(CYAN)),
        Quantity::Circular => Some(ColourMap::To(YELLOW)),
        Quantity::Chirality => Some(ColourMap::Between(YELLOW, BLUE)),
        Quantity::S1 | Quantity::S2 | Quantity::S3 => Some(ColourMap::PlusMinus),
        Quantity::Type | Quantity::Orientation => None,
    }
}

fn false_colour(quantity: Quantity, relative: [f64; 3]) -> Colour {
    let [s1, s2, s3] = relative;
    let mixed = |parts: [(Colour, f64); 2]| -> Colour {
        std::array::from_fn(|c| {
            parts.iter().map(|(colour, share)| colour[c] * *share as f32).sum::<f32>().clamp(0.0, 1.0)
        })
    };
    match (quantity, map(quantity)) {
        (Quantity::Type, _) => mixed([(CYAN, s1.hypot(s2)), (YELLOW, s3.abs())]),
        (Quantity::Orientation, _) => {
            mixed([(if s1 < 0.0 { RED } else { GREEN }, s1.abs()), (if s2 < 0.0 { BLUE } else { YELLOW }, s2.abs())])
        }
        (Quantity::S1, Some(map)) => map.colour(s1),
        (Quantity::S2, Some(map)) => map.colour(s2),
        (Quantity::S3 | Quantity::Chirality, Some(map)) => map.colour(s3),
        (_, Some(map)) => map.colour(strength(quantity, relative)),
        (_, None) => [0.0; 3],
    }
}

/// What the picture looks like in grey, coded.
fn greys(picture: &Picture) -> Vec<f32> {
    let display = Display::new(&ToneMap::default(), &luminances(picture.xyz()));
    let grey = |xyz: &[f32; 3]| crate::tone_map::coded(&display, *xyz);
    picture.xyz().iter().map(grey).map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b).collect()
}

fn legend(view: &View, height: usize) -> DisplayImage {
    let at = view.wavelength_nm.map(|nm| format!("{nm} nm"));
    let title = |first: &'static str| -> Vec<&str> { std::iter::once(first).chain(at.as_deref()).collect() };
    match (view.quantity, map(view.quantity)) {
        (Quantity::Type, _) => {
            let entries = [Entry { colour: CYAN, name: "linear" }, Entry { colour: YELLOW, name: "circular" }];
            swatches(height, &title("type"), &entries)
        }
        (Quantity::Orientation, _) => {
            let entries = [
                Entry { colour: GREEN, name: "horizontal" },
                Entry { colour: YELLOW, name: "rising" },
                Entry { colour: RED, name: "vertical" },
                Entry { colour: BLUE, name: "falling" },
            ];
            swatches(height, &title("orientation"), &entries)
        }
        (Quantity::Chirality, _) => {
            let entries = [Entry { colour: BLUE, name: "right" }, Entry { colour: YELLOW, name: "left" }];
            swatches(height, &title("chirality"), &entries)
        }
        (quantity, map) => {
            let map = map.unwrap_or(ColourMap::Grey);
            let least = if map.is_signed() { -view.most } else { 0.0 };
            scale_bar(height, map, [least, view.most], &title(quantity.name()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(stokes: &[[f32; 4]]) -> Picture {
        Picture::Spectral(SpectralImage {
            width: stokes.len(),
            height: 1,
            band_edges_nm: vec![500.0, 600.0],
            radiance: stokes.iter().map(|s| s[0]).collect(),
            stokes: Some(stokes.iter().map(|s| [s[1], s[2], s[3]]).collect()),
            xyz: stokes.iter().map(|s| [s[0]; 3]).collect(),
            channels: vec![],
            metadata: vec![],
        })
    }

    fn shown(stokes: &[[f32; 4]], quantity: Quantity) -> Vec<Colour> {
        let view = View { quantity, legend: false, ..View::default() };
        visualise(&picture(stokes), &view).unwrap().rgb
    }

    #[test]
    fn colours_are_those_of_the_standard() {
        let pure = [[2.0, 2.0, 0.0, 0.0], [2.0, -2.0, 0.0, 0.0], [2.0, 0.0, 2.0, 0.0], [2.0, 0.0, -2.0, 0.0]];
        assert_eq!(shown(&pure, Quantity::Orientation), [GREEN, RED, YELLOW, BLUE]);
        assert_eq!(shown(&pure, Quantity::Degree), [RED; 4]);
        assert_eq!(shown(&pure, Quantity::Type), [CYAN; 4]);
        let circular = [[1.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, -1.0], [1.0, 0.0, 0.0, 0.0], [0.0; 4]];
        assert_eq!(shown(&circular, Quantity::Chirality), [BLUE, YELLOW, [0.0; 3], [0.0; 3]]);
        assert_eq!(shown(&circular, Quantity::Type)[0], YELLOW);
    }

    #[test]
    fn degrees_are_the_closed_forms() {
        let stokes = [[4.0, 1.2, 1.6, 0.0]];
        assert!((shown(&stokes, Quantity::Degree)[0][0] - 0.5).abs() < 1e-6);
        assert_eq!(shown(&stokes, Quantity::Circular)[0], [0.0; 3]);
        let view = View { most: 0.25, legend: false, ..View::default() };
        assert_eq!(visualise(&picture(&stokes), &view).unwrap().rgb[0], RED, "saturates");
    }

    #[test]
    fn overlays_keep_the_picture_where_nothing_is_polarised() {
        let stokes = [[1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0]];
        let view = View { overlay: Overlay::Picture, legend: false, ..View::default() };
        let over = visualise(&picture(&stokes), &view).unwrap().rgb;
        assert!(over[0][0] > 0.2 && over[0][0] == over[0][2] && over[1] == RED, "{over:?}");
        let view = View { overlay: Overlay::Luminance, ..view };
        let scaled = visualise(&picture(&stokes), &view).unwrap().rgb;
        assert!(scaled[0] == [0.0; 3] && scaled[1][0] > 0.2 && scaled[1][0] < 0.9 && scaled[1][1] == 0.0);
    }

    #[test]
    fn every_quantity_has_a_legend_and_nonsense_is_refused() {
        let picture = picture(&[[1.0, 0.5, -0.2, 0.1], [f32::NAN, 0.0, 0.0, 0.0]]);
        for quantity in Quantity::ALL {
            let image = visualise(&picture, &View { quantity, ..View::default() }).unwrap();
            image.verify().unwrap();
            assert!(
                image.width > 2 && image.rgb.iter().flatten().all(|c| (0.0..=1.0).contains(c)),
                "{}",
                quantity.name()
            );
        }
        for view in [
            View { most: 0.0, ..View::default() },
            View { most: f64::NAN, ..View::default() },
            View { wavelength_nm: Some(700.0), ..View::default() },
        ] {
            assert!(visualise(&picture, &view).is_err());
        }
        let Picture::Spectral(mut plain) = picture else { panic!() };
        plain.stokes = None;
        let refused = visualise(&Picture::Spectral(plain), &View::default());
        assert!(matches!(refused, Err(ImagingError::NotPolarised)));
    }
}
