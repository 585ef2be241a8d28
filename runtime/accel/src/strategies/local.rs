//! The default: cells with simplified expressions (`crate::cells`) are Embree's primitives, visited front to back.

use arsc_geometry::Aabb;

use crate::Budget;
use crate::cells::{self, CellSet, Line, Window};
use crate::facets::{self, Facet, mesh_of};
use crate::level::Solids;
use crate::query::{Extent, Mode, Query, slab};
use crate::solid::SolidRay;
use crate::strategies::{Members, SolidTracer, oracle};

/// A solid, or the part of it beyond its core, that Embree cannot hold.
#[derive(Clone, Copy, Debug)]
enum Open {
    /// Whole solids.
    Whole { solid: u32 },
    /// The cell is what is left of the expression outside the core.
    Outer { cell: u32, core: Aabb },
}

/// Solids smaller than this, in parts of the largest coordinate, have no facets.
const SMALLEST_MESH: f64 = 1.0 / 256.0;

#[derive(Default)]
pub struct Local {
    cells: CellSet,
    /// Primitives after the cells.
    pub members: Members,
    /// Triangles of mesh leaves, with their cells.
    pub facets: Vec<Facet>,
    pub facet_cells: CellSet,
    outer: CellSet,
    open: Vec<Open>,
}

impl Local {
    pub fn build(solids: &Solids, budget: &Budget) -> Local {
        let mut local = Local::default();
        let largest = |b: Aabb| if b.is_finite() { b.min.abs().max(b.max.abs()).max_element() } else { 0.0 };
        let reach = solids.models.iter().map(|solid| largest(cells::core(solid))).fold(0.0, f64::max);
        for ((number, solid), share) in solids.numbered().zip(solids.shares(budget)) {
            let core = cells::core(solid);
            if !core.is_empty() && !Extent::admits(&core) {
                local.open.push(Open::Whole { solid: number });
            } else if solid.leaves.iter().any(|leaf| mesh_of(leaf).is_some()) || !local.members.admit(number, solid) {
                // Triangles that are small beside single precision's step in this scene are left to the cells.
                let has_facets = !core.is_empty() && core.extent().max_element() >= SMALLEST_MESH * reach;
                if has_facets {
                    facets::append(&mut local.facets, &mut local.facet_cells, number, solid, &share);
                }
                cells::append_solid(&mut local.cells, number, solid, has_facets, &share);
                if let Some((cell, core)) = cells::append_outer(&mut local.outer, number, solid) {
                    local.open.push(Open::Outer { cell, core });
                }
            }
        }
        local
    }

    fn visit_whole(&self, solids: &Solids, solid: u32, query: &mut Query) {
        if solids.is_left_out(solid, query) {
            return;
        }
        query.tests += solids.models[solid as usize].leaves.len() as u32;
        let (ray, view) = (solids.near_ray(solid, query), query.view);
        oracle::transitions(&solids.models[solid as usize], &ray, |transition| {
            query.offer(solids.candidate(solid, transition, &ray, &view))
        });
    }

    /// `stretch` is where the ray is in the cell.
    fn visit_cell(
        &self,
        solids: &Solids,
        set: &CellSet,
        cell: u32,
        ray: &SolidRay,
        stretch: (f64, f64),
        query: &mut Query,
    ) {
        let cell = &set.cells[cell as usize];
        if solids.is_left_out(cell.solid, query) {
            return;
        }
        let view = query.view;
        let low = stretch.0.max(ray.start);
        let high = stretch.1.min(ray.end);
        if low > high {
            return;
        }
        query.tests += cell.leaf_count();
        let solid = &solids.models[cell.solid as usize];
        let window = Window { low, high, start: ray.start, tolerance: solids.tolerance(cell.solid) };
        let line = Line::new(solid, cell.solid, ray, &view);
        if query.mode == Mode::Collect {
            let mut found = vec![];
            set.transitions(cell, &line, &window, &mut query.scratch, true, |transition| found.push(transition));
            for transition in found {
                query.offer(solids.candidate(cell.solid, transition, ray, &view));
            }
            return;
        }
        let mut found = None;
        set.transitions(cell, &line, &window, &mut query.scratch, false, |transition| found = Some(transition));
        if let Some(transition) = found {
            query.offer(solids.candidate(cell.solid, transition, ray, &view));
        }
    }
}

impl SolidTracer for Local {
    fn primitive_count(&self) -> usize {
        self.cells.cells.len() + self.members.len()
    }

    fn primitive_bounds(&self, solids: &Solids, primitive: u32) -> Aabb {
        match self.cells.cells.get(primitive as usize) {
            Some(cell) => cell.bounds,
            None => self.members.bounds(solids, primitive - self.cells.cells.len() as u32),
        }
    }

    fn cell_count(&self) -> usize {
        self.primitive_count() + self.facet_cells.cells.len()
    }

    fn bytes(&self) -> usize {
        self.cells.bytes()
            + self.members.bytes()
            + self.outer.bytes()
            + self.facet_cells.bytes()
            + size_of_val(&self.facets[..])
    }

    fn visit_open(&self, solids: &Solids, query: &mut Query) {
        for open in &self.open {
            if query.blocked {
                return;
            }
            match *open {
                Open::Whole { solid } => self.visit_whole(solids, solid, query),
                Open::Outer { cell, core } => {
                    let ray = solids.near_ray(self.outer.cells[cell as usize].solid, query);
                    let (low, high) = slab(&core, ray.origin, query.view.inverse_dir);
                    if low <= high && !core.is_empty() {
                        self.visit_cell(solids, &self.outer, cell, &ray, (f64::NEG_INFINITY, low), query);
                        self.visit_cell(solids, &self.outer, cell, &ray, (high, f64::INFINITY), query);
                    } else {
                        self.visit_cell(solids, &self.outer, cell, &ray, (f64::NEG_INFINITY, f64::INFINITY), query);
                    }
                }
            }
        }
    }

    fn visit(&self, solids: &Solids, primitive: u32, query: &mut Query) {
        let Some(cell) = self.cells.cells.get(primitive as usize) else {
            return self.members.visit(solids, primitive - self.cells.cells.len() as u32, query);
        };
        if query.probing {
            return;
        }
        let ray = solids.near_ray(cell.solid, query);
        let stretch = slab(&cell.bounds, ray.origin, query.view.inverse_dir);
        self.visit_cell(solids, &self.cells, primitive, &ray, stretch, query);
    }
}
