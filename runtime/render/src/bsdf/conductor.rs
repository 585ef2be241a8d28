//! Smooth metal: mirror reflection with Fresnel's reflectance for a complex index.

use arsc_spectral::{DenseSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::{BsdfSample, index_of_metal};
use crate::fresnel;
use crate::polarisation::{DiattenuatingRetarder, Polarisation};

#[derive(Clone, Debug)]
pub struct Conductor {
    eta: DenseSpectrum,
    k: DenseSpectrum,
}

impl Conductor {
    pub(super) fn new(eta: &Spectrum, k: &Spectrum) -> Conductor {
        let [eta, k] = index_of_metal(eta, k);
        Conductor { eta, k }
    }

    /// The same metal behind a transparent medium of this index.
    pub(super) fn within(&self, index: f64) -> Conductor {
        let [eta, k] = super::relative_to(index, &self.eta, &self.k);
        Conductor { eta, k }
    }

    /// What a reflection at an angle of this cosine does.
    #[inline]
    pub fn reflection(&self, cos: f64, wavelengths: &SampledWavelengths) -> DiattenuatingRetarder {
        let cos = cos.abs().min(1.0) as f32;
        fresnel::conductor_reflection(cos, self.eta.sample(wavelengths), self.k.sample(wavelengths))
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(&self, wo: DVec3, wavelengths: &SampledWavelengths) -> Option<BsdfSample<P>> {
        (wo.z != 0.0).then(|| BsdfSample::specular_reflection(wo, &self.reflection(wo.z, wavelengths)))
    }
}
