//! Gives every transmissive solid one interior: a medium and an index of refraction, the same at all its inner points.
//!
//! What fills a point of a solid comes from the leaf that holds it and has precedence: the first operand of a
//! difference or an intersection, and the first operand of a union that holds the point. A regularised union has no
//! wall inside, so one of different interiors is taken apart: X ∪ Y becomes the members X and Y, and Boolean
//! operators distribute, (X ∪ Y) − B = X − B, Y − B. Where two members overlap, the earlier one fills the common part
//! and hides the walls of the later one there; the renderer sees to that, for objects of the scene as well.
//! Neighbouring operands of equal interiors stay one solid.
//!
//! Then the materials of walls state what is behind them: the medium, and where a subtrahend covers the wall of
//! another index, the bsdf whose index it is. A material with a medium and without a bsdf becomes inert; a wall
//! without either, cut into a medium, keeps the default bsdf.
//!
//! Rewrites: `split_interiors` (counts the parts), `fill` (counts the leaves).

use arsc_ir::{Bsdf, Ir, Leaf, Material, MaterialId, Node, NodeId, NodeKind, Spectrum};
use rustc_hash::FxHashMap;

use crate::pipeline::Log;
use crate::separate_media::transmissive;

/// Parts of one solid at most: shared operands may multiply them.
const MOST_PARTS: usize = 1 << 16;

/// What fills a solid; opaque ones have neither.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Interior {
    /// Bsdf with the index of refraction.
    index: Option<u32>,
    medium: Option<u32>,
    /// Light gets in.
    transmissive: bool,
}

/// A solid with one interior; `id` is in the frame of the node that it was split from.
#[derive(Clone, Copy, Debug)]
struct Part {
    id: NodeId,
    interior: Interior,
}

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let transmissive = transmissive(&ir);
    let NodeKind::Group(members) = ir.kind(ir.root).clone() else { return ir };
    if !members.iter().any(|id| transmissive[id.index()]) {
        return ir;
    }
    let mut filling =
        Filling { transmissive, parts: FxHashMap::default(), filled: FxHashMap::default(), log, ir: &mut ir };
    let mut out = Vec::with_capacity(members.len());
    for member in members {
        if filling.transmissive[member.index()] && !matches!(filling.ir.kind(member), NodeKind::Group(_)) {
            let parts = filling.split(member);
            if parts.len() > 1 {
                filling.log.fire_times("split_interiors", parts.len());
            }
            for part in parts {
                let id = filling.fill(part.id, part.interior);
                out.push(id);
            }
        } else {
            out.push(member);
        }
    }
    let origin = ir.node(ir.root).origin;
    ir.root = ir.push(Node { kind: NodeKind::Group(out), origin });
    ir
}

struct Filling<'a, 'b> {
    ir: &'a mut Ir,
    /// By node of the source.
    transmissive: Vec<bool>,
    parts: FxHashMap<NodeId, Vec<Part>>,
    filled: FxHashMap<(NodeId, Interior), NodeId>,
    log: &'a mut Log<'b>,
}

impl Filling<'_, '_> {
    fn interior_of(&mut self, material: MaterialId) -> Interior {
        let material = &self.ir.materials[material.0 as usize];
        let bsdf = material.bsdf.map(|bsdf| &self.ir.bsdfs[bsdf as usize]);
        let transmissive = bsdf.map_or(material.medium.is_some(), Bsdf::is_transmissive);
        if !transmissive {
            return Interior::default();
        }
        let medium = material.medium;
        let index = match bsdf {
            // Of what varies, the interface is the same wherever the texture lies.
            Some(Bsdf::Varying(_)) => {
                let interface = bsdf.and_then(Bsdf::interface).cloned();
                interface.map(|interface| position_or_push(&mut self.ir.bsdfs, interface))
            }
            bsdf => material.bsdf.filter(|_| bsdf.is_some_and(Bsdf::has_index)),
        };
        Interior { index, medium, transmissive }
    }

    /// The parts below a node, in the order of precedence. Children first: nothing recurses.
    fn split(&mut self, root: NodeId) -> Vec<Part> {
        let mut stack = vec![(root, false)];
        while let Some((id, ready)) = stack.pop() {
            if self.parts.contains_key(&id) {
                continue;
            }
            let kind = self.ir.kind(id).clone();
            // What decides the interior: all operands of a union, the first of the others.
            let deciding = match &kind {
                NodeKind::Union(operands) => &operands[..],
                kind => kind.children().get(..1).unwrap_or(&[]),
            };
            if !ready && !deciding.is_empty() {
                stack.push((id, true));
                stack.extend(deciding.iter().map(|&child| (child, false)));
                continue;
            }
            let parts = self.join(id, &kind);
            self.parts.insert(id, parts);
        }
        self.parts[&root].clone()
    }

    fn join(&mut self, id: NodeId, kind: &NodeKind) -> Vec<Part> {
        match kind {
            NodeKind::Leaf(leaf) => {
                let interior = match **leaf {
                    Leaf::Solid { material: Some(material), .. } => self.interior_of(material),
                    _ => Interior::default(),
                };
                vec![Part { id, interior }]
            }
            NodeKind::Union(operands) => self.join_union(id, operands),
            NodeKind::Transform { .. } | NodeKind::Intersection(_) | NodeKind::Difference(_) => {
                let below = self.parts[&kind.children()[0]].clone();
                match below[..] {
                    [only] => vec![Part { id, ..only }],
                    _ => below.iter().map(|part| self.with_first(id, kind, part)).collect(),
                }
            }
            NodeKind::Group(_) | NodeKind::Attributes { .. } | NodeKind::Light(_) | NodeKind::Environment(_) => {
                vec![Part { id, interior: Interior::default() }]
            }
        }
    }

    /// Runs of operands that are whole and filled alike stay one union.
    fn join_union(&mut self, id: NodeId, operands: &[NodeId]) -> Vec<Part> {
        let origin = self.ir.node(id).origin;
        let mut runs: Vec<(Interior, Vec<NodeId>)> = Vec::new();
        for operand in operands {
            for part in &self.parts[operand] {
                match runs.last_mut() {
                    Some((interior, run)) if *interior == part.interior => run.push(part.id),
                    _ => runs.push((part.interior, vec![part.id])),
                }
            }
        }
        if runs.len() > MOST_PARTS {
            let parts = runs.len() as u64;
            self.log.too_many_leaves(self.ir, parts);
            runs.truncate(1);
        }
        match &runs[..] {
            [] => vec![Part { id, interior: Interior::default() }],
            [(interior, _)] => vec![Part { id, interior: *interior }],
            _ => runs
                .into_iter()
                .map(|(interior, run)| match run[..] {
                    [only] => Part { id: only, interior },
                    _ => Part { id: self.ir.push(Node { kind: NodeKind::Union(run), origin }), interior },
                })
                .collect(),
        }
    }

    fn with_first(&mut self, id: NodeId, kind: &NodeKind, part: &Part) -> Part {
        let mut kind = kind.clone();
        kind.children_mut()[0] = part.id;
        let origin = self.ir.node(id).origin;
        Part { id: self.ir.push(Node { kind, origin }), interior: part.interior }
    }

    /// The solid with materials that say what is behind their walls.
    fn fill(&mut self, root: NodeId, interior: Interior) -> NodeId {
        let mut stack = vec![(root, false)];
        while let Some((id, ready)) = stack.pop() {
            if self.filled.contains_key(&(id, interior)) {
                continue;
            }
            let Node { mut kind, origin } = self.ir.node(id).clone();
            if !ready && !kind.children().is_empty() {
                stack.push((id, true));
                stack.extend(kind.children().iter().map(|&child| (child, false)));
                continue;
            }
            let changed = match &mut kind {
                NodeKind::Leaf(leaf) => self.fill_leaf(leaf, interior),
                kind => {
                    let mut changed = false;
                    for child in kind.children_mut() {
                        let new = self.filled[&(*child, interior)];
                        changed |= new != *child;
                        *child = new;
                    }
                    changed
                }
            };
            let filled = if changed { self.ir.push(Node { kind, origin }) } else { id };
            self.filled.insert((id, interior), filled);
        }
        self.filled[&(root, interior)]
    }

    fn fill_leaf(&mut self, leaf: &mut Leaf, interior: Interior) -> bool {
        let Leaf::Solid { material: Some(id), .. } = leaf else { return false };
        let new = self.fill_material(*id, interior);
        if new == *id {
            return false;
        }
        self.log.fire("fill");
        *id = new;
        true
    }

    /// The material with its faces; those have none of their own.
    fn fill_material(&mut self, id: MaterialId, interior: Interior) -> MaterialId {
        let mut old = self.ir.materials[id.0 as usize].clone();
        let mut faces = std::mem::take(&mut old.faces);
        faces.iter_mut().for_each(|(_, face)| *face = self.fill_material(*face, interior));
        let bsdf = match old.bsdf {
            None if old.medium.is_some() => Some(self.bsdf(Bsdf::Inert)),
            None if interior.medium.is_some() => {
                Some(self.bsdf(Bsdf::Lambert { reflectance: Spectrum::Constant(0.5) }))
            }
            bsdf => bsdf,
        };
        let has_index = bsdf.is_some_and(|bsdf| self.ir.bsdfs[bsdf as usize].has_index());
        let inside = interior.index.filter(|_| has_index && interior.index != bsdf);
        self.material(Material { bsdf, emitter: old.emitter, medium: interior.medium, inside, faces })
    }

    fn bsdf(&mut self, bsdf: Bsdf) -> u32 {
        position_or_push(&mut self.ir.bsdfs, bsdf)
    }

    fn material(&mut self, material: Material) -> MaterialId {
        MaterialId(position_or_push(&mut self.ir.materials, material))
    }
}

fn position_or_push<T: PartialEq>(table: &mut Vec<T>, value: T) -> u32 {
    let found = table.iter().position(|old| *old == value);
    found.unwrap_or_else(|| {
        table.push(value);
        table.len() - 1
    }) as u32
}
