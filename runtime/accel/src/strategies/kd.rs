//! A KD tree over the leaves of each solid, which is one user primitive of Embree (thesis, section 3.5.3; P. Zajíček's
//! thesis of 2012 applies KD trees to CSG). The leaves in the cells that the ray passes are crossed, all of them, and
//! then the whole operator tree is evaluated.

use arsc_geometry::Aabb;

use crate::solid::{SolidModel, SolidRay};
use crate::strategies::kd_tree::{KdTree, Mailbox};
use crate::strategies::leaf_boxes;
use crate::strategies::operators::Gathered;

pub struct SolidKd {
    tree: KdTree,
    /// Leaves that every ray meets.
    everywhere: Vec<u32>,
}

impl SolidKd {
    pub fn new(solid: &SolidModel) -> SolidKd {
        let (boxes, everywhere): (Vec<Aabb>, Vec<u32>) = leaf_boxes(solid);
        SolidKd { tree: KdTree::build(&boxes), everywhere }
    }

    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(&self.everywhere[..])
    }

    pub fn cells(&self) -> usize {
        self.tree.cells()
    }

    /// Crosses the leaves that the ray may meet between its start and its end.
    pub fn gather(&self, solid: &SolidModel, ray: &SolidRay, mailbox: &mut Mailbox, gathered: &mut Gathered) {
        for &leaf in &self.everywhere {
            gathered.cross(solid, leaf, ray, ray.start, ray.end);
        }
        let range = (ray.start, ray.end);
        self.tree.visit(ray.origin, ray.dir.recip(), range, mailbox, |leaf| {
            gathered.cross(solid, leaf, ray, ray.start, ray.end);
        });
    }
}
