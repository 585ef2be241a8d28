//! An environment with the same radiance everywhere.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};

use super::EnvironmentSample;
use crate::warp;

#[derive(Clone, Debug)]
pub struct ConstantEnvironment {
    radiance: DenseSpectrum,
}

impl ConstantEnvironment {
    pub(super) fn new(radiance: &Spectrum) -> ConstantEnvironment {
        ConstantEnvironment { radiance: DenseSpectrum::new(radiance).clamped(0.0, f32::MAX) }
    }

    #[inline]
    pub fn radiance(&self, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        self.radiance.sample(wavelengths)
    }

    #[inline]
    pub(super) fn sample(&self, u: [f64; 2], wavelengths: &SampledWavelengths) -> EnvironmentSample {
        EnvironmentSample {
            wi: warp::uniform_sphere(u),
            radiance: self.radiance(wavelengths),
            pdf: warp::UNIFORM_SPHERE_PDF,
        }
    }

    /// Radiance integrated over the sphere and the rendered range, W m^-2.
    pub(super) fn fluence(&self, range: &WavelengthRange) -> f64 {
        4.0 * std::f64::consts::PI * self.radiance.integral(range)
    }
}
