//! What `tests/truth.rs` has found, by hand: scenes and rays that a strategy once got wrong.

use arsc_accel::{BuildOptions, Csg, CsgLeaf, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy};
use glam::{DAffine3, DMat3, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn leaf(shape: Shape, world_from_object: DAffine3) -> CsgLeaf {
    CsgLeaf { shape, world_from_object, material: MaterialIndex(0) }
}

#[allow(clippy::needless_update)] // Options to come keep their defaults.
fn scenes(solids: Vec<Solid>) -> impl Iterator<Item = (Strategy, Scene)> {
    let geometry = SceneGeometry { solids, ..SceneGeometry::default() };
    Strategy::ALL.into_iter().map(move |strategy| {
        let options = BuildOptions { strategy, ..BuildOptions::default() };
        (strategy, Scene::build(geometry.clone(), options).unwrap())
    })
}

/// A half-space less itself is nothing, also beyond all bounded leaves.
#[test]
fn an_unbounded_leaf_less_itself_is_nothing() {
    let ball = Shape::Sphere { radius: 0.5 };
    let tree = Csg::Union(vec![Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(Csg::Leaf(0))), Csg::Leaf(1)]);
    let leaves = vec![leaf(Shape::HalfSpace, DAffine3::IDENTITY), leaf(ball, DAffine3::IDENTITY)];
    for (strategy, scene) in scenes(vec![Solid { tree, leaves }]) {
        let beside = Ray::new(DVec3::new(3.0, 0.0, 5.0), DVec3::NEG_Z);
        assert!(scene.intervals(&beside).is_empty() && scene.intersect(&beside).is_none(), "{strategy:?}");
        let through = scene.intervals(&Ray::new(DVec3::new(0.0, 0.0, 5.0), DVec3::NEG_Z));
        assert_eq!(through.iter().map(|i| (i.t_enter, i.t_exit)).collect::<Vec<_>>(), [(4.5, 5.5)], "{strategy:?}");
    }
}

/// A ball of a micrometre ends half a micrometre before a face of a box of 1 000 km, which is within the tolerance of the
/// box: of two solids that coincide the first is seen, whichever of them a strategy meets first.
#[test]
fn a_small_solid_before_the_face_of_a_large_one() {
    let large = Shape::Box { min: DVec3::splat(-1e6), max: DVec3::splat(0.0) };
    let small = Shape::Sphere { radius: 1e-6 };
    let single = |shape: &Shape, z: f64| Solid {
        tree: Csg::Leaf(0),
        leaves: vec![leaf(shape.clone(), DAffine3::from_translation(DVec3::new(-10.0, -10.0, z)))],
    };
    let box_at_zero = Solid { tree: Csg::Leaf(0), leaves: vec![leaf(large, DAffine3::IDENTITY)] };
    let ray = Ray::new(DVec3::new(-10.0, -10.0, 1.5e-6), DVec3::NEG_Z);
    for (strategy, scene) in scenes(vec![box_at_zero.clone(), single(&small, 1.5e-6)]) {
        assert_eq!(scene.intersect(&ray).unwrap().part.0, 0, "{strategy:?}: the box comes first");
    }
    for (strategy, scene) in scenes(vec![single(&small, 1.5e-6), box_at_zero.clone()]) {
        assert_eq!(scene.intersect(&ray).unwrap().part.0, 0, "{strategy:?}: the ball comes first");
    }
}

/// Far from an unbounded solid the padding of its boxes is nothing beside the roundings of crossings.
#[test]
fn half_spaces_far_away() {
    let up =
        DAffine3::from_translation(DVec3::new(0.1, 0.1, -0.05)) * DAffine3::from_scale(DVec3::new(-0.1, -0.1, -0.1));
    let matrix = DMat3::from_cols(DVec3::X * 0.1, DVec3::Z * 0.1, DVec3::Y * 0.1);
    let down = DAffine3 { matrix3: matrix, translation: DVec3::new(0.0, 0.1, 0.1) };
    let tree = Csg::Union(vec![Csg::Leaf(0), Csg::Leaf(1)]);
    let leaves = vec![leaf(Shape::HalfSpace, down), leaf(Shape::HalfSpace, up)];
    let mut rng = Pcg64::seed_from_u64(1);
    let far = |rng: &mut Pcg64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1e6..1e6)));
    for (strategy, scene) in scenes(vec![Solid { tree, leaves }]) {
        for _ in 0..500 {
            let origin = far(&mut rng);
            let ray = Ray::new(origin, (far(&mut rng) - origin).normalize());
            let starts_inside = origin.y < 0.1 || origin.z > -0.05;
            let first = scene.intervals(&ray).first().map(|i| i.t_enter);
            assert_eq!(first == Some(0.0), starts_inside, "{strategy:?} {ray:?}");
        }
    }
}
