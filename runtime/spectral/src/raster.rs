//! Pictures as data: a grid of colours or of spectra, row by row from the top.

use crate::{SampledSpectrum, SampledWavelengths};

/// What a pixel holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Channels {
    /// Linear sRGB.
    Rgb,
    /// Samples at these wavelengths, nm: strictly increasing, at least one. Linear between them, and constant beyond by half of
    /// the distance to the neighbour; zero further out.
    Spectral(Vec<f64>),
}

/// A picture. All values are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    width: usize,
    height: usize,
    channels: Channels,
    /// `[y][x][channel]`.
    values: Vec<f32>,
}

impl Raster {
    /// `None` if it has no pixel, if wavelengths do not increase, or if there are not as many values as pixels and channels
    /// demand. Values that are not finite become zero.
    pub fn new(width: usize, height: usize, channels: Channels, mut values: Vec<f32>) -> Option<Raster> {
        let count = match &channels {
            Channels::Rgb => 3,
            Channels::Spectral(lambda_nm) => {
                let positive = lambda_nm.first().is_some_and(|first| *first > 0.0);
                let increases = lambda_nm.windows(2).all(|pair| pair[0] < pair[1]);
                if !positive || !increases || !lambda_nm[lambda_nm.len() - 1].is_finite() {
                    return None;
                }
                lambda_nm.len()
            }
        };
        let due = width.checked_mul(height)?.checked_mul(count)?;
        if due == 0 || due != values.len() {
            return None;
        }
        values.iter_mut().filter(|value| !value.is_finite()).for_each(|value| *value = 0.0);
        Some(Raster { width, height, channels, values })
    }

    pub fn width(&self) -> usize {
        self.width
    }

    pub fn height(&self) -> usize {
        self.height
    }

    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    fn channel_count(&self) -> usize {
        match &self.channels {
            Channels::Rgb => 3,
            Channels::Spectral(lambda_nm) => lambda_nm.len(),
        }
    }

    /// The channels of a pixel; column and row must be within the picture.
    #[inline]
    pub fn pixel(&self, column: usize, row: usize) -> &[f32] {
        let count = self.channel_count();
        let at = (row * self.width + column) * count;
        &self.values[at..at + count]
    }

    /// The spectrum of a pixel of samples at the wavelengths of a path; zero for a picture of colours.
    #[inline]
    pub fn spectrum(&self, column: usize, row: usize, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let Channels::Spectral(lambda_nm) = &self.channels else { return SampledSpectrum::ZERO };
        let pixel = self.pixel(column, row);
        SampledSpectrum(wavelengths.lambda_nm).map(|lambda| interpolate(lambda_nm, pixel, f64::from(lambda)))
    }
}

fn interpolate(lambda_nm: &[f64], values: &[f32], lambda: f64) -> f32 {
    let last = lambda_nm.len() - 1;
    let above = lambda_nm.partition_point(|knot| *knot <= lambda);
    let half = |a: usize, b: usize| if last == 0 { 0.5 } else { 0.5 * (lambda_nm[b] - lambda_nm[a]) };
    match above {
        0 if lambda < lambda_nm[0] - half(0, 1.min(last)) => 0.0,
        0 => values[0],
        above if above > last => {
            let beyond = lambda > lambda_nm[last] + half(last.saturating_sub(1), last);
            if beyond { 0.0 } else { values[last] }
        }
        above => {
            let t = (lambda - lambda_nm[above - 1]) / (lambda_nm[above] - lambda_nm[above - 1]);
            values[above - 1] + (values[above] - values[above - 1]) * t as f32
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectra_are_linear_and_end_half_a_step_beyond() {
        let raster = Raster::new(1, 1, Channels::Spectral(vec![400.0, 500.0, 520.0]), vec![1.0, 3.0, 5.0]).unwrap();
        let at = |lambda: [f64; 4]| raster.spectrum(0, 0, &SampledWavelengths::fixed(lambda)).0.to_array();
        assert_eq!(at([349.0, 351.0, 450.0, 510.0]), [0.0, 1.0, 2.0, 4.0]);
        assert_eq!(at([520.0, 529.0, 531.0, 400.0]), [5.0, 5.0, 0.0, 1.0]);
    }

    #[test]
    fn what_does_not_fit_is_refused_and_infinities_become_dark() {
        assert!(Raster::new(2, 1, Channels::Rgb, vec![0.0; 5]).is_none());
        assert!(Raster::new(0, 1, Channels::Rgb, vec![]).is_none());
        assert!(Raster::new(usize::MAX, 2, Channels::Rgb, vec![]).is_none());
        assert!(Raster::new(1, 1, Channels::Spectral(vec![500.0, 500.0]), vec![0.0; 2]).is_none());
        let raster = Raster::new(1, 1, Channels::Rgb, vec![1.0, f32::NAN, f32::INFINITY]).unwrap();
        assert_eq!(raster.pixel(0, 0), [1.0, 0.0, 0.0]);
    }
}
