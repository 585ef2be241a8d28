//! Scene geometry, traced.
//!
//! In goes a [`SceneGeometry`]: solids as Boolean trees over placed shapes, surfaces, instances. Out comes a
//! [`Scene`] that answers: the nearest hit, occlusion, and all intervals along a ray. Positions and distances
//! are double precision and carry error bounds; there is no fixed epsilon. Materials are opaque numbers here.

mod budget;
mod cells;
mod coincidence;
mod counted;
mod error;
mod expression;
mod faces;
mod facets;
mod frame;
mod geometry;
mod hit;
mod level;
mod nearest;
mod query;
mod scene;
mod solid;
mod strategies;
mod surfaces;
mod transition;
mod world;

use expression::Expression;

pub use arsc_geometry::{Aabb, Ray, Shape, TriangleMesh};
pub use budget::Budget;
pub use error::AccelError;
pub use geometry::{
    Csg, CsgLeaf, FaceMaterial, Instance, MaterialIndex, SceneGeometry, Solid, Strategy, Surface, SurfaceShape,
};
pub use hit::{AreaSample, Hit, Interval, Parametrization, PartId};
pub use scene::{BuildOptions, BuildStats, Part, PartKind, Scene};
