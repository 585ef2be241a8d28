//! Points and frames through the map of an instance.

use glam::{DAffine3, DVec3};

use arsc_geometry::{Foot, SurfacePoint, invert};

/// An invertible placement, with what it does to errors.
#[derive(Clone, Debug)]
pub struct Frame {
    pub world_from_object: DAffine3,
    pub object_from_world: DAffine3,
    /// Bounds how much a length grows.
    stretch: f64,
}

impl Frame {
    /// `None` without a finite inverse.
    pub fn new(world_from_object: DAffine3) -> Option<Frame> {
        let object_from_world = invert(&world_from_object)?;
        let m = world_from_object.matrix3;
        let stretch = (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt();
        Some(Frame { world_from_object, object_from_world, stretch })
    }

    /// A surface point, from the object's frame to the world's.
    pub fn to_world(&self, local: &Foot) -> Foot {
        let p = self.world_from_object.transform_point3(local.p);
        let n = self.object_from_world.matrix3.transpose().mul_vec3(local.n).normalize();
        // Both maps are applied to points on the way: to the object and back.
        let here = p.abs().max_element() + self.world_from_object.translation.abs().max_element();
        let rounding = 32.0 * f64::EPSILON * (here + self.stretch * local.p.abs().max_element());
        Foot { p, p_error: local.p_error * self.stretch + rounding, n }
    }

    /// The direction of growing u at a point whose world normal is `n`: unit, tangent.
    pub fn tangent_to_world(&self, local: &SurfacePoint, n: DVec3) -> DVec3 {
        let dpdu = self.world_from_object.transform_vector3(local.dpdu);
        (dpdu - n * n.dot(dpdu)).try_normalize().unwrap_or_else(|| n.any_orthonormal_vector())
    }
}
