//! The built scene: what rays, lights and probes ask.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;

use arsc_geometry::{Aabb, Placed, Ray, SurfacePoint};

use crate::frame::Frame;
use crate::nearest::{Candidate, Nearest, Target};
use crate::solid::{SolidModel, SolidRay};
use crate::surfaces::SurfaceModel;
use crate::tree::{Transition, transitions};
use crate::{AccelError, AreaSample, Hit, Interval, MaterialIndex, PartId, SceneGeometry, Strategy};

/// How to build.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildOptions {
    pub strategy: Strategy,
}

/// What a build made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildStats {
    pub solids: usize,
    pub instances: usize,
    pub surfaces: usize,
    /// Leaves of solids (shared ones once) and surfaces.
    pub primitives: usize,
    /// Primitives of the bounding hierarchy that stand for solids.
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
    first_part: u32,
}

/// Geometry, ready to be traced from any number of threads.
///
/// Rays must have a unit direction; one that is not finite meets nothing.
pub struct Scene {
    members: Vec<Member>,
    surfaces: Vec<SurfaceModel>,
    first_surface_part: u32,
    parts: Vec<Part>,
    bounds: Aabb,
    stats: BuildStats,
}

impl Scene {
    pub fn build(geometry: SceneGeometry, options: BuildOptions) -> Result<Scene, AccelError> {
        let start = Instant::now();
        let _ = options;
        let mut scene = Scene {
            members: vec![],
            surfaces: vec![],
            first_surface_part: 0,
            parts: vec![],
            bounds: Aabb::EMPTY,
            stats: BuildStats::default(),
        };
        for (i, solid) in (0..).zip(&geometry.solids) {
            scene.add_member(Arc::new(SolidModel::new(solid, i)?), None)?;
        }
        scene.first_surface_part = scene.parts.len() as u32;
        for (i, surface) in (0..).zip(&geometry.surfaces) {
            let model = SurfaceModel::new(surface, i)?;
            scene.bounds = scene.bounds.union(&model.bounds());
            scene.parts.push(Part { material: surface.material, kind: PartKind::Surface { surface: i } });
            scene.surfaces.push(model);
        }
        scene.add_instances(&geometry)?;
        scene.stats = BuildStats {
            solids: geometry.solids.len(),
            instances: geometry.instances.len(),
            surfaces: geometry.surfaces.len(),
            primitives: scene.parts.len(),
            cells: scene.members.len(),
            bytes: 0,
            build_time: start.elapsed(),
        };
        Ok(scene)
    }

    fn add_instances(&mut self, geometry: &SceneGeometry) -> Result<(), AccelError> {
        let first = geometry.solids.len() as u32;
        let mut shared: Vec<(*const crate::Solid, Arc<SolidModel>)> = Vec::new();
        for (i, instance) in (0..).zip(&geometry.instances) {
            let frame = Frame::new(instance.world_from_object).ok_or(AccelError::Instance { instance: i })?;
            let pointer = Arc::as_ptr(&instance.solid);
            let known = shared.iter().find(|(p, _)| *p == pointer).map(|(_, model)| model.clone());
            let model = match known {
                Some(model) => model,
                None => {
                    let model = Arc::new(SolidModel::new(&instance.solid, first + i)?);
                    shared.push((pointer, model.clone()));
                    model
                }
            };
            self.add_member(model, Some(frame))?;
        }
        Ok(())
    }

    fn add_member(&mut self, model: Arc<SolidModel>, frame: Option<Frame>) -> Result<(), AccelError> {
        let solid = self.members.len() as u32;
        let first_part = self.parts.len() as u32;
        if self.parts.len() + model.leaves.len() > u32::MAX as usize / 2 {
            return Err(AccelError::TooManyParts);
        }
        for (leaf, &material) in (0..).zip(&model.materials) {
            self.parts.push(Part { material, kind: PartKind::Leaf { solid, leaf } });
        }
        let local = model.bounds;
        let world = frame.as_ref().map_or(local, |frame| local.transformed(&frame.world_from_object));
        self.bounds = self.bounds.union(&world);
        self.members.push(Member { model, frame, first_part });
        Ok(())
    }

    /// Holds everything; infinite where an unbounded solid or plane is.
    pub fn bounds(&self) -> Aabb {
        self.bounds
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

    /// World area of a part's whole surface; infinite when it is unbounded.
    pub fn part_area(&self, part: PartId) -> f64 {
        match self.parts[part.0 as usize].kind {
            PartKind::Surface { surface } => self.surfaces[surface as usize].area(),
            PartKind::Leaf { solid, leaf } => self.placed_leaf(solid, leaf).map_or(f64::INFINITY, |p| p.area()),
        }
    }

    /// The leaf in the world; `None` where the maps multiply to nothing usable.
    fn placed_leaf(&self, solid: u32, leaf: u32) -> Option<Placed> {
        let member = &self.members[solid as usize];
        let placed = &member.model.leaves[leaf as usize];
        match &member.frame {
            None => Some(placed.clone()),
            Some(frame) => Placed::new(*placed.shape(), frame.world_from_object * *placed.world_from_object()).ok(),
        }
    }

    /// The nearest surface point with `0 < t < t_max`.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if !is_traceable(ray) {
            return None;
        }
        let mut nearest = Nearest::new(ray.t_max);
        for (solid, member) in (0..).zip(&self.members) {
            offer_solid(solid, member, ray, &mut nearest);
        }
        for (surface, model) in (0..).zip(&self.surfaces) {
            offer_surface(surface, self.first_surface_part + surface, model, ray, &mut nearest);
        }
        let best = nearest.best?;
        Some(self.complete(&best, nearest.tie, ray))
    }

    /// Whether anything is met with `0 < t < t_max`.
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.intersect(ray).is_some()
    }

    /// All stretches of the ray inside solids, sorted by solid, then by `t`.
    pub fn intervals(&self, ray: &Ray) -> Vec<Interval> {
        let mut found = Vec::new();
        if is_traceable(ray) {
            for (solid, member) in (0..).zip(&self.members) {
                self.solid_intervals(solid, member, ray, &mut found);
            }
        }
        found
    }

    fn solid_intervals(&self, solid: u32, member: &Member, ray: &Ray, found: &mut Vec<Interval>) {
        let (view, scale) = member.view(ray);
        let mut crossed = Vec::new();
        let start = transitions(&member.model, &view, |transition| {
            let t = (transition.t - view.start) / scale;
            if t < ray.t_max {
                crossed.push(Candidate {
                    t,
                    part: member.first_part + transition.leaf,
                    tolerance: member.model.tolerance / scale,
                    target: Target::Solid { solid, transition },
                });
            }
            t < ray.t_max
        });
        let mut open = start.then_some((0.0, None));
        for candidate in crossed {
            let hit = self.complete(&candidate, 0.0, ray);
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

    /// A point uniform over the part's object space area, if it is on the boundary of the part's solid and its own there;
    /// its density is over the whole part, so that leaving out the others is unbiased. `choice` and `u` in [0, 1)
    /// are independent; `choice` picks the triangle of a mesh. `None` for unbounded parts too.
    pub fn sample_part(&self, part: PartId, choice: f64, u: [f64; 2]) -> Option<AreaSample> {
        match self.parts[part.0 as usize].kind {
            PartKind::Surface { surface } => {
                let model = &self.surfaces[surface as usize];
                let point = model.sample(choice, u)?;
                Some(area_sample(&point, point.n, 1.0 / model.area()))
            }
            PartKind::Leaf { solid, leaf } => {
                let chosen = self.placed_leaf(solid, leaf)?.sample_area(u)?;
                let hit = self.boundary_at(part, solid, &chosen.point)?;
                let point = SurfacePoint { p_error: chosen.point.p_error.max(hit.p_error), ..chosen.point };
                let ng = if hit.ng.dot(point.n) < 0.0 { -point.n } else { point.n };
                Some(area_sample(&point, ng, chosen.pdf_area))
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
        let mut nearest = Nearest::new(ray.t_max);
        offer_solid(solid, member, &ray, &mut nearest);
        let best = nearest.best.filter(|best| best.part == part.0)?;
        Some(self.complete(&best, nearest.tie, &ray))
    }

    /// Density with which [`Scene::sample_part`] gives the point of this hit, per unit of world area; zero for
    /// unbounded parts.
    pub fn pdf_area(&self, hit: &Hit) -> f64 {
        match self.parts[hit.part.0 as usize].kind {
            PartKind::Surface { surface } => 1.0 / self.surfaces[surface as usize].area(),
            PartKind::Leaf { solid, leaf } => match &self.members[solid as usize].frame {
                None => self.members[solid as usize].model.leaves[leaf as usize].pdf_area(hit.ng),
                Some(_) => self.placed_leaf(solid, leaf).map_or(0.0, |placed| placed.pdf_area(hit.ng)),
            },
        }
    }

    /// The frame at a candidate.
    fn complete(&self, candidate: &Candidate, tie: f64, ray: &Ray) -> Hit {
        let p = ray.at(candidate.t);
        let (point, ns, face, flipped, closed) = match candidate.target {
            Target::Solid { solid, transition } => {
                let member = &self.members[solid as usize];
                let point = member.surface(&transition, p);
                (point, point.n, u32::from(transition.face), transition.flipped, true)
            }
            Target::Flat { surface } => {
                let SurfaceModel::Flat(flat) = &self.surfaces[surface as usize] else { unreachable!() };
                let point = flat.surface(p);
                (point, point.n, 0, false, false)
            }
            Target::Triangle { surface, triangle, weights } => {
                let SurfaceModel::Triangles(mesh) = &self.surfaces[surface as usize] else { unreachable!() };
                let (point, ns) = mesh.surface(triangle as usize, weights);
                (point, ns, triangle, false, false)
            }
        };
        let sign = if flipped { -1.0 } else { 1.0 };
        Hit {
            t: candidate.t,
            p: point.p,
            p_error: point.p_error + tie,
            ng: point.n * sign,
            ns: ns * sign,
            uv: point.uv,
            dpdu: point.dpdu,
            material: self.parts[candidate.part as usize].material,
            part: PartId(candidate.part),
            face,
            closed,
        }
    }
}

impl Member {
    /// The ray in the solid's frame, and how much longer its unit of `t` is there.
    fn view(&self, ray: &Ray) -> (SolidRay, f64) {
        match &self.frame {
            None => (self.model.near_ray(ray.origin, ray.dir, ray.t_max), 1.0),
            Some(frame) => {
                let local = ray.transformed(&frame.object_from_world);
                let scale = local.dir.length();
                (self.model.near_ray(local.origin, local.dir / scale, local.t_max * scale), scale)
            }
        }
    }

    /// The surface point of a transition at `p`, in the world.
    fn surface(&self, transition: &Transition, p: DVec3) -> SurfacePoint {
        let leaf = &self.model.leaves[transition.leaf as usize];
        let inner = self.frame.as_ref().map_or(p, |frame| frame.object_from_world.transform_point3(p));
        let mut point = leaf.surface(inner, transition.face);
        if transition.shared {
            // Rays that leave must start beyond the other coincident faces as well.
            let others = self.model.leaves.iter().map(|leaf| leaf.error_at(point.p));
            point.p_error = others.fold(point.p_error, f64::max);
        }
        self.frame.as_ref().map_or(point, |frame| frame.to_world(&point))
    }
}

fn is_traceable(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.dir.is_finite() && ray.dir != DVec3::ZERO && ray.t_max > 0.0
}

fn area_sample(point: &SurfacePoint, ng: DVec3, pdf_area: f64) -> AreaSample {
    AreaSample { p: point.p, p_error: point.p_error, ng, uv: point.uv, pdf_area }
}

fn offer_solid(solid: u32, member: &Member, ray: &Ray, nearest: &mut Nearest) {
    let (view, scale) = member.view(ray);
    transitions(&member.model, &view, |transition| {
        nearest.offer(Candidate {
            t: (transition.t - view.start) / scale,
            part: member.first_part + transition.leaf,
            tolerance: member.model.tolerance / scale,
            target: Target::Solid { solid, transition },
        });
        false
    });
}

fn offer_surface(surface: u32, part: u32, model: &SurfaceModel, ray: &Ray, nearest: &mut Nearest) {
    match model {
        SurfaceModel::Flat(flat) => {
            if let Some(t) = flat.crossing(ray.origin, ray.dir) {
                let tolerance = flat.tolerance(ray.at(t), ray.dir);
                nearest.offer(Candidate { t, part, tolerance, target: Target::Flat { surface } });
            }
        }
        SurfaceModel::Triangles(mesh) => {
            for triangle in 0..mesh.triangles.len() {
                if let Some((t, weights)) = mesh.crossing(triangle, ray.origin, ray.dir)
                    && weights.min_element() >= 0.0
                    && weights.x + weights.y <= 1.0
                {
                    let target = Target::Triangle { surface, triangle: triangle as u32, weights };
                    let tolerance = mesh.tolerance(triangle, ray.dir);
                    nearest.offer(Candidate { t, part, tolerance, target });
                }
            }
        }
    }
}
