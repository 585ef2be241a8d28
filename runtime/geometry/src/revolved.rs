//! A line and a stretch of a profile turned about the z axis.
//!
//! Along the line its distance ρ from the axis is a convex function of t, and where z grows or falls along both line and
//! profile, the profile's radius r is a function of t too. Pieces are cut so that r has no inflection either: then the
//! slopes of ρ and r are monotone, their values at the ends of an interval bound that of ρ − r within, and every root is
//! isolated by bisection (Moore 1966). On which side the line is at an end of a piece is computed alike for both pieces
//! that meet there, so that crossings come in pairs.

use glam::{DVec2, DVec3};

use crate::profile::Segment;

/// Halvings at most while looking for one root.
const STEPS: usize = 100;

/// Monotone in radius, height and slope.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) curve: Segment,
    pub(crate) face: u32,
}

/// A line not far from the solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    o: DVec3,
    d: DVec3,
    /// Beyond this stretch ρ exceeds every radius.
    low: f64,
    high: f64,
    /// Shorter intervals are not cut.
    shortest: f64,
    /// Less is rounding of ρ − r: where a line runs in the surface, sides are told at the ends of the stretch alone.
    rounding: f64,
}

/// A point of the line: ρ − r and the slopes of both by t.
#[derive(Clone, Copy)]
struct Node {
    t: f64,
    gap: f64,
    rho_rate: f64,
    r_rate: f64,
}

impl Node {
    fn is_outside(&self) -> bool {
        self.gap >= 0.0
    }
}

impl Line {
    /// `d` is unit; `None` when the line stays beyond the greatest radius.
    pub(crate) fn new(o: DVec3, d: DVec3, greatest: f64) -> Option<Line> {
        let flat = d.truncate().length_squared();
        let shortest = 1e-13 * greatest;
        let rounding = 16.0 * f64::EPSILON * (greatest + o.length());
        if flat == 0.0 {
            return Some(Line { o, d, low: f64::NEG_INFINITY, high: f64::INFINITY, shortest, rounding });
        }
        let middle = -o.truncate().dot(d.truncate()) / flat;
        let closest = (o + d * middle).truncate().length();
        let greatest = greatest * (1.0 + 1e-9);
        let reach = ((greatest - closest).max(0.0) * (greatest + closest) / flat).sqrt();
        (closest < greatest).then_some(Line { o, d, low: middle - reach, high: middle + reach, shortest, rounding })
    }

    pub(crate) fn rho(&self, t: f64) -> f64 {
        (self.o + self.d * t).truncate().length()
    }

    fn rho_rate(&self, t: f64) -> f64 {
        let p = (self.o + self.d * t).truncate();
        let rho = p.length();
        if rho > 0.0 { p.dot(self.d.truncate()) / rho } else { 0.0 }
    }

    /// Where the line has a height; infinite for lines across the axis.
    fn at_height(&self, z: f64) -> f64 {
        (z - self.o.z) / self.d.z
    }

    /// The line may meet profiles within this box.
    pub(crate) fn reaches(&self, min: DVec2, max: DVec2) -> bool {
        let (mut low, mut high) = (self.low, self.high);
        if self.d.z == 0.0 {
            if self.o.z < min.y || self.o.z > max.y {
                return false;
            }
        } else {
            let (a, b) = (self.at_height(min.y), self.at_height(max.y));
            low = low.max(a.min(b));
            high = high.min(a.max(b));
        }
        let slack = self.shortest + 1e-12 * max.x;
        let (low, high) = (low - slack, high + slack);
        if low > high {
            return false;
        }
        let flat = self.d.truncate();
        let middle = if flat == DVec2::ZERO { low } else { -self.o.truncate().dot(flat) / flat.length_squared() };
        let nearest = self.rho(middle.clamp(low, high));
        let farthest = self.rho(low).max(self.rho(high));
        nearest <= max.x + slack && (farthest >= min.x - slack || !farthest.is_finite())
    }

    /// Adds the crossings of a piece.
    pub(crate) fn cross(&self, piece: &Piece, found: &mut impl FnMut(f64, u32)) {
        let (a, b) = (piece.curve.c[0], piece.curve.c[3]);
        if self.d.z == 0.0 {
            return self.cross_level(piece, found);
        }
        let (ta, tb) = (self.at_height(a.y), self.at_height(b.y));
        if a.y == b.y {
            if (self.rho(ta) >= a.x) != (self.rho(ta) >= b.x) {
                found(ta, piece.face);
            }
            return;
        }
        let (first, last) = if ta < tb { (a, b) } else { (b, a) };
        let (ta, tb) = (ta.min(tb), ta.max(tb));
        if ta >= self.high || tb <= self.low {
            return;
        }
        let start = if ta > self.low { self.end(piece, ta, first) } else { self.beyond(piece, self.low) };
        let end = if tb < self.high { self.end(piece, tb, last) } else { self.beyond(piece, self.high) };
        self.isolate(piece, start, end, found);
    }

    /// A line of constant height crosses at the radius there, before and after its closest approach to the axis.
    fn cross_level(&self, piece: &Piece, found: &mut impl FnMut(f64, u32)) {
        let (z, flat) = (self.o.z, self.d.truncate());
        if !piece.spans(z) {
            return;
        }
        let radius = piece.radius(z);
        let middle = -self.o.truncate().dot(flat) / flat.length_squared();
        let closest = self.rho(middle);
        if radius > closest {
            let half = ((radius - closest) * (radius + closest) / flat.length_squared()).sqrt();
            found(middle - half, piece.face);
            found(middle + half, piece.face);
        }
    }

    /// At an end of the piece.
    fn end(&self, piece: &Piece, t: f64, end: DVec2) -> Node {
        let s = if end == piece.curve.c[0] { 0.0 } else { 1.0 };
        Node { t, gap: self.rho(t) - end.x, rho_rate: self.rho_rate(t), r_rate: piece.slope(s) * self.d.z }
    }

    /// Where ρ exceeds every radius.
    fn beyond(&self, piece: &Piece, t: f64) -> Node {
        let node = self.node(piece, t);
        Node { gap: node.gap.max(0.0), ..node }
    }

    fn node(&self, piece: &Piece, t: f64) -> Node {
        let s = piece.parameter(self.o.z + self.d.z * t);
        let (r, slope) = (piece.curve.at(s).x, piece.slope(s));
        Node { t, gap: self.rho(t) - r, rho_rate: self.rho_rate(t), r_rate: slope * self.d.z }
    }

    fn isolate(&self, piece: &Piece, start: Node, end: Node, found: &mut impl FnMut(f64, u32)) {
        let mut open: smallvec::SmallVec<[(Node, Node); 16]> = smallvec::smallvec![(start, end)];
        while let Some((a, b)) = open.pop() {
            let least = a.rho_rate - a.r_rate.max(b.r_rate);
            let most = b.rho_rate - a.r_rate.min(b.r_rate);
            let differ = a.is_outside() != b.is_outside();
            let width = b.t - a.t;
            let largest = a.gap.abs().min(b.gap.abs()) + width * most.max(-least);
            let is_flat = largest <= self.rounding + 4.0 * f64::EPSILON * a.t.abs().max(b.t.abs());
            if least > 0.0 || most < 0.0 || width <= self.shortest || is_flat {
                if differ {
                    found(self.root(piece, a, b), piece.face);
                }
                continue;
            }
            if !differ && stays(a.gap, b.gap, least, most, width) {
                continue;
            }
            let middle = self.node(piece, 0.5 * (a.t + b.t));
            open.push((middle, b));
            open.push((a, middle));
        }
    }

    /// The root between two points on different sides, by safeguarded Newton steps.
    fn root(&self, piece: &Piece, a: Node, b: Node) -> f64 {
        let (mut low, mut high) = (a.t, b.t);
        let mut t = low + (high - low) * (a.gap / (a.gap - b.gap)).clamp(0.0, 1.0);
        for _ in 0..STEPS {
            let node = self.node(piece, t);
            if node.is_outside() == a.is_outside() {
                low = t;
            } else {
                high = t;
            }
            let newton = t - node.gap / (node.rho_rate - node.r_rate);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - t).abs() <= f64::EPSILON * (t.abs() + self.shortest) {
                return next;
            }
            t = next;
        }
        t
    }
}

/// A function with these values at both ends of an interval, of one sign, and slopes within bounds has no root.
fn stays(a: f64, b: f64, least: f64, most: f64, width: f64) -> bool {
    // Turned so that the values are positive: it falls from the left and rises to the right as steeply as it may.
    let (a, b, fall, rise) = if a >= 0.0 { (a, b, least, most) } else { (-a, -b, -most, -least) };
    if !(fall.is_finite() && rise.is_finite()) {
        return false;
    }
    let x = if rise > fall { ((a - b + rise * width) / (rise - fall)).clamp(0.0, width) } else { 0.0 };
    (a + fall * x).max(b - rise * (width - x)) > 0.0
}

impl Piece {
    /// Exactly one end is above.
    pub(crate) fn spans(&self, z: f64) -> bool {
        (self.curve.c[0].y > z) != (self.curve.c[3].y > z)
    }

    /// Radius over height along the piece; infinite where the height turns. Where one of them turns rounding may give its
    /// rate the wrong sign, but along the whole piece it is known.
    fn slope(&self, s: f64) -> f64 {
        let rate = self.curve.rate(s).abs();
        let whole = self.curve.c[3] - self.curve.c[0];
        let slope = if rate == DVec2::ZERO { (whole.x / whole.y).abs() } else { rate.x / rate.y };
        slope.copysign(whole.x * whole.y)
    }

    pub(crate) fn radius(&self, z: f64) -> f64 {
        self.curve.at(self.parameter(z)).x
    }

    /// Where the piece has a height, clamped to its ends.
    fn parameter(&self, z: f64) -> f64 {
        let (a, b) = (self.curve.c[0].y, self.curve.c[3].y);
        let mut s = ((z - a) / (b - a)).clamp(0.0, 1.0);
        if self.curve.is_line || s == 0.0 || s == 1.0 {
            return s;
        }
        let rising = b > a;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..STEPS {
            let excess = self.curve.at(s).y - z;
            if (excess > 0.0) == rising {
                high = s;
            } else {
                low = s;
            }
            let newton = s - excess / self.curve.rate(s).y;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - s).abs() <= f64::EPSILON {
                return next;
            }
            s = next;
        }
        s
    }

    /// The piece has a point in common with a rectangle, or nearly.
    pub(crate) fn meets(&self, min: DVec2, max: DVec2) -> bool {
        let [a, .., b] = self.curve.c;
        if a.min(b).cmpgt(max).any() || a.max(b).cmplt(min).any() {
            return false;
        }
        let n = (b - a).perp();
        let (middle, half) = (0.5 * (min + max), 0.5 * (max - min));
        let reach = n.abs().dot(half);
        let across = self.curve.c.map(|p| (p - middle).dot(n));
        let (low, high) = across.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
        low <= reach && high >= -reach
    }
}
