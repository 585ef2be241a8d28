//! Divides the scene's union into objects: the opaque ones stay one union, each transmissive one stands alone.
//!
//! An object is an operand of the root union. It is transmissive when a leaf of it lets light in: it has a dielectric or
//! inert bsdf, or a medium and no bsdf. A
//! regularised union of two different media has no wall between them, so light could not tell where one ends;
//! the scene means its objects to be side by side. Among opaque objects the walls inside of the union can be seen
//! only by a camera that sits inside, so they stay one union, with the precedence of operands for coincident faces.
//! A root group's members are independent already.
//!
//! Rewrites: `separate_transmissive`, `root_to_group`.

use arsc_diagnostics::Span;
use arsc_ir::{Bsdf, Ir, Leaf, Material, MaterialId, Node, NodeId, NodeKind};

use crate::pipeline::Log;

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let Node { kind, origin } = ir.node(ir.root).clone();
    let members = match kind {
        NodeKind::Group(_) => return ir,
        NodeKind::Union(objects) => separate(&mut ir, objects, origin, log),
        _ => vec![ir.root],
    };
    log.fire("root_to_group");
    ir.root = ir.push(Node { kind: NodeKind::Group(members), origin });
    ir
}

fn separate(ir: &mut Ir, objects: Vec<NodeId>, origin: Span, log: &mut Log) -> Vec<NodeId> {
    let transmissive = transmissive(ir);
    let first_opaque = objects.iter().take_while(|id| transmissive[id.index()]).count();
    let (mut members, opaque): (Vec<NodeId>, Vec<NodeId>) =
        objects.into_iter().partition(|id| transmissive[id.index()]);
    log.fire_times("separate_transmissive", members.len());
    match opaque[..] {
        [] => {}
        [only] => members.insert(first_opaque, only),
        _ => {
            let union = ir.push(Node { kind: NodeKind::Union(opaque), origin });
            members.insert(first_opaque, union);
        }
    }
    members
}

/// Light gets into a solid of this material.
pub(crate) fn is_transmissive(ir: &Ir, material: &Material) -> bool {
    let bsdf = material.bsdf.map(|bsdf| &ir.bsdfs[bsdf as usize]);
    let face_is = |id: MaterialId| is_transmissive(ir, &ir.materials[id.0 as usize]);
    bsdf.map_or(material.medium.is_some(), Bsdf::is_transmissive) || material.faces.iter().any(|face| face_is(face.1))
}

/// For each node, whether light passes through a leaf below it.
pub(crate) fn transmissive(ir: &Ir) -> Vec<bool> {
    let mut transmissive = vec![false; ir.nodes.len()];
    for (id, node) in ir.nodes.iter().enumerate() {
        transmissive[id] = match &node.kind {
            NodeKind::Leaf(leaf) => matches!(**leaf, Leaf::Solid { material: Some(material), .. }
                if is_transmissive(ir, &ir.materials[material.0 as usize])),
            kind => kind.children().iter().any(|child| transmissive[child.index()]),
        };
    }
    transmissive
}
