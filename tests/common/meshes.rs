//! Closed meshes for tests and benchmarks, with shared vertices, counter-clockwise from outside.

#![allow(dead_code)] // Each program uses its part.

use arsc_geometry::TriangleMesh;

/// A grid of `rows` × `columns` points that closes in both directions.
fn wrapped(rows: usize, columns: usize, point: impl Fn(f64, f64) -> [f64; 3]) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for i in 0..rows {
        for j in 0..columns {
            mesh.positions.push(point(i as f64 / rows as f64, j as f64 / columns as f64).map(|x| x as f32));
        }
    }
    let at = |i: usize, j: usize| ((i % rows) * columns + j % columns) as u32;
    for i in 0..rows {
        for j in 0..columns {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// About z; 2 × `rows` × `columns` triangles.
pub fn torus(rows: usize, columns: usize, major: f64, minor: f64) -> TriangleMesh {
    wrapped(rows, columns, |u, v| {
        let (around, across) = (u * std::f64::consts::TAU, v * std::f64::consts::TAU);
        let ring = major + minor * across.cos();
        [ring * around.cos(), ring * around.sin(), minor * across.sin()]
    })
}

/// By latitude and longitude; 2 × `columns` × (`rows` − 1) triangles.
pub fn sphere(rows: usize, columns: usize, radius: f64) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let mut add = |x: f64, y: f64, z: f64| mesh.positions.push([x * radius, y * radius, z * radius].map(|x| x as f32));
    add(0.0, 0.0, 1.0);
    for i in 1..rows {
        let polar = std::f64::consts::PI * i as f64 / rows as f64;
        for j in 0..columns {
            let around = std::f64::consts::TAU * j as f64 / columns as f64;
            add(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos());
        }
    }
    add(0.0, 0.0, -1.0);
    let last = (mesh.positions.len() - 1) as u32;
    let at = |i: usize, j: usize| (1 + (i - 1) * columns + j % columns) as u32;
    for j in 0..columns {
        mesh.triangles.push([0, at(1, j), at(1, j + 1)]);
        mesh.triangles.push([last, at(rows - 1, j + 1), at(rows - 1, j)]);
        for i in 1..rows - 1 {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// A box with corners that its faces share.
pub fn cube(min: [f64; 3], max: [f64; 3]) -> TriangleMesh {
    let corner = |i: usize| std::array::from_fn(|axis| (if i >> axis & 1 == 0 { min[axis] } else { max[axis] }) as f32);
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..TriangleMesh::default()
    }
}

/// Both, side by side or one within the other.
#[allow(dead_code)]
pub fn joined(mut a: TriangleMesh, b: &TriangleMesh) -> TriangleMesh {
    let first = a.positions.len() as u32;
    a.positions.extend(&b.positions);
    a.triangles.extend(b.triangles.iter().map(|t| t.map(|i| i + first)));
    a
}
