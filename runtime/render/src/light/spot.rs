//! Spot lights: a point whose intensity falls as a power of the cosine from its axis, and ends at an angle.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};
use glam::DVec3;

#[derive(Clone, Debug)]
pub struct SpotLight {
    pub position: DVec3,
    /// Unit.
    axis: DVec3,
    /// Along the axis.
    intensity: DenseSpectrum,
    exponent: f64,
    cos_angle: f64,
}

impl SpotLight {
    pub(super) fn new(position: DVec3, axis: DVec3, intensity: &Spectrum, exponent: f64, angle: f64) -> SpotLight {
        SpotLight {
            position,
            axis: axis.normalize_or(DVec3::Z),
            intensity: DenseSpectrum::new(intensity).clamped(0.0, f32::MAX),
            exponent: exponent.max(0.0),
            cos_angle: angle.clamp(0.0, std::f64::consts::FRAC_PI_2).cos(),
        }
    }

    /// Irradiance across the beam at a point.
    #[inline]
    pub fn irradiance(&self, p: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let from = p - self.position;
        let distance2 = from.length_squared();
        let cos = from.dot(self.axis) / distance2.sqrt();
        if cos.is_nan() || cos < self.cos_angle || cos <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        self.intensity.sample(wavelengths) * (cos.powf(self.exponent) / distance2) as f32
    }

    /// 2 pi I (1 - cos^(n + 1)) / (n + 1).
    pub(super) fn power(&self, range: &WavelengthRange) -> f64 {
        let n1 = self.exponent + 1.0;
        std::f64::consts::TAU * self.intensity.integral(range) * (1.0 - self.cos_angle.powf(n1)) / n1
    }
}
