//! Path tracing: spectral, and polarised where that is asked for.

use arsc_spectral::{SampledSpectrum, WavelengthDistribution, WavelengthRange};

use crate::camera::{Camera, CameraRay};
use crate::film::{Bands, Film, Tile};
use crate::integrator::incident_radiance;
use crate::passes::{self, CameraSample, Progress, Sampling};
use crate::polarisation::{Polarisation, Polarised, Stokes, Unpolarised};
use crate::volume;
use crate::world::World;

/// What `path_trace` is asked for.
#[derive(Clone, Debug)]
pub struct PathTraceSettings {
    pub sampling: Sampling,
    /// Largest number of scattering events of a path: 0 shows lights alone, 1 adds direct light.
    pub max_depth: u32,
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
            sampling: Sampling::default(),
            max_depth: 20,
            wavelengths: WavelengthRange::VISIBLE,
            bands: Bands::default(),
            polarised: false,
        }
    }
}

/// Renders on the threads of the current rayon pool.
pub fn path_trace(world: &World, camera: &Camera, settings: &PathTraceSettings, progress: &dyn Progress) -> Film {
    let sampling = &settings.sampling;
    let mut film = Film::new(camera.resolution(), sampling.crop, settings.bands, settings.polarised);
    let trace = match (settings.polarised, world.needs_volumes()) {
        (false, false) => trace_tile::<Unpolarised, false>,
        (false, true) => trace_tile::<Unpolarised, true>,
        (true, false) => trace_tile::<Polarised, false>,
        (true, true) => trace_tile::<Polarised, true>,
    };
    let distribution = WavelengthDistribution::new(settings.wavelengths, settings.bands.observer);
    passes::run(&mut film, sampling, progress, |samples, tile: &mut Tile| {
        trace(world, camera, settings, &distribution, samples, tile);
    });
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
    let depth = settings.max_depth;
    for y in 0..tile.height {
        for x in 0..tile.width {
            let pixel = [tile.x0 + x, tile.y0 + y];
            for index in samples.clone() {
                let sample = CameraSample::new(camera, &settings.sampling, distribution, pixel, index);
                let (wavelengths, sampler) = (&sample.wavelengths, &sample.sampler);
                let light = match sample.ray {
                    None => P::Stokes::unpolarised(SampledSpectrum::ZERO),
                    Some(CameraRay { ray, horizontal }) if MEDIA => {
                        let range = distribution.range();
                        volume::incident_radiance::<P>(world, ray, horizontal, wavelengths, range, sampler, depth)
                    }
                    Some(CameraRay { ray, horizontal }) => {
                        incident_radiance::<P>(world, ray, horizontal, wavelengths, sampler, depth)
                    }
                };
                tile.add(x, y, wavelengths, &light, sample.weight);
            }
        }
    }
}
