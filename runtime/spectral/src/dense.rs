//! Spectra tabulated for the inner loop.
//!
//! Knots every nanometre over the range of the tables ([`crate::TABLE_MIN_NM`]); the value between knots is that of the
//! nearest one. Single precision.

use glam::Vec4;

use crate::range::{KNOTS, knot_nm, nearest_knot};
use crate::{SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};

/// A spectrum as the renderer holds it.
#[derive(Clone, Debug, PartialEq)]
pub enum DenseSpectrum {
    Constant(f32),
    Table(Box<[f32; KNOTS]>),
    /// Known at the four wavelengths of one path alone, which are all that may be asked for: what varies over a surface, at
    /// a hit. Elsewhere it counts as its hero's value.
    Sampled(SampledSpectrum),
}

impl DenseSpectrum {
    /// Tabulates. A value that is not finite becomes zero.
    pub fn new(spectrum: &Spectrum) -> DenseSpectrum {
        DenseSpectrum::from_fn(|lambda_nm| spectrum.eval(lambda_nm))
    }

    /// Tabulates a function of wavelength. A value that is not finite becomes zero.
    pub fn from_fn(value_at: impl Fn(f64) -> f64) -> DenseSpectrum {
        let mut table = Box::new([0.0; KNOTS]);
        for (i, entry) in table.iter_mut().enumerate() {
            let value = value_at(knot_nm(i)) as f32;
            *entry = if value.is_finite() { value } else { 0.0 };
        }
        if table.iter().all(|value| *value == table[0]) {
            DenseSpectrum::Constant(table[0])
        } else {
            DenseSpectrum::Table(table)
        }
    }

    /// Every value limited to `[low, high]`.
    pub fn clamped(mut self, low: f32, high: f32) -> DenseSpectrum {
        match &mut self {
            DenseSpectrum::Constant(value) => *value = value.clamp(low, high),
            DenseSpectrum::Table(table) => table.iter_mut().for_each(|value| *value = value.clamp(low, high)),
            DenseSpectrum::Sampled(values) => *values = values.map(|value| value.clamp(low, high)),
        }
        self
    }

    /// Values at the sampled wavelengths.
    #[inline]
    pub fn sample(&self, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        match self {
            DenseSpectrum::Constant(value) => SampledSpectrum(Vec4::splat(*value)),
            DenseSpectrum::Table(table) => {
                let [a, b, c, d] = wavelengths.knots;
                SampledSpectrum(Vec4::new(table[a as usize], table[b as usize], table[c as usize], table[d as usize]))
            }
            DenseSpectrum::Sampled(values) => *values,
        }
    }

    /// The value at the knot nearest to a wavelength.
    pub fn at(&self, lambda_nm: f64) -> f32 {
        match self {
            DenseSpectrum::Constant(value) => *value,
            DenseSpectrum::Table(table) => table[nearest_knot(lambda_nm as f32) as usize],
            DenseSpectrum::Sampled(values) => values.hero(),
        }
    }

    pub fn is_constant(&self) -> bool {
        matches!(self, DenseSpectrum::Constant(_))
    }

    /// Integral over a range, in the spectrum's unit times nm; the table counts as linear between its knots.
    pub fn integral(&self, range: &WavelengthRange) -> f64 {
        match self {
            DenseSpectrum::Constant(value) => f64::from(*value) * range.width_nm(),
            DenseSpectrum::Sampled(values) => f64::from(values.hero()) * range.width_nm(),
            DenseSpectrum::Table(table) => {
                // The part of each cell that lies within the range, and the middle of that part.
                let cell = |i: usize| {
                    let (low, high) = (knot_nm(i).max(range.min_nm()), knot_nm(i + 1).min(range.max_nm()));
                    let t = 0.5 * (low + high) - knot_nm(i);
                    let value = f64::from(table[i]) * (1.0 - t) + f64::from(table[i + 1]) * t;
                    (high - low).max(0.0) * value
                };
                (0..KNOTS - 1).map(cell).sum()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_agree_with_their_spectrum_at_the_knots() {
        let spectrum = Spectrum::Blackbody { kelvin: 4000.0 };
        let dense = DenseSpectrum::new(&spectrum);
        for lambda in [201.0, 360.0, 361.0, 555.0, 829.0, 830.0, 1099.0] {
            let exact = spectrum.eval(lambda) as f32;
            assert_eq!(dense.at(lambda), exact);
            assert_eq!(dense.at(lambda + 0.4), exact);
            assert_eq!(dense.at(lambda - 0.4), exact);
        }
    }

    #[test]
    fn constants_are_recognised_and_poles_removed() {
        let half = Spectrum::Scaled { factor: 0.5, spectrum: std::sync::Arc::new(Spectrum::Constant(1.0)) };
        assert_eq!(DenseSpectrum::new(&half), DenseSpectrum::Constant(0.5));
        let bad = DenseSpectrum::from_fn(|lambda| if lambda == 500.0 { f64::NAN } else { lambda });
        assert_eq!(bad.at(500.0), 0.0);
        assert_eq!(bad.at(501.0), 501.0);
    }

    #[test]
    fn integral_of_a_linear_spectrum_is_exact() {
        let line = DenseSpectrum::from_fn(|lambda| lambda - 360.0);
        assert!((line.integral(&WavelengthRange::VISIBLE) - 470.0 * 235.0).abs() < 1e-3);
        let odd = WavelengthRange::new(400.25, 501.75).unwrap();
        assert!((line.integral(&odd) - 101.5 * 91.0).abs() < 1e-3, "{}", line.integral(&odd));
        assert_eq!(DenseSpectrum::Constant(2.0).integral(&WavelengthRange::VISIBLE), 940.0);
    }
}
