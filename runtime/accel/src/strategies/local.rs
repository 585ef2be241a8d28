//! The default: cells with simplified expressions (`crate::cells`) are Embree's primitives, visited front to back.

use arsc_geometry::Aabb;

use crate::Budget;
use crate::cells::{self, Cell, CellSet, Line, Window};
use crate::facets::{self, Facet, mesh_of};
use crate::level::Solids;
use crate::query::{Extent, Mode, PreparedRay, Query, slab};
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

    /// Embree holds everything.
    pub fn is_closed(&self) -> bool {
        self.open.is_empty()
    }

    fn visit_whole(&self, solids: &Solids, solid: u32, query: &mut Query) {
        if solids.is_left_out(solid, query) {
            return;
        }
        query.tests += solids.models[solid as usize].leaves.len() as u32;
        let (ray, view) = (solids.near_ray(solid, query), query.view);
        oracle::transitions(&solids.models[solid as usize], &ray, |transition| {
            query.offer(solids.candidate(solid, transition, ray.start, &view))
        });
    }

    /// `stretch` gives where a ray is in the cell.
    #[inline(always)]
    fn visit_cell(
        solids: &Solids,
        set: &CellSet,
        cell: &Cell,
        query: &mut Query,
        stretch: impl FnOnce(&PreparedRay) -> (f64, f64),
    ) {
        if solids.is_left_out(cell.solid, query) {
            return;
        }
        let end = query.limit() * query.view.scale;
        let mut moved = None;
        let (ray, start) = solids.near(cell.solid, &query.view, &mut moved);
        let (low, high) = stretch(ray);
        let (low, high) = (low.max(start), high.min(start + end));
        if low > high {
            return;
        }
        query.tests += cell.leaf_count();
        let window = Window { low, high, start, tolerance: solids.tolerance(cell.solid) };
        let line = Line::new(&solids.models[cell.solid as usize], cell.solid, ray, &query.view);
        if query.mode == Mode::Collect {
            let mut found = vec![];
            set.transitions(cell, &line, &window, &mut query.scratch, true, |transition| found.push(transition));
            for transition in found {
                query.offer(solids.candidate(cell.solid, transition, start, &query.view));
            }
        } else if let Some(transition) = set.first(cell, &line, &window, &mut query.scratch) {
            query.offer(solids.candidate(cell.solid, transition, start, &query.view));
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
                    let cell = &self.outer.cells[cell as usize];
                    // Before the core, and behind it.
                    for behind in [false, true] {
                        Local::visit_cell(solids, &self.outer, cell, query, |ray| {
                            let (low, high) = slab(&core, ray.origin, ray.inverse_dir);
                            let passes = low <= high && !core.is_empty();
                            match behind {
                                false if passes => (f64::NEG_INFINITY, low),
                                false => (f64::NEG_INFINITY, f64::INFINITY),
                                true if passes => (high, f64::INFINITY),
                                true => (f64::INFINITY, f64::NEG_INFINITY),
                            }
                        });
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
        Local::visit_cell(solids, &self.cells, cell, query, |ray| slab(&cell.bounds, ray.origin, ray.inverse_dir));
    }
}
