//! Half-space z <= 0.

use glam::{DVec2, DVec3};

use crate::{Crossings, LocalPoint};

pub(crate) fn crossings(origin: DVec3, dir: DVec3) -> Crossings {
    if dir.z == 0.0 {
        return if origin.z <= 0.0 { Crossings::ALWAYS_INSIDE } else { Crossings::NONE };
    }
    let t = -origin.z / dir.z;
    if t.is_finite() {
        Crossings::single(t, dir.z > 0.0)
    } else if origin.z <= 0.0 {
        Crossings::ALWAYS_INSIDE
    } else {
        Crossings::NONE
    }
}

/// u and v are x and y.
pub(crate) fn surface(p: DVec3) -> LocalPoint {
    LocalPoint { p: DVec3::new(p.x, p.y, 0.0), n: DVec3::Z, uv: DVec2::new(p.x, p.y), dpdu: DVec3::X }
}
