//! What every format has in common: vertices and polygons, checked and cut into triangles.
//!
//! Polygons with more than three corners are cut by ear clipping in the plane of their Newell normal, so that concave ones
//! come out right; the winding is kept. Triangles without an area stay, for a closed mesh may need them.

use arsc_geometry::TriangleMesh;
use glam::{DVec2, DVec3};

/// Ear clipping takes quadratic time: more corners than this in one polygon are an error.
const MOST_CORNERS: usize = 1024;

/// What is wrong with a mesh file.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    #[error("its name ends neither in .ply nor .obj nor .stl nor .png")]
    Format,
    #[error("it cannot be read")]
    Read(#[source] std::io::Error),
    #[error("it is no PLY file: {0}")]
    Ply(std::io::Error),
    #[error("it is no OBJ file: it has {0}")]
    Obj(&'static str),
    #[error("it is no STL file: {0}")]
    Stl(std::io::Error),
    #[error("it is no PNG file: {0}")]
    Png(png::DecodingError),
    #[error("it makes no height field: {0}")]
    Image(&'static str),
    #[error("the file ends in `{element}` {index} of {count}")]
    Truncated { element: String, index: u64, count: u64 },
    #[error("the header declares no {0}")]
    Missing(&'static str),
    #[error("the header claims {count} of `{element}`, more than {bytes} bytes can hold")]
    TooMany { element: String, count: u64, bytes: u64 },
    #[error("`{element}` {index} claims a list of {items} items")]
    List { element: String, index: u64, items: u64 },
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite { vertex: usize },
    #[error("face {face} names vertex {index}, but there are {vertices}")]
    Index { face: usize, index: i64, vertices: usize },
    #[error("face {face} has {corners} corners, more than the supported {MOST_CORNERS}")]
    Corners { face: usize, corners: usize },
    #[error("there is no triangle with an area")]
    Empty,
}

/// Collects vertices, then faces.
#[derive(Debug, Default)]
pub struct MeshBuilder {
    mesh: TriangleMesh,
    faces: usize,
}

impl MeshBuilder {
    pub fn vertex(
        &mut self,
        position: [f64; 3],
        normal: Option<[f64; 3]>,
        uv: Option<[f64; 2]>,
        color: Option<[u8; 3]>,
    ) -> Result<(), MeshError> {
        let position = position.map(|c| c as f32);
        if !position.iter().all(|c| c.is_finite()) {
            return Err(MeshError::NotFinite { vertex: self.mesh.positions.len() });
        }
        self.mesh.positions.push(position);
        if let Some(normal) = normal {
            self.mesh.normals.push(normal.map(|c| c as f32));
        }
        if let Some(uv) = uv {
            self.mesh.uvs.push(uv.map(|c| c as f32));
        }
        self.mesh.colors.extend(color);
        Ok(())
    }

    /// Number of vertices so far.
    pub fn vertices(&self) -> usize {
        self.mesh.positions.len()
    }

    /// Makes room, for counts that have been checked.
    pub fn reserve(&mut self, vertices: usize, faces: usize) {
        self.mesh.positions.reserve_exact(vertices);
        self.mesh.triangles.reserve_exact(faces);
    }

    /// A polygon, counter-clockwise as seen from the side of the normal.
    pub fn face(&mut self, corners: &[i64]) -> Result<(), MeshError> {
        let face = self.faces;
        self.faces += 1;
        if corners.len() > MOST_CORNERS {
            return Err(MeshError::Corners { face, corners: corners.len() });
        }
        if let [a, b, c] = *corners {
            let triangle = [self.index(face, a)?, self.index(face, b)?, self.index(face, c)?];
            self.mesh.triangles.push(triangle);
            return Ok(());
        }
        let checked = corners.iter().map(|&index| self.index(face, index)).collect::<Result<Vec<u32>, _>>()?;
        if checked.len() > 3 {
            self.polygon(checked);
        }
        Ok(())
    }

    fn index(&self, face: usize, index: i64) -> Result<u32, MeshError> {
        let vertices = self.mesh.positions.len();
        match u32::try_from(index) {
            Ok(i) if (i as usize) < vertices => Ok(i),
            _ => Err(MeshError::Index { face, index, vertices }),
        }
    }

    /// Strips of triangles, ended by -1; every second triangle turns its winding.
    pub fn strip(&mut self, indices: &[i64]) -> Result<(), MeshError> {
        for run in indices.split(|&i| i == -1) {
            for (i, corner) in run.windows(3).enumerate() {
                let odd = i % 2;
                self.face(&[corner[odd], corner[1 - odd], corner[2]])?;
            }
        }
        Ok(())
    }

    pub fn finish(mut self) -> Result<TriangleMesh, MeshError> {
        if !(0..self.mesh.triangles.len()).any(|triangle| self.mesh.cross(triangle) != DVec3::ZERO) {
            return Err(MeshError::Empty);
        }
        // Normals that are not all usable are none.
        let usable = |n: &[f32; 3]| n.iter().all(|c| c.is_finite()) && n.iter().any(|c| *c != 0.0);
        if self.mesh.normals.len() != self.mesh.positions.len() || !self.mesh.normals.iter().all(usable) {
            self.mesh.normals.clear();
        }
        if self.mesh.uvs.len() != self.mesh.positions.len()
            || !self.mesh.uvs.as_flattened().iter().all(|c| c.is_finite())
        {
            self.mesh.uvs.clear();
        }
        if self.mesh.colors.len() != self.mesh.positions.len() {
            self.mesh.colors.clear();
        }
        debug_assert!(self.mesh.is_valid());
        Ok(self.mesh)
    }

    fn polygon(&mut self, mut corners: Vec<u32>) {
        let points = self.flatten(&corners);
        let mut ring: Vec<usize> = (0..corners.len()).collect();
        while ring.len() > 3 {
            // Not a simple polygon: any cut is as good as another.
            let ear = (0..ring.len()).find(|&i| is_ear(&points, &ring, i)).unwrap_or(0);
            let n = ring.len();
            let [before, at, after] = [ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]].map(|i| corners[i]);
            self.mesh.triangles.push([before, at, after]);
            ring.remove(ear);
        }
        corners = ring.into_iter().map(|i| corners[i]).collect();
        if let [a, b, c] = corners[..] {
            self.mesh.triangles.push([a, b, c]);
        }
    }

    /// The corners in the plane across the polygon's Newell normal, counter-clockwise.
    fn flatten(&self, corners: &[u32]) -> Vec<DVec2> {
        let points: Vec<DVec3> = corners.iter().map(|&c| self.mesh.position(c)).collect();
        let next = |i: usize| points[(i + 1) % points.len()];
        let normal: DVec3 = (0..points.len()).map(|i| (points[i] - points[0]).cross(next(i) - points[0])).sum();
        let (x, y) = normal.try_normalize().unwrap_or(DVec3::Z).any_orthonormal_pair();
        points.iter().map(|p| DVec2::new(p.dot(x), p.dot(y))).collect()
    }
}

/// Whether the corner is convex and no other corner lies in its triangle.
fn is_ear(points: &[DVec2], ring: &[usize], i: usize) -> bool {
    let n = ring.len();
    let [a, b, c] = [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]];
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let [pa, pb, pc] = [points[a], points[b], points[c]];
    let is_inside = |p: DVec2| side(pa, pb, p) >= 0.0 && side(pb, pc, p) >= 0.0 && side(pc, pa, p) >= 0.0;
    side(pa, pb, pc) > 0.0 && !ring.iter().any(|&k| k != a && k != b && k != c && is_inside(points[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(mesh: &TriangleMesh) -> f64 {
        let p = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from));
        mesh.triangles.iter().map(|t| 0.5 * (p(t[1]) - p(t[0])).cross(p(t[2]) - p(t[0])).dot(DVec3::Z)).sum()
    }

    fn builder(points: &[[f64; 2]]) -> MeshBuilder {
        let mut builder = MeshBuilder::default();
        for p in points {
            builder.vertex([p[0], p[1], 3.0], None, None, None).unwrap();
        }
        builder
    }

    #[test]
    fn concave_polygons_keep_area_and_winding() {
        // An arrow head and an L: a fan from the first corner would cover what lies outside.
        for (points, expected) in [
            (vec![[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]], 1.0),
            (vec![[1.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.0, 0.0], [2.0, 0.0], [2.0, 1.0]], 3.0),
        ] {
            let mut builder = builder(&points);
            builder.face(&(0..points.len() as i64).collect::<Vec<_>>()).unwrap();
            let mesh = builder.finish().unwrap();
            assert_eq!(mesh.triangles.len(), points.len() - 2);
            let p = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from));
            for t in &mesh.triangles {
                assert!((p(t[1]) - p(t[0])).cross(p(t[2]) - p(t[0])).z > 0.0);
            }
            assert!((area(&mesh) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn strips_alternate_their_winding() {
        let mut builder = builder(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.0, 2.0]]);
        builder.strip(&[0, 1, 2, 3, 4, -1, 0, 1, 2]).unwrap();
        let mesh = builder.finish().unwrap();
        assert_eq!(mesh.triangles, vec![[0, 1, 2], [2, 1, 3], [2, 3, 4], [0, 1, 2]]);
        assert!(area(&mesh) > 0.0);
    }

    #[test]
    fn bad_meshes_are_errors() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let error = |corners: &[i64]| builder(&square).face(corners).unwrap_err();
        assert!(matches!(error(&[0, 1, 4]), MeshError::Index { face: 0, index: 4, vertices: 4 }));
        assert!(matches!(error(&[0, -1, 2]), MeshError::Index { index: -1, .. }));
        assert!(matches!(error(&vec![0; 5000]), MeshError::Corners { corners: 5000, .. }));
        let mut degenerate = builder(&square);
        degenerate.face(&[0, 1, 1]).unwrap();
        degenerate.face(&[0]).unwrap();
        degenerate.face(&[]).unwrap();
        assert!(matches!(degenerate.finish(), Err(MeshError::Empty)));
        let nan = MeshBuilder::default().vertex([0.0, f64::NAN, 0.0], None, None, None);
        assert!(matches!(nan, Err(MeshError::NotFinite { vertex: 0 })));
        assert!(MeshBuilder::default().vertex([0.0, 1e300, 0.0], None, None, None).is_err(), "too large for f32");
    }
}
