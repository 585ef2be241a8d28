//! Over budget: as right as before, with fewer and larger cells.

use arsc_accel::{
    Budget, BuildOptions, Csg, CsgLeaf, Instance, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy,
};
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

const HOLES: u32 = 400;

fn point(rng: &mut Pcg64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
}

fn cheese() -> Solid {
    let mut rng = Pcg64::seed_from_u64(1);
    let leaf =
        |shape, at| CsgLeaf { shape, world_from_object: DAffine3::from_translation(at), material: MaterialIndex(0) };
    let mut leaves = vec![leaf(Shape::Box { min: DVec3::NEG_ONE, max: DVec3::ONE }, DVec3::ZERO)];
    leaves.extend((0..HOLES).map(|_| leaf(Shape::Sphere { radius: 0.12 }, point(&mut rng))));
    let holes = Csg::Union((1..=HOLES).map(Csg::Leaf).collect());
    Solid { tree: Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(holes)), leaves }
}

/// A cheese, and two instances of one more.
fn scene(strategy: Strategy, budget: Budget) -> Scene {
    let shared = Arc::new(cheese());
    let place =
        |x: f64| Instance { solid: shared.clone(), world_from_object: DAffine3::from_translation(DVec3::X * x) };
    let geometry =
        SceneGeometry { solids: vec![cheese()], instances: vec![place(3.0), place(6.0)], ..SceneGeometry::default() };
    Scene::build(geometry, BuildOptions { strategy, budget }).unwrap()
}

fn rays() -> Vec<Ray> {
    let mut rng = Pcg64::seed_from_u64(2);
    let through = |_| {
        let (from, to) = (point(&mut rng).normalize() * 9.0, point(&mut rng) * DVec3::new(7.0, 1.0, 1.0));
        Ray::new(from, (to - from).normalize())
    };
    (0..500).map(through).collect()
}

#[test]
fn over_budget_rays_are_as_right_and_take_more_tests() {
    let rays = rays();
    let tests = |scene: &Scene| rays.iter().map(|ray| u64::from(scene.count_tests(ray))).sum::<u64>();
    for strategy in [Strategy::Local, Strategy::Native, Strategy::Kd] {
        let free = scene(strategy, Budget::UNLIMITED);
        let mut last = (free.stats().cells + 1, tests(&free));
        for cells in [100, 30, 2] {
            let scarce = scene(strategy, Budget { cells, ..Budget::UNLIMITED });
            let now = (scarce.stats().cells, tests(&scarce));
            assert!(now.0 <= cells, "{}: {} cells of {cells}", strategy.name(), now.0);
            assert!(now.0 < last.0 && now.1 > last.1, "{}: {now:?} after {last:?}", strategy.name());
            for ray in &rays {
                let (a, b) = (free.intersect(ray), scarce.intersect(ray));
                assert_eq!(a.map(|hit| hit.part), b.map(|hit| hit.part), "{}: {ray:?}", strategy.name());
                assert!(a.zip(b).is_none_or(|(a, b)| (a.t - b.t).abs() < 1e-9));
                let short = Ray { t_max: 8.0, ..*ray };
                assert_eq!(free.occluded(&short), scarce.occluded(&short));
            }
            last = now;
        }
    }
}

#[test]
fn memory_stays_near_the_budget() {
    for strategy in [Strategy::Local, Strategy::Native, Strategy::Kd] {
        // Embree's part depends on how many threads took blocks of it: the least of some builds is what is needed.
        let built = |bytes| scene(strategy, Budget { bytes, ..Budget::UNLIMITED }).stats().bytes;
        let used = |bytes| (0..8).map(|_| built(bytes)).min().unwrap();
        let (none, some, all) = (used(0), used(20_000), used(usize::MAX));
        assert!(none < some && some < all, "{}: {none}, {some}, {all}", strategy.name());
        assert!(some < none + 60_000, "{}: {some} with 20 kB more than {none}", strategy.name());
    }
}
