//! Rays.

use glam::{DAffine3, DVec3};

/// A ray `origin + t dir`, `0 <= t <= t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: DVec3,
    /// Unit length in the world.
    pub dir: DVec3,
    pub t_max: f64,
}

impl Ray {
    #[inline]
    pub fn new(origin: DVec3, dir: DVec3) -> Ray {
        Ray { origin, dir, t_max: f64::INFINITY }
    }

    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.dir * t
    }

    /// The same ray in another frame; `t` keeps its meaning because the direction is not normalised.
    #[inline]
    pub fn transformed(&self, map: &DAffine3) -> Ray {
        Ray { origin: map.transform_point3(self.origin), dir: map.transform_vector3(self.dir), t_max: self.t_max }
    }
}
