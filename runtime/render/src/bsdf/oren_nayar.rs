//! Rough diffuse reflection by Lambertian facets with Gaussian slopes. It depolarises.
//!
//! The qualitative model of Oren and Nayar 1994, equation 30: f = reflectance / pi (A + B max(0, cos dphi) sin alpha
//! tan beta), A = 1 - sigma^2 / (2 (sigma^2 + 0.33)), B = 0.45 sigma^2 / (sigma^2 + 0.09). The angular factor is
//! evaluated without trigonometry as max(0, wi . wo - cos_i cos_o) / max(cos_i, cos_o) (Fujii).
//! Deviation: towards grazing incidence the model's albedo approaches A + B / 2, which is above 1 by as much as 1.5 %
//! for sigma below 0.33; there the whole function is divided by that limit, so that no energy is gained.

use std::f64::consts::FRAC_1_PI;

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::{BsdfSample, cosine_direction, cosine_pdf};
use crate::polarisation::Polarisation;

#[derive(Clone, Debug)]
pub struct OrenNayar {
    pub(super) reflectance: DenseSpectrum,
    a: f64,
    b: f64,
}

impl OrenNayar {
    pub(super) fn new(reflectance: &Spectrum, sigma: f64) -> OrenNayar {
        let reflectance = DenseSpectrum::new(reflectance).clamped(0.0, 1.0);
        OrenNayar { reflectance, a: 1.0, b: 0.0 }.with_sigma(sigma)
    }

    /// The same shape in another colour, of another roughness if one is given.
    pub(super) fn with_parameters(&self, reflectance: DenseSpectrum, sigma: Option<f64>) -> OrenNayar {
        let own = OrenNayar { reflectance, a: self.a, b: self.b };
        match sigma {
            Some(sigma) => own.with_sigma(sigma),
            None => own,
        }
    }

    /// The same colour of another roughness.
    fn with_sigma(self, sigma: f64) -> OrenNayar {
        let sigma2 = if sigma.is_finite() { sigma * sigma } else { 0.0 };
        let a = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
        let b = 0.45 * sigma2 / (sigma2 + 0.09);
        let scale = 1.0 / (a + 0.5 * b).max(1.0);
        OrenNayar { reflectance: self.reflectance, a: a * scale, b: b * scale }
    }

    /// pi f over the reflectance.
    #[inline]
    fn shape(&self, wo: DVec3, wi: DVec3) -> f64 {
        let (cos_o, cos_i) = (wo.z.abs(), wi.z.abs());
        let s = wo.x * wi.x + wo.y * wi.y;
        self.a + self.b * s.max(0.0) / cos_o.max(cos_i)
    }

    #[inline]
    pub(super) fn eval(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        if wo.z * wi.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        self.reflectance.sample(wavelengths) * (self.shape(wo, wi) * FRAC_1_PI) as f32
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u: [f64; 2],
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        let wi = cosine_direction(wo, u)?;
        let weight = self.reflectance.sample(wavelengths) * self.shape(wo, wi) as f32;
        Some(BsdfSample::diffuse(wi, weight, cosine_pdf(wo, wi)))
    }
}
