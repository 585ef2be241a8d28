//! Rough metal: Torrance and Sparrow's model, mirrors turned every way with the reflectance of a complex index.
//!
//! f = F(wo.h) D(h) G / (4 |cos_o cos_i|) with G = 1 / (1 + Lambda(wo) + Lambda(wi)), masking and shadowing correlated by
//! height (Heitz 2014, equation 99). Light that is reflected more than once among the facets is lost. Both sides reflect.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::{BsdfSample, Microfacets, index_of_metal};
use crate::fresnel;
use crate::polarisation::{Mueller, Polarisation, s_axis};

#[derive(Clone, Debug)]
pub struct RoughConductor {
    pub(super) eta: DenseSpectrum,
    pub(super) k: DenseSpectrum,
    pub(super) facets: Microfacets,
}

/// The direction above a two-sided surface.
#[inline]
pub(super) fn above(w: DVec3) -> DVec3 {
    DVec3::new(w.x, w.y, w.z.abs())
}

impl RoughConductor {
    pub(super) fn new(eta: &Spectrum, k: &Spectrum, facets: Microfacets) -> RoughConductor {
        let [eta, k] = index_of_metal(eta, k);
        RoughConductor { eta, k, facets }
    }

    /// The same metal behind a transparent medium of this index.
    pub(super) fn within(&self, index: f64) -> RoughConductor {
        let [eta, k] = super::relative_to(index, &self.eta, &self.k);
        RoughConductor { eta, k, facets: self.facets.clone() }
    }

    /// The facet's normal on the side of `wo`; `None` where nothing is reflected.
    #[inline]
    fn half(wo: DVec3, wi: DVec3) -> Option<DVec3> {
        let sum = wo + wi;
        (wo.z * wi.z > 0.0).then(|| sum.normalize())
    }

    #[inline]
    fn reflect<P: Polarisation>(
        &self,
        wo: DVec3,
        wi: DVec3,
        h: DVec3,
        factor: f64,
        w: &SampledWavelengths,
    ) -> P::Mueller {
        let cos = wo.dot(h).clamp(0.0, 1.0) as f32;
        let effect = fresnel::conductor_reflection(cos, self.eta.sample(w), self.k.sample(w));
        let effect = effect * SampledSpectrum::splat(factor as f32);
        P::Mueller::diattenuating_retarder(&effect, s_axis(h, wo), wo, wi)
    }

    #[inline]
    pub(super) fn eval<P: Polarisation>(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> P::Mueller {
        let Some(h) = Self::half(wo, wi) else { return P::Mueller::depolariser(SampledSpectrum::ZERO) };
        let (up_o, up_i) = (above(wo), above(wi));
        let g = 1.0 / (1.0 + self.facets.lambda(up_o) + self.facets.lambda(up_i));
        let factor = self.facets.density(above(h)) * g / (4.0 * up_o.z * up_i.z);
        self.reflect::<P>(wo, wi, h, if factor.is_finite() { factor } else { 0.0 }, wavelengths)
    }

    #[inline]
    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let Some(h) = Self::half(wo, wi) else { return 0.0 };
        let pdf = self.facets.pdf(above(wo), above(h)) / (4.0 * wo.dot(h));
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u: [f64; 2],
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        if wo.z == 0.0 {
            return None;
        }
        let mut h = self.facets.sample(above(wo), u);
        h.z = h.z.copysign(wo.z);
        let wi = (h * (2.0 * wo.dot(h)) - wo).normalize();
        let pdf = self.pdf(wo, wi);
        if pdf.is_nan() || pdf <= 0.0 {
            return None;
        }
        let weight = self.eval::<P>(wo, wi, wavelengths) * (wi.z.abs() / pdf) as f32;
        Some(BsdfSample { wi, weight, path_pdf: SampledSpectrum::ONE, pdf, specular: false, eta: 1.0 })
    }
}
