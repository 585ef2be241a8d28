//! Every rewrite of every pass: a scene in which it fires, and one like it in which it must not.

use arsc_ir::{Ir, read, verify};
use arsc_opt::{Options, PassReport, optimise_observed};

/// Statements without provenance; each node gets its line as its span.
fn scene(statements: &str) -> Ir {
    let mut text = String::from(
        "ir 1\nbsdf b0 = lambert(reflectance: constant(0.5))\nbsdf b1 = mirror(reflectance: constant(0.9))\n\
         bsdf b2 = dielectric(ior: constant(1.5))\n\
         bsdf b3 = dielectric(ior: constant(1.33))\n\
         emitter e0 = emitter(radiance: constant(1.0), two_sided: false)\n\
         medium v0 = medium(absorption: constant(1.0), scattering: constant(0.0), emission: constant(0.0), \
         phase: isotropic(), density: uniform())\n",
    );
    for (line, statement) in statements.lines().map(str::trim).filter(|line| !line.is_empty()).enumerate() {
        let origin = if statement.starts_with('%') { format!(" @0:{line}..{}", line + 1) } else { String::new() };
        text.push_str(&format!("{statement}{origin}\n"));
    }
    let ir = read(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    verify(&ir).expect("test scenes verify");
    ir
}

fn run(statements: &str) -> (Ir, Vec<PassReport>) {
    let mut broken = Vec::new();
    let optimised = optimise_observed(scene(statements), &Options::default(), &mut |pass, ir| {
        if let Err(violations) = verify(ir) {
            broken.push((pass, violations));
        }
    });
    assert!(broken.is_empty(), "{broken:?}");
    (optimised.ir, optimised.passes)
}

/// How often a rewrite of a pass fired.
fn fired(passes: &[PassReport], pass: &str, rewrite: &str) -> usize {
    let report = passes.iter().find(|report| report.name == pass).unwrap_or_else(|| panic!("no pass {pass}"));
    report.rewrites.iter().find(|(name, _)| *name == rewrite).map_or(0, |(_, count)| *count)
}

/// A pass, a rewrite, a scene in which it fires that often, and one in which it does not.
struct Case(&'static str, &'static str, usize, &'static str, &'static str);

const CASES: &[Case] = &[
    Case(
        "propagate_attributes",
        "attach",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b0)\n%2 = union(%1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = override(%0, bsdf: b0)\n%2 = union(%1)\nroot %2",
    ),
    Case(
        "propagate_attributes",
        "override",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = override(%0, bsdf: b0)\n%2 = union(%1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b0)\n%2 = union(%1)\nroot %2",
    ),
    Case(
        "propagate_attributes",
        "cut_with",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = with(%1, cut: b1)\n\
         %3 = difference(%0, %2)\n%4 = union(%3)\nroot %4",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = with(%1, cut: b1)\n\
         %3 = intersection(%0, %2)\n%4 = union(%3)\nroot %4",
    ),
    Case(
        "propagate_attributes",
        "inherit",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = with(%1, cut: inherit)\n\
         %3 = difference(%0, %2)\n%4 = union(%3)\nroot %4",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = with(%1, cut: inherit)\n\
         %3 = difference(%2, %0)\n%4 = difference(%2)\n%5 = union(%4)\nroot %5",
    ),
    Case(
        "propagate_attributes",
        "distribute_inherit",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = with(%1, bsdf: b1)\n\
         %3 = union(%0, %2)\n%4 = sphere(radius: 1.0, at: [0.5, 0.5, 0.0])\n%5 = with(%4, cut: inherit)\n\
         %6 = difference(%3, %5)\n%7 = union(%6)\nroot %7",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %2 = union(%0, %1)\n%3 = sphere(radius: 1.0, at: [0.5, 0.5, 0.0])\n%4 = with(%3, cut: inherit)\n\
         %5 = difference(%2, %4)\n%6 = union(%5)\nroot %6",
    ),
    Case(
        "separate_media",
        "separate_transmissive",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b2)\n%2 = half_space()\n%3 = union(%1, %2)\nroot %3",
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b1)\n%2 = half_space()\n%3 = union(%1, %2)\nroot %3",
    ),
    Case(
        "separate_media",
        "root_to_group",
        1,
        "%0 = sphere(radius: 1.0)\nroot %0",
        "%0 = sphere(radius: 1.0)\n%1 = group(%0)\nroot %1",
    ),
    Case(
        "split_environments",
        "split_environment",
        2,
        "%0 = sphere(radius: 1.0)\n%1 = constant_environment(radiance: constant(1.0))\n%2 = union(%0, %1)\n\
         %3 = half_space()\n%4 = difference(%2, %3)\n%5 = union(%4, %1)\nroot %5",
        "%0 = sphere(radius: 1.0)\n%1 = point_light(intensity: constant(1.0))\n%2 = union(%0, %1)\nroot %2",
    ),
    Case(
        "split_lights",
        "split_light",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = point_light(intensity: constant(1.0))\n%2 = union(%0, %1)\n\
         %3 = half_space()\n%4 = intersection(%3, %2)\n%5 = union(%4)\nroot %5",
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, emitter: e0)\n%2 = union(%1)\nroot %2",
    ),
    Case(
        "split_lights",
        "split_surface",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = plane()\n%2 = union(%0, %1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = half_space()\n%2 = union(%0, %1)\nroot %2",
    ),
    // (glass | water | water) - ball: glass, and the two waters as one solid.
    Case(
        "fill_interiors",
        "split_interiors",
        2,
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b2)\n%2 = with(%0, bsdf: b3)\n\
         %3 = transform(%2, at: [1.0, 0.0, 0.0])\n%4 = transform(%2, at: [2.0, 0.0, 0.0])\n%5 = union(%1, %3, %4)\n\
         %6 = difference(%5, %0)\n%7 = union(%6)\nroot %7",
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b2)\n%2 = with(%0, bsdf: b2)\n\
         %3 = transform(%2, at: [1.0, 0.0, 0.0])\n%4 = union(%1, %3)\n%5 = difference(%4, %0)\n%6 = union(%5)\nroot %6",
    ),
    // The wall that water cuts into glass has glass behind it.
    Case(
        "fill_interiors",
        "fill",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b2)\n%2 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %3 = with(%2, bsdf: b3)\n%4 = difference(%1, %3)\n%5 = union(%4)\nroot %5",
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b2)\n%2 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %3 = with(%2, bsdf: b2)\n%4 = difference(%1, %3)\n%5 = union(%4)\nroot %5",
    ),
    // A medium without a bsdf is inert.
    Case(
        "fill_interiors",
        "fill",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, medium: v0)\n%2 = union(%1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b2, medium: v0)\n%2 = union(%1)\nroot %2",
    ),
    Case(
        "share_subtrees",
        "share",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0)\n%2 = transform(%1, at: [5.0, 0.0, 0.0])\n\
         %3 = union(%0, %2)\nroot %3",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0)\n%2 = with(%1, bsdf: b1)\n\
         %3 = transform(%2, at: [5.0, 0.0, 0.0])\n%4 = union(%0, %3)\nroot %4",
    ),
    Case(
        "split_union",
        "split_solids",
        2,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [2.1, 0.0, 0.0])\n%2 = union(%0, %1)\nroot %2",
        // Touching balls stay one union.
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [2.0, 0.0, 0.0])\n%2 = union(%0, %1)\nroot %2",
    ),
    Case(
        "split_union",
        "split_solids",
        2,
        // The boxes overlap, but the ball lies outside of the other's box.
        "%0 = sphere(radius: 1.0)\n%1 = box(min: [0.8, 0.8, 0.0], max: [2.0, 2.0, 1.0])\n%2 = union(%0, %1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = box(min: [0.7, 0.7, 0.0], max: [2.0, 2.0, 1.0])\n%2 = union(%0, %1)\nroot %2",
    ),
    Case(
        "fold_transforms",
        "fold_into_leaf",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = transform(%0, at: [1.0, 0.0, 0.0])\n%2 = union(%1)\nroot %2",
        "%0 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%1 = union(%0)\nroot %1",
    ),
    Case(
        "fold_transforms",
        "fold_into_light",
        1,
        "%0 = point_light(intensity: constant(1.0))\n%1 = transform(%0, at: [1.0, 0.0, 0.0])\n%2 = union(%1)\nroot %2",
        "%0 = point_light(intensity: constant(1.0))\n%1 = union(%0)\nroot %1",
    ),
    Case(
        "fold_transforms",
        "keep_instance",
        2,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [0.0, 0.0, 0.5])\n\
         %2 = difference(%0, %1, %1, %1, %1, %1, %1, %1)\n%3 = transform(%2, at: [5.0, 0.0, 0.0])\n\
         %4 = union(%2, %3)\nroot %4",
        // Overlapping copies are one union.
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [0.0, 0.0, 0.5])\n\
         %2 = difference(%0, %1, %1, %1, %1, %1, %1, %1)\n%3 = transform(%2, at: [0.5, 0.0, 0.0])\n\
         %4 = union(%2, %3)\nroot %4",
    ),
    Case(
        "fold_transforms",
        "ungroup",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = group(%0)\n%2 = group(%1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = group(%0)\nroot %1",
    ),
    Case(
        "flatten",
        "union_in_union",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = union(%0, %1)\n\
         %3 = sphere(radius: 1.0, at: [0.5, 0.5, 0.0])\n%4 = union(%2, %3)\n%5 = half_space()\n\
         %6 = intersection(%4, %5)\n%7 = union(%6)\nroot %7",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = intersection(%0, %1)\n\
         %3 = sphere(radius: 1.0, at: [0.5, 0.5, 0.0])\n%4 = union(%2, %3)\n%5 = half_space()\n\
         %6 = intersection(%4, %5)\n%7 = union(%6)\nroot %7",
    ),
    Case(
        "flatten",
        "intersection_in_intersection",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = intersection(%0, %1)\n\
         %3 = sphere(radius: 1.0, at: [0.5, 0.5, 0.0])\n%4 = intersection(%2, %3)\n%5 = union(%4)\nroot %5",
        // The inner one has another user.
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = intersection(%0, %1)\n\
         %3 = sphere(radius: 1.0, at: [0.5, 0.5, 0.0])\n%4 = intersection(%2, %3)\n%5 = difference(%4, %2)\n\
         %6 = union(%5)\nroot %6",
    ),
    Case(
        "flatten",
        "difference_in_minuend",
        2,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = difference(%0, %1)\n\
         %3 = difference(%2, %1)\n%4 = difference(%3, %1)\n%5 = union(%4)\nroot %5",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%2 = difference(%0, %1)\n\
         %3 = difference(%0, %2)\n%4 = union(%3)\nroot %4",
    ),
    Case(
        "flatten",
        "union_in_subtrahend",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %2 = sphere(radius: 1.0, at: [0.0, 1.0, 0.0])\n%3 = union(%1, %2)\n%4 = difference(%0, %3)\n\
         %5 = union(%4)\nroot %5",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %2 = sphere(radius: 1.0, at: [0.0, 1.0, 0.0])\n%3 = union(%1, %2)\n%4 = difference(%3, %0)\n\
         %5 = union(%4)\nroot %5",
    ),
    Case(
        "flatten",
        "single_operand",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = intersection(%0)\n%2 = group(%1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = half_space()\n%2 = intersection(%0, %1)\n%3 = group(%2)\nroot %3",
    ),
    Case(
        "bound_unbounded",
        "half_space_to_box",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = half_space()\n%2 = intersection(%0, %1)\n%3 = union(%2)\nroot %3",
        "%0 = sphere(radius: 1.0)\n%1 = half_space()\n%2 = difference(%1, %0)\n%3 = union(%2)\nroot %3",
    ),
    Case(
        "bound_unbounded",
        "infinite_cylinder_to_cylinder",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = infinite_cylinder(radius: 0.5)\n%2 = difference(%0, %1)\n%3 = union(%2)\nroot %3",
        "%0 = half_space()\n%1 = infinite_cylinder(radius: 0.5)\n%2 = difference(%0, %1)\n%3 = union(%2)\nroot %3",
    ),
    Case(
        "drop_operands",
        "empty_operand",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [3.0, 0.0, 0.0])\n\
         %2 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%3 = difference(%0, %1, %2)\n%4 = union(%3)\nroot %4",
        // Touching, which proves nothing.
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [2.0, 0.0, 0.0])\n\
         %2 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n%3 = difference(%0, %1, %2)\n%4 = union(%3)\nroot %4",
    ),
    Case(
        "drop_operands",
        "full_operand",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %2 = box(min: [-2.0, -2.0, -2.0], max: [2.0, 2.0, 2.0])\n%3 = intersection(%0, %1, %2)\n%4 = union(%3)\nroot %4",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %2 = box(min: [-2.0, -1.0, -2.0], max: [2.0, 2.0, 2.0])\n%3 = intersection(%0, %1, %2)\n%4 = union(%3)\nroot %4",
    ),
    Case(
        "drop_operands",
        "empty_intersection",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [3.0, 0.0, 0.0])\n%2 = intersection(%0, %1)\n\
         %3 = union(%2)\nroot %3",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.9, 0.0, 0.0])\n%2 = intersection(%0, %1)\n\
         %3 = union(%2)\nroot %3",
    ),
    Case(
        "drop_operands",
        "empty_difference",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 3.0)\n%2 = difference(%0, %1)\n%3 = union(%2)\nroot %3",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 0.5)\n%2 = difference(%0, %1)\n%3 = union(%2)\nroot %3",
    ),
    Case(
        "drop_operands",
        "full_union",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 3.0)\n%2 = sphere(radius: 3.0, at: [4.0, 0.0, 0.0])\n\
         %3 = union(%1, %2)\n%4 = sphere(radius: 1.0, at: [0.0, 1.0, 0.0])\n%5 = intersection(%0, %3, %4)\n\
         %6 = union(%5)\nroot %6",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %2 = sphere(radius: 3.0, at: [4.0, 0.0, 0.0])\n%3 = union(%1, %2)\n\
         %4 = sphere(radius: 1.0, at: [0.0, 1.0, 0.0])\n%5 = intersection(%0, %3, %4)\n%6 = union(%5)\nroot %6",
    ),
    Case(
        "drop_operands",
        "absorbed_operand",
        1,
        "%0 = sphere(radius: 3.0)\n%1 = sphere(radius: 1.0)\n%2 = union(%0, %1)\nroot %2",
        // The hole reaches the inner ball.
        "%0 = sphere(radius: 3.0)\n%1 = sphere(radius: 1.0)\n%2 = sphere(radius: 1.0, at: [1.5, 0.0, 0.0])\n\
         %3 = difference(%0, %2)\n%4 = union(%3, %1)\nroot %4",
    ),
    Case(
        "drop_operands",
        "repeated_operand",
        1,
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0)\n%2 = union(%0, %1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = sphere(radius: 1.0)\n%2 = with(%1, bsdf: b1)\n%3 = union(%0, %2)\nroot %3",
    ),
    Case(
        "drop_operands",
        "empty_solid",
        1,
        "%0 = union()\n%1 = sphere(radius: 1.0)\n%2 = group(%0, %1)\nroot %2",
        "%0 = sphere(radius: 1.0)\n%1 = group(%0)\nroot %1",
    ),
    Case(
        "drop_operands",
        "single_operand",
        1,
        "%0 = sphere(radius: 3.0)\n%1 = sphere(radius: 1.0)\n%2 = union(%0, %1)\nroot %2",
        "%0 = sphere(radius: 3.0)\n%1 = sphere(radius: 3.0, at: [1.0, 0.0, 0.0])\n%2 = union(%0, %1)\nroot %2",
    ),
];

#[test]
fn each_rewrite_fires_where_it_should_and_nowhere_else() {
    for Case(pass, rewrite, times, positive, negative) in CASES {
        assert_eq!(fired(&run(positive).1, pass, rewrite), *times, "{pass}/{rewrite} in\n{positive}");
        assert_eq!(fired(&run(negative).1, pass, rewrite), 0, "{pass}/{rewrite} in\n{negative}");
    }
}

/// The lines of nodes of the optimised scene, without provenance.
fn nodes(statements: &str) -> Vec<String> {
    let text = run(statements).0.to_string();
    let nodes = text.lines().filter(|line| line.starts_with('%') || line.starts_with("material"));
    nodes.map(|line| line.split(" @").next().unwrap_or_default().to_string()).collect()
}

#[test]
fn the_innermost_attribute_wins_and_the_outermost_override_beats_it() {
    let inner = "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b1, emitter: e0)\n%2 = with(%1, bsdf: b0)\n\
                 %3 = union(%2)\nroot %3";
    assert_eq!(nodes(inner)[0], "material m0 = material(bsdf: b1, emitter: e0)");
    let forced = "%0 = sphere(radius: 1.0)\n%1 = override(%0, bsdf: b1)\n%2 = override(%1, bsdf: b0)\n\
                  %3 = with(%2, emitter: e0)\n%4 = union(%3)\nroot %4";
    assert_eq!(nodes(forced)[0], "material m0 = material(bsdf: b0, emitter: e0)");
}

#[test]
fn a_cut_wall_shows_the_subtrahend_unless_a_rule_says_otherwise() {
    let solids = "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b0)\n%2 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
                  %3 = with(%2, bsdf: b1, emitter: e0)\n";
    let cut = |rest: &str| nodes(&format!("{solids}{rest}"));
    let wall = |lines: &[String]| {
        let leaf = lines.iter().find(|line| line.contains("at: [1.0")).expect("the subtrahend");
        let id = leaf.split("material: ").nth(1).expect("a material").trim_end_matches(')').to_string();
        lines.iter().find(|line| line.starts_with(&format!("material {id} "))).expect("its entry").clone()
    };
    let plain = cut("%4 = difference(%1, %3)\n%5 = union(%4)\nroot %5");
    assert!(wall(&plain).ends_with("material(bsdf: b1, emitter: e0)"));
    let on_subtrahend = cut("%4 = with(%3, cut: inherit)\n%5 = difference(%1, %4)\n%6 = union(%5)\nroot %6");
    assert!(wall(&on_subtrahend).ends_with("material(bsdf: b0)"));
    let on_minuend = cut("%4 = with(%1, cut: inherit)\n%5 = difference(%4, %3)\n%6 = union(%5)\nroot %6");
    assert!(wall(&on_minuend).ends_with("material(bsdf: b0)"));
    let around = cut("%4 = difference(%1, %3)\n%5 = with(%4, cut: b2)\n%6 = union(%5)\nroot %6");
    assert!(wall(&around).ends_with("material(bsdf: b2)"));
    let nearest = cut("%4 = with(%3, cut: inherit)\n%5 = difference(%1, %4)\n%6 = with(%5, cut: b2)\n\
                       %7 = union(%6)\nroot %7");
    assert!(wall(&nearest).ends_with("material(bsdf: b0)"));
}

#[test]
fn inherited_walls_of_a_mixed_union_take_the_material_of_each_part() {
    let lines = nodes(
        "%0 = sphere(radius: 1.0)\n%1 = with(%0, bsdf: b0)\n%2 = sphere(radius: 1.0, at: [1.0, 0.0, 0.0])\n\
         %3 = with(%2, bsdf: b1)\n%4 = union(%1, %3)\n%5 = transform(%4, at: [0.0, 0.0, 2.0])\n\
         %6 = sphere(radius: 1.0, at: [0.5, 0.5, 2.0])\n%7 = with(%6, cut: inherit)\n%8 = difference(%5, %7)\n\
         %9 = union(%8)\nroot %9",
    );
    let walls: Vec<&String> = lines.iter().filter(|line| line.contains("at: [0.5, 0.5, 2.0]")).collect();
    assert_eq!(walls.len(), 2, "{lines:#?}");
    assert_ne!(walls[0].split("material").nth(1), walls[1].split("material").nth(1));
    assert_eq!(lines.iter().filter(|line| line.contains("difference(")).count(), 2);
}

#[test]
fn long_chains_and_shared_towers_do_not_exhaust_the_stack_or_memory() {
    let mut chain = String::from("%0 = sphere(radius: 1.0)\n");
    for n in 1..30_000 {
        let operator = ["union", "difference", "intersection"][n % 3];
        chain.push_str(&format!("%{} = sphere(radius: 1.0, at: [{:?}, 0.0, 0.0])\n", 2 * n - 1, n as f64 * 1e-5));
        chain.push_str(&format!("%{} = {operator}(%{}, %{})\n", 2 * n, 2 * n - 2, 2 * n - 1));
    }
    chain.push_str("root %59998");
    let (ir, _) = run(&chain);
    assert!(ir.nodes.len() > 10);

    let mut tower = String::from("%0 = sphere(radius: 1.0)\n");
    for n in 0..60 {
        tower.push_str(&format!("%{} = transform(%{}, at: [0.1, 0.0, 0.0])\n", 2 * n + 1, 2 * n));
        tower.push_str(&format!("%{} = union(%{}, %{})\n", 2 * n + 2, 2 * n, 2 * n + 1));
    }
    tower.push_str("root %120");
    let optimised = arsc_opt::optimise(scene(&tower), &Options::default());
    assert!(optimised.diagnostics.iter().any(|finding| finding.code.id() == "E0401"));
}

#[test]
fn maps_that_multiply_to_nothing_are_an_error() {
    let shrink = "map: [1e-90, 0.0, 0.0, 0.0, 1e-90, 0.0, 0.0, 0.0, 1e-90, 0.0, 0.0, 0.0]";
    let text = "%0 = sphere(radius: 1.0)\n%1 = transform(%0, SHRINK)\n%2 = transform(%1, SHRINK)\n\
                %3 = transform(%2, SHRINK)\n%4 = union(%3)\nroot %4"
        .replace("SHRINK", shrink);
    let optimised = arsc_opt::optimise(scene(&text), &Options::default());
    assert_eq!(optimised.diagnostics.iter().map(|finding| finding.code.id()).collect::<Vec<_>>(), ["E0206"]);
}
