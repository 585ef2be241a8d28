//! The solids of one frame: those of the world, or the one that instances share.

use std::sync::Arc;

use arsc_embree::{Bounds, BuildQuality, Callbacks, Device, GeometryId, Scene as EmbreeScene, SceneBuilder, Step};
use arsc_geometry::Aabb;

use crate::cells::{self, CellSet, Line, Window};
use crate::nearest::{Candidate, Target};
use crate::query::{Extent, Mode, Query, View, slab};
use crate::solid::{SolidModel, SolidRay};
use crate::tree::{self, Transition};
use crate::{AccelError, Strategy};

/// A solid, or the part of it beyond its core, that Embree cannot hold.
#[derive(Clone, Copy, Debug)]
enum Open {
    /// Whole solids.
    Tree { solid: u32 },
    /// The cell is what is left of the expression outside the core.
    Outer { cell: u32, core: Aabb },
}

/// Solids with their primitives.
pub struct Level {
    pub solids: Vec<Arc<SolidModel>>,
    /// First part of each solid, relative to the frame's first.
    first_parts: Vec<u32>,
    cells: CellSet,
    outer: CellSet,
    open: Vec<Open>,
    /// Strategy `Tree`: the solids that are primitives.
    whole: Vec<u32>,
    strategy: Strategy,
}

impl Level {
    pub fn new(solids: Vec<Arc<SolidModel>>, strategy: Strategy) -> Level {
        let mut first_parts = Vec::with_capacity(solids.len());
        let mut next = 0;
        for solid in &solids {
            first_parts.push(next);
            next += solid.leaves.len() as u32;
        }
        let mut level = Level {
            solids,
            first_parts,
            cells: CellSet::default(),
            outer: CellSet::default(),
            open: vec![],
            whole: vec![],
            strategy,
        };
        for number in 0..level.solids.len() as u32 {
            level.add(number);
        }
        level
    }

    fn add(&mut self, number: u32) {
        let solid = self.solids[number as usize].clone();
        let core = cells::core(&solid);
        if !core.is_empty() && !Extent::admits(&core) {
            self.open.push(Open::Tree { solid: number });
        } else if self.strategy == Strategy::Tree {
            if Extent::admits(&solid.bounds) {
                self.whole.push(number);
            } else if !solid.bounds.is_empty() {
                self.open.push(Open::Tree { solid: number });
            }
        } else {
            cells::append_solid(&mut self.cells, number, &solid);
            if let Some((cell, core)) = cells::append_outer(&mut self.outer, number, &solid) {
                self.open.push(Open::Outer { cell, core });
            }
        }
    }

    /// Number of primitives for Embree.
    pub fn primitive_count(&self) -> usize {
        match self.strategy {
            Strategy::Local => self.cells.cells.len(),
            Strategy::Tree => self.whole.len(),
        }
    }

    pub fn primitive_bounds(&self, primitive: u32) -> Aabb {
        match self.strategy {
            Strategy::Local => self.cells.cells[primitive as usize].bounds,
            Strategy::Tree => {
                let solid = &self.solids[self.whole[primitive as usize] as usize];
                solid.bounds.dilated(solid.tolerance)
            }
        }
    }

    /// Holds all primitives.
    pub fn bounds(&self) -> Aabb {
        let all = 0..self.primitive_count() as u32;
        all.fold(Aabb::EMPTY, |hull, primitive| hull.union(&self.primitive_bounds(primitive)))
    }

    pub fn bytes(&self) -> usize {
        let leaves: usize = self.solids.iter().map(|s| size_of_val(&s.leaves[..])).sum();
        self.cells.bytes() + self.outer.bytes() + leaves
    }

    /// Meets what Embree does not hold.
    pub fn visit_open(&self, query: &mut Query) {
        for open in &self.open {
            if query.blocked {
                return;
            }
            match *open {
                Open::Tree { solid } => self.visit_whole(solid, query),
                Open::Outer { cell, core } => {
                    let ray = self.near_ray(self.outer.cells[cell as usize].solid, query);
                    let (low, high) = slab(&core, ray.origin, query.view.inverse_dir);
                    if low <= high && !core.is_empty() {
                        self.visit_cell(&self.outer, cell, &ray, (f64::NEG_INFINITY, low), query);
                        self.visit_cell(&self.outer, cell, &ray, (high, f64::INFINITY), query);
                    } else {
                        self.visit_cell(&self.outer, cell, &ray, (f64::NEG_INFINITY, f64::INFINITY), query);
                    }
                }
            }
        }
    }

    /// Meets a primitive that Embree's traversal has come to.
    pub fn visit(&self, primitive: u32, query: &mut Query) {
        match self.strategy {
            Strategy::Local => {
                let cell = &self.cells.cells[primitive as usize];
                let ray = self.near_ray(cell.solid, query);
                let stretch = slab(&cell.bounds, ray.origin, query.view.inverse_dir);
                self.visit_cell(&self.cells, primitive, &ray, stretch, query);
            }
            Strategy::Tree => self.visit_whole(self.whole[primitive as usize], query),
        }
    }

    fn near_ray(&self, solid: u32, query: &Query) -> SolidRay {
        let view = &query.view;
        self.solids[solid as usize].near_ray(view.origin, view.dir, query.limit() * view.scale)
    }

    fn is_left_out(&self, solid: u32, query: &Query) -> bool {
        query.only.is_some_and(|only| only != query.view.first_solid + solid)
    }

    fn visit_whole(&self, solid: u32, query: &mut Query) {
        if self.is_left_out(solid, query) {
            return;
        }
        query.tests += 1;
        let (ray, view) = (self.near_ray(solid, query), query.view);
        tree::transitions(&self.solids[solid as usize], &ray, |transition| {
            query.offer(self.candidate(solid, transition, &ray, &view))
        });
    }

    /// `stretch` is where the ray is in the cell.
    fn visit_cell(&self, set: &CellSet, cell: u32, ray: &SolidRay, stretch: (f64, f64), query: &mut Query) {
        let cell = &set.cells[cell as usize];
        if self.is_left_out(cell.solid, query) {
            return;
        }
        let view = query.view;
        let low = stretch.0.max(ray.start);
        let high = stretch.1.min(ray.end);
        if low > high {
            return;
        }
        query.tests += 1;
        let solid = &self.solids[cell.solid as usize];
        let window = Window { low, high, start: ray.start, tolerance: solid.tolerance };
        let line = Line {
            solid,
            origin: ray.origin,
            dir: ray.dir,
            inverse_dir: view.inverse_dir,
            inverse_square: view.inverse_square,
            key: u64::from(view.first_solid + cell.solid) << 32,
        };
        if query.mode == Mode::Collect {
            let mut found = vec![];
            set.transitions(cell, &line, &window, &mut query.scratch, |transition| {
                found.push(transition);
                true
            });
            for transition in found {
                query.offer(self.candidate(cell.solid, transition, ray, &view));
            }
            return;
        }
        let mut found = None;
        set.transitions(cell, &line, &window, &mut query.scratch, |transition| {
            found = Some(transition);
            false
        });
        if let Some(transition) = found {
            query.offer(self.candidate(cell.solid, transition, ray, &view));
        }
    }

    fn candidate(&self, solid: u32, transition: Transition, ray: &SolidRay, view: &View) -> Candidate {
        Candidate {
            t: (transition.t - ray.start) * view.inverse_scale,
            part: view.first_part + self.first_parts[solid as usize] + transition.leaf,
            tolerance: self.solids[solid as usize].tolerance * view.inverse_scale,
            target: Target::Solid { solid: view.first_solid + solid, transition },
        }
    }
}

/// A level as a scene of its own, for instances.
pub struct Prototype {
    pub level: Level,
    extent: Extent,
}

impl Prototype {
    pub fn build(
        device: &Device,
        solid: Arc<SolidModel>,
        strategy: Strategy,
    ) -> Result<EmbreeScene<Prototype>, AccelError> {
        let level = Level::new(vec![solid], strategy);
        let extent = Extent::new(level.bounds());
        let primitives = level.primitive_count();
        let mut builder = SceneBuilder::new(device, Arc::new(Prototype { level, extent }), BuildQuality::High)?;
        builder.user_geometry(primitives)?;
        Ok(builder.commit()?)
    }

    /// Traces the query, whose view is this frame's.
    pub fn trace(scene: &EmbreeScene<Prototype>, query: &mut Query) {
        let this = scene.callbacks();
        this.level.visit_open(query);
        let limit = query.limit();
        if query.blocked {
            return;
        }
        let Some(segment) = query.view.segment(&this.extent, limit) else { return };
        if query.mode == Mode::Occluded {
            scene.occluded(&segment, query);
        } else {
            scene.intersect(&segment, query);
        }
    }
}

impl Callbacks for Prototype {
    type Query = Query;

    fn bounds(&self, _: GeometryId, primitive: u32) -> Bounds {
        self.extent.single(&self.level.primitive_bounds(primitive))
    }

    fn intersect(&self, query: &mut Query, _: GeometryId, primitive: u32, _: Option<GeometryId>) -> Step {
        let before = query.limit();
        self.level.visit(primitive, query);
        query.step(before)
    }

    fn occluded(&self, query: &mut Query, _: GeometryId, primitive: u32, _: Option<GeometryId>) -> bool {
        self.level.visit(primitive, query);
        query.blocked
    }
}
