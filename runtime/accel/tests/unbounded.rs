//! Solids of unbounded leaves alone: nothing of them is in a cell that Embree holds.

use arsc_accel::{BuildOptions, Csg, CsgLeaf, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy};
use glam::{DAffine3, DVec3};

fn scene(leaves: Vec<CsgLeaf>, tree: Csg, strategy: Strategy) -> Scene {
    let geometry = SceneGeometry { solids: vec![Solid { tree, leaves }], ..SceneGeometry::default() };
    Scene::build(geometry, BuildOptions::from(strategy)).expect("a scene")
}

fn leaf(shape: Shape, world_from_object: DAffine3) -> CsgLeaf {
    CsgLeaf { shape, world_from_object, material: MaterialIndex(0) }
}

#[test]
fn a_lone_half_space_is_hit() {
    for strategy in Strategy::ALL {
        let ground = leaf(Shape::HalfSpace, DAffine3::from_translation(DVec3::new(0.0, 0.0, -0.25)));
        let scene = scene(vec![ground], Csg::Leaf(0), strategy);
        let down = Ray::new(DVec3::new(20.0, 60.0, 5.0), DVec3::NEG_Z);
        let hit = scene.intersect(&down).unwrap_or_else(|| panic!("{strategy:?} misses the ground"));
        assert!((hit.t - 5.25).abs() < 1e-12 && hit.ng == DVec3::Z);
        assert!(scene.occluded(&down));
        assert_eq!(scene.intervals(&down).len(), 1);
        let up = Ray::new(DVec3::new(0.0, 0.0, 1.0), DVec3::Z);
        assert!(scene.intersect(&up).is_none() && !scene.occluded(&up));
    }
}

#[test]
fn a_slab_between_two_half_spaces_is_hit_from_both_sides() {
    for strategy in Strategy::ALL {
        let flipped = DAffine3::from_rotation_x(std::f64::consts::PI);
        let leaves = vec![
            leaf(Shape::HalfSpace, DAffine3::from_translation(DVec3::Z)),
            leaf(Shape::HalfSpace, DAffine3::from_translation(DVec3::NEG_Z) * flipped),
        ];
        let scene = scene(leaves, Csg::Intersection(vec![Csg::Leaf(0), Csg::Leaf(1)]), strategy);
        for (z, dir) in [(4.0, DVec3::NEG_Z), (-4.0, DVec3::Z)] {
            let hit = scene.intersect(&Ray::new(DVec3::new(1.0, 2.0, z), dir)).expect("the slab");
            assert!((hit.t - 3.0).abs() < 1e-12);
            assert!((hit.ng + dir).length() < 1e-12);
        }
    }
}

#[test]
fn an_infinite_cylinder_is_hit_far_from_the_origin() {
    for strategy in Strategy::ALL {
        let scene =
            scene(vec![leaf(Shape::InfiniteCylinder { radius: 2.0 }, DAffine3::IDENTITY)], Csg::Leaf(0), strategy);
        let hit = scene.intersect(&Ray::new(DVec3::new(5.0, 0.0, 1e4), DVec3::NEG_X)).expect("the cylinder");
        assert!((hit.t - 3.0).abs() < 1e-9);
    }
}
