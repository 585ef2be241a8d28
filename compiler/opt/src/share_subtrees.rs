//! Equal subtrees become one node.
//!
//! Two nodes are equal when their kinds, numbers and materials are and their operands are the same nodes, so equality
//! of whole subtrees is found from the leaves up in one walk. The origin of the first is kept.
//!
//! Rewrite: `share`.

use std::hash::{Hash, Hasher};

use arsc_geometry::{DAffine3, DVec3};
use arsc_ir::{Ir, Leaf, NodeId, NodeKind, Shape, Surface};
use rustc_hash::{FxHashMap, FxHasher};

use crate::intern::hash_f64;
use crate::pipeline::Log;

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let canonical = redirect_to_first(&mut ir);
    let shared = canonical.iter().enumerate().filter(|(id, first)| first.index() != *id).count();
    log.fire_times("share", shared);
    ir.root = canonical[ir.root.index()];
    ir
}

/// For each node the first one with the same geometry, whatever the materials are.
pub(crate) fn canonical_geometry(ir: &Ir) -> Vec<NodeId> {
    let mut ir = ir.clone();
    for node in &mut ir.nodes {
        if let NodeKind::Leaf(leaf) = &mut node.kind {
            let (Leaf::Solid { material, .. } | Leaf::Surface { material, .. }) = &mut **leaf;
            *material = None;
        }
    }
    redirect_to_first(&mut ir)
}

/// For each node the first equal one. Operands become first ones, too.
fn redirect_to_first(ir: &mut Ir) -> Vec<NodeId> {
    let mut first_of_hash: FxHashMap<u64, u32> = FxHashMap::default();
    first_of_hash.reserve(ir.nodes.len());
    // Nodes of equal hash form a list; u32::MAX ends it.
    let mut next_of_hash = vec![u32::MAX; ir.nodes.len()];
    let mut canonical: Vec<NodeId> = Vec::with_capacity(ir.nodes.len());
    for id in 0..ir.nodes.len() {
        for child in ir.nodes[id].kind.children_mut() {
            *child = canonical[child.index()];
        }
        let kind = &ir.nodes[id].kind;
        let mut at = *first_of_hash.entry(hash(kind)).or_insert(id as u32) as usize;
        while at != id && ir.nodes[at].kind != *kind {
            if next_of_hash[at] == u32::MAX {
                next_of_hash[at] = id as u32;
            }
            at = next_of_hash[at] as usize;
        }
        canonical.push(NodeId(at as u32));
    }
    canonical
}

fn hash(kind: &NodeKind) -> u64 {
    let mut hasher = FxHasher::default();
    std::mem::discriminant(kind).hash(&mut hasher);
    kind.children().hash(&mut hasher);
    match kind {
        NodeKind::Leaf(leaf) => match &**leaf {
            Leaf::Solid { shape, parent_from_object, material } => {
                material.hash(&mut hasher);
                hash_map(parent_from_object, &mut hasher);
                hash_shape(shape, &mut hasher);
            }
            Leaf::Surface { surface, parent_from_object, material } => {
                material.hash(&mut hasher);
                hash_map(parent_from_object, &mut hasher);
                hash_surface(surface, &mut hasher);
            }
        },
        NodeKind::Transform { parent_from_child, .. } => hash_map(parent_from_child, &mut hasher),
        NodeKind::Attributes { attributes, precedence, .. } => (attributes, precedence).hash(&mut hasher),
        _ => {}
    }
    hasher.finish()
}

fn hash_map(map: &DAffine3, hasher: &mut FxHasher) {
    for x in map.to_cols_array() {
        hash_f64(x, hasher);
    }
}

fn hash_surface(surface: &Surface, hasher: &mut FxHasher) {
    std::mem::discriminant(surface).hash(hasher);
    let mut corners = |points: &[DVec3]| points.iter().flat_map(DVec3::to_array).for_each(|x| hash_f64(x, hasher));
    match surface {
        Surface::Triangle(points) => corners(points),
        Surface::Quad(points) => corners(points),
        Surface::Rectangle { width, depth } => [*width, *depth].iter().for_each(|&x| hash_f64(x, hasher)),
        Surface::Disk { radius } => hash_f64(*radius, hasher),
        Surface::Plane => {}
        Surface::Mesh { path, .. } => path.hash(hasher),
    }
}

fn hash_shape(shape: &Shape, hasher: &mut FxHasher) {
    std::mem::discriminant(shape).hash(hasher);
    if let Shape::Mesh(mesh) = shape {
        mesh.name().hash(hasher);
    }
    shape.for_each_size(&mut |x| hash_f64(x, hasher));
}
