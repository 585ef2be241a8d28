//! Features of what the camera sees first: channels beside a picture, for compositing and denoising.
//!
//! | channel | of the first surface with a bsdf | filtered |
//! | --- | --- | --- |
//! | `albedo.R`, `.G`, `.B` | share of D65 that is scattered, linear sRGB; 1 for lamps | yes, 0 where nothing is |
//! | `normal.X`, `.Y`, `.Z` | shading normal on the seen side, world frame | yes, 0 where nothing is |
//! | `position.X`, `.Y`, `.Z` | world position | mean over what is seen |
//! | `depth.Z` | distance along the ray | mean over what is seen |
//! | `uv.U`, `.V` | surface coordinates | mean over what is seen |
//! | `coverage.A` | share of samples that see a surface | yes |
//! | `material.Id`, `part.Id` | number of the material, of the leaf or surface, from 1; 0 for nothing | pixel's centre |
//!
//! Means over no samples are 0. Filter weights count by sign, as in the film.

use arsc_geometry::Ray;
use arsc_image::Channel;
use arsc_spectral::{
    DenseSpectrum, Observer, SampledSpectrum, SampledWavelengths, WavelengthDistribution, WavelengthRange, d65, srgb,
    xyz_of_radiance,
};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::camera::Camera;
use crate::first_hit::{albedo, first_hit, seen_normal};
use crate::passes::{CAMERA_PAIRS, CameraSample, Sampling};
use crate::world::World;

/// Names of the channels, sorted, in the order of [`Features::values`].
const NAMES: [&str; 15] = [
    "albedo.B",
    "albedo.G",
    "albedo.R",
    "coverage.A",
    "depth.Z",
    "material.Id",
    "normal.X",
    "normal.Y",
    "normal.Z",
    "part.Id",
    "position.X",
    "position.Y",
    "position.Z",
    "uv.U",
    "uv.V",
];

/// Pairs of sample dimensions of the first surface.
const DIRECTION: u32 = CAMERA_PAIRS;
const LOBE: u32 = CAMERA_PAIRS + 1;

/// Sums over the samples of a pixel.
#[derive(Clone, Copy, Default)]
struct Features {
    weight: f64,
    covered: f64,
    /// XYZ of the albedo under D65, and of white with the same wavelengths: their ratio keeps greys grey.
    albedo: DVec3,
    white: DVec3,
    normal: DVec3,
    /// Over what is seen, each sample counting one.
    seen: f64,
    position: DVec3,
    depth: f64,
    uv: DVec2,
    material: u32,
    part: u32,
}

/// The features of all pixels: `sampling.samples` camera rays each, on the threads of the current rayon pool. Noise
/// thresholds do not apply. Outside of the crop all channels are 0.
pub fn features(world: &World, camera: &Camera, sampling: &Sampling) -> Vec<Channel> {
    let [width, height] = camera.resolution();
    let [x0, y0, x1, y1] = sampling.crop.unwrap_or([0, 0, width, height]);
    let scene = Scene {
        world,
        camera,
        sampling,
        distribution: WavelengthDistribution::new(WavelengthRange::VISIBLE, Observer::Cie1931),
        white: DenseSpectrum::new(d65()),
        white_xyz: DVec3::from_array(xyz_of_radiance(d65())).normalize_or_zero(),
    };
    let mut channels: Vec<Vec<f32>> = vec![vec![0.0; width as usize * height as usize]; NAMES.len()];
    let rows: Vec<Vec<[f32; NAMES.len()]>> = (y0..y1.min(height))
        .into_par_iter()
        .map(|y| (x0..x1.min(width)).map(|x| scene.pixel([x, y])).collect())
        .collect();
    for (row, y) in rows.iter().zip(y0..) {
        for (values, x) in row.iter().zip(x0..) {
            let at = y as usize * width as usize + x as usize;
            channels.iter_mut().zip(values).for_each(|(channel, value)| channel[at] = *value);
        }
    }
    NAMES.iter().zip(channels).map(|(name, samples)| Channel { name: (*name).to_owned(), samples }).collect()
}

struct Scene<'a> {
    world: &'a World,
    camera: &'a Camera,
    sampling: &'a Sampling,
    distribution: WavelengthDistribution,
    white: DenseSpectrum,
    /// XYZ of D65, of any length.
    white_xyz: DVec3,
}

impl Scene<'_> {
    fn pixel(&self, pixel: [u32; 2]) -> [f32; NAMES.len()] {
        let mut sums = Features::default();
        for index in 0..self.sampling.samples {
            let sample = CameraSample::new(self.camera, self.sampling, &self.distribution, pixel, index);
            sums.weight += sample.weight;
            sums.white += sample.weight * self.xyz(&sample.wavelengths, SampledSpectrum::ONE);
            if let Some(camera_ray) = &sample.ray {
                self.add(&mut sums, &sample, camera_ray.ray);
            }
        }
        let center = DVec2::new(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
        if let Some(hit) = self.camera.ray(center).and_then(|ray| first_hit(self.world, ray)) {
            sums.material = hit.material.0 + 1;
            sums.part = hit.part.0 + 1;
        }
        self.values(&sums)
    }

    fn add(&self, sums: &mut Features, sample: &CameraSample, ray: Ray) {
        let wo = -ray.dir;
        let Some(mut hit) = first_hit(self.world, ray) else { return };
        sums.covered += sample.weight;
        let share = if self.world.material(&hit).emitter.is_some() {
            SampledSpectrum::ONE
        } else {
            let (u, u_lobe) = (sample.sampler.pair(DIRECTION), sample.sampler.single(LOBE));
            albedo(self.world, &mut hit, wo, u, u_lobe, &sample.wavelengths)
        };
        sums.albedo += sample.weight * self.xyz(&sample.wavelengths, share);
        sums.normal += sample.weight * seen_normal(&hit, wo);
        sums.seen += 1.0;
        sums.position += hit.p;
        sums.depth += hit.p.distance(ray.origin);
        sums.uv += self.world.geometry.parametrize(&hit).uv;
    }

    /// Of a share of D65, up to a factor.
    fn xyz(&self, wavelengths: &SampledWavelengths, share: SampledSpectrum) -> DVec3 {
        let estimates = (share * self.white.sample(wavelengths)).0 / wavelengths.pdf;
        let matching = Observer::Cie1931.matching_functions();
        let lanes = estimates.to_array().into_iter().zip(wavelengths.knots());
        lanes.map(|(estimate, knot)| DVec3::from_array(matching[knot]) * f64::from(estimate)).sum()
    }

    fn values(&self, sums: &Features) -> [f32; NAMES.len()] {
        let inverse = |sum: f64| if sum.abs() > 0.0 { 1.0 / sum } else { 0.0 };
        let filtered = inverse(sums.weight);
        let seen = inverse(sums.seen);
        let white = DVec3::from_array(sums.white.to_array().map(inverse));
        // Linear sRGB in which D65 itself is white.
        let to_rgb = srgb::rgb_from_xyz();
        let scale = inverse((to_rgb * self.white_xyz).y);
        let rgb = to_rgb * (sums.albedo * white * self.white_xyz) * scale;
        let normal = sums.normal * filtered;
        let (position, uv) = (sums.position * seen, sums.uv * seen);
        [
            rgb.z,
            rgb.y,
            rgb.x,
            sums.covered * filtered,
            sums.depth * seen,
            f64::from(sums.material),
            normal.x,
            normal.y,
            normal.z,
            f64::from(sums.part),
            position.x,
            position.y,
            position.z,
            uv.x,
            uv.y,
        ]
        .map(|value| value as f32)
    }
}
