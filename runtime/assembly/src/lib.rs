//! From the IR to a picture: the one place that turns IR into runtime objects, and the action sequence.
//!
//! In goes an IR in the normal form that `arsc-opt` documents; everything else (spans, parameters, file names as the
//! author wrote them) ends here. Files are reached through [`Host`] alone.

mod mesh;
mod ply;

pub use mesh::{MeshError, MeshReader};
pub use ply::Ply;
