//! The stand-in for a renderer without Embree (thesis, section 2.2.3): one KD tree of our own over the leaves of all solids.
//!
//! The ray is followed to its end, whatever it meets on the way, and all leaves in the cells that it passes are
//! crossed; then the whole operator trees are evaluated. Shadow rays are no different, but end at the light. Open surfaces
//! and instances are in a second tree ([`plain`](super::plain)); Embree is given nothing.

use arsc_geometry::Aabb;

use crate::Budget;
use crate::level::Solids;
use crate::query::Query;
use crate::strategies::SolidTracer;
use crate::strategies::collected::{Collected, SolidLeaf};
use crate::strategies::scene_tree::SceneTree;

pub struct Native {
    collected: Collected,
    tree: SceneTree,
    /// What is in the tree.
    leaves: Vec<SolidLeaf>,
}

impl Native {
    pub fn build(solids: &Solids, budget: &Budget) -> Native {
        let (collected, boxed) = Collected::build(solids);
        let tree = SceneTree::build(boxed.iter().map(|&(_, bounds)| bounds), budget);
        let leaves = boxed.iter().map(|&(leaf, _)| leaf).collect();
        Native { collected, tree, leaves }
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
        let mark = query.scratch.whole.mark();
        let whole = &mut query.scratch.whole;
        let (mailbox, met) = (&mut whole.mailbox, &mut whole.met);
        self.tree.visit(&view, t_max, mailbox, |number| met.push(self.leaves[number as usize]));
        self.collected.finish(solids, mark, t_max, query);
    }

    fn visit(&self, _: &Solids, _: u32, _: &mut Query) {}
}
