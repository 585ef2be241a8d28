//! Which triangles of a closed mesh a line passes through: exact in parity.
//!
//! Vertices are projected along the line by a shear of its dominant axis (Woop, Benthin and Wald 2013), so each vertex
//! becomes one point of the plane, rounded the same way for every triangle that it belongs to. Whether the projected
//! triangle holds the line is then decided *exactly*: signs of two-dimensional orientations by adaptive arithmetic
//! (Shewchuk 1997), ties as if the line were moved by (ε, ε²) (simulation of simplicity, Edelsbrunner and Mücke 1990).
//! The projected mesh is a closed surface over the plane and the moved line a point in general position, so it is
//! covered an even number of times, whatever the rounding did: no line slips between two triangles or counts an
//! edge twice, through vertices and along faces too.

use glam::DVec3;
use robust::{Coord, orient2d};

/// Relative rounding error of a difference of two products (Shewchuk's `ccwerrboundA`), rounded up.
const PRODUCTS: f64 = 3.4e-16;

/// A projected area below so many of its error bounds says nothing about where the line passes.
const EDGE_ON: f64 = 1e6;

/// Barycentric coordinate up to which a line passes near an edge.
const MARGIN: f64 = 1.0 / (1 << 12) as f64;

/// A line that points are projected along.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    origin: [f64; 3],
    /// Axes of the plane, then that of the largest component of the direction.
    axes: [usize; 3],
    /// Slope of the line over its dominant axis.
    shear: [f64; 2],
    inverse: f64,
}

/// A vertex seen along the line: the line is at (0, 0), and passes the vertex at parameter `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    pub x: f64,
    pub y: f64,
    pub t: f64,
}

impl Projection {
    /// `dir` is finite and not zero.
    pub fn new(origin: DVec3, dir: DVec3) -> Projection {
        let major = dir.abs().max_position();
        let axes = [(major + 1) % 3, (major + 2) % 3, major];
        let d = dir.to_array();
        let shear = [d[axes[0]] / d[major], d[axes[1]] / d[major]];
        Projection { origin: origin.to_array(), axes, shear, inverse: 1.0 / d[major] }
    }

    /// The axis of the largest component of the direction.
    pub fn major(&self) -> usize {
        self.axes[2]
    }

    /// `MAJOR` is [`Projection::major`].
    #[inline]
    pub fn project<const MAJOR: usize>(&self, p: [f32; 3]) -> Projected {
        let axes = [(MAJOR + 1) % 3, (MAJOR + 2) % 3, MAJOR];
        let [x, y, z] = axes.map(|axis| f64::from(p[axis]) - self.origin[axis]);
        Projected { x: x - self.shear[0] * z, y: y - self.shear[1] * z, t: z * self.inverse }
    }

    /// Whether the line may pass through a triangle with corners in this box. Rounding is monotone, and the bounds go
    /// through the same operations as the vertices: none that [`crossing`] counts is ever turned down. `MAJOR` is
    /// [`Projection::major`].
    #[inline]
    pub fn meets_box<const MAJOR: usize>(&self, min: [f32; 3], max: [f32; 3]) -> bool {
        let axes = [(MAJOR + 1) % 3, (MAJOR + 2) % 3, MAJOR];
        let low = axes.map(|axis| f64::from(min[axis]) - self.origin[axis]);
        let high = axes.map(|axis| f64::from(max[axis]) - self.origin[axis]);
        let meets = |i: usize| {
            let (a, b) = (self.shear[i] * low[2], self.shear[i] * high[2]);
            let (least, most) = if a < b { (a, b) } else { (b, a) };
            (low[i] - most <= 0.0) & (high[i] - least >= 0.0)
        };
        meets(0) & meets(1)
    }
}

/// Where a line passes through a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    pub t: f64,
    /// It goes against the normal.
    pub enters: bool,
    /// So near an edge ([`MARGIN`]), or so nearly along the triangle, that the line may pass a neighbour at the same place.
    pub is_marginal: bool,
}

/// The passage of the line through the triangle, if there is one.
///
/// The error of its parameter is some 2⁻⁵⁰ of the largest number involved over the cosine of the angle of incidence; it never leaves the
/// stretch of the line along which the triangle lies.
#[inline]
pub fn crossing(line: &Projection, a: Projected, b: Projected, c: Projected) -> Option<Passage> {
    let (u, v, w) = (product(b, c), product(c, a), product(a, b));
    let sign = side(b, c, u);
    if sign == 0 || side(c, a, v) != sign || side(a, b, w) != sign {
        return None;
    }
    let enters = (sign > 0) != (line.inverse > 0.0);
    let area = u.0 + v.0 + w.0;
    if area.abs() <= EDGE_ON * (u.1 + v.1 + w.1) {
        return Some(Passage { t: edge_on(a, b, c), enters, is_marginal: true });
    }
    let t = (u.0 * a.t + v.0 * b.t + w.0 * c.t) / area;
    let t = t.clamp(a.t.min(b.t).min(c.t), a.t.max(b.t).max(c.t));
    let is_marginal = u.0.abs().min(v.0.abs()).min(w.0.abs()) <= MARGIN * area.abs();
    Some(Passage { t, enters, is_marginal })
}

/// The same for a triangle that is hardly more than a line in the projection: the middle of the stretch between its edges,
/// along the axis of its larger extent.
#[cold]
fn edge_on(a: Projected, b: Projected, c: Projected) -> f64 {
    let extent = |f: fn(Projected) -> f64| f(a).max(f(b)).max(f(c)) - f(a).min(f(b)).min(f(c));
    let along: fn(Projected) -> f64 = if extent(|p| p.x) >= extent(|p| p.y) { |p| p.x } else { |p| p.y };
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (p, q) in [(a, b), (b, c), (c, a)] {
        let (x, y) = (along(p), along(q));
        if x.min(y) <= 0.0 && x.max(y) >= 0.0 {
            let share = if x == y { 0.5 } else { x / (x - y) };
            let t = p.t + (q.t - p.t) * share;
            (low, high) = (low.min(t), high.max(t));
        }
    }
    let middle = 0.5 * (low + high);
    if middle.is_finite() { middle } else { a.t }
}

/// `a × b`, and a bound on its rounding error.
#[inline]
fn product(a: Projected, b: Projected) -> (f64, f64) {
    let (l, r) = (a.x * b.y, a.y * b.x);
    (l - r, PRODUCTS * (l.abs() + r.abs()))
}

/// On which side of the edge the line passes; zero only when the edge is a point.
#[inline]
fn side(a: Projected, b: Projected, (value, bound): (f64, f64)) -> i8 {
    if value.abs() > bound {
        return if value > 0.0 { 1 } else { -1 };
    }
    exact_side(a, b)
}

#[cold]
fn exact_side(a: Projected, b: Projected) -> i8 {
    let coord = |p: Projected| Coord { x: p.x, y: p.y };
    let value = orient2d(coord(a), coord(b), Coord { x: 0.0, y: 0.0 });
    let sign = |positive: bool| if positive { 1 } else { -1 };
    if value != 0.0 {
        sign(value > 0.0)
    } else if a.y != b.y {
        // The coefficient of ε, then that of ε².
        sign(a.y > b.y)
    } else if a.x != b.x {
        sign(a.x < b.x)
    } else {
        0
    }
}
