//! Maps from the unit square that preserve measure, with their densities.

use std::f64::consts::{FRAC_1_PI, FRAC_PI_4, TAU};

use glam::{DVec2, DVec3};

/// Density of [`uniform_sphere`], per steradian.
pub const UNIFORM_SPHERE_PDF: f64 = 0.25 * FRAC_1_PI;

/// The unit disk, concentric (Shirley and Chiu 1997); uniform per area.
#[inline]
pub fn concentric_disk(u: [f64; 2]) -> DVec2 {
    let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if x == 0.0 && y == 0.0 {
        return DVec2::ZERO;
    }
    if x.abs() > y.abs() {
        let (sin, cos) = short_sin_cos(FRAC_PI_4 * (y / x));
        DVec2::new(x * cos, x * sin)
    } else {
        let (sin, cos) = short_sin_cos(FRAC_PI_4 * (x / y));
        DVec2::new(y * sin, y * cos)
    }
}

/// Of at most an eighth of a turn either way, with an error of 2e-9: Taylor's series. Places on a disk need no more, since
/// what depends on them is computed from where they are.
#[inline]
fn short_sin_cos(angle: f64) -> (f64, f64) {
    let a = angle * angle;
    let (a2, a4) = (a * a, a * a * a * a);
    let sin = (1.0 - a / 6.0) + a2 * (1.0 / 120.0 - a / 5_040.0) + a4 * (1.0 / 362_880.0);
    let cos = (1.0 - a / 2.0) + a2 * (1.0 / 24.0 - a / 720.0) + a4 * (1.0 / 40_320.0 - a / 3_628_800.0);
    (angle * sin, cos)
}

/// The hemisphere z >= 0 with density z / pi per steradian (Malley).
#[inline]
pub fn cosine_hemisphere(u: [f64; 2]) -> DVec3 {
    let d = concentric_disk(u);
    DVec3::new(d.x, d.y, (1.0 - d.length_squared()).max(0.0).sqrt())
}

/// The unit sphere, uniform.
#[inline]
pub fn uniform_sphere(u: [f64; 2]) -> DVec3 {
    uniform_cone(u, -1.0)
}

/// Directions within the cone z >= `cos_max`, uniform; density 1 / (2 pi (1 - cos_max)).
#[inline]
pub fn uniform_cone(u: [f64; 2], cos_max: f64) -> DVec3 {
    let drop = u[0] * (1.0 - cos_max);
    let r = (drop * (2.0 - drop)).max(0.0).sqrt();
    let (sin, cos) = (TAU * u[1]).sin_cos();
    DVec3::new(r * cos, r * sin, 1.0 - drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First and second moments over a 512 x 512 grid of midpoints; a grid has no sampling noise.
    fn mean(f: impl Fn([f64; 2]) -> f64) -> f64 {
        let n = 512;
        let at = |i: usize| (i as f64 + 0.5) / n as f64;
        (0..n * n).map(|i| f([at(i % n), at(i / n)])).sum::<f64>() / (n * n) as f64
    }

    #[test]
    fn moments_are_those_of_the_densities() {
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-4, "{a} instead of {b}");
        close(mean(|u| concentric_disk(u).length_squared()), 0.5);
        close(mean(|u| cosine_hemisphere(u).z), 2.0 / 3.0);
        close(mean(|u| cosine_hemisphere(u).x.powi(2)), 0.25);
        close(mean(|u| uniform_sphere(u).z), 0.0);
        close(mean(|u| uniform_sphere(u).x.powi(2)), 1.0 / 3.0);
        close(mean(|u| uniform_cone(u, 0.5).z), 0.75);
        assert!((uniform_cone([0.7, 0.3], 0.999_999_9).length() - 1.0).abs() < 1e-12);
    }
}
