//! Textures stay where they were attached, whatever is done to the shape afterwards.

use arsc_geometry::{DAffine3, DVec3};
use arsc_ir::{Bsdf, Ir, Leaf, NodeKind, read, verify};
use arsc_opt::{Options, optimise};

const VARYING: &str = "varying(part(lambert(reflectance: constant(0.5)), weight: expression(1.0), \
    reflectance: blend(term(expression(x), constant(1.0)))))";

fn normal_form(statements: &str) -> Ir {
    let mut text = format!("ir 1\nbsdf b0 = {VARYING}\nbsdf b1 = mirror(reflectance: constant(0.4))\n");
    for statement in statements.lines() {
        let origin = if statement.starts_with('%') { " @0:0..1" } else { "" };
        text.push_str(&format!("{statement}{origin}\n"));
    }
    let ir = optimise(read(&text).unwrap(), &Options { lint: false, ..Options::default() }).ir;
    verify(&ir).unwrap();
    assert_eq!(read(&ir.to_string()).unwrap(), ir, "what is written reads back");
    ir
}

/// The maps from the world to the space of the texture, of the solid leaves that have one, in the order of the nodes.
fn texture_from_world(ir: &Ir) -> Vec<DAffine3> {
    let mut found = Vec::new();
    for node in &ir.nodes {
        if let NodeKind::Leaf(leaf) = &node.kind
            && let Leaf::Solid { parent_from_object, material: Some(id), .. } = &**leaf
            && let Some(bsdf) = ir.materials[id.0 as usize].bsdf
            && let Bsdf::Varying(varying) = &ir.bsdfs[bsdf as usize]
        {
            found.push(varying.texture_from_object * parent_from_object.inverse());
        }
    }
    found
}

fn close(a: &DAffine3, b: &DAffine3) -> bool {
    a.to_cols_array().iter().zip(b.to_cols_array()).all(|(a, b)| (a - b).abs() < 1e-12)
}

const TWO: &str = "%0 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%1 = sphere(radius: 1.0, at: [1.0, 1.0, 0.0])\n";

#[test]
fn what_is_moved_takes_its_texture_along_and_parts_share_one_space() {
    let statements = format!(
        "{TWO}%2 = transform(%1, map: [0.0, 2.0, 0.0, -2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 3.0])\n\
         %3 = union(%0, %2)\n%4 = with(%3, bsdf: b0)\n%5 = transform(%4, at: [5.0, 0.0, 0.0])\n%6 = union(%5)\nroot %6"
    );
    let maps = texture_from_world(&normal_form(&statements));
    let wanted = DAffine3::from_translation(DVec3::new(-5.0, 0.0, 0.0));
    assert_eq!(maps.len(), 2);
    assert!(maps.iter().all(|map| close(map, &wanted)), "{maps:?}");
}

#[test]
fn a_cut_wall_shows_the_texture_in_the_space_of_what_it_is_attached_to() {
    // The subtrahend's own, a rule, and the material of what is cut.
    let cut = |attributes: &str| {
        format!(
            "{TWO}{attributes}\n%4 = transform(%3, at: [0.0, 0.5, 0.0])\n%5 = difference(%2, %4)\n\
             %6 = transform(%5, at: [0.0, 0.0, 7.0])\n%7 = union(%6)\nroot %7"
        )
    };
    let last = |attributes: &str| *texture_from_world(&normal_form(&cut(attributes))).last().expect("a texture");
    let own = last("%2 = with(%0, bsdf: b1)\n%3 = with(%1, bsdf: b0)");
    assert!(close(&own, &DAffine3::from_translation(DVec3::new(0.0, -0.5, -7.0))), "{own:?}");
    let rule = last("%2 = with(%0, bsdf: b1, cut: b0)\n%3 = with(%1, bsdf: b1)");
    assert!(close(&rule, &DAffine3::from_translation(DVec3::new(0.0, 0.0, -7.0))), "{rule:?}");
    let inherited = normal_form(&cut("%2 = with(%0, bsdf: b0, cut: inherit)\n%3 = with(%1, bsdf: b1)"));
    let maps = texture_from_world(&inherited);
    assert_eq!(maps.len(), 2);
    assert!(maps.iter().all(|map| close(map, &DAffine3::from_translation(DVec3::new(0.0, 0.0, -7.0)))), "{maps:?}");
}

#[test]
fn textures_of_the_world_need_no_space() {
    let statements =
        format!("{TWO}%2 = union(%0, %1)\n%3 = with(%2, bsdf: b0)\n%4 = transform(%3, at: [5.0, 0.0, 0.0])\nroot %4");
    let mut text = format!("ir 1\nbsdf b0 = {}\n", VARYING.replace("(x)", "(world_x)"));
    statements.lines().for_each(|line| {
        text.push_str(&format!("{line}{}\n", if line.starts_with('%') { " @0:0..1" } else { "" }));
    });
    let ir = optimise(read(&text).unwrap(), &Options { lint: false, ..Options::default() }).ir;
    assert_eq!(ir.bsdfs.len(), 1);
    assert_eq!(ir.materials.len(), 1);
}
