//! The loop over the image, shared by all integrators.
//!
//! Passes of growing length go over the tiles; within a pass the tiles are shared among the threads of the current
//! rayon pool, each owning the sums it writes. A render that is cancelled between tiles leaves pixels whose sample
//! counts differ by one pass at most. A sample is a function of (seed, pixel, number): the film does not
//! depend on threads, nor, without a noise threshold, on how the samples are divided into passes. A time limit makes the
//! number of samples depend on the machine; what a given number of samples shows does not.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use arsc_spectral::{SampledWavelengths, WavelengthDistribution};

use crate::camera::{Camera, CameraRay};
use crate::film::{Film, Tile};
use crate::noise::NoiseMap;
use crate::sampler::{SampleSequence, Sampler};

/// How many samples, and which.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Camera paths per pixel; with a noise threshold or a time limit, at most.
    pub samples: u32,
    pub seed: u64,
    pub sequence: SampleSequence,
    /// Pixels x0, y0, x1, y1 (end exclusive) of the full image; the rest stays empty.
    pub crop: Option<[u32; 4]>,
    /// Tiles get no more samples once the relative standard error of their pixels is this, [`crate::noise`].
    pub noise: Option<f64>,
}

impl Default for Sampling {
    fn default() -> Sampling {
        Sampling { samples: 64, seed: 0, sequence: SampleSequence::Sobol, crop: None, noise: None }
    }
}

/// How a render reports and is stopped. Called from worker threads, but for [`Progress::pass`].
pub trait Progress: Sync {
    /// So many camera paths more are done.
    fn advance(&self, paths: u64);
    /// Asked between tiles and passes; when true the render ends early with what it has.
    fn cancelled(&self) -> bool;
    /// Seconds until the render shall end with what it has; `None` without a limit. The first sample of every pixel is
    /// taken whatever the time.
    fn seconds_left(&self) -> Option<f64> {
        None
    }
    /// A pass is over.
    fn pass(&self, _: &Pass) {}
}

/// What is known after a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// Relative noise of the picture, once there are samples enough to tell.
    pub noise: Option<f64>,
    /// Camera paths of the whole render, as it seems now.
    pub expected_paths: u64,
}

/// No report, no end before the end.
impl Progress for () {
    fn advance(&self, _: u64) {}
    fn cancelled(&self) -> bool {
        false
    }
}

/// Samples per pixel of the longest pass.
const LONGEST_PASS: u32 = 16;

/// Pairs of sample dimensions: the position in the pixel, the wavelengths, the point of the lens.
const PIXEL_POSITION: u32 = 0;
const WAVELENGTHS: u32 = 1;
const LENS: u32 = 2;

/// Pairs of sample dimensions that cameras use; those of integrators follow.
pub(crate) const CAMERA_PAIRS: u32 = 3;

/// Where a sample begins.
pub(crate) struct CameraSample {
    pub sampler: Sampler,
    pub wavelengths: SampledWavelengths,
    /// `None` outside of the camera's field of view.
    pub ray: Option<CameraRay>,
    /// The filter's.
    pub weight: f64,
}

impl CameraSample {
    /// Sample number `index` of a pixel.
    #[inline]
    pub fn new(
        camera: &Camera,
        sampling: &Sampling,
        distribution: &WavelengthDistribution,
        pixel: [u32; 2],
        index: u32,
    ) -> CameraSample {
        let sampler = Sampler::of(sampling.sequence, sampling.seed, pixel, index);
        let wavelengths = distribution.sample(sampler.single(WAVELENGTHS));
        let position = camera.filter.sample(sampler.pair(PIXEL_POSITION));
        let center = DVec2::new(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
        let lens = if camera.has_lens() { sampler.pair(LENS) } else { [0.5; 2] };
        let ray = camera.sample_ray(center + position.offset, lens);
        CameraSample { sampler, wavelengths, ray, weight: position.weight }
    }
}

/// Fills a film: `trace` adds the samples of a range of numbers to all pixels of a tile.
pub(crate) fn run<T>(film: &mut Film, sampling: &Sampling, progress: &dyn Progress, trace: T)
where
    T: Fn(Range<u32>, &mut Tile) + Sync,
{
    let columns = film.columns();
    let pixels: Vec<u64> = film.tiles.iter().map(Tile::pixels).collect();
    let mut done = vec![0u32; pixels.len()];
    let mut wanted = vec![sampling.samples; pixels.len()];
    let mut seconds_per_path = 0.0;
    loop {
        let active = |i: usize| done[i] < wanted[i];
        let Some(fewest) = (0..done.len()).filter(|&i| active(i)).map(|i| done[i]).min() else { break };
        let paths_per_sample: u64 = (0..done.len()).filter(|&i| active(i)).map(|i| pixels[i]).sum();
        let before = progress.seconds_left();
        let affordable = before.map_or(u32::MAX, |left| (left / (seconds_per_path * paths_per_sample as f64)) as u32);
        let pass = fewest.clamp(1, LONGEST_PASS).min(if fewest == 0 { 1 } else { affordable });
        if pass == 0 || progress.cancelled() {
            break;
        }
        let ends: Vec<u32> =
            (0..done.len()).map(|i| wanted[i].min(done[i].saturating_add(pass)).max(done[i])).collect();
        film.tiles.par_iter_mut().zip(&done).zip(&ends).for_each(|((tile, &from), &to)| {
            if from < to && !progress.cancelled() {
                trace(from..to, tile);
                progress.advance(tile.pixels() * u64::from(to - from));
            }
        });
        let paths: u64 = (0..done.len()).map(|i| pixels[i] * u64::from(ends[i] - done[i])).sum();
        if let (Some(before), Some(after)) = (before, progress.seconds_left()) {
            seconds_per_path = (before - after).max(0.0) / paths.max(1) as f64;
        }
        done = ends;
        if progress.cancelled() {
            break;
        }
        let map = NoiseMap::new(&film.tiles.par_iter().map(Tile::noise).collect::<Vec<_>>(), columns);
        if let Some(threshold) = sampling.noise {
            for (tile, wanted) in wanted.iter_mut().enumerate() {
                *wanted = map.samples_needed(tile, threshold).min(sampling.samples);
            }
        }
        let expected_paths = (0..done.len()).map(|i| pixels[i] * u64::from(wanted[i])).sum();
        progress.pass(&Pass { noise: map.of_picture(), expected_paths });
    }
}
