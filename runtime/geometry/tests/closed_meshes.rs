//! Closed meshes against the winding number: parity on hostile lines, membership, classification, repairs, sampling.

#[path = "../../../tests/common/meshes.rs"]
mod meshes;

use std::sync::Arc;

use arsc_geometry::{
    Aabb, Classification, ClosedMesh, ClosedMeshError, DAffine3, DMat3, DVec3, MeshRepairs, Placed, Shape, TriangleMesh,
};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn vector(rng: &mut Pcg64) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
}

fn closed(mesh: TriangleMesh) -> Arc<ClosedMesh> {
    let (closed, repairs) = ClosedMesh::new("test".into(), mesh).unwrap();
    assert_eq!(repairs, MeshRepairs::default(), "{closed:?}");
    Arc::new(closed)
}

fn family() -> Vec<Arc<ClosedMesh>> {
    let shell = meshes::sphere(8, 12, 0.5);
    let cavity = {
        let mut inner = shell.clone();
        inner.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        meshes::joined(meshes::cube([-0.75; 3], [0.75; 3]), &inner)
    };
    let touching = meshes::joined(meshes::cube([-0.5; 3], [0.0; 3]), &meshes::cube([0.0, 0.0, -0.5], [0.5, 0.5, 0.0]));
    [meshes::cube([-0.5, -0.25, -1.0], [0.5, 0.75, 1.0]), meshes::sphere(6, 8, 1.0), meshes::torus(9, 7, 0.7, 0.3)]
        .into_iter()
        .chain([meshes::sphere(40, 60, 0.9), shell, cavity, touching])
        .map(closed)
        .collect()
}

/// Signed solid angle over 4 π (van Oosterom and Strackee 1983).
fn winding(mesh: &TriangleMesh, p: DVec3) -> f64 {
    let angle = |triangle: usize| {
        let [a, b, c] = mesh.corners(triangle).map(|q| q - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let numerator = a.dot(b.cross(c));
        let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * numerator.atan2(denominator)
    };
    (0..mesh.triangles.len()).map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Within a millionth of a triangle's plane, and of its box.
fn on_surface(mesh: &TriangleMesh, p: DVec3) -> bool {
    (0..mesh.triangles.len()).any(|triangle| {
        let [a, b, c] = mesh.corners(triangle);
        let hull = Aabb::new(a.min(b).min(c), a.max(b).max(c)).dilated(1e-6);
        hull.contains(p) && (p - a).dot((b - a).cross(c - a).normalize()).abs() < 1e-6
    })
}

/// A line that tries to slip through: via vertices, along edges, within faces, through edges, axis-parallel.
fn hostile(rng: &mut Pcg64, mesh: &TriangleMesh) -> (DVec3, DVec3) {
    let triangle = rng.random_range(0..mesh.triangles.len());
    let [a, b, c] = mesh.corners(triangle);
    let [d, e, _] = mesh.corners(rng.random_range(0..mesh.triangles.len()));
    let start = vector(rng) * 3.0;
    let axis = DVec3::AXES[rng.random_range(0..3)];
    let (from, to) = match rng.random_range(0..8) {
        0 => (start, a),
        1 => (a, b),
        2 => (a - (b - a), b),
        3 => (a, (b + c) * 0.5),
        4 => (a, d),
        5 => ((a + b) * 0.5, (d + e) * 0.5),
        6 => (a - axis * 2.0, a),
        _ => ((a + b + c) / 3.0, a),
    };
    let dir = to - from;
    if dir == DVec3::ZERO { (from, DVec3::X) } else { (from, dir * 10f64.powi(rng.random_range(-3..4))) }
}

#[test]
fn lines_cross_an_even_number_of_times_and_bound_what_is_inside() {
    let mut rng = Pcg64::seed_from_u64(71);
    let (mut checked, mut undecided) = (0u32, 0u32);
    for mesh in family() {
        for round in 0..3000 {
            let (origin, dir) = if round % 4 == 0 {
                let origin = vector(&mut rng) * 2.0;
                (origin, vector(&mut rng) - origin)
            } else {
                hostile(&mut rng, mesh.mesh())
            };
            let crossings = mesh.crossings(origin, dir);
            assert_eq!(crossings.len() % 2, 0, "{mesh:?} {origin} {dir}");
            assert!(crossings.t().is_sorted());
            // Between two crossings, and beyond them, the parity is what the winding number says.
            let t = crossings.t();
            let ends = [t.first().map_or(-1.0, |t| t - 1.0), t.last().map_or(1.0, |t| t + 1.0)];
            let all: Vec<f64> = [&ends[..1], t, &ends[1..]].concat();
            for (i, pair) in all.windows(2).enumerate() {
                if round % 10 != 0 && i > 2 {
                    break;
                }
                let middle = origin + dir * (0.5 * (pair[0] + pair[1]));
                let inside = i % 2 == 1;
                if on_surface(mesh.mesh(), middle) {
                    undecided += 1;
                    continue;
                }
                checked += 1;
                assert_eq!(
                    inside,
                    winding(mesh.mesh(), middle).round() as i64 % 2 != 0,
                    "{mesh:?} {origin} {dir} {all:?} at {i}"
                );
                assert_eq!(mesh.contains(middle), inside, "{mesh:?} {middle}");
            }
        }
    }
    assert!(checked > 30_000 && undecided < checked / 3, "{checked} {undecided}");
}

/// Exact in parity whatever the map: far origins, slivers, extreme scales.
#[test]
fn parity_survives_any_map() {
    let mut rng = Pcg64::seed_from_u64(72);
    for mesh in family() {
        for _ in 0..40 {
            let scale = 10f64.powf(rng.random_range(-9.0..7.0));
            let skew = DMat3::from_cols(vector(&mut rng), vector(&mut rng), vector(&mut rng)) * scale;
            let map = DAffine3 { matrix3: skew, translation: vector(&mut rng) * scale * 1e3 };
            let Ok(placed) = Placed::new(Shape::Mesh(mesh.clone()), map) else { continue };
            for _ in 0..50 {
                let (from, dir) = hostile(&mut rng, mesh.mesh());
                let (from, dir) = (map.transform_point3(from), map.transform_vector3(dir));
                let from = from - dir * 10f64.powf(rng.random_range(0.0..8.0));
                assert_eq!(placed.crossings(from, dir).len() % 2, 0);
            }
        }
    }
}

#[test]
fn boxes_are_never_classified_wrongly() {
    let mut rng = Pcg64::seed_from_u64(73);
    let mut decided = [0u32; 3];
    for mesh in family() {
        for _ in 0..30 {
            let turn = DMat3::from_cols(vector(&mut rng), vector(&mut rng), vector(&mut rng));
            let map = DAffine3 { matrix3: turn, translation: vector(&mut rng) };
            let Ok(placed) = Placed::new(Shape::Mesh(mesh.clone()), map) else { continue };
            let bounds = *placed.bounds();
            for _ in 0..20 {
                let at = |rng: &mut Pcg64| bounds.min + bounds.extent() * (0.6 * vector(rng) + 0.5);
                let center = at(&mut rng);
                let half = bounds.extent() * 10f64.powf(rng.random_range(-3.0..-0.5)) * 0.5;
                let cell = Aabb::new(center - half, center + half);
                let class = placed.classify(&cell);
                let held = [Classification::Outside, Classification::Inside].iter().position(|c| *c == class);
                decided[held.unwrap_or(2)] += 1;
                let Some(held) = held else { continue };
                for _ in 0..20 {
                    let p = center + half * vector(&mut rng);
                    assert_eq!(placed.contains(p), held == 1, "{mesh:?} {cell:?}");
                }
            }
        }
    }
    assert!(decided.iter().all(|&n| n > 200), "{decided:?}");
}

#[test]
fn open_meshes_show_an_edge() {
    let mut mesh = meshes::cube([-1.0; 3], [1.0; 3]);
    mesh.triangles.remove(5);
    let error = ClosedMesh::new("box".into(), mesh).unwrap_err();
    let ClosedMeshError::Open { edges: 3, edge, uses: 1 } = error.clone() else { panic!("{error:?}") };
    assert!(edge[0] != edge[1]);
    assert!(error.to_string().ends_with("belongs to one face, one of 3 such edges"), "{error}");
    let mut mesh = meshes::cube([-1.0; 3], [1.0; 3]);
    mesh.triangles.push([0, 1, 2]);
    assert!(matches!(ClosedMesh::new("fin".into(), mesh), Err(ClosedMeshError::Open { edges: 3, .. })));
    let empty = ClosedMesh::new("none".into(), TriangleMesh::default());
    assert_eq!(empty.unwrap_err(), ClosedMeshError::Empty);
    let mut mesh = meshes::cube([-1.0; 3], [1.0; 3]);
    mesh.triangles[0][1] = 99;
    assert_eq!(ClosedMesh::new("index".into(), mesh).unwrap_err(), ClosedMeshError::Invalid);
}

/// The projective plane with six vertices: every edge twice, and no way to turn its triangles.
#[test]
fn one_sided_meshes_are_refused() {
    let triangles =
        [[0, 1, 4], [0, 1, 5], [0, 2, 3], [0, 2, 5], [0, 3, 4], [1, 2, 3], [1, 2, 4], [1, 3, 5], [2, 4, 5], [3, 4, 5]];
    let mut rng = Pcg64::seed_from_u64(74);
    let positions = (0..6).map(|_| vector(&mut rng).as_vec3().to_array()).collect();
    let mesh = TriangleMesh { positions, triangles: triangles.to_vec(), ..TriangleMesh::default() };
    assert!(matches!(ClosedMesh::new("plane".into(), mesh), Err(ClosedMeshError::Unorientable { .. })));
}

/// Repairs give the mesh that was never broken.
#[test]
fn orientation_and_seams_are_repaired() {
    let whole = meshes::torus(12, 9, 0.7, 0.3);
    let expected = closed(whole.clone());
    let mut broken = whole.clone();
    broken.triangles.iter_mut().step_by(7).for_each(|t| t.swap(0, 1));
    let (mended, repairs) = ClosedMesh::new("test".into(), broken).unwrap();
    assert_eq!((repairs.flipped, repairs.inverted_pieces), (whole.triangles.len().div_ceil(7), 0));
    let normal = |mesh: &ClosedMesh, triangle| mesh.mesh().cross(triangle).normalize();
    for triangle in 0..whole.triangles.len() {
        assert!(normal(&mended, triangle).dot(normal(&expected, triangle)) > 0.999);
    }
    let mut inverted = whole.clone();
    inverted.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let (turned, repairs) = ClosedMesh::new("test".into(), inverted).unwrap();
    assert_eq!(repairs, MeshRepairs { inverted_pieces: 1, ..MeshRepairs::default() });
    assert!((0..whole.triangles.len()).all(|t| normal(&turned, t).dot(normal(&expected, t)) > 0.999));
    // Each triangle with vertices of its own, zeros of either sign, and one without an area.
    let mut soup = TriangleMesh::default();
    for triangle in 0..whole.triangles.len() {
        for p in whole.corners(triangle) {
            soup.positions.push(p.as_vec3().to_array().map(|x| if x == 0.0 && triangle % 2 == 0 { -x } else { x }));
        }
        let last = soup.positions.len() as u32;
        soup.triangles.push([last - 3, last - 2, last - 1]);
    }
    soup.triangles.push([0, 1, 1]);
    let (welded, repairs) = ClosedMesh::new("test".into(), soup).unwrap();
    assert_eq!(repairs, MeshRepairs { degenerate: 1, ..MeshRepairs::default() });
    assert_eq!(welded.mesh().triangles.len(), whole.triangles.len());
}

/// Area in the world, and sampling that covers triangles in proportion to it.
#[test]
fn samples_follow_the_area() {
    let mut rng = Pcg64::seed_from_u64(75);
    let mesh = closed(meshes::cube([0.0; 3], [1.0, 2.0, 3.0]));
    assert!((mesh.area() - 22.0).abs() < 1e-12);
    let map = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(-2.0, 1.0, 1.0)), translation: DVec3::Y };
    let placed = Placed::new(Shape::Mesh(mesh), map).unwrap();
    assert!((placed.area() - 2.0 * (4.0 + 6.0 + 6.0)).abs() < 1e-12);
    let (mut integral, n) = (0.0, 20_000);
    for _ in 0..n {
        let sample = placed.sample_area([rng.random(), rng.random()]).unwrap();
        let outside = placed.contains(sample.point.p + sample.point.n * 1e-6);
        let inside = placed.contains(sample.point.p - sample.point.n * 1e-6);
        assert!(inside && !outside, "{sample:?}");
        integral += 1.0 / sample.pdf_area / f64::from(n);
    }
    assert!((integral / placed.area() - 1.0).abs() < 0.02, "{integral}");
}
