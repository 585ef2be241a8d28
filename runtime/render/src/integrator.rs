//! A unidirectional path tracer.
//!
//! Each scattering event samples one light and one direction of the bsdf; both find the same light and are weighted
//! by the power heuristic with exponent 2 (Veach 1997, section 9.2). Across the four wavelengths of a path the
//! balance heuristic holds (Wilkie et al. 2014, equation 6): `beta` is f / pdf for the hero's pdf, `path_pdf` the
//! ratio of each wavelength's pdf of the same path to the hero's, and what arrives is divided by the mean of that
//! ratio. The two combine: against light sampling stands the mean density of directions over the wavelengths, weighted
//! by their `path_pdf`. All weights of a wavelength then add up to one, whether or not densities depend on wavelength. Russian roulette ends dim paths from the [`ROULETTE_DEPTH`]th event on, on the brightest
//! wavelength, with the change of radiance by refraction taken out.
//!
//! Written once for light with and without polarisation. `beta` is then a Mueller matrix from the current ray to the
//! camera's; all decisions look at its first element, so that both kinds of light follow the same paths.

use arsc_accel::{Hit, Ray};
use arsc_spectral::{SampledSpectrum, SampledWavelengths};
use glam::DVec3;

use crate::bsdf::Bsdf;
use crate::frame::Frame;
use crate::light::Origin;
use crate::passes::CAMERA_PAIRS;
use crate::polarisation::{Mueller, Polarisation, Stokes};
use crate::sampler::Sampler;
use crate::world::{LightSource, World};

pub(crate) const ROULETTE_DEPTH: u32 = 3;

/// Largest probability that roulette lets a path go on: an albedo of one still ends.
pub(crate) const ROULETTE_MAX: f32 = 0.99;

/// Pairs of sample dimensions of each scattering event, after those of the camera.
const EVENT_PAIRS: u32 = 4;
const LIGHT_CHOICE: u32 = 0;
const LIGHT_POINT: u32 = 1;
const BSDF_DIRECTION: u32 = 2;
const BSDF_LOBE: u32 = 3;

/// A path under construction.
struct Path<P: Polarisation> {
    ray: Ray,
    /// Throughput at the hero's pdf, from light along the ray's reverse to the camera.
    beta: P::Mueller,
    path_pdf: SampledSpectrum,
    /// Density per steradian of the last direction; `None` after the camera and specular lobes, which light sampling
    /// does not compete with.
    direction_pdf: Option<f64>,
    /// Product of squared relative indices along the path.
    eta2: f64,
}

impl<P: Polarisation> Path<P> {
    /// What reaches the camera of light that arrives at the ray's origin, under the balance heuristic over wavelengths.
    #[inline]
    fn carry(&self, light: &P::Stokes) -> P::Stokes {
        self.beta.apply(light) * (1.0 / self.path_pdf.mean())
    }

    /// Power heuristic for light found by a scattered ray, `light_pdf` being the density of light sampling.
    #[inline]
    fn scattered_weight(&self, light_pdf: f64) -> f32 {
        self.direction_pdf.map_or(1.0, |pdf| power_heuristic(pdf, light_pdf))
    }
}

#[inline]
fn power_heuristic(pdf: f64, other: f64) -> f32 {
    if pdf.is_infinite() {
        return 1.0;
    }
    let ratio = other / pdf;
    (1.0 / (1.0 + ratio * ratio)) as f32
}

/// Radiance that arrives at the origin of `ray` from its direction, at the given wavelengths, after at most
/// `max_depth` scattering events. `horizontal`, a unit vector across the ray, is the x axis of its reference frame.
pub fn incident_radiance<P: Polarisation>(
    world: &World,
    ray: Ray,
    horizontal: DVec3,
    wavelengths: &SampledWavelengths,
    sampler: &Sampler,
    max_depth: u32,
) -> P::Stokes {
    let beta = P::Mueller::identity(horizontal, -ray.dir);
    let mut path = Path::<P> { ray, beta, path_pdf: SampledSpectrum::ONE, direction_pdf: None, eta2: 1.0 };
    let mut radiance = P::Stokes::unpolarised(SampledSpectrum::ZERO);
    for depth in 0..=max_depth {
        let Some(mut hit) = world.geometry.intersect(&path.ray) else {
            radiance += escaped_radiance(world, &path, wavelengths);
            break;
        };
        let wo = -path.ray.dir;
        if let Some(emitter) = &world.material(&hit).emitter {
            let emitted = emitter.radiance::<P>(wo, hit.ng, wavelengths);
            if !emitted.intensity().is_black() {
                let weight = path.scattered_weight(part_pdf(world, &hit, &path));
                radiance += path.carry(&emitted) * weight;
            }
        }
        if depth == max_depth {
            break;
        }
        let pair = CAMERA_PAIRS + EVENT_PAIRS * depth;
        let mut u_lobe = sampler.pair(pair + BSDF_LOBE);
        let mut owned = None;
        let bsdf = world.bsdf(&mut hit, &mut u_lobe[0], wavelengths, &mut owned);
        let event = Event::new(world, &hit, wo, bsdf);
        if !event.bsdf.is_specular()
            && let Some((source, probability, rest)) = world.choose_light(|| sampler.single(pair + LIGHT_CHOICE))
        {
            let u = sampler.pair(pair + LIGHT_POINT);
            let chosen = ChosenLight { source, probability, rest, u };
            if let Some(direct) = event.sampled_light::<P>(world, &chosen, wavelengths, path.path_pdf) {
                radiance += path.carry(&direct);
            }
        }
        let direction = sampler.pair(pair + BSDF_DIRECTION);
        if !event.scatter(&mut path, direction, u_lobe[0], wavelengths) {
            break;
        }
        if depth + 1 >= ROULETTE_DEPTH && !survives_roulette(&mut path, u_lobe[1]) {
            break;
        }
    }
    radiance
}

/// What reaches the camera from all environments, weighted against light sampling.
fn escaped_radiance<P: Polarisation>(world: &World, path: &Path<P>, wavelengths: &SampledWavelengths) -> P::Stokes {
    let mut radiance = P::Stokes::unpolarised(SampledSpectrum::ZERO);
    for (environment, probability) in world.environments() {
        let wi = path.ray.dir;
        let weight = match path.direction_pdf {
            None => 1.0,
            Some(pdf) => power_heuristic(pdf, probability * environment.pdf(wi)),
        };
        radiance += path.carry(&environment.radiance::<P>(wi, wavelengths)) * weight;
    }
    radiance
}

/// Density per steradian with which light sampling at the last event would have chosen this hit.
fn part_pdf<P: Polarisation>(world: &World, hit: &Hit, path: &Path<P>) -> f64 {
    let probability = world.part_probability(hit);
    if probability == 0.0 || path.direction_pdf.is_none() {
        return 0.0;
    }
    let cos = path.ray.dir.dot(hit.ng).abs();
    probability * world.geometry.pdf_area(hit) * hit.t * hit.t / cos
}

fn survives_roulette<P: Polarisation>(path: &mut Path<P>, u: f64) -> bool {
    let throughput = path.beta.intensity() * (1.0 / path.path_pdf.mean());
    let survival = (throughput.max() * path.eta2 as f32).min(ROULETTE_MAX);
    // False for NaN as well.
    let survives = u < f64::from(survival);
    if survives {
        path.beta = path.beta * (1.0 / survival);
    }
    survives
}

/// A light source with its probability, and random numbers for a point of it.
struct ChosenLight {
    source: LightSource,
    probability: f64,
    rest: f64,
    u: [f64; 2],
}

/// A scattering event: a hit with its local frame.
struct Event<'a> {
    hit: &'a Hit,
    bsdf: &'a Bsdf,
    frame: Frame,
    local_wo: DVec3,
}

impl<'a> Event<'a> {
    /// The frame is that of the shading normal, unless `wo` sees the two normals from different sides.
    #[inline]
    fn new(world: &World, hit: &'a Hit, wo: DVec3, bsdf: &'a Bsdf) -> Event<'a> {
        let agree = wo.dot(hit.ng) * wo.dot(hit.ns) > 0.0;
        let normal = if agree { hit.ns } else { hit.ng };
        let frame = if bsdf.needs_tangent() {
            Frame::with_tangent(normal, world.geometry.parametrize(hit).dpdu)
        } else {
            Frame::new(normal)
        };
        Event { hit, bsdf, frame, local_wo: frame.to_local(wo) }
    }

    /// Whether a direction lies on the same side of the true surface as of the shaded one.
    #[inline]
    fn sides_agree(&self, wi: DVec3, local_wi: DVec3) -> bool {
        wi.dot(self.hit.ng) * local_wi.z > 0.0
    }

    /// Light of one sampled source that is scattered towards the viewer; `None` where there is none.
    fn sampled_light<P: Polarisation>(
        &self,
        world: &World,
        chosen: &ChosenLight,
        wavelengths: &SampledWavelengths,
        path_pdf: SampledSpectrum,
    ) -> Option<P::Stokes> {
        let ChosenLight { source, probability, rest, u } = *chosen;
        let (ray, light, pdf) = match source {
            LightSource::Part { part, .. } => {
                let sample = world.geometry.sample_part(part, rest, u)?;
                let to_light = sample.p - self.hit.p;
                let distance2 = to_light.length_squared();
                let wi = to_light / distance2.sqrt();
                let radiance = world.emitter(sample.material.0)?.radiance::<P>(-wi, sample.ng, wavelengths);
                if radiance.intensity().is_black() {
                    return None;
                }
                let pdf = probability * sample.pdf_area * distance2 / wi.dot(sample.ng).abs();
                (self.hit.spawn_to_sample(&sample)?, radiance, Some(pdf))
            }
            LightSource::Light(index) => {
                let (origin, irradiance) = world.light(index).incident(self.hit.p, wavelengths);
                let ray = match origin {
                    Origin::Point(position) => self.hit.spawn_to(position)?,
                    Origin::Direction(wi) => self.hit.spawn(wi),
                };
                (ray, P::Stokes::unpolarised(irradiance), None)
            }
            LightSource::Environment(index) => {
                let sample = world.environment(index).sample::<P>(u, wavelengths)?;
                (self.hit.spawn(sample.wi), sample.radiance, Some(probability * sample.pdf))
            }
        };
        let (wi, local_wi) = (ray.dir, self.frame.to_local(ray.dir));
        if !self.sides_agree(wi, local_wi) {
            return None;
        }
        let value = self.bsdf.eval::<P>(self.local_wo, local_wi, wavelengths) * local_wi.z.abs() as f32;
        if value.intensity().is_black() || light.intensity().is_black() {
            return None;
        }
        let weight = match pdf {
            None => 1.0 / probability,
            Some(pdf) => {
                let scattered = self.bsdf.pdf(self.local_wo, local_wi, wavelengths) * path_pdf;
                f64::from(power_heuristic(pdf, f64::from(scattered.mean() / path_pdf.mean()))) / pdf
            }
        };
        if !(weight > 0.0 && weight.is_finite()) || world.geometry.occluded(&ray) {
            return None;
        }
        Some(value.to_world(&self.frame).apply(&light) * weight as f32)
    }

    /// Extends the path by a sampled direction; false where it ends.
    #[inline]
    fn scatter<P: Polarisation>(
        &self,
        path: &mut Path<P>,
        u: [f64; 2],
        u_lobe: f64,
        wavelengths: &SampledWavelengths,
    ) -> bool {
        let Some(sample) = self.bsdf.sample::<P>(self.local_wo, u, u_lobe, wavelengths) else {
            return false;
        };
        let wi = self.frame.to_world(sample.wi);
        if !self.sides_agree(wi, sample.wi) {
            return false;
        }
        path.beta = path.beta.then(&sample.weight.to_world(&self.frame));
        let before = path.path_pdf.mean();
        path.path_pdf *= sample.path_pdf;
        path.direction_pdf = (!sample.specular).then(|| sample.pdf * f64::from(path.path_pdf.mean() / before));
        path.eta2 *= sample.eta * sample.eta;
        path.ray = self.hit.spawn(wi);
        let intensity = path.beta.intensity();
        !intensity.is_black() && intensity.is_valid()
    }
}
