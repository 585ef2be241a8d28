//! Axis-aligned box. Faces: 0 −x, 1 +x, 2 −y, 3 +y, 4 −z, 5 +z.

use glam::{DVec2, DVec3};

use crate::{Crossings, LocalPoint};

pub(crate) fn crossings(min: DVec3, max: DVec3, origin: DVec3, dir: DVec3) -> Crossings {
    let (mut t0, mut f0) = (f64::NEG_INFINITY, 0);
    let (mut t1, mut f1) = (f64::INFINITY, 0);
    for axis in 0..3 {
        let (o, d) = (origin[axis], dir[axis]);
        if d == 0.0 {
            if o < min[axis] || o > max[axis] {
                return Crossings::NONE;
            }
            continue;
        }
        let face = 2 * axis as u32;
        let (low, high) = ((min[axis] - o) / d, (max[axis] - o) / d);
        let (near, far) = if d > 0.0 { ((low, face), (high, face + 1)) } else { ((high, face + 1), (low, face)) };
        if near.0 > t0 {
            (t0, f0) = near;
        }
        if far.0 < t1 {
            (t1, f1) = far;
        }
    }
    Crossings::interval(t0, f0, t1, f1)
}

pub(crate) fn surface(min: DVec3, max: DVec3, p: DVec3, face: u32) -> LocalPoint {
    let axis = (face / 2) as usize;
    let (u_axis, v_axis) = ((axis + 1) % 3, (axis + 2) % 3);
    let high = face % 2 == 1;
    let mut on = p.clamp(min, max);
    on[axis] = if high { max[axis] } else { min[axis] };
    let extent = max - min;
    let relative = (on - min) / extent;
    let mut n = DVec3::ZERO;
    n[axis] = if high { 1.0 } else { -1.0 };
    let mut dpdu = DVec3::ZERO;
    dpdu[u_axis] = extent[u_axis];
    LocalPoint { p: on, n, uv: DVec2::new(relative[u_axis], relative[v_axis]), dpdu }
}

/// Areas of the faces, in order.
pub(crate) fn areas(min: DVec3, max: DVec3) -> [f64; 6] {
    let e = max - min;
    let (x, y, z) = (e.y * e.z, e.z * e.x, e.x * e.y);
    [x, x, y, y, z, z]
}

pub(crate) fn sample(min: DVec3, max: DVec3, face: u32, u: [f64; 2]) -> DVec3 {
    let axis = (face / 2) as usize;
    let mut p = min;
    p[(axis + 1) % 3] += u[0] * (max - min)[(axis + 1) % 3];
    p[(axis + 2) % 3] += u[1] * (max - min)[(axis + 2) % 3];
    if face % 2 == 1 {
        p[axis] = max[axis];
    }
    p
}
