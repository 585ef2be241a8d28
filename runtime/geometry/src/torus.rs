//! Torus about the z axis: ring (minor < major), horn (equal) and spindle (minor > major, lens included).
//!
//! A point at distance `ρ` from the axis is inside when `(ρ − major)² + z² <= minor²`. From the line's closest
//! approach to the centre the quartic `(|p|² + major² − minor²)² = 4 major² ρ²` is depressed. Its roots are bracketed by
//! those of its derivative and found by safeguarded Newton steps; both ends of the bracket sequence lie outside the
//! torus, so the number of roots is even whatever the rounding.

use std::f64::consts::{FRAC_PI_3, PI, TAU};

use glam::{DVec2, DVec3};

use crate::{Crossings, LocalPoint};

/// `t⁴ + p t² + q t + s`.
struct Quartic {
    p: f64,
    q: f64,
    s: f64,
}

impl Quartic {
    fn eval(&self, t: f64) -> f64 {
        ((t * t + self.p) * t + self.q) * t + self.s
    }

    fn derivative(&self, t: f64) -> f64 {
        (4.0 * t * t + 2.0 * self.p) * t + self.q
    }

    /// Real roots of the derivative, ascending.
    fn critical(&self) -> ([f64; 3], usize) {
        let (p, q) = (self.p / 2.0, self.q / 4.0);
        let (third, half) = (p / 3.0, q / 2.0);
        let discriminant = third * third * third + half * half;
        if discriminant >= 0.0 {
            let big = -(half.abs() + discriminant.sqrt()).cbrt().copysign(half);
            let root = if big == 0.0 { 0.0 } else { big - third / big };
            return ([root, 0.0, 0.0], 1);
        }
        let radius = (-third).sqrt();
        let angle = (-half / (radius * radius * radius)).clamp(-1.0, 1.0).acos() / 3.0;
        let at = |k: f64| 2.0 * radius * (angle - 2.0 * FRAC_PI_3 * k).cos();
        // cos(angle − 2π/3 k) for angle in [0, π/3]: k = 0 largest, k = −1 (that is +2π/3) smallest.
        ([at(-1.0), at(1.0), at(0.0)], 3)
    }

    /// The root between `a` and `b`, where the sign changes; `rising` when positive at `b`.
    fn root_between(&self, mut a: f64, mut b: f64, rising: bool) -> f64 {
        let mut t = 0.5 * (a + b);
        for _ in 0..64 {
            let value = self.eval(t);
            if (value > 0.0) == rising {
                b = t;
            } else {
                a = t;
            }
            let next = t - value / self.derivative(t);
            let next = if next > a && next < b { next } else { 0.5 * (a + b) };
            if (next - t).abs() <= 1e-15 * (1.0 + t.abs()) {
                return next;
            }
            t = next;
        }
        t
    }
}

/// `dir` is unit.
pub(crate) fn crossings(major: f64, minor: f64, origin: DVec3, dir: DVec3) -> Crossings {
    // Unit outer radius: the quartic's terms are then of order one.
    let scale = major + minor;
    let (major, minor) = (major / scale, minor / scale);
    let middle = -origin.dot(dir);
    let o = (origin + dir * middle) / scale;
    let m = o.length_squared();
    if m >= 1.0 {
        return Crossings::NONE;
    }
    let reach = (1.0 - m).sqrt();
    let (mut low, mut high) = (-reach, reach);
    if dir.z != 0.0 {
        let (a, b) = ((-minor - o.z) / dir.z, (minor - o.z) / dir.z);
        low = low.max(a.min(b));
        high = high.min(a.max(b));
    } else if o.z.abs() >= minor {
        return Crossings::NONE;
    }
    if low >= high {
        return Crossings::NONE;
    }
    let k = m + (major - minor) * (major + minor);
    let rr = 4.0 * major * major;
    let quartic =
        Quartic { p: 2.0 * k - rr * (1.0 - dir.z * dir.z), q: 2.0 * rr * o.z * dir.z, s: k * k - rr * (m - o.z * o.z) };
    let mut found = Crossings::NONE;
    let mut previous = (low, true);
    let (critical, count) = quartic.critical();
    for &t in critical[..count].iter().filter(|&&t| t > low && t < high).chain(std::iter::once(&high)) {
        let positive = t == high || quartic.eval(t) > 0.0;
        if positive != previous.1 {
            let root = polished(major, minor, o, dir, quartic.root_between(previous.0, t, positive));
            if k + root * root >= 0.0 {
                found.push(root, 0);
            }
        }
        previous = (t, positive);
    }
    if found.len() % 2 == 1 {
        // Rounding split a pair at a pole of a spindle: the line grazes it.
        return Crossings::NONE;
    }
    found.remapped(middle / scale, scale)
}

/// One Newton step on the distance to the tube, which is better conditioned than the quartic for thin tori.
fn polished(major: f64, minor: f64, o: DVec3, dir: DVec3, t: f64) -> f64 {
    let p = o + dir * t;
    let ring = p.truncate().length();
    let tube = (ring - major).hypot(p.z);
    if ring == 0.0 || tube == 0.0 {
        return t;
    }
    let slope = ((ring - major) * p.truncate().dot(dir.truncate()) / ring + p.z * dir.z) / tube;
    let step = (tube - minor) / slope;
    if slope.abs() > 1e-3 && step.abs() < 1e-7 { t - step } else { t }
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
