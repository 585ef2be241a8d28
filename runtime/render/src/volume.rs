//! The path tracer of scenes with participating media, nested dielectrics and fluorescence.
//!
//! As the module `integrator`, with three differences. A path knows what fills the space around it, so that a wall is an
//! interface between what really lies on both sides, or none: walls without a bsdf, walls hidden in a solid of
//! precedence, walls between equal matter. Paths and shadow rays go straight through those. And within a medium the
//! distance to the next event is sampled: by the hero's extinction, in proportion to its transmittance.
//!
//! Distances have different densities at the four wavelengths, and light sampling does not sample any. So one balance
//! heuristic holds over wavelengths and techniques together (Miller, Georgiev and Jarosz 2019, "A null-scattering path
//! integral formulation of light transport"): `path_pdf` is each wavelength's density of the path by scattering alone,
//! `light_pdf` that of the same path with its last direction by light sampling, without that direction's density, both
//! over the hero's density by scattering. Where light fluoresces, all four wavelengths of the path change together (see
//! [`arsc_spectral::ReradiationTable`]); which wavelengths the camera sees does not. Emission within a medium is integrated along each stretch, in closed form.

use arsc_accel::{AreaSample, Hit, Ray};
use arsc_spectral::{SampledSpectrum, SampledWavelengths, WavelengthRange};
use glam::DVec3;

use crate::bsdf::Bsdf;
use crate::frame::Frame;
use crate::integrator::{ROULETTE_DEPTH, ROULETTE_MAX};
use crate::interiors::FillingId;
use crate::light::Origin;
use crate::medium::Medium;
use crate::passes::CAMERA_PAIRS;
use crate::phase::PhaseFunction;
use crate::polarisation::{Mueller, Polarisation, Stokes};
use crate::sampler::Sampler;
use crate::world::{LightSource, World};

/// Pairs of sample dimensions of each scattering event, and within them; the distance to an event comes first.
const EVENT_PAIRS: u32 = 6;
const LIGHT_CHOICE: u32 = 0;
const LIGHT_POINT: u32 = 1;
const DIRECTION: u32 = 2;
const LOBE: u32 = 3;
const DISTANCE: u32 = 4;
/// Whether light fluoresces, and where from.
const SHIFT: u32 = 5;

/// Walls that a stretch between two events passes at most; beyond, it counts as dark.
const MOST_WALLS: u32 = 10_000;

/// A path under construction.
struct Path<P: Polarisation> {
    ray: Ray,
    /// What fills the space at the ray's origin.
    filling: FillingId,
    /// Of the light that arrives at the ray's origin.
    wavelengths: SampledWavelengths,
    /// Throughput at the hero's pdf, from light along the ray's reverse to the camera.
    beta: P::Mueller,
    path_pdf: SampledSpectrum,
    light_pdf: SampledSpectrum,
    /// Where the last event was: light sampling measured from there.
    event: DVec3,
    eta2: f64,
}

impl<P: Polarisation> Path<P> {
    /// What reaches the camera of light that arrives at the ray's origin and that light sampling would have found with
    /// this density.
    #[inline]
    fn carry(&self, light: &P::Stokes, light_pdf: f64) -> P::Stokes {
        let mut mean = self.path_pdf.mean();
        if light_pdf > 0.0 {
            mean += self.light_pdf.mean() * light_pdf as f32;
        }
        // Infinite densities leave nothing.
        self.beta.apply(light) * (1.0 / mean)
    }

    /// Goes through a medium without an event, which happens with the given probability.
    fn pass(&mut self, transmittance: SampledSpectrum, probability: SampledSpectrum) {
        let hero = 1.0 / probability.hero();
        self.beta = self.beta * (transmittance * hero);
        self.path_pdf *= probability * hero;
        self.light_pdf *= hero;
    }

    /// One of several things happens: `weight` at the hero's probability, `path_pdf` each wavelength's over the hero's.
    fn choose(&mut self, weight: SampledSpectrum, path_pdf: SampledSpectrum) {
        self.beta = self.beta * weight;
        self.path_pdf *= path_pdf;
    }

    /// Starts a new stretch.
    /// `before`: the densities up to the event; `pdf`: of the new direction, for the hero. Specular lobes have none.
    fn leave(&mut self, ray: Ray, event: DVec3, before: SampledSpectrum, pdf: Option<f64>) {
        self.light_pdf = pdf.map_or(SampledSpectrum::ZERO, |pdf| before * (1.0 / pdf) as f32);
        (self.ray, self.event) = (ray, event);
    }

    fn is_alive(&self) -> bool {
        let intensity = self.beta.intensity();
        !intensity.is_black() && intensity.is_valid() && self.path_pdf.is_valid() && self.light_pdf.is_valid()
    }
}

/// Where light is scattered.
#[derive(Clone, Copy)]
enum Vertex<'a> {
    Surface(&'a Hit),
    Volume(DVec3),
}

impl Vertex<'_> {
    fn p(&self) -> DVec3 {
        match self {
            Vertex::Surface(hit) => hit.p,
            Vertex::Volume(p) => *p,
        }
    }

    fn spawn(&self, wi: DVec3) -> Ray {
        match self {
            Vertex::Surface(hit) => hit.spawn(wi),
            Vertex::Volume(p) => Ray::new(*p, wi),
        }
    }

    fn segment_to(&self, sample: &AreaSample) -> Option<Ray> {
        match self {
            Vertex::Surface(hit) => hit.spawn_to_sample(sample),
            Vertex::Volume(p) => sample.segment_from(*p),
        }
    }

    fn segment_to_point(&self, target: DVec3) -> Option<Ray> {
        match self {
            Vertex::Surface(hit) => hit.spawn_to(target),
            Vertex::Volume(p) => {
                let length = (target - *p).length();
                let ray = Ray::new(*p, (target - *p) / length);
                (length > 0.0 && ray.dir.is_finite()).then_some(Ray { t_max: length, ..ray })
            }
        }
    }
}

/// Light of one source towards a vertex, before what is in between.
struct LightSample<L> {
    ray: Ray,
    light: L,
    /// Probability of the source times density per steradian; `None` for sources that only light sampling finds.
    pdf: Option<f64>,
    probability: f64,
}

/// As [`crate::incident_radiance`], for any scene. `range`: the wavelengths that there are.
pub fn incident_radiance<P: Polarisation>(
    world: &World,
    ray: Ray,
    horizontal: DVec3,
    wavelengths: &SampledWavelengths,
    range: &WavelengthRange,
    sampler: &Sampler,
    max_depth: u32,
) -> P::Stokes {
    let mut tracer = Tracer { world, range, radiance: P::Stokes::unpolarised(SampledSpectrum::ZERO) };
    let mut path = Path::<P> {
        ray,
        filling: world.interiors().at(&world.geometry, ray.origin),
        wavelengths: *wavelengths,
        beta: P::Mueller::identity(horizontal, -ray.dir),
        path_pdf: SampledSpectrum::ONE,
        light_pdf: SampledSpectrum::ZERO,
        event: ray.origin,
        eta2: 1.0,
    };
    for depth in 0..=max_depth {
        let pair = CAMERA_PAIRS + EVENT_PAIRS * depth;
        let draw = Draw { sampler, pair };
        let goes_on = match tracer.next_event(&mut path, &draw) {
            Event::None => false,
            _ if depth == max_depth => false,
            Event::Surface(hit) => tracer.scatter_at_surface(&mut path, &hit, &draw),
            Event::Volume(p, phase) => tracer.scatter_in_volume(&mut path, p, &phase, &draw),
        };
        if !goes_on || (depth + 1 >= ROULETTE_DEPTH && !survives_roulette(&mut path, sampler.pair(pair + LOBE)[1])) {
            break;
        }
    }
    tracer.radiance
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

/// Random numbers of one event.
struct Draw<'a> {
    sampler: &'a Sampler,
    pair: u32,
}

impl Draw<'_> {
    fn pair(&self, of: u32) -> [f64; 2] {
        self.sampler.pair(self.pair + of)
    }

    /// For the stretch behind the given number of walls: one stretch of sampled distance ends where another begins.
    fn distance(&self, wall: u32) -> f64 {
        match wall {
            0 => self.sampler.single(self.pair + DISTANCE),
            // High numbers are no other event's.
            _ => self.sampler.single(u32::MAX - self.pair.wrapping_mul(MOST_WALLS).wrapping_add(wall)),
        }
    }
}

/// What ends a stretch.
enum Event {
    None,
    Surface(Hit),
    Volume(DVec3, PhaseFunction),
}

struct Tracer<'w, P: Polarisation> {
    world: &'w World,
    /// What is rendered: light that excites lies within.
    range: &'w WavelengthRange,
    radiance: P::Stokes,
}

impl<'w, P: Polarisation> Tracer<'w, P> {
    /// Follows the path to where it is scattered next, through walls that are none, and adds the light met on the way.
    fn next_event(&mut self, path: &mut Path<P>, draw: &Draw) -> Event {
        for wall in 0..MOST_WALLS {
            let hit = self.world.geometry.intersect(&path.ray);
            let t_max = hit.map_or(f64::INFINITY, |hit| hit.t);
            if let Some(medium) = self.world.medium(path.filling)
                && let Some((t, phase)) = self.cross_medium(path, medium, t_max, draw, wall)
            {
                return Event::Volume(path.ray.at(t), phase);
            }
            if !path.is_alive() {
                return Event::None;
            }
            let Some(hit) = hit else {
                self.add_environments(path);
                return Event::None;
            };
            let beyond = self.passes(&hit, path.ray.dir, path.filling);
            if beyond != Some(path.filling) {
                self.add_emitter(path, &hit);
            }
            let Some(beyond) = beyond else { return Event::Surface(hit) };
            path.filling = beyond;
            path.ray = hit.spawn(path.ray.dir);
        }
        Event::None
    }

    /// Through a medium to `t_max`, or to an event before it: its distance, and how it scatters.
    fn cross_medium(
        &mut self,
        path: &mut Path<P>,
        medium: &Medium,
        t_max: f64,
        draw: &Draw,
        wall: u32,
    ) -> Option<(f64, PhaseFunction)> {
        let coefficients = medium.coefficients(&path.wavelengths, self.range);
        let total = medium.density.depth(&path.ray, t_max);
        let transmittance = coefficients.transmittance(total);
        if !coefficients.glow.is_black() {
            let glow = coefficients.glow * (SampledSpectrum::ONE - transmittance);
            self.radiance += path.carry(&P::Stokes::unpolarised(glow), 0.0);
        }
        if coefficients.has_no_events() {
            path.pass(transmittance, SampledSpectrum::ONE);
            return None;
        }
        let rate = coefficients.event_rate();
        let hero = f64::from(rate.hero());
        // Never for a hero that the medium does not see.
        let depth = -(-draw.distance(wall)).ln_1p() / hero;
        let reached = if depth < total { medium.density.distance(&path.ray, depth, t_max) } else { None };
        let Some(t) = reached else {
            path.pass(transmittance, coefficients.no_event(total));
            return None;
        };
        let (transmittance, passing) = (coefficients.transmittance(depth), coefficients.no_event(depth));
        let [choice, shift] = if medium.fluoresces() { draw.pair(SHIFT) } else { [1.0, 0.0] };
        let shift_rate = coefficients.shift_rate;
        if choice * hero < f64::from(shift_rate.hero()) {
            let density = 1.0 / (shift_rate.hero() * passing.hero());
            path.choose(coefficients.strength * transmittance * density, shift_rate * passing * density);
            path.wavelengths = medium.shift(&path.wavelengths, self.range, shift);
            return Some((t, PhaseFunction::Isotropic));
        }
        let density = 1.0 / (coefficients.sigma_t.hero() * passing.hero());
        path.choose(coefficients.sigma_s * transmittance * density, coefficients.sigma_t * passing * density);
        Some((t, medium.phase))
    }

    /// What is beyond a wall that light goes straight through; `None` for a wall that does something.
    fn passes(&self, hit: &Hit, dir: DVec3, here: FillingId) -> Option<FillingId> {
        let material = self.world.material(hit);
        let bsdf = &material.bsdf;
        if !bsdf.is_transmissive() || (!hit.closed && bsdf.has_interface()) {
            return None;
        }
        let beyond = self.beyond(hit, dir);
        if material.varying.is_some() {
            // Some part may do something; but a wall with the same on both sides is not there.
            return (hit.closed && beyond == here).then_some(beyond);
        }
        let alike = bsdf.index().is_some() && self.world.interiors().alike(here, beyond);
        (!bsdf.has_interface() || beyond == here || alike).then_some(beyond)
    }

    /// What fills the space on the side of a wall that `dir` goes to.
    fn beyond(&self, hit: &Hit, dir: DVec3) -> FillingId {
        self.world.interiors().at(&self.world.geometry, hit.spawn(dir).origin)
    }

    fn add_environments(&mut self, path: &Path<P>) {
        let wi = path.ray.dir;
        for (environment, probability) in self.world.environments() {
            let light = environment.radiance::<P>(wi, &path.wavelengths);
            self.radiance += path.carry(&light, probability * environment.pdf(wi));
        }
    }

    fn add_emitter(&mut self, path: &Path<P>, hit: &Hit) {
        let Some(emitter) = &self.world.material(hit).emitter else { return };
        let light = emitter.radiance::<P>(-path.ray.dir, hit.ng, &path.wavelengths);
        if light.intensity().is_black() {
            return;
        }
        let probability = self.world.part_probability(hit);
        let mut pdf = 0.0;
        if probability > 0.0 && !path.light_pdf.is_black() {
            let distance2 = (hit.p - path.event).length_squared();
            let cos = path.ray.dir.dot(hit.ng).abs();
            pdf = probability * self.world.geometry.pdf_area(hit) * distance2 / cos;
        }
        self.radiance += path.carry(&light, pdf);
    }

    fn scatter_in_volume(&mut self, path: &mut Path<P>, p: DVec3, phase: &PhaseFunction, draw: &Draw) -> bool {
        let wo = -path.ray.dir;
        if let Some(sample) = self.sample_light(&Vertex::Volume(p), &path.wavelengths, draw) {
            let wi = sample.ray.dir;
            let pdf = SampledSpectrum::splat(phase.pdf(wo, wi) as f32);
            let value = phase.weight::<P>(wo, wi) * pdf;
            self.add_direct(path, &sample, value, pdf, path.filling);
        }
        let wi = phase.sample(wo, draw.pair(DIRECTION));
        path.beta = path.beta.then(&phase.weight::<P>(wo, wi));
        path.leave(Ray::new(p, wi), p, path.path_pdf, Some(phase.pdf(wo, wi)));
        path.is_alive()
    }

    fn scatter_at_surface(&mut self, path: &mut Path<P>, hit: &Hit, draw: &Draw) -> bool {
        let wo = -path.ray.dir;
        let (mut u_lobe, mut owned, mut hit) = (draw.pair(LOBE)[0], None, *hit);
        let mut bsdf = self.world.bsdf(&mut hit, &mut u_lobe, &path.wavelengths, &mut owned);
        let hit = &hit;
        if let Some(fluorescent) = bsdf.fluorescent() {
            let [choice, shift] = draw.pair(SHIFT);
            let event = fluorescent.choose(&path.wavelengths, self.range, choice, shift);
            path.choose(event.weight, event.path_pdf);
            path.wavelengths = event.shifted.unwrap_or(path.wavelengths);
            bsdf = event.bsdf;
        }
        let agree = wo.dot(hit.ng) * wo.dot(hit.ns) > 0.0;
        let normal = if agree { hit.ns } else { hit.ng };
        let frame = if bsdf.needs_tangent() {
            Frame::with_tangent(normal, self.world.geometry.parametrize(hit).dpdu)
        } else {
            Frame::new(normal)
        };
        let relative = self.relative_index(path, hit, bsdf);
        let local_wo = frame.to_local(wo);
        let sides_agree = |wi: DVec3, local_wi: DVec3| wi.dot(hit.ng) * local_wi.z > 0.0;
        if !bsdf.is_specular()
            && let Some(sample) = self.sample_light(&Vertex::Surface(hit), &path.wavelengths, draw)
        {
            let (wi, local_wi) = (sample.ray.dir, frame.to_local(sample.ray.dir));
            if sides_agree(wi, local_wi) {
                let value =
                    bsdf.eval_between::<P>(relative, local_wo, local_wi, &path.wavelengths) * local_wi.z.abs() as f32;
                let pdf = bsdf.pdf_between(relative, local_wo, local_wi, &path.wavelengths);
                let reflected = wi.dot(hit.ng) * wo.dot(hit.ng) > 0.0;
                let filling = if reflected { path.filling } else { self.beyond(hit, wi) };
                self.add_direct(path, &sample, value.to_world(&frame), pdf, filling);
            }
        }
        let u = draw.pair(DIRECTION);
        let sample = bsdf.sample_between::<P>(relative, local_wo, u, u_lobe, &path.wavelengths);
        let Some(sample) = sample else { return false };
        let wi = frame.to_world(sample.wi);
        if !sides_agree(wi, sample.wi) {
            return false;
        }
        path.beta = path.beta.then(&sample.weight.to_world(&frame));
        let before = path.path_pdf;
        path.path_pdf *= sample.path_pdf;
        path.eta2 *= sample.eta * sample.eta;
        if wi.dot(hit.ng) * wo.dot(hit.ng) < 0.0 {
            path.filling = self.beyond(hit, wi);
        }
        path.leave(hit.spawn(wi), hit.p, before, (!sample.specular).then_some(sample.pdf));
        path.is_alive()
    }

    /// Of what lies behind a closed interface over what lies before it.
    fn relative_index(&self, path: &Path<P>, hit: &Hit, bsdf: &Bsdf) -> Option<SampledSpectrum> {
        if bsdf.index().is_none() || !hit.closed {
            return None;
        }
        let dir = path.ray.dir;
        let beyond = self.beyond(hit, dir);
        let sides = if dir.dot(hit.ng) < 0.0 { [path.filling, beyond] } else { [beyond, path.filling] };
        self.world.interiors().relative_index(&self.world.geometry, hit, sides, &path.wavelengths)
    }

    /// Adds the light of a source: `value` is what the vertex makes of it (with the cosine), `pdf` the densities of its
    /// direction by scattering, `filling` what is around the start of the shadow ray.
    fn add_direct(
        &mut self,
        path: &Path<P>,
        sample: &LightSample<P::Stokes>,
        value: P::Mueller,
        pdf: SampledSpectrum,
        filling: FillingId,
    ) {
        if value.intensity().is_black() || sample.light.intensity().is_black() {
            return;
        }
        let Some((transmittance, passing)) = self.transmittance(&sample.ray, &path.wavelengths, filling) else {
            return;
        };
        let (weight, competing) = match sample.pdf {
            None => (1.0 / sample.probability, SampledSpectrum::ZERO),
            Some(light_pdf) => (1.0 / light_pdf, pdf * (1.0 / light_pdf) as f32),
        };
        if !(weight > 0.0 && weight.is_finite() && competing.is_valid()) {
            return;
        }
        // Densities by light sampling plus those by scattering, over the hero's by light sampling.
        let both = path.path_pdf * (SampledSpectrum::ONE + passing * competing);
        let factor = transmittance * (weight as f32 / both.mean());
        if factor.is_valid() {
            self.radiance += path.beta.then(&(value * factor)).apply(&sample.light);
        }
    }

    /// Share of light that gets along a segment, and each wavelength's probability that a path gets along it without an
    /// event. `None` if something is in the way.
    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &SampledWavelengths,
        mut filling: FillingId,
    ) -> Option<(SampledSpectrum, SampledSpectrum)> {
        let mut ray = *ray;
        let (mut transmittance, mut passing) = (SampledSpectrum::ONE, SampledSpectrum::ONE);
        for _ in 0..MOST_WALLS {
            let hit = self.world.geometry.intersect(&ray);
            if let Some(medium) = self.world.medium(filling) {
                let coefficients = medium.coefficients(wavelengths, self.range);
                let t = hit.map_or(ray.t_max, |hit| hit.t);
                let depth = medium.density.depth(&ray, t);
                transmittance *= coefficients.transmittance(depth);
                if !coefficients.has_no_events() {
                    passing *= coefficients.no_event(depth);
                }
                if transmittance.is_black() {
                    return None;
                }
            }
            let Some(hit) = hit else { return Some((transmittance, passing)) };
            filling = self.passes(&hit, ray.dir, filling)?;
            let next = hit.spawn(ray.dir);
            let t_max = ray.t_max - (next.origin - ray.origin).dot(ray.dir);
            ray = Ray { t_max, ..next };
        }
        None
    }

    fn sample_light(
        &self,
        vertex: &Vertex,
        wavelengths: &SampledWavelengths,
        draw: &Draw,
    ) -> Option<LightSample<P::Stokes>> {
        let (source, probability, rest) = self.world.choose_light(|| draw.pair(LIGHT_CHOICE)[0])?;
        let u = draw.pair(LIGHT_POINT);
        let (ray, light, pdf) = match source {
            LightSource::Part { part, .. } => {
                let sample = self.world.geometry.sample_part(part, rest, u)?;
                let to_light = sample.p - vertex.p();
                let distance2 = to_light.length_squared();
                let wi = to_light / distance2.sqrt();
                let radiance = self.world.emitter(sample.material.0)?.radiance::<P>(-wi, sample.ng, wavelengths);
                let pdf = probability * sample.pdf_area * distance2 / wi.dot(sample.ng).abs();
                (vertex.segment_to(&sample)?, radiance, Some(pdf))
            }
            LightSource::Light(index) => {
                let (origin, irradiance) = self.world.light(index).incident(vertex.p(), wavelengths);
                let ray = match origin {
                    Origin::Point(position) => vertex.segment_to_point(position)?,
                    Origin::Direction(wi) => vertex.spawn(wi),
                };
                (ray, P::Stokes::unpolarised(irradiance), None)
            }
            LightSource::Environment(index) => {
                let sample = self.world.environment(index).sample::<P>(u, wavelengths)?;
                (vertex.spawn(sample.wi), sample.radiance, Some(probability * sample.pdf))
            }
        };
        Some(LightSample { ray, light, pdf, probability })
    }
}
