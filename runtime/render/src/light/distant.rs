//! Distant lights: parallel beams.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};
use glam::DVec3;

#[derive(Clone, Debug)]
pub struct DistantLight {
    /// Unit, towards the light.
    pub wi: DVec3,
    irradiance: DenseSpectrum,
}

impl DistantLight {
    pub(super) fn new(direction: DVec3, irradiance: &Spectrum) -> DistantLight {
        DistantLight {
            wi: (-direction).normalize_or(DVec3::Z),
            irradiance: DenseSpectrum::new(irradiance).clamped(0.0, f32::MAX),
        }
    }

    /// Irradiance across the beam.
    #[inline]
    pub fn irradiance(&self, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        self.irradiance.sample(wavelengths)
    }

    pub(super) fn power(&self, scene_radius: f64, range: &WavelengthRange) -> f64 {
        std::f64::consts::PI * scene_radius * scene_radius * self.irradiance.integral(range)
    }
}
