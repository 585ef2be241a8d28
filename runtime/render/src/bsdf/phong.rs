//! A glossy lobe about the mirrored direction: f = reflectance (n + 2) / (2 pi) cos^n alpha, on both sides.
//!
//! Phong's lobe as made reciprocal and held to energy by Lafortune and Willems 1994, "Using the modified Phong reflectance
//! model". It depolarises. Sampled by the lobe alone, (n + 1) / (2 pi) cos^n alpha; what falls below the surface is lost.

use std::f64::consts::TAU;

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::BsdfSample;
use crate::frame::Frame;
use crate::polarisation::Polarisation;

const MAX_EXPONENT: f64 = 1e7;

#[derive(Clone, Debug)]
pub struct Phong {
    pub(super) reflectance: DenseSpectrum,
    pub(super) exponent: f64,
}

/// Cosine to the mirrored direction, to the power of the exponent.
#[inline]
fn lobe(wo: DVec3, wi: DVec3, exponent: f64) -> f64 {
    let mirrored = DVec3::new(-wo.x, -wo.y, wo.z);
    // From the distance, which keeps its digits near the centre.
    let cos_less_1 = -0.5 * (mirrored - wi).length_squared();
    if wo.z * wi.z <= 0.0 || cos_less_1 <= -1.0 { 0.0 } else { (exponent * cos_less_1.ln_1p()).exp() }
}

impl Phong {
    pub(super) fn new(reflectance: &Spectrum, exponent: f64) -> Phong {
        let reflectance = DenseSpectrum::new(reflectance).clamped(0.0, 1.0);
        Phong { reflectance, exponent: Phong::limited(exponent) }
    }

    /// The exponent within its bounds.
    pub(super) fn limited(exponent: f64) -> f64 {
        if exponent.is_nan() { 0.0 } else { exponent.clamp(0.0, MAX_EXPONENT) }
    }

    /// Of facets that make about as wide a lobe.
    pub(super) fn width(&self) -> f64 {
        (2.0 / (self.exponent + 2.0)).sqrt()
    }

    #[inline]
    pub(super) fn eval(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let value = (self.exponent + 2.0) / TAU * lobe(wo, wi, self.exponent);
        self.reflectance.sample(wavelengths) * value as f32
    }

    #[inline]
    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        (self.exponent + 1.0) / TAU * lobe(wo, wi, self.exponent)
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u: [f64; 2],
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        let log = (1.0 - u[1]).ln() / (self.exponent + 1.0);
        let r = (-(2.0 * log).exp_m1()).max(0.0).sqrt();
        let (sin, cos) = (TAU * u[0]).sin_cos();
        let frame = Frame::new(DVec3::new(-wo.x, -wo.y, wo.z));
        let wi = frame.to_world(DVec3::new(r * cos, r * sin, log.exp())).normalize();
        let pdf = self.pdf(wo, wi);
        if pdf.is_nan() || pdf <= 0.0 {
            return None;
        }
        let weight = self.eval(wo, wi, wavelengths) * (wi.z.abs() / pdf) as f32;
        Some(BsdfSample::diffuse(wi, weight, pdf))
    }
}
