//! The loop over the image.
//!
//! Passes of growing length go over all tiles; within a pass the tiles are shared among the threads of the current
//! rayon pool, each owning the sums it writes. A render that is cancelled between tiles leaves pixels whose sample
//! counts differ by one pass at most. A sample is a function of (seed, pixel, number): the film does not
//! depend on threads, nor on how the samples are divided into passes.

use glam::DVec2;
use rayon::prelude::*;

use arsc_spectral::{WavelengthDistribution, WavelengthRange};

use crate::camera::Camera;
use crate::film::{Bands, Film, Tile};
use crate::integrator::incident_radiance;
use crate::polarisation::{Polarisation, Polarised, Unpolarised};
use crate::sampler::Sampler;
use crate::volume;
use crate::world::World;

/// What `path_trace` is asked for.
#[derive(Clone, Debug)]
pub struct PathTraceSettings {
    /// Camera paths per pixel.
    pub samples: u32,
    /// Largest number of scattering events of a path: 0 shows lights alone, 1 adds direct light.
    pub max_depth: u32,
    pub seed: u64,
    /// Pixels x0, y0, x1, y1 (end exclusive) of the full image; the rest stays empty.
    pub crop: Option<[u32; 4]>,
    /// What is sampled; light outside of it does not exist.
    pub wavelengths: WavelengthRange,
    /// What the film records; the observer's eye also decides where wavelengths are dense.
    pub bands: Bands,
    /// Keep track of polarisation, and of the Stokes parameters S1 to S3 on the film.
    pub polarised: bool,
}

impl Default for PathTraceSettings {
    fn default() -> PathTraceSettings {
        PathTraceSettings {
            samples: 64,
            max_depth: 20,
            seed: 0,
            crop: None,
            wavelengths: WavelengthRange::VISIBLE,
            bands: Bands::default(),
            polarised: false,
        }
    }
}

/// How a render reports and is stopped. Called from worker threads.
pub trait Progress: Sync {
    /// So many camera paths more are done.
    fn advance(&self, paths: u64);
    /// Asked between tiles and passes; when true the render ends early with what it has.
    fn cancelled(&self) -> bool;
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

/// Pair of sample dimensions for the position in the pixel; the next one is for the wavelengths.
const PIXEL_POSITION: u32 = 0;
const WAVELENGTHS: u32 = 1;

/// Renders on the threads of the current rayon pool.
pub fn path_trace(world: &World, camera: &Camera, settings: &PathTraceSettings, progress: &dyn Progress) -> Film {
    let mut film = Film::new(camera.resolution(), settings.crop, settings.bands, settings.polarised);
    let trace = match (settings.polarised, world.needs_volumes()) {
        (false, false) => trace_tile::<Unpolarised, false>,
        (false, true) => trace_tile::<Unpolarised, true>,
        (true, false) => trace_tile::<Polarised, false>,
        (true, true) => trace_tile::<Polarised, true>,
    };
    let distribution = WavelengthDistribution::new(settings.wavelengths, settings.bands.observer);
    let mut done = 0;
    while done < settings.samples && !film.tiles.is_empty() && !progress.cancelled() {
        let pass = done.clamp(1, LONGEST_PASS).min(settings.samples - done);
        film.tiles.par_iter_mut().for_each(|tile| {
            if !progress.cancelled() {
                trace(world, camera, settings, &distribution, done..done + pass, tile);
                progress.advance(u64::from(tile.width) * u64::from(tile.height) * u64::from(pass));
            }
        });
        done += pass;
    }
    film
}

/// `MEDIA`: paths know what fills the space around them, and may change their wavelengths.
fn trace_tile<P: Polarisation, const MEDIA: bool>(
    world: &World,
    camera: &Camera,
    settings: &PathTraceSettings,
    distribution: &WavelengthDistribution,
    samples: std::ops::Range<u32>,
    tile: &mut Tile,
) {
    for y in 0..tile.height {
        for x in 0..tile.width {
            let pixel = [tile.x0 + x, tile.y0 + y];
            for index in samples.clone() {
                let sampler = Sampler::new(settings.seed, pixel, index);
                let wavelengths = distribution.sample(sampler.single(WAVELENGTHS));
                let position = camera.filter.sample(sampler.pair(PIXEL_POSITION));
                let center = DVec2::new(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
                let ray = camera.ray(center + position.offset);
                let horizontal = camera.horizontal(&ray);
                let depth = settings.max_depth;
                let light = if MEDIA {
                    {
                        let range = distribution.range();
                        volume::incident_radiance::<P>(world, ray, horizontal, &wavelengths, range, &sampler, depth)
                    }
                } else {
                    incident_radiance::<P>(world, ray, horizontal, &wavelengths, &sampler, depth)
                };
                tile.add(x, y, &wavelengths, &light, position.weight);
            }
        }
    }
}
