//! Superellipsoid (Barr 1981) with unit half axes: `F(p) <= 1` for the gauge
//! `F = ((|x|^(2/e2) + |y|^(2/e2))^(e2/e1) + |z|^(2/e1))^(e1/2)`. One face.
//!
//! `F` grows in proportion along rays from the origin and is not less than the largest coordinate, so that nothing
//! overflows. With exponents up to 2 it is a norm, hence convex: Newton's steps from the box towards the solid never
//! pass a root. Beyond 2 the solid is pinched, and all roots are isolated by bounds on `F` and its slope over intervals
//! where no coordinate changes sign (every factor is monotone there, so its ends bound it).

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::sync::OnceLock;

use glam::{DVec2, DVec3};

use crate::region::Region;
use crate::superquadric_area::Patches;
use crate::{Aabb, Classification, Crossings, LocalPoint};

/// Least and greatest exponent: beyond, the shape is a box or a set of spikes to the eye.
pub const EXPONENTS: std::ops::RangeInclusive<f64> = 0.05..=10.0;

/// Newton's steps at most.
const STEPS: usize = 100;
/// Intervals that are looked at for all roots at most; what is left then is judged by its ends.
const INTERVALS: usize = 4000;
/// Shortest interval that is cut.
const SHORTEST: f64 = 1e-13;

/// `e1` shapes the section through the z axis, `e2` that across it: 0 tends to a square, 1 is round, 2 a rhombus.
pub struct Superquadric {
    e1: f64,
    e2: f64,
    /// 2 / e2.
    p: f64,
    /// 2 / e1.
    q: f64,
    patches: OnceLock<Patches>,
}

impl fmt::Debug for Superquadric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Superquadric {{ e1: {}, e2: {} }}", self.e1, self.e2)
    }
}

impl PartialEq for Superquadric {
    fn eq(&self, other: &Superquadric) -> bool {
        (self.e1, self.e2) == (other.e1, other.e2)
    }
}

/// `(u^p + v^p)^(1/p)`, arguments not negative.
fn norm(u: f64, v: f64, p: f64) -> f64 {
    let (low, high) = if u < v { (u, v) } else { (v, u) };
    if low == 0.0 { high } else { high * (1.0 + (low / high).powf(p)).powf(1.0 / p) }
}

/// The support of the unit ball of [`norm`] with exponent 2 / e, or of its convex hull.
fn dual(u: f64, v: f64, e: f64) -> f64 {
    if e >= 2.0 { u.max(v) } else { norm(u, v, 2.0 / (2.0 - e)) }
}

/// Least and greatest value.
type Range = (f64, f64);

/// Of `x^k` for a range of `x`, not negative.
fn power((low, high): Range, k: f64) -> Range {
    if k >= 0.0 { (low.powf(k), high.powf(k)) } else { (high.powf(k), low.powf(k)) }
}

/// Of `a / b` where `a <= b`, both not negative.
fn share((a0, a1): Range, (b0, b1): Range) -> Range {
    let high = if b0 > 0.0 { (a1 / b0).min(1.0) } else { 1.0 };
    (if b1 > 0.0 { a0 / b1 } else { 0.0 }, high)
}

impl Superquadric {
    /// `None` unless both exponents are within [`EXPONENTS`].
    pub fn new(e1: f64, e2: f64) -> Option<Superquadric> {
        let valid = EXPONENTS.contains(&e1) && EXPONENTS.contains(&e2);
        valid.then(|| Superquadric { e1, e2, p: 2.0 / e2, q: 2.0 / e1, patches: OnceLock::new() })
    }

    /// The exponents e1 and e2.
    pub fn exponents(&self) -> [f64; 2] {
        [self.e1, self.e2]
    }

    fn is_convex(&self) -> bool {
        self.e1.max(self.e2) <= 2.0
    }

    /// `F`.
    pub(crate) fn gauge(&self, p: DVec3) -> f64 {
        norm(norm(p.x.abs(), p.y.abs(), self.p), p.z.abs(), self.q)
    }

    /// A gradient of `F`, of any length in the limit at edges and spikes.
    pub(crate) fn gradient(&self, p: DVec3) -> DVec3 {
        let a = p.abs();
        let g = norm(a.x, a.y, self.p);
        let f = norm(g, a.z, self.q);
        let slope = |part: f64, whole: f64, k: f64| if whole > 0.0 { (part / whole).powf(k - 1.0) } else { 1.0 };
        let ring = slope(g, f, self.q);
        let along = DVec3::new(ring * slope(a.x, g, self.p), ring * slope(a.y, g, self.p), slope(a.z, f, self.q));
        let finite = if along.is_finite() {
            along
        } else {
            DVec3::from_array(along.to_array().map(|x| if x.is_finite() { 0.0 } else { 1.0 }))
        };
        DVec3::from_array(std::array::from_fn(|i| finite[i].copysign(p[i])))
    }

    pub(crate) fn contains(&self, p: DVec3) -> bool {
        self.gauge(p) <= 1.0
    }

    pub(crate) fn bounds(&self) -> Aabb {
        Aabb::new(DVec3::NEG_ONE, DVec3::ONE)
    }

    /// `dir` is unit. Roots are off the surface by at most 64 units in the last place of the origin's distance; a pair
    /// closer than 10⁻¹³ may be missed.
    pub(crate) fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        let shift = -origin.dot(dir);
        let o = origin + dir * shift;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for i in 0..3 {
            if dir[i] != 0.0 {
                let (a, b) = ((-1.0 - o[i]) / dir[i], (1.0 - o[i]) / dir[i]);
                low = low.max(a.min(b));
                high = high.min(a.max(b));
            } else if o[i].abs() > 1.0 {
                return Crossings::NONE;
            }
        }
        if low >= high {
            return Crossings::NONE;
        }
        if !self.is_convex() {
            return self.isolated(o, dir, low, high).remapped(shift, 1.0);
        }
        let enter = self.approach(o, dir, low, high);
        let leave = enter.and_then(|_| self.approach(o, -dir, -high, -low));
        match (enter, leave) {
            (Some(enter), Some(leave)) => Crossings::interval(enter + shift, 0, shift - leave, 0),
            _ => Crossings::NONE,
        }
    }

    /// The first root after `low`, where the line is outside; `F` convex along it.
    fn approach(&self, o: DVec3, dir: DVec3, low: f64, high: f64) -> Option<f64> {
        let mut t = low;
        for _ in 0..STEPS {
            let p = o + dir * t;
            let excess = self.gauge(p) - 1.0;
            let slope = self.gradient(p).dot(dir);
            if excess <= 0.0 {
                return Some(t);
            }
            if slope >= 0.0 {
                return None;
            }
            let next = t - excess / slope;
            if next > high {
                return None;
            }
            if next <= t {
                return Some(t);
            }
            t = next;
        }
        None
    }

    /// All roots between `low` and `high`, where the line is outside.
    fn isolated(&self, o: DVec3, dir: DVec3, low: f64, high: f64) -> Crossings {
        let mut cuts = vec![low, high];
        let zeros = (0..3).map(|i| -o[i] / dir[i]);
        cuts.extend(zeros.filter(|&t| t > low && t < high));
        cuts.sort_by(f64::total_cmp);
        let inside = |t: f64| self.contains(o + dir * t);
        let mut found = Crossings::NONE;
        let mut budget = INTERVALS;
        let mut before = (low, false);
        for (i, &cut) in cuts.iter().enumerate().skip(1) {
            let after = (cut, i + 1 < cuts.len() && inside(cut));
            let mut open = vec![(before, after)];
            while let Some((a, b)) = open.pop() {
                budget = budget.saturating_sub(1);
                match self.look(o, dir, a.0, b.0) {
                    Look::Empty => {}
                    Look::Unknown if budget > 0 && b.0 - a.0 > SHORTEST => {
                        let t = 0.5 * (a.0 + b.0);
                        let middle = (t, inside(t));
                        open.extend([(middle, b), (a, middle)]);
                    }
                    Look::Monotone | Look::Unknown => {
                        if a.1 != b.1 {
                            found.push(self.bisected(o, dir, a.0, b), 0);
                        }
                    }
                }
            }
            before = after;
        }
        found
    }

    /// What is certain about `F` between `a` and `b`, where no coordinate changes sign.
    fn look(&self, o: DVec3, dir: DVec3, a: f64, b: f64) -> Look {
        let (pa, pb) = (o + dir * a, o + dir * b);
        let (low, high) = (pa.abs().min(pb.abs()), pa.abs().max(pb.abs()));
        let ring = (norm(low.x, low.y, self.p), norm(high.x, high.y, self.p));
        let gauge = (norm(ring.0, low.z, self.q), norm(ring.1, high.z, self.q));
        if gauge.0 > 1.0 || gauge.1 < 1.0 {
            return Look::Empty;
        }
        let outer = power(share(ring, gauge), self.q - 1.0);
        let middle = (pa + pb) * 0.5;
        let mut slope = (0.0, 0.0);
        for i in 0..3 {
            let rate = dir[i] * middle[i].signum();
            if rate == 0.0 {
                continue;
            }
            let (least, most) = if i == 2 {
                power(share((low.z, high.z), gauge), self.q - 1.0)
            } else {
                let inner = power(share((low[i], high[i]), ring), self.p - 1.0);
                (outer.0 * inner.0, outer.1 * inner.1)
            };
            let (x, y) = (rate * least, rate * most);
            slope = (slope.0 + x.min(y), slope.1 + x.max(y));
        }
        if slope.0 > 0.0 || slope.1 < 0.0 { Look::Monotone } else { Look::Unknown }
    }

    /// The root between `a` and `b`, whose sides differ; `b` with its side.
    fn bisected(&self, o: DVec3, dir: DVec3, mut a: f64, (mut b, inside_b): (f64, bool)) -> f64 {
        let mut t = 0.5 * (a + b);
        for _ in 0..STEPS {
            let p = o + dir * t;
            let excess = self.gauge(p) - 1.0;
            if (excess <= 0.0) == inside_b {
                b = t;
            } else {
                a = t;
            }
            let newton = t - excess / self.gradient(p).dot(dir);
            let next = if newton > a && newton < b { newton } else { 0.5 * (a + b) };
            if (next - t).abs() <= f64::EPSILON * 0.5 {
                return next;
            }
            t = next;
        }
        t
    }

    /// u is the azimuth, v the angle from the south pole as seen from the centre, both over [0, 1].
    pub(crate) fn surface(&self, p: DVec3) -> LocalPoint {
        let gauge = self.gauge(p);
        let p = if gauge > 0.0 { p / gauge } else { DVec3::Z };
        let n = self.gradient(p).try_normalize().unwrap_or(DVec3::Z);
        let azimuth = p.y.atan2(p.x);
        let (sin, cos) = azimuth.sin_cos();
        let around = DVec3::new(-sin, cos, 0.0);
        let polar = (p.z / p.length()).clamp(-1.0, 1.0).acos();
        let uv = DVec2::new(azimuth.rem_euclid(TAU) / TAU, 1.0 - polar / PI);
        LocalPoint { p, n, uv, dpdu: around - n * n.dot(around) }
    }

    /// Greatest `n · p`.
    pub(crate) fn support(&self, n: DVec3) -> f64 {
        let n = n.abs();
        dual(dual(n.x, n.y, self.e2), n.z, self.e1)
    }

    pub(crate) fn classify(&self, region: &Region) -> Classification {
        region.refined(4, &|part| self.classify_once(part), &|p| self.contains(p))
    }

    fn classify_once(&self, region: &Region) -> Classification {
        let half = region.e[0].abs() + region.e[1].abs() + region.e[2].abs();
        let center = region.c.abs();
        if self.gauge((center - half).max(DVec3::ZERO)) > 1.0 {
            return Classification::Outside;
        }
        if self.gauge(center + half) <= 1.0 {
            return Classification::Inside;
        }
        if self.is_convex() {
            if region.corners().all(|p| self.contains(p)) {
                return Classification::Inside;
            }
            // F is not less than any of its tangents.
            let n = self.gradient(region.nearest(DVec3::ZERO, false));
            if region.c.dot(n) - region.reach(n) > 1.0 {
                return Classification::Outside;
            }
        }
        Classification::Boundary
    }

    fn patches(&self) -> &Patches {
        self.patches.get_or_init(|| Patches::new(self))
    }

    /// By quadrature; relative error below 10⁻³.
    pub(crate) fn area(&self) -> f64 {
        self.patches().area()
    }

    /// Points all over the surface, with the areas of the patches about them.
    pub(crate) fn pieces(&self) -> Vec<(DVec3, f64)> {
        self.patches().pieces(self)
    }

    /// A point with about the same density everywhere.
    pub(crate) fn sample(&self, u: [f64; 2]) -> DVec3 {
        self.patches().sample(self, u)
    }

    /// Density of [`Superquadric::sample`] at a surface point, per unit of area; exact.
    pub(crate) fn density(&self, p: DVec3) -> f64 {
        self.patches().density(self, p)
    }
}

/// What is known about an interval.
enum Look {
    /// No root.
    Empty,
    /// At most one.
    Monotone,
    Unknown,
}
