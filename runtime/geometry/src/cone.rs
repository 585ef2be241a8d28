//! Cylinders and (truncated) cones about the z axis. Faces: 0 side, 1 bottom (z = 0), 2 top.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::{Crossings, LocalPoint};

const SIDE: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

/// Where `0 <= z <= height`: entry and exit with their faces; unbounded for rays across, `None` outside.
fn slab(height: f64, origin: DVec3, dir: DVec3) -> Option<(f64, u32, f64, u32)> {
    if dir.z == 0.0 {
        return (0.0..=height).contains(&origin.z).then_some((f64::NEG_INFINITY, SIDE, f64::INFINITY, SIDE));
    }
    let (bottom, top) = (-origin.z / dir.z, (height - origin.z) / dir.z);
    Some(if dir.z > 0.0 { (bottom, BOTTOM, top, TOP) } else { (top, TOP, bottom, BOTTOM) })
}

/// Entry into and exit from the infinite cylinder; `None` when missed, infinite when inside and parallel.
fn infinite_side(radius: f64, origin: DVec3, dir: DVec3) -> Option<(f64, f64)> {
    let (o, d) = (origin.truncate(), dir.truncate());
    let dd = d.length_squared();
    if dd == 0.0 {
        return (o.length() <= radius).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let middle = -o.dot(d) / dd;
    let closest = (o.perp_dot(d) / dd.sqrt()).abs();
    if closest >= radius {
        return None;
    }
    let half = ((radius - closest) * (radius + closest) / dd).sqrt();
    Some((middle - half, middle + half))
}

pub(crate) fn infinite_cylinder_crossings(radius: f64, origin: DVec3, dir: DVec3) -> Crossings {
    match infinite_side(radius, origin, dir) {
        None => Crossings::NONE,
        Some((t0, t1)) if t0.is_finite() && t1.is_finite() => Crossings::interval(t0, SIDE, t1, SIDE),
        Some(_) => Crossings::ALWAYS_INSIDE,
    }
}

pub(crate) fn cylinder_crossings(radius: f64, height: f64, origin: DVec3, dir: DVec3) -> Crossings {
    let (Some(caps), Some(side)) = (slab(height, origin, dir), infinite_side(radius, origin, dir)) else {
        return Crossings::NONE;
    };
    intersect(caps, side)
}

/// The slab's interval cut by the side's.
fn intersect(caps: (f64, u32, f64, u32), side: (f64, f64)) -> Crossings {
    let (z0, f0, z1, f1) = caps;
    let (t0, f0) = if side.0 > z0 { (side.0, SIDE) } else { (z0, f0) };
    let (t1, f1) = if side.1 < z1 { (side.1, SIDE) } else { (z1, f1) };
    Crossings::interval(t0, f0, t1, f1)
}

/// The side is `x² + y² = r(z)²` with `r(z) = base + slope z`; between the caps `r >= 0`, so the mirrored nappe of
/// the double cone is cut off by the slab, and what is left is convex: one interval.
pub(crate) fn cone_crossings(base: f64, top: f64, height: f64, origin: DVec3, dir: DVec3) -> Crossings {
    let Some(caps) = slab(height, origin, dir) else { return Crossings::NONE };
    // From the point nearest to the middle of the cone nothing large is subtracted.
    let shift = (DVec3::new(0.0, 0.0, 0.5 * height) - origin).dot(dir);
    let o = origin + dir * shift;
    let slope = (top - base) / height;
    let (r, dr) = (base + slope * o.z, slope * dir.z);
    let a = dir.truncate().length_squared() - dr * dr;
    let half_b = o.truncate().dot(dir.truncate()) - r * dr;
    let c = (o.truncate().length() - r) * (o.truncate().length() + r);
    let (z0, z1) = (caps.0 - shift, caps.2 - shift);
    let Some((t0, t1)) = not_positive(a, half_b, c, z0, z1) else { return Crossings::NONE };
    intersect(caps, (t0 + shift, t1 + shift))
}

/// Where `a t² + 2 b t + c <= 0` between `z0` and `z1`, known to be one interval; ends may lie beyond the bounds.
fn not_positive(a: f64, b: f64, c: f64, z0: f64, z1: f64) -> Option<(f64, f64)> {
    let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
    let discriminant = b * b - a * c;
    if discriminant <= 0.0 {
        // No sign change: the double cone is missed, or (a < 0) the line stays within.
        return (a < 0.0 || (a == 0.0 && c <= 0.0)).then_some(everywhere);
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    if a == 0.0 {
        let root = c / q;
        return Some(if b > 0.0 { (f64::NEG_INFINITY, root) } else { (root, f64::INFINITY) });
    }
    let (r0, r1) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    let (low, high) = if r0 < r1 { (r0, r1) } else { (r1, r0) };
    if a > 0.0 {
        return Some((low, high));
    }
    // One nappe before `low`, the other after `high`; the slab holds only one of them.
    let (before, after) = (low.min(z1) - z0, z1 - high.max(z0));
    Some(if before > after { (f64::NEG_INFINITY, low) } else { (high, f64::INFINITY) })
}

/// Also serves cylinders (`base == top`); `height` may be infinite then.
pub(crate) fn surface(base: f64, top: f64, height: f64, p: DVec3, face: u32) -> LocalPoint {
    let azimuth = p.y.atan2(p.x);
    let (sin, cos) = azimuth.sin_cos();
    if face != SIDE {
        let high = face == TOP;
        let (z, n) = if high { (height, DVec3::Z) } else { (0.0, DVec3::NEG_Z) };
        let radius = if high { top } else { base };
        let uv = DVec2::new(0.5 + 0.5 * p.x / radius, 0.5 + 0.5 * p.y / radius);
        return LocalPoint { p: DVec3::new(p.x, p.y, z), n, uv, dpdu: DVec3::X };
    }
    let slope = if height.is_finite() { (top - base) / height } else { 0.0 };
    let n = DVec3::new(cos, sin, -slope).normalize();
    // Along the normal's meridian direction onto the side, not radially: a flat cone stays accurate.
    let out = (p.truncate().length() - (base + slope * p.z)) / (1.0 + slope * slope);
    let z = p.z + slope * out;
    let z = if height.is_finite() { z.clamp(0.0, height) } else { z };
    let radius = base + slope * z;
    let v = if height.is_finite() { z / height } else { z };
    let uv = DVec2::new(azimuth.rem_euclid(TAU) / TAU, v);
    LocalPoint { p: DVec3::new(radius * cos, radius * sin, z), n, uv, dpdu: DVec3::new(-sin, cos, 0.0) }
}

/// Areas of side, bottom and top.
pub(crate) fn areas(base: f64, top: f64, height: f64) -> [f64; 3] {
    let pi = std::f64::consts::PI;
    [pi * (base + top) * (base - top).hypot(height), pi * base * base, pi * top * top]
}

pub(crate) fn sample(base: f64, top: f64, height: f64, face: u32, u: [f64; 2]) -> DVec3 {
    let (sin, cos) = (TAU * u[0]).sin_cos();
    let (radius, z) = match face {
        BOTTOM => (base * u[1].sqrt(), 0.0),
        TOP => (top * u[1].sqrt(), height),
        _ => {
            // The density along the slant grows as the radius: its square is uniform.
            let radius = (base * base + u[1] * (top * top - base * base)).max(0.0).sqrt();
            let along = if radius + base > 0.0 { u[1] * (top + base) / (radius + base) } else { 0.0 };
            (radius, height * along.clamp(0.0, 1.0))
        }
    };
    DVec3::new(radius * cos, radius * sin, z)
}
