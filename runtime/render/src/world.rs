//! Everything that light meets, ready for rendering.
//!
//! [`World::new`] finds the light sources: emissive parts of the geometry, point and distant lights, environments. One is
//! chosen per light sample, with a probability that follows its power over the rendered range; [`FLOOR`] of the
//! choices are uniform, so that a dim light close by is not starved. Emissive parts of unbounded area are hit by
//! scattered rays only.

use arsc_accel::{Hit, Part, PartId, Scene};
use arsc_spectral::{DenseSpectrum, SampledWavelengths, WavelengthRange};

use crate::bsdf::Bsdf;
use crate::emitter::AreaEmitter;
use crate::interiors::{FillingId, Interiors};
use crate::light::{AliasTable, Environment, Light};
use crate::medium::Medium;
use crate::varying::VaryingBsdf;

/// Scattering and emission of one material; indexed by [`arsc_accel::MaterialIndex`].
#[derive(Clone, Debug, Default)]
pub struct Material {
    pub bsdf: Bsdf,
    pub emitter: Option<AreaEmitter>,
    /// What fills the solid behind the wall: an entry of [`Media::media`].
    pub medium: Option<u32>,
    /// Index of refraction behind the wall, where it is not the bsdf's own.
    pub inside: Option<DenseSpectrum>,
    /// In place of `bsdf`, which is then the part that answers for all where there is no hit.
    pub varying: Option<Box<VaryingBsdf>>,
}

impl Material {
    /// All that a hit may find.
    fn bsdfs(&self) -> impl Iterator<Item = &Bsdf> {
        let parts = self.varying.iter().flat_map(|varying| varying.bsdfs());
        std::iter::once(&self.bsdf).chain(parts)
    }
}

/// Participating media of a scene.
#[derive(Clone, Debug, Default)]
pub struct Media {
    pub media: Vec<Medium>,
    /// Fills all space that no solid fills.
    pub atmosphere: Option<u32>,
}

/// Share of the light samples that is spread evenly over the lights.
const FLOOR: f64 = 0.05;

/// Radius that stands for that of a scene of unbounded geometry alone when powers are compared.
const UNBOUNDED_RADIUS: f64 = 100.0;

/// A light as light sampling sees it; indices into the world's tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    Part { part: PartId, material: u32 },
    Light(u32),
    Environment(u32),
}

/// Geometry, materials and lights.
pub struct World {
    pub geometry: Scene,
    materials: Vec<Material>,
    lights: Vec<Light>,
    environments: Vec<Environment>,
    sources: Vec<LightSource>,
    powers: Vec<f64>,
    choice: AliasTable,
    /// Probability that light sampling chooses a part; by [`PartId`].
    part_probability: Vec<f64>,
    environment_probability: Vec<f64>,
    media: Vec<Medium>,
    interiors: Interiors,
    /// Some surface changes the wavelength of light.
    fluoresces: bool,
}

impl World {
    /// `materials` is indexed by [`arsc_accel::MaterialIndex`]; a part whose material is missing gets the default.
    pub fn new(geometry: Scene, materials: Vec<Material>, lights: Vec<Light>, environments: Vec<Environment>) -> World {
        World::with_media(geometry, materials, lights, environments, Media::default())
    }

    /// The same, with participating media.
    pub fn with_media(
        geometry: Scene,
        mut materials: Vec<Material>,
        lights: Vec<Light>,
        environments: Vec<Environment>,
        media: Media,
    ) -> World {
        let faces = |i: usize| geometry.face_materials(PartId(i as u32)).iter().map(|(_, material)| *material);
        let shown = |(i, part): (usize, &Part)| faces(i).chain([part.material]).map(|m| m.0 as usize + 1).max();
        let needed = geometry.parts().iter().enumerate().filter_map(shown).max().unwrap_or(0);
        materials.resize_with(materials.len().max(needed), Material::default);
        let interiors = Interiors::new(&geometry, &materials, media.atmosphere);
        let fluoresces = materials.iter().flat_map(Material::bsdfs).any(|bsdf| bsdf.fluorescent().is_some());
        let mut world = World {
            media: media.media,
            interiors,
            fluoresces,
            part_probability: vec![0.0; geometry.parts().len()],
            environment_probability: vec![0.0; environments.len()],
            geometry,
            materials,
            lights,
            environments,
            sources: Vec::new(),
            powers: Vec::new(),
            choice: AliasTable::default(),
        };
        world.limit_events();
        world.weigh_lights(&WavelengthRange::VISIBLE);
        world
    }

    /// Tells media how large is what they fill; endless space counts as large as what stands in it.
    fn limit_events(&mut self) {
        let scene = 2.0 * self.scene_radius();
        for (medium, extent) in self.interiors.extents() {
            if let Some(medium) = self.media.get_mut(medium as usize) {
                medium.fills(if extent.is_finite() { extent } else { scene });
            }
        }
    }

    /// Chooses lights by their power over the wavelengths that a render samples; before, it is that over the visible
    /// ones. A matter of variance alone.
    pub fn weigh_lights(&mut self, range: &WavelengthRange) {
        self.collect_sources(range);
        self.choose_probabilities();
    }

    fn collect_sources(&mut self, range: &WavelengthRange) {
        let mut found = Vec::new();
        for i in 0..self.geometry.parts().len() {
            let part = PartId(i as u32);
            if let Some(power) = self.part_power(part, range) {
                let material = self.geometry.parts()[i].material.0;
                found.push((LightSource::Part { part, material }, power));
            }
        }
        let radius = self.scene_radius();
        let lights = (0..).zip(&self.lights).map(|(i, light)| (LightSource::Light(i), light.power(radius, range)));
        found.extend(lights);
        let environments = (0..).zip(&self.environments);
        found.extend(
            environments.map(|(i, environment)| (LightSource::Environment(i), environment.power(radius, range))),
        );
        // What is dark or unbounded cannot be sampled by power.
        found.retain(|(_, power)| *power > 0.0 && power.is_finite());
        (self.sources, self.powers) = found.into_iter().unzip();
    }

    /// Power that a part emits; `None` if it is no lamp. Where only some of its faces emit, only they are sampled.
    fn part_power(&mut self, part: PartId, range: &WavelengthRange) -> Option<f64> {
        let emitter = |material: u32| self.materials[material as usize].emitter.as_ref();
        let exitance = |material: u32| emitter(material).map(|emitter| emitter.exitance(range));
        let base = exitance(self.geometry.parts()[part.0 as usize].material.0);
        let others: Vec<(u32, Option<f64>)> =
            self.geometry.face_materials(part).iter().map(|&(face, material)| (face, exitance(material.0))).collect();
        if others.is_empty() {
            return base.map(|exitance| exitance * self.geometry.part_area(part));
        }
        let on_face = |face: u32| others.iter().find(|other| other.0 == face).map_or(base, |other| other.1);
        let lit: Vec<(u32, f64)> =
            (0..self.geometry.face_count(part)).filter_map(|face| Some((face, on_face(face)?))).collect();
        if lit.is_empty() {
            return None;
        }
        let mean = lit.iter().map(|(_, exitance)| exitance).sum::<f64>() / lit.len() as f64;
        let share = self.geometry.sample_only(part, lit.into_iter().map(|(face, _)| face).collect());
        Some(mean * share * self.geometry.part_area(part))
    }

    fn choose_probabilities(&mut self) {
        self.part_probability.fill(0.0);
        self.environment_probability.fill(0.0);
        let total: f64 = self.powers.iter().sum();
        let n = self.sources.len() as f64;
        let weights: Vec<f64> = self.powers.iter().map(|p| (1.0 - FLOOR) * p + FLOOR * total / n).collect();
        self.choice = AliasTable::new(&weights);
        for (i, source) in self.sources.iter().enumerate() {
            let probability = self.choice.probability(i);
            match source {
                LightSource::Part { part, .. } => self.part_probability[part.0 as usize] = probability,
                LightSource::Environment(e) => self.environment_probability[*e as usize] = probability,
                LightSource::Light(_) => {}
            }
        }
    }

    /// Radius of a sphere about the bounded geometry: what an endless floor receives far away from it is not looked at,
    /// and would starve the lights nearby.
    fn scene_radius(&self) -> f64 {
        let bounds = self.geometry.bounded_parts();
        let radius = 0.5 * bounds.extent().length();
        match (bounds.is_empty(), self.geometry.bounds().is_empty()) {
            (true, true) => 0.0,
            (false, _) if radius.is_finite() => radius,
            _ => UNBOUNDED_RADIUS,
        }
    }

    /// The lights that light sampling chooses from, with their powers in W over the rendered range.
    pub fn light_sources(&self) -> impl Iterator<Item = (LightSource, f64)> + '_ {
        self.sources.iter().copied().zip(self.powers.iter().copied())
    }

    /// Media and nested dielectrics, so that paths have to know what fills the space around them; fluorescence.
    pub(crate) fn needs_volumes(&self) -> bool {
        self.interiors.matters() || self.fluoresces
    }

    pub(crate) fn interiors(&self) -> &Interiors {
        &self.interiors
    }

    #[inline]
    pub(crate) fn medium(&self, filling: FillingId) -> Option<&Medium> {
        self.interiors.medium(filling).map(|medium| &self.media[medium as usize])
    }

    #[inline]
    pub fn material(&self, hit: &Hit) -> &Material {
        &self.materials[hit.material.0 as usize]
    }

    /// The bsdf at a hit, in `owned` where it is made there. `u` chooses among the parts of a mixture, and what is left of it
    /// is uniform again; all that happens at the hit must see the same choice, and the shading normal that the hit gets.
    #[inline]
    pub(crate) fn bsdf<'a>(
        &'a self,
        hit: &mut Hit,
        u: &mut f64,
        wavelengths: &SampledWavelengths,
        owned: &'a mut Option<Bsdf>,
    ) -> &'a Bsdf {
        let material = self.material(hit);
        match &material.varying {
            None => &material.bsdf,
            Some(varying) => varying.at(&self.geometry, hit, u, wavelengths, owned),
        }
    }

    #[inline]
    pub(crate) fn emitter(&self, material: u32) -> Option<&AreaEmitter> {
        self.materials[material as usize].emitter.as_ref()
    }

    #[inline]
    pub(crate) fn light(&self, index: u32) -> &Light {
        &self.lights[index as usize]
    }

    #[inline]
    pub(crate) fn environment(&self, index: u32) -> &Environment {
        &self.environments[index as usize]
    }

    #[inline]
    pub(crate) fn environments(&self) -> impl Iterator<Item = (&Environment, f64)> {
        self.environments.iter().zip(self.environment_probability.iter().copied())
    }

    /// A light, its probability, and what is left of `u`, which is asked for if need be. `None` without lights.
    #[inline]
    pub(crate) fn choose_light(&self, u: impl FnOnce() -> f64) -> Option<(LightSource, f64, f64)> {
        match self.sources[..] {
            [] => None,
            [source @ (LightSource::Environment(_) | LightSource::Light(_))] => Some((source, 1.0, 0.0)),
            _ => {
                let (index, rest) = self.choice.sample(u());
                Some((self.sources[index], self.choice.probability(index), rest))
            }
        }
    }

    /// Probability that light sampling chooses the part that was hit.
    #[inline]
    pub(crate) fn part_probability(&self, hit: &Hit) -> f64 {
        self.part_probability[hit.part.0 as usize]
    }
}
