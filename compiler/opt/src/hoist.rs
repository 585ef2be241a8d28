//! Taking what is no solid out of the Boolean trees, to the root group.
//!
//! A light, an environment or an open surface is no set of points, so a Boolean operator does nothing to it: it
//! stays in the scene wherever in the tree it was written, in its place by the transforms above it.

use arsc_geometry::DAffine3;
use arsc_ir::{Ir, Node, NodeId, NodeKind};

use crate::pipeline::Log;

/// Moves every wanted node that is not a member of the root group yet; gives how many.
pub(crate) fn hoist(ir: &mut Ir, wanted: fn(&NodeKind) -> bool, log: &mut Log) -> usize {
    let mut holds = vec![0u64; ir.nodes.len()];
    for (id, node) in ir.nodes.iter().enumerate() {
        let below = node.kind.children().iter().fold(0u64, |sum, child| sum.saturating_add(holds[child.index()]));
        holds[id] = below + u64::from(wanted(&node.kind));
    }
    let total = holds[ir.root.index()];
    if total == 0 {
        return 0;
    }
    if total > log.options.max_leaves {
        log.too_many_leaves(ir, total);
        return 0;
    }
    let found = occurrences(ir, &holds, wanted);
    let root = ir.root;
    remove(ir, &holds, wanted);
    let mut members = match ir.kind(root) {
        NodeKind::Group(members) => members.clone(),
        _ => vec![root],
    };
    members.retain(|&member| !is_wanted_or_gone(ir, member, wanted));
    for (id, map) in &found {
        members.push(match map {
            None => *id,
            Some(map) => {
                let kind = NodeKind::Transform { parent_from_child: Box::new(*map), child: *id };
                ir.push(Node { kind, origin: ir.node(*id).origin })
            }
        });
    }
    let origin = ir.node(root).origin;
    ir.root = ir.push(Node { kind: NodeKind::Group(members), origin });
    found.len()
}

/// Every path from the root to a wanted node, in the order of the tree, with the map along it.
fn occurrences(ir: &Ir, holds: &[u64], wanted: fn(&NodeKind) -> bool) -> Vec<(NodeId, Option<DAffine3>)> {
    let mut found = Vec::new();
    let mut stack = vec![(ir.root, None)];
    while let Some((id, map)) = stack.pop() {
        let kind = ir.kind(id);
        if wanted(kind) {
            found.push((id, map));
            continue;
        }
        let map = match kind {
            NodeKind::Transform { parent_from_child, .. } => {
                Some(map.map_or(**parent_from_child, |map: DAffine3| map * **parent_from_child))
            }
            _ => map,
        };
        let children = kind.children().iter().rev().filter(|child| holds[child.index()] > 0);
        stack.extend(children.map(|&child| (child, map)));
    }
    found
}

/// Drops wanted nodes, and what is left without operands, from the operands of every node.
fn remove(ir: &mut Ir, holds: &[u64], wanted: fn(&NodeKind) -> bool) {
    let mut gone: Vec<bool> = vec![false; ir.nodes.len()];
    for id in 0..ir.nodes.len() {
        if holds[id] == 0 {
            continue;
        }
        let kind = &mut ir.nodes[id].kind;
        gone[id] = match kind {
            NodeKind::Union(operands) | NodeKind::Intersection(operands) | NodeKind::Group(operands) => {
                operands.retain(|operand| !gone[operand.index()]);
                operands.is_empty()
            }
            NodeKind::Difference(operands) => {
                let first_gone = gone[operands[0].index()];
                operands.retain(|operand| !gone[operand.index()]);
                first_gone
            }
            NodeKind::Transform { child, .. } | NodeKind::Attributes { child, .. } => gone[child.index()],
            kind => wanted(kind),
        };
        if gone[id] && !wanted(&ir.nodes[id].kind) {
            ir.nodes[id].kind = NodeKind::Union(Vec::new());
        }
    }
}

fn is_wanted_or_gone(ir: &Ir, id: NodeId, wanted: fn(&NodeKind) -> bool) -> bool {
    wanted(ir.kind(id)) || matches!(ir.kind(id), NodeKind::Union(operands) if operands.is_empty())
}
