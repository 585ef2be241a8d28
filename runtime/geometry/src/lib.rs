//! Shapes in double precision: intersection, membership, bounds, classification, area.
//!
//! Pure mathematics without Embree, so that the compiler's geometric passes and lints use the same shapes as
//! the renderer. Conventions: right-handed, z up; lengths in scene units (one unit is one metre); `dir` of a ray
//! is a unit vector in the world and arbitrary after a transform to object space; normals point out of the solid.

mod aabb;
mod ray;
mod shape;

pub use aabb::Aabb;
pub use glam::{DAffine3, DMat3, DVec2, DVec3};
pub use ray::Ray;
pub use shape::Shape;
