//! Surfaces, instances and solids in one scene: the same under every strategy, the one without Embree included.

use std::sync::Arc;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, Instance, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy, Surface,
    SurfaceShape, TriangleMesh,
};
use glam::{DAffine3, DVec2, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

const MATERIAL: MaterialIndex = MaterialIndex(0);

fn point(rng: &mut Pcg64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
}

fn place(rng: &mut Pcg64, reach: f64) -> DAffine3 {
    let turn = DAffine3::from_axis_angle(point(rng).normalize(), rng.random_range(0.0..6.0));
    DAffine3::from_translation(point(rng) * reach) * turn
}

/// Small triangles at random.
fn dust(rng: &mut Pcg64, count: u32) -> TriangleMesh {
    let corners = |rng: &mut Pcg64| {
        let at = point(rng) * 3.0;
        [0, 1, 2].map(|_| (at + point(rng) * 0.3).as_vec3().to_array())
    };
    TriangleMesh {
        positions: (0..count).flat_map(|_| corners(rng)).collect(),
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..TriangleMesh::default()
    }
}

fn bitten(rng: &mut Pcg64, reach: f64) -> Solid {
    let mut leaf = |shape| CsgLeaf { shape, world_from_object: place(rng, reach), material: MATERIAL };
    let leaves = vec![
        leaf(Shape::Box { min: DVec3::NEG_ONE, max: DVec3::ONE }),
        leaf(Shape::Sphere { radius: 1.1 }),
        leaf(Shape::Cylinder { radius: 0.4, height: 2.0 }),
    ];
    let tree = Csg::Difference(Box::new(Csg::Union(vec![Csg::Leaf(0), Csg::Leaf(2)])), Box::new(Csg::Leaf(1)));
    Solid { tree, leaves }
}

fn scene(seed: u64) -> SceneGeometry {
    let rng = &mut Pcg64::seed_from_u64(seed);
    let surface = |shape, world_from_object| Surface { shape, world_from_object, material: MATERIAL };
    let mut surfaces = vec![
        surface(SurfaceShape::Mesh(Arc::new(dust(rng, 300))), DAffine3::IDENTITY),
        surface(SurfaceShape::Plane, DAffine3::from_translation(DVec3::NEG_Z * 5.0)),
    ];
    for _ in 0..8 {
        surfaces.push(surface(SurfaceShape::Rectangle { size: DVec2::new(1.0, 0.5) }, place(rng, 3.0)));
        surfaces.push(surface(SurfaceShape::Disk { radius: 0.4 }, place(rng, 3.0)));
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        surfaces.push(surface(SurfaceShape::Quad(corners), place(rng, 3.0)));
    }
    let shared = Arc::new(bitten(rng, 0.2));
    let instances = (0..6).map(|_| Instance { solid: shared.clone(), world_from_object: place(rng, 4.0) }).collect();
    SceneGeometry { solids: vec![bitten(rng, 1.0), bitten(rng, 1.0)], surfaces, instances, faces: vec![] }
}

#[test]
fn mixed_scenes_are_the_same_under_every_strategy() {
    let (mut hits, mut kinds) = (0, [0; 2]);
    for seed in 0..4 {
        let geometry = scene(seed);
        let build = |strategy| Scene::build(geometry.clone(), BuildOptions::from(strategy)).unwrap();
        let oracle = build(Strategy::Oracle);
        let scenes = Strategy::ALL.map(|strategy| (strategy.name(), build(strategy)));
        let mut rng = Pcg64::seed_from_u64(100 + seed);
        for i in 0..1500 {
            let far = if i % 10 == 0 { 1e5 } else { 6.0 };
            let (from, to) = (point(&mut rng) * far, point(&mut rng) * 3.0);
            let ray = Ray::new(from, (to - from).normalize());
            let expected = oracle.intersect(&ray);
            let short = Ray { t_max: rng.random_range(0.5..1.2) * (to - from).length(), ..ray };
            let blocked = oracle.occluded(&short);
            for (name, scene) in &scenes {
                let hit = scene.intersect(&ray);
                assert_eq!(hit.map(|hit| hit.part), expected.map(|hit| hit.part), "{name}, seed {seed}: {ray:?}");
                let apart = hit.zip(expected).map_or(0.0, |(a, b)| (a.t - b.t).abs());
                assert!(apart < 1e-12 * far * 10.0, "{name}: {apart}");
                assert_eq!(scene.occluded(&short), blocked, "{name}, seed {seed}: {short:?}");
                assert_eq!(scene.intervals(&ray).len(), oracle.intervals(&ray).len());
            }
            if let Some(hit) = expected {
                hits += 1;
                kinds[usize::from(hit.closed)] += 1;
            }
        }
    }
    assert!(hits > 2000 && kinds.iter().all(|&count| count > 500), "{hits} {kinds:?}");
}
