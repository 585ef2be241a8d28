//! Ideal diffuse reflection: f = reflectance / pi. It depolarises.

use std::f32::consts::FRAC_1_PI;

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::{BsdfSample, cosine_direction, cosine_pdf};
use crate::polarisation::Polarisation;

#[derive(Clone, Debug)]
pub struct Lambert {
    pub(super) reflectance: DenseSpectrum,
}

impl Lambert {
    pub(super) fn new(reflectance: &Spectrum) -> Lambert {
        Lambert { reflectance: DenseSpectrum::new(reflectance).clamped(0.0, 1.0) }
    }

    pub(super) fn reflectance(&self) -> &DenseSpectrum {
        &self.reflectance
    }

    #[inline]
    pub(super) fn eval(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        if wo.z * wi.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        self.reflectance.sample(wavelengths) * FRAC_1_PI
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u: [f64; 2],
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        let wi = cosine_direction(wo, u)?;
        Some(BsdfSample::diffuse(wi, self.reflectance.sample(wavelengths), cosine_pdf(wo, wi)))
    }
}
