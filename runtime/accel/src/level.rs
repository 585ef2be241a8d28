//! The solids of one frame: those of the world, or the one that instances share.

use std::sync::Arc;

use arsc_embree::{Bounds, BuildQuality, Callbacks, Device, GeometryId, Scene as EmbreeScene, SceneBuilder, Step};
use arsc_geometry::Aabb;

use crate::facets::Facet;
use crate::nearest::{Candidate, Target};
use crate::query::{Extent, Mode, PreparedRay, Query, View};
use crate::solid::{Nearness, SolidModel, SolidRay};
use crate::strategies::{Members, SolidTracer, Tracer};
use crate::transition::Transition;
use crate::{AccelError, Budget, Strategy};

/// Solids and how their parts are numbered.
pub struct Solids {
    pub models: Vec<Arc<SolidModel>>,
    frames: Vec<SolidFrame>,
}

/// What rays need of a solid, side by side.
#[derive(Clone, Copy, Debug)]
struct SolidFrame {
    nearness: Nearness,
    tolerance: f64,
    /// Relative to the first of the level.
    first_part: u32,
}

impl Solids {
    fn new(models: Vec<Arc<SolidModel>>) -> Solids {
        let mut frames = Vec::with_capacity(models.len());
        let mut first_part = 0;
        for solid in &models {
            frames.push(SolidFrame { nearness: solid.nearness, tolerance: solid.tolerance, first_part });
            first_part += solid.leaves.len() as u32;
        }
        Solids { models, frames }
    }

    /// What each solid gets of a budget for all.
    pub fn shares(&self, budget: &Budget) -> impl Iterator<Item = Budget> {
        let all: usize = self.models.iter().map(|solid| solid.leaves.len()).sum();
        self.models.iter().map(move |solid| budget.share(solid.leaves.len(), all))
    }

    /// The solids with their numbers.
    pub fn numbered(&self) -> impl Iterator<Item = (u32, &SolidModel)> {
        (0..).zip(self.models.iter().map(|model| &**model))
    }

    #[inline]
    pub fn near_ray(&self, solid: u32, query: &Query) -> SolidRay {
        let view = &query.view;
        self.frames[solid as usize].nearness.near_ray(view.ray.origin, view.ray.dir, query.limit() * view.scale)
    }

    /// The ray of a view as `solid` is met by it: [`Nearness::near`].
    #[inline(always)]
    pub fn near<'a>(&self, solid: u32, view: &'a View, moved: &'a mut Option<PreparedRay>) -> (&'a PreparedRay, f64) {
        self.frames[solid as usize].nearness.near(view, moved)
    }

    #[inline]
    pub fn tolerance(&self, solid: u32) -> f64 {
        self.frames[solid as usize].tolerance
    }

    /// The query asks for another solid alone.
    #[inline]
    pub fn is_left_out(&self, solid: u32, query: &Query) -> bool {
        query.only.is_some_and(|only| only != query.view.first_solid + solid)
    }

    /// What a transition is in the scene, along a ray whose own start is at the parameter `start`.
    #[inline]
    pub fn candidate(&self, solid: u32, transition: Transition, start: f64, view: &View) -> Candidate {
        Candidate {
            t: (transition.t - start) * view.inverse_scale,
            part: view.first_part + self.frames[solid as usize].first_part + transition.leaf,
            tolerance: self.frames[solid as usize].tolerance * view.inverse_scale,
            target: Target::Solid { solid: view.first_solid + solid, transition },
        }
    }
}

/// Solids with their primitives.
pub struct Level {
    pub solids: Solids,
    tracer: Tracer,
}

impl Level {
    pub fn new(models: Vec<Arc<SolidModel>>, strategy: Strategy, budget: &Budget) -> Level {
        let solids = Solids::new(models);
        let tracer = Tracer::build(&solids, strategy, budget);
        Level { solids, tracer }
    }

    /// Nothing is to be left to Embree.
    pub fn is_native(&self) -> bool {
        matches!(self.tracer, Tracer::Native(_))
    }

    /// Number of primitives for Embree.
    pub fn primitive_count(&self) -> usize {
        self.tracer.get().primitive_count()
    }

    pub fn primitive_bounds(&self, primitive: u32) -> Aabb {
        self.tracer.get().primitive_bounds(&self.solids, primitive)
    }

    /// Holds all primitives.
    pub fn bounds(&self) -> Aabb {
        let all = 0..self.primitive_count() as u32;
        let hull = all.fold(Aabb::EMPTY, |hull, primitive| hull.union(&self.primitive_bounds(primitive)));
        let corners = self.facets().iter().flat_map(|facet| facet.corners(&self.solids));
        corners.fold(hull, |hull, p| hull.union(&Aabb::new(p, p)))
    }

    /// Triangles that are boundary by themselves, or in part.
    pub fn facets(&self) -> &[Facet] {
        match &self.tracer {
            Tracer::Local(local) => &local.facets,
            _ => &[],
        }
    }

    /// Holds the facet.
    pub fn facet_bounds(&self, facet: u32) -> Aabb {
        let corners = self.facets()[facet as usize].corners(&self.solids);
        corners.iter().fold(Aabb::EMPTY, |hull, &p| hull.union(&Aabb::new(p, p)))
    }

    /// Meets a facet that Embree's traversal has come to.
    #[inline]
    pub fn visit_facet(&self, facet: u32, query: &mut Query) {
        if let Tracer::Local(local) = &self.tracer
            && !query.probing
        {
            local.facets[facet as usize].visit(&self.solids, &local.facet_cells, query);
        }
    }

    /// Boxes that the solids are found by.
    pub fn cell_count(&self) -> usize {
        self.tracer.get().cell_count()
    }

    pub fn bytes(&self) -> usize {
        let leaves: usize = self.solids.models.iter().map(|s| size_of_val(&s.leaves[..])).sum();
        self.tracer.get().bytes() + leaves
    }

    /// There is nothing for [`Level::visit_open`] to meet.
    pub fn is_closed(&self) -> bool {
        matches!(&self.tracer, Tracer::Local(local) if local.is_closed())
    }

    /// Meets what Embree does not hold.
    pub fn visit_open(&self, query: &mut Query) {
        self.tracer.get().visit_open(&self.solids, query);
    }

    /// Meets a primitive that Embree's traversal has come to.
    pub fn visit(&self, primitive: u32, query: &mut Query) {
        match &self.tracer {
            Tracer::Local(local) => local.visit(&self.solids, primitive, query),
            other => other.get().visit(&self.solids, primitive, query),
        }
    }

    /// Has Embree take the query through `scene`, whose solids are this level's and which lies in `extent`.
    pub fn traverse<C: Callbacks<Query = Query>>(&self, scene: &EmbreeScene<C>, extent: &Extent, query: &mut Query) {
        let mark = query.scratch.whole.mark();
        match &self.tracer {
            Tracer::Local(local) if local.members.has_several() => {
                self.traverse_unions(&local.members, mark, scene, extent, query);
            }
            Tracer::Collect(collect) => {
                pass(scene, extent, query);
                collect.finish(&self.solids, mark, query);
            }
            _ => pass(scene, extent, query),
        }
    }

    /// The same where some solids are unions of leaves that Embree visits one by one.
    fn traverse_unions<C: Callbacks<Query = Query>>(
        &self,
        members: &Members,
        mark: usize,
        scene: &EmbreeScene<C>,
        extent: &Extent,
        query: &mut Query,
    ) {
        // This may be an instance within a traversal of the world.
        let outer = (query.gathering, query.tentative);
        let nearest = query.nearest;
        (query.gathering, query.tentative) = (query.mode == Mode::Collect, false);
        pass(scene, extent, query);
        if query.tentative && !query.blocked && !query.unclear {
            // Whatever holds the start has its box here.
            query.probing = true;
            if let Some(segment) = query.view.segment(extent, 0.0) {
                scene.occluded(&segment, query);
            }
            query.probing = false;
            query.blocked = !query.unclear;
        }
        if query.unclear {
            query.nearest = nearest;
            (query.blocked, query.unclear, query.tentative, query.gathering) = (false, false, false, true);
            pass(scene, extent, query);
        }
        members.finish(&self.solids, mark, query);
        (query.gathering, query.tentative) = outer;
    }
}

/// One traversal.
#[inline(always)]
fn pass<C: Callbacks<Query = Query>>(scene: &EmbreeScene<C>, extent: &Extent, query: &mut Query) {
    let limit = query.limit();
    let Some(segment) = query.view.segment(extent, limit) else { return };
    if query.mode == Mode::Occluded {
        scene.occluded(&segment, query);
    } else {
        scene.intersect(&segment, query);
    }
}

/// The first geometry of a prototype; the second is its facets.
const PRIMITIVES: GeometryId = GeometryId(0);

/// A level as a scene of its own, for instances.
pub struct Prototype {
    pub level: Level,
    extent: Extent,
    /// Embree holds everything.
    is_closed: bool,
}

impl Prototype {
    pub fn build(
        device: &Device,
        solid: Arc<SolidModel>,
        strategy: Strategy,
        budget: &Budget,
    ) -> Result<EmbreeScene<Prototype>, AccelError> {
        let level = Level::new(vec![solid], strategy, budget);
        let extent = Extent::new(level.bounds());
        let (primitives, facets) = (level.primitive_count(), level.facets().len());
        let is_closed = level.is_closed();
        let prototype = Arc::new(Prototype { level, extent, is_closed });
        let mut builder = SceneBuilder::new(device, prototype, BuildQuality::High)?;
        builder.user_geometry(primitives)?;
        if facets > 0 {
            builder.user_geometry(facets)?;
        }
        Ok(builder.commit()?)
    }

    fn visit(&self, query: &mut Query, geometry: GeometryId, primitive: u32) {
        match geometry {
            PRIMITIVES => self.level.visit(primitive, query),
            _ => self.level.visit_facet(primitive, query),
        }
    }

    /// Traces the query, whose view is this frame's.
    pub fn trace(scene: &EmbreeScene<Prototype>, query: &mut Query) {
        let this = scene.callbacks();
        if !this.is_closed {
            this.level.visit_open(query);
            if query.blocked {
                return;
            }
        }
        this.level.traverse(scene, &this.extent, query);
    }
}

impl Callbacks for Prototype {
    type Query = Query;

    fn bounds(&self, geometry: GeometryId, primitive: u32) -> Bounds {
        let bounds = match geometry {
            PRIMITIVES => self.level.primitive_bounds(primitive),
            _ => self.level.facet_bounds(primitive),
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
}
