//! The default strategy's short ways against the oracle: same part, same face, same side and the same bits of `t`.
//!
//! Seeded; every assertion is exact. `tests/strategies.rs` does the same for random trees of all shapes.

use std::f64::consts::TAU;

use arsc_accel::{BuildOptions, Csg, CsgLeaf, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy};
use glam::{DAffine3, DMat3, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn vector(rng: &mut Pcg64, reach: f64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| rng.random_range(-reach..reach)))
}

fn leaf(shape: Shape, world_from_object: DAffine3) -> CsgLeaf {
    CsgLeaf { shape, world_from_object, material: MaterialIndex(0) }
}

fn union_of(range: std::ops::Range<u32>) -> Csg {
    Csg::Union(range.map(Csg::Leaf).collect())
}

/// Scenes of one solid, by the default strategy and by the oracle.
fn scenes(solids: Vec<Solid>) -> [Scene; 2] {
    let geometry = SceneGeometry { solids, ..SceneGeometry::default() };
    [Strategy::Local, Strategy::Oracle]
        .map(|strategy| Scene::build(geometry.clone(), BuildOptions { strategy, ..Default::default() }).unwrap())
}

/// The nearest hit and occlusion up to some random distance; the hit's distance.
fn compare([local, oracle]: &[Scene; 2], ray: &Ray, t_max: f64) -> Option<f64> {
    let (found, expected) = (local.intersect(ray), oracle.intersect(ray));
    let outline = |hit: &arsc_accel::Hit| (hit.part, hit.face, hit.t.to_bits(), hit.ng.dot(ray.dir) > 0.0);
    assert_eq!(found.as_ref().map(outline), expected.as_ref().map(outline), "{ray:?}: {found:?} against {expected:?}");
    let short = Ray { t_max, ..*ray };
    assert_eq!(local.occluded(&short), oracle.occluded(&short), "{short:?}");
    expected.map(|hit| hit.t)
}

/// Balls less tori under maps of all kinds, seen from outside, from the surface and from within.
#[test]
fn deferred_tori_are_tori() {
    let mut rng = Pcg64::seed_from_u64(31);
    let (mut hits, mut grooves) = (0, 0);
    for _ in 0..40 {
        let mut leaves = vec![leaf(Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY)];
        for _ in 0..rng.random_range(1..7) {
            let turn = DMat3::from_axis_angle(vector(&mut rng, 1.0).normalize(), rng.random_range(0.0..TAU));
            let stretch = if rng.random() { DVec3::ONE } else { DVec3::new(1.0, -0.7, 1.3) };
            let minor = rng.random_range(0.02..0.4);
            let map = DAffine3::from_mat3(turn * DMat3::from_diagonal(stretch));
            leaves.push(leaf(Shape::Torus { major: 1.0, minor }, map));
        }
        let grooves_of = union_of(1..leaves.len() as u32);
        let tree = if rng.random_range(0..4) == 0 {
            Csg::Intersection(vec![Csg::Leaf(0), grooves_of])
        } else {
            Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(grooves_of))
        };
        let pair = scenes(vec![Solid { tree, leaves }]);
        for _ in 0..1500 {
            let origin = vector(&mut rng, 2.0);
            let ray = Ray::new(origin, (vector(&mut rng, 0.8) - origin).normalize());
            let t_max = rng.random_range(0.0..4.0);
            if compare(&pair, &ray, t_max).is_none() {
                continue;
            }
            let hit = pair[0].intersect(&ray).unwrap();
            hits += 1;
            grooves += u32::from(hit.part.0 > 0);
            // From the surface, to all sides.
            let next = hit.spawn(vector(&mut rng, 1.0).normalize());
            compare(&pair, &next, t_max);
        }
    }
    assert!(hits > 30_000 && grooves > 10_000, "{hits} hits, {grooves} in grooves");
}

/// A union's leaf: balls, boxes and tori, on the half-unit lattice if `coincident`, so that faces and edges coincide.
fn member(rng: &mut Pcg64, size: f64, coincident: bool) -> CsgLeaf {
    let snap = |x: f64| if coincident { (2.0 * x).round() * 0.5 } else { x };
    let at = vector(rng, 2.0).map(snap);
    let extent = snap(size * rng.random_range(0.5..1.5)).max(0.1 * size);
    let shape = match rng.random_range(0..5) {
        0 | 1 => Shape::Sphere { radius: extent },
        2 | 3 => Shape::Box { min: DVec3::splat(-extent), max: DVec3::new(extent, extent, extent * 2.0) },
        _ => Shape::Torus { major: extent, minor: 0.4 * extent },
    };
    leaf(shape, DAffine3::from_translation(at))
}

/// Unions of few and many leaves, rays from outside and from within, along and across coincident faces.
#[test]
fn unions_by_their_leaves_are_unions() {
    let mut rng = Pcg64::seed_from_u64(32);
    let (mut hits, mut within) = (0, 0);
    for case in 0..60 {
        let coincident = case % 2 == 1;
        let count = [1, 2, 3, 8, 40, 200][case % 6];
        let size = 1.2 / f64::from(count).cbrt();
        let leaves: Vec<CsgLeaf> = (0..count).map(|_| member(&mut rng, size, coincident)).collect();
        let pair = scenes(vec![Solid { tree: union_of(0..count), leaves }]);
        for _ in 0..1500 {
            let reach = if rng.random() { 2.0 } else { 6.0 };
            let origin = vector(&mut rng, reach);
            let mut dir = vector(&mut rng, 1.5) - origin;
            let mut origin = origin;
            if coincident && rng.random_range(0..4) == 0 {
                origin = origin.map(|x| (2.0 * x).round() * 0.5);
                dir = DVec3::AXES[rng.random_range(0..3)];
            }
            let ray = Ray::new(origin, dir.normalize());
            let t_max = rng.random_range(0.0..6.0);
            let Some(t) = compare(&pair, &ray, t_max) else { continue };
            hits += 1;
            within += u32::from(pair[0].intersect(&ray).unwrap().ng.dot(ray.dir) > 0.0);
            // All stretches inside.
            let stretches = pair.each_ref().map(|scene| scene.intervals(&ray));
            let ends = |list: &[arsc_accel::Interval]| -> Vec<_> {
                let part = |hit: Option<arsc_accel::Hit>| hit.map(|hit| (hit.part, hit.face));
                list.iter().map(|i| (i.t_enter.to_bits(), i.t_exit.to_bits(), part(i.enter), part(i.exit))).collect()
            };
            assert_eq!(ends(&stretches[0]), ends(&stretches[1]), "{ray:?}");
            // Just short of the surface, and just beyond it.
            for t_max in [t, t * (1.0 + 1e-15) + 1e-300] {
                let short = Ray { t_max, ..ray };
                assert_eq!(pair[0].occluded(&short), pair[1].occluded(&short), "{short:?}");
            }
        }
    }
    assert!(hits > 30_000 && within > 5_000, "{hits} hits, {within} from within");
}

/// Several unions, some as instances, and a union within which the camera is: what is seen behind them is right too.
#[test]
fn unions_beside_each_other() {
    let mut rng = Pcg64::seed_from_u64(33);
    let mut seen = [0; 4];
    for _ in 0..20 {
        let solid = |rng: &mut Pcg64, count: u32| {
            let leaves = (0..count).map(|_| member(rng, 0.5, false)).collect();
            Solid { tree: union_of(0..count), leaves }
        };
        let shared = std::sync::Arc::new(solid(&mut rng, 5));
        let instance = |rng: &mut Pcg64| arsc_accel::Instance {
            solid: shared.clone(),
            world_from_object: DAffine3::from_scale(DVec3::splat(0.8)) * DAffine3::from_translation(vector(rng, 1.0)),
        };
        let geometry = SceneGeometry {
            solids: vec![solid(&mut rng, 6), solid(&mut rng, 1), solid(&mut rng, 9)],
            instances: vec![instance(&mut rng), instance(&mut rng)],
            ..SceneGeometry::default()
        };
        let pair = [Strategy::Local, Strategy::Oracle]
            .map(|strategy| Scene::build(geometry.clone(), BuildOptions { strategy, ..Default::default() }).unwrap());
        for _ in 0..1500 {
            let ray = Ray::new(vector(&mut rng, 3.0), vector(&mut rng, 1.0).normalize());
            if compare(&pair, &ray, rng.random_range(0.0..5.0)).is_some() {
                let part = pair[0].intersect(&ray).unwrap().part.0;
                seen[[6, 7, 16].iter().filter(|&&first| part >= first).count()] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 500), "{seen:?}");
}
