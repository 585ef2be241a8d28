//! The stand-in for a renderer without Embree (thesis, section 2.2.3): one KD tree of our own over the leaves of all solids.
//!
//! The ray is followed to its end, whatever it meets on the way, and all leaves in the cells that it passes are
//! crossed; then the whole operator trees are evaluated. Shadow rays are no different, but end at the light.

use glam::DVec3;

use arsc_geometry::Aabb;

use crate::Budget;
use crate::level::Solids;
use crate::query::Query;
use crate::strategies::SolidTracer;
use crate::strategies::collected::{Collected, SolidLeaf};
use crate::strategies::kd_tree::KdTree;

/// Origins farther away than so many times the largest coordinate are moved along the ray.
const NEAR: f64 = 16.0;
/// Room around boxes for the roundings of rays that begin there, relative to the largest coordinate.
const ROUNDING: f64 = 1.0 / (1u64 << 44) as f64;

pub struct Native {
    collected: Collected,
    tree: KdTree,
    /// What is in the tree.
    leaves: Vec<SolidLeaf>,
    reach: f64,
}

impl Native {
    pub fn build(solids: &Solids, budget: &Budget) -> Native {
        let (collected, boxed) = Collected::build(solids);
        let corner = boxed.iter().fold(DVec3::ZERO, |corner, (_, b)| corner.max(b.min.abs()).max(b.max.abs()));
        let magnitude = corner.max_element();
        let boxes: Vec<Aabb> = boxed.iter().map(|(_, b)| b.dilated(ROUNDING * magnitude)).collect();
        let leaves = boxed.iter().map(|&(leaf, _)| leaf).collect();
        Native { collected, tree: KdTree::build(&boxes, budget), leaves, reach: NEAR * magnitude }
    }
}

impl SolidTracer for Native {
    fn primitive_count(&self) -> usize {
        0
    }

    fn primitive_bounds(&self, _: &Solids, _: u32) -> Aabb {
        Aabb::EMPTY
    }

    fn cell_count(&self) -> usize {
        self.tree.cells()
    }

    fn bytes(&self) -> usize {
        self.collected.bytes() + self.tree.bytes() + size_of_val(&self.leaves[..])
    }

    /// All there is: Embree holds nothing.
    fn visit_open(&self, solids: &Solids, query: &mut Query) {
        let (view, t_max) = (query.view, query.ray.t_max);
        let shift = if view.origin.abs().max_element() <= self.reach {
            0.0
        } else {
            (self.tree.bounds().center() - view.origin).dot(view.dir)
        };
        let origin = view.origin + view.dir * shift;
        let range = (-shift, t_max * view.scale - shift);
        let mark = query.scratch.whole.mark();
        let whole = &mut query.scratch.whole;
        let (mailbox, met) = (&mut whole.mailbox, &mut whole.met);
        self.tree.visit(origin, view.inverse_dir, range, mailbox, |number| met.push(self.leaves[number as usize]));
        self.collected.finish(solids, mark, t_max, query);
    }

    fn visit(&self, _: &Solids, _: u32, _: &mut Query) {}
}
