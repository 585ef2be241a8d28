//! Smooth interface between vacuum outside (where z is positive) and a transparent medium inside, or between two media.
//!
//! Reflection is chosen with the Fresnel reflectance of the hero wavelength. The other wavelengths of the path would
//! reflect into the same direction, so they stay, each with its own probability; they refract into the same direction
//! only if their index is the same. Refraction with dispersion therefore leaves the hero alone. The choice looks at
//! unpolarised light; polarised light is weighted.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::{BsdfSample, index_of_glass};
use crate::fresnel::{self, Interface};
use crate::polarisation::{Mueller, Polarisation, s_axis};

#[derive(Clone, Debug)]
pub struct Dielectric {
    ior: DenseSpectrum,
}

impl Dielectric {
    pub(super) fn new(ior: &Spectrum) -> Dielectric {
        Dielectric { ior: index_of_glass(ior) }
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u_lobe: f64,
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        sample(self.ior.sample(wavelengths), wo, u_lobe)
    }

    pub(super) fn index(&self) -> &DenseSpectrum {
        &self.ior
    }
}

/// Reflection or refraction where the index behind the interface, over that before it, is `ior`.
#[inline]
pub(super) fn sample<P: Polarisation>(ior: SampledSpectrum, wo: DVec3, u_lobe: f64) -> Option<BsdfSample<P>> {
    if wo.z == 0.0 {
        return None;
    }
    let cos_o = wo.z.abs().min(1.0);
    let relative = |index: f32| if wo.z > 0.0 { f64::from(index) } else { 1.0 / f64::from(index) };
    let eta = relative(ior.hero());
    let hero = Interface::new(cos_o, eta);
    let reflectance = hero.reflectance();
    if u_lobe < reflectance {
        if ior.is_flat() {
            let reflection = hero.reflection();
            let effect = fresnel::gather(|_| reflection, 1.0 / reflectance);
            return Some(BsdfSample::specular_reflection(wo, &effect));
        }
        let index = ior.0.to_array();
        let reflection = |lane: usize| Interface::new(cos_o, relative(index[lane])).reflection();
        let effect = fresnel::gather(reflection, 1.0 / reflectance);
        let sample = BsdfSample::specular_reflection(wo, &effect);
        return Some(BsdfSample { path_pdf: effect.a, ..sample });
    }
    let wi = DVec3::new(-wo.x / eta, -wo.y / eta, -hero.cos_t.copysign(wo.z));
    let remaining = if ior.is_flat() { SampledSpectrum::ONE } else { SampledSpectrum::ONE.hero_only() };
    let refraction = hero.refraction();
    let effect = fresnel::gather(|_| refraction, 1.0 / (1.0 - reflectance));
    let weight = remaining * (1.0 / (eta * eta)) as f32;
    let axis = s_axis(DVec3::Z, wo);
    let weight = P::Mueller::diattenuating_retarder(&(effect * weight), axis, wo, wi);
    Some(BsdfSample { wi, weight, path_pdf: remaining, pdf: 1.0, specular: true, eta })
}
