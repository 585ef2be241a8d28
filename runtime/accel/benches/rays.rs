//! Primary and shadow rays through CSG scenes, both strategies, one thread.
//!
//! `cargo bench -p arsc-accel [-- NAME…]` prints million rays per CPU-second of the tracing thread, cells, bytes and
//! build time. The oracle gets fewer rays where it is slow. On a machine that is shared compare within one run only.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::time::Instant;

use arsc_accel::{BuildOptions, Csg, CsgLeaf, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy};
use glam::{DAffine3, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

const WIDTH: usize = 500;
/// Seconds of CPU per measurement, about.
const BUDGET: f64 = 1.0;

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

/// CPU seconds of this thread, where the system tells.
fn cpu_seconds(since: Instant) -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = stat.and_then(|text| text.split(' ').next().and_then(|word| word.parse::<f64>().ok()));
    nanoseconds.map_or(since.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// Pixels in a scattered order, so that any number of them covers the picture.
fn pixel(i: usize) -> (f64, f64) {
    let n = WIDTH * WIDTH;
    let j = i * 104_729 % n;
    ((j % WIDTH) as f64 + 0.5, (j / WIDTH) as f64 + 0.5)
}

/// Million rays per CPU-second and mean tests per primary ray.
fn measure(scene: &Scene, eye: DVec3, target: DVec3) -> (f64, f64) {
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let up = right.cross(forward);
    let light = eye + (right + up * 2.0) * (target - eye).length();
    let spread = (FRAC_PI_2 / 2.4).tan();
    let clock = Instant::now();
    let start = cpu_seconds(clock);
    let (mut rays, mut hits, mut tests, mut i) = (0u64, 0u64, 0u64, 0);
    let mut lit = 0u64;
    while i < 4 * WIDTH * WIDTH && (i % 256 != 0 || cpu_seconds(clock) - start < BUDGET) {
        let (x, y) = pixel(i);
        let (x, y) = ((x / WIDTH as f64 - 0.5) * spread, (0.5 - y / WIDTH as f64) * spread);
        let ray = Ray::new(eye, (forward + right * x + up * y).normalize());
        rays += 1;
        if let Some(hit) = scene.intersect(&ray) {
            hits += 1;
            if let Some(shadow) = hit.spawn_to(light) {
                rays += 1;
                lit += u64::from(!scene.occluded(&shadow));
            }
        }
        i += 1;
    }
    let seconds = cpu_seconds(clock) - start;
    let n = i.min(2000);
    for i in 0..n {
        let (x, y) = pixel(i);
        let (x, y) = ((x / WIDTH as f64 - 0.5) * spread, (0.5 - y / WIDTH as f64) * spread);
        tests += u64::from(scene.count_tests(&Ray::new(eye, (forward + right * x + up * y).normalize())));
    }
    assert!(hits > 0 && lit > 0, "the camera sees nothing");
    (rays as f64 / seconds * 1e-6, tests as f64 / n as f64)
}

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).collect();
    let near = DVec3::new(2.4, -3.2, 2.1);
    let mouth = (DVec3::new(4.5, -8.0, 1.0), DVec3::new(0.0, 0.0, -1.6));
    type Make = Box<dyn Fn() -> Vec<Solid>>;
    let scenes: Vec<(&str, Make, DVec3, DVec3)> = vec![
        ("grooved-3", Box::new(|| grooved(3)), near * 1.6, DVec3::ZERO),
        ("grooved-12", Box::new(|| grooved(12)), near * 2.6, DVec3::ZERO),
        ("cheese-100", Box::new(|| cheese(100)), near, DVec3::ZERO),
        ("cheese-1000", Box::new(|| cheese(1000)), near, DVec3::ZERO),
        ("cheese-10000", Box::new(|| cheese(10000)), near, DVec3::ZERO),
        ("holes-32", Box::new(|| drilled(32)), near * 0.7, DVec3::ZERO),
        ("shell", Box::new(|| shell(false)), mouth.0, mouth.1),
        ("shell-chain", Box::new(|| shell(true)), mouth.0, mouth.1),
        ("union-1000", Box::new(|| balls(1000)), near, DVec3::ZERO),
        ("union-10000", Box::new(|| balls(10000)), near, DVec3::ZERO),
    ];
    println!(
        "{:<14}{:>10}{:>10}{:>9}{:>9}{:>10}{:>9}{:>9}",
        "scene", "leaves", "cells", "kB", "build s", "tree", "local", "tests"
    );
    for (name, make, eye, target) in scenes {
        if !wanted.is_empty() && !wanted.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        let build = |strategy| {
            let geometry = SceneGeometry { solids: make(), ..SceneGeometry::default() };
            Scene::build(geometry, BuildOptions::from(strategy)).expect("the scene can be built")
        };
        let local = build(Strategy::Local);
        let (speed, tests) = measure(&local, eye, target);
        let (oracle, _) = measure(&build(Strategy::Tree), eye, target);
        let stats = local.stats();
        println!(
            "{name:<14}{:>10}{:>10}{:>9}{:>9.3}{oracle:>10.3}{speed:>9.3}{tests:>9.2}",
            stats.primitives,
            stats.cells,
            stats.bytes / 1000,
            stats.build_time.as_secs_f64()
        );
    }
}
