//! FLIP, the difference that a viewer who flips between two pictures would see.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020, "FLIP: a difference evaluator for
//! alternating images", for low dynamic range: contrast sensitivity filters in an opponent space (section 4.1), the
//! distance HyAB with the Hunt effect (4.1.3), differences of edges and points (4.2), and their combination (4.3). Beyond the
//! edge of the picture its outermost pixels go on.

use arsc_spectral::colour::lab_from_xyz;
use arsc_spectral::srgb;
use glam::{DMat3, DVec3};

use std::f64::consts::PI;

/// Of a viewer 0.7 m from a screen 0.7 m wide with 3840 pixels.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Exponents of the differences of colour and feature.
const COLOUR_POWER: f64 = 0.7;
const FEATURE_POWER: f64 = 0.5;
/// Where differences of colour begin to be compressed, of the greatest, and the value there.
const KNEE: [f64; 2] = [0.4, 0.95];
/// Width of the feature detectors, degrees.
const FEATURE_DEGREES: f64 = 0.082;

/// Sensitivities: a pair of Gaussians (a, b) each for luminance, red–green and blue–yellow, in degrees.
const SENSITIVITIES: [[[f64; 2]; 2]; 3] =
    [[[1.0, 0.0047], [0.0, 1e-5]], [[1.0, 0.0053], [0.0, 1e-5]], [[34.1, 0.04], [13.5, 0.025]]];

/// The difference per pixel, in [0, 1], of two pictures in coded sRGB, `width` pixels to a row.
pub fn flip(reference: &[DVec3], test: &[DVec3], width: usize, pixels_per_degree: f64) -> Vec<f64> {
    let opponent = |pixels: &[DVec3]| -> Vec<DVec3> { pixels.iter().map(|rgb| opponent_of(linear(*rgb))).collect() };
    let (reference, test) = (opponent(reference), opponent(test));
    let colours = colour_differences(&reference, &test, width, pixels_per_degree);
    let [features, others] = [&reference, &test].map(|pixels| features(pixels, width, pixels_per_degree));
    let feature = |a: [f64; 2], b: [f64; 2]| {
        ((a[0] - b[0]).abs().max((a[1] - b[1]).abs()) / 2f64.sqrt()).clamp(0.0, 1.0).powf(FEATURE_POWER)
    };
    let pairs = features.into_iter().zip(others);
    colours.into_iter().zip(pairs).map(|(colour, (a, b))| colour.powf(1.0 - feature(a, b))).collect()
}

fn linear(rgb: DVec3) -> DVec3 {
    let decode = |c: f64| srgb::decode(c.clamp(0.0, 1.0));
    DVec3::new(decode(rgb.x), decode(rgb.y), decode(rgb.z))
}

fn white() -> DVec3 {
    srgb::xyz_from_rgb() * DVec3::ONE
}

/// Luminance, red–green, blue–yellow: L*a*b* without its cube root.
fn opponent_of(linear: DVec3) -> DVec3 {
    let n = srgb::xyz_from_rgb() * linear / white();
    DVec3::new(116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z))
}

fn linear_of(opponent: DVec3, rgb_from_xyz: &DMat3) -> DVec3 {
    let y = (opponent.x + 16.0) / 116.0;
    let n = DVec3::new(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
    (*rgb_from_xyz * (n * white())).clamp(DVec3::ZERO, DVec3::ONE)
}

/// L*, a*, b* with the chroma that counts less in the dark.
fn hunt(linear: DVec3) -> DVec3 {
    let [l, a, b] = lab_from_xyz((srgb::xyz_from_rgb() * linear).to_array(), white().to_array());
    DVec3::new(l, 0.01 * l * a, 0.01 * l * b)
}

fn hyab(a: DVec3, b: DVec3) -> f64 {
    (a.x - b.x).abs() + (a.y - b.y).hypot(a.z - b.z)
}

fn colour_differences(reference: &[DVec3], test: &[DVec3], width: usize, pixels_per_degree: f64) -> Vec<f64> {
    let rgb_from_xyz = srgb::rgb_from_xyz();
    let perceived = |pixels: &[DVec3]| -> Vec<DVec3> {
        sensed(pixels, width, pixels_per_degree).into_iter().map(|p| hunt(linear_of(p, &rgb_from_xyz))).collect()
    };
    let greatest = hyab(hunt(DVec3::Y), hunt(DVec3::Z)).powf(COLOUR_POWER);
    let [at, value] = [KNEE[0] * greatest, KNEE[1]];
    let compressed = |difference: f64| {
        if difference < at {
            value / at * difference
        } else {
            value + (difference - at) / (greatest - at) * (1.0 - value)
        }
    };
    let pairs = perceived(reference).into_iter().zip(perceived(test));
    pairs.map(|(a, b)| compressed(hyab(a, b).powf(COLOUR_POWER)).clamp(0.0, 1.0)).collect()
}

/// Filtered by the contrast sensitivities.
fn sensed(pixels: &[DVec3], width: usize, pixels_per_degree: f64) -> Vec<DVec3> {
    let widest = SENSITIVITIES.iter().flatten().map(|g| g[1]).fold(0.0, f64::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i64;
    let channels = SENSITIVITIES.iter().enumerate().map(|(channel, gaussians)| {
        let plane: Vec<f64> = pixels.iter().map(|p| p[channel]).collect();
        let mut sum = vec![0.0; plane.len()];
        let mut total = 0.0;
        for &[a, b] in gaussians.iter().filter(|g| g[0] > 0.0) {
            let taps = taps(radius, |x| (-(PI * x / pixels_per_degree).powi(2) / b).exp());
            let weight = taps.iter().sum::<f64>().powi(2) * a * (PI / b).sqrt();
            let share = filtered(&filtered(&plane, width, &normalised(&taps), true), width, &normalised(&taps), false);
            sum.iter_mut().zip(share).for_each(|(sum, value)| *sum += weight * value);
            total += weight;
        }
        sum.iter_mut().for_each(|value| *value /= total);
        sum
    });
    let channels: Vec<Vec<f64>> = channels.collect();
    (0..pixels.len()).map(|i| DVec3::new(channels[0][i], channels[1][i], channels[2][i])).collect()
}

/// Magnitudes of edges and of points.
fn features(pixels: &[DVec3], width: usize, pixels_per_degree: f64) -> Vec<[f64; 2]> {
    let grey: Vec<f64> = pixels.iter().map(|p| (p.x + 16.0) / 116.0).collect();
    let sigma = 0.5 * FEATURE_DEGREES * pixels_per_degree;
    let radius = (3.0 * sigma).ceil() as i64;
    let gaussian = |x: f64| (-x * x / (2.0 * sigma * sigma)).exp();
    let smooth = normalised(&taps(radius, gaussian));
    let first = signed(&taps(radius, |x| -x * gaussian(x)));
    let second = signed(&taps(radius, |x| (x * x / (sigma * sigma) - 1.0) * gaussian(x)));
    let along = |derivative: &[f64], horizontal: bool| {
        filtered(&filtered(&grey, width, derivative, horizontal), width, &smooth, !horizontal)
    };
    let size = |derivative: &[f64]| -> Vec<f64> {
        along(derivative, true).into_iter().zip(along(derivative, false)).map(|(x, y)| x.hypot(y)).collect()
    };
    size(&first).into_iter().zip(size(&second)).map(|(edge, point)| [edge, point]).collect()
}

fn taps(radius: i64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (-radius..=radius).map(|i| f(i as f64)).collect()
}

fn normalised(taps: &[f64]) -> Vec<f64> {
    let sum: f64 = taps.iter().sum();
    taps.iter().map(|t| t / sum).collect()
}

/// Positive taps add up to 1, negative ones to -1.
fn signed(taps: &[f64]) -> Vec<f64> {
    let positive: f64 = taps.iter().filter(|t| **t > 0.0).sum();
    let negative: f64 = -taps.iter().filter(|t| **t < 0.0).sum::<f64>();
    taps.iter().map(|t| t / if *t > 0.0 { positive } else { negative }).collect()
}

/// Correlates rows (or columns) with taps about their middle.
fn filtered(plane: &[f64], width: usize, taps: &[f64], horizontal: bool) -> Vec<f64> {
    let height = plane.len() / width;
    let radius = (taps.len() / 2) as i64;
    let mut result = vec![0.0; plane.len()];
    for (i, value) in result.iter_mut().enumerate() {
        let (x, y) = (i % width, i / width);
        let mut sum = 0.0;
        for (k, tap) in taps.iter().enumerate() {
            let offset = k as i64 - radius;
            let at = |middle: usize, end: usize| (middle as i64 + offset).clamp(0, end as i64 - 1) as usize;
            sum += tap * if horizontal { plane[y * width + at(x, width)] } else { plane[at(y, height) * width + x] };
        }
        *value = sum;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pattern that any program can repeat: edges, points, gradients and colours.
    fn pattern(width: usize, height: usize, phase: usize) -> Vec<DVec3> {
        let level = |n: usize| (n % 256) as f64 / 255.0;
        let pixel = |i: usize| {
            let (x, y) = (i % width, i / width);
            let stripe = if ((x + phase) / 8).is_multiple_of(2) { 40 } else { 0 };
            DVec3::new(level(7 * x + stripe), level(5 * y + 3 * x * phase), level(x * y + 11 * phase))
        };
        (0..width * height).map(pixel).collect()
    }

    /// Phase of the pattern, mean and the pixel at 20, 10.
    const FROM_THE_AUTHORS: [(usize, f64, f64); 3] =
        [(1, 0.674_532, 0.524_846), (2, 0.673_209, 0.964_054), (5, 0.795_774, 0.562_020)];

    /// Means and a pixel as the authors' own program gives them (PyPI flip-evaluator 1.7, 32 bit floats).
    #[test]
    fn differences_are_those_of_the_authors() {
        for (phase, mean, pixel) in FROM_THE_AUTHORS {
            let found = flip(&pattern(48, 32, 0), &pattern(48, 32, phase), 48, PIXELS_PER_DEGREE);
            let average = found.iter().sum::<f64>() / found.len() as f64;
            assert!((average - mean).abs() < 2e-4, "phase {phase}: mean {average} instead of {mean}");
            assert!((found[10 * 48 + 20] - pixel).abs() < 1e-3, "phase {phase}: {} instead of {pixel}", found[500]);
        }
    }

    #[test]
    fn equal_pictures_do_not_differ_and_opposite_ones_do_utterly() {
        let picture = pattern(20, 10, 3);
        assert!(flip(&picture, &picture, 20, PIXELS_PER_DEGREE).iter().all(|d| *d == 0.0));
        let (black, white) = (vec![DVec3::ZERO; 200], vec![DVec3::ONE; 200]);
        assert!(flip(&black, &white, 20, PIXELS_PER_DEGREE).iter().all(|d| *d > 0.9 && *d <= 1.0));
        assert_eq!(flip(&black[..1], &white[..1], 1, PIXELS_PER_DEGREE).len(), 1);
    }
}
