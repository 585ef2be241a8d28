//! Laws of set algebra along rays, and instances against solids that are written out.

use std::sync::Arc;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, Instance, Interval, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy,
};
use glam::{DAffine3, DMat3, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn vector(rng: &mut Pcg64) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
}

fn map(rng: &mut Pcg64) -> DAffine3 {
    let turn = DMat3::from_axis_angle(vector(rng).normalize(), rng.random_range(0.0..6.0));
    let stretch = DMat3::from_cols(DVec3::X * 0.8, DVec3::new(0.3, 1.1, 0.0), DVec3::new(0.0, -0.2, -0.9));
    DAffine3 { matrix3: turn * if rng.random() { stretch } else { DMat3::IDENTITY }, translation: vector(rng) }
}

fn leaves(rng: &mut Pcg64, count: u32) -> Vec<CsgLeaf> {
    let shape = |rng: &mut Pcg64| {
        let r = rng.random_range(0.3..0.9);
        match rng.random_range(0..5) {
            0 => Shape::Box { min: DVec3::splat(-r), max: DVec3::new(r, 0.4, 0.7) },
            1 => Shape::Torus { major: r, minor: 0.25 },
            2 => Shape::Cylinder { radius: r, height: 1.0 },
            3 => Shape::Cone { base_radius: r, top_radius: 0.0, height: 1.2 },
            _ => Shape::Sphere { radius: r },
        }
    };
    let leaf = |i| CsgLeaf { shape: shape(rng), world_from_object: map(rng), material: MaterialIndex(i) };
    (0..count).map(leaf).collect()
}

fn tree(rng: &mut Pcg64, range: std::ops::Range<u32>) -> Csg {
    if range.len() == 1 {
        return Csg::Leaf(range.start);
    }
    let middle = rng.random_range(range.start + 1..range.end);
    let (a, b) = (tree(rng, range.start..middle), tree(rng, middle..range.end));
    match rng.random_range(0..4) {
        0 => Csg::Difference(Box::new(a), Box::new(b)),
        1 => Csg::Intersection(vec![a, b]),
        _ => Csg::Union(vec![a, b]),
    }
}

fn scene(tree: Csg, leaves: &[CsgLeaf], strategy: Strategy) -> Scene {
    let solids = vec![Solid { tree, leaves: leaves.to_vec() }];
    Scene::build(SceneGeometry { solids, ..SceneGeometry::default() }, BuildOptions::from(strategy)).unwrap()
}

fn length(intervals: &[Interval]) -> f64 {
    intervals.iter().map(|i| i.t_exit - i.t_enter).sum()
}

fn random_ray(rng: &mut Pcg64) -> Ray {
    let origin = vector(rng) * rng.random_range(0.5..4.0);
    Ray::new(origin, (vector(rng) - origin).normalize())
}

/// |A| + |B| = |A ∪ B| + |A ∩ B| and |A − B| = |A| − |A ∩ B| along every ray; the De Morgan form of the union too.
/// 60 pairs of trees, 400 rays each.
#[test]
fn lengths_add_up() {
    let mut rng = Pcg64::seed_from_u64(21);
    let mut total = 0.0;
    for case in 0..60 {
        let count = rng.random_range(2..14);
        let leaves = leaves(&mut rng, 2 * count);
        let (a, b) = (tree(&mut rng, 0..count), tree(&mut rng, count..2 * count));
        let everything = CsgLeaf {
            shape: Shape::Box { min: DVec3::splat(-50.0), max: DVec3::splat(50.0) },
            world_from_object: DAffine3::IDENTITY,
            material: MaterialIndex(0),
        };
        let mut with_frame = leaves.clone();
        with_frame.push(everything);
        let frame = || Box::new(Csg::Leaf(2 * count));
        let not = |x: &Csg| Csg::Difference(frame(), Box::new(x.clone()));
        let strategy = Strategy::ALL[case as usize % Strategy::ALL.len()];
        let build = |tree: Csg| scene(tree, &with_frame, strategy);
        let (sa, sb) = (build(a.clone()), build(b.clone()));
        let union = build(Csg::Union(vec![a.clone(), b.clone()]));
        let both = build(Csg::Intersection(vec![a.clone(), b.clone()]));
        let difference = build(Csg::Difference(Box::new(a.clone()), Box::new(b.clone())));
        let de_morgan = build(Csg::Difference(frame(), Box::new(Csg::Intersection(vec![not(&a), not(&b)]))));
        for _ in 0..400 {
            let ray = random_ray(&mut rng);
            let measure = |scene: &Scene| length(&scene.intervals(&ray));
            let (a, b, u, i, d) = (measure(&sa), measure(&sb), measure(&union), measure(&both), measure(&difference));
            assert!((a + b - u - i).abs() < 1e-8, "case {case}, {ray:?}: {a} + {b} is not {u} + {i}");
            assert!((a - i - d).abs() < 1e-8, "case {case}, {ray:?}: {a} - {i} is not {d}");
            assert!((measure(&de_morgan) - u).abs() < 1e-8, "case {case}, {ray:?}: De Morgan");
            total += u;
        }
    }
    assert!(total > 1000.0, "the rays meet too little: {total}");
}

/// Instances of a tree, through mirrored and sheared maps at several scales, against the same leaves placed directly.
#[test]
fn instances_are_written_out_copies() {
    let mut rng = Pcg64::seed_from_u64(22);
    let mut hits = 0;
    for case in 0..40 {
        let count = rng.random_range(1..12);
        let leaves = leaves(&mut rng, count);
        let tree = tree(&mut rng, 0..count);
        let scale = [1e-3, 1.0, 1e4][case % 3];
        let places: Vec<DAffine3> = (0..3)
            .map(|_| {
                DAffine3::from_scale(DVec3::splat(scale))
                    * DAffine3::from_translation(vector(&mut rng) * 2.0)
                    * map(&mut rng)
            })
            .collect();
        let shared = Arc::new(Solid { tree: tree.clone(), leaves: leaves.clone() });
        let instances = places.iter().map(|&world_from_object| Instance { solid: shared.clone(), world_from_object });
        let written_out = places.iter().map(|place| {
            let moved = leaves.iter().map(|l| CsgLeaf { world_from_object: *place * l.world_from_object, ..l.clone() });
            Solid { tree: tree.clone(), leaves: moved.collect() }
        });
        let strategy = Strategy::ALL[case % Strategy::ALL.len()];
        let build = |geometry| Scene::build(geometry, BuildOptions::from(strategy)).unwrap();
        let instanced = build(SceneGeometry { instances: instances.collect(), ..SceneGeometry::default() });
        let direct = build(SceneGeometry { solids: written_out.collect(), ..SceneGeometry::default() });
        for _ in 0..500 {
            let ray = random_ray(&mut rng);
            let ray = Ray { origin: ray.origin * scale, ..ray };
            let (a, b) = (instanced.intersect(&ray), direct.intersect(&ray));
            assert_eq!(a.map(|h| h.part), b.map(|h| h.part), "case {case} {ray:?}");
            assert_eq!(instanced.occluded(&ray), a.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                hits += 1;
                assert!(
                    (a.t - b.t).abs() < 1e-9 * scale * 10.0 && a.ng.dot(b.ng) > 1.0 - 1e-6,
                    "case {case}: {a:?} {b:?}"
                );
                assert!((a.p - b.p).length() <= 1e-9 * scale * 10.0);
                let pdfs = (instanced.pdf_area(&a), direct.pdf_area(&b));
                assert!((pdfs.0 - pdfs.1).abs() < 1e-6 * pdfs.1);
            }
            let (a, b) = (instanced.intervals(&ray), direct.intervals(&ray));
            assert_eq!(a.len(), b.len());
            assert!((length(&a) - length(&b)).abs() < 1e-8 * scale);
        }
    }
    assert!(hits > 2000, "{hits}");
}
