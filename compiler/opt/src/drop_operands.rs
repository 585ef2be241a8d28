//! Drops operands that boxes prove to be empty, full, or absorbed by another.
//!
//! Each node has a context, the box in which its points matter (`bound_unbounded`). A leaf outside of its context
//! is *empty* there, one that covers it is *full*; Boolean nodes follow: a union is full when an operand is, an
//! intersection empty, a difference empty when its minuend is or a subtrahend is full. In a union, an operand whose box
//! lies inside of another operand is absorbed.
//!
//! All proofs keep a distance ([`pad`](crate::bounds::pad)): touching solids are left alone. So nothing dropped has a
//! face that coincides with one that stays, and no face that shows changes its material.
//!
//! Rewrites: `empty_operand`, `full_operand`, `empty_intersection`, `empty_difference`, `full_union`,
//! `absorbed_operand`, `repeated_operand`, `empty_solid`, `single_operand`.

use arsc_geometry::{Aabb, Classification, DAffine3};
use arsc_ir::{Ir, Leaf, NodeId, NodeKind};
use rustc_hash::FxHashSet;

use crate::bound_unbounded::contexts;
use crate::bounds::{bounds, padded, place};
use crate::box_tree::{BoxTree, Work};
use crate::flatten::collapse;
use crate::pipeline::Log;

/// Candidates looked at per operand of a union.
const CANDIDATES: usize = 32;
/// Nodes looked at per operand of a union, on average.
const VISITS: usize = 256;
/// Trees are searched this deep for a proof that a box is inside.
const PROOF_DEPTH: usize = 32;

/// What a node is within its context.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Value {
    Empty,
    Full,
    Some,
}

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let bounds = bounds(&ir);
    let contexts = contexts(&ir, &bounds);
    let uses = ir.uses();
    let mut values: Vec<Value> = Vec::with_capacity(ir.nodes.len());
    for id in 0..ir.nodes.len() {
        if uses[id] == 0 {
            values.push(Value::Some);
            continue;
        }
        let value = value_of(&ir.nodes[id].kind, &contexts[id], &values);
        simplify(&mut ir.nodes[id].kind, value, &values, log);
        values.push(value);
        if let NodeKind::Union(of) = &ir.nodes[id].kind
            && of.len() > 1
        {
            let kept = without_absorbed(&ir, of, &bounds, log);
            ir.nodes[id].kind = NodeKind::Union(kept);
        }
    }
    ir.compact();
    collapse(&mut ir, log);
    ir
}

/// The value of a leaf in its context.
pub(crate) fn leaf_value(leaf: &Leaf, context: &Aabb) -> Value {
    let Some(placed) = place(leaf, &DAffine3::IDENTITY) else { return Value::Some };
    match placed.classify(&padded(context)) {
        Classification::Outside => Value::Empty,
        Classification::Inside => Value::Full,
        Classification::Boundary => Value::Some,
    }
}

/// The value of a node whose operands' values are known.
pub(crate) fn value_of(kind: &NodeKind, context: &Aabb, values: &[Value]) -> Value {
    let value = |operand: &NodeId| values[operand.index()];
    let any = |of: &[NodeId], wanted: Value| of.iter().any(|operand| value(operand) == wanted);
    let all = |of: &[NodeId], wanted: Value| of.iter().all(|operand| value(operand) == wanted);
    match kind {
        NodeKind::Leaf(leaf) => leaf_value(leaf, context),
        NodeKind::Union(of) if any(of, Value::Full) => Value::Full,
        NodeKind::Union(of) if all(of, Value::Empty) => Value::Empty,
        NodeKind::Intersection(of) if any(of, Value::Empty) => Value::Empty,
        NodeKind::Intersection(of) if all(of, Value::Full) => Value::Full,
        NodeKind::Difference(of) if value(&of[0]) == Value::Empty || any(&of[1..], Value::Full) => Value::Empty,
        NodeKind::Difference(of) if all(&of[1..], Value::Empty) => value(&of[0]),
        NodeKind::Transform { child, .. } if value(child) == Value::Empty => Value::Empty,
        _ => Value::Some,
    }
}

/// Drops operands in place; the node's value in its context stays.
fn simplify(kind: &mut NodeKind, result: Value, values: &[Value], log: &mut Log) {
    let value = |operand: NodeId| values[operand.index()];
    match kind {
        NodeKind::Union(of) if result == Value::Full && of.len() > 1 => {
            log.fire("full_union");
            of.retain(|&operand| value(operand) == Value::Full);
            of.truncate(1);
        }
        NodeKind::Union(of) => drop_all(of, |operand| value(operand) == Value::Empty, "empty_operand", log),
        NodeKind::Intersection(_) if result == Value::Empty => log.fire("empty_intersection"),
        NodeKind::Intersection(of) if result == Value::Some => {
            drop_all(of, |operand| value(operand) == Value::Full, "full_operand", log);
        }
        NodeKind::Difference(_) if result == Value::Empty => log.fire("empty_difference"),
        NodeKind::Difference(of) => {
            let mut subtrahends = of.split_off(1);
            drop_all(&mut subtrahends, |operand| value(operand) == Value::Empty, "empty_operand", log);
            of.append(&mut subtrahends);
        }
        NodeKind::Group(of) => drop_all(of, |member| value(member) == Value::Empty, "empty_solid", log),
        _ => {}
    }
}

fn drop_all(of: &mut Vec<NodeId>, unwanted: impl Fn(NodeId) -> bool, rewrite: &'static str, log: &mut Log) {
    let before = of.len();
    of.retain(|&operand| !unwanted(operand));
    log.fire_times(rewrite, before - of.len());
}

fn without_absorbed(ir: &Ir, of: &[NodeId], bounds: &[Aabb], log: &mut Log) -> Vec<NodeId> {
    let mut seen = FxHashSet::default();
    let mut kept: Vec<NodeId> = of.iter().copied().filter(|&operand| seen.insert(operand)).collect();
    log.fire_times("repeated_operand", of.len() - kept.len());
    let absorbed = absorbed(ir, &kept, bounds);
    log.fire_times("absorbed_operand", absorbed.iter().flatten().count());
    let mut absorbed = absorbed.into_iter();
    kept.retain(|_| absorbed.next().flatten().is_none());
    kept
}

/// For each operand of a union, another operand inside of which its box lies, as far as a bounded search finds one.
///
/// Being inside is strict, so the relation has no cycles and its last elements stay.
pub(crate) fn absorbed(ir: &Ir, of: &[NodeId], bounds: &[Aabb]) -> Vec<Option<usize>> {
    let boxes: Vec<Aabb> = of.iter().map(|operand| bounds[operand.index()]).collect();
    let tree = BoxTree::new(&boxes);
    let mut work = Work::for_searches(of.len());
    let mut proof = Proof { ir, visits: VISITS * of.len() };
    let mut absorber = |i: usize| {
        let cell = padded(&boxes[i]);
        let mut candidates = CANDIDATES;
        let mut found = None;
        tree.containing(&cell, &mut work, |j| {
            if j != i {
                candidates -= 1;
                if proof.inside(of[j], &cell, 0) {
                    found = Some(j);
                }
            }
            found.is_none() && candidates > 0
        });
        found
    };
    (0..of.len()).map(|i| if boxes[i].is_finite() { absorber(i) } else { None }).collect()
}

/// Proofs about boxes and whole trees, with a budget.
pub(crate) struct Proof<'a> {
    pub ir: &'a Ir,
    /// Nodes that may still be looked at.
    pub visits: usize,
}

impl Proof<'_> {
    /// The box certainly lies in the solid.
    pub fn inside(&mut self, id: NodeId, cell: &Aabb, depth: usize) -> bool {
        if !self.visit(depth) {
            return false;
        }
        let ir = self.ir;
        match ir.kind(id) {
            NodeKind::Leaf(leaf) => classify(leaf, cell) == Classification::Inside,
            NodeKind::Union(of) => self.any(of, |proof, operand| proof.inside(operand, cell, depth + 1)),
            NodeKind::Intersection(of) => of.iter().all(|&operand| self.inside(operand, cell, depth + 1)),
            NodeKind::Difference(of) => {
                self.inside(of[0], cell, depth + 1)
                    && of[1..].iter().all(|&operand| self.outside(operand, cell, depth + 1))
            }
            _ => false,
        }
    }

    /// The box certainly lies outside of the solid.
    fn outside(&mut self, id: NodeId, cell: &Aabb, depth: usize) -> bool {
        if !self.visit(depth) {
            return false;
        }
        let ir = self.ir;
        match ir.kind(id) {
            NodeKind::Leaf(leaf) => classify(leaf, cell) == Classification::Outside,
            NodeKind::Union(of) => of.iter().all(|&operand| self.outside(operand, cell, depth + 1)),
            NodeKind::Intersection(of) => self.any(of, |proof, operand| proof.outside(operand, cell, depth + 1)),
            NodeKind::Difference(of) => self.outside(of[0], cell, depth + 1),
            _ => false,
        }
    }

    fn visit(&mut self, depth: usize) -> bool {
        let may = depth <= PROOF_DEPTH && self.visits > 0;
        self.visits -= usize::from(may);
        may
    }

    /// Any operand, looked at until the budget ends.
    fn any(&mut self, of: &[NodeId], mut holds: impl FnMut(&mut Self, NodeId) -> bool) -> bool {
        for &operand in of {
            if self.visits == 0 {
                return false;
            }
            if holds(self, operand) {
                return true;
            }
        }
        false
    }
}

fn classify(leaf: &Leaf, cell: &Aabb) -> Classification {
    place(leaf, &DAffine3::IDENTITY).map_or(Classification::Boundary, |placed| placed.classify(cell))
}
