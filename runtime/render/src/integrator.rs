//! A unidirectional path tracer.
//!
//! Each scattering event samples one light and one direction of the bsdf; both find the same light and are weighted
//! by the power heuristic with exponent 2 (Veach 1997, section 9.2). Across the four wavelengths of a path the
//! balance heuristic holds (Wilkie et al. 2014, equation 6): `beta` is f / pdf for the hero's pdf, `path_pdf` the
//! ratio of each wavelength's pdf of the same path to the hero's, and what arrives is divided by the mean of that
//! ratio. All densities except the choice at a dielectric are the same at the four wavelengths, therefore the two
//! heuristics multiply. Russian roulette ends dim paths from the [`ROULETTE_DEPTH`]th event on, on the brightest
//! wavelength, with the change of radiance by refraction taken out.

use arsc_accel::{Hit, Ray};
use arsc_spectral::{SampledSpectrum, SampledWavelengths};
use glam::DVec3;

use crate::bsdf::Bsdf;
use crate::frame::Frame;
use crate::light::Light;
use crate::sampler::Sampler;
use crate::world::{LightSource, World};

const ROULETTE_DEPTH: u32 = 3;

/// Largest probability that roulette lets a path go on: an albedo of one still ends.
const ROULETTE_MAX: f32 = 0.99;

/// Pairs of sample dimensions of the camera, then of each scattering event.
pub(crate) const CAMERA_PAIRS: u32 = 2;
const EVENT_PAIRS: u32 = 4;
const LIGHT_CHOICE: u32 = 0;
const LIGHT_POINT: u32 = 1;
const BSDF_DIRECTION: u32 = 2;
const BSDF_LOBE: u32 = 3;

/// A path under construction.
struct Path {
    ray: Ray,
    /// Throughput at the hero's pdf.
    beta: SampledSpectrum,
    path_pdf: SampledSpectrum,
    /// Density per steradian of the last direction; `None` after the camera and specular lobes, which light sampling
    /// does not compete with.
    direction_pdf: Option<f64>,
    /// Product of squared relative indices along the path.
    eta2: f64,
}

impl Path {
    /// Throughput under the balance heuristic over wavelengths.
    #[inline]
    fn throughput(&self) -> SampledSpectrum {
        self.beta * (1.0 / self.path_pdf.mean())
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
/// `max_depth` scattering events.
pub fn incident_radiance(
    world: &World,
    ray: Ray,
    wavelengths: &SampledWavelengths,
    sampler: &Sampler,
    max_depth: u32,
) -> SampledSpectrum {
    let one = SampledSpectrum::ONE;
    let mut path = Path { ray, beta: one, path_pdf: one, direction_pdf: None, eta2: 1.0 };
    let mut radiance = SampledSpectrum::ZERO;
    for depth in 0..=max_depth {
        let Some(hit) = world.geometry.intersect(&path.ray) else {
            radiance += path.throughput() * escaped_radiance(world, &path, wavelengths);
            break;
        };
        let wo = -path.ray.dir;
        if let Some(emitter) = &world.material(&hit).emitter {
            let emitted = emitter.radiance(wo.dot(hit.ng), wavelengths);
            if !emitted.is_black() {
                let weight = path.scattered_weight(part_pdf(world, &hit, &path));
                radiance += path.throughput() * emitted * weight;
            }
        }
        if depth == max_depth {
            break;
        }
        let pair = CAMERA_PAIRS + EVENT_PAIRS * depth;
        let event = Event::new(&hit, wo, &world.material(&hit).bsdf);
        if !event.bsdf.is_specular() {
            let choice = sampler.single(pair + LIGHT_CHOICE);
            let direct = event.direct_light(world, choice, sampler.pair(pair + LIGHT_POINT), wavelengths);
            radiance += path.throughput() * direct;
        }
        let u_lobe = sampler.pair(pair + BSDF_LOBE);
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

/// From all environments, weighted against light sampling.
fn escaped_radiance(world: &World, path: &Path, wavelengths: &SampledWavelengths) -> SampledSpectrum {
    let mut radiance = SampledSpectrum::ZERO;
    for (environment, probability) in world.environments() {
        let wi = path.ray.dir;
        let weight = match path.direction_pdf {
            None => 1.0,
            Some(pdf) => power_heuristic(pdf, probability * environment.pdf(wi)),
        };
        radiance += environment.radiance(wi, wavelengths) * weight;
    }
    radiance
}

/// Density per steradian with which light sampling at the last event would have chosen this hit.
fn part_pdf(world: &World, hit: &Hit, path: &Path) -> f64 {
    let probability = world.part_probability(hit);
    if probability == 0.0 || path.direction_pdf.is_none() {
        return 0.0;
    }
    let cos = path.ray.dir.dot(hit.ng).abs();
    probability * world.geometry.pdf_area(hit) * hit.t * hit.t / cos
}

fn survives_roulette(path: &mut Path, u: f64) -> bool {
    let survival = (path.throughput().max() * path.eta2 as f32).min(ROULETTE_MAX);
    // False for NaN as well.
    let survives = u < f64::from(survival);
    if survives {
        path.beta *= 1.0 / survival;
    }
    survives
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
    fn new(hit: &'a Hit, wo: DVec3, bsdf: &'a Bsdf) -> Event<'a> {
        let agree = wo.dot(hit.ng) * wo.dot(hit.ns) > 0.0;
        let frame = Frame::new(if agree { hit.ns } else { hit.ng });
        Event { hit, bsdf, frame, local_wo: frame.to_local(wo) }
    }

    /// Whether a direction lies on the same side of the true surface as of the shaded one.
    #[inline]
    fn sides_agree(&self, wi: DVec3, local_wi: DVec3) -> bool {
        wi.dot(self.hit.ng) * local_wi.z > 0.0
    }

    /// Light of one sampled source that is scattered towards the viewer.
    fn direct_light(
        &self,
        world: &World,
        choice: f64,
        u: [f64; 2],
        wavelengths: &SampledWavelengths,
    ) -> SampledSpectrum {
        self.sampled_light(world, choice, u, wavelengths).unwrap_or(SampledSpectrum::ZERO)
    }

    fn sampled_light(
        &self,
        world: &World,
        choice: f64,
        u: [f64; 2],
        wavelengths: &SampledWavelengths,
    ) -> Option<SampledSpectrum> {
        let (source, probability, rest) = world.choose_light(choice)?;
        let (ray, light, pdf) = match source {
            LightSource::Part { part, material } => {
                let sample = world.geometry.sample_part(part, rest, u)?;
                let to_light = sample.p - self.hit.p;
                let distance2 = to_light.length_squared();
                let wi = to_light / distance2.sqrt();
                let cos = -wi.dot(sample.ng);
                let radiance = world.emitter(material)?.radiance(cos, wavelengths);
                if radiance.is_black() {
                    return None;
                }
                let pdf = probability * sample.pdf_area * distance2 / cos.abs();
                (self.hit.spawn_to_sample(&sample)?, radiance, Some(pdf))
            }
            LightSource::Light(index) => match world.light(index) {
                Light::Point(point) => {
                    let distance2 = (point.position - self.hit.p).length_squared();
                    (self.hit.spawn_to(point.position)?, point.irradiance(distance2, wavelengths), None)
                }
                Light::Distant(distant) => (self.hit.spawn(distant.wi), distant.irradiance(wavelengths), None),
            },
            LightSource::Environment(index) => {
                let sample = world.environment(index).sample(u, wavelengths)?;
                (self.hit.spawn(sample.wi), sample.radiance, Some(probability * sample.pdf))
            }
        };
        let (wi, local_wi) = (ray.dir, self.frame.to_local(ray.dir));
        if !self.sides_agree(wi, local_wi) {
            return None;
        }
        let value = self.bsdf.eval(self.local_wo, local_wi, wavelengths) * local_wi.z.abs() as f32;
        if value.is_black() || light.is_black() {
            return None;
        }
        let weight = match pdf {
            None => 1.0 / probability,
            Some(pdf) => f64::from(power_heuristic(pdf, self.bsdf.pdf(self.local_wo, local_wi))) / pdf,
        };
        if !(weight > 0.0 && weight.is_finite()) || world.geometry.occluded(&ray) {
            return None;
        }
        Some(value * light * weight as f32)
    }

    /// Extends the path by a sampled direction; false where it ends.
    #[inline]
    fn scatter(&self, path: &mut Path, u: [f64; 2], u_lobe: f64, wavelengths: &SampledWavelengths) -> bool {
        let Some(sample) = self.bsdf.sample(self.local_wo, u, u_lobe, wavelengths) else {
            return false;
        };
        let wi = self.frame.to_world(sample.wi);
        if !self.sides_agree(wi, sample.wi) {
            return false;
        }
        path.beta *= sample.weight;
        path.path_pdf *= sample.path_pdf;
        path.direction_pdf = (!sample.specular).then_some(sample.pdf);
        path.eta2 *= sample.eta * sample.eta;
        path.ray = self.hit.spawn(wi);
        !path.beta.is_black() && path.beta.is_valid()
    }
}
