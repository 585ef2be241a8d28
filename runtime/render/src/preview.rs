//! A quick look: surfaces in their colours, lit from the camera.
//!
//! A surface sends the camera the light of D65 times its albedo times the cosine between its normal and the ray, as
//! under a lamp at the eye without falloff; lamps show D65 alone. One ray per sample, no shadows. A white surface seen
//! head-on has the luminance of the equal-energy radiance 1.

use arsc_geometry::Ray;
use arsc_spectral::{
    DenseSpectrum, Observer, SampledSpectrum, SampledWavelengths, WavelengthDistribution, WavelengthRange, d65,
};

use crate::ambient_occlusion::one_band;
use crate::camera::Camera;
use crate::film::Film;
use crate::first_hit::{albedo, first_hit, seen_normal};
use crate::passes::{self, CAMERA_PAIRS, CameraSample, Progress, Sampling};
use crate::sampler::Sampler;
use crate::world::World;

/// Pairs of sample dimensions of the first surface.
const DIRECTION: u32 = CAMERA_PAIRS;
const LOBE: u32 = CAMERA_PAIRS + 1;

/// Renders on the threads of the current rayon pool.
pub fn preview(world: &World, camera: &Camera, sampling: &Sampling, progress: &dyn Progress) -> Film {
    let mut film = Film::new(camera.resolution(), sampling.crop, one_band(), false);
    let distribution = WavelengthDistribution::new(WavelengthRange::VISIBLE, Observer::Cie1931);
    let white = DenseSpectrum::new(d65());
    passes::run(&mut film, sampling, progress, |samples, tile| {
        tile.for_each_sample(samples, |pixel, index| {
            let sample = CameraSample::new(camera, sampling, &distribution, pixel, index);
            let shade = |ray| shade(world, ray, &sample.sampler, &sample.wavelengths);
            let share = sample.ray.map_or(SampledSpectrum::ZERO, |camera_ray| shade(camera_ray.ray));
            (sample.wavelengths, share * white.sample(&sample.wavelengths), sample.weight)
        });
    });
    film
}

fn shade(world: &World, ray: Ray, sampler: &Sampler, wavelengths: &SampledWavelengths) -> SampledSpectrum {
    let wo = -ray.dir;
    let Some(mut hit) = first_hit(world, ray) else { return SampledSpectrum::ZERO };
    if world.material(&hit).emitter.is_some() {
        return SampledSpectrum::ONE;
    }
    let albedo = albedo(world, &mut hit, wo, sampler.pair(DIRECTION), sampler.single(LOBE), wavelengths);
    albedo * wo.dot(seen_normal(&hit, wo)) as f32
}
