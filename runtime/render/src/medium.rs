//! Participating media along rays.
//!
//! Coefficients are those at density 1, times a density that depends on the place. The densities have closed integrals
//! along lines, so transmittance is exact, and distances are found by inverting it: no null collisions, no majorants.
//!
//! Dyes absorb, and emit what they absorbed at other wavelengths, equally into all directions. Where they emit they need
//! not absorb, so that events of re-radiation have a rate of their own, beside that of extinction: the strength of the
//! re-radiation, but no more than one over the size of what the medium fills, so that light still gets through.

use arsc_accel::Ray;
use arsc_spectral::{
    DenseSpectrum, Dye, Fluorescence, ReradiationTable, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange,
};
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
    dyes: Option<Box<Dyes>>,
    pub phase: PhaseFunction,
    pub density: Density,
}

#[derive(Clone, Debug, PartialEq)]
struct Dyes {
    absorption: DenseSpectrum,
    reradiation: ReradiationTable,
    /// Largest rate of re-radiation events, per metre at density 1.
    most_events: f32,
}

/// Coefficients of a medium at density 1, per metre, at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    pub sigma_s: SampledSpectrum,
    pub sigma_t: SampledSpectrum,
    /// Absorption times emission over extinction: the radiance of an infinitely deep layer without scattered light.
    pub glow: SampledSpectrum,
    /// What dyes emit per metre of constant radiance at all wavelengths.
    pub strength: SampledSpectrum,
    /// Events of re-radiation per metre.
    pub shift_rate: SampledSpectrum,
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
        Medium { absorption, scattering, emission, dyes: None, phase, density }
    }

    /// The same with dyes in it; their absorption is per metre.
    pub fn with_dyes(mut self, dyes: &[Dye]) -> Medium {
        let parts: Vec<Fluorescence> = dyes.iter().cloned().map(Fluorescence::Dye).collect();
        let of = |dye: &Dye, nm: f64| dye.absorption.eval(nm).max(0.0);
        let absorption = DenseSpectrum::from_fn(|nm| dyes.iter().map(|dye| of(dye, nm)).sum());
        let reradiation = ReradiationTable::new(&parts);
        self.dyes = (!dyes.is_empty()).then(|| Box::new(Dyes { absorption, reradiation, most_events: f32::INFINITY }));
        self
    }

    pub fn fluoresces(&self) -> bool {
        self.dyes.is_some()
    }

    /// The medium fills something of this size, metres.
    pub(crate) fn fills(&mut self, extent: f64) {
        if let Some(dyes) = &mut self.dyes
            && extent > 0.0
        {
            dyes.most_events = dyes.most_events.min((1.0 / extent) as f32);
        }
    }

    /// `range`: the wavelengths that there are.
    #[inline]
    pub fn coefficients(&self, wavelengths: &SampledWavelengths, range: &WavelengthRange) -> Coefficients {
        let (sigma_a, sigma_s) = (self.absorption.sample(wavelengths), self.scattering.sample(wavelengths));
        let (mut sigma_t, zero) = (sigma_a + sigma_s, SampledSpectrum::ZERO);
        let (mut strength, mut shift_rate) = (zero, zero);
        if let Some(dyes) = &self.dyes {
            sigma_t += dyes.absorption.sample(wavelengths);
            strength = dyes.reradiation.strength(wavelengths, range);
            shift_rate = strength.map(|strength| strength.min(dyes.most_events));
        }
        let share = sigma_a / sigma_t.map(|x| if x > 0.0 { x } else { 1.0 });
        Coefficients { sigma_s, sigma_t, glow: self.emission.sample(wavelengths) * share, strength, shift_rate }
    }

    /// The wavelengths that dyes absorb where they emit the given ones; see [`ReradiationTable::shift`].
    pub(crate) fn shift(
        &self,
        wavelengths: &SampledWavelengths,
        range: &WavelengthRange,
        u: f64,
    ) -> SampledWavelengths {
        self.dyes.as_ref().map_or(*wavelengths, |dyes| dyes.reradiation.shift(wavelengths, range, u))
    }
}

impl Coefficients {
    /// Share of light left after a depth (the integral of density along the way, metres; may be infinite).
    #[inline]
    pub fn transmittance(&self, depth: f64) -> SampledSpectrum {
        decayed(self.sigma_t, depth)
    }

    /// Light is absorbed at most: the medium is no place of events.
    #[inline]
    pub fn has_no_events(&self) -> bool {
        self.sigma_s.is_black() && self.shift_rate.is_black()
    }

    /// Events per metre at density 1. A medium that does not scatter has none where it absorbs.
    #[inline]
    pub fn event_rate(&self) -> SampledSpectrum {
        if self.sigma_s.is_black() { self.shift_rate } else { self.sigma_t + self.shift_rate }
    }

    /// The probability that a path gets through a depth without an event.
    #[inline]
    pub fn no_event(&self, depth: f64) -> SampledSpectrum {
        decayed(self.event_rate(), depth)
    }
}

#[inline]
fn decayed(rate: SampledSpectrum, depth: f64) -> SampledSpectrum {
    rate.map(|rate| if rate > 0.0 { (-f64::from(rate) * depth).exp() as f32 } else { 1.0 })
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
