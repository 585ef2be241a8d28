//! What a pixel holds: as text and as a plot of its spectrum.

use std::fmt::Write;

use arsc_image::{Picture, UNIT_LUMINANCE};
use arsc_spectral::tone::{Display, Exposure, Gamut, Luminances, ToneMap};
use arsc_spectral::{Observer, chromaticity};
use glam::DVec3;

use crate::ImagingError;
use crate::draw::{Colour, Mark, Plot};

/// One pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixel {
    pub place: [u32; 2],
    /// Y in cd m^-2.
    pub xyz: [f32; 3],
    /// Edges of the bands, nm; empty without a spectrum.
    pub band_edges_nm: Vec<f64>,
    /// Per band, W m^-2 sr^-1 nm^-1.
    pub radiance: Vec<f32>,
    /// S1, S2, S3 per band.
    pub stokes: Option<Vec<[f32; 3]>>,
    pub channels: Vec<(String, f32)>,
}

/// The pixel at x, y from the upper left corner.
pub fn pixel(picture: &Picture, [x, y]: [u32; 2]) -> Result<Pixel, ImagingError> {
    let (width, height) = (picture.width(), picture.height());
    if x as usize >= width || y as usize >= height {
        let what = format!("the pixel {x},{y} does not lie in the picture of {width}x{height} pixels");
        return Err(ImagingError::Arguments(what));
    }
    let at = y as usize * width + x as usize;
    let (mut band_edges_nm, mut radiance, mut stokes) = (Vec::new(), Vec::new(), None);
    if let Picture::Spectral(image) = picture {
        let bands = at * image.bands()..(at + 1) * image.bands();
        band_edges_nm.clone_from(&image.band_edges_nm);
        radiance.extend_from_slice(&image.radiance[bands.clone()]);
        stokes = image.stokes.as_ref().map(|stokes| stokes[bands].to_vec());
    }
    let channels = picture.channels().iter().map(|channel| (channel.name.clone(), channel.samples[at])).collect();
    Ok(Pixel { place: [x, y], xyz: picture.xyz()[at], band_edges_nm, radiance, stokes, channels })
}

impl std::fmt::Display for Pixel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [x, y, z] = self.xyz;
        let [cx, cy] = chromaticity(self.xyz.map(f64::from));
        writeln!(f, "pixel {},{}", self.place[0], self.place[1])?;
        writeln!(f, "XYZ in cd/m2: {x:.6e} {y:.6e} {z:.6e}   xy: {cx:.5} {cy:.5}")?;
        for (name, value) in &self.channels {
            writeln!(f, "{name}: {value}")?;
        }
        if self.radiance.is_empty() {
            return Ok(());
        }
        let polarised = if self.stokes.is_some() { "  S1 S2 S3  degree of polarisation" } else { "" };
        writeln!(f, "nm  W m-2 sr-1 nm-1{polarised}")?;
        for (band, radiance) in self.radiance.iter().enumerate() {
            let center = 0.5 * (self.band_edges_nm[band] + self.band_edges_nm[band + 1]);
            let mut row = format!("{center}  {radiance:.6e}");
            if let Some(stokes) = &self.stokes {
                let [s1, s2, s3] = stokes[band];
                let degree = if *radiance > 0.0 { s1.hypot(s2).hypot(s3) / radiance } else { 0.0 };
                let _ = write!(row, "  {s1:.6e} {s2:.6e} {s3:.6e}  {degree:.4}");
            }
            writeln!(f, "{row}")?;
        }
        Ok(())
    }
}

const INK: Colour = [0.1; 3];
const FAINT: Colour = [0.85; 3];
const STOKES: [Colour; 3] = [[0.80, 0.20, 0.15], [0.15, 0.50, 0.20], [0.20, 0.30, 0.80]];

/// The spectrum as steps over its bands, Stokes parameters in red, green and blue; below it, what the wavelengths look like.
/// `None` without a spectrum.
pub fn spectrum_plot(pixel: &Pixel, [width, height]: [usize; 2]) -> Option<Plot> {
    let (first, last) = (*pixel.band_edges_nm.first()?, *pixel.band_edges_nm.last()?);
    let (left, right, top, bottom) = (64.0, width as f64 - 16.0, 28.0, height as f64 - 44.0);
    let values = || pixel.radiance.iter().chain(pixel.stokes.iter().flatten().flatten()).map(|v| f64::from(*v));
    let finite = || values().filter(|v| v.is_finite());
    let most = Some(finite().fold(0.0, f64::max)).filter(|most| *most > 0.0).unwrap_or(1.0);
    let least = finite().fold(0.0, f64::min);
    let x = |nm: f64| left + (nm - first) / (last - first) * (right - left);
    let y = |value: f64| bottom - (value - least) / (most - least) * (bottom - top);
    let mut marks = Vec::new();
    let grey = |points: Vec<[f64; 2]>, colour| Mark::Line { points, colour };
    for tick in crate::draw::ticks(least, most, 5) {
        marks.push(grey(vec![[left, y(tick)], [right, y(tick)]], FAINT));
        marks.push(words([left - 6.0, y(tick)], crate::draw::label(tick), false));
    }
    for tick in crate::draw::ticks(first, last, 8) {
        marks.push(grey(vec![[x(tick), top], [x(tick), bottom]], FAINT));
        marks.push(words([x(tick), bottom + 24.0], crate::draw::label(tick), true));
    }
    for band in 0..pixel.radiance.len() {
        let (from, to) = (x(pixel.band_edges_nm[band]), x(pixel.band_edges_nm[band + 1]));
        let center = 0.5 * (pixel.band_edges_nm[band] + pixel.band_edges_nm[band + 1]);
        let mark = Mark::Rectangle { corner: [from, bottom + 4.0], size: [to - from, 10.0], colour: seen(center) };
        marks.push(mark);
    }
    let steps = |value: &dyn Fn(usize) -> f32| {
        let ends = |band: usize| {
            let y = y(f64::from(value(band)));
            [[x(pixel.band_edges_nm[band]), y], [x(pixel.band_edges_nm[band + 1]), y]]
        };
        (0..pixel.radiance.len()).filter(|band| value(*band).is_finite()).flat_map(ends).collect::<Vec<_>>()
    };
    if let Some(stokes) = &pixel.stokes {
        for (parameter, colour) in STOKES.into_iter().enumerate() {
            marks.push(grey(steps(&|band| stokes[band][parameter]), colour));
        }
    }
    marks.push(grey(steps(&|band| pixel.radiance[band]), INK));
    let title = format!("pixel {},{}: W m-2 sr-1 nm-1 over nm", pixel.place[0], pixel.place[1]);
    marks.push(words([0.5 * width as f64, 12.0], title, true));
    Some(Plot { size: [width, height], marks })
}

fn words(place: [f64; 2], words: String, centred: bool) -> Mark {
    Mark::Words { place, words, colour: INK, centred }
}

/// What light of a wavelength looks like, dim at the ends of the visible.
fn seen(lambda_nm: f64) -> Colour {
    let wanted = ToneMap { exposure: Exposure::Ev(0.0), gamut: Gamut::Desaturate, ..ToneMap::default() };
    let display = Display::new(&wanted, &Luminances::default());
    display.coded(DVec3::from_array(Observer::Cie1931.matching_at(lambda_nm)) * 0.6).as_vec3().to_array()
}

/// The colour as a display of sRGB shows it at an exposure, coded.
pub fn srgb(pixel: &Pixel, exposure: Exposure) -> [f64; 3] {
    let display = Display::new(&ToneMap { exposure, ..ToneMap::default() }, &Luminances::default());
    display.coded(DVec3::from_array(pixel.xyz.map(|c| f64::from(c) / UNIT_LUMINANCE))).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use arsc_image::{Channel, SpectralImage};

    fn picture() -> Picture {
        Picture::Spectral(SpectralImage {
            width: 2,
            height: 1,
            band_edges_nm: vec![400.0, 500.0, 700.0],
            radiance: vec![1.0, 2.0, 3.0, 4.0],
            stokes: Some(vec![[0.0; 3], [0.0; 3], [3.0, 0.0, 0.0], [0.0, 1.2, 1.6]]),
            xyz: vec![[1.0; 3], [2.0, 4.0, 2.0]],
            channels: vec![Channel { name: "depth.Z".into(), samples: vec![7.0, 8.5] }],
            metadata: vec![],
        })
    }

    #[test]
    fn a_pixel_tells_what_it_holds() {
        let pixel = pixel(&picture(), [1, 0]).unwrap();
        assert_eq!((&pixel.radiance[..], pixel.xyz), (&[3.0, 4.0][..], [2.0, 4.0, 2.0]));
        let text = pixel.to_string();
        for part in [
            "pixel 1,0",
            "xy: 0.25000 0.50000",
            "depth.Z: 8.5",
            "450  3.000000e0",
            "600  4.0",
            " 1.0000\n",
            " 0.5000\n",
        ] {
            assert!(text.contains(part), "`{part}` is not in {text}");
        }
        assert!(super::pixel(&picture(), [2, 0]).is_err() && super::pixel(&picture(), [0, 1]).is_err());
    }

    #[test]
    fn the_plot_is_both_vector_and_pixels() {
        let plot = spectrum_plot(&pixel(&picture(), [1, 0]).unwrap(), [480, 240]).unwrap();
        let svg = plot.to_svg();
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && svg.matches("<polyline").count() > 6);
        let image = plot.to_pixels();
        assert_eq!((image.width, image.height), (480, 240));
        assert!(image.rgb.contains(&INK));
        let dark = Pixel { radiance: vec![f32::NAN, 0.0], ..pixel(&picture(), [0, 0]).unwrap() };
        assert!(!spectrum_plot(&dark, [200, 100]).unwrap().to_svg().contains("NaN"));
    }
}
