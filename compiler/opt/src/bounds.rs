//! Boxes that hold the solids of the node table.

use arsc_geometry::{Aabb, DAffine3, Placed};
use arsc_ir::{Ir, Leaf, NodeKind};

/// The box of each node in its own frame (of the frame that its parent sees); empty for what is no solid.
///
/// Rounded outwards. A rotated box of a `Transform` gives a box around its corners, which is not tight.
pub(crate) fn bounds(ir: &Ir) -> Vec<Aabb> {
    let mut bounds: Vec<Aabb> = Vec::with_capacity(ir.nodes.len());
    for node in &ir.nodes {
        let below = |operands: &[arsc_ir::NodeId], empty: Aabb, join: fn(&Aabb, &Aabb) -> Aabb| {
            operands.iter().fold(empty, |sum, operand| join(&sum, &bounds[operand.index()]))
        };
        let hull = match &node.kind {
            NodeKind::Leaf(leaf) => leaf_bounds(leaf, &DAffine3::IDENTITY),
            NodeKind::Union(operands) | NodeKind::Group(operands) => below(operands, Aabb::EMPTY, Aabb::union),
            NodeKind::Intersection(operands) => below(operands, Aabb::EVERYTHING, Aabb::intersection),
            NodeKind::Difference(operands) => bounds[operands[0].index()],
            NodeKind::Transform { parent_from_child, child } => bounds[child.index()].transformed(parent_from_child),
            NodeKind::Attributes { child, .. } => bounds[child.index()],
            NodeKind::Light(_) | NodeKind::Environment(_) => Aabb::EMPTY,
        };
        bounds.push(if hull.is_empty() { Aabb::EMPTY } else { hull });
    }
    bounds
}

/// The box of a leaf under one map more; empty for surfaces.
pub(crate) fn leaf_bounds(leaf: &Leaf, world_from_parent: &DAffine3) -> Aabb {
    match (leaf, place(leaf, world_from_parent)) {
        (Leaf::Surface { .. }, _) => Aabb::EMPTY,
        (_, Some(placed)) => *placed.bounds(),
        (_, None) => Aabb::EVERYTHING,
    }
}

/// A solid leaf in its place under one map more. Verified leaves can be placed, but for a product of maps that is
/// singular in double precision: then nothing is proved about the leaf.
pub(crate) fn place(leaf: &Leaf, world_from_parent: &DAffine3) -> Option<Placed> {
    let Leaf::Solid { shape, parent_from_object, .. } = leaf else { return None };
    Placed::new(shape.clone(), *world_from_parent * *parent_from_object).ok()
}

/// A length that rounding near this box stays far below: 1e-9 of its largest finite coordinate.
pub(crate) fn pad(bounds: &Aabb) -> f64 {
    let finite = |x: f64| if x.is_finite() { x.abs() } else { 0.0 };
    let [low, high] = [bounds.min, bounds.max].map(|p| finite(p.x).max(finite(p.y)).max(finite(p.z)));
    1e-9 * low.max(high) + f64::MIN_POSITIVE
}

/// The box grown by its own [`pad`]; empty stays empty.
pub(crate) fn padded(bounds: &Aabb) -> Aabb {
    if bounds.is_empty() { Aabb::EMPTY } else { bounds.dilated(pad(bounds)) }
}
