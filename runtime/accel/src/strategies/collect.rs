//! Embree finds the leaves, the tree is evaluated afterwards (thesis, section 3.5.1; M. Karaffová's thesis of 2016).
//!
//! Every leaf is a user primitive. Its callback only takes note of it and never shortens the ray, because a hit of a leaf
//! need not be one of its solid; open surfaces that Embree meets do shorten it. When the traversal is over the leaves
//! are put together by solid, crossed, and each solid's operator tree is evaluated.

use arsc_geometry::Aabb;

use crate::level::Solids;
use crate::query::Query;
use crate::strategies::SolidTracer;
use crate::strategies::collected::{Collected, SolidLeaf};

pub struct Collect {
    collected: Collected,
    /// Embree's primitives.
    leaves: Vec<(SolidLeaf, Aabb)>,
}

impl Collect {
    pub fn build(solids: &Solids) -> Collect {
        let (collected, leaves) = Collected::build(solids);
        Collect { collected, leaves }
    }

    /// Evaluates what the traversal has met since `mark`.
    pub fn finish(&self, solids: &Solids, mark: usize, query: &mut Query) {
        if !query.blocked {
            self.collected.finish(solids, mark, query.limit(), query);
        }
    }
}

impl SolidTracer for Collect {
    fn primitive_count(&self) -> usize {
        self.leaves.len()
    }

    fn primitive_bounds(&self, _: &Solids, primitive: u32) -> Aabb {
        self.leaves[primitive as usize].1
    }

    fn bytes(&self) -> usize {
        self.collected.bytes() + size_of_val(&self.leaves[..])
    }

    fn visit_open(&self, _: &Solids, _: &mut Query) {}

    fn visit(&self, solids: &Solids, primitive: u32, query: &mut Query) {
        let leaf = self.leaves[primitive as usize].0;
        if !solids.is_left_out(leaf.0, query) {
            query.scratch.whole.met.push(leaf);
        }
    }
}
