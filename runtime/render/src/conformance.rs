//! What every bsdf, phase function and light must obey, instantiated by a line each.
//!
//! Random numbers are fixed by seed. Chi-square tests use 200 000 samples and a threshold at a false-alarm rate of 1e-5 per
//! test. Means of n samples are compared within five standard errors (false-alarm rate 6e-7).

mod area_lights;
mod bsdfs;
mod layered;
mod lights;
mod mueller;
mod phases;

use std::f64::consts::TAU;

use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

const SAMPLES: usize = 200_000;

fn random() -> Pcg64 {
    Pcg64::seed_from_u64(0x5eed)
}

fn pair(random: &mut Pcg64) -> [f64; 2] {
    [random.random(), random.random()]
}

/// Mean and its standard error.
fn mean(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut n, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for value in values {
        n += 1.0;
        sum += value;
        squares += value * value;
    }
    let mean = sum / n;
    (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt())
}

/// Quantile of the standard normal distribution at an upper tail of 1e-5.
const NORMAL_QUANTILE: f64 = 4.265;

/// Quantile of the chi-square distribution where the standard normal one has `normal` (Wilson and Hilferty 1931).
fn chi_square_quantile(degrees: f64, normal: f64) -> f64 {
    let c = 2.0 / (9.0 * degrees);
    degrees * (1.0 - c + normal * c.sqrt()).powi(3)
}

/// Directions from `sample` (`None` counts too) follow `pdf` per steradian: chi-square over equal solid angles, whose
/// expectations are integrals of the pdf by a midpoint rule; cells that expect less than five samples are pooled.
fn assert_directions_follow(
    name: &str,
    mut sample: impl FnMut(&mut Pcg64) -> Option<DVec3>,
    pdf: impl Fn(DVec3) -> f64,
) {
    const ROWS: usize = 24;
    const COLUMNS: usize = 32;
    const PROBES: usize = 16;
    let cell_of = |wi: DVec3| {
        let row = (((wi.z + 1.0) * 0.5 * ROWS as f64) as usize).min(ROWS - 1);
        let turn = wi.y.atan2(wi.x) / TAU;
        row * COLUMNS + (((turn - turn.floor()) * COLUMNS as f64) as usize).min(COLUMNS - 1)
    };
    let mut counts = vec![0.0; ROWS * COLUMNS + 1];
    let mut random = random();
    for _ in 0..SAMPLES {
        counts[sample(&mut random).map_or(ROWS * COLUMNS, cell_of)] += 1.0;
    }
    let expected_in = |cell: usize| {
        // About the poles a cell is a wide range of angles.
        let row = cell / COLUMNS;
        let heights = if row == 0 || row == ROWS - 1 { 16 * PROBES } else { PROBES };
        let mut sum = 0.0;
        for i in 0..heights * PROBES {
            let at = |cell: usize, k: usize, n: usize| cell as f64 + (k as f64 + 0.5) / n as f64;
            let z = 2.0 * at(row, i / PROBES, heights) / ROWS as f64 - 1.0;
            let (sin, cos) = (TAU * at(cell % COLUMNS, i % PROBES, PROBES) / COLUMNS as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            sum += pdf(DVec3::new(r * cos, r * sin, z));
        }
        sum / (heights * PROBES) as f64 * 2.0 * TAU / (ROWS * COLUMNS) as f64 * SAMPLES as f64
    };
    let mut expected: Vec<f64> = (0..ROWS * COLUMNS).map(expected_in).collect();
    // What the pdf leaves out are samples of no direction.
    expected.push((SAMPLES as f64 - expected.iter().sum::<f64>()).max(0.0));
    let (mut statistic, mut degrees, mut pooled) = (0.0, -1.0, (0.0, 0.0));
    for (count, expected) in counts.iter().zip(&expected) {
        if *expected < 5.0 {
            pooled = (pooled.0 + count, pooled.1 + expected);
        } else {
            statistic += (count - expected).powi(2) / expected;
            degrees += 1.0;
        }
    }
    if pooled.1 >= 1.0 || pooled.0 > 0.0 {
        statistic += (pooled.0 - pooled.1).powi(2) / pooled.1.max(1.0);
        degrees += 1.0;
    }
    let threshold = chi_square_quantile(degrees, NORMAL_QUANTILE);
    assert!(statistic < threshold, "{name}: chi-square {statistic:.1} of {degrees} degrees, threshold {threshold:.1}");
}

/// Tables give 149.449 for 100 degrees at 0.001 and 76.154 for 50 degrees at 0.01.
#[test]
fn chi_square_quantiles_are_the_tabulated_ones() {
    assert!((chi_square_quantile(100.0, 3.0902) - 149.449).abs() < 0.2);
    assert!((chi_square_quantile(50.0, 2.3263) - 76.154).abs() < 0.1);
}
