//! Signed distances to solids that are no low polynomials, from their definitions: the winding number of a mesh (van Oosterom and
//! Strackee 1983), the supporting planes of a point set, the even-odd rule in a polygon, the monotone sum of
//! powers of a superellipsoid. Plain doubles: their rounding is a
//! thousandth of the tolerances that answers are compared with.

use arsc_geometry::{DVec2, Polyhedron, Prism, Superquadric, TriangleMesh};
use glam::DVec3;

/// Distance from a triangle.
fn from_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let n = (b - a).cross(c - a);
    let within = [(a, b), (b, c), (c, a)].iter().all(|(u, v)| (v - u).cross(p - u).dot(n) >= 0.0);
    if within {
        return ((p - a).dot(n) / n.length()).abs();
    }
    [(a, b), (b, c), (c, a)].iter().map(|&(u, v)| from_segment(p, u, v)).fold(f64::INFINITY, f64::min)
}

fn from_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    (a + (b - a) * t - p).length()
}

/// How far beyond a box a point is, if it is.
fn beyond(points: impl Iterator<Item = DVec3>, p: DVec3) -> Option<f64> {
    let (low, high) = points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), q| (l.min(q), h.max(q)));
    let far = (low - p).max(p - high).max_element();
    (far > 1e-3 * (high - low).max_element()).then_some(far)
}

pub fn mesh(mesh: &TriangleMesh, p: DVec3) -> f64 {
    if let Some(far) = beyond((0..mesh.positions.len() as u32).map(|v| mesh.position(v)), p) {
        return far;
    }
    let mut winding = 0.0;
    let mut nearest = f64::INFINITY;
    for triangle in 0..mesh.triangles.len() {
        let corners = mesh.corners(triangle);
        let [a, b, c] = corners.map(|corner| corner - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        winding += 2.0 * a.dot(b.cross(c)).atan2(below);
        nearest = nearest.min(from_triangle(p, corners));
    }
    if winding > std::f64::consts::TAU { -nearest } else { nearest }
}

/// Greatest of the distances from all planes through three of the points that have no point beyond them.
pub fn polyhedron(polyhedron: &Polyhedron, p: DVec3) -> f64 {
    let points = polyhedron.points();
    if let Some(far) = beyond(points.iter().copied(), p) {
        return far;
    }
    let mut value = f64::NEG_INFINITY;
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate().skip(i + 1) {
            for &c in &points[j + 1..] {
                let n = (b - a).cross(c - a).normalize_or_zero();
                for n in [n, -n] {
                    if n != DVec3::ZERO && points.iter().all(|&q| n.dot(q - a) < 1e-13) {
                        value = value.max(n.dot(p - a));
                    }
                }
            }
        }
    }
    value
}

pub fn prism(prism: &Prism, p: DVec3) -> f64 {
    let flat = p.truncate();
    let mut inside = false;
    let mut nearest = f64::INFINITY;
    for ring in prism.polygon().rings() {
        for (i, &a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            nearest = nearest.min(from_segment(flat.extend(0.0), a.extend(0.0), b.extend(0.0)));
            let across = |a: DVec2, b: DVec2| a.x + (b.x - a.x) * (flat.y - a.y) / (b.y - a.y);
            inside ^= (a.y > flat.y) != (b.y > flat.y) && flat.x < across(a, b);
        }
    }
    let side = if inside { -nearest } else { nearest };
    side.max(-p.z).max(p.z - prism.height())
}

/// Whether a point is in a superellipsoid; open when one at most `near` away may not be. The sum of powers grows with every
/// coordinate's size.
pub fn superquadric(superquadric: &Superquadric, p: DVec3, near: f64) -> Option<bool> {
    let [e1, e2] = superquadric.exponents();
    let inside = |p: DVec3| {
        let p = p.abs();
        p.max_element() <= 1.0 && (p.x.powf(2.0 / e2) + p.y.powf(2.0 / e2)).powf(e2 / e1) + p.z.powf(2.0 / e1) <= 1.0
    };
    let (inner, outer) = ((p.abs() - near).max(DVec3::ZERO), p.abs() + near);
    (inside(inner) == inside(outer)).then(|| inside(inner))
}
