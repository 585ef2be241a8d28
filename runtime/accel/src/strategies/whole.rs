//! Solids as single user primitives of Embree, met as a whole (thesis, sections 3.5.2, 3.5.3 and 4.2).
//!
//! The primitive's callback is told how far the nearest hit so far is; beyond it nothing is looked for.

use arsc_geometry::Aabb;

use crate::Budget;
use crate::level::Solids;
use crate::query::{Extent, Query};
use crate::solid::{SolidModel, SolidRay};
use crate::strategies::gather::{Gathered, SolidLine};
use crate::strategies::kd::SolidKd;
use crate::strategies::kd_tree::Mailbox;
use crate::strategies::operators::{Evaluation, Operators, Values};
use crate::strategies::tree::{BoxTree, Open};
use crate::strategies::{PAD, SolidTracer, oracle};

/// Buffers of a thread for evaluations of whole trees.
#[derive(Debug, Default)]
pub struct WholeScratch {
    pub gathered: Gathered,
    pub values: Values,
    pub mailbox: Mailbox,
    pub open: Vec<Open>,
    /// Leaves that a traversal has come to: solid and leaf.
    pub met: Vec<(u32, u32)>,
    /// Boxes of [`plain`](super::plain) that the ray passes.
    pub items: Vec<u32>,
}

impl WholeScratch {
    pub fn clear(&mut self) {
        self.gathered.clear();
        self.met.clear();
    }

    /// Where the collection of a traversal begins: one may run within another.
    pub fn mark(&self) -> usize {
        self.met.len()
    }
}

/// What a solid is met by.
pub enum Structure {
    Oracle,
    Tree(BoxTree, Operators),
    Kd(SolidKd, Operators),
}

impl Structure {
    pub fn tree(solid: &SolidModel, _: &Budget) -> Structure {
        // Nodes are left out by their boxes: what is looked at is not the whole tree.
        Structure::Tree(BoxTree::new(solid, PAD * solid.tolerance), Operators::new(solid, Evaluation::Kept))
    }

    pub fn kd(solid: &SolidModel, budget: &Budget) -> Structure {
        Structure::Kd(SolidKd::new(solid, budget), Operators::new(solid, Evaluation::Whole))
    }

    pub fn incremental(solid: &SolidModel, budget: &Budget) -> Structure {
        Structure::Kd(SolidKd::new(solid, budget), Operators::new(solid, Evaluation::Kept))
    }

    fn bytes(&self) -> usize {
        match self {
            Structure::Oracle => 0,
            Structure::Tree(tree, operators) => tree.bytes() + operators.bytes(),
            Structure::Kd(kd, operators) => kd.bytes() + operators.bytes(),
        }
    }

    fn cells(&self) -> usize {
        match self {
            Structure::Oracle => 1,
            Structure::Tree(tree, _) => tree.len(),
            Structure::Kd(kd, _) => kd.cells(),
        }
    }
}

pub struct PerSolid {
    structures: Vec<Structure>,
    /// Solids that are Embree's primitives.
    primitives: Vec<u32>,
    /// Solids that Embree cannot hold.
    open: Vec<u32>,
}

impl PerSolid {
    pub fn build(solids: &Solids, budget: &Budget, structure: fn(&SolidModel, &Budget) -> Structure) -> PerSolid {
        let shares = solids.shares(budget);
        let structures = solids.models.iter().zip(shares).map(|(solid, share)| structure(solid, &share)).collect();
        let present = solids.numbered().filter(|(_, solid)| !solid.bounds.is_empty());
        let (primitives, open): (Vec<_>, Vec<_>) = present.partition(|(_, solid)| Extent::admits(&solid.bounds));
        let number = |(number, _): (u32, &SolidModel)| number;
        PerSolid {
            structures,
            primitives: primitives.into_iter().map(number).collect(),
            open: open.into_iter().map(number).collect(),
        }
    }

    fn visit_solid(&self, solids: &Solids, solid: u32, query: &mut Query) {
        if solids.is_left_out(solid, query) {
            return;
        }
        let (ray, model) = (solids.near_ray(solid, query), &*solids.models[solid as usize]);
        match &self.structures[solid as usize] {
            Structure::Oracle => {
                let view = query.view;
                query.tests += model.leaves.len() as u32;
                oracle::transitions(model, &ray, |transition| {
                    query.offer(solids.candidate(solid, transition, ray.start, &view))
                });
            }
            Structure::Tree(tree, operators) => evaluate(solids, solid, operators, &ray, query, |line, scratch| {
                tree.gather(line, &mut scratch.open, &mut scratch.mailbox, &mut scratch.gathered);
            }),
            Structure::Kd(kd, operators) => evaluate(solids, solid, operators, &ray, query, |line, scratch| {
                kd.gather(line, &mut scratch.mailbox, &mut scratch.gathered);
            }),
        }
    }
}

/// Gathers the crossings of a solid's leaves, evaluates its tree, and offers what changes.
pub fn evaluate(
    solids: &Solids,
    solid: u32,
    operators: &Operators,
    ray: &SolidRay,
    query: &mut Query,
    gather: impl FnOnce(&SolidLine, &mut WholeScratch),
) {
    // Offering needs the query.
    let mut scratch = std::mem::take(&mut query.scratch.whole);
    let (view, model) = (query.view, &*solids.models[solid as usize]);
    gather(&SolidLine::new(model, &operators.kernels, *ray, &view), &mut scratch);
    let WholeScratch { gathered, values, .. } = &mut scratch;
    query.tests += gathered.tests;
    operators.transitions(model, gathered, values, |transition| {
        query.offer(solids.candidate(solid, transition, ray.start, &view))
    });
    query.scratch.whole = scratch;
}

impl SolidTracer for PerSolid {
    fn primitive_count(&self) -> usize {
        self.primitives.len()
    }

    fn primitive_bounds(&self, solids: &Solids, primitive: u32) -> Aabb {
        let solid = &solids.models[self.primitives[primitive as usize] as usize];
        solid.bounds.dilated(solid.tolerance)
    }

    fn cell_count(&self) -> usize {
        self.structures.iter().map(Structure::cells).sum()
    }

    fn bytes(&self) -> usize {
        self.structures.iter().map(Structure::bytes).sum()
    }

    fn visit_open(&self, solids: &Solids, query: &mut Query) {
        for &solid in &self.open {
            if query.blocked {
                return;
            }
            self.visit_solid(solids, solid, query);
        }
    }

    fn visit(&self, solids: &Solids, primitive: u32, query: &mut Query) {
        self.visit_solid(solids, self.primitives[primitive as usize], query);
    }
}
