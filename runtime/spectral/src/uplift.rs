//! Reflectance spectra for colours (Jakob and Hanika 2019, "A low-dimensional function space for efficient spectral
//! upsampling").
//!
//! The spectrum is a sigmoid of a quadratic in wavelength. Its three coefficients are found by damped Gauss–Newton
//! (Levenberg–Marquardt) on the residual of the colour under an illuminant, one colour per call and no table. It
//! starts from the grey of the same mean and walks to the colour along a straight line, because a saturated
//! colour is out of reach from afar. Under D65 colours are linear sRGB; black, white and the faces of its cube lie at
//! infinity of the coefficients: components are kept 1/2000 away from 0 and 1. Under other illuminants colours are
//! X, Y, Z relative to the perfect diffuser's.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use crate::eval::sigmoid;
use crate::observer::{Observer, d65};
use crate::range::{TABLE_MIN_NM, WavelengthRange};
use crate::{Spectrum, srgb};

/// Where the solver works; the sigmoid goes on beyond.
const FIRST_NM: f64 = WavelengthRange::VISIBLE.min_nm();
const LENGTH_NM: f64 = WavelengthRange::VISIBLE.width_nm();

const MARGIN: f64 = 1.0 / 2000.0;
const STATIONS: usize = 8;
const ITERATIONS: usize = 20;

/// What a unit of reflectance at a wavelength adds to the colour, at every 5 nm: position in [0, 1], weights.
type Weights = Vec<(f64, DVec3)>;

static SRGB_WEIGHTS: LazyLock<Weights> = LazyLock::new(|| weights(d65(), srgb::rgb_from_xyz()));

/// For colours in the basis `from_xyz`; the perfect diffuser has the colour (1, 1, 1).
fn weights(illuminant: &Spectrum, from_xyz: DMat3) -> Weights {
    let rows = &Observer::Cie1931.matching_functions()[(FIRST_NM - TABLE_MIN_NM) as usize..][..=LENGTH_NM as usize];
    let fine = rows
        .iter()
        .enumerate()
        .map(|(i, row)| from_xyz * DVec3::from_array(*row) * illuminant.eval(FIRST_NM + i as f64));
    // Trapezoidal regrouping onto every fifth knot: linear functions of wavelength keep their integral.
    let mut coarse: Weights = (0..rows.len()).step_by(5).map(|i| (i as f64 / LENGTH_NM, DVec3::ZERO)).collect();
    for (i, weight) in fine.enumerate() {
        let (cell, t) = (i / 5, (i % 5) as f64 / 5.0);
        coarse[cell].1 += weight * (1.0 - t);
        if t > 0.0 {
            coarse[cell + 1].1 += weight * t;
        }
    }
    // The perfect diffuser is exactly white.
    let white: DVec3 = coarse.iter().map(|(_, weight)| *weight).sum();
    coarse.into_iter().map(|(x, weight)| (x, weight / white)).collect()
}

/// Coefficients for [`Spectrum::Sigmoid`] of a reflectance that has the given linear sRGB colour under D65.
/// Components are limited to [0, 1] (NaN counts as 0). Greys give flat spectra.
pub fn uplift_rgb(rgb: [f64; 3]) -> [f64; 3] {
    let limited = rgb.map(|c| if c.is_nan() { MARGIN } else { c.clamp(MARGIN, 1.0 - MARGIN) });
    in_nanometres(solve(&SRGB_WEIGHTS, DVec3::from_array(limited)).0)
}

/// Coefficients for [`Spectrum::Sigmoid`] of a reflectance that has the given X, Y, Z under an illuminant, the perfect
/// diffuser's Y being 1; and what is left of the colour's error relative to white, in the worst of X, Y and Z. No
/// reflectance has a colour outside of the solid of object colours: there the error is large.
pub fn uplift_xyz(xyz: [f64; 3], illuminant: &Spectrum) -> ([f64; 3], f64) {
    let weights = weights(illuminant, DMat3::IDENTITY);
    let white = DVec3::from_array(Observer::Cie1931.xyz_of_reflectance(&Spectrum::Constant(1.0), illuminant));
    let target = DVec3::from_array(xyz) / white;
    if !target.is_finite() {
        return ([0.0; 3], f64::INFINITY);
    }
    let (coefficients, residual) = solve(&weights, target);
    (in_nanometres(coefficients), residual.abs().max_element())
}

/// Coefficients for wavelengths mapped to [0, 1], and what is left of the error.
fn solve(weights: &Weights, target: DVec3) -> (DVec3, DVec3) {
    let grey = ((target.x + target.y + target.z) / 3.0).clamp(MARGIN, 1.0 - MARGIN);
    let mut c = DVec3::new(0.0, 0.0, (grey - 0.5) / (grey * (1.0 - grey)).sqrt());
    let mut residual = target - colour_and_jacobian(weights, c).0;
    if target.max_element() > target.min_element() {
        for station in 1..=STATIONS {
            let goal = DVec3::splat(grey).lerp(target, station as f64 / STATIONS as f64);
            (c, residual) = approach(weights, c, goal);
        }
    }
    (c, residual)
}

/// Levenberg–Marquardt from `c` towards `goal`.
fn approach(weights: &Weights, mut c: DVec3, goal: DVec3) -> (DVec3, DVec3) {
    let (mut colour, mut jacobian) = colour_and_jacobian(weights, c);
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
        let (next_colour, next_jacobian) = colour_and_jacobian(weights, c + step);
        if step.is_finite() && (goal - next_colour).length_squared() < residual.length_squared() {
            (c, colour, jacobian) = (c + step, next_colour, next_jacobian);
            damping = (damping * 0.1).max(1e-15);
        } else {
            damping *= 10.0;
        }
    }
    (c, goal - colour)
}

/// Colour of the sigmoid with coefficients for wavelengths mapped to [0, 1], and its derivatives by them.
fn colour_and_jacobian(weights: &Weights, c: DVec3) -> (DVec3, DMat3) {
    let (mut colour, mut jacobian) = (DVec3::ZERO, DMat3::ZERO);
    for &(x, weight) in weights {
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
    let scale = 1.0 / LENGTH_NM;
    let shift = -FIRST_NM * scale;
    [c.x * scale * scale, 2.0 * c.x * scale * shift + c.y * scale, c.x * shift * shift + c.y * shift + c.z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::xyz_of_reflectance;

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

    /// Under illuminants of unlike colour, an object colour outside of the gamut of sRGB included.
    #[test]
    fn tristimulus_values_come_back() {
        let incandescent = Spectrum::Blackbody { kelvin: 2856.0 };
        for illuminant in [d65(), &incandescent, &Spectrum::Constant(1.0)] {
            for (x, y, luminance) in [(0.35, 0.36, 0.2), (0.25, 0.22, 0.1), (0.55, 0.41, 0.3), (0.2, 0.55, 0.15)] {
                let xyz = crate::colour::xyz_from_xyy([x, y, luminance]);
                let (coefficients, error) = uplift_xyz(xyz, illuminant);
                assert!(error < 1e-3, "{x} {y}: {error}");
                let back = xyz_of_reflectance(&Spectrum::Sigmoid { coefficients }, illuminant);
                assert!((0..3).all(|c| (back[c] - xyz[c]).abs() < 1.5e-3), "{xyz:?} comes back as {back:?}");
            }
        }
        let (_, error) = uplift_xyz(crate::colour::xyz_from_xyy([0.17, 0.02, 0.5]), d65());
        assert!(error > 0.1, "no reflectance is so bright a violet: {error}");
        assert_eq!(uplift_xyz([f64::NAN, 1.0, 1.0], d65()).1, f64::INFINITY);
    }

    #[test]
    fn nonsense_gives_finite_coefficients() {
        for rgb in [[f64::NAN, 0.2, 0.3], [f64::INFINITY, -1.0, 0.0], [-1e300, 1e300, f64::NEG_INFINITY]] {
            assert!(uplift_rgb(rgb).iter().all(|c| c.is_finite()), "{rgb:?}");
        }
    }
}
