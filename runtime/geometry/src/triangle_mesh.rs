//! Indexed triangles in single precision, as files give them.

use glam::{DVec2, DVec3, Vec3};

/// Points of a triangle keep off its edges by so much of its size: a ray that leaves from an edge would lie in the
/// neighbour's plane.
const EDGE: f64 = 1e-9;

/// A point of a triangle with its frame, in the mesh's own space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrianglePoint {
    pub p: DVec3,
    /// Unit normal of the plane, on the side from which the corners run counter-clockwise.
    pub n: DVec3,
    /// Interpolated normal, unit, on the side of `n`.
    pub ns: DVec3,
    pub uv: DVec2,
    /// Direction of growing u, in the plane, of any length.
    pub dpdu: DVec3,
}

/// Indexed triangles; every index is below the number of positions. Attributes are empty or one per vertex.
///
/// Counter-clockwise as seen from the side of the normal.
#[derive(Clone, Default)]
pub struct TriangleMesh {
    /// Finite.
    pub positions: Vec<[f32; 3]>,
    /// Finite and not zero; not always unit.
    pub normals: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    /// Red, green, blue as the file has them, 255 being full.
    pub colors: Vec<[u8; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Every index and every number of attributes is as it must be.
    pub fn is_valid(&self) -> bool {
        let vertices = self.positions.len();
        let fits = |len: usize| len == 0 || len == vertices;
        let finite = |v: &[f32]| v.iter().all(|x| x.is_finite());
        fits(self.normals.len())
            && fits(self.uvs.len())
            && fits(self.colors.len())
            && finite(self.positions.as_flattened())
            && finite(self.normals.as_flattened())
            && finite(self.uvs.as_flattened())
            && self.triangles.as_flattened().iter().all(|&i| (i as usize) < vertices)
    }

    #[inline]
    pub fn position(&self, vertex: u32) -> DVec3 {
        Vec3::from_array(self.positions[vertex as usize]).as_dvec3()
    }

    #[inline]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|vertex| self.position(vertex))
    }

    /// Normals at the corners, of any length; `None` when there are none.
    #[inline]
    pub fn corner_normals(&self, triangle: usize) -> Option<[DVec3; 3]> {
        let normal = |vertex: u32| Vec3::from_array(self.normals[vertex as usize]).as_dvec3();
        (!self.normals.is_empty()).then(|| self.triangles[triangle].map(normal))
    }

    /// Texture coordinates at the corners; `None` when there are none.
    pub fn corner_uvs(&self, triangle: usize) -> Option<[DVec2; 3]> {
        let uv = |vertex: u32| {
            let [u, v] = self.uvs[vertex as usize];
            DVec2::new(u.into(), v.into())
        };
        (!self.uvs.is_empty()).then(|| self.triangles[triangle].map(uv))
    }

    /// Colours of a triangle's corners with their weights at a point of its plane, which add up to 1; `None` when there
    /// are none, or no area.
    pub fn colors_at(&self, triangle: usize, p: DVec3) -> Option<[([u8; 3], f64); 3]> {
        let colors = self.triangles[triangle].map(|vertex| self.colors.get(vertex as usize));
        let [a, b, c] = self.corners(triangle);
        let normal = (b - a).cross(c - a);
        let area = normal.length_squared();
        let share = |from: DVec3, to: DVec3| ((to - from).cross(p - from).dot(normal) / area).clamp(0.0, 1.0);
        let (second, third) = (share(c, a), share(a, b));
        let weights = [1.0 - second - third, second, third];
        let [x, y, z] = [0, 1, 2].map(|i| colors[i].map(|color| (*color, weights[i])));
        if area > 0.0 { Some([x?, y?, z?]) } else { None }
    }

    /// Twice the area, along the normal.
    pub fn cross(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    /// Weights of the second and third corner for the foot of `p` on the plane, anywhere in it.
    pub fn weights(&self, triangle: usize, p: DVec3) -> DVec2 {
        let [a, b, c] = self.corners(triangle);
        let (ab, ac, ap) = (b - a, c - a, p - a);
        let n = ab.cross(ac);
        DVec2::new(ap.cross(ac).dot(n), ab.cross(ap).dot(n)) / n.length_squared()
    }

    /// The point with these weights of the second and third corner, moved to just within the triangle. Triangles without
    /// an area give some point and some normal of theirs.
    pub fn surface(&self, triangle: usize, weights: DVec2) -> TrianglePoint {
        let mut w = if weights.is_finite() { weights.max(DVec2::splat(EDGE)) } else { DVec2::splat(EDGE) };
        if w.x + w.y > 1.0 - EDGE {
            w *= (1.0 - EDGE) / (w.x + w.y);
        }
        let [a, b, c] = self.corners(triangle);
        let (ab, ac) = (b - a, c - a);
        let n =
            ab.cross(ac).try_normalize().unwrap_or_else(|| (ab + ac).normalize_or(DVec3::X).any_orthonormal_vector());
        let (uv, dpdu) = match self.corner_uvs(triangle) {
            None => (w, ab),
            Some([ua, ub, uc]) => {
                let (du, dv) = (ub - ua, uc - ua);
                (ua + du * w.x + dv * w.y, (ab * dv.y - ac * du.y) * du.perp_dot(dv).signum())
            }
        };
        let dpdu = dpdu - n * n.dot(dpdu);
        let dpdu = if dpdu.length_squared() > 0.0 { dpdu } else { n.any_orthonormal_vector() };
        let ns = match self.corner_normals(triangle) {
            None => n,
            Some([na, nb, nc]) => {
                let [na, nb, nc] = [na, nb, nc].map(|v| v.normalize_or_zero());
                let ns = (na * (1.0 - w.x - w.y) + nb * w.x + nc * w.y).normalize_or(n);
                if ns.dot(n) < 0.0 { -ns } else { ns }
            }
        };
        TrianglePoint { p: a + ab * w.x + ac * w.y, n, ns, uv, dpdu }
    }

    /// Triangles without an area: a corner twice, or all three on a line.
    pub fn count_degenerate(&self) -> usize {
        (0..self.triangles.len()).filter(|&triangle| self.cross(triangle) == DVec3::ZERO).count()
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.positions[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.uvs[..])
            + size_of_val(&self.colors[..])
            + size_of_val(&self.triangles[..])
    }
}

impl PartialEq for TriangleMesh {
    fn eq(&self, other: &TriangleMesh) -> bool {
        std::ptr::eq(self, other)
            || self.positions == other.positions
                && self.normals == other.normals
                && self.uvs == other.uvs
                && self.colors == other.colors
                && self.triangles == other.triangles
    }
}

impl std::fmt::Debug for TriangleMesh {
    /// Counts: the content is too long to read.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "TriangleMesh({} vertices, {} triangles)", self.positions.len(), self.triangles.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At the corners and in the middle of an edge.
    #[test]
    fn colours_are_interpolated() {
        let mesh = TriangleMesh {
            positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 4.0, 0.0]],
            colors: vec![[255, 0, 0], [0, 255, 0], [0, 0, 255]],
            triangles: vec![[0, 1, 2]],
            ..TriangleMesh::default()
        };
        for (p, wanted) in [
            (DVec3::ZERO, [1.0, 0.0, 0.0]),
            (DVec3::X * 2.0, [0.0, 1.0, 0.0]),
            (DVec3::Y * 4.0, [0.0, 0.0, 1.0]),
            (DVec3::new(1.0, 2.0, 0.0), [0.0, 0.5, 0.5]),
        ] {
            let found = mesh.colors_at(0, p).unwrap();
            assert_eq!(found.map(|(_, weight)| weight), wanted);
            assert_eq!(found[1].0, [0, 255, 0]);
        }
        assert!(TriangleMesh { colors: vec![], ..mesh }.colors_at(0, DVec3::ZERO).is_none());
    }
}
