//! Unbounded solids get an end where a bounded partner makes it invisible.
//!
//! In A ∩ H and in A − H only the part of H in the box of A matters. A half-space there becomes a box and an infinite
//! cylinder a finite one, so large that the new faces lie well outside of A's box: the set, the faces that show and
//! their materials stay. What it buys: finite bounds for every leaf, and a finite area for walls that emit.
//!
//! The box in which a node matters: everything for the root; for operands of an intersection also the boxes of all the
//! other operands; for subtrahends also the box of the minuend; for a shared node the hull over its users.
//!
//! Rewrites: `half_space_to_box`, `infinite_cylinder_to_cylinder`.

use arsc_geometry::{Aabb, DAffine3, DVec3, Shape, invert};
use arsc_ir::{Bsdf, Ir, Leaf, NodeId, NodeKind};

use crate::bounds::bounds;
use crate::pipeline::Log;

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let unbounded = |node: &arsc_ir::Node| matches!(&node.kind, NodeKind::Leaf(leaf) if matches!(&**leaf, Leaf::Solid { shape, .. } if !shape.is_bounded()));
    if !ir.nodes.iter().any(unbounded) {
        return ir;
    }
    let contexts = contexts(&ir, &bounds(&ir));
    let is_varying = |bsdf: Option<u32>| bsdf.is_some_and(|bsdf| matches!(ir.bsdfs[bsdf as usize], Bsdf::Varying(_)));
    let varies: Vec<bool> = ir.materials.iter().map(|material| is_varying(material.bsdf)).collect();
    for (node, context) in ir.nodes.iter_mut().zip(&contexts) {
        let NodeKind::Leaf(leaf) = &mut node.kind else { continue };
        let Leaf::Solid { shape, parent_from_object, material } = &mut **leaf else { continue };
        // Textures count on the shape's own coordinates.
        if material.is_some_and(|material| varies[material.0 as usize]) {
            continue;
        }
        if shape.is_bounded() || !context.is_finite() || context.is_empty() {
            continue;
        }
        if let Some((ended, map, rewrite)) = end(shape, parent_from_object, context) {
            (*shape, *parent_from_object) = (ended, map);
            log.fire(rewrite);
        }
    }
    ir
}

/// For each node the box outside of which its points do not matter. Nodes that nothing uses matter nowhere.
pub(crate) fn contexts(ir: &Ir, bounds: &[Aabb]) -> Vec<Aabb> {
    let mut contexts = vec![Aabb::EMPTY; ir.nodes.len()];
    contexts[ir.root.index()] = Aabb::EVERYTHING;
    for (id, node) in ir.nodes.iter().enumerate().rev() {
        let context = contexts[id];
        if context.is_empty() {
            continue;
        }
        let mut widen = |child: NodeId, with: Aabb| {
            let slot = &mut contexts[child.index()];
            *slot = slot.union(&with);
        };
        match &node.kind {
            NodeKind::Intersection(of) => {
                // Boxes of all operands before, and of all after, each one.
                let mut after = vec![Aabb::EVERYTHING; of.len() + 1];
                for (i, operand) in of.iter().enumerate().rev() {
                    after[i] = after[i + 1].intersection(&bounds[operand.index()]);
                }
                let mut before = context;
                for (i, operand) in of.iter().enumerate() {
                    widen(*operand, before.intersection(&after[i + 1]));
                    before = before.intersection(&bounds[operand.index()]);
                }
            }
            NodeKind::Difference(of) => {
                widen(of[0], context);
                let inside = context.intersection(&bounds[of[0].index()]);
                of[1..].iter().for_each(|operand| widen(*operand, inside));
            }
            // The context of what is placed is in the frame of the instance: all of it.
            NodeKind::Transform { child, .. } => widen(*child, Aabb::EVERYTHING),
            kind => kind.children().iter().for_each(|child| widen(*child, context)),
        }
    }
    contexts
}

fn end(shape: &Shape, map: &DAffine3, context: &Aabb) -> Option<(Shape, DAffine3, &'static str)> {
    let cell = context.transformed(&invert(map)?);
    // Half the extent beyond on every side: far from the context, whatever the rounding.
    let margin = cell.extent() * 0.5 + cell.min.abs().max(cell.max.abs()) * 1e-6;
    let (low, high) = (cell.min - margin, cell.max + margin);
    let (ended, map, rewrite) = match *shape {
        Shape::HalfSpace => {
            // Where the context does not reach the solid, any small box below the plane will do.
            let floor = low.z.min(-margin.z);
            let shape = Shape::Box { min: DVec3::new(low.x, low.y, floor), max: DVec3::new(high.x, high.y, 0.0) };
            (shape, *map, "half_space_to_box")
        }
        Shape::InfiniteCylinder { radius } => {
            let shape = Shape::Cylinder { radius, height: high.z - low.z };
            let lifted = *map * DAffine3::from_translation(DVec3::new(0.0, 0.0, low.z));
            (shape, lifted, "infinite_cylinder_to_cylinder")
        }
        _ => return None,
    };
    (ended.is_valid() && invert(&map).is_some()).then_some((ended, map, rewrite))
}
