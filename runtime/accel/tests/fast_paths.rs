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
