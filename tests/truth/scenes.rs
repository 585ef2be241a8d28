//! Random scenes and rays for the truth test, a function of a seed.
//!
//! Families, by turns: *friendly* (sizes and maps at random, mirrored and sheared ones among them), *hostile* (sizes and
//! places on a lattice, so that faces coincide and surfaces touch), *scales* (several solids from 10⁻⁹ to 10⁷ in one scene),
//! *crowds* (up to 200 leaves, and an instance).

use std::f64::consts::TAU;
use std::sync::Arc;

use arsc_accel::{Csg, CsgLeaf, FaceMaterial, Instance, MaterialIndex, Ray, SceneGeometry, Shape, Solid};
use arsc_geometry::{
    Aabb, ClosedMesh, DVec2, Hyperboloid, Lathe, Paraboloid, Placed, Polygon, Polyhedron, Prism, Superquadric,
};
use glam::{DAffine3, DMat3, DVec3};
use rand::Rng;
use rand_pcg::Pcg64;

use crate::meshes;

/// A scene, and what rays are aimed by.
pub struct Case {
    pub geometry: SceneGeometry,
    pub hostile: bool,
    /// Size of each solid, instances after solids.
    pub scales: Vec<f64>,
}

/// Materials from here on are those of single faces.
const OWN_FACES: u32 = 10_000;

pub fn vector(rng: &mut Pcg64, reach: f64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| rng.random_range(-reach..reach)))
}

/// A point of the half-unit lattice.
fn lattice(rng: &mut Pcg64, reach: i32) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(-2 * reach..=2 * reach)) * 0.5))
}

/// Every kind of shape from three sizes.
fn shape(rng: &mut Pcg64, a: f64, b: f64, c: f64) -> Shape {
    match rng.random_range(0..36) {
        0..5 => Shape::Sphere { radius: a },
        5..9 => Shape::Box { min: DVec3::new(-a, -b, -c), max: DVec3::new(b, c, a) },
        9..12 => Shape::Cylinder { radius: 0.5 * a, height: 2.0 * b },
        12..15 => Shape::Cone { base_radius: a, top_radius: if c >= 0.8 || c == a { 0.0 } else { c }, height: b },
        15..18 => Shape::Torus { major: a, minor: if c >= 1.0 { a + 0.5 * b } else { 0.5 * b } },
        18..20 => Shape::Paraboloid(Paraboloid { radius: a, height: b }),
        20..22 => Shape::Hyperboloid(Hyperboloid { radius: a, slope: b, half_height: c, two_sheets: false }),
        22 => Shape::Hyperboloid(Hyperboloid { radius: a, slope: b, half_height: c + a / b, two_sheets: true }),
        23 => Shape::InfiniteCylinder { radius: 0.5 * a },
        24..26 => Shape::HalfSpace,
        26..28 => prism(a, b, c),
        28..30 => polyhedron(a, b, c),
        30 => superquadric(a, b, c),
        31..34 => lathe(a, b, c),
        _ => mesh(a, b, c),
    }
}

/// An L, or a plate with a hole.
fn prism(a: f64, b: f64, c: f64) -> Shape {
    let at = DVec2::new;
    let rings = if b < c {
        vec![vec![at(-a, -b), at(a, -b), at(a, 0.0), at(0.0, 0.0), at(0.0, c), at(-a, c)]]
    } else {
        let (x, y) = (0.5 * a, 0.5 * b);
        let outline = vec![at(-a, -b), at(a, -b), at(a, b), at(-a, b)];
        vec![outline, vec![at(-x, -y), at(-x, y), at(x, y), at(x, -y)]]
    };
    let polygon = Polygon::new(rings).expect("a simple polygon");
    Shape::Prism(Arc::new(Prism::new(polygon, c).expect("a height")))
}

/// An octahedron of three sizes, or a wedge.
fn polyhedron(a: f64, b: f64, c: f64) -> Shape {
    let (x, y, z) = (DVec3::X * a, DVec3::Y * b, DVec3::Z * c);
    let points = if a < b { vec![x, -x, y, -y, z, -z] } else { vec![-x, x, -x + y, x + y, -x + z, x + z] };
    Shape::Polyhedron(Arc::new(Polyhedron::new(points).expect("a hull")))
}

/// A vase, a ring, or a spline of either.
fn lathe(a: f64, b: f64, c: f64) -> Shape {
    let at = DVec2::new;
    let closed = b < c;
    let points = if closed {
        vec![at(a, -b), at(a + c, 0.0), at(a, b), at(a + 0.25 * c, 0.0)]
    } else {
        vec![at(0.5 * a, -c), at(a, 0.0), at(0.5 * a, 0.5 * b), at(b, b), at(0.0, b + 0.5 * c)]
    };
    Shape::Lathe(Arc::new(Lathe::new(points, closed, a < c).expect("a profile")))
}

/// Round, box-like and pinched ones.
fn superquadric(a: f64, b: f64, c: f64) -> Shape {
    let exponent = |x: f64, y: f64| if x < y { 0.3 + 0.5 * x } else { 0.5 + 1.5 * x };
    Shape::Superquadric(Arc::new(Superquadric::new(exponent(a, b), exponent(b, c)).expect("exponents")))
}

/// A box, a ball or a ring of triangles.
fn mesh(a: f64, b: f64, c: f64) -> Shape {
    let triangles = if a < b {
        meshes::cube([-a, -b, 0.0], [a, b, c])
    } else if b < c {
        meshes::sphere(4, 7, a)
    } else {
        meshes::torus(5, 4, a + 0.25, 0.25)
    };
    Shape::Mesh(Arc::new(ClosedMesh::new("truth".into(), triangles).expect("a closed mesh").0))
}

fn friendly_leaf(rng: &mut Pcg64) -> (Shape, DAffine3) {
    let mut size = || rng.random_range(0.3..1.2);
    let (a, b, c) = (size(), size(), size());
    let rotation = DMat3::from_axis_angle(vector(rng, 1.0).normalize(), rng.random_range(0.0..TAU));
    let stretch = match rng.random_range(0..4) {
        0 => DMat3::from_diagonal(DVec3::new(-1.0, 0.7, 1.4)),
        1 => DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::new(-0.2, 0.4, 0.9)),
        _ => DMat3::IDENTITY,
    };
    (shape(rng, a, b, c), DAffine3 { matrix3: stretch * rotation, translation: vector(rng, 1.5) })
}

/// Quarter turns, mirrors and now and then a shear along the lattice.
fn hostile_leaf(rng: &mut Pcg64) -> (Shape, DAffine3) {
    let mut size = || f64::from(rng.random_range(1..4)) * 0.5;
    let (a, b, c) = (size(), size(), size());
    let sign = |rng: &mut Pcg64| if rng.random() { 1.0 } else { -1.0 };
    let axes = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1]][rng.random_range(0..4)];
    let mut matrix = DMat3::from_cols(
        DVec3::AXES[axes[0]] * sign(rng),
        DVec3::AXES[axes[1]] * sign(rng),
        DVec3::AXES[axes[2]] * sign(rng),
    );
    if rng.random_range(0..6) == 0 {
        matrix = DMat3::from_cols(DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Z) * matrix;
    }
    (shape(rng, a, b, c), DAffine3 { matrix3: matrix, translation: lattice(rng, 1) })
}

fn tree(rng: &mut Pcg64, leaves: &mut Vec<CsgLeaf>, size: usize, make: &mut dyn FnMut(&mut Pcg64) -> CsgLeaf) -> Csg {
    if size <= 1 {
        if !leaves.is_empty() && rng.random_range(0..25) == 0 {
            return Csg::Leaf(rng.random_range(0..leaves.len()) as u32);
        }
        let leaf = make(rng);
        leaves.push(leaf);
        return Csg::Leaf(leaves.len() as u32 - 1);
    }
    let left = rng.random_range(1..size);
    let mut child = |rng: &mut Pcg64, size| tree(rng, leaves, size, make);
    let (a, b) = (child(rng, left), child(rng, size - left));
    match rng.random_range(0..10) {
        0..5 => Csg::Union(vec![a, b]),
        5..8 => Csg::Difference(Box::new(a), Box::new(b)),
        _ => Csg::Intersection(vec![a, b]),
    }
}

fn solid(rng: &mut Pcg64, size: usize, hostile: bool, outer: DAffine3, materials: &mut u32) -> Solid {
    let mut leaves = Vec::new();
    let mut make = |rng: &mut Pcg64| {
        let (shape, map) = if hostile { hostile_leaf(rng) } else { friendly_leaf(rng) };
        *materials += 1;
        CsgLeaf { shape, world_from_object: outer * map, material: MaterialIndex(*materials - 1) }
    };
    let tree = tree(rng, &mut leaves, size, &mut make);
    Solid { tree, leaves }
}

pub fn case(seed: u64, rng: &mut Pcg64) -> Case {
    let mut case = plain_case(seed, rng);
    paint_faces(&mut case.geometry);
    case
}

/// Two of the faces of every other leaf show a material of their own.
fn paint_faces(geometry: &mut SceneGeometry) {
    let leaves = geometry.solids.iter().flat_map(|solid| &solid.leaves);
    let leaves = leaves.chain(geometry.instances.iter().flat_map(|instance| &instance.solid.leaves));
    for leaf in leaves.filter(|leaf| leaf.material.0 % 2 == 0 && leaf.shape.face_count() > 2) {
        let own = |face: u32| MaterialIndex(OWN_FACES + 2 * leaf.material.0 + face % 2);
        let paint = |face| FaceMaterial { base: leaf.material, face, material: own(face) };
        geometry.faces.extend([1, 2].map(paint));
    }
}

fn plain_case(seed: u64, rng: &mut Pcg64) -> Case {
    let mut materials = 0;
    let scaled = |scale: f64| DAffine3::from_scale(DVec3::splat(scale));
    let mut geometry = SceneGeometry::default();
    let mut scales = Vec::new();
    let small = [1, 2, 3, 5, 8, 13, 25, 40];
    // Crowds cost as much as all others together when they are one in sixteen.
    let family = if seed % 16 == 3 { 3 } else { seed % 3 };
    let hostile = match family {
        0 | 1 => {
            let scale = if rng.random() { 1.0 } else { [1e-9, 1e-3, 0.1, 37.0, 1e7][rng.random_range(0..5)] };
            let size = small[rng.random_range(0..small.len())];
            geometry.solids.push(solid(rng, size, family == 1, scaled(scale), &mut materials));
            scales.push(scale);
            family == 1
        }
        2 => {
            let hostile = rng.random();
            for _ in 0..rng.random_range(2..5) {
                let scale = 10f64.powi(rng.random_range(-9..8));
                let size = small[rng.random_range(0..5)];
                // Beside the origin, so that the small ones are not far from it in their own terms.
                let place = DAffine3::from_translation(vector(rng, 2.0) * scale);
                let place = if hostile { DAffine3::IDENTITY } else { place };
                geometry.solids.push(solid(rng, size, hostile, place * scaled(scale), &mut materials));
                scales.push(scale);
            }
            hostile
        }
        _ => {
            let hostile = rng.random_range(0..3) == 0;
            let size = rng.random_range(20..200);
            geometry.solids.push(solid(rng, size, hostile, DAffine3::IDENTITY, &mut materials));
            let size = rng.random_range(2..20);
            let shared = Arc::new(solid(rng, size, hostile, DAffine3::IDENTITY, &mut materials));
            let (_, frame) = if hostile { hostile_leaf(rng) } else { friendly_leaf(rng) };
            geometry.instances.push(Instance { solid: shared, world_from_object: frame });
            scales.extend([1.0, 1.0]);
            hostile
        }
    };
    Case { geometry, hostile, scales }
}

/// Planes across an axis at which cells are likely to be cut: faces of the leaves' boxes, and sixteenths of their hull.
fn cut(solid: &Solid, axis: usize, rng: &mut Pcg64) -> Option<f64> {
    let bounds = |leaf: &CsgLeaf| *Placed::new(leaf.shape.clone(), leaf.world_from_object).expect("valid").bounds();
    let finite = |b: &Aabb| b.is_finite();
    let at = if rng.random() {
        let leaf = bounds(&solid.leaves[rng.random_range(0..solid.leaves.len())]);
        if rng.random() { leaf.min[axis] } else { leaf.max[axis] }
    } else {
        let hull = solid.leaves.iter().map(bounds).filter(finite).fold(Aabb::EMPTY, |a, b| a.union(&b));
        hull.min[axis] + hull.extent()[axis] * f64::from(rng.random_range(0..=16)) / 16.0
    };
    at.is_finite().then_some(at)
}

/// A ray towards one of the solids.
pub fn ray(case: &Case, rng: &mut Pcg64) -> Ray {
    let target = rng.random_range(0..case.scales.len());
    let scale = case.scales[target];
    let solid = case.geometry.solids.get(target);
    let family = rng.random_range(0..40);
    let (origin, towards) = if case.hostile && family < 3 {
        // Along the lattice: within faces and through edges.
        let origin = lattice(rng, 2);
        (origin, origin + DVec3::AXES[rng.random_range(0..3)] * if rng.random() { 1.0 } else { -1.0 })
    } else if case.hostile && family < 6 {
        // From lattice point to lattice point: through corners, rims and axes.
        (lattice(rng, 3), lattice(rng, 1))
    } else if let (6..9, Some(solid)) = (family, solid) {
        // On the plane between two cells.
        let (mut origin, mut towards) = (vector(rng, 4.0), vector(rng, 1.5));
        let axis = rng.random_range(0..3);
        if let Some(at) = cut(solid, axis, rng) {
            origin[axis] = at / scale;
            towards[axis] = at / scale;
        }
        (origin, towards)
    } else if let (9..12, Some(solid)) = (family, solid) {
        // From or along the surface of a leaf.
        let leaf = &solid.leaves[rng.random_range(0..solid.leaves.len())];
        let placed = Placed::new(leaf.shape.clone(), leaf.world_from_object).expect("valid");
        match placed.sample_area([rng.random(), rng.random()]) {
            Some(sample) => {
                let (p, n) = (sample.point.p / scale, sample.point.n);
                let way = vector(rng, 1.0);
                let way = if rng.random() { way - n * way.dot(n) } else { way };
                (p - way * rng.random_range(0..2) as f64, p + way)
            }
            None => (vector(rng, 2.0), vector(rng, 1.5)),
        }
    } else if family < 20 {
        (vector(rng, 1.5), vector(rng, 1.5))
    } else {
        let far = if family == 20 { 10f64.powf(rng.random_range(1.0..5.0)) } else { 4.0 };
        (vector(rng, 1.0).normalize() * far, vector(rng, 1.5))
    };
    let dir = (towards - origin).try_normalize().unwrap_or(DVec3::Z);
    Ray::new(origin * scale, dir)
}
