//! How two pictures differ: pixel by pixel in a metric, and as a whole.
//!
//! Colour differences refer to what a display would show: both pictures get the exposure that the first one asks for, and
//! L* = 100 is the display's white. Pixels that are not finite in either picture have no difference (NaN) and are counted.

mod flip;

use arsc_image::{DisplayImage, Picture, UNIT_LUMINANCE};
use arsc_spectral::colour::{delta_e_2000, lab_from_xyz};
use arsc_spectral::colour_space::{D65_WHITE, xyz_of_chromaticity};
use arsc_spectral::tone::{Curve, Display, Exposure, Gamut, ToneMap};
use glam::DVec3;

use crate::combine::check_alike;
use crate::draw::{ColourMap, beside, scale_bar};
use crate::{ImagingError, is_display, luminances, slice};

pub use arsc_spectral::pictures::{Metric, Question};
pub use flip::{PIXELS_PER_DEGREE, flip};

/// A difference per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    pub width: usize,
    pub height: usize,
    pub metric: Metric,
    pub values: Vec<f64>,
}

/// Numbers about a [`Difference`], of magnitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    pub mean: f64,
    pub root_mean_square: f64,
    pub median: f64,
    /// Not exceeded by 95 % of the pixels.
    pub percentile_95: f64,
    pub greatest: f64,
    /// Pixels that cannot be compared.
    pub not_finite: usize,
}

/// Errors of a second picture against a first, over all bands, or over X, Y and Z where there are none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    pub root_mean_square: f64,
    /// Of the first picture's greatest value; infinite for equal pictures.
    pub peak_signal_to_noise_db: f64,
    pub signal_to_noise_db: f64,
}

/// The second picture against the first.
pub fn difference(a: &Picture, b: &Picture, question: &Question) -> Result<Difference, ImagingError> {
    let size = |picture: &Picture| [picture.width(), picture.height()];
    if size(a) != size(b) {
        return Err(ImagingError::Sizes(size(a), size(b)));
    }
    if question.wavelength_nm.is_some() && question.metric != Metric::PlusMinus {
        return Err(ImagingError::Arguments("a wavelength goes with the metric plus_minus alone".into()));
    }
    let values = match question.metric {
        Metric::PlusMinus => plus_minus(a, b, question.wavelength_nm)?,
        Metric::Flip => {
            let display = display(a, question.exposure);
            let mut values = flip(&coded(a, &display), &coded(b, &display), a.width(), PIXELS_PER_DEGREE);
            for ((value, a), b) in values.iter_mut().zip(a.xyz()).zip(b.xyz()) {
                if !is_finite(a) || !is_finite(b) {
                    *value = f64::NAN;
                }
            }
            values
        }
        metric => {
            let ev = exposure(a, question.exposure).ev(&luminances(a.xyz()));
            let lab = |xyz: &[f32; 3]| {
                let scale = ev.exp2() / UNIT_LUMINANCE;
                let white = xyz_of_chromaticity(D65_WHITE).to_array();
                lab_from_xyz(xyz.map(|c| f64::from(c) * scale), white)
            };
            a.xyz().iter().zip(b.xyz()).map(|(a, b)| of_colours(metric, lab(a), lab(b))).collect()
        }
    };
    let [width, height] = size(a);
    Ok(Difference { width, height, metric: question.metric, values })
}

fn is_finite(xyz: &[f32; 3]) -> bool {
    xyz.iter().all(|c| c.is_finite())
}

/// The exposure that both pictures get.
fn exposure(a: &Picture, asked: Option<Exposure>) -> Exposure {
    asked.unwrap_or(if is_display(a) { Exposure::Ev(0.0) } else { Exposure::Auto })
}

fn display(a: &Picture, asked: Option<Exposure>) -> Display {
    let wanted =
        ToneMap { exposure: exposure(a, asked), curve: Curve::Linear, gamut: Gamut::Clip, ..ToneMap::default() };
    Display::new(&wanted, &luminances(a.xyz()))
}

/// Components of sRGB, coded.
fn coded(picture: &Picture, display: &Display) -> Vec<DVec3> {
    let colour = |xyz: &[f32; 3]| display.coded(DVec3::from_array(xyz.map(|c| f64::from(c) / UNIT_LUMINANCE)));
    picture.xyz().iter().map(colour).collect()
}

fn plus_minus(a: &Picture, b: &Picture, wavelength_nm: Option<f64>) -> Result<Vec<f64>, ImagingError> {
    let less = |a: f32, b: f32| if a.is_finite() && b.is_finite() { f64::from(b) - f64::from(a) } else { f64::NAN };
    let Some(lambda_nm) = wavelength_nm else {
        return Ok(a.xyz().iter().zip(b.xyz()).map(|(a, b)| less(a[1], b[1])).collect());
    };
    let (Picture::Spectral(a), Picture::Spectral(b)) = (a, b) else { return Err(ImagingError::NoSpectrum) };
    let (a, b) = (slice::radiance_at(a, lambda_nm)?, slice::radiance_at(b, lambda_nm)?);
    Ok(a.into_iter().zip(b).map(|(a, b)| less(a, b)).collect())
}

/// Of two colours in L*, a*, b*.
fn of_colours(metric: Metric, a: [f64; 3], b: [f64; 3]) -> f64 {
    if !a.iter().chain(&b).all(|c| c.is_finite()) {
        return f64::NAN;
    }
    let [dl, da, db] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let chroma = |lab: [f64; 3]| lab[1].hypot(lab[2]);
    let dc = chroma(b) - chroma(a);
    match metric {
        Metric::Cie76 => (dl * dl + da * da + db * db).sqrt(),
        Metric::Lightness => dl,
        Metric::Chroma => dc,
        // CIE 15:2018, equation 8.17.
        Metric::Hue => (da * da + db * db - dc * dc).max(0.0).sqrt(),
        Metric::Ciede2000 | Metric::Flip | Metric::PlusMinus => delta_e_2000(a, b),
    }
}

impl Difference {
    pub fn statistics(&self) -> Statistics {
        let mut sizes: Vec<f64> = self.values.iter().filter(|v| v.is_finite()).map(|v| v.abs()).collect();
        let count = sizes.len().max(1) as f64;
        let mean = sizes.iter().sum::<f64>() / count;
        let root_mean_square = (sizes.iter().map(|v| v * v).sum::<f64>() / count).sqrt();
        sizes.sort_unstable_by(f64::total_cmp);
        let rank = |share: f64| sizes.get(((share * count).ceil() as usize).max(1) - 1).copied().unwrap_or(0.0);
        Statistics {
            mean,
            root_mean_square,
            median: rank(0.5),
            percentile_95: rank(0.95),
            greatest: rank(1.0),
            not_finite: self.values.len() - sizes.len(),
        }
    }

    /// False colours with a scale bar, up to `most` (`None`: the greatest difference). What has no difference is magenta.
    pub fn picture(&self, most: Option<f64>, with_scale: bool) -> DisplayImage {
        let greatest = self.statistics().greatest;
        let most = most.unwrap_or(if greatest > 0.0 { greatest } else { 1.0 });
        let map = if self.metric.is_signed() { ColourMap::PlusMinus } else { ColourMap::Heat };
        let mut image = crate::draw::blank(self.width, self.height, crate::draw::PAPER);
        for (colour, value) in image.rgb.iter_mut().zip(&self.values) {
            *colour = map.colour(value / most);
        }
        if !with_scale {
            return image;
        }
        let least = if map.is_signed() { -most } else { 0.0 };
        beside(&image, &scale_bar(self.height, map, [least, most], &[self.metric.name()]))
    }
}

/// Of the second picture against the first; both of one size with the same bands.
pub fn errors(a: &Picture, b: &Picture) -> Result<Errors, ImagingError> {
    check_alike(a, b)?;
    let (a, b) = match (a, b) {
        (Picture::Spectral(a), Picture::Spectral(b)) => (a.radiance.as_slice(), b.radiance.as_slice()),
        _ => (a.xyz().as_flattened(), b.xyz().as_flattened()),
    };
    let (mut noise, mut signal, mut peak, mut count) = (0.0, 0.0, 0.0f64, 0u64);
    for (a, b) in a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite()) {
        let (a, b) = (f64::from(*a), f64::from(*b));
        (noise, signal) = (noise + (b - a) * (b - a), signal + a * a);
        (peak, count) = (peak.max(a.abs()), count + 1);
    }
    let root_mean_square = (noise / count.max(1) as f64).sqrt();
    let decibels = |ratio: f64| if noise == 0.0 { f64::INFINITY } else { 10.0 * ratio.log10() };
    Ok(Errors {
        root_mean_square,
        peak_signal_to_noise_db: decibels((peak / root_mean_square).powi(2)),
        signal_to_noise_db: decibels(signal / noise),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use arsc_image::{ColourImage, SpectralImage};
    use arsc_spectral::colour::xyz_from_lab;

    fn colours(xyz: &[[f64; 3]]) -> Picture {
        let xyz: Vec<[f32; 3]> = xyz.iter().map(|p| p.map(|c| (c * UNIT_LUMINANCE) as f32)).collect();
        Picture::Colour(ColourImage { width: xyz.len(), height: 1, xyz, channels: vec![], metadata: vec![] })
    }

    fn of_labs(labs: &[[f64; 3]]) -> Picture {
        let white = xyz_of_chromaticity(D65_WHITE).to_array();
        colours(&labs.iter().map(|lab| xyz_from_lab(*lab, white)).collect::<Vec<_>>())
    }

    fn asked(metric: Metric, a: &Picture, b: &Picture) -> Vec<f64> {
        difference(a, b, &Question { metric, ..Question::default() }).unwrap().values
    }

    /// All 34 pairs of table 1 of Sharma, Wu and Dalal 2005, through a picture.
    #[test]
    fn ciede2000_is_the_published_one() {
        let table = include_str!("sharma.csv");
        let row = |line: &str| -> Vec<f64> { line.split(',').map(|n| n.parse().unwrap()).collect() };
        let rows: Vec<Vec<f64>> = table.lines().filter(|l| !l.starts_with('#')).map(row).collect();
        assert_eq!(rows.len(), 34);
        let labs = |from: usize| rows.iter().map(|row| [row[from], row[from + 1], row[from + 2]]).collect::<Vec<_>>();
        for (row, (a, b)) in rows.iter().zip(labs(0).into_iter().zip(labs(3))) {
            assert!((delta_e_2000(a, b) - row[6]).abs() < 5e-5, "{row:?}: {}", delta_e_2000(a, b));
        }
        // Pictures hold 24 bit numbers, and the hues of some pairs lie on a discontinuity.
        let found = asked(Metric::Ciede2000, &of_labs(&labs(0)), &of_labs(&labs(3)));
        for (row, found) in rows.iter().zip(found).filter(|(row, _)| row[2].abs() > 1.0) {
            assert!((found - row[6]).abs() < 1e-3, "{row:?}: {found}");
        }
    }

    #[test]
    fn parts_of_the_difference_are_what_they_say() {
        let (a, b) = (of_labs(&[[50.0, 30.0, 0.0]]), of_labs(&[[53.0, 0.0, 40.0]]));
        for (metric, value) in [
            (Metric::Lightness, 3.0),
            (Metric::Chroma, 10.0),
            (Metric::Hue, (2500.0f64 - 100.0).sqrt()),
            (Metric::Cie76, 2509f64.sqrt()),
        ] {
            let found = asked(metric, &a, &b)[0];
            assert!((found - value).abs() < 1e-3, "{}: {found} instead of {value}", metric.name());
        }
    }

    #[test]
    fn equal_pictures_do_not_differ_and_what_is_not_finite_is_counted() {
        let a = colours(&[[0.2, 0.3, 0.1], [f64::NAN, 0.3, 0.1], [0.4; 3], [0.0; 3]]);
        for metric in Metric::ALL {
            let difference = difference(&a, &a, &Question { metric, ..Question::default() }).unwrap();
            let statistics = difference.statistics();
            assert!(statistics.greatest < 1e-12, "{}: {statistics:?}", metric.name());
            if metric != Metric::PlusMinus {
                assert_eq!(statistics.not_finite, 1, "{}", metric.name());
            }
            difference.picture(None, true).verify().unwrap();
        }
        assert_eq!(errors(&a, &a).unwrap().signal_to_noise_db, f64::INFINITY);
    }

    #[test]
    fn errors_have_their_closed_forms() {
        let (a, b) = (colours(&[[1.0; 3]; 4]), colours(&[[1.1; 3]; 4]));
        let errors = errors(&a, &b).unwrap();
        assert!((errors.root_mean_square / UNIT_LUMINANCE - 0.1).abs() < 1e-6);
        assert!(
            (errors.signal_to_noise_db - 20.0).abs() < 1e-4 && (errors.peak_signal_to_noise_db - 20.0).abs() < 1e-4
        );
    }

    #[test]
    fn radiances_are_compared_at_their_wavelength() {
        let of = |radiance: [f32; 2]| {
            Picture::Spectral(SpectralImage {
                width: 1,
                height: 1,
                band_edges_nm: vec![400.0, 500.0, 600.0],
                radiance: radiance.to_vec(),
                stokes: None,
                xyz: vec![[0.0; 3]],
                channels: vec![],
                metadata: vec![],
            })
        };
        let at = |nm| Question { metric: Metric::PlusMinus, wavelength_nm: Some(nm), ..Question::default() };
        assert_eq!(difference(&of([1.0, 2.0]), &of([1.5, 0.0]), &at(450.0)).unwrap().values, [0.5]);
        assert_eq!(difference(&of([1.0, 2.0]), &of([1.5, 0.0]), &at(550.0)).unwrap().values, [-2.0]);
        assert!(difference(&of([1.0, 2.0]), &of([1.5, 0.0]), &at(700.0)).is_err());
        let wrong = Question { metric: Metric::Flip, ..at(450.0) };
        assert!(difference(&of([1.0, 2.0]), &of([1.5, 0.0]), &wrong).is_err());
    }
}
