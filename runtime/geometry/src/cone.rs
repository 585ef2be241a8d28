//! Cylinders and (truncated) cones about the z axis. Faces: 0 side, 1 bottom (z = 0), 2 top.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::quadratic::{Inside, not_positive};
use crate::{Crossings, LocalPoint};

pub(crate) const SIDE: u32 = 0;
pub(crate) const BOTTOM: u32 = 1;
pub(crate) const TOP: u32 = 2;

/// Where `low <= z <= high`: entry and exit with their faces; unbounded for rays across, `None` outside.
pub(crate) fn slab(low: f64, high: f64, origin: DVec3, dir: DVec3) -> Option<(f64, u32, f64, u32)> {
    if dir.z == 0.0 {
        return (low..=high).contains(&origin.z).then_some((f64::NEG_INFINITY, SIDE, f64::INFINITY, SIDE));
    }
    let (bottom, top) = ((low - origin.z) / dir.z, (high - origin.z) / dir.z);
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
    let (Some(caps), Some(side)) = (slab(0.0, height, origin, dir), infinite_side(radius, origin, dir)) else {
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
    let Some(caps) = slab(0.0, height, origin, dir) else { return Crossings::NONE };
    // From the point nearest to the tip nothing large is subtracted, and lines through the tip keep their double root there;
    // a tip that is cut off and far away is replaced by the middle.
    let slope = (top - base) / height;
    let tip = if top == 0.0 { height } else { -base / slope };
    let (z, radius) = if (tip / height - 0.5).abs() < 4.0 { (tip, 0.0) } else { (0.5 * height, 0.5 * (base + top)) };
    let center = DVec3::new(0.0, 0.0, z);
    let shift = (center - origin).dot(dir);
    let o = (origin - center) + dir * shift;
    let (r, dr) = (radius + slope * o.z, slope * dir.z);
    let a = dir.truncate().length_squared() - dr * dr;
    let half_b = o.truncate().dot(dir.truncate()) - r * dr;
    let c = (o.truncate().length() - r) * (o.truncate().length() + r);
    let (z0, z1) = (caps.0 - shift, caps.2 - shift);
    let Some((t0, t1)) = one_interval(a, half_b, c, z0, z1) else { return Crossings::NONE };
    intersect(caps, (t0 + shift, t1 + shift))
}

/// Where the quadratic is not positive between `z0` and `z1`, known to be one interval; ends may lie beyond the bounds.
fn one_interval(a: f64, half_b: f64, c: f64, z0: f64, z1: f64) -> Option<(f64, f64)> {
    match not_positive(a, half_b, c) {
        Inside::Never => None,
        Inside::Always => Some((f64::NEG_INFINITY, f64::INFINITY)),
        Inside::Between(low, high) => Some((low, high)),
        Inside::Beyond(low, high) => {
            // One nappe before `low`, the other after `high`; the slab holds only one of them.
            let (before, after) = (low.min(z1) - z0, z1 - high.max(z0));
            Some(if before > after { (f64::NEG_INFINITY, low) } else { (high, f64::INFINITY) })
        }
    }
}

/// Also serves cylinders (`base == top`); `height` may be infinite then.
pub(crate) fn surface(base: f64, top: f64, height: f64, p: DVec3, face: u32) -> LocalPoint {
    let azimuth = p.y.atan2(p.x);
    let (sin, cos) = azimuth.sin_cos();
    if face != SIDE {
        return if face == TOP { disk_surface(top, height, 1.0, p) } else { disk_surface(base, 0.0, -1.0, p) };
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

/// The end face at a height, its normal along z times `sign`; u and v over the square about the disk.
pub(crate) fn disk_surface(radius: f64, z: f64, sign: f64, p: DVec3) -> LocalPoint {
    let uv = DVec2::new(0.5 + 0.5 * p.x / radius, 0.5 + 0.5 * p.y / radius);
    LocalPoint { p: DVec3::new(p.x, p.y, z), n: DVec3::Z * sign, uv, dpdu: DVec3::X }
}

/// Uniform over the disk at a height.
pub(crate) fn disk_point(radius: f64, z: f64, u: [f64; 2]) -> DVec3 {
    let (sin, cos) = (TAU * u[0]).sin_cos();
    let rho = radius * u[1].sqrt();
    DVec3::new(rho * cos, rho * sin, z)
}

/// Areas of side, bottom and top.
pub(crate) fn areas(base: f64, top: f64, height: f64) -> [f64; 3] {
    let pi = std::f64::consts::PI;
    [pi * (base + top) * (base - top).hypot(height), pi * base * base, pi * top * top]
}

pub(crate) fn sample(base: f64, top: f64, height: f64, face: u32, u: [f64; 2]) -> DVec3 {
    match face {
        BOTTOM => disk_point(base, 0.0, u),
        TOP => disk_point(top, height, u),
        _ => {
            let (along, radius) = frustum_sample(base, top, u[1]);
            let (sin, cos) = (TAU * u[0]).sin_cos();
            DVec3::new(radius * cos, radius * sin, height * along)
        }
    }
}

/// Uniform along the slant of a frustum by area: the fraction of the slant, and the radius there. The density grows as
/// the radius, so that its square is uniform.
pub(crate) fn frustum_sample(base: f64, top: f64, u: f64) -> (f64, f64) {
    let radius = (base * base + u * (top * top - base * base)).max(0.0).sqrt();
    let along = if radius + base > 0.0 { u * (top + base) / (radius + base) } else { 0.0 };
    (along.clamp(0.0, 1.0), radius)
}
