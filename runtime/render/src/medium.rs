//! Participating media along rays.
//!
//! Coefficients are those at density 1, times a density that depends on the place. The densities have closed integrals
//! along lines, so transmittance is exact, and distances are found by inverting it: no null collisions, no majorants.

use arsc_accel::Ray;
use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use crate::phase::PhaseFunction;

/// A factor on the coefficients; positions are in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    Uniform,
    /// `exp(-|p - center|^2 / (2 sigma^2))`.
    Gaussian {
        center: DVec3,
        sigma: f64,
    },
    /// 1 up to the level `ground`, above it `exp(-(z - ground) / height)`.
    Exponential {
        ground: f64,
        height: f64,
    },
}

/// A medium, tabulated for rendering.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    absorption: DenseSpectrum,
    scattering: DenseSpectrum,
    emission: DenseSpectrum,
    pub phase: PhaseFunction,
    pub density: Density,
}

/// Coefficients of a medium at density 1, per metre, at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    pub sigma_s: SampledSpectrum,
    pub sigma_t: SampledSpectrum,
    /// Absorption times emission over extinction: the radiance of an infinitely deep layer without scattered light.
    pub glow: SampledSpectrum,
}

impl Medium {
    /// Absorption and scattering per metre, and the radiance `emission` of a deep absorbing layer; negative values count
    /// as zero.
    pub fn new(
        absorption: &Spectrum,
        scattering: &Spectrum,
        emission: &Spectrum,
        phase: PhaseFunction,
        density: Density,
    ) -> Medium {
        let table = |spectrum| DenseSpectrum::new(spectrum).clamped(0.0, f32::MAX);
        let (absorption, scattering, emission) = (table(absorption), table(scattering), table(emission));
        Medium { absorption, scattering, emission, phase, density }
    }

    #[inline]
    pub fn coefficients(&self, wavelengths: &SampledWavelengths) -> Coefficients {
        let (sigma_a, sigma_s) = (self.absorption.sample(wavelengths), self.scattering.sample(wavelengths));
        let sigma_t = sigma_a + sigma_s;
        let share = sigma_a / sigma_t.map(|x| if x > 0.0 { x } else { 1.0 });
        Coefficients { sigma_s, sigma_t, glow: self.emission.sample(wavelengths) * share }
    }
}

impl Coefficients {
    /// Share of light left after a depth (the integral of density along the way, metres; may be infinite).
    #[inline]
    pub fn transmittance(&self, depth: f64) -> SampledSpectrum {
        self.sigma_t.map(|sigma| if sigma > 0.0 { (-f64::from(sigma) * depth).exp() as f32 } else { 1.0 })
    }
}

impl Density {
    /// Integral of the density along the first `t` metres of a ray (unit direction); infinite where it diverges. Relative
    /// error below 1e-12 where it does not cancel.
    pub fn depth(&self, ray: &Ray, t: f64) -> f64 {
        match *self {
            Density::Uniform => t,
            Density::Gaussian { center, sigma } => {
                let along = (center - ray.origin).dot(ray.dir);
                let distance2 = (center - ray.origin - ray.dir * along).length_squared();
                let peak = (-0.5 * distance2 / (sigma * sigma)).exp();
                let scaled = |s: f64| (s - along) / (sigma * std::f64::consts::SQRT_2);
                let norm = sigma * (0.5 * std::f64::consts::PI).sqrt();
                peak * norm * erf_difference(scaled(0.0), scaled(t))
            }
            Density::Exponential { ground, height } => exponential_depth(ray.origin.z - ground, ray.dir.z, t, height),
        }
    }

    /// The distance along a ray at which the depth is reached; `None` if it is not within `t_max`.
    pub fn distance(&self, ray: &Ray, depth: f64, t_max: f64) -> Option<f64> {
        if *self == Density::Uniform {
            return (depth < t_max).then_some(depth);
        }
        if depth >= self.depth(ray, t_max) {
            return None;
        }
        // Densities are at most 1: the distance is at least the depth.
        let (mut low, mut high) = (depth, t_max.min(depth.max(f64::MIN_POSITIVE) * 2.0));
        while self.depth(ray, high) <= depth {
            low = high;
            high = (2.0 * high).min(t_max);
        }
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.depth(ray, middle) <= depth { low = middle } else { high = middle }
        }
        Some(low)
    }
}

/// erf(b) - erf(a) for a <= b, without cancellation in the tails.
fn erf_difference(a: f64, b: f64) -> f64 {
    if a > 0.5 {
        libm::erfc(a) - libm::erfc(b)
    } else if b < -0.5 {
        libm::erfc(-b) - libm::erfc(-a)
    } else {
        libm::erf(b) - libm::erf(a)
    }
}

/// From `z` metres above the ground, along a ray that climbs `climb` metres per metre.
fn exponential_depth(z: f64, climb: f64, t: f64, height: f64) -> f64 {
    // The stretch below the ground, where the density is 1, comes before or after the other.
    let crossing = -z / climb;
    let passes = climb != 0.0 && crossing > 0.0 && crossing < t;
    match (z < 0.0 || (z == 0.0 && climb <= 0.0), passes) {
        (true, false) => t,
        (true, true) => crossing + decay(0.0, climb, t - crossing, height),
        (false, false) => decay(z, climb, t, height),
        (false, true) => decay(z, climb, crossing, height) + (t - crossing),
    }
}

/// The same, for a stretch above the ground.
fn decay(z: f64, climb: f64, t: f64, height: f64) -> f64 {
    let start = (-z / height).exp();
    let rise = climb * t / height;
    if climb == 0.0 || rise.abs() < 1e-12 {
        return start * t;
    }
    -start * (-rise).exp_m1() * height / climb
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rays() -> Vec<Ray> {
        let mut rays = Vec::new();
        for origin in [DVec3::ZERO, DVec3::new(0.3, -0.2, 1.5), DVec3::new(0.1, 0.4, -2.0)] {
            for dir in [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, -0.8, -0.6)] {
                rays.push(Ray::new(origin, dir));
            }
        }
        rays
    }

    fn value(density: &Density, p: DVec3) -> f64 {
        match *density {
            Density::Uniform => 1.0,
            Density::Gaussian { center, sigma } => (-(p - center).length_squared() / (2.0 * sigma * sigma)).exp(),
            Density::Exponential { ground, height } => (-(p.z - ground).max(0.0) / height).exp(),
        }
    }

    const DENSITIES: [Density; 3] = [
        Density::Uniform,
        Density::Gaussian { center: DVec3::new(0.2, 0.1, 0.4), sigma: 0.7 },
        Density::Exponential { ground: 0.25, height: 0.5 },
    ];

    /// Closed integrals against the midpoint rule with 20 000 points.
    #[test]
    fn depths_are_integrals() {
        for density in &DENSITIES {
            for ray in rays() {
                for t in [0.1, 1.0, 4.0] {
                    let n = 20_000;
                    let step = t / f64::from(n);
                    let sum: f64 = (0..n).map(|i| value(density, ray.at((f64::from(i) + 0.5) * step))).sum();
                    let (exact, found) = (sum * step, density.depth(&ray, t));
                    assert!((found - exact).abs() < 1e-7, "{density:?} {ray:?} {t}: {found} not {exact}");
                }
            }
        }
    }

    #[test]
    fn distances_invert_depths() {
        for density in &DENSITIES {
            for ray in rays() {
                let total = density.depth(&ray, 4.0);
                assert_eq!(density.distance(&ray, total * 1.001, 4.0), None);
                for share in [0.0, 1e-6, 0.3, 0.9, 0.999] {
                    let t = density.distance(&ray, total * share, 4.0).expect("within the ray");
                    let back = density.depth(&ray, t);
                    assert!((back - total * share).abs() < 1e-9 * total.max(1e-300), "{density:?} {ray:?} {share}");
                }
            }
        }
    }

    /// Upwards the air comes to an end, downwards it does not.
    #[test]
    fn infinite_rays() {
        let air = Density::Exponential { ground: 0.0, height: 8000.0 };
        let up = Ray::new(DVec3::ZERO, DVec3::Z);
        assert!((air.depth(&up, f64::INFINITY) - 8000.0).abs() < 1e-9);
        assert_eq!(air.depth(&Ray::new(DVec3::ZERO, -DVec3::Z), f64::INFINITY), f64::INFINITY);
        assert_eq!(air.depth(&Ray::new(DVec3::Z, DVec3::X), f64::INFINITY), f64::INFINITY);
        assert_eq!(air.distance(&up, 9000.0, f64::INFINITY), None);
        let t = air.distance(&up, 4000.0, f64::INFINITY).expect("half of it");
        assert!((t / (8000.0 * 2f64.ln()) - 1.0).abs() < 1e-9);
    }
}
