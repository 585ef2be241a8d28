//! What fills which point: media and indices of refraction, by precedence of solids.
//!
//! A *filling* is what one transmissive solid holds: a medium, if any, and an index of refraction. Filling 0 is that of
//! all space that no transmissive solid fills. Where solids overlap the first one fills the common part and hides the
//! walls of the others in there (Schmidt and Budge 2002, "Simple nested dielectrics in ray traced images"). Unlike
//! there, no list is kept along paths: beyond each wall that light passes, the filling is found anew from membership of
//! the point, so that coincident walls and starts anywhere need no care.

use std::collections::HashMap;

use arsc_accel::{Aabb, Hit, PartKind, Scene};
use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths};
use glam::DVec3;

use crate::world::Material;

/// Index into the fillings of a world; 0 is outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FillingId(pub u32);

#[derive(Clone, Debug)]
struct Filling {
    solid: u32,
    bounds: Aabb,
    medium: Option<u32>,
    /// `None`: that of vacuum.
    index: Option<DenseSpectrum>,
    /// Equal for equal contents.
    class: u32,
}

/// The fillings of a scene.
#[derive(Clone, Debug, Default)]
pub struct Interiors {
    /// The first one is outside.
    fillings: Vec<Filling>,
    by_solid: HashMap<u32, FillingId>,
    /// Paths must know what fills the space around them.
    matters: bool,
}

impl Interiors {
    /// From the materials of the walls of each solid, which agree on what is behind them.
    pub fn new(geometry: &Scene, materials: &[Material], atmosphere: Option<u32>) -> Interiors {
        let outside = Filling { solid: u32::MAX, bounds: Aabb::EVERYTHING, medium: atmosphere, index: None, class: 0 };
        let mut interiors =
            Interiors { fillings: vec![outside], matters: atmosphere.is_some(), ..Interiors::default() };
        for part in geometry.parts() {
            let PartKind::Leaf { solid, .. } = part.kind else { continue };
            let material = &materials[part.material.0 as usize];
            if material.bsdf.is_transmissive() && !interiors.by_solid.contains_key(&solid) {
                interiors.add(geometry, solid, material);
            }
            interiors.matters |= material.inside.is_some();
        }
        interiors.matters |= interiors.boxes_overlap();
        interiors
    }

    fn add(&mut self, geometry: &Scene, solid: u32, material: &Material) {
        let index = material.inside.as_ref().or(material.bsdf.index()).cloned();
        let (medium, bounds) = (material.medium, geometry.solid_bounds(solid));
        self.matters |= medium.is_some() || !material.bsdf.has_interface();
        let equal = self.fillings.iter().rev().take(64).find(|old| old.medium == medium && old.index == index);
        let class = equal.map_or(self.fillings.len() as u32, |old| old.class);
        self.by_solid.insert(solid, FillingId(self.fillings.len() as u32));
        self.fillings.push(Filling { solid, bounds, medium, index, class });
    }

    /// Whether the boxes of two transmissive solids touch: a sweep along x.
    fn boxes_overlap(&self) -> bool {
        let mut boxes: Vec<Aabb> = self.fillings[1..].iter().map(|filling| filling.bounds).collect();
        boxes.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
        let mut budget = 1_000_000;
        for (i, a) in boxes.iter().enumerate() {
            for b in boxes[i + 1..].iter().take_while(|b| b.min.x <= a.max.x) {
                budget -= 1;
                if budget == 0 || (b.min.cmple(a.max).all() && a.min.cmple(b.max).all()) {
                    return true;
                }
            }
        }
        false
    }

    pub fn matters(&self) -> bool {
        self.matters
    }

    /// What fills a point.
    pub fn at(&self, geometry: &Scene, p: DVec3) -> FillingId {
        let holds = |filling: &Filling| {
            let Aabb { min, max } = filling.bounds;
            p.cmpge(min).all() && p.cmple(max).all() && geometry.contains(filling.solid, p)
        };
        let inside = self.fillings[1..].iter().position(holds);
        FillingId(inside.map_or(0, |i| i as u32 + 1))
    }

    pub fn medium(&self, filling: FillingId) -> Option<u32> {
        self.fillings[filling.0 as usize].medium
    }

    /// The media, and how large is what they fill; infinite where it has no end.
    pub fn extents(&self) -> impl Iterator<Item = (u32, f64)> {
        self.fillings.iter().filter_map(|filling| Some((filling.medium?, filling.bounds.extent().length())))
    }

    fn index(&self, filling: FillingId, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let index = &self.fillings[filling.0 as usize].index;
        index.as_ref().map_or(SampledSpectrum::ONE, |index| index.sample(wavelengths))
    }

    /// The two are the same matter: there is no wall between them.
    pub fn alike(&self, a: FillingId, b: FillingId) -> bool {
        self.fillings[a.0 as usize].class == self.fillings[b.0 as usize].class
    }

    /// The index behind a wall over the one before it, seen from where the normal points; `None` where the wall's own
    /// holds: open surfaces, and walls of solids that are opaque elsewhere.
    pub fn relative_index(
        &self,
        geometry: &Scene,
        hit: &Hit,
        [outer, inner]: [FillingId; 2],
        wavelengths: &SampledWavelengths,
    ) -> Option<SampledSpectrum> {
        let PartKind::Leaf { solid, .. } = geometry.parts()[hit.part.0 as usize].kind else { return None };
        self.by_solid.contains_key(&solid).then(|| self.index(inner, wavelengths) / self.index(outer, wavelengths))
    }
}
