//! What the lints know about the scene: boxes, contexts, objects, membership.

use arsc_diagnostics::Span;
use arsc_geometry::{Aabb, DAffine3, DVec3};
use arsc_ir::{Ir, Leaf, Material, NodeId, NodeKind};

use crate::bound_unbounded::contexts;
use crate::bounds::{bounds, place};
use crate::drop_operands::{Value, value_of};
use crate::separate_media::transmissive;
use crate::share_subtrees::canonical_geometry;

/// Deeper trees have no answer.
const MAX_DEPTH: usize = 1000;
/// Nodes looked at for all membership tests of one lint.
const MEMBERSHIP_VISITS: u64 = 3_000_000;

pub(super) struct Survey<'a> {
    pub ir: &'a Ir,
    pub bounds: Vec<Aabb>,
    /// Proved by boxes within each node's context.
    pub values: Vec<Value>,
    pub transmissive: Vec<bool>,
    /// Solids of the scene: members of the root group, and of unions right below it.
    pub objects: Vec<NodeId>,
    /// Open surfaces of the scene.
    pub surfaces: Vec<NodeId>,
    /// For each node the first one with the same geometry, whatever the materials are.
    pub canonical: Vec<NodeId>,
}

impl<'a> Survey<'a> {
    pub fn new(ir: &'a Ir) -> Survey<'a> {
        let bounds = bounds(ir);
        let contexts = contexts(ir, &bounds);
        let mut values = Vec::with_capacity(ir.nodes.len());
        for (node, context) in ir.nodes.iter().zip(&contexts) {
            let value = value_of(&node.kind, context, &values);
            values.push(value);
        }
        let (mut objects, mut surfaces) = (Vec::new(), Vec::new());
        for &member in ir.kind(ir.root).children() {
            match ir.kind(member) {
                NodeKind::Union(of) => objects.extend(of),
                NodeKind::Leaf(leaf) if matches!(**leaf, Leaf::Surface { .. }) => surfaces.push(member),
                NodeKind::Light(_) | NodeKind::Environment(_) | NodeKind::Transform { .. } => {}
                _ => objects.push(member),
            }
        }
        Survey {
            transmissive: transmissive(ir),
            canonical: canonical_geometry(ir),
            ir,
            bounds,
            values,
            objects,
            surfaces,
        }
    }

    pub fn origin(&self, id: NodeId) -> Span {
        self.ir.node(id).origin
    }

    pub fn material(&self, leaf: &Leaf) -> Option<&'a Material> {
        let (Leaf::Solid { material, .. } | Leaf::Surface { material, .. }) = leaf;
        material.map(|id| &self.ir.materials[id.0 as usize])
    }

    /// A leaf that emits.
    pub fn emits(&self, id: NodeId) -> bool {
        match self.ir.kind(id) {
            NodeKind::Leaf(leaf) => self.material(leaf).is_some_and(|material| {
                let shown = material.faces.iter().map(|(_, id)| &self.ir.materials[id.0 as usize]);
                shown.chain([material]).any(|material| material.emitter.is_some())
            }),
            _ => false,
        }
    }

    /// The solid leaves below a node, in order; `None` if more than `limit`.
    pub fn leaves(&self, id: NodeId, limit: usize) -> Option<Vec<NodeId>> {
        let mut leaves = Vec::new();
        let mut visited = 0;
        let mut stack = vec![id];
        while let Some(id) = stack.pop() {
            visited += 1;
            if visited > 4 * limit {
                return None;
            }
            match self.ir.kind(id) {
                NodeKind::Leaf(_) => leaves.push(id),
                kind => stack.extend(kind.children().iter().rev()),
            }
        }
        (leaves.len() <= limit).then_some(leaves)
    }
}

/// Whether points are in solids, answered as long as the budget lasts.
pub(super) struct Membership<'a> {
    survey: &'a Survey<'a>,
    visits_left: u64,
}

impl<'a> Membership<'a> {
    pub fn new(survey: &'a Survey<'a>) -> Membership<'a> {
        Membership { survey, visits_left: MEMBERSHIP_VISITS }
    }

    pub fn is_spent(&self) -> bool {
        self.visits_left == 0
    }

    /// `None` when the tree is too deep, a map too extreme, or the budget spent.
    pub fn contains(&mut self, id: NodeId, p: DVec3) -> Option<bool> {
        self.contains_below(id, p, 0)
    }

    fn contains_below(&mut self, id: NodeId, p: DVec3, depth: usize) -> Option<bool> {
        if depth > MAX_DEPTH || self.is_spent() {
            return None;
        }
        self.visits_left -= 1;
        let survey = self.survey;
        if !survey.bounds[id.index()].contains(p) {
            return Some(false);
        }
        match survey.ir.kind(id) {
            NodeKind::Leaf(leaf) => place(leaf, &DAffine3::IDENTITY).map(|placed| placed.contains(p)),
            NodeKind::Union(of) => self.any(of, true, p, depth),
            NodeKind::Intersection(of) => self.any(of, false, p, depth).map(|outside| !outside),
            NodeKind::Difference(of) => {
                let inside = self.contains_below(of[0], p, depth + 1)?;
                Some(inside && !self.any(&of[1..], true, p, depth)?)
            }
            _ => None,
        }
    }

    /// Some operand answers as wanted.
    fn any(&mut self, of: &[NodeId], wanted: bool, p: DVec3, depth: usize) -> Option<bool> {
        for &operand in of {
            if self.contains_below(operand, p, depth + 1)? == wanted {
                return Some(true);
            }
        }
        Some(false)
    }
}
