//! What a ray meets.

use glam::{DVec2, DVec3};

use crate::MaterialIndex;

/// Index of a part that a material is attached to: leaves of solids first, in order, then surfaces, then the leaves
/// of instances. A light that is geometry is named by its part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PartId(pub u32);

/// The nearest surface point along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    pub t: f64,
    pub p: DVec3,
    /// Bound on the distance between `p` and the true surface, in world units.
    pub p_error: f64,
    /// Unit geometric normal: out of the solid (flipped for the wall that a subtraction leaves), or a surface's own.
    pub ng: DVec3,
    /// Unit shading normal, on the side of `ng`.
    pub ns: DVec3,
    pub uv: DVec2,
    /// Direction of growing u on the surface, unit, orthogonal to `ng`.
    pub dpdu: DVec3,
    pub material: MaterialIndex,
    pub part: PartId,
    /// Number of the shape's face, or of the mesh's triangle.
    pub face: u32,
    /// The part is a leaf of a solid; otherwise an open surface.
    pub closed: bool,
}

/// A maximal stretch of a ray inside one solid. Rays may start inside: then `t_enter` is 0 and `enter` is `None`.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    pub t_enter: f64,
    pub t_exit: f64,
    /// Index of the solid (instances after solids).
    pub solid: u32,
    pub enter: Option<Hit>,
    /// `None` when the interval is unbounded.
    pub exit: Option<Hit>,
}
