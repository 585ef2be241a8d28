//! The suite for emissive parts: points chosen on a part, seen from a point outside, against rays that find the part.
//!
//! With p the density of chosen points per area, two estimates of the same must agree: the mean cosine of chosen points that
//! are visible and face the viewer, and the mean over uniform directions of 4 pi p r^2 where the part is hit.
//! Likewise the solid angle of the part: the mean of cos / (p r^2), and 4 pi times the share of directions that hit it.

use std::f64::consts::PI;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, MaterialIndex, PartId, Ray, Scene, SceneGeometry, Shape, Solid, Surface, SurfaceShape,
    TriangleMesh,
};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use rand::Rng;

use super::{mean, pair, random};
use crate::warp;

const SAMPLES: usize = 40_000;

fn leaf(shape: Shape, world_from_object: DAffine3) -> CsgLeaf {
    CsgLeaf { shape, world_from_object, material: MaterialIndex(0) }
}

fn scene_of(tree: Csg, leaves: Vec<CsgLeaf>) -> Scene {
    let geometry = SceneGeometry { solids: vec![Solid { tree, leaves }], ..SceneGeometry::default() };
    Scene::build(geometry, BuildOptions::default()).expect("valid geometry")
}

fn scene_of_surface(shape: SurfaceShape, world_from_object: DAffine3) -> Scene {
    let surfaces = vec![Surface { shape, world_from_object, material: MaterialIndex(0) }];
    let geometry = SceneGeometry { surfaces, ..SceneGeometry::default() };
    Scene::build(geometry, BuildOptions::default()).expect("valid geometry")
}

/// Part 0, from `eye`.
fn assert_conforms(name: &str, scene: &Scene, eye: DVec3) {
    let part = PartId(0);
    let mut random = random();
    // Cosine and weight of a point; zero where it is not seen.
    let mut choose = || {
        let sample = scene.sample_part(part, random.random(), pair(&mut random))?;
        let (distance, wi) = ((sample.p - eye).length(), (sample.p - eye).normalize());
        let cos = -wi.dot(sample.ng);
        let segment = Ray { origin: eye, dir: wi, t_max: distance * (1.0 - 1e-9) - 4.0 * sample.p_error };
        let visible = cos > 0.0 && !scene.occluded(&segment);
        visible.then(|| [cos, cos / (sample.pdf_area * distance * distance)])
    };
    let chosen: Vec<[f64; 2]> = (0..SAMPLES).map(|_| choose().unwrap_or_default()).collect();
    let mut find = || {
        let dir = warp::uniform_sphere(pair(&mut random));
        let hit = scene.intersect(&Ray::new(eye, dir)).filter(|hit| hit.part == part)?;
        let faces = dir.dot(hit.ng) < 0.0;
        faces.then(|| [4.0 * PI * scene.pdf_area(&hit) * hit.t * hit.t, 4.0 * PI])
    };
    let found: Vec<[f64; 2]> = (0..SAMPLES).map(|_| find().unwrap_or_default()).collect();
    let column = |values: &[[f64; 2]], i: usize| mean(values.iter().map(|v| v[i]));
    let same = |what: &str, a: (f64, f64), b: (f64, f64)| {
        let bound = 5.0 * (a.1 * a.1 + b.1 * b.1).sqrt();
        assert!((a.0 - b.0).abs() < bound && bound < 0.25 * a.0, "{name}, {what}: {a:?} and {b:?}");
    };
    same("mean cosine", column(&chosen, 0), column(&found, 0));
    same("solid angle", column(&chosen, 1), column(&found, 1));
}

/// Rotated, stretched, sheared, mirrored.
fn skew() -> DAffine3 {
    let stretch = DMat3::from_diagonal(DVec3::new(1.3, -0.6, 0.9));
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.3, 1.0, 0.0), DVec3::new(0.0, -0.2, 1.0));
    DAffine3 { matrix3: shear * stretch * DMat3::from_rotation_x(0.7), translation: DVec3::new(0.1, 0.2, -0.1) }
}

#[test]
fn leaves_of_every_shape() {
    for (shape, eye) in [
        (Shape::Sphere { radius: 1.0 }, DVec3::new(0.5, -2.0, 1.0)),
        (Shape::Box { min: DVec3::new(-0.5, -1.0, -0.4), max: DVec3::new(0.7, 0.6, 0.5) }, DVec3::new(1.4, 1.5, 1.0)),
        (Shape::Cylinder { radius: 0.7, height: 1.2 }, DVec3::new(0.8, -1.3, 2.0)),
        (Shape::Cone { base_radius: 1.0, top_radius: 0.3, height: 1.0 }, DVec3::new(1.0, -1.3, 1.7)),
        (Shape::Torus { major: 1.0, minor: 0.4 }, DVec3::new(0.3, -1.6, 1.4)),
    ] {
        for map in [DAffine3::IDENTITY, skew()] {
            let scene = scene_of(Csg::Leaf(0), vec![leaf(shape.clone(), map)]);
            assert_conforms(&format!("{shape:?}"), &scene, map.transform_point3(eye));
        }
    }
}

/// A sphere with a bite, seen from the bite's side and from behind; and the wall of the bite.
#[test]
fn leaves_that_are_cut() {
    let sphere = leaf(Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY);
    let bite = leaf(Shape::Sphere { radius: 0.8 }, DAffine3::from_translation(DVec3::new(0.0, -0.9, 0.2)));
    let without = |a: u32, b: u32| Csg::Difference(Box::new(Csg::Leaf(a)), Box::new(Csg::Leaf(b)));
    let scene = scene_of(without(0, 1), vec![sphere.clone(), bite.clone()]);
    assert_conforms("sphere", &scene, DVec3::new(1.0, -1.2, 0.5));
    assert_conforms("sphere from behind", &scene, DVec3::new(0.3, 1.5, 0.5));
    assert_conforms("wall", &scene_of(without(1, 0), vec![bite, sphere]), DVec3::new(0.3, -2.0, 0.5));
}

#[test]
fn open_surfaces() {
    let eye = DVec3::new(0.4, -0.5, 1.0);
    let quad = [DVec3::new(-1.0, -0.5, 0.0), DVec3::X, DVec3::new(1.1, 1.2, 0.0), DVec3::new(-0.6, 0.9, 0.0)];
    let mesh = TriangleMesh {
        positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.1], [1.0, 1.0, 0.4], [-1.0, 0.3, -0.3]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    };
    for shape in [
        SurfaceShape::Triangle([quad[0], quad[1], quad[2]]),
        SurfaceShape::Quad(quad),
        SurfaceShape::Rectangle { size: DVec2::new(1.5, 0.7) },
        SurfaceShape::Disk { radius: 0.8 },
        SurfaceShape::Mesh(mesh.into()),
    ] {
        assert_conforms(&format!("{shape:?}"), &scene_of_surface(shape.clone(), DAffine3::IDENTITY), eye);
        let map = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.2, 0.7, 1.1)), ..skew() };
        let scene = scene_of_surface(shape.clone(), map);
        assert_conforms(&format!("{shape:?}, mapped"), &scene, map.transform_point3(eye));
    }
}
