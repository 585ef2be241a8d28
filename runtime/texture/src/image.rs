//! Pictures on surfaces.
//!
//! The picture fills the unit square of the surface coordinates, (0, 0) being its lower left corner. Lookups are at full
//! resolution: what a pixel of the render averages is left to its samples, which converge to the average of the picture
//! itself. A pyramid of smaller pictures would be quicker to converge, and biased.

use std::sync::Arc;

use arsc_spectral::{Channels, ColourBasis, Raster, SampledSpectrum, SampledWavelengths, srgb};
use glam::{DVec2, Vec3};

/// A picture and how it is laid on a surface.
#[derive(Clone, Debug)]
pub struct ImageMap {
    /// From the root script's folder.
    pub path: Arc<str>,
    pub raster: Arc<Raster>,
    /// It fills the plane again and again; otherwise its border goes on.
    pub repeat: bool,
    /// Linear between the centres of four pixels; otherwise each pixel is of one colour.
    pub smooth: bool,
    /// The values are numbers as the file has them: no transfer function of colours was undone.
    pub data: bool,
}

/// The values as a file of coded colours holds them.
fn coded(raster: &Raster) -> Raster {
    let mut values = Vec::new();
    for row in 0..raster.height() {
        for column in 0..raster.width() {
            values.extend(raster.pixel(column, row).iter().map(|value| srgb::encode(f64::from(*value)) as f32));
        }
    }
    let coded = Raster::new(raster.width(), raster.height(), raster.channels().clone(), values);
    coded.unwrap_or_else(|| raster.clone())
}

/// Of the same file and laid alike: pictures do not change while a script is compiled.
impl PartialEq for ImageMap {
    fn eq(&self, other: &ImageMap) -> bool {
        let settings = |map: &ImageMap| (map.repeat, map.smooth, map.data);
        self.path == other.path && settings(self) == settings(other)
    }
}

/// Four pixels with their weights.
struct Corners {
    columns: [usize; 2],
    rows: [usize; 2],
    /// Of the second column and row.
    part: DVec2,
}

impl ImageMap {
    /// `raster` is linear. For `data` the transfer function of sRGB that its reader undid is applied again, unless the name
    /// says that the file is linear itself.
    pub fn new(path: Arc<str>, raster: Arc<Raster>, repeat: bool, smooth: bool, data: bool) -> ImageMap {
        let lower = path.to_ascii_lowercase();
        let is_linear = [".exr", ".hdr", ".pic", ".artraw", ".csv"].iter().any(|ending| lower.ends_with(ending));
        let raster = if data && !is_linear { Arc::new(coded(&raster)) } else { raster };
        ImageMap { path, raster, repeat, smooth, data }
    }

    fn corners(&self, uv: DVec2) -> Corners {
        let (width, height) = (self.raster.width(), self.raster.height());
        let axis = |x: f64, size: usize| {
            let x = if x.is_finite() { x } else { 0.0 };
            let x = if self.repeat { x.rem_euclid(1.0) } else { x.clamp(0.0, 1.0) } * size as f64;
            let x = if self.smooth { x - 0.5 } else { x.floor() };
            let low = x.floor();
            let index = |i: f64| match (self.repeat, i) {
                (true, i) => i.rem_euclid(size as f64) as usize,
                (false, i) => i.max(0.0) as usize,
            };
            ([low, low + 1.0].map(|i| index(i).min(size - 1)), x - low)
        };
        let (columns, part_x) = axis(uv.x, width);
        let (rows, part_y) = axis(uv.y, height);
        // Rows are stored from the top.
        Corners { columns, rows: rows.map(|row| height - 1 - row), part: DVec2::new(part_x, part_y) }
    }

    /// The sum of what `of` makes of the pixels about a place, by their weights.
    fn blend<T>(&self, uv: DVec2, zero: T, mut of: impl FnMut(T, usize, usize, f64) -> T) -> T {
        let Corners { columns, rows, part } = self.corners(uv);
        let mut sum = zero;
        for (row, weight_y) in rows.into_iter().zip([1.0 - part.y, part.y]) {
            for (column, weight_x) in columns.into_iter().zip([1.0 - part.x, part.x]) {
                if weight_x * weight_y > 0.0 {
                    sum = of(sum, column, row, weight_x * weight_y);
                }
            }
        }
        sum
    }

    /// Red, green or blue; of a picture of spectra, the mean of the bands of a third of them, from long to short waves.
    fn component(&self, column: usize, row: usize, channel: usize) -> f64 {
        let pixel = self.raster.pixel(column, row);
        match self.raster.channels() {
            Channels::Rgb => pixel[channel].into(),
            Channels::Spectral(_) => {
                let n = pixel.len();
                let bands =
                    &pixel[n * (2 - channel) / 3..(n * (3 - channel) / 3).max(n * (2 - channel) / 3 + 1).min(n)];
                bands.iter().map(|value| f64::from(*value)).sum::<f64>() / bands.len().max(1) as f64
            }
        }
    }

    /// A component (0 to 2) at a place.
    pub fn channel(&self, uv: DVec2, channel: usize) -> f64 {
        self.blend(uv, 0.0, |sum, column, row, weight| sum + weight * self.component(column, row, channel))
    }

    /// Derivatives of [`ImageMap::channel`] by u and v.
    pub fn channel_slope(&self, uv: DVec2, channel: usize) -> DVec2 {
        if !self.smooth {
            return DVec2::ZERO;
        }
        let Corners { columns, rows, part } = self.corners(uv);
        let value = |i: usize, j: usize| self.component(columns[i], rows[j], channel);
        let along_u = (value(1, 0) - value(0, 0)) * (1.0 - part.y) + (value(1, 1) - value(0, 1)) * part.y;
        let along_v = (value(0, 1) - value(0, 0)) * (1.0 - part.x) + (value(1, 1) - value(1, 0)) * part.x;
        DVec2::new(along_u * self.raster.width() as f64, along_v * self.raster.height() as f64)
    }

    /// The reflectance at a place: that of the colour ([`ColourBasis::reflectance`]), or the picture's own spectrum.
    pub fn reflectance(&self, uv: DVec2, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        match self.raster.channels() {
            Channels::Rgb => {
                let rgb = self.blend(uv, Vec3::ZERO, |sum, column, row, weight| {
                    sum + Vec3::from_slice(self.raster.pixel(column, row)) * weight as f32
                });
                ColourBasis::reflectance().sample(rgb.to_array(), wavelengths)
            }
            Channels::Spectral(_) => self.blend(uv, SampledSpectrum::ZERO, |mut sum, column, row, weight| {
                sum += self.raster.spectrum(column, row, wavelengths) * weight as f32;
                sum
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two by two: red 1, 2 above, 3, 4 below.
    fn map(repeat: bool, smooth: bool) -> ImageMap {
        let values = [1.0, 2.0, 3.0, 4.0].into_iter().flat_map(|red| [red, 0.0, 0.5]).collect();
        let raster = Arc::new(Raster::new(2, 2, Channels::Rgb, values).expect("sound"));
        ImageMap { path: "a.png".into(), raster, repeat, smooth, data: false }
    }

    #[test]
    fn pixels_are_where_they_are_seen() {
        let map = map(false, false);
        for (u, v, wanted) in [(0.1, 0.9, 1.0), (0.9, 0.9, 2.0), (0.1, 0.1, 3.0), (0.9, 0.1, 4.0), (1.0, 1.0, 2.0)] {
            assert_eq!(map.channel(DVec2::new(u, v), 0), wanted, "{u} {v}");
            assert_eq!(map.channel(DVec2::new(u, v), 2), 0.5);
        }
    }

    #[test]
    fn lookups_between_pixels_are_linear_and_borders_go_on_or_repeat() {
        let (clamped, repeated) = (map(false, true), map(true, true));
        let at = |map: &ImageMap, u: f64, v: f64| map.channel(DVec2::new(u, v), 0);
        assert_eq!(at(&clamped, 0.5, 0.5), 2.5);
        assert_eq!(at(&clamped, 0.375, 0.75), 1.25);
        assert_eq!(at(&clamped, 0.0, 0.75), 1.0);
        assert_eq!(at(&clamped, -7.0, 9.0), 1.0);
        assert_eq!(at(&repeated, 0.0, 0.75), 1.5);
        assert_eq!(at(&repeated, 1.0, 0.75), 1.5);
        assert_eq!(at(&repeated, 3.375, -0.25), 1.25);
        assert_eq!(at(&repeated, f64::NAN, f64::INFINITY), at(&repeated, 0.0, 0.0));
    }

    #[test]
    fn slopes_are_those_of_the_values() {
        for map in [map(false, true), map(true, true)] {
            let (uv, h) = (DVec2::new(0.41, 0.63), 1e-6);
            for axis in [DVec2::X, DVec2::Y] {
                let wanted = (map.channel(uv + axis * h, 0) - map.channel(uv - axis * h, 0)) / (2.0 * h);
                assert!((map.channel_slope(uv, 0).dot(axis) - wanted).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn spectra_of_pictures_are_their_own() {
        let channels = Channels::Spectral(vec![400.0, 500.0, 600.0]);
        let raster = Arc::new(Raster::new(1, 1, channels, vec![0.1, 0.2, 0.6]).expect("sound"));
        let map = ImageMap { path: "a.exr".into(), raster, repeat: true, smooth: true, data: false };
        let found = map.reflectance(DVec2::new(0.3, 0.3), &SampledWavelengths::fixed([400.0, 450.0, 500.0, 550.0]));
        let wanted = [0.1f32, 0.15, 0.2, 0.4];
        assert!(found.0.to_array().iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?}");
        assert_eq!([0, 1, 2].map(|c| map.channel(DVec2::ZERO, c) as f32), [0.6, 0.2, 0.1]);
    }

    #[test]
    fn colours_give_their_spectra() {
        let w = SampledWavelengths::fixed([450.0, 500.0, 550.0, 650.0]);
        let grey = Raster::new(1, 1, Channels::Rgb, vec![0.25; 3]).expect("sound");
        let grey = ImageMap { raster: Arc::new(grey), ..map(true, true) };
        assert_eq!(grey.reflectance(DVec2::ZERO, &w), SampledSpectrum::splat(0.25));
    }
}
