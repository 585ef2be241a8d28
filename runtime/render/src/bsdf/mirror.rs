//! Ideal mirror: the same reflectance at every angle, on both sides.

use arsc_spectral::{DenseSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::BsdfSample;

#[derive(Clone, Debug)]
pub struct Mirror {
    reflectance: DenseSpectrum,
}

impl Mirror {
    pub(super) fn new(reflectance: &Spectrum) -> Mirror {
        Mirror { reflectance: DenseSpectrum::new(reflectance).clamped(0.0, 1.0) }
    }

    #[inline]
    pub(super) fn sample(&self, wo: DVec3, wavelengths: &SampledWavelengths) -> Option<BsdfSample> {
        (wo.z != 0.0).then(|| BsdfSample::specular_reflection(wo, self.reflectance.sample(wavelengths)))
    }
}
