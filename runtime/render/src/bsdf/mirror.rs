//! Ideal mirror: the same reflectance at every angle, on both sides. Polarised light is turned over, as by a perfect
//! conductor.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::BsdfSample;
use crate::polarisation::{DiattenuatingRetarder, Polarisation};

#[derive(Clone, Debug)]
pub struct Mirror {
    pub(super) reflectance: DenseSpectrum,
}

impl Mirror {
    pub(super) fn new(reflectance: &Spectrum) -> Mirror {
        Mirror { reflectance: DenseSpectrum::new(reflectance).clamped(0.0, 1.0) }
    }

    #[inline]
    pub(super) fn reflectance(&self, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        self.reflectance.sample(wavelengths)
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(&self, wo: DVec3, wavelengths: &SampledWavelengths) -> Option<BsdfSample<P>> {
        let effect = DiattenuatingRetarder::mirror(self.reflectance.sample(wavelengths));
        (wo.z != 0.0).then(|| BsdfSample::specular_reflection(wo, &effect))
    }
}
