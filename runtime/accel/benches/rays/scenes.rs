//! Scenes of the CSG benchmark, built directly; `tests/bench/csg/scenes.py` has them for whole programs.

use std::f64::consts::TAU;

use arsc_accel::{Csg, CsgLeaf, MaterialIndex, Shape, Solid};
use glam::{DAffine3, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// Solids and where they are seen from.
pub struct View {
    pub name: &'static str,
    pub make: fn() -> Vec<Solid>,
    pub eye: DVec3,
    pub target: DVec3,
}

const NEAR: DVec3 = DVec3::new(2.4, -3.2, 2.1);

fn near(name: &'static str, scale: f64, make: fn() -> Vec<Solid>) -> View {
    View { name, make, eye: NEAR * scale, target: DVec3::ZERO }
}

fn mouth(name: &'static str, make: fn() -> Vec<Solid>) -> View {
    View { name, make, eye: DVec3::new(4.5, -8.0, 1.0), target: DVec3::new(0.0, 0.0, -1.6) }
}

pub fn all() -> Vec<View> {
    vec![
        near("grooved-3", 1.6, || grooved(3)),
        near("grooved-12", 2.6, || grooved(12)),
        near("holes-10", 0.7, || drilled(10)),
        near("holes-32", 0.7, || drilled(32)),
        near("holes-100", 0.7, || drilled(100)),
        near("cheese-100", 1.0, || cheese(100)),
        near("cheese-1000", 1.0, || cheese(1000)),
        near("cheese-10000", 1.0, || cheese(10000)),
        near("nest-100", 1.0, || nest(100)),
        near("nest-1000", 1.0, || nest(1000)),
        mouth("shell", || shell(false)),
        mouth("shell-chain", || shell(true)),
        mouth("chain-2144", chain),
        near("union-1000", 1.0, || balls(1000)),
        near("union-10000", 1.0, || balls(10000)),
        near("union-100000", 1.0, || balls(100_000)),
        near("mixed-200", 1.0, || mixed(200)),
    ]
}

fn leaf(shape: Shape, world_from_object: DAffine3) -> CsgLeaf {
    CsgLeaf { shape, world_from_object, material: MaterialIndex(0) }
}

fn ball(center: DVec3, radius: f64) -> CsgLeaf {
    leaf(Shape::Sphere { radius }, DAffine3::from_translation(center))
}

fn union_of(range: std::ops::Range<u32>) -> Csg {
    Csg::Union(range.map(Csg::Leaf).collect())
}

fn without(a: Csg, b: Csg) -> Csg {
    Csg::Difference(Box::new(a), Box::new(b))
}

fn point(rng: &mut Pcg64) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
}

/// Spheres with six grooves of one torus each.
fn grooved(count: u32) -> Vec<Solid> {
    let side = f64::from(count).sqrt().ceil() as u32;
    let sphere = |i: u32| {
        let at = DVec3::new(f64::from(i % side), f64::from(i / side), 0.0) * 2.3;
        let center = DAffine3::from_translation(at - DVec3::new(1.0, 1.0, 0.0) * 1.15 * f64::from(side - 1));
        let mut leaves = vec![leaf(Shape::Sphere { radius: 1.0 }, center)];
        for k in 0..6 {
            let turn = DAffine3::from_rotation_x(f64::from(k) * TAU / 12.0) * DAffine3::from_rotation_y(0.3);
            leaves.push(leaf(Shape::Torus { major: 1.0, minor: 0.06 }, center * turn));
        }
        Solid { tree: without(Csg::Leaf(0), union_of(1..7)), leaves }
    };
    (0..count).map(sphere).collect()
}

/// A cube with spherical holes.
fn cheese(holes: u32) -> Vec<Solid> {
    let mut rng = Pcg64::seed_from_u64(11);
    let mut leaves = vec![leaf(Shape::Box { min: DVec3::NEG_ONE, max: DVec3::ONE }, DAffine3::IDENTITY)];
    let radius = 0.9 / f64::from(holes).cbrt();
    leaves.extend((0..holes).map(|_| ball(point(&mut rng), radius * rng.random_range(0.5..1.0))));
    vec![Solid { tree: without(Csg::Leaf(0), union_of(1..holes + 1)), leaves }]
}

/// A snail shell: a shrinking spiral of overlapping spheres, hollowed at its mouth.
fn shell(chained: bool) -> Vec<Solid> {
    let place = |i: u32| {
        let shrink = 0.989228f64.powi(i as i32);
        DAffine3::from_rotation_z(5f64.to_radians() * f64::from(i)) * DAffine3::from_scale(DVec3::splat(shrink))
    };
    let bead = |i: u32, r: f64| {
        leaf(Shape::Sphere { radius: r }, place(i) * DAffine3::from_translation(DVec3::new(-1.0, 0.0, -2.0)))
    };
    let mut leaves: Vec<CsgLeaf> = (0..2048).map(|i| bead(i, 1.0)).collect();
    leaves.extend((0..96).map(|i| bead(i, 0.98)));
    let tree = if chained {
        // Each hollow after its beads: unions and differences in turn.
        (0..64).fold(Csg::Union(vec![]), |chain, k| {
            let chain = Csg::Union(vec![chain, union_of(32 * k..32 * (k + 1))]);
            if k < 3 { without(chain, union_of(2048 + 32 * k..2048 + 32 * (k + 1))) } else { chain }
        })
    } else {
        without(union_of(0..2048), union_of(2048..2144))
    };
    vec![Solid { tree, leaves }]
}

fn balls(count: u32) -> Vec<Solid> {
    let mut rng = Pcg64::seed_from_u64(12);
    let radius = 0.7 / f64::from(count).cbrt();
    let leaves = (0..count).map(|_| ball(point(&mut rng), radius * rng.random_range(0.5..1.0))).collect();
    vec![Solid { tree: union_of(0..count), leaves }]
}

/// A plate drilled by `n` times `n` cylinders.
fn drilled(n: u32) -> Vec<Solid> {
    let plate = Shape::Box { min: DVec3::new(-1.0, -1.0, -0.1), max: DVec3::new(1.0, 1.0, 0.1) };
    let mut leaves = vec![leaf(plate, DAffine3::IDENTITY)];
    let step = 2.0 / f64::from(n);
    for i in 0..n * n {
        let at = DVec3::new(f64::from(i % n) + 0.5, f64::from(i / n) + 0.5, 0.0) * step - DVec3::new(1.0, 1.0, 0.2);
        leaves.push(leaf(Shape::Cylinder { radius: 0.35 * step, height: 0.4 }, DAffine3::from_translation(at)));
    }
    vec![Solid { tree: without(Csg::Leaf(0), union_of(1..n * n + 1)), leaves }]
}

/// Nested differences: a ball less ten smaller ones on its surface, each of which is a ball less ten smaller ones, …
fn nest(count: usize) -> Vec<Solid> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let mut balls = vec![(DVec3::ZERO, 1.2)];
    for i in 1..count {
        let ((center, radius), k) = (balls[(i - 1) / 10], ((i - 1) % 10) as f64);
        let z = 1.0 - (2.0 * k + 1.0) / 10.0;
        let (sin, cos) = (golden * k).sin_cos();
        let way = (DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt()).with_z(z);
        balls.push((center + way * 0.9 * radius, 0.42 * radius));
    }
    let mut nodes: Vec<Option<Csg>> = (0..count as u32).map(|i| Some(Csg::Leaf(i))).collect();
    for i in (0..count).rev() {
        let children = 10 * i + 1..count.min(10 * i + 11);
        let below: Vec<Csg> = children.filter_map(|j| nodes[j].take()).collect();
        if !below.is_empty() {
            nodes[i] = Some(without(Csg::Leaf(i as u32), Csg::Union(below)));
        }
    }
    let leaves = balls.into_iter().map(|(center, radius)| ball(center, radius)).collect();
    vec![Solid { tree: nodes[0].take().expect("the outermost"), leaves }]
}

/// Beads of the shell, after each a dimple taken away: ((b0 − d0) ∪ b1) − d1 …, left-deep.
fn chain() -> Vec<Solid> {
    let mut leaves = vec![];
    let mut tree = Csg::Union(vec![]);
    for i in 0..1072u32 {
        let radius = 0.989228f64.powi(i as i32);
        let turn = DAffine3::from_rotation_z(5f64.to_radians() * f64::from(i));
        let center = turn.transform_point3(DVec3::new(-1.0, 0.0, -2.0)) * radius;
        let way = center.with_z(0.4 * radius).normalize();
        leaves.extend([ball(center, radius), ball(center + way * 0.95 * radius, 0.3 * radius)]);
        tree = without(Csg::Union(vec![tree, Csg::Leaf(2 * i)]), Csg::Leaf(2 * i + 1));
    }
    vec![Solid { tree, leaves }]
}

/// A random tree over all simple kinds: a union of lumps less another, ten leaves or less to a lump.
fn mixed(count: usize) -> Vec<Solid> {
    let mut rng = Pcg64::seed_from_u64(13);
    let mut leaves = vec![];
    let added = tree(&mut rng, &mut leaves, count - count / 4, None);
    let taken = tree(&mut rng, &mut leaves, count / 4, None);
    vec![Solid { tree: without(added, taken), leaves }]
}

fn tree(rng: &mut Pcg64, leaves: &mut Vec<CsgLeaf>, size: usize, lump: Option<DVec3>) -> Csg {
    let lump = lump.or_else(|| (size <= 10).then(|| point(rng) * 0.9));
    if let (Some(at), 1) = (lump, size) {
        leaves.push(lump_leaf(rng, at));
        return Csg::Leaf(leaves.len() as u32 - 1);
    }
    let left = if lump.is_some() { rng.random_range(1..size) } else { size / 2 };
    let (a, b) = (tree(rng, leaves, left, lump), tree(rng, leaves, size - left, lump));
    match rng.random_range(0..10) {
        _ if lump.is_none() => Csg::Union(vec![a, b]),
        0..5 => Csg::Union(vec![a, b]),
        5..9 => without(a, b),
        _ => Csg::Intersection(vec![a, b]),
    }
}

fn lump_leaf(rng: &mut Pcg64, at: DVec3) -> CsgLeaf {
    let mut size = || rng.random_range(0.12..0.4);
    let (a, b, c) = (size(), size(), size());
    let shape = match rng.random_range(0..5) {
        0 => Shape::Sphere { radius: a },
        1 => Shape::Box { min: DVec3::new(-a, -b, -c), max: DVec3::new(b, c, a) },
        2 => Shape::Cylinder { radius: 0.6 * a, height: 2.0 * b },
        3 => Shape::Cone { base_radius: a, top_radius: 0.3 * c, height: 1.5 * b },
        _ => Shape::Torus { major: a, minor: 0.4 * b },
    };
    let turn =
        DAffine3::from_rotation_z(rng.random_range(0.0..TAU)) * DAffine3::from_rotation_x(rng.random_range(0.0..TAU));
    let stretch = DAffine3::from_scale(DVec3::ONE + point(rng) * 0.3);
    leaf(shape, DAffine3::from_translation(at + point(rng) * 0.2) * turn * stretch)
}
