//! Torus about the z axis: ring (minor < major), horn (equal) and spindle (minor > major, lens included).
//!
//! A point at distance `ρ` from the axis is inside when `(ρ − major)² + z² <= minor²`. From the line's closest
//! approach to the centre the quartic `(|p|² + major² − minor²)² = 4 major² ρ²` is depressed, so its points of inflection are
//! symmetric and known. Between them, and between the ends of the line's stretch in the torus's bounding sphere and slab, where
//! it is positive, the curvature has one sign: each piece holds no root, one that brackets itself, or a pair about its
//! extremum. Signs at the ends of pieces are decided once, so the number of roots is even whatever the rounding.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::{Crossings, LocalPoint};

/// Most Newton steps for a root or an extremum; every step that leaves its bracket is a bisection instead.
const STEPS: usize = 64;
/// Relative to the torus's outer radius: brackets and errors below this are rounding.
const ROUNDING: f64 = 1e-15;

/// `t⁴ + p t² + q t + s`, positive outside of the torus.
struct Quartic {
    p: f64,
    q: f64,
    s: f64,
}

impl Quartic {
    fn eval(&self, t: f64) -> f64 {
        ((t * t + self.p) * t + self.q) * t + self.s
    }

    fn slope(&self, t: f64) -> f64 {
        (4.0 * t * t + 2.0 * self.p) * t + self.q
    }

    fn curvature(&self, t: f64) -> f64 {
        12.0 * t * t + 2.0 * self.p
    }

    /// Where the tangent at `t` is zero.
    fn newton(&self, t: f64) -> f64 {
        t - self.eval(t) / self.slope(t)
    }

    /// The only root between `a` and `b`, sought from `t` on; `rising` when the value is positive at `b`.
    fn root(&self, mut a: f64, mut b: f64, rising: bool, mut t: f64) -> f64 {
        if !(t > a && t < b) {
            t = 0.5 * (a + b);
        }
        for _ in 0..STEPS {
            let (value, slope) = (self.eval(t), self.slope(t));
            if (value > 0.0) == rising {
                b = t;
            } else {
                a = t;
            }
            let step = value / slope;
            let next = t - step;
            if !(next > a && next < b) {
                t = 0.5 * (a + b);
                if b - a <= ROUNDING {
                    break;
                }
                continue;
            }
            // What a Newton step leaves of an error is its square times half of this ratio.
            let rest = step * step * self.curvature(t);
            t = next;
            if rest.abs() <= ROUNDING * slope.abs() {
                break;
            }
        }
        t
    }

    /// The two roots, if there are any, between `a` and `b`, where the curvature has the sign `bend` and so has the value at
    /// both ends.
    fn pair(&self, a: f64, b: f64, bend: f64, found: &mut impl FnMut(f64)) {
        let (mut low, mut high) = (a, b);
        let (fall, rise) = (bend * self.slope(a), bend * self.slope(b));
        if fall >= 0.0 || rise <= 0.0 {
            return;
        }
        let mut t = a + (b - a) * fall / (fall - rise);
        for _ in 0..STEPS {
            let (value, slope, curvature) = (bend * self.eval(t), bend * self.slope(t), bend * self.curvature(t));
            if value < 0.0 {
                // On either side, from where the parabola through here is zero.
                let spread = (slope * slope - 2.0 * value * curvature).max(0.0).sqrt();
                found(self.root(a, t, bend < 0.0, t - (slope + spread) / curvature));
                found(self.root(t, b, bend > 0.0, t - (slope - spread) / curvature));
                return;
            }
            // The extremum is on the side that the tangent falls to. Where the tangent stays above zero so does the curve.
            let end = if slope > 0.0 { low } else { high };
            if value + slope * (end - t) > 0.0 || high - low <= ROUNDING {
                return;
            }
            if slope > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let next = t - slope / curvature;
            t = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
    }

    /// All roots in `(low, high)`, ascending; the value counts as positive at `high`, and at `low` if `outside`.
    fn roots(&self, low: f64, high: f64, mut outside: bool, found: &mut impl FnMut(f64)) {
        if self.p >= 0.0 {
            if outside {
                return self.pair(low, high, 1.0, found);
            }
            return found(self.root(low, high, true, self.newton(high)));
        }
        let inflection = (self.p * (-1.0 / 6.0)).sqrt();
        let mut start = low;
        for (end, bend) in [(-inflection, 1.0), (inflection, -1.0), (high, 1.0)] {
            if end <= start {
                continue;
            }
            let last = end >= high;
            let end = end.min(high);
            let positive = last || self.eval(end) > 0.0;
            if positive != outside {
                // On outer pieces from the point of inflection: the first step already leads beyond the root, to the side from
                // which Newton's method does not overshoot.
                let from = match bend < 0.0 {
                    true => 0.5 * (start + end),
                    false if positive => start,
                    false => end,
                };
                found(self.root(start, end, positive, self.newton(from)));
            } else if positive == (bend > 0.0) {
                self.pair(start, end, bend, found);
            }
            (start, outside) = (end, positive);
            if last {
                return;
            }
        }
    }
}

/// `dir` is unit. Error bound: [`crate::Shape::crossings`].
pub(crate) fn crossings(major: f64, minor: f64, origin: DVec3, dir: DVec3) -> Crossings {
    // Unit outer radius: the quartic's terms are then of order one.
    let scale = major + minor;
    let unit = 1.0 / scale;
    let (major, minor) = (major * unit, minor * unit);
    let middle = -origin.dot(dir);
    let o = (origin + dir * middle) * unit;
    let m = o.length_squared();
    if m >= 1.0 {
        return Crossings::NONE;
    }
    let reach = (1.0 - m).sqrt();
    let (mut low, mut high) = (-reach, reach);
    if dir.z != 0.0 {
        let inverse = 1.0 / dir.z;
        let (a, b) = ((-minor - o.z) * inverse, (minor - o.z) * inverse);
        low = low.max(a.min(b));
        high = high.min(a.max(b));
    } else if o.z.abs() >= minor {
        return Crossings::NONE;
    }
    if low >= high {
        return Crossings::NONE;
    }
    // Squared distance from the axis: a + 2 b t + c t².
    let (a, b, c) = (m - o.z * o.z, -o.z * dir.z, 1.0 - dir.z * dir.z);
    let ring = |t: f64| (c * t + 2.0 * b) * t + a;
    let hole = major - minor;
    if hole > 0.0 && ring(low).max(ring(high)) <= hole * hole {
        return Crossings::NONE;
    }
    let k = m + hole;
    let rr = 4.0 * major * major;
    let quartic = Quartic { p: 2.0 * k - rr * c, q: -2.0 * rr * b, s: k * k - rr * a };
    let mut found = Crossings::NONE;
    let mut last = low;
    // Polishing must not swap the two roots of a line that grazes.
    let mut push = |t: f64| {
        last = polished(major, minor, o, dir, t).max(last);
        found.push(last, 0);
    };
    if k < 0.0 {
        spindle_roots(&quartic, low, high, (-k).sqrt(), &mut push);
    } else {
        quartic.roots(low, high, true, &mut push);
    }
    found.remapped(middle * unit, scale)
}

/// Roots of a line that passes between the poles of a spindle. Within `lens` of the closest approach it is inside, where
/// the quartic is zero on the inner side of the surface too; at the ends of that stretch the quartic is negative, but for
/// lines through a pole, where it has a double root and no sign.
fn spindle_roots(quartic: &Quartic, low: f64, high: f64, lens: f64, found: &mut impl FnMut(f64)) {
    let mirrored = Quartic { q: -quartic.q, ..*quartic };
    let mut before = [0.0; 3];
    let mut count = 0;
    mirrored.roots(lens.min(-low), -low, false, &mut |t| {
        before[count] = t;
        count += 1;
    });
    before[..count].iter().rev().for_each(|t| found(-t));
    quartic.roots(lens.min(high), high, false, found);
}

/// Newton steps on the distance to the tube, which is better conditioned than the quartic: for thin tori, and near the poles
/// of a spindle, where the quartic's roots are double.
fn polished(major: f64, minor: f64, o: DVec3, dir: DVec3, mut t: f64) -> f64 {
    let steps = if minor > major { 3 } else { 1 };
    for _ in 0..steps {
        let p = o + dir * t;
        let ring = p.truncate().length();
        let out = ring - major;
        let excess = out * out + p.z * p.z - minor * minor;
        let outwards = if ring > 0.0 { p.truncate().dot(dir.truncate()) / ring } else { 0.0 };
        let slope = 2.0 * (out * outwards + p.z * dir.z);
        let step = excess / slope;
        // Not where the line grazes the tube.
        if slope.abs() > 2e-3 * minor && step.abs() < 1e-7 {
            t -= step;
        }
    }
    t
}

/// Whether the ball of this radius about `p` is inside or outside; `None` where the surface may be in it (or within a
/// spindle's lens).
#[inline]
pub(crate) fn state_around(major: f64, minor: f64, p: DVec3, radius: f64) -> Option<bool> {
    let out = p.truncate().length() - major;
    let square = out * out + p.z * p.z;
    let (outer, inner) = (minor + radius, minor - radius);
    if square > outer * outer {
        Some(false)
    } else if inner > 0.0 && square < inner * inner {
        Some(true)
    } else {
        None
    }
}

/// u is the azimuth, v the angle around the tube from the outer equator, both over [0, 1].
pub(crate) fn surface(major: f64, minor: f64, p: DVec3) -> LocalPoint {
    let azimuth = p.y.atan2(p.x);
    let (sin, cos) = azimuth.sin_cos();
    let (out, up) = (p.truncate().length() - major, p.z);
    let around = up.atan2(out);
    let (up, out) = around.sin_cos();
    let n = DVec3::new(out * cos, out * sin, up);
    let on = DVec3::new((major + minor * out) * cos, (major + minor * out) * sin, minor * up);
    let uv = DVec2::new(azimuth.rem_euclid(TAU) / TAU, around.rem_euclid(TAU) / TAU);
    LocalPoint { p: on, n, uv, dpdu: DVec3::new(-sin, cos, 0.0) }
}

/// Largest tube angle on the outer surface: beyond it a spindle's surface lies within the lens.
fn tube_limit(major: f64, minor: f64) -> f64 {
    if minor > major { (-major / minor).acos() } else { PI }
}

/// Area of the outer surface.
pub(crate) fn area(major: f64, minor: f64) -> f64 {
    let limit = tube_limit(major, minor);
    2.0 * TAU * minor * (major * limit + minor * limit.sin())
}

pub(crate) fn sample(major: f64, minor: f64, u: [f64; 2]) -> DVec3 {
    // Distribution of the tube angle: major a + minor sin a, monotone up to the limit; solved by safeguarded Newton.
    let limit = tube_limit(major, minor);
    let total = major * limit + minor * limit.sin();
    let wanted = (2.0 * u[1] - 1.0) * total;
    let (mut low, mut high) = (-limit, limit);
    let mut a = wanted / total * limit;
    for _ in 0..60 {
        let excess = major * a + minor * a.sin() - wanted;
        if excess > 0.0 {
            high = a;
        } else {
            low = a;
        }
        let next = a - excess / (major + minor * a.cos());
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - a).abs() < 1e-15 {
            break;
        }
        a = next;
    }
    let (sin, cos) = (TAU * u[0]).sin_cos();
    let (up, out) = a.sin_cos();
    DVec3::new((major + minor * out) * cos, (major + minor * out) * sin, minor * up)
}
