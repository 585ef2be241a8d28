//! PLY (Turk 1994): ASCII and both binary encodings, by ply-rs.
//!
//! Understood: `vertex` with `x y z`, optionally `nx ny nz` and a pair of texture coordinates under its usual names;
//! `face` with `vertex_indices` or `vertex_index`; `tristrips` with the same. Everything else is read over. Elements
//! are read one at a time, so that memory grows with the mesh and not with what the header claims.

use std::io::{BufRead, Error};

use arsc_accel::TriangleMesh;
use ply_rs::parser::Parser;
use ply_rs::ply::{ElementDef, Encoding, Header, Property, PropertyAccess, PropertyType};

use crate::mesh::{MeshBuilder, MeshError, MeshReader};

/// The PLY reader.
pub struct Ply;

impl MeshReader for Ply {
    fn read(&self, source: &mut dyn BufRead, bytes: u64) -> Result<TriangleMesh, MeshError> {
        let mut source = source;
        let header = Parser::<Vertex>::new().read_header(&mut source).map_err(broken)?;
        let vertex = header.elements.get("vertex").ok_or(MeshError::Missing("element `vertex`"))?;
        for (name, what) in [("x", "property `x`"), ("y", "property `y`"), ("z", "property `z`")] {
            if !is_scalar(vertex, name) {
                return Err(MeshError::Missing(what));
            }
        }
        let mut mesh = MeshBuilder::default();
        for (name, element) in &header.elements {
            if element.count as u64 > bytes {
                return Err(MeshError::TooMany { element: name.clone(), count: element.count as u64, bytes });
            }
            match name.as_str() {
                "vertex" => read_vertices(&mut source, element, &header, &mut mesh)?,
                "face" => each::<Corners>(&mut source, element, &header, |c| mesh.face(&c.0))?,
                "tristrips" => each::<Corners>(&mut source, element, &header, |c| mesh.strip(&c.0))?,
                _ => each::<Skipped>(&mut source, element, &header, |_| Ok(()))?,
            }
        }
        mesh.finish()
    }
}

/// A line of an ASCII file that is not what the header promises; the reader's own words are those of its grammar.
fn not_an(element: &ElementDef, line: &str, error: &Error) -> Error {
    let shown: String = line.trim().chars().take(60).collect();
    Error::new(error.kind(), format!("`{shown}` is no `{}` as the header has it", element.name))
}

/// What the reader says, without the tables of its grammar on the lines below.
fn broken(error: Error) -> MeshError {
    let text = error.to_string();
    match text.split_once('\n') {
        Some((first, _)) => MeshError::Ply(Error::new(error.kind(), first.to_owned())),
        None => MeshError::Ply(error),
    }
}

fn is_scalar(element: &ElementDef, name: &str) -> bool {
    element.properties.get(name).is_some_and(|p| matches!(p.data_type, PropertyType::Scalar(_)))
}

fn read_vertices(
    source: &mut dyn BufRead,
    element: &ElementDef,
    header: &Header,
    mesh: &mut MeshBuilder,
) -> Result<(), MeshError> {
    let has = |names: &[&str]| names.iter().all(|name| is_scalar(element, name));
    let normals = has(&["nx", "ny", "nz"]);
    let uvs = UV_NAMES.iter().any(|names| has(names));
    each::<Vertex>(source, element, header, |v| {
        mesh.vertex(v.position, normals.then_some(v.normal), uvs.then_some(v.uv))
    })
}

/// Reads the elements one by one.
fn each<E: PropertyAccess>(
    mut source: &mut dyn BufRead,
    element: &ElementDef,
    header: &Header,
    mut take: impl FnMut(E) -> Result<(), MeshError>,
) -> Result<(), MeshError> {
    let parser = Parser::<E>::new();
    let mut line = String::new();
    for _ in 0..element.count {
        let read = match header.encoding {
            Encoding::Ascii => {
                line.clear();
                next_line(source, &mut line).map_err(MeshError::Ply)?;
                parser.read_ascii_element(&line, element).map_err(|error| not_an(element, &line, &error))
            }
            Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut source, element),
            Encoding::BinaryLittleEndian => parser.read_little_endian_element(&mut source, element),
        };
        take(read.map_err(broken)?)?;
    }
    Ok(())
}

/// The next line that is not blank.
fn next_line(source: &mut dyn BufRead, line: &mut String) -> Result<(), Error> {
    while line.trim().is_empty() {
        line.clear();
        if source.read_line(line)? == 0 {
            return Err(std::io::ErrorKind::UnexpectedEof.into());
        }
    }
    Ok(())
}

/// Names of texture coordinates that programs write.
const UV_NAMES: [[&str; 2]; 4] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

#[derive(Default)]
struct Vertex {
    position: [f64; 3],
    normal: [f64; 3],
    uv: [f64; 2],
}

impl PropertyAccess for Vertex {
    fn new() -> Vertex {
        Vertex::default()
    }

    fn set_property(&mut self, name: String, property: Property) {
        let Some(value) = scalar(&property) else { return };
        match name.as_str() {
            "x" => self.position[0] = value,
            "y" => self.position[1] = value,
            "z" => self.position[2] = value,
            "nx" => self.normal[0] = value,
            "ny" => self.normal[1] = value,
            "nz" => self.normal[2] = value,
            "u" | "s" | "texture_u" | "texture_s" => self.uv[0] = value,
            "v" | "t" | "texture_v" | "texture_t" => self.uv[1] = value,
            _ => {}
        }
    }
}

/// The indices of a face or a strip.
struct Corners(Vec<i64>);

impl PropertyAccess for Corners {
    fn new() -> Corners {
        Corners(Vec::new())
    }

    fn set_property(&mut self, name: String, property: Property) {
        if name == "vertex_indices" || name == "vertex_index" {
            self.0 = integers(property);
        }
    }
}

/// What is read over.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Skipped {
        Skipped
    }
}

fn scalar(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(v) => v.into(),
        Property::UChar(v) => v.into(),
        Property::Short(v) => v.into(),
        Property::UShort(v) => v.into(),
        Property::Int(v) => v.into(),
        Property::UInt(v) => v.into(),
        Property::Float(v) => v.into(),
        Property::Double(v) => v,
        _ => return None,
    })
}

fn integers(property: Property) -> Vec<i64> {
    fn widen<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
        list.into_iter().map(Into::into).collect()
    }
    match property {
        Property::ListChar(list) => widen(list),
        Property::ListUChar(list) => widen(list),
        Property::ListShort(list) => widen(list),
        Property::ListUShort(list) => widen(list),
        Property::ListInt(list) => widen(list),
        Property::ListUInt(list) => widen(list),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
        Ply.read(&mut &bytes[..], bytes.len() as u64)
    }

    fn header(encoding: &str, index: &str) -> String {
        format!(
            "ply\nformat {encoding} 1.0\ncomment a quad and a triangle\nelement vertex 5\nproperty float x\n\
             property double y\nproperty float z\nproperty uchar confidence\nelement face 2\n\
             property list uchar {index} vertex_indices\nend_header\n"
        )
    }

    const POINTS: [[f64; 3]; 5] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 2.0, 1.0]];
    const FACES: [&[i32]; 2] = [&[0, 1, 2, 3], &[3, 2, 4]];

    fn ascii() -> String {
        let mut text = header("ascii", "int");
        for p in POINTS {
            text += &format!("{} {} {} 7\n", p[0], p[1], p[2]);
        }
        text + "4 0 1 2 3\n3 3 2 4\n"
    }

    fn binary(big: bool) -> Vec<u8> {
        let name = if big { "binary_big_endian" } else { "binary_little_endian" };
        let mut bytes = header(name, "int").into_bytes();
        let mut put = |little: &[u8]| {
            let mut little = little.to_vec();
            if big {
                little.reverse();
            }
            bytes.extend(little);
        };
        for p in POINTS {
            put(&(p[0] as f32).to_le_bytes());
            put(&p[1].to_le_bytes());
            put(&(p[2] as f32).to_le_bytes());
            put(&[7]);
        }
        for face in FACES {
            put(&[face.len() as u8]);
            for index in face {
                put(&index.to_le_bytes());
            }
        }
        bytes
    }

    #[test]
    fn all_encodings_give_the_same_mesh() {
        let mesh = read(ascii().as_bytes()).unwrap();
        assert_eq!(mesh.positions, POINTS.map(|p| p.map(|c| c as f32)));
        assert_eq!(mesh.triangles.len(), 3);
        assert!(mesh.normals.is_empty() && mesh.uvs.is_empty());
        assert_eq!(read(&binary(false)).unwrap(), mesh);
        assert_eq!(read(&binary(true)).unwrap(), mesh);
        assert_eq!(read(ascii().replace('\n', "\r\n").as_bytes()).unwrap(), mesh, "CRLF");
        assert_eq!(read(ascii().replace("vertex_indices", "vertex_index").as_bytes()).unwrap(), mesh);
    }

    #[test]
    fn every_cut_is_an_error_and_none_a_panic() {
        for whole in [ascii().into_bytes(), binary(false), binary(true)] {
            for cut in 0..whole.len() - 2 {
                assert!(read(&whole[..cut]).is_err(), "cut at {cut}");
            }
        }
    }

    #[test]
    fn lies_are_found_out() {
        let claim = |from: &str, to: &str| read(ascii().replace(from, to).as_bytes()).unwrap_err();
        assert!(matches!(claim("vertex 5", "vertex 4000000000000"), MeshError::TooMany { .. }));
        assert!(matches!(claim("3 3 2 4", "3 3 2 5"), MeshError::Index { face: 1, index: 5, vertices: 5 }));
        assert!(matches!(claim("3 3 2 4", "3 3 2 -4"), MeshError::Index { index: -4, .. }));
        assert!(matches!(claim("3 3 2 4", "-3 3 2 4"), MeshError::Ply(_)));
        assert!(matches!(claim("0.5 2 1 7", "0.5 2 1e300 7"), MeshError::NotFinite { vertex: 4 }));
        assert!(matches!(claim("property float z", "property float w"), MeshError::Missing("property `z`")));
        assert!(matches!(claim("element vertex", "element point"), MeshError::Missing("element `vertex`")));
        assert!(matches!(read(b"not a mesh"), Err(MeshError::Ply(_))));
        let MeshError::Ply(cause) = claim("0.5 2 1 7", "0.5 nan 1 7") else { panic!("a vertex of words") };
        assert_eq!(cause.to_string(), "`0.5 nan 1 7` is no `vertex` as the header has it");
        let MeshError::Ply(cause) = read(b"not a mesh\n").unwrap_err() else { panic!("no header") };
        assert!(!cause.to_string().contains('\n'), "{cause}");
        assert!(matches!(read(b""), Err(MeshError::Ply(_))));
    }

    #[test]
    fn normals_and_texture_coordinates_come_along() {
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n\
                    element face 1\nproperty list uchar uint vertex_index\nend_header\n\
                    0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n";
        let mesh = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.normals, vec![[0.0, 0.0, 1.0]; 3]);
        assert_eq!(mesh.uvs, vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    }
}
