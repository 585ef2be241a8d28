//! The solid shapes in their canonical placement.

use glam::DVec3;

/// A closed solid in object space. Sizes are positive and finite; the compiler guarantees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Centre at the origin.
    Sphere { radius: f64 },
    /// Axis-aligned, `min < max` in every axis.
    Box { min: DVec3, max: DVec3 },
    /// About the z axis, from z = 0 to z = `height`.
    Cylinder { radius: f64, height: f64 },
    /// About the z axis, unbounded.
    InfiniteCylinder { radius: f64 },
    /// About the z axis, radius `base_radius` at z = 0 and `top_radius` at z = `height`; at most one is zero.
    Cone { base_radius: f64, top_radius: f64, height: f64 },
    /// About the z axis, centre circle of radius `major` in the plane z = 0, tube radius `minor`
    /// (ring, horn and spindle; a spindle torus is the union, its lens included).
    Torus { major: f64, minor: f64 },
    /// z <= 0.
    HalfSpace,
}
