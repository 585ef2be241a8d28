//! Nested Boolean nodes of one kind become n-ary; differences of differences become one.
//!
//! `(A ∪ B) ∪ C → A ∪ B ∪ C`, likewise for intersections; `(A − B) − C → A − B − C`, which stands for A − (B ∪ C);
//! `A − (B ∪ C) → A − B − C`. Operands keep their order, so precedence stays: where walls of B and C coincide, B's
//! shows both before and after. A node that has other users stays as it is.
//!
//! Rewrites: `union_in_union`, `intersection_in_intersection`, `difference_in_minuend`, `union_in_subtrahend`,
//! `single_operand`.

use arsc_ir::{Ir, NodeId, NodeKind};

use crate::pipeline::Log;

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let uses = ir.uses();
    let mut absorbed = vec![false; ir.nodes.len()];
    let inner = |ir: &Ir, id: NodeId, same: fn(&NodeKind) -> bool| uses[id.index()] == 1 && same(ir.kind(id));
    for id in (0..ir.nodes.len()).rev() {
        if uses[id] == 0 || absorbed[id] {
            continue;
        }
        let mut operands = Vec::new();
        let mut absorb = |id: NodeId, rewrite: &'static str| {
            absorbed[id.index()] = true;
            log.fire(rewrite);
        };
        match &ir.nodes[id].kind {
            NodeKind::Union(of) => gather(&ir, of, is_union, &uses, "union_in_union", &mut operands, &mut absorb),
            NodeKind::Intersection(of) => {
                let rewrite = "intersection_in_intersection";
                gather(&ir, of, is_intersection, &uses, rewrite, &mut operands, &mut absorb);
            }
            NodeKind::Difference(of) => {
                let mut chain = vec![of];
                while let Some(NodeKind::Difference(of)) =
                    chain.last().map(|of| of[0]).filter(|&id| inner(&ir, id, is_difference)).map(|id| ir.kind(id))
                {
                    absorb(chain[chain.len() - 1][0], "difference_in_minuend");
                    chain.push(of);
                }
                operands.push(chain[chain.len() - 1][0]);
                for of in chain.iter().rev() {
                    gather(&ir, &of[1..], is_union, &uses, "union_in_subtrahend", &mut operands, &mut absorb);
                }
            }
            _ => continue,
        }
        if let NodeKind::Union(of) | NodeKind::Intersection(of) | NodeKind::Difference(of) = &mut ir.nodes[id].kind {
            *of = operands;
        }
    }
    ir.compact();
    collapse(&mut ir, log);
    ir
}

fn is_union(kind: &NodeKind) -> bool {
    matches!(kind, NodeKind::Union(_))
}

fn is_intersection(kind: &NodeKind) -> bool {
    matches!(kind, NodeKind::Intersection(_))
}

fn is_difference(kind: &NodeKind) -> bool {
    matches!(kind, NodeKind::Difference(_))
}

/// The operands with those of unshared inner nodes of the kind in their place, in order.
fn gather(
    ir: &Ir,
    of: &[NodeId],
    same: fn(&NodeKind) -> bool,
    uses: &[u32],
    rewrite: &'static str,
    operands: &mut Vec<NodeId>,
    absorb: &mut impl FnMut(NodeId, &'static str),
) {
    let mut stack: Vec<NodeId> = of.iter().rev().copied().collect();
    while let Some(id) = stack.pop() {
        if uses[id.index()] == 1 && same(ir.kind(id)) {
            absorb(id, rewrite);
            stack.extend(ir.kind(id).children().iter().rev());
        } else {
            operands.push(id);
        }
    }
}

/// A Boolean node with one operand is that operand.
pub(crate) fn collapse(ir: &mut Ir, log: &mut Log) {
    let mut target: Vec<NodeId> = (0..ir.nodes.len() as u32).map(NodeId).collect();
    let mut collapsed = 0;
    for id in 0..ir.nodes.len() {
        let kind = &mut ir.nodes[id].kind;
        for child in kind.children_mut() {
            *child = target[child.index()];
        }
        if let NodeKind::Union(of) | NodeKind::Intersection(of) | NodeKind::Difference(of) = kind
            && let [only] = of[..]
        {
            target[id] = only;
            collapsed += 1;
        }
    }
    log.fire_times("single_operand", collapsed);
    ir.root = target[ir.root.index()];
}
