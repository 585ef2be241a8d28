//! Axis-aligned box. Faces: 0 −x, 1 +x, 2 −y, 3 +y, 4 −z, 5 +z.

use glam::{DVec2, DVec3};

use crate::{Crossings, LocalPoint, Span};

pub(crate) fn crossings(min: DVec3, max: DVec3, origin: DVec3, dir: DVec3) -> Crossings {
    Span::of_box(min, max, origin, dir.recip()).into()
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
