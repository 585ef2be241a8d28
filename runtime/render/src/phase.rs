//! Phase functions: into which directions a medium scatters.
//!
//! `wo` points towards the viewer and `wi` towards the light, unit vectors; the scattering angle is the one between
//! -wo and wi, 0 straight on. Values are per steradian and their own densities: sampling is exact.
//!
//! Isotropic scattering and Henyey and Greenstein's function (1941) say nothing of polarisation: what they scatter is
//! depolarised. Rayleigh's has the Mueller matrix of a dipole, with the share of isotropic scattering that anisotropic
//! molecules add (Hansen and Travis 1974, equations 2.15 and 2.16): delta = (1 - rho) / (1 + rho / 2) for the ratio rho of
//! the two linear polarisations of light scattered at a right angle from natural light.

use std::f64::consts::{FRAC_1_PI, TAU};

use arsc_spectral::SampledSpectrum;
use glam::DVec3;

use crate::frame::Frame;
use crate::polarisation::{Mueller, Polarisation};

const ISOTROPIC: f64 = 0.25 * FRAC_1_PI;

/// A phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PhaseFunction {
    Isotropic,
    /// Mean cosine `g` in (-1, 1).
    HenyeyGreenstein {
        g: f64,
    },
    /// `depolarisation` in [0, 1/2].
    Rayleigh {
        depolarisation: f64,
    },
}

/// Share of dipole scattering.
fn dipole_share(depolarisation: f64) -> f64 {
    (1.0 - depolarisation) / (1.0 + 0.5 * depolarisation)
}

impl PhaseFunction {
    /// Density per steradian of `wi`, and the value for unpolarised light.
    #[inline]
    pub fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let cos = -wo.dot(wi);
        match *self {
            PhaseFunction::Isotropic => ISOTROPIC,
            PhaseFunction::HenyeyGreenstein { g } => {
                let denominator = (1.0 + g * g - 2.0 * g * cos).max(f64::MIN_POSITIVE);
                ISOTROPIC * (1.0 - g * g) / (denominator * denominator.sqrt())
            }
            PhaseFunction::Rayleigh { depolarisation } => {
                let delta = dipole_share(depolarisation);
                ISOTROPIC * (delta * 0.75 * (1.0 + cos * cos) + (1.0 - delta))
            }
        }
    }

    /// The value over its density: 1 for unpolarised light, a Mueller matrix otherwise.
    #[inline]
    pub fn weight<P: Polarisation>(&self, wo: DVec3, wi: DVec3) -> P::Mueller {
        match *self {
            PhaseFunction::Isotropic | PhaseFunction::HenyeyGreenstein { .. } => {
                P::Mueller::depolariser(SampledSpectrum::ONE)
            }
            PhaseFunction::Rayleigh { depolarisation } => rayleigh::<P>(depolarisation, wo, wi),
        }
    }

    /// A direction distributed by [`PhaseFunction::pdf`].
    #[inline]
    pub fn sample(&self, wo: DVec3, u: [f64; 2]) -> DVec3 {
        let cos = match *self {
            PhaseFunction::Isotropic => 1.0 - 2.0 * u[0],
            // For g near 0 the inversion loses digits.
            PhaseFunction::HenyeyGreenstein { g } if g.abs() < 1e-6 => {
                let cos = 1.0 - 2.0 * u[0];
                cos + 1.5 * g * (1.0 - cos * cos)
            }
            PhaseFunction::HenyeyGreenstein { g } => {
                let ratio = (1.0 - g * g) / (1.0 + g - 2.0 * g * u[0]);
                (1.0 + g * g - ratio * ratio) / (2.0 * g)
            }
            PhaseFunction::Rayleigh { depolarisation } => {
                let delta = dipole_share(depolarisation);
                if u[0] < delta {
                    // The root of cos^3 + 3 cos = 8 u - 4.
                    let q = 4.0 * u[0] / delta - 2.0;
                    let root = (1.0 + q * q).sqrt();
                    (q + root).cbrt() + (q - root).cbrt()
                } else {
                    1.0 - 2.0 * (u[0] - delta) / (1.0 - delta)
                }
            }
        };
        let cos = cos.clamp(-1.0, 1.0);
        let sin = (1.0 - cos * cos).sqrt();
        let (sin_phi, cos_phi) = (TAU * u[1]).sin_cos();
        Frame::new(-wo).to_world(DVec3::new(sin * cos_phi, sin * sin_phi, cos))
    }
}

/// Rayleigh's matrix over its first element, x across the plane of scattering.
fn rayleigh<P: Polarisation>(depolarisation: f64, wo: DVec3, wi: DVec3) -> P::Mueller {
    let cos = -wo.dot(wi);
    let delta = dipole_share(depolarisation);
    let circular = delta * (1.0 - 2.0 * depolarisation) / (1.0 - depolarisation);
    let norm = 1.0 / (delta * 0.75 * (1.0 + cos * cos) + (1.0 - delta));
    let across = wi.cross(wo);
    let length2 = across.length_squared();
    let axis = if length2 > 1e-30 { across / length2.sqrt() } else { Frame::new(wo).x };
    let element = |i: usize, j: usize| {
        let value = match (i, j) {
            (0, 0) => return SampledSpectrum::ONE,
            (1, 1) => delta * 0.75 * (1.0 + cos * cos),
            (0, 1) | (1, 0) => delta * 0.75 * (1.0 - cos * cos),
            (2, 2) => delta * 1.5 * cos,
            (3, 3) => circular * 1.5 * cos,
            _ => 0.0,
        };
        SampledSpectrum::splat((value * norm) as f32)
    };
    P::Mueller::from_elements(element, [axis, axis], wo, wi)
}
