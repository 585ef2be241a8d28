//! The surface point nearest to a point beside it, with the normal alone: what every hit needs.
//!
//! [`Placed::surface`] gives the same point with uv and their direction, which cost several times as much (angles from
//! arc functions) and few materials ask for. The usual shapes have a short way here; error bounds are the same.

use glam::DVec3;

use crate::{Direct, Placed, Shape, SurfacePoint};

/// A surface point, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    pub p: DVec3,
    /// Bound on the distance between `p` and the true surface.
    pub p_error: f64,
    /// Outward unit normal.
    pub n: DVec3,
}

impl From<SurfacePoint> for Foot {
    fn from(point: SurfacePoint) -> Foot {
        Foot { p: point.p, p_error: point.p_error, n: point.n }
    }
}

impl Placed {
    /// The surface point at `p`, which lies on that face up to rounding: projected onto it.
    pub fn foot(&self, p: DVec3, face: u32) -> Foot {
        if let Some((p, n)) = self.direct().and_then(|direct| direct_foot(direct, p, face)) {
            return Foot { p, p_error: self.error_at(p), n };
        }
        let Some((p, n)) = local_foot(self.shape(), self.object_from_world().transform_point3(p), face) else {
            return self.surface(p, face).into();
        };
        let p = self.world_from_object().transform_point3(p);
        Foot { p, p_error: self.error_at(p), n: self.world_normal(n) }
    }
}

fn direct_foot(direct: &Direct, p: DVec3, face: u32) -> Option<(DVec3, DVec3)> {
    match *direct {
        Direct::Ball { center, radius } => {
            let n = (p - center).try_normalize()?;
            Some((center + n * radius, n))
        }
        Direct::Box { min, max } => {
            let axis = face as usize / 2;
            let mut on = p.clamp(min, max);
            let mut n = DVec3::ZERO;
            (on[axis], n[axis]) = if face % 2 == 1 { (max[axis], 1.0) } else { (min[axis], -1.0) };
            Some((on, n))
        }
        Direct::HalfSpace { .. } => None,
    }
}

/// Point and normal in object space. `None` where the general way must do: on axes, and for other shapes.
fn local_foot(shape: &Shape, p: DVec3, face: u32) -> Option<(DVec3, DVec3)> {
    match *shape {
        Shape::Cylinder { radius, height } => match face {
            0 => {
                let n = p.truncate().try_normalize()?;
                Some(((n * radius).extend(p.z.clamp(0.0, height)), n.extend(0.0)))
            }
            1 => Some((p.truncate().extend(0.0), DVec3::NEG_Z)),
            _ => Some((p.truncate().extend(height), DVec3::Z)),
        },
        Shape::Torus { major, minor } => {
            let ring = p.truncate().try_normalize()? * major;
            let n = (p - ring.extend(0.0)).try_normalize()?;
            Some((ring.extend(0.0) + n * minor, n))
        }
        _ => None,
    }
}
