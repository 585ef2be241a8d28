//! Convex hull of points in space: incremental (Clarkson and Shor 1989, without the conflict graph), with exact
//! predicates (Shewchuk 1997), so that no degeneracy breaks it.
//!
//! A face is visible from a point that lies strictly before its plane. Points within the plane of a face are outside of
//! other faces if they are outside at all, so that a flat side with many points becomes several triangles in one plane.

use std::collections::HashSet;
use std::fmt;

use glam::DVec3;
use robust::{Coord3D, orient3d};

/// Why points have no hull with a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HullError {
    /// A coordinate is not finite, or too large or too small to compute with.
    OutOfRange,
    TooFewPoints,
    TooManyPoints,
    /// All points lie (to a billionth of their extent) in one plane.
    Flat,
}

/// More would take too long: the work grows with the square.
pub const MOST_POINTS: usize = 2048;
impl fmt::Display for HullError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            HullError::OutOfRange => f.write_str("a coordinate is not finite, or all are too large or small"),
            HullError::TooFewPoints => f.write_str("a polyhedron has four corners or more"),
            HullError::TooManyPoints => write!(f, "there are more than {MOST_POINTS} points"),
            HullError::Flat => f.write_str("all points lie in one plane"),
        }
    }
}

impl std::error::Error for HullError {}

/// Thickness that counts as none, relative to the extent.
const FLAT: f64 = 1e-9;

/// Triangles of the hull, counter-clockwise from outside.
pub(crate) fn triangles(points: &[DVec3]) -> Result<Vec<[u32; 3]>, HullError> {
    if points.len() < 4 {
        return Err(HullError::TooFewPoints);
    }
    if points.len() > MOST_POINTS {
        return Err(HullError::TooManyPoints);
    }
    let extent = extent(points);
    let largest = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    if !(points.iter().all(|p| p.is_finite()) && largest < 1e60 && extent > 1e-60) {
        return Err(HullError::OutOfRange);
    }
    let first = first_simplex(points, extent)?;
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for i in 0..4 {
        let [a, b, c] = [1, 2, 3].map(|k| first[(i + k) % 4]);
        let outward = !is_before(points, [a, b, c], first[i]);
        faces.push(if outward { [a, b, c] } else { [a, c, b] });
    }
    for p in (0..points.len() as u32).filter(|p| !first.contains(p)) {
        let (visible, hidden): (Vec<_>, Vec<_>) = faces.iter().partition(|face| is_before(points, **face, p));
        if visible.is_empty() {
            continue;
        }
        let edges = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
        let seen: HashSet<(u32, u32)> = visible.iter().flat_map(|face: &[u32; 3]| edges(*face)).collect();
        faces = hidden;
        let horizon = visible.iter().flat_map(|face| edges(*face)).filter(|&(a, b)| !seen.contains(&(b, a)));
        faces.extend(horizon.map(|(a, b)| [a, b, p]));
    }
    Ok(faces)
}

/// Longest side of the points' box.
pub(crate) fn extent(points: &[DVec3]) -> f64 {
    let low = points.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
    let high = points.iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
    (high - low).max_element()
}

/// Point `p` lies strictly on the outer side of the triangle.
fn is_before(points: &[DVec3], face: [u32; 3], p: u32) -> bool {
    let at = |i: u32| {
        let DVec3 { x, y, z } = points[i as usize];
        Coord3D { x, y, z }
    };
    orient3d(at(face[0]), at(face[1]), at(face[2]), at(p)) < 0.0
}

/// Four points far from one plane.
fn first_simplex(points: &[DVec3], extent: f64) -> Result<[u32; 4], HullError> {
    let farthest = |measure: &dyn Fn(DVec3) -> f64| {
        let by = |&i: &usize, &j: &usize| measure(points[i]).total_cmp(&measure(points[j])).then(j.cmp(&i));
        (0..points.len()).max_by(by).unwrap_or(0)
    };
    let a = points[0];
    let b = farthest(&|p| p.distance_squared(a));
    let along = (points[b] - a).try_normalize().ok_or(HullError::Flat)?;
    let c = farthest(&|p| (p - a).cross(along).length_squared());
    let normal = (points[c] - a).cross(along).try_normalize().ok_or(HullError::Flat)?;
    let d = farthest(&|p| (p - a).dot(normal).abs());
    let thickness = (points[d] - a).dot(normal).abs();
    let width = (points[c] - a).cross(along).length();
    if thickness.min(width) <= FLAT * extent {
        return Err(HullError::Flat);
    }
    Ok([0, b as u32, c as u32, d as u32])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Euler's formula, every edge twice, every point behind every face.
    fn check(points: &[DVec3]) -> usize {
        let faces = triangles(points).unwrap();
        let mut corners: Vec<u32> = faces.iter().flatten().copied().collect();
        corners.sort_unstable();
        corners.dedup();
        assert_eq!(faces.len(), 2 * corners.len() - 4);
        for face in &faces {
            assert!((0..points.len() as u32).all(|p| !is_before(points, *face, p)));
        }
        corners.len()
    }

    #[test]
    fn cubes_lattices_and_balls() {
        let lattice = |n: i32| -> Vec<DVec3> {
            let axis = move || (0..n).map(f64::from);
            axis().flat_map(|x| axis().flat_map(move |y| axis().map(move |z| DVec3::new(x, y, z)))).collect()
        };
        assert_eq!(check(&lattice(2)), 8);
        assert!(check(&lattice(4)) >= 8);
        let ball: Vec<DVec3> = (0..300)
            .map(|i| {
                let (z, angle) = (2.0 * (f64::from(i) + 0.5) / 300.0 - 1.0, f64::from(i) * 2.399_963);
                DVec3::new((1.0 - z * z).sqrt() * angle.cos(), (1.0 - z * z).sqrt() * angle.sin(), z)
            })
            .collect();
        assert_eq!(check(&ball), 300);
        let turned: Vec<DVec3> = lattice(3)
            .into_iter()
            .map(|p| glam::DMat3::from_rotation_x(0.3) * glam::DMat3::from_rotation_z(1.1) * p)
            .collect();
        check(&turned);
    }

    #[test]
    fn what_has_no_volume() {
        let flat: Vec<DVec3> = (0..20).map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5), 1e-12)).collect();
        assert_eq!(triangles(&flat), Err(HullError::Flat));
        assert_eq!(triangles(&[DVec3::ONE; 9]), Err(HullError::OutOfRange));
        assert_eq!(triangles(&[DVec3::X, DVec3::Y, DVec3::Z]), Err(HullError::TooFewPoints));
        assert_eq!(triangles(&[DVec3::X, DVec3::Y, DVec3::Z, DVec3::NAN]), Err(HullError::OutOfRange));
    }
}
