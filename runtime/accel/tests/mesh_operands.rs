//! Closed meshes as operands: the default strategy, whose triangles are Embree's where nothing else is near, against the
//! oracle, which counts crossings of whole lines.

#[path = "../../../tests/common/meshes.rs"]
mod meshes;

use std::sync::Arc;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, Hit, Instance, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy,
    TriangleMesh,
};
use arsc_geometry::ClosedMesh;
use glam::{DAffine3, DMat3, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn vector(rng: &mut Pcg64) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
}

fn closed(mesh: TriangleMesh) -> Shape {
    Shape::Mesh(Arc::new(ClosedMesh::new("test".into(), mesh).unwrap().0))
}

fn random_map(rng: &mut Pcg64, scale: f64) -> DAffine3 {
    let turn = DMat3::from_axis_angle(vector(rng).normalize(), rng.random_range(0.0..6.0));
    let mirror = if rng.random() { DVec3::new(-1.3, 1.0, 0.8) } else { DVec3::splat(0.9) };
    DAffine3 { matrix3: turn * DMat3::from_diagonal(mirror * scale), translation: vector(rng) * 0.5 * scale }
}

fn random_tree(rng: &mut Pcg64, leaves: &mut u32, depth: u32) -> Csg {
    if depth == 0 || rng.random_range(0..4) == 0 {
        *leaves += 1;
        return Csg::Leaf(*leaves - 1);
    }
    let (a, b) = (random_tree(rng, leaves, depth - 1), random_tree(rng, leaves, depth - 1));
    match rng.random_range(0..3) {
        0 => Csg::Union(vec![a, b]),
        1 => Csg::Intersection(vec![a, b]),
        _ => Csg::Difference(Box::new(a), Box::new(b)),
    }
}

fn random_solid(rng: &mut Pcg64, shapes: &[Shape], scale: f64) -> Solid {
    let mut count = 0;
    let tree = random_tree(rng, &mut count, 3);
    let leaf = |i| CsgLeaf {
        shape: shapes[rng.random_range(0..shapes.len())].clone(),
        world_from_object: random_map(rng, scale),
        material: MaterialIndex(i),
    };
    let leaves = (0..count).map(leaf).collect();
    Solid { tree, leaves }
}

fn same(a: &Option<Hit>, b: &Option<Hit>, scale: f64) -> bool {
    match (a, b) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            (a.t - b.t).abs() < 1e-9 * scale && (a.part == b.part || (a.p - b.p).length() < 1e-12 * scale)
        }
        _ => false,
    }
}

/// 2 kinds × 30 solids × 700 rays: nearest hits, occlusion and intervals of `local` are the oracle's.
#[test]
fn facets_and_cells_are_the_oracle() {
    let mut rng = Pcg64::seed_from_u64(91);
    let shapes = [
        closed(meshes::sphere(12, 16, 1.0)),
        closed(meshes::torus(16, 10, 0.7, 0.3)),
        closed(meshes::cube([-0.7; 3], [0.6; 3])),
        Shape::Sphere { radius: 0.8 },
        Shape::Box { min: DVec3::splat(-0.6), max: DVec3::splat(0.7) },
    ];
    let (mut hits, mut near_edges, mut rays) = (0u32, 0u32, 0u32);
    for round in 0..60 {
        let scale = [1.0, 1e-3, 1e5][round % 3];
        let solid = random_solid(&mut rng, if round % 2 == 0 { &shapes } else { &shapes[..3] }, scale);
        let map = random_map(&mut rng, 1.0);
        let scene = |strategy| {
            let mut geometry = SceneGeometry::default();
            if round % 5 == 4 {
                geometry.instances = vec![Instance { solid: Arc::new(solid.clone()), world_from_object: map }];
            } else {
                geometry.solids = vec![solid.clone()];
            }
            Scene::build(geometry, BuildOptions { strategy, ..BuildOptions::default() }).unwrap()
        };
        let (local, oracle) = (scene(Strategy::Local), scene(Strategy::Oracle));
        for _ in 0..700 {
            let reach = if rng.random() { 4.0 } else { 0.7 };
            let origin = vector(&mut rng) * reach * scale;
            let ray = Ray::new(origin, (vector(&mut rng) * scale - origin).normalize());
            let (found, expected) = (local.intersect(&ray), oracle.intersect(&ray));
            rays += 1;
            hits += u32::from(expected.is_some());
            let t_max = rng.random_range(0.0..4.0) * scale;
            let blocked = Ray { t_max, ..ray };
            let lengths = [&local, &oracle]
                .map(|scene| scene.intervals(&ray).iter().map(|i| i.t_exit.min(1e9) - i.t_enter).sum::<f64>());
            let agree = same(&found, &expected, scale)
                && local.occluded(&blocked) == expected.is_some_and(|hit| hit.t < t_max)
                && (lengths[0] - lengths[1]).abs() < 1e-9 * scale;
            near_edges += u32::from(!agree);
        }
    }
    assert!(hits > rays / 5, "{hits} of {rays}");
    assert_eq!(near_edges, 0);
}

/// What leaves a facet does not meet it again, and nothing leaks out of a closed mesh.
#[test]
fn meshes_neither_shadow_themselves_nor_leak() {
    let mut rng = Pcg64::seed_from_u64(92);
    for scale in [1.0, 1e-4, 1e5] {
        let tree = Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(Csg::Leaf(1)));
        let leaf = |mesh, i, at: f64| CsgLeaf {
            shape: closed(mesh),
            world_from_object: DAffine3::from_scale(DVec3::splat(scale))
                * DAffine3::from_translation(DVec3::new(at, 0.3 * at, 0.0)),
            material: MaterialIndex(i),
        };
        let leaves = vec![leaf(meshes::sphere(30, 40, 1.0), 0, 0.0), leaf(meshes::sphere(20, 30, 0.6), 1, 0.9)];
        let geometry = SceneGeometry { solids: vec![Solid { tree, leaves }], ..SceneGeometry::default() };
        let scene = Scene::build(geometry, BuildOptions::default()).unwrap();
        for _ in 0..4000 {
            let origin = vector(&mut rng).normalize() * 3.0 * scale;
            let ray = Ray::new(origin, (vector(&mut rng) * 0.9 * scale - origin).normalize());
            let Some(hit) = scene.intersect(&ray) else { continue };
            assert!(hit.ng.dot(ray.dir) < 0.0, "{hit:?}");
            // Straight on into the solid: it must be left again, and further on.
            let within = scene.intersect(&hit.spawn(ray.dir)).expect("a way out");
            assert!(within.ng.dot(ray.dir) > 0.0, "{hit:?} {within:?}");
            // Back where it came from: free.
            assert!(!scene.occluded(&hit.spawn(-ray.dir)), "{hit:?}");
        }
    }
}
