//! The variance that a film tells of, and what is rendered to a noise threshold.

use arsc_image::SpectralImage;
use arsc_render::{Camera, Film, PathTraceSettings, SampleSequence, Sampling, World, path_trace};
use arsc_spectral::{Observer, WavelengthRange};
use glam::DVec3;

use super::support::{Stage, camera, constant, emitter, lambert};

/// A ball on another under a lamp above the picture: a black background, a noisy penumbra.
fn scene(pixels: u32) -> (World, Camera) {
    let mut stage = Stage::default();
    stage.sphere(DVec3::new(0.0, 0.0, -10.0), 10.0, lambert(0.6));
    stage.sphere(DVec3::new(0.0, 0.0, 0.5), 0.5, lambert(0.3));
    stage.sphere(DVec3::new(1.2, -0.3, 3.0), 0.3, emitter(constant(5.0)));
    (stage.build(), camera(DVec3::new(0.0, -5.0, 1.5), DVec3::new(0.0, 0.0, 0.4), 0.7, pixels))
}

fn settings(sampling: Sampling) -> PathTraceSettings {
    let bands = arsc_render::Bands::over(&WavelengthRange::VISIBLE, 470.0, Observer::Cie1931);
    PathTraceSettings { sampling, max_depth: 1, bands, ..PathTraceSettings::default() }
}

/// Four tiles across the middle of a picture of 64 x 64.
const STRIP: Option<[u32; 4]> = Some([0, 32, 64, 48]);

fn luminances(image: &SpectralImage) -> Vec<f64> {
    image.xyz.iter().map(|xyz| f64::from(xyz[1])).collect()
}

/// Over 32 renders of 32 samples: the mean of the variances that the films tell, and the variance of what they show,
/// summed over the picture. The latter has a relative standard error of sqrt(2 / 31 / 24^2) = 1.1 % for pixels of equal
/// variance; the noisiest tenth of them dominates, hence 3.3 %, of which the bound is four.
#[test]
fn told_variance_is_the_true_one_or_bounds_it() {
    let (runs, pixels) = (32, 24);
    let (world, view) = scene(pixels);
    for (sequence, is_unbiased) in [(SampleSequence::Independent, true), (SampleSequence::Sobol, false)] {
        let n = (pixels * pixels) as usize;
        let (mut sums, mut squares, mut told) = (vec![0.0; n], vec![0.0; n], 0.0);
        for seed in 0..runs {
            let sampling = Sampling { samples: 32, seed, sequence, ..Sampling::default() };
            let image = path_trace(&world, &view, &settings(sampling), &()).to_image();
            told += image.channel("variance.Y").expect("a variance").iter().map(|v| f64::from(*v)).sum::<f64>();
            for (i, y) in luminances(&image).into_iter().enumerate() {
                sums[i] += y;
                squares[i] += y * y;
            }
        }
        let runs = runs as f64;
        let of = |i: usize| (squares[i] - sums[i] * sums[i] / runs) / (runs - 1.0);
        let ratio = told / runs / (0..n).map(of).sum::<f64>();
        if is_unbiased {
            assert!((ratio - 1.0).abs() < 4.0 * 0.033, "{ratio}");
        } else {
            assert!(ratio > 1.0, "{ratio}");
        }
    }
}

fn to_threshold(noise: f64, seed: u64, crop: Option<[u32; 4]>) -> Film {
    let (world, view) = scene(64);
    let sampling = Sampling { samples: 2048, seed, noise: Some(noise), crop, ..Sampling::default() };
    path_trace(&world, &view, &settings(sampling), &())
}

#[test]
fn thresholds_are_kept_and_spare_the_quiet_parts() {
    let film = to_threshold(0.15, 1, None);
    let (fewest, most) = film.samples_per_pixel();
    assert!(film.noise().expect("samples enough") <= 0.15);
    // Nobody was stopped by the number of samples: all tiles are below the threshold.
    assert!((32..=64).contains(&fewest) && most > 2 * fewest && most < 2048, "{fewest} to {most}");
    let half = to_threshold(0.075, 1, None);
    assert!(half.paths() > 2 * film.paths(), "half the noise costs four times the samples, but for the first ones");
}

#[test]
fn thresholds_decide_alike_on_any_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| to_threshold(0.15, 3, STRIP))
    };
    assert_eq!(on(1), on(3));
}

/// The mean luminance of 24 renders to a threshold against that of 24 with 128 samples everywhere: the difference is
/// within four standard errors (false alarms: 1 in 5 000), which together are below 1 % where the threshold is 15 %.
#[test]
fn stopping_is_not_biased() {
    let runs = 24;
    let mean_and_error = |render: &dyn Fn(u64) -> Film| {
        let mean = |seed| luminances(&render(seed).to_image()).iter().sum::<f64>();
        let means: Vec<f64> = (0..runs).map(mean).collect();
        let mean = means.iter().sum::<f64>() / runs as f64;
        let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (runs - 1) as f64;
        (mean, variance / runs as f64)
    };
    let (world, view) = scene(64);
    let plain = |seed| Sampling { samples: 128, seed: 1000 + seed, crop: STRIP, ..Sampling::default() };
    let (stopped, stopped_variance) = mean_and_error(&|seed| to_threshold(0.15, 100 + seed, STRIP));
    let (truth, truth_variance) = mean_and_error(&|seed| path_trace(&world, &view, &settings(plain(seed)), &()));
    let error = (stopped_variance + truth_variance).sqrt();
    assert!(error < 0.01 * truth && (stopped - truth).abs() < 4.0 * error, "{stopped}, not {truth}, +- {error}");
}
