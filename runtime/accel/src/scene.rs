//! The built scene: what rays, lights and probes ask.

use std::cell::Cell;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DAffine3, DVec2, DVec3};

use arsc_embree::Scene as EmbreeScene;
use arsc_geometry::{Aabb, Foot, Placed, Ray, Shape, SurfacePoint};

use crate::expression::{Expression, eval};
use crate::faces::Faces;
use crate::frame::Frame;
use crate::level::{Level, Prototype};
use crate::nearest::{Candidate, Target};
use crate::query::{Mode, Query, Scratch};
use crate::solid::SolidModel;
use crate::strategies::oracle;
use crate::strategies::plain::Plain;
use crate::surfaces::SurfaceModel;
use crate::transition::Transition;
use crate::world::{InstanceModel, World, device};
use crate::{
    AccelError, AreaSample, Budget, Hit, Interval, MaterialIndex, Parametrization, PartId, SceneGeometry, Solid,
    Strategy,
};

/// Parts are numbered in 32 bits, with room for what is added to them.
const MOST_PARTS: usize = (u32::MAX / 2) as usize;

thread_local! {
    static SCRATCH: Cell<Option<Box<Scratch>>> = const { Cell::new(None) };
}

/// How to build.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildOptions {
    pub strategy: Strategy,
    pub budget: Budget,
}

impl From<Strategy> for BuildOptions {
    fn from(strategy: Strategy) -> BuildOptions {
        BuildOptions { strategy, ..BuildOptions::default() }
    }
}

/// What a build made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildStats {
    pub solids: usize,
    pub instances: usize,
    pub surfaces: usize,
    /// Leaves of solids (shared ones once) and surfaces.
    pub primitives: usize,
    /// Boxes that solids are found by: Embree's primitives, or the cells of own trees.
    pub cells: usize,
    /// Bytes held by our own structures and by the hierarchy.
    pub bytes: usize,
    pub build_time: Duration,
}

/// One leaf of a solid or one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    pub material: MaterialIndex,
    pub kind: PartKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// `solid` counts instances after solids.
    Leaf {
        solid: u32,
        leaf: u32,
    },
    Surface {
        surface: u32,
    },
}

/// A solid in the scene: its model, and the frame of an instance.
struct Member {
    model: Arc<SolidModel>,
    frame: Option<Frame>,
}

impl Member {
    /// Bound on the solid's tolerance in the world, along any direction.
    fn tolerance(&self) -> f64 {
        let columns = |frame: &Frame| {
            let m = frame.world_from_object.matrix3;
            m.x_axis.length() + m.y_axis.length() + m.z_axis.length()
        };
        self.model.tolerance * self.frame.as_ref().map_or(1.0, columns)
    }
}

/// Geometry, ready to be traced from any number of threads.
///
/// Rays must have a unit direction; one that is not finite meets nothing.
pub struct Scene {
    members: Vec<Member>,
    parts: Vec<Part>,
    bounds: Aabb,
    bounded: Aabb,
    stats: BuildStats,
    /// The greatest tolerance of any member, in the world.
    slack: f64,
    world: EmbreeScene<World>,
    faces: Faces,
}

impl Scene {
    pub fn build(geometry: SceneGeometry, options: BuildOptions) -> Result<Scene, AccelError> {
        let start = Instant::now();
        let mut plan = Plan::default();
        for (i, solid) in (0..).zip(&geometry.solids) {
            plan.add_member(Arc::new(SolidModel::new(solid, i)?), None)?;
        }
        let solids = plan.members.iter().map(|member| member.model.clone()).collect();
        let first_surface_part = plan.parts.len() as u32;
        let mut surfaces = Vec::with_capacity(geometry.surfaces.len());
        for (i, surface) in (0..).zip(&geometry.surfaces) {
            let model = SurfaceModel::new(surface, i)?;
            plan.include(&model.bounds());
            plan.parts.push(Part { material: surface.material, kind: PartKind::Surface { surface: i } });
            surfaces.push(model);
        }
        let before = device()?.bytes();
        let (instances, shared_cells, shared_bytes) = plan.add_instances(&geometry, &options)?;
        let share = options.budget.share(geometry.solids.iter().map(|s| s.leaves.len()).sum(), leaf_count(&geometry));
        let level = Level::new(solids, options.strategy, &share);
        let (cells, own_bytes) = (level.cell_count() + shared_cells, level.bytes() + shared_bytes);
        let world = World::build(level, surfaces, first_surface_part, instances)?;
        let stats = BuildStats {
            solids: geometry.solids.len(),
            instances: geometry.instances.len(),
            surfaces: geometry.surfaces.len(),
            primitives: plan.parts.len(),
            cells,
            bytes: own_bytes
                + world.callbacks().plain.as_ref().map_or(0, Plain::bytes)
                + device()?.bytes().saturating_sub(before),
            build_time: start.elapsed(),
        };
        let Plan { members, parts, bounds, bounded } = plan;
        let slack = members.iter().map(Member::tolerance).fold(0.0, f64::max);
        Ok(Scene { members, parts, bounds, bounded, stats, slack, world, faces: Faces::new(&geometry.faces) })
    }

    /// Holds everything; infinite where an unbounded solid or plane is.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Holds every bounded solid, instance and surface; empty if there is none.
    pub fn bounded_parts(&self) -> Aabb {
        self.bounded
    }

    pub fn stats(&self) -> &BuildStats {
        &self.stats
    }

    /// All parts, indexed by [`PartId`].
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Number of solids, instances included.
    pub fn solid_count(&self) -> u32 {
        self.members.len() as u32
    }

    /// The faces of a part that show another material than the part's, ascending.
    pub fn face_materials(&self, part: PartId) -> &[(u32, MaterialIndex)] {
        self.faces.of(self.parts[part.0 as usize].material)
    }

    /// The part's number of faces; 1 for surfaces.
    pub fn face_count(&self, part: PartId) -> u32 {
        match self.parts[part.0 as usize].kind {
            PartKind::Surface { .. } => 1,
            PartKind::Leaf { solid, leaf } => self.shape(solid, leaf).face_count(),
        }
    }

    fn shape(&self, solid: u32, leaf: u32) -> &Shape {
        self.members[solid as usize].model.leaves[leaf as usize].shape()
    }

    /// From now on [`Scene::sample_part`] chooses points of a leaf on these faces only; their share of its object space area.
    pub fn sample_only(&mut self, part: PartId, faces: Vec<u32>) -> f64 {
        let PartKind::Leaf { solid, leaf } = self.parts[part.0 as usize].kind else { return 1.0 };
        let shape = self.shape(solid, leaf);
        let share = faces.iter().map(|&face| shape.face_area(face)).sum::<f64>() / shape.area();
        self.faces.sample_only(part, faces);
        share
    }

    /// Holds a solid, in the world.
    pub fn solid_bounds(&self, solid: u32) -> Aabb {
        let member = &self.members[solid as usize];
        let bounds = member.model.bounds;
        member.frame.as_ref().map_or(bounds, |frame| bounds.transformed(&frame.world_from_object))
    }

    /// Whether a point is in a solid (instances after solids): its leaves' memberships, put together. Takes time linear in
    /// the leaves.
    pub fn contains(&self, solid: u32, p: DVec3) -> bool {
        let Member { model, frame } = &self.members[solid as usize];
        let p = frame.as_ref().map_or(p, |frame| frame.object_from_world.transform_point3(p));
        match &model.expression {
            Expression::Constant(value) => *value,
            Expression::Tokens(tokens) => eval(tokens, |leaf| model.leaves[leaf as usize].contains(p)),
        }
    }

    /// World area of a part's whole surface; infinite when it is unbounded.
    pub fn part_area(&self, part: PartId) -> f64 {
        match self.parts[part.0 as usize].kind {
            PartKind::Surface { surface } => self.surfaces()[surface as usize].area(),
            PartKind::Leaf { solid, leaf } => self.placed_leaf(solid, leaf).map_or(f64::INFINITY, |p| p.area()),
        }
    }

    /// The leaf in the world; `None` where the maps multiply to nothing usable.
    fn placed_leaf(&self, solid: u32, leaf: u32) -> Option<Placed> {
        let member = &self.members[solid as usize];
        let placed = &member.model.leaves[leaf as usize];
        match &member.frame {
            None => Some(placed.clone()),
            Some(frame) => {
                Placed::new(placed.shape().clone(), frame.world_from_object * *placed.world_from_object()).ok()
            }
        }
    }

    /// The nearest surface point with `0 < t < t_max`.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.trace(Mode::Nearest, ray, None, |query| {
            let best = query.nearest.best.as_ref()?;
            Some(self.complete(best, query.nearest.tie, ray))
        })
    }

    /// Whether anything is met with `0 < t < t_max`.
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.trace(Mode::Occluded, ray, None, |query| query.blocked)
    }

    /// Leaves (in every cell anew) and surfaces that [`Scene::intersect`] tests for this ray.
    pub fn count_tests(&self, ray: &Ray) -> u32 {
        self.trace(Mode::Nearest, ray, None, |query| query.tests)
    }

    /// All stretches of the ray inside solids, sorted by solid, then by `t`.
    pub fn intervals(&self, ray: &Ray) -> Vec<Interval> {
        // To infinity, so that a bounded solid is known to be left again.
        let endless = Ray { t_max: f64::INFINITY, ..*ray };
        self.trace(Mode::Collect, &endless, None, |query| self.paired(&mut query.scratch.collected, ray))
    }

    /// The stretches between transitions of all solids.
    fn paired(&self, transitions: &mut [Candidate], ray: &Ray) -> Vec<Interval> {
        let mut found = Vec::new();
        let solid_of = |candidate: &Candidate| match candidate.target {
            Target::Solid { solid, .. } => solid,
            _ => u32::MAX,
        };
        transitions
            .sort_unstable_by(|a, b| solid_of(a).cmp(&solid_of(b)).then(a.t.total_cmp(&b.t)).then(a.part.cmp(&b.part)));
        let mut rest = &transitions[..];
        for (solid, member) in (0..).zip(&self.members) {
            let (own, others) = rest.split_at(rest.partition_point(|candidate| solid_of(candidate) <= solid));
            if !own.is_empty() || !member.model.bounds.is_finite() {
                self.solid_intervals(solid, own, ray, &mut found);
            }
            rest = others;
        }
        found
    }

    /// Pairs the transitions of one solid. Overlapping cells report some of them twice: entries and exits alternate, so
    /// one that repeats the kind of the one before is the same.
    fn solid_intervals(&self, solid: u32, transitions: &[Candidate], ray: &Ray, found: &mut Vec<Interval>) {
        let enters = |candidate: &Candidate| {
            matches!(candidate.target, Target::Solid { transition: Transition { entering: true, .. }, .. })
        };
        let starts_inside = match transitions.first() {
            Some(first) => !enters(first),
            None => self.members[solid as usize].contains_start(ray),
        };
        let mut open = starts_inside.then_some((0.0, None));
        for candidate in transitions.iter().take_while(|candidate| candidate.t < ray.t_max) {
            if enters(candidate) == open.is_some() {
                continue;
            }
            let hit = self.complete(candidate, 0.0, ray);
            match open.take() {
                None => open = Some((candidate.t, Some(hit))),
                Some((t_enter, enter)) => {
                    found.push(Interval { t_enter, t_exit: candidate.t, solid, enter, exit: Some(hit) });
                }
            }
        }
        if let Some((t_enter, enter)) = open {
            found.push(Interval { t_enter, t_exit: ray.t_max, solid, enter, exit: None });
        }
    }

    /// What `answer` makes of the traced query; nothing for rays that cannot be traced.
    #[inline]
    fn trace<R: Default>(&self, mode: Mode, ray: &Ray, only: Option<u32>, answer: impl FnOnce(&mut Query) -> R) -> R {
        if !is_traceable(ray) {
            return R::default();
        }
        let mut query = Query::new(mode, ray, self.slack, SCRATCH.take().unwrap_or_default());
        query.only = only;
        World::trace(&self.world, &mut query);
        let result = answer(&mut query);
        SCRATCH.set(Some(query.scratch));
        result
    }

    /// A point uniform over the part's object space area (or the faces given to [`Scene::sample_only`]), if it is on the boundary of the part's solid and its own there;
    /// its density is over the whole part, so that leaving out the others is unbiased. `choice` and `u` in [0, 1)
    /// are independent; `choice` picks the triangle of a mesh. `None` for unbounded parts too.
    pub fn sample_part(&self, part: PartId, choice: f64, u: [f64; 2]) -> Option<AreaSample> {
        match self.parts[part.0 as usize].kind {
            PartKind::Surface { surface } => {
                let model = &self.surfaces()[surface as usize];
                let point = model.sample(choice, u)?;
                let material = self.parts[part.0 as usize].material;
                Some(area_sample(&point, point.n, 1.0 / model.area(), material))
            }
            PartKind::Leaf { solid, leaf } => {
                let placed = self.placed_leaf(solid, leaf)?;
                let chosen = match self.faces.sampled(part) {
                    None => placed.sample_area(u)?,
                    Some(faces) => placed.sample_faces(faces, u)?,
                };
                let hit = self.boundary_at(part, solid, &chosen.point)?;
                let point = SurfacePoint { p_error: chosen.point.p_error.max(hit.p_error), ..chosen.point };
                let ng = if hit.ng.dot(point.n) < 0.0 { -point.n } else { point.n };
                Some(area_sample(&point, ng, chosen.pdf_area, hit.material))
            }
        }
    }

    /// The boundary of the solid where this part's surface is, if it owns it: found by a short ray through the point.
    fn boundary_at(&self, part: PartId, solid: u32, point: &SurfacePoint) -> Option<Hit> {
        let member = &self.members[solid as usize];
        let stretch =
            member.frame.as_ref().map_or(1.0, |frame| frame.world_from_object.matrix3.determinant().abs().cbrt());
        let reach = 4.0 * (member.model.tolerance * stretch).max(4.0 * point.p_error);
        let ray = Ray { origin: point.p + point.n * reach, dir: -point.n, t_max: 2.0 * reach };
        self.trace(Mode::Nearest, &ray, Some(solid), |query| {
            let best = query.nearest.best.filter(|best| best.part == part.0)?;
            Some(self.complete(&best, query.nearest.tie, &ray))
        })
    }

    /// Density with which [`Scene::sample_part`] gives the point of this hit, per unit of world area; zero for
    /// unbounded parts.
    pub fn pdf_area(&self, hit: &Hit) -> f64 {
        match self.parts[hit.part.0 as usize].kind {
            PartKind::Surface { surface } => 1.0 / self.surfaces()[surface as usize].area(),
            PartKind::Leaf { solid, leaf } => {
                let density = |placed: &Placed| match self.faces.sampled(hit.part) {
                    None => placed.pdf_area(hit.p, hit.ng),
                    Some(faces) if faces.contains(&hit.face) => placed.pdf_faces(faces, hit.ng),
                    Some(_) => 0.0,
                };
                match &self.members[solid as usize].frame {
                    None => density(&self.members[solid as usize].model.leaves[leaf as usize]),
                    Some(_) => self.placed_leaf(solid, leaf).map_or(0.0, |placed| density(&placed)),
                }
            }
        }
    }

    /// Surface coordinates of a hit of this scene.
    pub fn parametrize(&self, hit: &Hit) -> Parametrization {
        match self.parts[hit.part.0 as usize].kind {
            PartKind::Leaf { solid, leaf } => {
                let member = &self.members[solid as usize];
                let placed = &member.model.leaves[leaf as usize];
                let Some(frame) = &member.frame else {
                    let point = placed.surface(hit.p, hit.face);
                    return Parametrization { uv: point.uv, dpdu: point.dpdu };
                };
                let point = placed.surface(frame.object_from_world.transform_point3(hit.p), hit.face);
                Parametrization { uv: point.uv, dpdu: frame.tangent_to_world(&point, hit.ng) }
            }
            PartKind::Surface { surface } => {
                let point = match &self.surfaces()[surface as usize] {
                    SurfaceModel::Flat(flat) => flat.surface(hit.p),
                    SurfaceModel::Triangles(mesh) => {
                        let edges = mesh.edges(hit.face as usize);
                        let crossing = edges.crossing(hit.p, hit.ng, f64::INFINITY);
                        mesh.surface(hit.face as usize, crossing.map_or(DVec2::ZERO, |crossing| crossing.weights))
                    }
                };
                Parametrization { uv: point.uv, dpdu: point.dpdu }
            }
        }
    }

    /// Colours of the corners of a mesh's triangle as the file has them, and their weights at a hit; `None` where there are
    /// none.
    pub fn vertex_colors(&self, hit: &Hit) -> Option<[([u8; 3], f64); 3]> {
        let mesh = match self.parts[hit.part.0 as usize].kind {
            PartKind::Leaf { solid, leaf } => match self.members[solid as usize].model.leaves[leaf as usize].shape() {
                Shape::Mesh(mesh) => mesh.mesh(),
                _ => return None,
            },
            PartKind::Surface { surface } => match &self.surfaces()[surface as usize] {
                SurfaceModel::Triangles(triangles) => triangles.mesh()?,
                SurfaceModel::Flat(_) => return None,
            },
        };
        let p = self.object_from_world(hit.part).transform_point3(hit.p);
        mesh.colors_at(hit.face as usize, p)
    }

    /// The map to the object space of a part: of its shape or surface as it was before it was placed.
    pub fn object_from_world(&self, part: PartId) -> DAffine3 {
        match self.parts[part.0 as usize].kind {
            PartKind::Leaf { solid, leaf } => {
                let member = &self.members[solid as usize];
                let own = *member.model.leaves[leaf as usize].object_from_world();
                member.frame.as_ref().map_or(own, |frame| own * frame.object_from_world)
            }
            PartKind::Surface { surface } => match &self.surfaces()[surface as usize] {
                SurfaceModel::Flat(flat) => *flat.object_from_world(),
                SurfaceModel::Triangles(triangles) => triangles.object_from_world(),
            },
        }
    }

    fn surfaces(&self) -> &[SurfaceModel] {
        &self.world.callbacks().surfaces
    }

    /// The frame at a candidate.
    fn complete(&self, candidate: &Candidate, tie: f64, ray: &Ray) -> Hit {
        let p = ray.at(candidate.t);
        let (point, ns, face, flipped, closed): (Foot, _, _, _, _) = match candidate.target {
            Target::Solid { solid, transition } => {
                let member = &self.members[solid as usize];
                let point = member.surface(&transition, p);
                let ns = member.shading_normal(&transition, p).map_or(point.n, |ns| on_side_of(ns, point.n));
                (point, ns, transition.face, transition.flipped, true)
            }
            Target::Flat { surface } => {
                let SurfaceModel::Flat(flat) = &self.surfaces()[surface as usize] else { unreachable!() };
                let foot = flat.foot(p);
                (foot, foot.n, 0, false, false)
            }
            Target::Triangle { surface, triangle, weights } => {
                let SurfaceModel::Triangles(mesh) = &self.surfaces()[surface as usize] else { unreachable!() };
                let (foot, ns) = mesh.foot(triangle as usize, weights);
                (foot, ns, triangle, false, false)
            }
        };
        let sign = if flipped { -1.0 } else { 1.0 };
        Hit {
            t: candidate.t,
            p: point.p,
            p_error: point.p_error + tie,
            ng: point.n * sign,
            ns: ns * sign,
            material: self.faces.material(self.parts[candidate.part as usize].material, face),
            part: PartId(candidate.part),
            face,
            closed,
        }
    }
}

/// Leaves of all solids, shared ones once.
fn leaf_count(geometry: &SceneGeometry) -> usize {
    let own: usize = geometry.solids.iter().map(|solid| solid.leaves.len()).sum();
    let shared: HashMap<*const Solid, usize> =
        geometry.instances.iter().map(|i| (Arc::as_ptr(&i.solid), i.solid.leaves.len())).collect();
    own + shared.values().sum::<usize>()
}

/// Parts and solids as they are numbered.
#[derive(Default)]
struct Plan {
    members: Vec<Member>,
    parts: Vec<Part>,
    bounds: Aabb,
    /// Of what is bounded alone.
    bounded: Aabb,
}

impl Plan {
    fn include(&mut self, bounds: &Aabb) {
        self.bounds = self.bounds.union(bounds);
        if bounds.is_finite() {
            self.bounded = self.bounded.union(bounds);
        }
    }

    fn add_member(&mut self, model: Arc<SolidModel>, frame: Option<Frame>) -> Result<(), AccelError> {
        let solid = self.members.len() as u32;
        if self.parts.len() + model.leaves.len() > MOST_PARTS {
            return Err(AccelError::TooManyParts);
        }
        for (leaf, &material) in (0..).zip(&model.materials) {
            self.parts.push(Part { material, kind: PartKind::Leaf { solid, leaf } });
        }
        let map = frame.as_ref().map(|frame| frame.world_from_object);
        let world = map.map_or(model.bounds, |map| model.bounds.transformed(&map));
        self.include(&world);
        self.members.push(Member { model, frame });
        Ok(())
    }

    /// The instances, and cells and bytes of what they share.
    fn add_instances(
        &mut self,
        geometry: &SceneGeometry,
        options: &BuildOptions,
    ) -> Result<(Vec<InstanceModel>, usize, usize), AccelError> {
        let leaves = leaf_count(geometry);
        let mut shared: HashMap<*const Solid, Arc<EmbreeScene<Prototype>>> = HashMap::new();
        let mut instances = Vec::with_capacity(geometry.instances.len());
        let (mut cells, mut bytes) = (0, 0);
        for (i, instance) in (0..).zip(&geometry.instances) {
            let frame = Frame::new(instance.world_from_object).ok_or(AccelError::Instance { instance: i })?;
            let (solid, first_part) = (self.members.len() as u32, self.parts.len() as u32);
            let prototype = match shared.get(&Arc::as_ptr(&instance.solid)) {
                Some(prototype) => prototype.clone(),
                None => {
                    let model = Arc::new(SolidModel::new(&instance.solid, solid)?);
                    let share = options.budget.share(model.leaves.len(), leaves);
                    let prototype = Arc::new(Prototype::build(device()?, model, options.strategy, &share)?);
                    let level = &prototype.callbacks().level;
                    cells += level.cell_count();
                    bytes += level.bytes();
                    shared.insert(Arc::as_ptr(&instance.solid), prototype.clone());
                    prototype
                }
            };
            self.add_member(prototype.callbacks().level.solids.models[0].clone(), Some(frame.clone()))?;
            instances.push(InstanceModel { prototype, frame, solid, first_part });
        }
        Ok((instances, cells, bytes))
    }
}

impl Member {
    /// The ray's origin is in the solid. The direction stays what it is: a grazing line would not survive a rounding.
    fn contains_start(&self, ray: &Ray) -> bool {
        let near = match &self.frame {
            None => self.model.near_ray(ray.origin, ray.dir, f64::INFINITY),
            Some(frame) => {
                let local = ray.transformed(&frame.object_from_world);
                self.model.near_ray(local.origin, local.dir.normalize(), f64::INFINITY)
            }
        };
        oracle::transitions(&self.model, &near, |_| false)
    }

    /// The interpolated normal of a transition at `p`, unit, in the world; `None` where it is the surface's own.
    fn shading_normal(&self, transition: &Transition, p: DVec3) -> Option<DVec3> {
        let leaf = &self.model.leaves[transition.leaf as usize];
        match &self.frame {
            None => leaf.shading_normal(p, transition.face),
            Some(frame) => {
                let local = leaf.shading_normal(frame.object_from_world.transform_point3(p), transition.face)?;
                frame.object_from_world.matrix3.transpose().mul_vec3(local).try_normalize()
            }
        }
    }

    /// Rays that leave from where faces coincide must start beyond all of them.
    #[cold]
    fn greatest_error(&self, point: &Foot) -> f64 {
        let others = self.model.leaves.iter().map(|leaf| leaf.error_at(point.p));
        others.fold(point.p_error, f64::max)
    }

    /// The surface point of a transition at `p`, in the world.
    #[inline]
    fn surface(&self, transition: &Transition, p: DVec3) -> Foot {
        let leaf = &self.model.leaves[transition.leaf as usize];
        let inner = self.frame.as_ref().map_or(p, |frame| frame.object_from_world.transform_point3(p));
        let mut point = leaf.foot(inner, transition.face);
        if transition.shared {
            point.p_error = self.greatest_error(&point);
        }
        self.frame.as_ref().map_or(point, |frame| frame.to_world(&point))
    }
}

fn on_side_of(ns: DVec3, n: DVec3) -> DVec3 {
    if ns.dot(n) < 0.0 { -ns } else { ns }
}

fn is_traceable(ray: &Ray) -> bool {
    // Zero for finite numbers, no number for others.
    let zero = (ray.origin * 0.0 + ray.dir * 0.0).element_sum();
    zero == 0.0 && ray.dir != DVec3::ZERO && ray.t_max > 0.0
}

fn area_sample(point: &SurfacePoint, ng: DVec3, pdf_area: f64, material: MaterialIndex) -> AreaSample {
    AreaSample { p: point.p, p_error: point.p_error, ng, uv: point.uv, pdf_area, material }
}
