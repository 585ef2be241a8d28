//! Distributions of microfacets, with Smith's masking and shadowing.
//!
//! D(h) is the density of facet normals per area of the surface and steradian: its integral of D(h) h.z over the hemisphere is 1.
//! With slopes p = -h.x / h.z it is the slope density P(p, q) over h.z^4. Lambda follows exactly from P for each of the three
//! (Heitz 2014, "Understanding the masking-shadowing function"), so that facets seen from any direction fill their
//! projected area: the integral of G1(w, h) (w.h)+ D(h) is w.z. Directions have z >= 0 here.
//!
//! - GGX (Walter et al. 2007): P of Student's t kind with the variance undefined; may be anisotropic.
//! - Beckmann: Gaussian slopes of variance alpha^2 / 2; may be anisotropic.
//! - Blinn: D = (n + 2) / (2 pi) h.z^n with n = 2 / alpha^2 - 2. Lambda has no closed form and is tabulated.
//!
//! Normals are sampled as seen from a direction: for GGX after Dupuy and Benyoub 2023, for Beckmann by inverting the
//! distribution of visible slopes (Heitz and d'Eon 2014). Blinn's are sampled by D(h) h.z.

use std::borrow::Cow;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

use std::sync::LazyLock;

use glam::DVec3;

/// Limits of alpha: narrower lobes are beyond single precision, wider ones beyond the model.
const MIN_ALPHA: f64 = 1e-4;
const MAX_ALPHA: f64 = 1.0;

/// Widths of Blinn's distribution with a masking table at hand, in steps of 4 %.
const BLINN_WIDTHS: usize = 256;

static BLINN_LADDER: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| {
    let alpha = |i: usize| MIN_ALPHA * (MAX_ALPHA / MIN_ALPHA).powf(i as f64 / (BLINN_WIDTHS - 1) as f64);
    (0..BLINN_WIDTHS).map(|i| blinn_masking(alpha(i))).collect()
});

/// Which function the normals follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MicrofacetShape {
    Ggx,
    Beckmann,
    /// Isotropic: the first alpha counts.
    Blinn,
}

/// A distribution of facet normals about z.
#[derive(Clone, Debug)]
pub struct Microfacets {
    shape: MicrofacetShape,
    alpha: [f64; 2],
    /// Blinn: exponent, and a Lambda(a) over a / (1 + a) with a = cot(theta) / alpha.
    exponent: f64,
    masking: Cow<'static, [f64]>,
}

impl Microfacets {
    /// `alpha` along x and y; values are limited to [1e-4, 1].
    pub fn new(shape: MicrofacetShape, alpha: [f64; 2]) -> Microfacets {
        let masking = |alpha| Cow::Owned(blinn_masking(alpha));
        Microfacets::with_masking(shape, alpha, masking)
    }

    fn with_masking(
        shape: MicrofacetShape,
        alpha: [f64; 2],
        masking: impl Fn(f64) -> Cow<'static, [f64]>,
    ) -> Microfacets {
        let limited = |a: f64| if a.is_nan() { MAX_ALPHA } else { a.clamp(MIN_ALPHA, MAX_ALPHA) };
        let alpha = alpha.map(limited);
        let exponent = 2.0 / (alpha[0] * alpha[0]) - 2.0;
        match shape {
            MicrofacetShape::Blinn => Microfacets { shape, alpha: [alpha[0]; 2], exponent, masking: masking(alpha[0]) },
            _ => Microfacets { shape, alpha, exponent, masking: Cow::Borrowed(&[]) },
        }
    }

    /// The same shape of another width, without memory of its own: Blinn's masking, which hardly depends on the width in
    /// its units, is that of the nearest of a few hundred.
    pub fn with_alpha(&self, alpha: Option<[f64; 2]>) -> Microfacets {
        Microfacets::with_masking(self.shape, alpha.unwrap_or(self.alpha), |alpha| {
            let at = (alpha / MIN_ALPHA).ln() / (MAX_ALPHA / MIN_ALPHA).ln() * (BLINN_WIDTHS - 1) as f64;
            Cow::Borrowed(&BLINN_LADDER[(at.round() as usize).min(BLINN_WIDTHS - 1)])
        })
    }

    /// Directions about z are not all alike.
    pub fn is_anisotropic(&self) -> bool {
        self.alpha[0] != self.alpha[1]
    }

    /// Mean alpha.
    pub fn width(&self) -> f64 {
        (self.alpha[0] * self.alpha[1]).sqrt()
    }

    /// Density of the normal `h`.
    #[inline]
    pub fn density(&self, h: DVec3) -> f64 {
        let [ax, ay] = self.alpha;
        let z2 = h.z * h.z;
        match self.shape {
            MicrofacetShape::Ggx => {
                let e = (h.x / ax).powi(2) + (h.y / ay).powi(2) + z2;
                FRAC_1_PI / (ax * ay * e * e)
            }
            MicrofacetShape::Beckmann if z2 == 0.0 => 0.0,
            MicrofacetShape::Beckmann => {
                let e = ((h.x / ax).powi(2) + (h.y / ay).powi(2)) / z2;
                (-e).exp() * FRAC_1_PI / (ax * ay * z2 * z2)
            }
            MicrofacetShape::Blinn => {
                // From the sine, which keeps its digits near the normal.
                let sin2 = h.x * h.x + h.y * h.y;
                (self.exponent + 2.0) / TAU * (0.5 * self.exponent * (-sin2.min(1.0)).ln_1p()).exp()
            }
        }
    }

    /// Area of masked facets over that of visible ones, seen from `w`.
    #[inline]
    pub fn lambda(&self, w: DVec3) -> f64 {
        let spread2 = (w.x * self.alpha[0]).powi(2) + (w.y * self.alpha[1]).powi(2);
        if spread2 == 0.0 {
            return 0.0;
        }
        let z2 = w.z * w.z;
        if z2 == 0.0 {
            return f64::INFINITY;
        }
        if let MicrofacetShape::Ggx = self.shape {
            return 0.5 * ((1.0 + spread2 / z2).sqrt() - 1.0);
        }
        let a = (z2 / spread2).sqrt();
        if let MicrofacetShape::Beckmann = self.shape {
            return 0.5 * ((-a * a).exp() / (a * PI.sqrt()) - libm::erfc(a)).max(0.0);
        }
        let at = a / (1.0 + a) * (self.masking.len() - 1) as f64;
        let cell = (at as usize).min(self.masking.len() - 2);
        let part = at - cell as f64;
        (self.masking[cell] * (1.0 - part) + self.masking[cell + 1] * part) / a
    }

    /// Share of the facets that are visible from `w`.
    #[inline]
    pub fn g1(&self, w: DVec3) -> f64 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Density per steradian with which [`Microfacets::sample`] gives `h` for `w`.
    #[inline]
    pub fn pdf(&self, w: DVec3, h: DVec3) -> f64 {
        match self.shape {
            MicrofacetShape::Blinn => self.density(h) * h.z,
            _ => self.g1(w) * self.density(h) * w.dot(h).max(0.0) / w.z,
        }
    }

    /// A facet's normal, as seen from `w`.
    #[inline]
    pub fn sample(&self, w: DVec3, u: [f64; 2]) -> DVec3 {
        let [ax, ay] = self.alpha;
        match self.shape {
            MicrofacetShape::Ggx => {
                let stretched = DVec3::new(w.x * ax, w.y * ay, w.z).normalize();
                let (sin, cos) = (TAU * u[0]).sin_cos();
                let z = (1.0 - u[1]) * (1.0 + stretched.z) - stretched.z;
                let r = (1.0 - z * z).max(0.0).sqrt();
                let h = DVec3::new(r * cos, r * sin, z) + stretched;
                DVec3::new(h.x * ax, h.y * ay, h.z.max(0.0)).normalize_or(DVec3::Z)
            }
            MicrofacetShape::Beckmann => {
                let stretched = DVec3::new(w.x * ax, w.y * ay, w.z).normalize();
                let sin = stretched.x.hypot(stretched.y);
                let (p, q) = (visible_gaussian_slope(stretched.z, sin, u[0]), gaussian_quantile(u[1]));
                let (cos_phi, sin_phi) = if sin > 0.0 { (stretched.x / sin, stretched.y / sin) } else { (1.0, 0.0) };
                let (x, y) = (cos_phi * p - sin_phi * q, sin_phi * p + cos_phi * q);
                DVec3::new(-x * ax, -y * ay, 1.0).normalize()
            }
            MicrofacetShape::Blinn => {
                let (sin, cos) = (TAU * u[0]).sin_cos();
                // h.z^(n + 2) is uniform.
                let log = (1.0 - u[1]).ln() / (self.exponent + 2.0);
                let r = (-(2.0 * log).exp_m1()).clamp(0.0, 1.0).sqrt();
                DVec3::new(r * cos, r * sin, log.exp())
            }
        }
    }
}

/// Slope with density exp(-q^2) / sqrt(pi).
fn gaussian_quantile(u: f64) -> f64 {
    invert(u, |q| 0.5 * libm::erfc(-q), |q| (-q * q).exp() / PI.sqrt(), 6.0)
}

/// A slope p in the plane of `w` = (sin, 0, cos), with density in proportion to (cos - p sin)+ exp(-p^2), by inversion.
/// A facet of slope p has the normal (-p, 0, 1), up to its length.
fn visible_gaussian_slope(cos: f64, sin: f64, u: f64) -> f64 {
    const FAR: f64 = 6.0;
    // Mass of the slopes beyond p, but for a constant.
    let beyond = |p: f64| 0.5 * cos * libm::erfc(p) - 0.5 * sin * (-p * p).exp() / PI.sqrt();
    // The projected area is positive only where p sin < cos.
    let end = if sin * FAR > cos { cos / sin } else { FAR };
    let all = beyond(-FAR) - beyond(end);
    let mass = |p: f64| if p >= end { 1.0 } else { (beyond(-FAR) - beyond(p)) / all };
    let density = |p: f64| (cos - p * sin).max(0.0) * (-p * p).exp() / (PI.sqrt() * all);
    invert(u, mass, density, FAR)
}

/// Where an increasing function on [-limit, limit] is `u`: Newton's method within a shrinking bracket.
fn invert(u: f64, mass: impl Fn(f64) -> f64, density: impl Fn(f64) -> f64, limit: f64) -> f64 {
    let (mut low, mut high, mut x) = (-limit, limit, 0.0);
    for _ in 0..60 {
        let excess = mass(x) - u;
        if excess.abs() < 1e-12 || high - low < 1e-12 {
            break;
        }
        if excess > 0.0 {
            high = x
        } else {
            low = x
        }
        let step = x - excess / density(x);
        x = if step > low && step < high { step } else { 0.5 * (low + high) };
    }
    x
}

/// a Lambda(a) for Blinn's slopes, in units of alpha: P2(s) ~ (1 + alpha^2 s^2)^(-(n + 3) / 2), Lambda(a) the integral of
/// (s - a) P2(s) over s > a, divided by a. Midpoint rule on s = v / (1 - v) from the far end.
fn blinn_masking(alpha: f64) -> Vec<f64> {
    const CELLS: usize = 256;
    const STEPS: usize = 16;
    let n = 2.0 / (alpha * alpha) - 2.0;
    let density = |s: f64| (-0.5 * (n + 3.0) * (alpha * alpha * s * s).ln_1p()).exp();
    let (mut mass, mut moment) = (0.0, 0.0);
    let mut table = vec![0.0; CELLS + 1];
    for cell in (0..CELLS).rev() {
        for step in 0..STEPS {
            let v = 1.0 - ((CELLS - 1 - cell) as f64 + (step as f64 + 0.5) / STEPS as f64) / CELLS as f64;
            let s = v / (1.0 - v);
            let weight = density(s) / ((1.0 - v) * (1.0 - v) * (CELLS * STEPS) as f64);
            (mass, moment) = (mass + weight, moment + weight * s);
        }
        let a = cell as f64 / (CELLS - cell) as f64;
        table[cell] = (moment - a * mass).max(0.0);
    }
    // The whole mass is that of one half.
    table.iter().map(|value| 0.5 * value / mass).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cases() -> impl Iterator<Item = Microfacets> {
        let shapes = [MicrofacetShape::Ggx, MicrofacetShape::Beckmann, MicrofacetShape::Blinn];
        let alphas = [[0.1; 2], [0.5; 2], [0.3, 0.8], [1.0; 2]];
        shapes.into_iter().flat_map(move |shape| alphas.map(|alpha| Microfacets::new(shape, alpha)))
    }

    /// Integral over the hemisphere of normals: midpoints in azimuth and in the angle from z, by tan = alpha s / (1 - s).
    fn integrate(facets: &Microfacets, f: impl Fn(DVec3) -> f64) -> f64 {
        const N: usize = 1200;
        let scale = facets.alpha[0].max(facets.alpha[1]);
        let mut sum = 0.0;
        for i in 0..N {
            let s = (i as f64 + 0.5) / N as f64;
            let tan = scale * s / (1.0 - s);
            let cos = 1.0 / (1.0 + tan * tan).sqrt();
            let sin = tan * cos;
            // d theta = cos^2 d tan.
            let measure = sin * cos * cos * scale / ((1.0 - s) * (1.0 - s)) / N as f64 * TAU / 256.0;
            for j in 0..256 {
                let (y, x) = (TAU * (f64::from(j) + 0.5) / 256.0).sin_cos();
                sum += measure * f(DVec3::new(sin * x, sin * y, cos));
            }
        }
        sum
    }

    /// The facets' projected areas add up to the surface's; seen aslant, the visible ones fill the projected area.
    #[test]
    fn facets_fill_the_surface_from_every_direction() {
        for facets in cases() {
            let area = integrate(&facets, |h| facets.density(h) * h.z);
            assert!((area - 1.0).abs() < 1e-5, "{facets:?}: {area}");
            for (theta, phi) in [(0.0f64, 0.0f64), (0.5, 1.0), (1.1, 0.2), (1.4, 2.0), (1.52, 1.3)] {
                let w = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
                let seen = integrate(&facets, |h| facets.g1(w) * facets.density(h) * w.dot(h).max(0.0));
                assert!((seen / w.z - 1.0).abs() < 1e-3, "{:?} {:?} at {theta}: {seen}", facets.shape, facets.alpha);
            }
        }
    }

    /// Moments of sampled normals, over a grid of u, are those of the density that `pdf` states.
    #[test]
    fn samples_follow_the_pdf() {
        const N: usize = 400;
        for facets in cases() {
            for (theta, phi) in [(0.0f64, 0.0f64), (0.6, 0.7), (1.3, 2.0), (1.55, 4.0)] {
                let w = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
                let mut means = [0.0; 3];
                for i in 0..N * N {
                    let h = facets.sample(w, [i % N, i / N].map(|k| (k as f64 + 0.5) / N as f64));
                    assert!(h.z >= 0.0 && (h.length() - 1.0).abs() < 1e-9, "{h}");
                    [h.x, h.y, h.x * h.y].iter().zip(&mut means).for_each(|(x, mean)| *mean += x / (N * N) as f64);
                }
                let exact = [
                    integrate(&facets, |h| facets.pdf(w, h) * h.x),
                    integrate(&facets, |h| facets.pdf(w, h) * h.y),
                    integrate(&facets, |h| facets.pdf(w, h) * h.x * h.y),
                ];
                for (mean, exact) in means.iter().zip(exact) {
                    let name = format!("{:?} {:?} at {theta}", facets.shape, facets.alpha);
                    assert!((mean - exact).abs() < 2e-3, "{name}: {means:?}, {exact:?}");
                }
            }
        }
    }

    /// Blinn's lobes become Gaussian as they narrow, with Beckmann's alpha.
    #[test]
    fn narrow_lobes_of_blinn_are_those_of_beckmann() {
        let [blinn, beckmann] =
            [MicrofacetShape::Blinn, MicrofacetShape::Beckmann].map(|shape| Microfacets::new(shape, [0.01; 2]));
        for tan in [0.0, 0.005, 0.01, 0.02] {
            let h = DVec3::new(tan, 0.0, 1.0).normalize();
            assert!((blinn.density(h) / beckmann.density(h) - 1.0).abs() < 2e-3);
        }
        for z in [0.005f64, 0.01, 0.03] {
            let w = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
            assert!((blinn.g1(w) / beckmann.g1(w) - 1.0).abs() < 2e-3, "{} {}", blinn.g1(w), beckmann.g1(w));
        }
    }
}
