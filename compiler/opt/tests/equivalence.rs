//! Optimised ≡ lowered only, along random rays: the same walls, at the same places, of the same materials.
//!
//! 320 random trees of a friendly and a hostile family at scales 1e-3, 1 and 1e6, 60 rays each. No statistics: seeds are
//! fixed, every ray must agree, but for rays that pass an edge or touch a face within the tolerance, where walls
//! appear in one evaluation and vanish in the other; they are counted and must be fewer than 1 in 1000.

mod common;

use arsc_geometry::DVec3;
use arsc_ir::{Ir, verify};
use arsc_opt::{Options, optimise};
use common::random::{Family, scene};
use common::{Wall, walls};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

const RAYS: usize = 60;

fn normal_forms(ir: Ir) -> (Ir, Ir) {
    verify(&ir).expect("random scenes verify");
    let lowered = optimise(ir.clone(), &Options { optimise: false, ..Options::default() });
    let optimised = optimise(ir, &Options::default());
    assert!(optimised.diagnostics.iter().all(|d| !d.is_error()));
    (lowered.ir, optimised.ir)
}

/// A ray towards the scene; in the lattice family often along an axis, in the plane of faces, or from a corner.
fn ray(rng: &mut Pcg64Mcg, family: Family, scale: f64) -> (DVec3, DVec3) {
    let mut point = |range: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-range..range)));
    let (from, to) = (point(9.0), point(3.0));
    if family == Family::Lattice && rng.random_bool(0.3) {
        let lattice = DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(-6..7)) * 0.5 + 0.125));
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][rng.random_range(0..3)];
        return ((lattice - axis * 8.0) * scale, axis);
    }
    (from * scale, (to - from).normalize())
}

/// The same walls up to `tolerance`.
fn same(a: &[Wall], b: &[Wall], tolerance: f64) -> bool {
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(x, y)| (x.t - y.t).abs() < tolerance && x.material == y.material && x.enters == y.enters)
}

/// Some stretch between walls is so short that rounding may decide whether it is there.
fn grazes(walls: &[Wall], tolerance: f64) -> bool {
    walls.windows(2).any(|pair| pair[1].t - pair[0].t < 100.0 * tolerance)
}

fn compare(family: Family, seeds: std::ops::Range<u64>, scale: f64) {
    let tolerance = 1e-8 * scale;
    let (mut grazing, mut rays, mut met) = (0, 0, 0);
    for seed in seeds {
        let (lowered, optimised) = normal_forms(scene(seed, family, scale));
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x5eed);
        for _ in 0..RAYS {
            let (origin, dir) = ray(&mut rng, family, scale);
            let expected = walls(&lowered, origin, dir, tolerance);
            let found = walls(&optimised, origin, dir, tolerance);
            rays += 1;
            met += usize::from(!expected.is_empty());
            if same(&expected, &found, 10.0 * tolerance) {
                continue;
            }
            if grazes(&expected, tolerance) || grazes(&found, tolerance) {
                grazing += 1;
                continue;
            }
            panic!(
                "seed {seed}, {family:?}, scale {scale}, ray {origin} {dir}:\n{expected:?}\n{found:?}\n{lowered}\n{optimised}"
            );
        }
    }
    assert!(grazing * 1000 < rays, "{grazing} of {rays} rays graze");
    assert!(met * 4 > rays, "only {met} of {rays} rays meet anything");
}

#[test]
fn friendly_trees() {
    compare(Family::Friendly, 0..120, 1.0);
}

#[test]
fn trees_full_of_coincidences() {
    compare(Family::Lattice, 1000..1120, 1.0);
}

#[test]
fn tiny_and_huge_trees() {
    compare(Family::Friendly, 2000..2020, 1e-3);
    compare(Family::Friendly, 2020..2040, 1e6);
    compare(Family::Lattice, 2040..2060, 1e-3);
    compare(Family::Lattice, 2060..2080, 1e6);
}

/// Membership of a point in the scene as it is written, by the definition of the operators.
fn holds(ir: &Ir, id: arsc_ir::NodeId, p: DVec3) -> bool {
    use arsc_ir::{Leaf, NodeKind};
    let any = |of: &[arsc_ir::NodeId]| of.iter().any(|&operand| holds(ir, operand, p));
    match ir.kind(id) {
        NodeKind::Leaf(leaf) => match &**leaf {
            Leaf::Solid { shape, parent_from_object, .. } => {
                shape.contains(parent_from_object.inverse().transform_point3(p))
            }
            Leaf::Surface { .. } => false,
        },
        NodeKind::Union(of) | NodeKind::Group(of) => any(of),
        NodeKind::Intersection(of) => of.iter().all(|&operand| holds(ir, operand, p)),
        NodeKind::Difference(of) => holds(ir, of[0], p) && !any(&of[1..]),
        NodeKind::Transform { parent_from_child, child } => {
            holds(ir, *child, parent_from_child.inverse().transform_point3(p))
        }
        NodeKind::Attributes { child, .. } => holds(ir, *child, p),
        NodeKind::Light(_) | NodeKind::Environment(_) => false,
    }
}

/// Both normal forms hold the points that the scene as written holds: 120 scenes, 200 points each in general position,
/// where rounding decides nothing.
#[test]
fn no_point_is_lost_or_gained() {
    let mut inside = 0;
    for seed in 3000..3120 {
        let family = if seed % 2 == 0 { Family::Friendly } else { Family::Lattice };
        let source = scene(seed, family, 1.0);
        let (lowered, optimised) = normal_forms(source.clone());
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        for _ in 0..200 {
            let p = DVec3::from_array(std::array::from_fn(|_| rng.random_range(-4.0..4.0)));
            let expected = holds(&source, source.root, p);
            inside += usize::from(expected);
            assert_eq!(holds(&lowered, lowered.root, p), expected, "lowered, seed {seed}, {p}");
            assert_eq!(holds(&optimised, optimised.root, p), expected, "optimised, seed {seed}, {p}");
        }
    }
    assert!(inside > 1000, "only {inside} points are inside");
}
