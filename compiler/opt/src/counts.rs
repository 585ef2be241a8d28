//! How large an IR is.

use arsc_ir::{Ir, NodeKind};

/// Node counts of an IR by kind, reachable from the root; a shared node counts once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub leaves: usize,
    pub unions: usize,
    pub intersections: usize,
    pub differences: usize,
    pub groups: usize,
    pub transforms: usize,
    pub attributes: usize,
    pub lights: usize,
    pub environments: usize,
    /// Nodes on the longest path from the root.
    pub depth: usize,
}

impl Counts {
    pub fn of(ir: &Ir) -> Counts {
        let mut counts = Counts::default();
        let mut depth = vec![0u32; ir.nodes.len()];
        depth[ir.root.index()] = 1;
        for (id, node) in ir.nodes.iter().enumerate().rev() {
            if depth[id] == 0 {
                continue;
            }
            *counts.slot(&node.kind) += 1;
            counts.depth = counts.depth.max(depth[id] as usize);
            for child in node.kind.children() {
                depth[child.index()] = depth[child.index()].max(depth[id] + 1);
            }
        }
        counts
    }

    /// All nodes.
    pub fn total(&self) -> usize {
        self.leaves
            + self.unions
            + self.intersections
            + self.differences
            + self.groups
            + self.transforms
            + self.attributes
            + self.lights
            + self.environments
    }

    fn slot(&mut self, kind: &NodeKind) -> &mut usize {
        match kind {
            NodeKind::Leaf(_) => &mut self.leaves,
            NodeKind::Union(_) => &mut self.unions,
            NodeKind::Intersection(_) => &mut self.intersections,
            NodeKind::Difference(_) => &mut self.differences,
            NodeKind::Group(_) => &mut self.groups,
            NodeKind::Transform { .. } => &mut self.transforms,
            NodeKind::Attributes { .. } => &mut self.attributes,
            NodeKind::Light(_) => &mut self.lights,
            NodeKind::Environment(_) => &mut self.environments,
        }
    }
}
