//! Signed distances to solids that are no low polynomials, from their definitions: the winding number of a mesh (van Oosterom and
//! Strackee 1983), the supporting planes of a point set, the even-odd rule in a polygon and in a profile of lines or splines
//! (Catmull and Rom 1974), the monotone sum of powers of a superellipsoid. Plain doubles: their rounding is a
//! thousandth of the tolerances that answers are compared with.

use arsc_geometry::{DVec2, Lathe, Polyhedron, Prism, Superquadric, TriangleMesh};
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

/// A stretch of a profile: a cubic by its values and slopes at both ends (Hermite).
struct Stretch {
    ends: [DVec2; 2],
    slopes: [DVec2; 2],
}

impl Stretch {
    fn at(&self, s: f64) -> DVec2 {
        let ([a, b], [m, n]) = (self.ends, self.slopes);
        let (s2, s3) = (s * s, s * s * s);
        a * (2.0 * s3 - 3.0 * s2 + 1.0) + m * (s3 - 2.0 * s2 + s) + b * (3.0 * s2 - 2.0 * s3) + n * (s3 - s2)
    }

    /// The parts between 64 places, by their ends.
    fn parts() -> impl Iterator<Item = (f64, f64)> {
        (0..64).map(|i| (f64::from(i) / 64.0, f64::from(i + 1) / 64.0))
    }

    /// How often a line from `p` to greater radii crosses it. Parts are taken to be monotone in height.
    fn crossings(&self, p: DVec2) -> usize {
        let beyond = |(mut low, mut high): (f64, f64)| {
            let (above, below) = (self.at(low).y > p.y, self.at(high).y > p.y);
            if above == below {
                return false;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (self.at(middle).y > p.y) == above { low = middle } else { high = middle }
            }
            self.at(low).x > p.x
        };
        Stretch::parts().filter(|&part| beyond(part)).count()
    }

    fn rate(&self, s: f64) -> DVec2 {
        let ([a, b], [m, n]) = (self.ends, self.slopes);
        (a - b) * (6.0 * s * s - 6.0 * s) + m * (3.0 * s * s - 4.0 * s + 1.0) + n * (3.0 * s * s - 2.0 * s)
    }

    /// Distance from the nearest of the places, moved to where the curve is nearest by Gauss and Newton's steps.
    fn distance(&self, p: DVec2) -> f64 {
        let far = |s: f64| self.at(s).distance_squared(p);
        let nearest = Stretch::parts().map(|part| part.0).chain([1.0]).min_by(|a, b| far(*a).total_cmp(&far(*b)));
        let step = |s: f64, _| {
            let rate = self.rate(s);
            (s + (p - self.at(s)).dot(rate) / rate.length_squared()).clamp(0.0, 1.0)
        };
        far((0..8).fold(nearest.unwrap_or(0.0), step)).sqrt()
    }
}

/// The stretches of a profile; at an open end on the axis a smooth one goes across it.
fn stretches(lathe: &Lathe) -> Vec<Stretch> {
    let points = lathe.points();
    let n = points.len();
    let slope = |i: usize| {
        let neighbour = |step: usize| points[(i + step) % n];
        match i {
            _ if lathe.is_closed() || (i > 0 && i + 1 < n) => 0.5 * (neighbour(1) - neighbour(n - 1)),
            0 if points[0].x == 0.0 => DVec2::new(points[1].x, 0.0),
            0 => points[1] - points[0],
            _ if points[i].x == 0.0 => DVec2::new(-points[i - 1].x, 0.0),
            _ => points[i] - points[i - 1],
        }
    };
    let stretch = |i: usize| {
        let (a, b) = (points[i], points[(i + 1) % n]);
        let slopes = if lathe.is_smooth() { [slope(i), slope((i + 1) % n)] } else { [b - a, b - a] };
        Stretch { ends: [a, b], slopes }
    };
    let mut all: Vec<Stretch> = (0..if lathe.is_closed() { n } else { n - 1 }).map(stretch).collect();
    if !lathe.is_closed() {
        let cap = |p: DVec2| {
            let foot = DVec2::new(0.0, p.y);
            Stretch { ends: [p, foot], slopes: [foot - p, foot - p] }
        };
        all.extend([cap(points[0]), cap(points[n - 1])]);
    }
    all
}

pub fn lathe(lathe: &Lathe, p: DVec3) -> f64 {
    let flat = DVec2::new(p.truncate().length(), p.z);
    let all = stretches(lathe);
    let crossings: usize = all.iter().map(|stretch| stretch.crossings(flat)).sum();
    let nearest = all.iter().map(|stretch| stretch.distance(flat)).fold(f64::INFINITY, f64::min);
    if crossings % 2 == 1 { -nearest } else { nearest }
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
