//! What `tests/truth.rs` has found, by hand: scenes and rays that a strategy once got wrong.

#[path = "../../../tests/common/meshes.rs"]
mod meshes;

use std::sync::Arc;

use arsc_accel::{BuildOptions, Csg, CsgLeaf, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy};
use arsc_geometry::ClosedMesh;
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

/// A ray that starts in an unbounded solid and never leaves it is inside all along.
#[test]
fn inside_for_ever() {
    let map = DAffine3 {
        matrix3: DMat3::from_cols(
            DVec3::new(0.3418059967816367, 0.9397705338010233, 6.605642949786272e-5),
            DVec3::new(0.612328485123819, -0.22265801080093062, -0.758602159588372),
            DVec3::new(-0.7128972484657807, 0.25933521555221273, -0.6515541106496117),
        ),
        translation: DVec3::new(-1.3913457444189308, -1.3134143375210943, 1.0914768078788208),
    };
    let size = DVec3::new(0.8259693355632445, 0.832390837409313, 0.8291487610629666);
    let block = Shape::Box { min: -size, max: DVec3::new(size.y, size.z, size.x) };
    let tilted = DAffine3 {
        matrix3: DMat3::from_cols(
            DVec3::new(0.9484732902050892, 0.6272305027660933, -0.3554951977035645),
            DVec3::new(0.28284340559147797, -0.8664438928536514, -0.5884222827569531),
            DVec3::new(-0.5571337592364569, -0.12592409196180077, -0.580846263278675),
        ),
        translation: DVec3::new(0.9712334810926513, 0.7034538621050155, -0.19996545227295548),
    };
    let ring = Shape::Torus { major: 1.1604120955806083, minor: 0.1971814662899468 };
    let turned = DAffine3 {
        matrix3: DMat3::from_cols(
            DVec3::new(-0.0012199542906966565, -0.22587250584773486, 1.3251126470466033),
            DVec3::new(-0.06538303220486738, 0.6611571186417338, 0.4506730230586776),
            DVec3::new(0.997859494523766, 0.043045041194371705, 0.031149621575496323),
        ),
        translation: DVec3::new(1.4782361077914397, 1.3594352981839988, 0.2934826572568634),
    };
    let inner = Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(Csg::Leaf(1)));
    let tree = Csg::Difference(Box::new(inner), Box::new(Csg::Leaf(2)));
    let solid = Solid { tree, leaves: vec![leaf(Shape::HalfSpace, map), leaf(block, tilted), leaf(ring, turned)] };
    let ray = Ray::new(
        DVec3::new(1.4441153435836334, 1.9960399513429192, 1.6957201029377251),
        DVec3::new(-0.6448466908975908, -0.2749406722703825, 0.713148211783453),
    );
    assert!(ray.dir.is_normalized());
    for (strategy, scene) in scenes(vec![solid]) {
        let found = scene.intervals(&ray);
        let ends: Vec<_> = found.iter().map(|i| (i.t_enter, i.t_exit, i.enter.is_some())).collect();
        assert_eq!(ends, [(0.0, f64::INFINITY, false)], "{strategy:?}");
    }
}

fn closed(mesh: arsc_accel::TriangleMesh) -> Shape {
    Shape::Mesh(Arc::new(ClosedMesh::new("found".into(), mesh).unwrap().0))
}

/// A line through the topmost vertex of a mesh, and through nothing else of it, meets nothing.
#[test]
fn a_vertex_touched() {
    for scale in [1e5, 1.0, 1e-9] {
        let map = DAffine3::from_scale(DVec3::splat(scale));
        let solid = Solid { tree: Csg::Leaf(0), leaves: vec![leaf(closed(meshes::sphere(4, 7, 0.5)), map)] };
        for (strategy, scene) in scenes(vec![solid]) {
            for i in 0..200 {
                let around = f64::from(i) * 0.1;
                let dir = DVec3::new(around.cos(), around.sin(), 0.0);
                let ray = Ray::new((DVec3::Z * 0.5 - dir * 2.0) * scale, dir);
                assert_eq!(scene.intersect(&ray).map(|hit| hit.t), None, "{strategy:?} {ray:?}");
                assert!(!scene.occluded(&ray) && scene.intervals(&ray).is_empty(), "{strategy:?} {ray:?}");
            }
        }
    }
}

/// Between points of a lattice, along faces and through edges and corners of meshes, strategies agree.
#[test]
fn lines_along_faces_and_through_corners_of_meshes() {
    let mut rng = Pcg64::seed_from_u64(2);
    let block = closed(meshes::cube([-0.5, -1.0, 0.0], [0.5, 1.0, 1.0]));
    let ball = closed(meshes::sphere(4, 7, 1.0));
    let point = |rng: &mut Pcg64, reach: i32| {
        DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(-reach..=reach)) * 0.5))
    };
    for tree in [Csg::Leaf(0), Csg::Leaf(1), Csg::Difference(Box::new(Csg::Leaf(1)), Box::new(Csg::Leaf(0)))] {
        let map = DAffine3::from_scale(DVec3::splat(1e5));
        let leaves = vec![leaf(block.clone(), map), leaf(ball.clone(), map)];
        let built: Vec<_> = scenes(vec![Solid { tree, leaves }]).collect();
        for _ in 0..4000 {
            let (from, to) = (point(&mut rng, 6), point(&mut rng, 2));
            let Some(dir) = (to - from).try_normalize() else { continue };
            let ray = Ray::new(from * 1e5, dir);
            let inside = |scene: &Scene| scene.intervals(&ray).iter().map(|i| i.t_exit - i.t_enter).sum::<f64>();
            let nearest = |scene: &Scene| scene.intersect(&ray).map_or(-1.0, |hit| hit.t);
            let all = built.iter().map(|(strategy, scene)| (strategy, inside(scene), nearest(scene)));
            let all: Vec<_> = all.collect();
            let agree = all.iter().all(|one| (one.1 - all[1].1).abs() < 1e-4 && (one.2 - all[1].2).abs() < 1e-4);
            assert!(agree, "{ray:?} {all:?}");
        }
    }
}

/// A line that enters a mesh through a vertex passes three triangles there; the one that is hit faces the line.
#[test]
fn the_triangle_hit_at_a_vertex_faces_the_line() {
    let ring = closed(meshes::torus(5, 4, 1.25, 0.25));
    let mesh = meshes::torus(5, 4, 1.25, 0.25);
    let map = DAffine3::from_translation(DVec3::new(0.5, 0.25, -0.125));
    let solid = Solid { tree: Csg::Leaf(0), leaves: vec![leaf(ring, map)] };
    let mut rng = Pcg64::seed_from_u64(3);
    for (strategy, scene) in scenes(vec![solid]) {
        for i in 0..4000 {
            let vertex = map.transform_point3(mesh.position(i % mesh.positions.len() as u32));
            let from = DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(-8..=8)) * 0.25));
            let ray = Ray::new(from, (vertex - from).normalize());
            for interval in scene.intervals(&ray) {
                let cosine = |hit: &Option<arsc_accel::Hit>| hit.as_ref().map_or(0.0, |hit| hit.ng.dot(ray.dir));
                let (enter, exit) = (cosine(&interval.enter), cosine(&interval.exit));
                assert!(enter < 1e-6 && exit > -1e-6, "{strategy:?} {ray:?} {interval:?}");
            }
        }
    }
}
