//! A KD tree over the leaves of each solid, which is one user primitive of Embree (thesis, section 3.5.3; P. Zajíček's
//! thesis of 2012 applies KD trees to CSG). The leaves in the cells that the ray passes are crossed, all of them, and
//! then the whole operator tree is evaluated.
//!
//! `incremental` is the same with an evaluation that no more looks at the whole tree.

use arsc_geometry::Aabb;

use crate::Budget;
use crate::solid::SolidModel;
use crate::strategies::gather::{Gathered, SolidLine};
use crate::strategies::kd_tree::{KdTree, Mailbox};
use crate::strategies::leaf_boxes;

pub struct SolidKd {
    tree: KdTree,
    /// Leaves that every ray meets.
    everywhere: Vec<u32>,
}

impl SolidKd {
    pub fn new(solid: &SolidModel, budget: &Budget) -> SolidKd {
        let (boxes, everywhere): (Vec<Aabb>, Vec<u32>) = leaf_boxes(solid);
        SolidKd { tree: KdTree::build(&boxes, budget), everywhere }
    }

    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(&self.everywhere[..])
    }

    pub fn cells(&self) -> usize {
        self.tree.cells()
    }

    /// Crosses the leaves that the ray may meet between its start and its end.
    pub fn gather(&self, line: &SolidLine, mailbox: &mut Mailbox, gathered: &mut Gathered) {
        self.everywhere.iter().for_each(|&leaf| gathered.cross(line, leaf));
        let range = (line.ray.start, line.ray.end);
        self.tree.visit(line.ray.origin, line.inverse_dir, range, mailbox, |leaf| gathered.cross(line, leaf));
    }
}
