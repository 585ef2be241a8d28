//! Sphere about the origin.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::{Crossings, LocalPoint, Span};

/// `dir` of any length.
pub(crate) fn crossings(radius: f64, origin: DVec3, dir: DVec3) -> Crossings {
    Span::of_ball(DVec3::ZERO, radius, origin, dir, 1.0 / dir.length_squared()).into()
}

/// u is the azimuth, v the colatitude from the south pole, both over [0, 1].
pub(crate) fn surface(radius: f64, p: DVec3) -> LocalPoint {
    let n = p.try_normalize().unwrap_or(DVec3::Z);
    let uv = DVec2::new(n.y.atan2(n.x).rem_euclid(TAU) / TAU, 1.0 - n.z.clamp(-1.0, 1.0).acos() / PI);
    LocalPoint { p: n * radius, n, uv, dpdu: DVec3::new(-n.y, n.x, 0.0) }
}

pub(crate) fn sample(radius: f64, u: [f64; 2]) -> DVec3 {
    let z = 1.0 - 2.0 * u[0];
    let (sin, cos) = (TAU * u[1]).sin_cos();
    let ring = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(ring * cos, ring * sin, z) * radius
}
