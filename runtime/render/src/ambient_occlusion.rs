//! Ambient occlusion: how much of the space above a surface is open within a distance.
//!
//! The value of a point is the share, weighted by the cosine, of the directions above it along which nothing lies within
//! the distance (Zhukov, Iones and Kronin 1998, with a step for the falloff). It is shown as the light of D65 whose full
//! value has the luminance of the equal-energy radiance 1: a linear sRGB of (v, v, v). Where the camera sees nothing the
//! value is 1. Materials do not count, except that walls without a bsdf are not there.

use arsc_spectral::{DenseSpectrum, Observer, SampledSpectrum, WavelengthDistribution, WavelengthRange, d65};
use glam::DVec3;

use crate::camera::Camera;
use crate::film::{Bands, Film};
use crate::first_hit::first_hit;
use crate::frame::Frame;
use crate::passes::{self, CAMERA_PAIRS, CameraSample, Progress, Sampling};
use crate::warp::cosine_hemisphere;
use crate::world::World;

/// Pair of sample dimensions for the direction.
const DIRECTION: u32 = CAMERA_PAIRS;

/// One band over the visible range: the picture is about values, not colours.
pub(crate) fn one_band() -> Bands {
    Bands::over(&WavelengthRange::VISIBLE, WavelengthRange::VISIBLE.width_nm(), Observer::Cie1931)
}

/// Renders on the threads of the current rayon pool. `distance` in scene units, positive, may be infinite.
pub fn ambient_occlusion(
    world: &World,
    camera: &Camera,
    distance: f64,
    sampling: &Sampling,
    progress: &dyn Progress,
) -> Film {
    let mut film = Film::new(camera.resolution(), sampling.crop, one_band(), false);
    let distribution = WavelengthDistribution::new(WavelengthRange::VISIBLE, Observer::Cie1931);
    let white = DenseSpectrum::new(d65());
    passes::run(&mut film, sampling, progress, |samples, tile| {
        tile.for_each_sample(samples, |pixel, index| {
            let sample = CameraSample::new(camera, sampling, &distribution, pixel, index);
            let light = match sample.ray {
                Some(camera_ray) if !is_open(world, camera_ray.ray, distance, sample.sampler.pair(DIRECTION)) => {
                    SampledSpectrum::ZERO
                }
                Some(_) => white.sample(&sample.wavelengths),
                None => SampledSpectrum::ZERO,
            };
            (sample.wavelengths, light, sample.weight)
        });
    });
    film
}

/// Nothing lies within the distance along one direction above what the ray meets.
fn is_open(world: &World, ray: arsc_geometry::Ray, distance: f64, u: [f64; 2]) -> bool {
    let wo = -ray.dir;
    let Some(hit) = first_hit(world, ray) else { return true };
    let normal = if wo.dot(hit.ng) < 0.0 { -hit.ng } else { hit.ng };
    let wi: DVec3 = Frame::new(normal).to_world(cosine_hemisphere(u));
    let mut shadow = hit.spawn(wi);
    shadow.t_max = distance;
    !world.geometry.occluded(&shadow)
}
