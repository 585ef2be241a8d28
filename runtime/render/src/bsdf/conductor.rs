//! Smooth metal: mirror reflection with Fresnel's reflectance for a complex index.

use arsc_spectral::{DenseSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::BsdfSample;
use crate::fresnel;
use crate::polarisation::Polarisation;

/// Smallest real part of the index: keeps the equations away from 0/0.
const MIN_ETA: f32 = 1e-3;
const MAX_INDEX: f32 = 1e3;

#[derive(Clone, Debug)]
pub struct Conductor {
    eta: DenseSpectrum,
    k: DenseSpectrum,
}

impl Conductor {
    pub(super) fn new(eta: &Spectrum, k: &Spectrum) -> Conductor {
        Conductor {
            eta: DenseSpectrum::new(eta).clamped(MIN_ETA, MAX_INDEX),
            k: DenseSpectrum::new(k).clamped(0.0, MAX_INDEX),
        }
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(&self, wo: DVec3, wavelengths: &SampledWavelengths) -> Option<BsdfSample<P>> {
        let cos = wo.z.abs().min(1.0) as f32;
        let effect = fresnel::conductor_reflection(cos, self.eta.sample(wavelengths), self.k.sample(wavelengths));
        (wo.z != 0.0).then(|| BsdfSample::specular_reflection(wo, &effect))
    }
}
