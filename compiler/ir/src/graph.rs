//! The node table as a graph: children, reachability, compaction.
//!
//! Children come before parents, so a loop over the table from front to back sees children first and one from back
//! to front sees parents first. Nothing here recurses: chains may be as long as memory allows.

use crate::{Ir, Node, NodeId, NodeKind};

impl NodeKind {
    /// The operands, in order.
    pub fn children(&self) -> &[NodeId] {
        match self {
            NodeKind::Union(children)
            | NodeKind::Intersection(children)
            | NodeKind::Difference(children)
            | NodeKind::Group(children) => children,
            NodeKind::Transform { child, .. } | NodeKind::Attributes { child, .. } => std::slice::from_ref(child),
            NodeKind::Leaf(_) | NodeKind::Light(_) | NodeKind::Environment(_) => &[],
        }
    }

    /// The operands, in order, to be redirected.
    pub fn children_mut(&mut self) -> &mut [NodeId] {
        match self {
            NodeKind::Union(children)
            | NodeKind::Intersection(children)
            | NodeKind::Difference(children)
            | NodeKind::Group(children) => children,
            NodeKind::Transform { child, .. } | NodeKind::Attributes { child, .. } => std::slice::from_mut(child),
            NodeKind::Leaf(_) | NodeKind::Light(_) | NodeKind::Environment(_) => &mut [],
        }
    }
}

impl NodeId {
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl Ir {
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.index()]
    }

    pub fn kind(&self, id: NodeId) -> &NodeKind {
        &self.nodes[id.index()].kind
    }

    /// Appends a node whose children are already there.
    pub fn push(&mut self, node: Node) -> NodeId {
        debug_assert!(node.kind.children().iter().all(|child| child.index() < self.nodes.len()));
        self.nodes.push(node);
        NodeId(self.nodes.len() as u32 - 1)
    }

    /// Which nodes the root needs.
    pub fn reachable(&self) -> Vec<bool> {
        let mut reachable = vec![false; self.nodes.len()];
        reachable[self.root.index()] = true;
        for id in (0..self.nodes.len()).rev() {
            if reachable[id] {
                for child in self.nodes[id].kind.children() {
                    reachable[child.index()] = true;
                }
            }
        }
        reachable
    }

    /// How often each node is an operand of reachable nodes (the root counts as used once).
    pub fn uses(&self) -> Vec<u32> {
        let mut uses = vec![0u32; self.nodes.len()];
        uses[self.root.index()] = 1;
        for id in (0..self.nodes.len()).rev() {
            if uses[id] > 0 {
                for child in self.nodes[id].kind.children() {
                    uses[child.index()] = uses[child.index()].saturating_add(1);
                }
            }
        }
        uses
    }

    /// Drops what the root does not need; the order of the rest stays.
    pub fn compact(&mut self) {
        let reachable = self.reachable();
        if reachable.iter().all(|&r| r) {
            return;
        }
        let mut renumbered = vec![NodeId(u32::MAX); self.nodes.len()];
        for (new, old) in (0..self.nodes.len()).filter(|&id| reachable[id]).enumerate() {
            renumbered[old] = NodeId(new as u32);
        }
        let mut id = 0;
        self.nodes.retain(|_| {
            id += 1;
            reachable[id - 1]
        });
        for node in &mut self.nodes {
            for child in node.kind.children_mut() {
                *child = renumbered[child.index()];
            }
        }
        self.root = renumbered[self.root.index()];
    }

    /// For each node, how many leaves, lights and environments a tree without sharing would have; saturating.
    pub fn expanded_leaves(&self) -> Vec<u64> {
        let mut counts = vec![0u64; self.nodes.len()];
        for (id, node) in self.nodes.iter().enumerate() {
            let children = node.kind.children();
            counts[id] = match &node.kind {
                NodeKind::Leaf(_) | NodeKind::Light(_) | NodeKind::Environment(_) => 1,
                _ => children.iter().fold(0, |sum, child| sum.saturating_add(counts[child.index()])),
            };
        }
        counts
    }
}
