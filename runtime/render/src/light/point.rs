//! Point lights: the same intensity in all directions.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};
use glam::DVec3;

#[derive(Clone, Debug)]
pub struct PointLight {
    pub position: DVec3,
    intensity: DenseSpectrum,
}

impl PointLight {
    pub(super) fn new(position: DVec3, intensity: &Spectrum) -> PointLight {
        PointLight { position, intensity: DenseSpectrum::new(intensity).clamped(0.0, f32::MAX) }
    }

    /// Irradiance across the beam at a squared distance from the light.
    #[inline]
    pub fn irradiance(&self, distance2: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        self.intensity.sample(wavelengths) * (1.0 / distance2) as f32
    }

    pub(super) fn power(&self, range: &WavelengthRange) -> f64 {
        4.0 * std::f64::consts::PI * self.intensity.integral(range)
    }
}
