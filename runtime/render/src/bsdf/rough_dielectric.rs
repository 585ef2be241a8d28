//! Rough glass: interfaces turned every way between vacuum outside (where z is positive) and a transparent medium
//! inside (Walter, Marschner, Li and Torrance 2007, equations 20 and 21, with radiance scaled as there).
//!
//! Masking is correlated by height for reflection, and independent of shadowing for refraction. Light that meets more than
//! one facet is lost. Reflection or refraction is chosen with the reflectance of the facet at the hero's index.
//! Each wavelength has its own density of directions, and its own facet for a pair of directions: dispersion costs
//! no wavelength here. An index of 1 would leave no facet to be found: what is nearer than [`INDEX_STEP`] is moved.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::{DVec3, Vec4};

use super::rough_conductor::above;
use super::{BsdfSample, Microfacets, limited_index};
use crate::fresnel::{self, Interface};
use crate::polarisation::{Mueller, Polarisation, s_axis};

/// Distance of the index from 1, at least.
const INDEX_STEP: f32 = 1e-4;

/// The index, kept away from 1.
fn apart(index: f32) -> f32 {
    if (index - 1.0).abs() < INDEX_STEP { 1.0 + INDEX_STEP } else { index }
}

#[derive(Clone, Debug)]
pub struct RoughDielectric {
    pub(super) ior: DenseSpectrum,
    pub(super) facets: Microfacets,
}

/// How a facet leads light from `wi` to `wo`, for one wavelength.
#[derive(Clone, Copy)]
struct Facet {
    /// On the side of `wo`.
    h: DVec3,
    interface: Interface,
    /// Probability density of `wi`, the choice of the lobe included.
    pdf: f64,
    /// f over the facet's reflectance or transmittance.
    factor: f64,
}

impl RoughDielectric {
    pub(super) fn new(ior: &Spectrum, facets: Microfacets) -> RoughDielectric {
        let ior = DenseSpectrum::from_fn(|lambda_nm| f64::from(apart(ior.eval(lambda_nm) as f32)));
        RoughDielectric { ior: limited_index(ior), facets }
    }

    /// `eta` is the index on the other side than `wo` over that on its own.
    #[inline]
    fn facet(&self, wo: DVec3, wi: DVec3, eta: f64) -> Option<Facet> {
        let reflected = wo.z * wi.z > 0.0;
        let sum = if reflected { wo + wi } else { wo + wi * eta };
        let mut h = sum.try_normalize()?;
        if h.z * wo.z < 0.0 {
            h = -h;
        }
        let (oh, ih) = (wo.dot(h), wi.dot(h));
        if wo.z == 0.0 || wi.z == 0.0 || oh <= 0.0 || (ih > 0.0) != reflected {
            return None;
        }
        let interface = Interface::new(oh.min(1.0), eta);
        let reflectance = interface.reflectance();
        let (up_o, up_i, up_h) = (above(wo), above(wi), above(h));
        let (density, visible) = (self.facets.density(up_h), self.facets.pdf(up_o, up_h));
        let (lambda_o, lambda_i) = (self.facets.lambda(up_o), self.facets.lambda(up_i));
        let (pdf, factor) = if reflected {
            let g = 1.0 / (1.0 + lambda_o + lambda_i);
            (reflectance * visible / (4.0 * oh), density * g / (4.0 * up_o.z * up_i.z))
        } else {
            let g = 1.0 / ((1.0 + lambda_o) * (1.0 + lambda_i));
            let root = eta * ih + oh;
            let jacobian = -ih / (root * root);
            ((1.0 - reflectance) * visible * jacobian * eta * eta, density * g * jacobian * oh / (up_o.z * up_i.z))
        };
        (pdf.is_finite() && factor.is_finite()).then_some(Facet { h, interface, pdf, factor })
    }

    pub(super) fn index(&self) -> &DenseSpectrum {
        &self.ior
    }

    /// The index behind the interface over that before it: `relative`, or for vacuum outside.
    #[inline]
    pub(super) fn ior(&self, relative: Option<SampledSpectrum>, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        relative.map_or_else(|| self.ior.sample(wavelengths), |index| index.map(apart))
    }

    #[inline]
    fn relative(wo: DVec3, index: f32) -> f64 {
        if wo.z > 0.0 { f64::from(index) } else { 1.0 / f64::from(index) }
    }

    #[inline]
    fn facets_of(&self, wo: DVec3, wi: DVec3, ior: SampledSpectrum) -> [Option<Facet>; 4] {
        let [a, b, c, d] = ior.0.to_array().map(|index| Self::relative(wo, index));
        let hero = self.facet(wo, wi, a);
        if ior.is_flat() {
            return [hero; 4];
        }
        [hero, self.facet(wo, wi, b), self.facet(wo, wi, c), self.facet(wo, wi, d)]
    }

    #[inline]
    fn value<P: Polarisation>(wo: DVec3, wi: DVec3, facets: &[Option<Facet>; 4], scale: f64) -> P::Mueller {
        let reflected = wo.z * wi.z > 0.0;
        let elements = |lane: usize| {
            facets[lane].map_or([0.0; 4], |facet| {
                let interface = &facet.interface;
                let [a, b, c, s] = if reflected { interface.reflection() } else { interface.refraction() };
                let factor = facet.factor;
                [a * factor, b * factor, c * factor, s * factor]
            })
        };
        // All facets lie in the plane of the two directions: they share s.
        let Some(h) = facets.iter().flatten().map(|facet| facet.h).next() else {
            return P::Mueller::depolariser(SampledSpectrum::ZERO);
        };
        P::Mueller::diattenuating_retarder(&fresnel::gather(elements, scale), s_axis(h, wo), wo, wi)
    }

    #[inline]
    pub(super) fn eval<P: Polarisation>(&self, wo: DVec3, wi: DVec3, ior: SampledSpectrum) -> P::Mueller {
        Self::value::<P>(wo, wi, &self.facets_of(wo, wi, ior), 1.0)
    }

    /// Density of `wi` at each wavelength.
    #[inline]
    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3, ior: SampledSpectrum) -> SampledSpectrum {
        let [a, b, c, d] = self.facets_of(wo, wi, ior).map(|f| f.map_or(0.0, |facet| facet.pdf as f32));
        SampledSpectrum(Vec4::new(a, b, c, d))
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u: [f64; 2],
        u_lobe: f64,
        ior: SampledSpectrum,
    ) -> Option<BsdfSample<P>> {
        if wo.z == 0.0 {
            return None;
        }
        let mut h = self.facets.sample(above(wo), u);
        h.z = h.z.copysign(wo.z);
        let oh = wo.dot(h);
        if oh <= 0.0 {
            return None;
        }
        let eta = Self::relative(wo, ior.hero());
        let interface = Interface::new(oh.min(1.0), eta);
        let reflected = u_lobe < interface.reflectance();
        let wi = if reflected { h * (2.0 * oh) - wo } else { h * (oh / eta - interface.cos_t) - wo / eta };
        let wi = wi.normalize();
        if (wi.z * wo.z > 0.0) != reflected {
            return None;
        }
        let facets = self.facets_of(wo, wi, ior);
        let pdf = facets[0]?.pdf;
        if pdf.is_nan() || pdf <= 0.0 {
            return None;
        }
        let ratio = |lane: usize| facets[lane].map_or(0.0, |facet| (facet.pdf / pdf) as f32);
        let path_pdf = SampledSpectrum(Vec4::new(1.0, ratio(1), ratio(2), ratio(3)));
        let weight = Self::value::<P>(wo, wi, &facets, wi.z.abs() / pdf);
        let eta = if reflected { 1.0 } else { eta };
        Some(BsdfSample { wi, weight, path_pdf, pdf, specular: false, eta })
    }
}
