//! Volumes by ray integration against closed forms.
//!
//! Parallel rays, one in each square of a grid, at a random place in it (seeded): the lengths that they spend inside,
//! times the area of a square. Directions are oblique, so that lengths are continuous across the picture; then the
//! standard error falls with the square of the number of squares a side, and is near 10⁻⁴ here.

#[path = "../../../tests/common/meshes.rs"]
mod meshes;

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy, TriangleMesh,
};
use arsc_geometry::{ClosedMesh, Hyperboloid, Lathe, Paraboloid, Polygon, Polyhedron, Prism, Superquadric};
use glam::{DAffine3, DMat3, DVec2, DVec3, dvec2, dvec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// Squares a side.
const SIDE: usize = 300;
const TOLERANCE: f64 = 1e-3;

/// By rays along `dir`; the solid is within `reach` of the origin.
fn integrated(scene: &Scene, dir: DVec3, reach: f64) -> f64 {
    let (x, y) = dir.any_orthonormal_pair();
    let mut rng = Pcg64::seed_from_u64(7);
    let width = 2.0 * reach / SIDE as f64;
    let mut place = |i: usize| -reach + width * (i as f64 + rng.random::<f64>());
    let mut length = 0.0;
    for i in 0..SIDE * SIDE {
        let origin = x * place(i % SIDE) + y * place(i / SIDE) - dir * (2.0 * reach);
        let inside = scene.intervals(&Ray::new(origin, dir));
        length += inside.iter().map(|interval| interval.t_exit - interval.t_enter).sum::<f64>();
    }
    length * width * width
}

fn assert_tree(name: &str, tree: Csg, leaves: Vec<CsgLeaf>, reach: f64, volume: f64) {
    let geometry = SceneGeometry { solids: vec![Solid { tree, leaves }], ..SceneGeometry::default() };
    for strategy in [Strategy::Local, Strategy::Tree] {
        let options = BuildOptions { strategy, ..BuildOptions::default() };
        let scene = Scene::build(geometry.clone(), options).unwrap();
        // Each strategy from a side of its own.
        let dir = if strategy == Strategy::Local { dvec3(0.62, 0.41, -0.67) } else { dvec3(-0.35, 0.83, 0.44) };
        let found = integrated(&scene, dir.normalize(), reach);
        let error = (found / volume - 1.0).abs();
        assert!(error < TOLERANCE, "{name}, {}: {found} instead of {volume}, {error:.1e} off", strategy.name());
    }
}

fn leaf(shape: Shape, world_from_object: DAffine3) -> CsgLeaf {
    CsgLeaf { shape, world_from_object, material: MaterialIndex(0) }
}

fn at(shape: Shape, x: f64, y: f64, z: f64) -> CsgLeaf {
    leaf(shape, DAffine3::from_translation(dvec3(x, y, z)))
}

/// `a` without `b`.
fn without(a: CsgLeaf, b: CsgLeaf) -> (Csg, Vec<CsgLeaf>) {
    (Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(Csg::Leaf(1))), vec![a, b])
}

fn common(leaves: Vec<CsgLeaf>) -> (Csg, Vec<CsgLeaf>) {
    (Csg::Intersection((0..leaves.len() as u32).map(Csg::Leaf).collect()), leaves)
}

/// A shape by itself, under a map that turns, shears and mirrors it: volumes grow with the determinant.
fn assert_shape(name: &str, shape: Shape, reach: f64, volume: f64) {
    let shear = DMat3::from_cols(dvec3(1.1, 0.2, 0.0), dvec3(0.0, -0.8, 0.3), dvec3(0.1, 0.0, 0.9));
    let turn = DMat3::from_axis_angle(dvec3(1.0, 2.0, -0.5).normalize(), 0.7);
    let map = DAffine3::from_mat3(turn * shear);
    assert_tree(name, Csg::Leaf(0), vec![leaf(shape.clone(), DAffine3::IDENTITY)], reach, volume);
    // No vector's square grows by more than the largest column sum of the Gram matrix.
    let gram = shear.transpose() * shear;
    let growth =
        [gram.x_axis, gram.y_axis, gram.z_axis].map(|c| c.abs().element_sum()).into_iter().fold(0.0, f64::max).sqrt();
    let scaled = volume * shear.determinant().abs();
    assert_tree(&format!("{name}, mapped"), Csg::Leaf(0), vec![leaf(shape, map)], reach * growth, scaled);
}

fn ball(radius: f64) -> Shape {
    Shape::Sphere { radius }
}

fn ball_volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

fn cuboid(half: DVec3) -> Shape {
    Shape::Box { min: -half, max: half }
}

fn closed(mesh: TriangleMesh) -> Shape {
    Shape::Mesh(Arc::new(ClosedMesh::new("test".into(), mesh).unwrap().0))
}

/// By the divergence theorem.
fn mesh_volume(mesh: &TriangleMesh) -> f64 {
    let signed = |[a, b, c]: [DVec3; 3]| a.dot(b.cross(c)) / 6.0;
    (0..mesh.triangles.len()).map(|i| signed(mesh.corners(i))).sum()
}

#[test]
fn round_shapes() {
    assert_shape("sphere", ball(1.3), 1.3, ball_volume(1.3));
    let ellipsoid = leaf(ball(1.0), DAffine3::from_scale(dvec3(0.5, 1.2, 0.8)));
    assert_tree("ellipsoid", Csg::Leaf(0), vec![ellipsoid], 1.2, ball_volume(1.0) * 0.5 * 1.2 * 0.8);
    assert_shape("box", Shape::Box { min: dvec3(-0.5, -0.7, 0.1), max: dvec3(0.4, 0.6, 1.0) }, 1.4, 0.9 * 1.3 * 0.9);
    assert_shape("cylinder", Shape::Cylinder { radius: 0.6, height: 1.5 }, 1.7, PI * 0.36 * 1.5);
    let cone = |base_radius, top_radius| Shape::Cone { base_radius, top_radius, height: 1.2 };
    assert_shape("truncated cone", cone(0.9, 0.4), 1.3, PI * 1.2 / 3.0 * (0.81 + 0.36 + 0.16));
    assert_shape("cone", cone(0.9, 0.0), 1.2, PI * 1.2 / 3.0 * 0.81);
    assert_shape("cone upside down", cone(0.0, 0.9), 1.5, PI * 1.2 / 3.0 * 0.81);
    let paraboloid = Paraboloid { radius: 0.8, height: 1.1 };
    assert_shape("paraboloid", Shape::Paraboloid(paraboloid), 1.4, PI * 0.64 * 1.1 / 2.0);
}

/// Pappus for ring and horn; for the filled spindle the section beside the axis, turned: 2π ∫ 2x √(r² − (x − R)²) dx.
#[test]
fn tori() {
    let torus = |major, minor| Shape::Torus { major, minor };
    assert_shape("ring torus", torus(1.0, 0.35), 1.35, 2.0 * PI * PI * 0.35 * 0.35);
    assert_shape("horn torus", torus(0.7, 0.7), 1.4, 2.0 * PI * PI * 0.7f64.powi(3));
    let (major, minor) = (0.5f64, 0.8f64);
    let lens = (minor * minor - major * major).sqrt();
    let section = minor * minor * (FRAC_PI_2 + (major / minor).asin()) + major * lens;
    let spindle = 2.0 * PI * (2.0 / 3.0 * lens.powi(3) + major * section);
    assert_shape("spindle torus", torus(major, minor), 1.3, spindle);
}

#[test]
fn hyperboloids() {
    let (radius, slope, half_height) = (0.4f64, 0.7f64, 1.1f64);
    let shape = |two_sheets| Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets });
    let up_to = |sign: f64, z: f64| PI * (slope * slope * z.powi(3) / 3.0 + sign * radius * radius * z);
    assert_shape("one sheet", shape(false), 1.45, 2.0 * up_to(1.0, half_height));
    let vertex = radius / slope;
    assert_shape("two sheets", shape(true), 1.4, 2.0 * (up_to(-1.0, half_height) - up_to(-1.0, vertex)));
}

/// By recurrence to Stirling's series.
fn gamma(x: f64) -> f64 {
    if x < 12.0 {
        return gamma(x + 1.0) / x;
    }
    let series = 1.0 / (12.0 * x) - 1.0 / (360.0 * x.powi(3)) + 1.0 / (1260.0 * x.powi(5));
    (2.0 * PI / x).sqrt() * (x * (x.ln() - 1.0) + series).exp()
}

/// Jaklič, Leonardis and Solina 2000: 2 e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2).
#[test]
fn superellipsoids() {
    let beta = |a: f64, b: f64| gamma(a) * gamma(b) / gamma(a + b);
    let volume = |e1: f64, e2: f64| 2.0 * e1 * e2 * beta(0.5 * e1 + 1.0, e1) * beta(0.5 * e2, 0.5 * e2);
    assert!((volume(1.0, 1.0) / ball_volume(1.0) - 1.0).abs() < 1e-9 && (volume(2.0, 2.0) * 0.75 - 1.0).abs() < 1e-9);
    for (e1, e2) in [(1.0, 1.0), (0.2, 0.4), (2.0, 1.0), (0.5, 2.5), (3.0, 3.0)] {
        let shape = Shape::Superquadric(Arc::new(Superquadric::new(e1, e2).unwrap()));
        let reach = if e1 < 1.0 { 3f64.sqrt() } else { 1.0 };
        assert_tree(
            &format!("superellipsoid {e1}, {e2}"),
            Csg::Leaf(0),
            vec![at(shape, 0.0, 0.0, 0.0)],
            reach,
            volume(e1, e2),
        );
    }
}

#[test]
fn prism_with_hole() {
    let outline = vec![(-1.0, -0.8), (1.0, -0.8), (1.0, 0.1), (0.2, 0.1), (0.2, 0.9), (-1.0, 0.9)];
    let hole = vec![(-0.7, -0.5), (-0.1, -0.5), (-0.4, 0.4)];
    let rings = [outline, hole].map(|ring| ring.into_iter().map(|(x, y)| dvec2(x, y)).collect()).to_vec();
    let prism = Prism::new(Polygon::new(rings).unwrap(), 0.7).unwrap();
    let area = 2.0 * 0.9 + 1.2 * 0.8 - 0.5 * 0.6 * 0.9;
    assert_shape("prism", Shape::Prism(Arc::new(prism)), 1.6, area * 0.7);
}

/// 2π ∫ x dA = ∮ π x² dy along the outline, by Simpson's rule on `steps` parts of each segment.
fn revolved(segments: &[[DVec2; 4]], steps: usize) -> f64 {
    let mut volume = 0.0;
    for c in segments {
        let point = |t: f64| {
            let s = 1.0 - t;
            c[0] * (s * s * s) + c[1] * (3.0 * s * s * t) + c[2] * (3.0 * s * t * t) + c[3] * (t * t * t)
        };
        let slope = |t: f64| {
            let s = 1.0 - t;
            ((c[1] - c[0]) * (s * s) + (c[2] - c[1]) * (2.0 * s * t) + (c[3] - c[2]) * (t * t)).y * 3.0
        };
        for k in 0..=2 * steps {
            let t = k as f64 / (2 * steps) as f64;
            let weight = if k == 0 || k == 2 * steps { 1.0 } else { [2.0, 4.0][k % 2] };
            volume += PI * point(t).x.powi(2) * slope(t) * weight / (6 * steps) as f64;
        }
    }
    volume.abs()
}

#[test]
fn lathes() {
    let points = |list: &[(f64, f64)]| -> Vec<DVec2> { list.iter().map(|&(r, z)| dvec2(r, z)).collect() };
    let lathe =
        |list: &[(f64, f64)], closed, smooth| Shape::Lathe(Arc::new(Lathe::new(points(list), closed, smooth).unwrap()));
    // A vase: the profile turns back inside.
    let vase = [(0.8, -0.6), (0.9, 0.5), (0.7, 0.5), (0.5, -0.3)];
    let frustum = |(a, low): (f64, f64), (b, high): (f64, f64)| PI * (high - low) / 3.0 * (a * a + a * b + b * b);
    let volume = frustum(vase[0], vase[1]) + frustum(vase[2], vase[3]);
    assert_shape("lathe", lathe(&vase, false, false), 1.1, volume);
    // A triangular ring, by Pappus.
    let triangle = [(0.6, -0.3), (1.1, -0.1), (0.7, 0.5)];
    assert_shape("ring", lathe(&triangle, true, false), 1.2, 2.0 * PI * 0.8 * 0.5 * (0.5 * 0.8 - 0.1 * 0.2));
    // A closed spline: the tangent at a point is half of what its neighbours are apart.
    let ring = [(0.5, -0.3), (1.0, -0.4), (1.1, 0.2), (0.7, 0.4)];
    let p = points(&ring);
    let tangent = |i: usize| (p[(i + 1) % 4] - p[(i + 3) % 4]) / 6.0;
    let spline: Vec<[DVec2; 4]> =
        (0..4).map(|i| (i, (i + 1) % 4)).map(|(i, j)| [p[i], p[i] + tangent(i), p[j] - tangent(j), p[j]]).collect();
    assert_shape("spline", lathe(&ring, true, true), 1.4, revolved(&spline, 64));
}

#[test]
fn polyhedra_and_meshes() {
    let signs = [-1.0, 1.0];
    let corner = |a: f64, b: f64| [dvec3(a, b, 0.0), dvec3(0.0, a, b), dvec3(b, 0.0, a)];
    let points: Vec<DVec3> = signs.iter().flat_map(|&a| signs.iter().flat_map(move |&b| corner(a, b))).collect();
    let hull = Shape::Polyhedron(Arc::new(Polyhedron::new(points).unwrap()));
    assert_shape("cuboctahedron", hull, 2f64.sqrt(), 20.0 / 3.0);
    let (globe, ring) = (meshes::sphere(24, 48, 1.0), meshes::torus(48, 24, 1.0, 0.3));
    for (name, mesh, round) in [("globe", globe, ball_volume(1.0)), ("tyre", ring, 2.0 * PI * PI * 0.09)] {
        let volume = mesh_volume(&mesh).abs();
        assert!(volume < round && volume > 0.97 * round);
        assert_shape(name, closed(mesh), 1.3, volume);
    }
}

#[test]
fn unbounded_shapes_cut() {
    let normal = dvec3(0.3, -0.5, 0.8).normalize();
    let half_space = |offset: f64| {
        let turn = DAffine3::from_quat(glam::DQuat::from_rotation_arc(DVec3::Z, normal));
        leaf(Shape::HalfSpace, DAffine3::from_translation(normal * offset) * turn)
    };
    let whole = at(cuboid(dvec3(0.6, 0.7, 0.8)), 0.0, 0.0, 0.0);
    let (tree, leaves) = common(vec![whole, half_space(0.0)]);
    assert_tree("half of a box", tree, leaves, 1.3, 4.0 * 0.6 * 0.7 * 0.8);
    let height = 0.7;
    let (tree, leaves) = common(vec![at(ball(1.0), 0.0, 0.0, 0.0), half_space(height - 1.0)]);
    assert_tree("spherical cap", tree, leaves, 1.0, PI * height * height * (3.0 - height) / 3.0);
    let pipe = Shape::InfiniteCylinder { radius: 0.6 };
    let (tree, leaves) = common(vec![at(pipe, 0.1, 0.0, 0.0), at(cuboid(dvec3(1.0, 1.0, 0.8)), 0.0, 0.0, 0.0)]);
    assert_tree("infinite cylinder", tree, leaves, 1.2, PI * 0.36 * 1.6);
}

#[test]
fn trees() {
    let radius = 0.8f64;
    let along = |turn: DAffine3| leaf(Shape::InfiniteCylinder { radius }, turn);
    let axes = [DAffine3::IDENTITY, DAffine3::from_rotation_x(FRAC_PI_2), DAffine3::from_rotation_y(FRAC_PI_2)];
    let ends = at(cuboid(DVec3::splat(0.9)), 0.0, 0.0, 0.0);
    let (tree, leaves) = common(vec![along(axes[0]), along(axes[1]), ends.clone()]);
    assert_tree("bicylinder", tree, leaves, 1.2, 16.0 / 3.0 * radius.powi(3));
    let (tree, leaves) = common(axes.map(along).into_iter().chain([ends]).collect());
    assert_tree("tricylinder", tree, leaves, 1.2, 8.0 * (2.0 - 2f64.sqrt()) * radius.powi(3));

    let half_height = (1.0 - 0.5f64 * 0.5).sqrt();
    let bore = Shape::Cylinder { radius: 0.5, height: 3.0 };
    let (tree, leaves) = without(at(ball(1.0), 0.0, 0.0, 0.0), at(bore, 0.0, 0.0, -1.5));
    assert_tree("drilled sphere", tree, leaves, 1.0, ball_volume(half_height));

    let (major, minor, half) = (0.6, 0.2, dvec3(0.9, 0.85, 0.5));
    let (block, ring) = (8.0 * half.x * half.y * half.z, 2.0 * PI * PI * major * minor * minor);
    let torus = Shape::Torus { major, minor };
    let (tree, leaves) = without(at(cuboid(half), 0.0, 0.0, 0.0), at(torus.clone(), 0.0, 0.0, 0.1));
    assert_tree("box less torus within", tree, leaves, 1.4, block - ring);
    let (tree, leaves) = without(at(cuboid(half), 0.0, 0.0, 0.0), at(torus, 0.0, 0.0, half.z));
    assert_tree("box with a groove", tree, leaves, 1.4, block - 0.5 * ring);

    // Two unit balls whose centres are d apart share π (4 + d) (2 − d)² / 12.
    let d = 0.9f64;
    let lens = PI * (4.0 + d) * (2.0 - d).powi(2) / 12.0;
    let pair = vec![at(ball(1.0), -0.5 * d, 0.0, 0.0), at(ball(1.0), 0.5 * d, 0.0, 0.0)];
    let union = Csg::Union(vec![Csg::Leaf(0), Csg::Leaf(1)]);
    assert_tree("union of balls", union, pair.clone(), 1.5, 2.0 * ball_volume(1.0) - lens);
    let (tree, leaves) = common(pair);
    assert_tree("lens", tree, leaves, 1.0, lens);
}

#[test]
fn meshes_with_other_shapes() {
    // Coordinates that single precision holds.
    let crate_of = || closed(meshes::cube([-0.75, -0.5, -0.625], [0.5, 0.75, 0.625]));
    let block = 1.25f64.powi(3);
    let (tree, leaves) = without(at(crate_of(), 0.0, 0.0, 0.0), at(ball(0.6), 0.5, 0.75, 0.625));
    assert_tree("mesh box less ball at its corner", tree, leaves, 1.25, block - ball_volume(0.6) / 8.0);
    let (tree, leaves) = without(at(crate_of(), 0.0, 0.0, 0.0), at(ball(0.5), -0.2, 0.1, 0.0));
    assert_tree("mesh box less ball within", tree, leaves, 1.25, block - ball_volume(0.5));
    let slab = at(closed(meshes::cube([-2.0, -2.0, -2.0], [2.0, 2.0, 0.0])), 0.0, 0.0, 0.0);
    let (tree, leaves) = common(vec![at(ball(1.0), 0.0, 0.0, 0.0), slab]);
    assert_tree("ball in mesh box", tree, leaves, 1.0, 0.5 * ball_volume(1.0));
}
