//! Convex polyhedron: the convex hull of points, kept as the half-spaces that meet in it.
//!
//! Triangles of the hull that lie in one plane to `COPLANAR` of the extent are one face, whose plane no point surpasses.
//! So the solid holds every point, and exceeds their hull by rounding only. Faces are numbered in the order of their
//! lowest point numbers. Crossing takes time in proportion to the number of faces.

use std::collections::HashMap;
use std::fmt;

use glam::{DVec2, DVec3};

use crate::area_table::{AreaTable, triangle_weights};
use crate::hull::{self, HullError};
use crate::region::Region;
use crate::{Aabb, Classification, Crossings, LocalPoint};

/// Distance from a common plane that is rounding, relative to the extent.
const COPLANAR: f64 = 1e-12;
/// How far the solid may reach beyond the points, relative to the extent: at sharp corners more than `COPLANAR`.
const BEYOND: f64 = 1e-9;

/// `normal · p <= offset`, with a frame for texture coordinates.
#[derive(Clone, Debug, PartialEq)]
struct Face {
    normal: DVec3,
    offset: f64,
    /// Corners, counter-clockwise from outside.
    corners: Vec<DVec3>,
    /// Unit direction of growing u.
    along: DVec3,
    /// u and v are 0 and 1 at these coordinates along `along` and across.
    low: DVec2,
    high: DVec2,
    triangles: AreaTable,
}

/// A bounded convex solid with flat faces.
#[derive(Clone)]
pub struct Polyhedron {
    points: Vec<DVec3>,
    faces: Vec<Face>,
    bounds: Aabb,
    areas: AreaTable,
}

impl fmt::Debug for Polyhedron {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Polyhedron").field(&self.points).finish()
    }
}

impl PartialEq for Polyhedron {
    /// All else follows from the points.
    fn eq(&self, other: &Polyhedron) -> bool {
        self.points == other.points
    }
}

impl Polyhedron {
    /// The convex hull of at most [`hull::MOST_POINTS`] points.
    ///
    /// # Errors
    /// When they are too few or too many, lie in one plane, or are not finite.
    pub fn new(points: Vec<DVec3>) -> Result<Polyhedron, HullError> {
        let triangles = hull::triangles(&points)?;
        let extent = hull::extent(&points);
        let mut faces: Vec<(Vec<u32>, Face)> = coplanar_groups(&points, &triangles, COPLANAR * extent)
            .into_iter()
            .filter_map(|g| Face::new(&points, &g))
            .collect();
        faces.sort_by(|a, b| a.0.cmp(&b.0));
        let faces: Vec<Face> = faces.into_iter().map(|(_, face)| face).collect();
        let hull = points.iter().fold(Aabb::EMPTY, |hull, &p| hull.union(&Aabb::new(p, p)));
        let areas = AreaTable::new(faces.iter().map(|face| face.triangles.total()));
        Ok(Polyhedron { points, faces, bounds: hull.dilated(BEYOND * extent), areas })
    }

    /// As they were given.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    pub(crate) fn contains(&self, p: DVec3) -> bool {
        self.faces.iter().all(|face| face.normal.dot(p) <= face.offset)
    }

    /// Reaches beyond the points by a billionth of the extent.
    pub(crate) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// `dir` of any length. Roots are off the face's plane by at most 8 units in the last place of the largest coordinate.
    pub(crate) fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        let (mut t0, mut f0) = (f64::NEG_INFINITY, 0);
        let (mut t1, mut f1) = (f64::INFINITY, 0);
        for (i, face) in (0..).zip(&self.faces) {
            let distance = face.offset - face.normal.dot(origin);
            let rate = face.normal.dot(dir);
            if rate == 0.0 {
                if distance < 0.0 {
                    return Crossings::NONE;
                }
                continue;
            }
            let t = distance / rate;
            if rate < 0.0 {
                if t > t0 {
                    (t0, f0) = (t, i);
                }
            } else if t < t1 {
                (t1, f1) = (t, i);
            }
            if t0 >= t1 {
                return Crossings::NONE;
            }
        }
        Crossings::interval(t0, f0, t1, f1)
    }

    /// u and v over the rectangle about the face whose u is along the edge from its lowest corner.
    pub(crate) fn surface(&self, p: DVec3, face: u32) -> LocalPoint {
        let face = &self.faces[face as usize];
        let p = p + face.normal * (face.offset - face.normal.dot(p));
        let uv = (face.flat(p) - face.low) / (face.high - face.low);
        LocalPoint { p, n: face.normal, uv, dpdu: face.along }
    }

    fn farthest(&self, n: DVec3) -> DVec3 {
        let by = |a: &&DVec3, b: &&DVec3| a.dot(n).total_cmp(&b.dot(n));
        let corner = self.points.iter().max_by(by).copied().unwrap_or_default();
        corner + n.normalize_or_zero() * (BEYOND * self.bounds.extent().max_element())
    }

    /// Greatest `n · p`, a billionth of the extent more at most.
    pub(crate) fn support(&self, n: DVec3) -> f64 {
        self.farthest(n).dot(n)
    }

    pub(crate) fn classify(&self, region: &Region) -> Classification {
        let mut inside = true;
        for face in &self.faces {
            let (middle, reach) = (region.c.dot(face.normal), region.reach(face.normal));
            if middle - reach > face.offset {
                return Classification::Outside;
            }
            inside &= middle + reach <= face.offset;
        }
        match inside {
            true => Classification::Inside,
            false if region.is_apart(|n| self.farthest(n)) => Classification::Outside,
            false => Classification::Boundary,
        }
    }

    pub(crate) fn areas(&self) -> &AreaTable {
        &self.areas
    }

    pub(crate) fn sample(&self, face: u32, u: [f64; 2]) -> DVec3 {
        let face = &self.faces[face as usize];
        let (triangle, rest) = face.triangles.choose(u[0]);
        let [b, c] = triangle_weights([rest, u[1]]);
        let [origin, first, second] = [0, triangle + 1, triangle + 2].map(|i| face.corners[i]);
        origin + (first - origin) * b + (second - origin) * c
    }
}

impl Face {
    /// The face of a group of triangles in one plane, with its points' numbers, ascending; `None` if it has no area.
    fn new(points: &[DVec3], group: &[[u32; 3]]) -> Option<(Vec<u32>, Face)> {
        let at = |i: u32| points[i as usize];
        let area = |t: &[u32; 3]| (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
        let normal = group.iter().map(area).sum::<DVec3>().try_normalize()?;
        let offset = points.iter().map(|p| p.dot(normal)).fold(f64::NEG_INFINITY, f64::max);
        let mut numbers: Vec<u32> = group.iter().flatten().copied().collect();
        numbers.sort_unstable();
        numbers.dedup();
        let outline = outline(points, &numbers, normal);
        let corners: Vec<DVec3> = outline.iter().map(|&i| at(i)).collect();
        let along = (*corners.get(1)? - corners[0]).try_normalize()?;
        let fan =
            (2..corners.len()).map(|i| 0.5 * (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]).dot(normal));
        let triangles = AreaTable::new(fan.map(|area| area.max(0.0)));
        let mut face = Face { normal, offset, corners, along, low: DVec2::ZERO, high: DVec2::ZERO, triangles };
        face.low = face.corners.iter().fold(DVec2::INFINITY, |m, &p| m.min(face.flat(p)));
        face.high = face.corners.iter().fold(DVec2::NEG_INFINITY, |m, &p| m.max(face.flat(p)));
        (face.triangles.len() > 0 && (face.high - face.low).min_element() > 0.0).then_some((numbers, face))
    }

    fn flat(&self, p: DVec3) -> DVec2 {
        DVec2::new(p.dot(self.along), p.dot(self.normal.cross(self.along)))
    }
}

/// The corners of points in a plane, counter-clockwise about its normal from the lowest number on, without those on
/// edges (Andrew 1979).
fn outline(points: &[DVec3], numbers: &[u32], normal: DVec3) -> Vec<u32> {
    let (x, y) = normal.any_orthonormal_pair();
    let mut flat: Vec<(DVec2, u32)> =
        numbers.iter().map(|&i| (DVec2::new(points[i as usize].dot(x), points[i as usize].dot(y)), i)).collect();
    flat.sort_by(|(a, i), (b, j)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(i.cmp(j)));
    let chain = |list: &mut dyn Iterator<Item = &(DVec2, u32)>| {
        let mut kept: Vec<(DVec2, u32)> = Vec::new();
        for &next in list {
            while let [.., a, b] = kept[..]
                && (b.0 - a.0).perp_dot(next.0 - b.0) <= 0.0
            {
                kept.pop();
            }
            kept.push(next);
        }
        kept.pop();
        kept
    };
    let mut corners: Vec<u32> =
        chain(&mut flat.iter()).into_iter().chain(chain(&mut flat.iter().rev())).map(|(_, i)| i).collect();
    let lowest = (0..corners.len()).min_by_key(|&i| corners[i]).unwrap_or(0);
    corners.rotate_left(lowest);
    corners
}

/// Triangles joined across edges where they lie in one plane.
fn coplanar_groups(points: &[DVec3], triangles: &[[u32; 3]], tolerance: f64) -> Vec<Vec<[u32; 3]>> {
    let mut beside: HashMap<(u32, u32), usize> = HashMap::new();
    for (i, &[a, b, c]) in triangles.iter().enumerate() {
        beside.extend([((a, b), i), ((b, c), i), ((c, a), i)]);
    }
    let at = |i: u32| points[i as usize];
    let surpasses = |t: &[u32; 3], other: &[u32; 3]| {
        let normal = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).normalize_or_zero();
        normal != DVec3::ZERO && other.iter().any(|&p| (at(p) - at(t[0])).dot(normal).abs() > tolerance)
    };
    let mut groups: Vec<Vec<[u32; 3]>> = Vec::new();
    let mut taken = vec![false; triangles.len()];
    for first in 0..triangles.len() {
        if std::mem::replace(&mut taken[first], true) {
            continue;
        }
        let mut group = vec![first];
        let mut next = 0;
        while let Some(&i) = group.get(next) {
            next += 1;
            let [a, b, c] = triangles[i];
            for edge in [(b, a), (c, b), (a, c)] {
                let Some(&other) = beside.get(&edge) else { continue };
                let (t, o) = (&triangles[i], &triangles[other]);
                // Slivers have no normal to speak of: it is enough that one lies in the plane of the other.
                if !(taken[other] || surpasses(t, o) && surpasses(o, t)) {
                    taken[other] = true;
                    group.push(other);
                }
            }
        }
        groups.push(group.into_iter().map(|i| triangles[i]).collect());
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_cube_has_six_faces() {
        let turn = glam::DMat3::from_rotation_y(0.7) * glam::DMat3::from_rotation_x(0.4);
        let corners = Aabb::new(DVec3::ZERO, DVec3::ONE).corners().map(|p| turn * p);
        let cube = Polyhedron::new(corners.to_vec()).unwrap();
        assert_eq!(cube.faces.len(), 6);
        assert!((cube.areas.total() - 6.0).abs() < 1e-12);
        assert!(cube.faces.iter().all(|face| face.corners.len() == 4));
        // The first three faces are those of the first point.
        assert!((0..3).all(|i| cube.faces[i].corners[0] == corners[0]));
    }

    #[test]
    fn points_inside_and_on_faces_change_nothing() {
        let mut points = Aabb::new(DVec3::ZERO, DVec3::ONE).corners().to_vec();
        let cube = Polyhedron::new(points.clone()).unwrap();
        points.extend([DVec3::splat(0.5), DVec3::new(0.5, 0.0, 0.0), DVec3::new(1.0, 0.25, 0.5), DVec3::ONE]);
        let more = Polyhedron::new(points).unwrap();
        assert_eq!(more.faces.len(), 6);
        assert_eq!(more.areas.total(), cube.areas.total());
    }
}
