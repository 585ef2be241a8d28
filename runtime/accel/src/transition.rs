//! Where a ray goes into a solid or out of it.

/// A point where a ray crosses the boundary of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    /// Parameter of the [`SolidRay`].
    pub t: f64,
    pub leaf: u32,
    pub face: u32,
    /// The ray is in the solid after it.
    pub entering: bool,
    /// The leaf's outward normal points into the solid: the wall of a subtraction.
    pub flipped: bool,
    /// The leaf is one of several with coincident faces here.
    pub shared: bool,
}
