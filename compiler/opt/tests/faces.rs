//! Materials by face: what a leaf's faces show after the passes.

use arsc_ir::{Ir, Leaf, Material, NodeKind, read, verify};
use arsc_opt::{Options, optimise};

/// The materials of the solid leaves, in the order of the nodes, and the IR that they refer to.
fn materials(statements: &str) -> (Ir, Vec<Material>) {
    let mut text = String::from(
        "ir 1\nbsdf b0 = lambert(reflectance: constant(0.5))\nbsdf b1 = mirror(reflectance: constant(0.9))\n\
         bsdf b2 = mirror(reflectance: constant(0.4))\nemitter e0 = emitter(radiance: constant(1.0), two_sided: false)\n",
    );
    for statement in statements.lines() {
        let origin = if statement.starts_with('%') { " @0:0..1" } else { "" };
        text.push_str(&format!("{statement}{origin}\n"));
    }
    let ir = optimise(read(&text).unwrap(), &Options { lint: false, ..Options::default() }).ir;
    verify(&ir).unwrap();
    // What is written reads back.
    assert_eq!(read(&ir.to_string()).unwrap(), ir);
    let leaves = ir.nodes.iter().filter_map(|node| match &node.kind {
        NodeKind::Leaf(leaf) => match **leaf {
            Leaf::Solid { material: Some(id), .. } => Some(ir.materials[id.0 as usize].clone()),
            _ => None,
        },
        _ => None,
    });
    let found = leaves.collect();
    (ir, found)
}

/// Bsdf and emitter of a face's material.
fn face(ir: &Ir, material: &Material, i: usize) -> (u32, Option<u32>, Option<u32>) {
    let (face, id) = material.faces[i];
    let Material { bsdf, emitter, .. } = ir.materials[id.0 as usize];
    (face, bsdf, emitter)
}

#[test]
fn a_face_has_its_own_and_takes_the_rest_from_the_whole() {
    for order in [
        "%1 = with(%0, bsdf: b0)\n%2 = with(%1, emitter: e0, face: 2)",
        "%1 = with(%0, emitter: e0, face: 2)\n%2 = with(%1, bsdf: b0)",
    ] {
        let (ir, found) =
            materials(&format!("%0 = cylinder(radius: 1.0, height: 2.0)\n{order}\n%3 = union(%2)\nroot %3"));
        assert_eq!((found[0].bsdf, found[0].emitter), (Some(0), None));
        assert_eq!(face(&ir, &found[0], 0), (2, Some(0), Some(0)));
        assert_eq!(found[0].faces.len(), 1);
    }
}

#[test]
fn the_nearest_wins_and_override_beats_all() {
    let inner =
        "%0 = cylinder(radius: 1.0, height: 2.0)\n%1 = with(%0, bsdf: b1, face: 1)\n%2 = with(%1, bsdf: b2, face: 1)";
    let (ir, found) = materials(&format!("{inner}\n%3 = with(%2, bsdf: b0)\n%4 = union(%3)\nroot %4"));
    let mirror = ir.bsdfs.iter().position(|bsdf| format!("{bsdf:?}").contains("0.9")).unwrap() as u32;
    assert_eq!(face(&ir, &found[0], 0), (1, Some(mirror), None));
    let (_, found) = materials(&format!("{inner}\n%3 = override(%2, bsdf: b0)\n%4 = union(%3)\nroot %4"));
    assert!(found[0].faces.is_empty());
}

#[test]
fn faces_that_are_not_there_and_single_faces() {
    let (_, found) = materials(
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, emitter: e0, face: 0)\n%2 = with(%1, bsdf: b1, face: 4)\n\
         %3 = union(%2)\nroot %3",
    );
    assert_eq!((found[0].emitter, found[0].faces.len()), (Some(0), 0));
    // A half-space that is given ends has one face still.
    let (_, found) = materials(
        "%0 = half_space()\n%1 = with(%0, bsdf: b1, face: 0)\n%2 = sphere(radius: 1.0)\n%3 = intersection(%2, %1)\n\
         %4 = union(%3)\nroot %4",
    );
    assert!(found.iter().all(|material| material.faces.is_empty()));
}

#[test]
fn cut_walls_have_no_faces() {
    let parts = "%0 = box(min: [0.0, 0.0, 0.0], max: [2.0, 2.0, 2.0])\n%1 = with(%0, bsdf: b1, face: 5)\n\
                 %2 = cylinder(radius: 0.5, height: 1.0, at: [1.0, 1.0, 1.5])";
    let rules = [("%3 = with(%1, cut: inherit)", 1), ("%3 = with(%1, cut: b2)", 1), ("%3 = union(%1)", 2)];
    for (rule, with_faces) in rules {
        let (_, found) = materials(&format!(
            "{parts}\n{rule}\n%4 = with(%2, bsdf: b2, face: 1)\n%5 = difference(%3, %4)\n%6 = union(%5)\nroot %6"
        ));
        assert_eq!(found.iter().filter(|m| !m.faces.is_empty()).count(), with_faces, "{rule}: {found:?}");
    }
}
