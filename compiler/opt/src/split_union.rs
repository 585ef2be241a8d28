//! Splits a union at the top level into independent solids where no box of one touches a box of another.
//!
//! Why the picture cannot change. Let S = S₁ ∪ … ∪ Sₙ with pairwise disjoint closed sets Sᵢ, which lie in disjoint
//! closed boxes and so have positive distance. Then the boundary of S is the disjoint union of the boundaries: near a
//! point of ∂Sᵢ, S and Sᵢ are the same set, with the same normal, side and material. The intervals of any line in S
//! are those in the Sᵢ, merged; none of them touch, so merging joins nothing. Hence nearest hits, occlusion, all
//! intervals, light that is inside, and walls between media are the same, wherever the ray starts and whatever the
//! materials are. No faces coincide, so precedence never decides.
//!
//! Overlapping solids stay one union even when all are opaque: there the inner walls would come back, which a camera
//! inside would see, and coincident faces would lose their precedence.
//!
//! The boxes are grown by more than their rounding, so touching solids stay together. Two solids whose boxes overlap
//! are still apart if one is a leaf that lies outside of the other's box. Placed unions inside of the union are taken
//! apart first, unless they are worth an instance.
//!
//! Rewrites: `split_solids` (counts the parts).

use arsc_diagnostics::Span;
use arsc_geometry::{Aabb, Classification, DAffine3};
use arsc_ir::{Ir, Node, NodeId, NodeKind};

use crate::bounds::{bounds, leaf_bounds, padded, place};
use crate::box_tree::{BoxTree, Work};
use crate::fold_transforms::INSTANCE_LEAVES;
use crate::pipeline::Log;

/// An operand of the union with the map above it.
#[derive(Clone, Copy)]
struct Part {
    id: NodeId,
    map: Option<DAffine3>,
}

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let NodeKind::Group(members) = ir.kind(ir.root).clone() else { return ir };
    let local = bounds(&ir);
    let uses = ir.uses();
    let expanded = ir.expanded_leaves();
    let mut split = Vec::with_capacity(members.len());
    for member in members {
        let parts = parts(&ir, member, &uses, &expanded);
        let groups = independent(&ir, &parts, &local);
        if groups.len() < 2 {
            split.push(member);
            continue;
        }
        log.fire_times("split_solids", groups.len());
        let origin = ir.node(member).origin;
        for group in groups {
            split.push(rebuild(&mut ir, &group, origin));
        }
    }
    let origin = ir.node(ir.root).origin;
    ir.root = ir.push(Node { kind: NodeKind::Group(split), origin });
    ir
}

/// The operands of the member and of the unions in it, through transforms.
fn parts(ir: &Ir, member: NodeId, uses: &[u32], expanded: &[u64]) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut stack = vec![Part { id: member, map: None }];
    while let Some(Part { id, map }) = stack.pop() {
        // Shared nodes stay whole, or parts could be exponentially many.
        let dissolve = uses[id.index()] == 1 || expanded[id.index()] < INSTANCE_LEAVES;
        match ir.kind(id) {
            NodeKind::Union(of) if dissolve => {
                stack.extend(of.iter().rev().map(|&id| Part { id, map }));
            }
            NodeKind::Transform { parent_from_child, child } if dissolve => {
                let map = map.map_or(**parent_from_child, |map| map * **parent_from_child);
                stack.push(Part { id: *child, map: Some(map) });
            }
            _ => parts.push(Part { id, map }),
        }
    }
    parts
}

fn part_bounds(ir: &Ir, part: &Part, local: &[Aabb]) -> Aabb {
    match (ir.kind(part.id), &part.map) {
        (NodeKind::Leaf(leaf), Some(map)) => leaf_bounds(leaf, map),
        (_, Some(map)) => local[part.id.index()].transformed(map),
        (_, None) => local[part.id.index()],
    }
}

/// Parts connected by touching boxes, in the order of their first parts; parts within keep their order.
///
/// A pair of touching parts is found by the search of either. Where both searches end early it may be missed, so all
/// parts with such a search stay together.
fn independent(ir: &Ir, parts: &[Part], local: &[Aabb]) -> Vec<Vec<Part>> {
    let boxes: Vec<Aabb> = parts.iter().map(|part| padded(&part_bounds(ir, part, local))).collect();
    let tree = BoxTree::new(&boxes);
    let mut sets = DisjointSets::new(parts.len());
    let mut work = Work::for_searches(parts.len());
    let mut cut_short = None;
    for (i, query) in boxes.iter().enumerate() {
        let complete = tree.overlapping(query, &mut work, |j| {
            if sets.find(i) != sets.find(j) && !apart(ir, [&parts[i], &parts[j]], [query, &boxes[j]]) {
                sets.join(i, j);
            }
            true
        });
        if !complete {
            sets.join(*cut_short.get_or_insert(i), i);
        }
    }
    let mut group_of_root = vec![usize::MAX; parts.len()];
    let mut groups: Vec<Vec<Part>> = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let root = sets.find(i);
        if group_of_root[root] == usize::MAX {
            group_of_root[root] = groups.len();
            groups.push(Vec::new());
        }
        groups[group_of_root[root]].push(*part);
    }
    groups
}

/// One is a leaf that lies outside of the box of the other.
fn apart(ir: &Ir, parts: [&Part; 2], boxes: [&Aabb; 2]) -> bool {
    let outside = |part: &Part, cell: &Aabb| {
        let NodeKind::Leaf(leaf) = ir.kind(part.id) else { return false };
        place(leaf, &part.map.unwrap_or(DAffine3::IDENTITY))
            .is_some_and(|placed| placed.classify(cell) == Classification::Outside)
    };
    outside(parts[0], boxes[1]) || outside(parts[1], boxes[0])
}

fn rebuild(ir: &mut Ir, group: &[Part], origin: Span) -> NodeId {
    let operands: Vec<NodeId> = group
        .iter()
        .map(|part| match part.map {
            None => part.id,
            Some(map) => {
                let kind = NodeKind::Transform { parent_from_child: Box::new(map), child: part.id };
                ir.push(Node { kind, origin: ir.node(part.id).origin })
            }
        })
        .collect();
    match operands[..] {
        [only] => only,
        _ => ir.push(Node { kind: NodeKind::Union(operands), origin }),
    }
}

/// Union–find with path halving; the least index is the root.
struct DisjointSets(Vec<u32>);

impl DisjointSets {
    fn new(length: usize) -> DisjointSets {
        DisjointSets((0..length as u32).collect())
    }

    fn find(&mut self, i: usize) -> usize {
        let mut i = i as u32;
        while self.0[i as usize] != i {
            let parent = self.0[i as usize];
            self.0[i as usize] = self.0[parent as usize];
            i = self.0[i as usize];
        }
        i as usize
    }

    fn join(&mut self, i: usize, j: usize) {
        let (i, j) = (self.find(i), self.find(j));
        self.0[i.max(j)] = i.min(j) as u32;
    }
}
