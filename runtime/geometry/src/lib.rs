//! Shapes in double precision: intersection, membership, bounds, classification, area.
//!
//! Pure mathematics without Embree, so that the compiler's geometric passes and lints use the same shapes as
//! the renderer. Conventions: right-handed, z up; lengths in scene units (one unit is one metre); `dir` of a ray
//! is a unit vector in the world and arbitrary after a transform to object space; normals point out of the solid.
//!
//! [`Shape`] is a solid in object space, [`Placed`] one under an affine map with everything that a tracer or a lint asks:
//! crossings with a line, membership, bounds, [`Classification`] of a box, surface frames and area sampling.

mod aabb;
mod area;
mod area_table;
mod box_tree;
mod classify;
mod closed_mesh;
mod cone;
mod crossings;
mod cuboid;
mod foot;
mod half_space;
mod hull;
mod hyperboloid;
mod lathe;
mod paraboloid;
mod placed;
mod polygon;
mod polyhedron;
mod prism;
mod profile;
mod quadratic;
mod ray;
mod region;
mod revolved;
mod shape;
mod span;
mod sphere;
mod superquadric;
mod superquadric_area;
mod torus;
mod triangle_mesh;

pub use aabb::Aabb;
pub use area::AreaPoint;
pub use classify::Classification;
pub use closed_mesh::{ClosedMesh, ClosedMeshError, MeshRepairs, Passage, Projection};
pub use crossings::Crossings;
pub use foot::Foot;
pub use glam::{DAffine3, DMat3, DVec2, DVec3};
pub use hull::{HullError, MOST_POINTS};
pub use hyperboloid::Hyperboloid;
pub use lathe::Lathe;
pub use paraboloid::Paraboloid;
pub use placed::{Direct, PlaceError, Placed, SurfacePoint, invert};
pub use polygon::{Corner, MOST_CORNERS, Polygon, PolygonError};
pub use polyhedron::Polyhedron;
pub use prism::Prism;
pub use profile::{MOST_PROFILE_POINTS, ProfileError};
pub use ray::Ray;
pub use shape::{LocalPoint, Shape};
pub use span::{Span, oblique_face, oblique_span};
pub use superquadric::{EXPONENTS, Superquadric};
pub use triangle_mesh::{TriangleMesh, TrianglePoint};
