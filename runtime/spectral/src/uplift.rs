//! Reflectance spectra for colours (Jakob and Hanika 2019, "A low-dimensional function space for efficient spectral
//! upsampling").
//!
//! The spectrum is a sigmoid of a quadratic in wavelength. Its three coefficients are found by damped Gauss–Newton
//! (Levenberg–Marquardt) on the linear sRGB residual under D65, with one colour solved per call and no table. It
//! starts from the grey of the same mean and walks to the colour along a straight line, because a saturated
//! colour is out of reach from afar. Black, white and the faces of the cube lie at infinity of the coefficients:
//! components are kept 1/2000 away from 0 and 1.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use crate::eval::sigmoid;
use crate::observer::{d65, matching_functions};
use crate::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, srgb};

const MARGIN: f64 = 1.0 / 2000.0;
const STATIONS: usize = 8;
const ITERATIONS: usize = 20;

/// What a unit of reflectance at a wavelength adds to linear sRGB, at every 5 nm: position in [0, 1], weights.
static WEIGHTS: LazyLock<Vec<(f64, DVec3)>> = LazyLock::new(|| {
    let to_rgb = srgb::rgb_from_xyz();
    let rows = matching_functions().iter().enumerate();
    let fine: Vec<(f64, DVec3)> = rows
        .map(|(i, row)| {
            let lambda = LAMBDA_MIN_NM + i as f64;
            (i as f64 / (LAMBDA_MAX_NM - LAMBDA_MIN_NM), to_rgb * DVec3::from_array(*row) * d65().eval(lambda))
        })
        .collect();
    // Trapezoidal regrouping onto every fifth knot: linear functions of wavelength keep their integral.
    let mut coarse: Vec<(f64, DVec3)> = fine.iter().step_by(5).map(|(x, _)| (*x, DVec3::ZERO)).collect();
    for (i, (_, weight)) in fine.iter().enumerate() {
        let (cell, t) = (i / 5, (i % 5) as f64 / 5.0);
        coarse[cell].1 += *weight * (1.0 - t);
        if t > 0.0 {
            coarse[cell + 1].1 += *weight * t;
        }
    }
    // The perfect diffuser is exactly white.
    let white: DVec3 = coarse.iter().map(|(_, weight)| *weight).sum();
    coarse.into_iter().map(|(x, weight)| (x, weight / white)).collect()
});

/// Coefficients for [`crate::Spectrum::Sigmoid`] of a reflectance that has the given linear sRGB colour under D65.
/// Components are limited to [0, 1] (NaN counts as 0). Greys give flat spectra.
pub fn uplift_rgb(rgb: [f64; 3]) -> [f64; 3] {
    let limited = rgb.map(|c| if c.is_nan() { MARGIN } else { c.clamp(MARGIN, 1.0 - MARGIN) });
    let target = DVec3::from_array(limited);
    let grey = (target.x + target.y + target.z) / 3.0;
    let mut c = DVec3::new(0.0, 0.0, (grey - 0.5) / (grey * (1.0 - grey)).sqrt());
    if target.max_element() > target.min_element() {
        for station in 1..=STATIONS {
            let goal = DVec3::splat(grey).lerp(target, station as f64 / STATIONS as f64);
            c = solve(c, goal);
        }
    }
    in_nanometres(c)
}

/// Levenberg–Marquardt from `c` towards `goal`.
fn solve(mut c: DVec3, goal: DVec3) -> DVec3 {
    let (mut colour, mut jacobian) = colour_and_jacobian(c);
    let mut damping = 1e-6;
    for _ in 0..ITERATIONS {
        let residual = goal - colour;
        if residual.length_squared() < 1e-20 {
            break;
        }
        let normal = jacobian.transpose() * jacobian;
        let trace = normal.x_axis.x + normal.y_axis.y + normal.z_axis.z;
        let damped = normal + DMat3::from_diagonal(DVec3::splat(damping * trace));
        let step = damped.inverse() * (jacobian.transpose() * residual);
        let (next_colour, next_jacobian) = colour_and_jacobian(c + step);
        if step.is_finite() && (goal - next_colour).length_squared() < residual.length_squared() {
            (c, colour, jacobian) = (c + step, next_colour, next_jacobian);
            damping = (damping * 0.1).max(1e-15);
        } else {
            damping *= 10.0;
        }
    }
    c
}

/// Linear sRGB of the sigmoid with coefficients for wavelengths mapped to [0, 1], and its derivatives by them.
fn colour_and_jacobian(c: DVec3) -> (DVec3, DMat3) {
    let (mut colour, mut jacobian) = (DVec3::ZERO, DMat3::ZERO);
    for &(x, weight) in WEIGHTS.iter() {
        let quadratic = (c.x * x + c.y) * x + c.z;
        let slope = 0.5 * (1.0 + quadratic * quadratic).powf(-1.5);
        colour += weight * sigmoid(quadratic);
        let derivative = weight * slope;
        jacobian.x_axis += derivative * (x * x);
        jacobian.y_axis += derivative * x;
        jacobian.z_axis += derivative;
    }
    (colour, jacobian)
}

/// From x = (lambda - 360) / 470 to lambda.
fn in_nanometres(c: DVec3) -> [f64; 3] {
    let scale = 1.0 / (LAMBDA_MAX_NM - LAMBDA_MIN_NM);
    let shift = -LAMBDA_MIN_NM * scale;
    [c.x * scale * scale, 2.0 * c.x * scale * shift + c.y * scale, c.x * shift * shift + c.y * shift + c.z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Spectrum, xyz_of_reflectance};

    fn round_trip(rgb: [f64; 3]) -> [f64; 3] {
        let spectrum = Spectrum::Sigmoid { coefficients: uplift_rgb(rgb) };
        (srgb::rgb_from_xyz() * DVec3::from_array(xyz_of_reflectance(&spectrum, d65()))).to_array()
    }

    /// All corners, edges, faces and the inside of the cube in steps of 1/8.
    #[test]
    fn colours_come_back() {
        let mut worst = (0.0, [0.0; 3]);
        for i in 0..729 {
            let rgb = [i / 81, i / 9 % 9, i % 9].map(|k| k as f64 / 8.0);
            let back = round_trip(rgb);
            let error = (0..3).map(|c| (back[c] - rgb[c]).abs()).fold(0.0, f64::max);
            if error.is_nan() || error > worst.0 {
                worst = (error, rgb);
            }
        }
        assert!(worst.0 < 2e-3, "{worst:?} comes back as {:?}", round_trip(worst.1));
    }

    #[test]
    fn greys_are_flat() {
        for v in [0.0, 0.01, 0.18, 0.5, 0.9, 1.0] {
            let spectrum = Spectrum::Sigmoid { coefficients: uplift_rgb([v; 3]) };
            for lambda in [360.0, 500.0, 830.0] {
                assert!((spectrum.eval(lambda) - v).abs() <= MARGIN * 1.001, "grey {v} at {lambda} nm");
            }
        }
    }

    #[test]
    fn nonsense_gives_finite_coefficients() {
        for rgb in [[f64::NAN, 0.2, 0.3], [f64::INFINITY, -1.0, 0.0], [-1e300, 1e300, f64::NEG_INFINITY]] {
            assert!(uplift_rgb(rgb).iter().all(|c| c.is_finite()), "{rgb:?}");
        }
    }
}
