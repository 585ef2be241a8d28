//! Readers of triangle meshes: bytes in, a checked [`TriangleMesh`] out.
//!
//! PLY (ASCII and both binary encodings, header and text by ply-rs), OBJ (tobj), STL (stl_io), and grey PNG images as height fields. Polygons are cut into
//! triangles; positions, normals and texture coordinates become f32. Nothing is repaired but normals and texture coordinates
//! that are not usable, which are dropped: topology is [`arsc_geometry::ClosedMesh`]'s.
//!
//! Files are hostile: every count is checked against the size of the file before it is believed, memory grows with what
//! was read, and every failure is a [`MeshError`]. No file is opened here.

mod binary;
mod builder;
mod height_field;
mod obj;
mod ply;
mod stl;

use std::io::BufRead;

use arsc_geometry::TriangleMesh;

pub use builder::{MeshBuilder, MeshError};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Ply,
    Obj,
    Stl,
    /// A grey image as a height field.
    Png,
}

impl Format {
    /// By the extension of a file's name, in any case; `None` if it is none of these.
    pub fn of(name: &str) -> Option<Format> {
        let (_, extension) = name.rsplit_once('.')?;
        match extension.to_ascii_lowercase().as_str() {
            "ply" => Some(Format::Ply),
            "obj" => Some(Format::Obj),
            "stl" => Some(Format::Stl),
            "png" => Some(Format::Png),
            _ => None,
        }
    }
}

/// Reads a mesh of the format that `name` ends in. `bytes` is the length of `source`.
pub fn read(name: &str, source: &mut dyn BufRead, bytes: u64) -> Result<TriangleMesh, MeshError> {
    match Format::of(name).ok_or(MeshError::Format)? {
        Format::Ply => ply::read(source, bytes),
        Format::Obj => obj::read(source),
        Format::Stl => stl::read(source, bytes),
        Format::Png => height_field::read(source, bytes),
    }
}
