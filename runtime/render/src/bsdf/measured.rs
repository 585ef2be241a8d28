//! Measured isotropic reflection: a table of MERL's form, its colours made spectra by [`ColourBasis::reflectance`].
//!
//! Both sides reflect. It depolarises, as the table says nothing of polarisation. Directions are drawn by half: from a
//! cosine, and from the half vector, whose angle follows the table's mean times cosine and solid angle, then mirrored.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use arsc_spectral::{ColourBasis, MerlBrdf, SampledSpectrum, SampledWavelengths};
use glam::DVec3;

use super::rough_conductor::above;
use super::{BsdfSample, cosine_direction, cosine_pdf};
use crate::polarisation::Polarisation;

/// Share of the directions drawn from a cosine.
const COSINE_SHARE: f64 = 0.5;

#[derive(Clone, Debug)]
pub struct Measured {
    brdf: Arc<MerlBrdf>,
    /// Cosines of the half angle at the borders of its cells, from 1 to 0.
    cosines: Vec<f64>,
    /// Distribution function of the cells, from 0 to 1.
    cumulative: Vec<f64>,
}

impl Measured {
    pub(super) fn new(brdf: Arc<MerlBrdf>) -> Measured {
        let means: Vec<(f64, f64)> = brdf.means_by_half_angle().collect();
        let mut cosines: Vec<f64> = means.iter().map(|(angle, _)| angle.cos()).collect();
        cosines.push(FRAC_PI_2.cos().max(0.0));
        let lit = means.iter().any(|(_, mean)| *mean > 0.0);
        let weight = |i: usize| {
            // Values are linear within a cell.
            let next = means.get(i + 1).map_or(means[i].1, |mean| mean.1);
            let mean = if lit { 0.5 * (means[i].1 + next) } else { 1.0 };
            mean * (cosines[i].powi(2) - cosines[i + 1].powi(2))
        };
        let weights: Vec<f64> = (0..means.len()).map(weight).collect();
        let total: f64 = weights.iter().sum();
        let mut sum = 0.0;
        let mut cumulative = vec![0.0];
        for weight in &weights {
            sum += weight / total;
            cumulative.push(sum);
        }
        Measured { brdf, cosines, cumulative }
    }

    #[inline]
    pub(super) fn eval(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        if wo.z * wi.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        let (wo, wi) = (above(wo), above(wi));
        let h = (wo + wi).normalize();
        let sin = h.x.hypot(h.y);
        let (cos_turn, sin_turn) = if sin > 0.0 { (h.x / sin, h.y / sin) } else { (1.0, 0.0) };
        let along = DVec3::new(h.z * cos_turn, h.z * sin_turn, -sin);
        let across = DVec3::new(-sin_turn, cos_turn, 0.0);
        let (x, y) = (wi.dot(along), wi.dot(across));
        let rgb = self.brdf.eval(sin.atan2(h.z), x.hypot(y).atan2(wi.dot(h)), y.atan2(x));
        ColourBasis::reflectance().sample(rgb, wavelengths)
    }

    #[inline]
    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if wo.z * wi.z <= 0.0 {
            return 0.0;
        }
        let h = (above(wo) + above(wi)).normalize();
        // Cosines fall.
        let cell = self.cosines.partition_point(|cos| *cos > h.z).clamp(1, self.cosines.len() - 1) - 1;
        let mass = self.cumulative[cell + 1] - self.cumulative[cell];
        let half = mass / (TAU * (self.cosines[cell] - self.cosines[cell + 1]));
        let mirrored = half / (4.0 * above(wo).dot(h));
        let pdf = COSINE_SHARE * cosine_pdf(wo, wi) + (1.0 - COSINE_SHARE) * mirrored;
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u: [f64; 2],
        u_lobe: f64,
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        if wo.z == 0.0 {
            return None;
        }
        let wi = if u_lobe < COSINE_SHARE {
            cosine_direction(wo, u)?
        } else {
            let cell = self.cumulative.partition_point(|c| *c <= u[0]).clamp(1, self.cumulative.len() - 1) - 1;
            let mass = self.cumulative[cell + 1] - self.cumulative[cell];
            let within = if mass > 0.0 { ((u[0] - self.cumulative[cell]) / mass).clamp(0.0, 1.0) } else { 0.5 };
            let z = self.cosines[cell] + (self.cosines[cell + 1] - self.cosines[cell]) * within;
            let r = (1.0 - z * z).max(0.0).sqrt();
            let (sin, cos) = (TAU * u[1]).sin_cos();
            let h = DVec3::new(r * cos, r * sin, z.copysign(wo.z));
            let cos = wo.dot(h);
            if cos <= 0.0 {
                return None;
            }
            (h * (2.0 * cos) - wo).normalize()
        };
        let pdf = self.pdf(wo, wi);
        if pdf.is_nan() || pdf <= 0.0 {
            return None;
        }
        let weight = self.eval(wo, wi, wavelengths) * (wi.z.abs() / pdf) as f32;
        Some(BsdfSample::diffuse(wi, weight, pdf))
    }
}
