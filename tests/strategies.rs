//! Strategy against strategy on random trees and rays, and all against point membership.
//!
//! 260 trees, a friendly and a hostile family (coincident faces, tangents, rays within faces, starts inside, mirrored and
//! sheared maps, scales from 1e-3 to 1e6), 2 000 rays each: nearest hit, occlusion and all intervals of every strategy must be
//! those of the oracle, and the middle of every interval and gap must be inside or outside by plain membership. A difference
//! is excused only if the ray is near a boundary: moved by a billionth of the scene it gets another answer from the oracle
//! itself. Such rays are counted and bounded. Seeds are fixed; nothing here is statistical.

use std::f64::consts::TAU;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, Interval, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy,
};
use arsc_geometry::Placed;
use glam::{DAffine3, DMat3, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

const TREES: u64 = 260;
const RAYS: usize = 2000;
/// Rays excused as near a boundary, of all.
const MOST_EXCUSED: f64 = 1e-3;

fn vector(rng: &mut Pcg64, reach: f64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| rng.random_range(-reach..reach)))
}

/// A point of the half-unit lattice.
fn lattice(rng: &mut Pcg64, reach: i32) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(-2 * reach..=2 * reach)) * 0.5))
}

fn friendly_shape(rng: &mut Pcg64) -> Shape {
    let mut size = || rng.random_range(0.3..1.2);
    let (a, b, c) = (size(), size(), size());
    match rng.random_range(0..20) {
        0..6 => Shape::Sphere { radius: a },
        6..10 => Shape::Box { min: DVec3::new(-a, -b, -c), max: DVec3::new(b, c, a) },
        10..13 => Shape::Cylinder { radius: 0.6 * a, height: 2.0 * b },
        13..15 => Shape::Cone { base_radius: a, top_radius: if c > 0.8 { 0.0 } else { c }, height: 1.5 * b },
        15..18 => Shape::Torus { major: a, minor: if c > 1.0 { 1.2 * a } else { 0.4 * b } },
        18 => Shape::InfiniteCylinder { radius: 0.5 * a },
        _ => Shape::HalfSpace,
    }
}

/// Sizes on the lattice, so that faces coincide and curved surfaces touch.
fn hostile_shape(rng: &mut Pcg64) -> Shape {
    let size = |rng: &mut Pcg64| f64::from(rng.random_range(1..4)) * 0.5;
    let (a, b) = (size(rng), size(rng));
    match rng.random_range(0..20) {
        0..4 => Shape::Sphere { radius: a },
        4..11 => Shape::Box { min: DVec3::ZERO, max: DVec3::new(size(rng), a, b) },
        11..14 => Shape::Cylinder { radius: a, height: b },
        14..16 => Shape::Cone { base_radius: a, top_radius: if a == b { 0.0 } else { b }, height: size(rng) },
        16..18 => Shape::Torus { major: a, minor: b },
        18 => Shape::InfiniteCylinder { radius: a },
        _ => Shape::HalfSpace,
    }
}

fn friendly_map(rng: &mut Pcg64) -> DAffine3 {
    let rotation = DMat3::from_axis_angle(vector(rng, 1.0).normalize(), rng.random_range(0.0..TAU));
    let stretch = match rng.random_range(0..4) {
        0 => DMat3::from_diagonal(DVec3::new(-1.0, 0.7, 1.4)),
        1 => DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::new(-0.2, 0.4, 0.9)),
        _ => DMat3::IDENTITY,
    };
    DAffine3 { matrix3: stretch * rotation, translation: vector(rng, 1.5) }
}

/// Quarter turns and mirrors; sometimes a shear along the lattice.
fn hostile_map(rng: &mut Pcg64) -> DAffine3 {
    let sign = |rng: &mut Pcg64| if rng.random() { 1.0 } else { -1.0 };
    let axes = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1]][rng.random_range(0..4)];
    let mut matrix = DMat3::from_cols(
        DVec3::AXES[axes[0]] * sign(rng),
        DVec3::AXES[axes[1]] * sign(rng),
        DVec3::AXES[axes[2]] * sign(rng),
    );
    if rng.random_range(0..6) == 0 {
        matrix = DMat3::from_cols(DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Z) * matrix;
    }
    DAffine3 { matrix3: matrix, translation: lattice(rng, 1) }
}

fn random_tree(
    rng: &mut Pcg64,
    leaves: &mut Vec<CsgLeaf>,
    size: usize,
    make: &mut dyn FnMut(&mut Pcg64) -> CsgLeaf,
) -> Csg {
    if size <= 1 {
        if !leaves.is_empty() && rng.random_range(0..25) == 0 {
            return Csg::Leaf(rng.random_range(0..leaves.len()) as u32);
        }
        let leaf = make(rng);
        leaves.push(leaf);
        return Csg::Leaf(leaves.len() as u32 - 1);
    }
    let left = rng.random_range(1..size);
    let mut child = |rng: &mut Pcg64, size| random_tree(rng, leaves, size, make);
    let (a, b) = (child(rng, left), child(rng, size - left));
    match rng.random_range(0..10) {
        0..5 => Csg::Union(vec![a, b]),
        5..8 => Csg::Difference(Box::new(a), Box::new(b)),
        _ => Csg::Intersection(vec![a, b]),
    }
}

struct Case {
    solid: Solid,
    hostile: bool,
    scale: f64,
}

fn case(seed: u64) -> (Case, Pcg64) {
    let mut rng = Pcg64::seed_from_u64(seed);
    let hostile = seed % 2 == 1;
    let scale = if seed % 4 < 2 { 1.0 } else { [1e-3, 0.1, 37.0, 1e6][rng.random_range(0..4)] };
    let size = [2, 3, 5, 8, 13, 25, 40][rng.random_range(0..7)];
    let mut leaves = Vec::new();
    let outer = DAffine3::from_scale(DVec3::splat(scale));
    let mut count = 0;
    let mut make = |rng: &mut Pcg64| {
        let shape = if hostile { hostile_shape(rng) } else { friendly_shape(rng) };
        let map = if hostile { hostile_map(rng) } else { friendly_map(rng) };
        count += 1;
        CsgLeaf { shape, world_from_object: outer * map, material: MaterialIndex(count - 1) }
    };
    let tree = random_tree(&mut rng, &mut leaves, size, &mut make);
    (Case { solid: Solid { tree, leaves }, hostile, scale }, rng)
}

fn random_ray(case: &Case, rng: &mut Pcg64) -> Ray {
    let far = if rng.random_range(0..50) == 0 { 1e4 } else { 4.0 };
    let (origin, target) = if case.hostile && rng.random_range(0..40) == 0 {
        // Along the lattice: within faces and through edges.
        let origin = lattice(rng, 2);
        (origin, origin + DVec3::AXES[rng.random_range(0..3)] * if rng.random() { 1.0 } else { -1.0 })
    } else if rng.random_range(0..3) == 0 {
        (vector(rng, 1.5), vector(rng, 1.5))
    } else {
        (vector(rng, 1.0).normalize() * far, vector(rng, 1.5))
    };
    Ray::new(origin * case.scale, (target - origin).normalize())
}

fn contains(tree: &Csg, leaves: &[Placed], p: DVec3) -> bool {
    match tree {
        Csg::Leaf(i) => leaves[*i as usize].contains(p),
        Csg::Union(list) => list.iter().any(|node| contains(node, leaves, p)),
        Csg::Intersection(list) => list.iter().all(|node| contains(node, leaves, p)),
        Csg::Difference(a, b) => contains(a, leaves, p) && !contains(b, leaves, p),
    }
}

/// What two answers must share, without the distances.
fn outline(intervals: &[Interval]) -> Vec<(Option<u32>, Option<u32>)> {
    let part = |hit: Option<arsc_accel::Hit>| hit.map(|hit| hit.part.0);
    intervals.iter().map(|i| (part(i.enter), part(i.exit))).collect()
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    a == b || (a - b).abs() <= tolerance
}

/// The first difference of a strategy's answers from the oracle's intervals.
fn difference(case: &Case, expected: &[Interval], scene: &Scene, ray: &Ray, t_max: f64) -> Option<String> {
    let tolerance = 1e-7 * (case.scale + ray.origin.length());
    let found = scene.intervals(ray);
    if outline(expected) != outline(&found) {
        return Some(format!("intervals {:?} against {:?}", outline(expected), outline(&found)));
    }
    for (a, b) in expected.iter().zip(&found) {
        if !close(a.t_enter, b.t_enter, tolerance) || !close(a.t_exit, b.t_exit, tolerance) {
            return Some(format!("interval {}..{} against {}..{}", a.t_enter, a.t_exit, b.t_enter, b.t_exit));
        }
        for (a, b) in [(a.enter, b.enter), (a.exit, b.exit)] {
            if let (Some(a), Some(b)) = (a, b)
                && a.ng.dot(b.ng) < 0.99
            {
                return Some(format!("normal {} against {}", a.ng, b.ng));
            }
        }
    }
    let first = expected.iter().flat_map(|i| [i.enter, i.exit]).flatten().next();
    let hit = scene.intersect(ray);
    if hit.map(|hit| hit.part) != first.map(|hit| hit.part) {
        return Some(format!("nearest {hit:?} against {first:?}"));
    }
    if let (Some(a), Some(b)) = (hit, first)
        && (!close(a.t, b.t, tolerance) || a.ng.dot(b.ng) < 0.99)
    {
        return Some(format!("nearest at {} against {}", a.t, b.t));
    }
    let blocked = first.is_some_and(|hit| hit.t < t_max);
    let wrong = scene.occluded(&Ray { t_max, ..*ray }) != blocked;
    wrong.then(|| format!("occluded up to {t_max}: {}", !blocked))
}

/// Membership in the middle of intervals and of gaps.
fn contradiction(case: &Case, placed: &[Placed], expected: &[Interval], ray: &Ray) -> Option<String> {
    let tolerance = 1e-7 * (case.scale + ray.origin.length());
    let mut from = 0.0;
    let beyond = 4.0 * case.scale;
    let probe = |low: f64, high: f64, inside: bool| {
        let high = if high.is_finite() { high } else { low + beyond };
        let wrong = high - low > tolerance && contains(&case.solid.tree, placed, ray.at(0.5 * (low + high))) != inside;
        wrong.then(|| format!("between {low} and {high}: inside {}", !inside))
    };
    for interval in expected {
        let wrong = probe(from, interval.t_enter, false).or_else(|| probe(interval.t_enter, interval.t_exit, true));
        if wrong.is_some() {
            return wrong;
        }
        from = interval.t_exit;
    }
    if from.is_finite() { probe(from, f64::INFINITY, false) } else { None }
}

/// The oracle's own answer changes when the ray is moved by a billionth of the scene.
fn near_boundary(case: &Case, oracle: &Scene, ray: &Ray, rng: &mut Pcg64) -> bool {
    let before = oracle.intervals(ray);
    (0..24).any(|_| {
        let step = 1e-9 * (case.scale + ray.origin.length());
        let origin = ray.origin + vector(rng, 1.0) * step;
        let dir = (ray.dir + vector(rng, 1e-9)).normalize();
        let after = oracle.intervals(&Ray { origin, dir, ..*ray });
        outline(&after) != outline(&before)
            || after.iter().zip(&before).any(|(a, b)| {
                let moved = |a: f64, b: f64| !close(a, b, 1e-7 * (case.scale + ray.origin.length()));
                moved(a.t_enter, b.t_enter) || moved(a.t_exit, b.t_exit)
            })
    })
}

/// What one tree's rays gave.
#[derive(Default)]
struct Tally {
    excused: u64,
    intervals: u64,
    unexplained: Vec<String>,
}

fn check(seed: u64) -> Tally {
    let (case, mut rng) = case(seed);
    let geometry = SceneGeometry { solids: vec![case.solid.clone()], ..SceneGeometry::default() };
    let build = |strategy| Scene::build(geometry.clone(), BuildOptions::from(strategy)).unwrap();
    let oracle = build(Strategy::Oracle);
    let scenes = Strategy::ALL.map(|strategy| (strategy, build(strategy)));
    let place = |leaf: &CsgLeaf| Placed::new(leaf.shape.clone(), leaf.world_from_object).unwrap();
    let placed: Vec<Placed> = case.solid.leaves.iter().map(place).collect();
    let mut tally = Tally::default();
    for i in 0..RAYS {
        let ray = random_ray(&case, &mut rng);
        let t_max = rng.random_range(0.0..6.0) * case.scale;
        let expected = oracle.intervals(&ray);
        let mut differences: Vec<String> = scenes
            .iter()
            .filter_map(|(strategy, scene)| {
                let difference = difference(&case, &expected, scene, &ray, t_max)?;
                Some(format!("{}: {difference}", strategy.name()))
            })
            .collect();
        differences.extend(contradiction(&case, &placed, &expected, &ray));
        if !differences.is_empty() {
            if near_boundary(&case, &oracle, &ray, &mut rng) {
                tally.excused += 1;
            } else {
                let differences = differences.join("; ");
                tally.unexplained.push(format!("seed {seed}, ray {i} {ray:?}, t_max {t_max}: {differences}"));
            }
        }
        tally.intervals += expected.len() as u64;
    }
    tally
}

#[test]
fn strategies_agree_with_the_oracle_and_with_membership() {
    let next = AtomicU64::new(0);
    let total = Mutex::new(Tally::default());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= TREES {
                        return;
                    }
                    let tally = check(seed);
                    let mut total = total.lock().unwrap();
                    total.excused += tally.excused;
                    total.intervals += tally.intervals;
                    total.unexplained.extend(tally.unexplained);
                }
            });
        }
    });
    let Tally { excused, intervals, unexplained } = total.into_inner().unwrap();
    let rays = TREES * RAYS as u64;
    println!("{rays} rays, {intervals} intervals, {excused} near a boundary");
    assert!(
        unexplained.is_empty(),
        "{} unexplained:\n{}",
        unexplained.len(),
        unexplained[..unexplained.len().min(20)].join("\n")
    );
    assert!(intervals > rays / 4, "only {intervals} intervals on {rays} rays");
    assert!((excused as f64) < MOST_EXCUSED * rays as f64, "{excused} of {rays} rays near a boundary");
}
