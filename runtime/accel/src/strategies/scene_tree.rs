//! A KD tree in the frame of a scene, for rays from anywhere.

use glam::DVec3;

use arsc_geometry::Aabb;

use crate::Budget;
use crate::query::View;
use crate::strategies::kd_tree::{KdTree, Mailbox};

/// Origins farther away than so many times the largest coordinate are moved along the ray.
const NEAR: f64 = 16.0;
/// Room around boxes for the roundings of rays that begin there, relative to the largest coordinate.
const ROUNDING: f64 = 1.0 / (1u64 << 44) as f64;

#[derive(Default)]
pub struct SceneTree {
    tree: KdTree,
    reach: f64,
}

impl SceneTree {
    /// `boxes` are finite; numbers are positions in the list.
    pub fn build(boxes: impl Iterator<Item = Aabb>, budget: &Budget) -> SceneTree {
        let mut boxes: Vec<Aabb> = boxes.collect();
        let corner = boxes.iter().fold(DVec3::ZERO, |corner, b| corner.max(b.min.abs()).max(b.max.abs()));
        let magnitude = corner.max_element();
        boxes.iter_mut().for_each(|b| *b = b.dilated(ROUNDING * magnitude));
        SceneTree { tree: KdTree::build(&boxes, budget), reach: NEAR * magnitude }
    }

    /// Calls `visit` once for every box that may be met before the parameter `t_max` of the scene's ray.
    pub fn visit(&self, view: &View, t_max: f64, mailbox: &mut Mailbox, visit: impl FnMut(u32)) {
        let shift = if view.reach <= self.reach {
            0.0
        } else {
            (self.tree.bounds().center() - view.ray.origin).dot(view.ray.dir)
        };
        let range = (-shift, t_max * view.scale - shift);
        self.tree.visit(view.ray.origin + view.ray.dir * shift, view.ray.inverse_dir, range, mailbox, visit);
    }

    pub fn cells(&self) -> usize {
        self.tree.cells()
    }

    pub fn bytes(&self) -> usize {
        self.tree.bytes()
    }
}
