//! All that rays meet, under one Embree scene: cells and facets of solids, flat surfaces and instances as user geometry, other triangles
//! and quads natively. Embree culls, double precision decides: triangles are given to Embree a little larger than they are,
//! and a filter finds their hits again. What is not finite is a short list that every ray meets first.

use std::sync::{Arc, OnceLock};

use arsc_embree::{
    Bounds, BuildQuality, Callbacks, Candidate as NativeCandidate, Device, EmbreeError, GeometryId,
    Scene as EmbreeScene, SceneBuilder, Step,
};
use arsc_geometry::{Aabb, Ray};
use glam::DVec3;

use crate::AccelError;
use crate::frame::Frame;
use crate::level::{Level, Prototype};
use crate::nearest::{Candidate, Target};
use crate::query::{Extent, Mode, Query, View};
use crate::strategies::plain::{Item, Plain};
use crate::surfaces::{Edges, Flat, SurfaceModel, Triangles};

/// What a geometry of the Embree scene is; indexed by [`GeometryId`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Solids,
    Flats,
    Instances,
    /// Of solids; see [`crate::facets`].
    Facets,
    /// Surfaces of few triangles.
    Loose,
    /// All triangles of one surface.
    Mesh(u32),
}

/// Triangles are met this far beyond their edges, in units of their size, so that no ray passes between two.
const SEAM: f64 = 1e-12;

/// Surfaces of at most so many triangles share one geometry, with the triangles side by side.
const FEW: usize = 64;

/// From so many triangles on, trees without spatial splits: those need several times the memory while they are built.
const LARGE: usize = 4_000_000;

/// A placed copy of a prototype.
pub struct InstanceModel {
    pub prototype: Arc<EmbreeScene<Prototype>>,
    pub frame: Frame,
    pub solid: u32,
    pub first_part: u32,
}

impl InstanceModel {
    fn bounds(&self) -> Aabb {
        let level = &self.prototype.callbacks().level;
        level.solids.models[0]
            .bounds
            .dilated(level.solids.models[0].tolerance)
            .transformed(&self.frame.world_from_object)
    }

    /// Meets the instance: the same query in its frame.
    fn visit(&self, query: &mut Query) {
        if query.only.is_some_and(|only| only != self.solid) {
            return;
        }
        let local = query.ray.transformed(&self.frame.object_from_world);
        let outside = std::mem::replace(&mut query.view, View::new(&local, self.solid, self.first_part));
        Prototype::trace(&self.prototype, query);
        query.view = outside;
    }
}

/// The primitives of the world's Embree scene.
pub struct World {
    pub level: Level,
    pub surfaces: Vec<SurfaceModel>,
    first_surface_part: u32,
    pub instances: Vec<InstanceModel>,
    kinds: Vec<Kind>,
    /// Surfaces behind the primitives of `Kind::Flats`.
    flats: Vec<u32>,
    loose: Vec<Loose>,
    /// Surfaces with a geometry of their own.
    meshes: Vec<u32>,
    /// Instances behind the primitives of `Kind::Instances`, and those that Embree cannot hold.
    placed: Vec<u32>,
    open_instances: Vec<u32>,
    open_surfaces: Vec<u32>,
    /// Strategy `native`: all surfaces and instances that are finite.
    pub plain: Option<Plain>,
    extent: Extent,
    /// There is nothing for [`World::visit_open`] to meet.
    is_closed: bool,
}

/// A triangle of a small surface, ready for rays.
#[derive(Clone, Copy, Debug)]
struct Loose {
    edges: Edges,
    tolerance: f64,
    surface: u32,
    triangle: u32,
}

/// A geometry of triangles for Embree, none sharing a vertex.
struct Native {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Native {
    /// Somewhat larger than they are.
    fn new(extent: &Extent, corners: impl ExactSizeIterator<Item = [DVec3; 3]>) -> Native {
        let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mut vertices = Vec::with_capacity(3 * corners.len());
        vertices.extend(corners.flat_map(|corners| extent.grown(corners)));
        Native { vertices, triangles }
    }
}

/// One device serves all scenes of the program.
pub fn device() -> Result<&'static Device, AccelError> {
    static DEVICE: OnceLock<Result<Device, EmbreeError>> = OnceLock::new();
    DEVICE.get_or_init(|| Device::new(0)).as_ref().map_err(|error| error.clone().into())
}

impl World {
    pub fn build(
        level: Level,
        surfaces: Vec<SurfaceModel>,
        first_surface_part: u32,
        instances: Vec<InstanceModel>,
    ) -> Result<EmbreeScene<World>, AccelError> {
        let mut world = World {
            level,
            surfaces,
            first_surface_part,
            instances,
            kinds: vec![],
            flats: vec![],
            loose: vec![],
            meshes: vec![],
            placed: vec![],
            open_instances: vec![],
            open_surfaces: vec![],
            plain: None,
            extent: Extent::new(Aabb::EMPTY),
            is_closed: false,
        };
        let mut bounds = world.level.bounds();
        let mut finite_surfaces = vec![];
        for surface in 0..world.surfaces.len() as u32 {
            let hull = world.surfaces[surface as usize].bounds();
            if Extent::admits(&hull) {
                bounds = bounds.union(&hull);
                finite_surfaces.push(surface);
            } else {
                world.open_surfaces.push(surface);
            }
        }
        for instance in 0..world.instances.len() as u32 {
            let hull = world.instances[instance as usize].bounds();
            if Extent::admits(&hull) {
                bounds = bounds.union(&hull);
                world.placed.push(instance);
            } else {
                world.open_instances.push(instance);
            }
        }
        world.extent = Extent::new(bounds);
        world.is_closed = world.level.is_closed() && world.open_surfaces.is_empty() && world.open_instances.is_empty();
        if world.level.is_native() {
            world.plain = Some(world.plain_items(&finite_surfaces));
            world.placed.clear();
        } else {
            for surface in finite_surfaces {
                world.add_surface(surface);
            }
        }
        world.commit()
    }

    /// The placed instances and these surfaces in a tree of our own.
    fn plain_items(&self, surfaces: &[u32]) -> Plain {
        let instance = |&instance: &u32| (Item::Instance { instance }, self.instances[instance as usize].bounds());
        let mut items: Vec<(Item, Aabb)> = self.placed.iter().map(instance).collect();
        for &surface in surfaces {
            match &self.surfaces[surface as usize] {
                SurfaceModel::Flat(_) => {
                    items.push((Item::Flat { surface }, self.surfaces[surface as usize].bounds()));
                }
                SurfaceModel::Triangles(mesh) => items.extend((0..mesh.len()).map(|triangle| {
                    let corners = mesh.corners(triangle);
                    let bounds = corners.iter().fold(Aabb::EMPTY, |hull, &p| hull.union(&Aabb::new(p, p)));
                    (Item::Triangle { surface, triangle: triangle as u32 }, bounds)
                })),
            }
        }
        Plain::build(items)
    }

    fn visit_item(&self, item: Item, query: &mut Query) {
        match item {
            Item::Instance { instance } => self.instances[instance as usize].visit(query),
            Item::Flat { surface } => {
                if let SurfaceModel::Flat(flat) = &self.surfaces[surface as usize] {
                    self.visit_flat(surface, flat, query);
                }
            }
            Item::Triangle { surface, triangle } => {
                if let SurfaceModel::Triangles(mesh) = &self.surfaces[surface as usize] {
                    self.visit_triangle(surface, mesh, triangle, query);
                }
            }
        }
    }

    fn add_surface(&mut self, surface: u32) {
        match &self.surfaces[surface as usize] {
            SurfaceModel::Flat(_) => self.flats.push(surface),
            SurfaceModel::Triangles(mesh) if mesh.len() > FEW => self.meshes.push(surface),
            SurfaceModel::Triangles(mesh) => self.loose.extend((0..mesh.len()).map(|triangle| Loose {
                edges: mesh.edges(triangle),
                tolerance: mesh.tolerance(),
                surface,
                triangle: triangle as u32,
            })),
        }
    }

    fn commit(mut self) -> Result<EmbreeScene<World>, AccelError> {
        let users = [
            (Kind::Solids, self.level.primitive_count()),
            (Kind::Flats, self.flats.len()),
            (Kind::Instances, self.placed.len()),
            (Kind::Facets, self.level.facets().len()),
        ];
        let users = users.into_iter().filter(|&(_, count)| count > 0);
        let users: Vec<(Kind, usize)> = users.collect();
        self.kinds.extend(users.iter().map(|&(kind, _)| kind));
        if !self.loose.is_empty() {
            self.kinds.push(Kind::Loose);
        }
        self.kinds.extend(self.meshes.iter().map(|&surface| Kind::Mesh(surface)));
        let triangles = |surface: &u32| self.triangles(*surface).map_or(0, Triangles::len);
        let large = self.loose.len() + self.meshes.iter().map(triangles).sum::<usize>() > LARGE;
        let quality = if large { BuildQuality::Medium } else { BuildQuality::High };
        let world = Arc::new(self);
        let mut builder = SceneBuilder::new(device()?, world.clone(), quality)?;
        for (_, count) in users {
            builder.user_geometry(count)?;
        }
        // Embree has its own copy of each, and needs room for the build.
        if !world.loose.is_empty() {
            let native = Native::new(&world.extent, world.loose.iter().map(|loose| loose.edges.corners()));
            builder.triangles(&native.vertices, &native.triangles, true)?;
        }
        for mesh in world.meshes.iter().filter_map(|&surface| world.triangles(surface)) {
            let native = Native::new(&world.extent, (0..mesh.len()).map(|triangle| mesh.corners(triangle)));
            builder.triangles(&native.vertices, &native.triangles, true)?;
        }
        Ok(builder.commit()?)
    }

    #[inline]
    fn triangles(&self, surface: u32) -> Option<&Triangles> {
        match &self.surfaces[surface as usize] {
            SurfaceModel::Triangles(triangles) => Some(triangles),
            SurfaceModel::Flat(_) => None,
        }
    }

    /// Traces a query from the world's frame.
    pub fn trace(scene: &EmbreeScene<World>, query: &mut Query) {
        let this = scene.callbacks();
        if !this.is_closed {
            this.visit_open(query);
            if query.blocked {
                return;
            }
        }
        match &this.plain {
            Some(plain) => plain.visit(query, |item, query| this.visit_item(item, query)),
            None => this.level.traverse(scene, &this.extent, query),
        }
    }

    fn visit_open(&self, query: &mut Query) {
        self.level.visit_open(query);
        for &instance in &self.open_instances {
            if !query.blocked {
                self.instances[instance as usize].visit(query);
            }
        }
        for &surface in &self.open_surfaces {
            match &self.surfaces[surface as usize] {
                SurfaceModel::Flat(flat) => self.visit_flat(surface, flat, query),
                SurfaceModel::Triangles(mesh) => {
                    for triangle in 0..mesh.len() as u32 {
                        self.visit_triangle(surface, mesh, triangle, query);
                    }
                }
            }
        }
    }

    /// Open surfaces have no part in what is inside what.
    fn ignores_surfaces(query: &Query) -> bool {
        query.mode == Mode::Collect || query.only.is_some()
    }

    fn visit_flat(&self, surface: u32, flat: &Flat, query: &mut Query) {
        let Ray { origin, dir, .. } = query.ray;
        if World::ignores_surfaces(query) {
            return;
        }
        query.tests += 1;
        if let Some(t) = flat.crossing(origin, dir) {
            let tolerance = flat.tolerance(origin + dir * t, dir);
            let part = self.first_surface_part + surface;
            query.offer(Candidate { t, part, tolerance, target: Target::Flat { surface } });
        }
    }

    fn visit_triangle(&self, surface: u32, mesh: &Triangles, triangle: u32, query: &mut Query) {
        let (edges, tolerance) = (mesh.edges(triangle as usize), mesh.tolerance());
        self.visit_loose(&Loose { edges, tolerance, surface, triangle }, query);
    }

    #[inline]
    fn visit_loose(&self, loose: &Loose, query: &mut Query) {
        if World::ignores_surfaces(query) {
            return;
        }
        query.tests += 1;
        let Some(crossing) = loose.edges.crossing(query.ray.origin, query.ray.dir, SEAM) else { return };
        let Loose { surface, triangle, .. } = *loose;
        query.offer(Candidate {
            t: crossing.t,
            part: self.first_surface_part + surface,
            tolerance: loose.tolerance * crossing.slant,
            target: Target::Triangle { surface, triangle, weights: crossing.weights },
        });
    }

    fn visit(&self, query: &mut Query, geometry: GeometryId, primitive: u32) {
        match self.kinds[geometry.0 as usize] {
            Kind::Solids => self.level.visit(primitive, query),
            _ if query.probing => {}
            Kind::Instances => self.instances[self.placed[primitive as usize] as usize].visit(query),
            Kind::Flats => {
                let surface = self.flats[primitive as usize];
                if let SurfaceModel::Flat(flat) = &self.surfaces[surface as usize] {
                    self.visit_flat(surface, flat, query);
                }
            }
            Kind::Facets => self.level.visit_facet(primitive, query),
            Kind::Loose | Kind::Mesh(_) => {}
        }
    }

    fn visit_native(&self, query: &mut Query, candidate: &NativeCandidate) {
        match self.kinds[candidate.geometry.0 as usize] {
            Kind::Mesh(surface) => {
                if let Some(mesh) = self.triangles(surface) {
                    self.visit_triangle(surface, mesh, candidate.primitive, query);
                }
            }
            _ => self.visit_loose(&self.loose[candidate.primitive as usize], query),
        }
    }
}

impl Callbacks for World {
    type Query = Query;

    fn bounds(&self, geometry: GeometryId, primitive: u32) -> Bounds {
        let bounds = match self.kinds[geometry.0 as usize] {
            Kind::Solids => self.level.primitive_bounds(primitive),
            Kind::Instances => self.instances[self.placed[primitive as usize] as usize].bounds(),
            Kind::Facets => self.level.facet_bounds(primitive),
            _ => self.surfaces[self.flats[primitive as usize] as usize].bounds(),
        };
        self.extent.single(&bounds)
    }

    fn intersect(&self, query: &mut Query, geometry: GeometryId, primitive: u32, _: Option<GeometryId>) -> Step {
        let before = query.limit();
        self.visit(query, geometry, primitive);
        query.step(before)
    }

    fn occluded(&self, query: &mut Query, geometry: GeometryId, primitive: u32, _: Option<GeometryId>) -> bool {
        self.visit(query, geometry, primitive);
        query.ends()
    }

    fn filter(&self, query: &mut Query, candidate: NativeCandidate) -> Step {
        let before = query.limit();
        self.visit_native(query, &candidate);
        query.step(before)
    }

    fn filter_occluded(&self, query: &mut Query, candidate: NativeCandidate) -> bool {
        if !query.probing {
            self.visit_native(query, &candidate);
        }
        query.blocked
    }
}
