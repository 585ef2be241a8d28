//! What a ray meets, and the rays that leave from there.
//!
//! A point on a surface is known up to `p_error`. Rays leave from the point moved along the geometric normal by that
//! bound, to the side that they go to, so they neither meet the surface that they leave nor skip one behind it
//! (Pharr, Jakob and Humphreys 2023, section 6.8).

use glam::{DVec2, DVec3};

use arsc_geometry::Ray;

use crate::MaterialIndex;

/// Index of a part that a material is attached to: leaves of solids first, in order, then surfaces, then the leaves
/// of instances. A light that is geometry is named by its part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PartId(pub u32);

/// The nearest surface point along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub t: f64,
    /// On the surface: the ray's point at `t`, projected.
    pub p: DVec3,
    /// Bound on the distance between `p` and the true surface, in world units.
    pub p_error: f64,
    /// Unit geometric normal: out of the solid (flipped for the wall that a subtraction leaves), or a surface's own.
    pub ng: DVec3,
    /// Unit shading normal, on the side of `ng`.
    pub ns: DVec3,
    pub material: MaterialIndex,
    pub part: PartId,
    /// Number of the shape's face, or of the mesh's triangle.
    pub face: u32,
    /// The part is a leaf of a solid; otherwise an open surface.
    pub closed: bool,
}

/// Surface coordinates at a hit, found on demand by [`Scene::parametrize`](crate::Scene::parametrize).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parametrization {
    pub uv: DVec2,
    /// Direction of growing u on the surface, unit, orthogonal to the hit's `ng`.
    pub dpdu: DVec3,
}

/// A maximal stretch of a ray inside one solid. Rays may start inside: then `t_enter` is 0 and `enter` is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub t_enter: f64,
    /// At most the ray's `t_max`; infinite when the solid is.
    pub t_exit: f64,
    /// Index of the solid (instances after solids).
    pub solid: u32,
    pub enter: Option<Hit>,
    /// `None` when the interval does not end before `t_max`.
    pub exit: Option<Hit>,
}

/// A point chosen on a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaSample {
    pub p: DVec3,
    pub p_error: f64,
    /// As [`Hit::ng`].
    pub ng: DVec3,
    pub uv: DVec2,
    /// Density per unit of world area, over the whole part whether it is on the solid's boundary or not.
    pub pdf_area: f64,
    /// What the point shows.
    pub material: MaterialIndex,
}

impl Hit {
    /// The ray that leaves towards `wi` (unit).
    #[inline]
    pub fn spawn(&self, wi: DVec3) -> Ray {
        Ray::new(offset(self.p, self.p_error, self.ng, wi), wi)
    }

    /// The segment to a point that is on no surface (a point light): its `dir` is unit, `t_max` just short of it.
    /// `None` if the two coincide.
    #[inline]
    pub fn spawn_to(&self, target: DVec3) -> Option<Ray> {
        segment(offset(self.p, self.p_error, self.ng, target - self.p), target)
    }

    /// The segment to a chosen point, which ends before that point's surface. `None` if the two coincide.
    #[inline]
    pub fn spawn_to_sample(&self, target: &AreaSample) -> Option<Ray> {
        let from = offset(self.p, self.p_error, self.ng, target.p - self.p);
        segment(from, offset(target.p, target.p_error, target.ng, self.p - target.p))
    }
}

impl AreaSample {
    /// The segment from a point that is on no surface to this one, ending before its surface. `None` if the two coincide.
    #[inline]
    pub fn segment_from(&self, from: DVec3) -> Option<Ray> {
        segment(from, offset(self.p, self.p_error, self.ng, from - self.p))
    }
}

/// `p` moved off the surface to the side of `towards`.
#[inline]
fn offset(p: DVec3, p_error: f64, ng: DVec3, towards: DVec3) -> DVec3 {
    p + ng * (2.0 * p_error).copysign(towards.dot(ng))
}

#[inline]
fn segment(from: DVec3, to: DVec3) -> Option<Ray> {
    let length = (to - from).length();
    let dir = (to - from) / length;
    // The end is reached up to rounding; the surfaces there are beyond it by more than that.
    (length > 0.0 && dir.is_finite()).then_some(Ray { origin: from, dir, t_max: length * (1.0 - 4.0 * f64::EPSILON) })
}
