//! PLY (Turk 1994): ASCII and both binary encodings; header and text by ply-rs.
//!
//! Understood: `vertex` with `x y z`, optionally `nx ny nz`, a pair of texture coordinates under its usual names and
//! `red green blue`; `face` with `vertex_indices` or `vertex_index`; `tristrips` with the same. Everything else is read
//! over. Elements are read one at a time, so that memory grows with the mesh and not with what the header claims.

use std::io::{BufRead, Error, ErrorKind, Read};

use arsc_geometry::TriangleMesh;
use ply_rs::parser::Parser;
use ply_rs::ply::{ElementDef, Encoding, Property, PropertyAccess, PropertyType, ScalarType};

use crate::binary::{self, Bytes};
use crate::{MeshBuilder, MeshError};

/// Bytes of the header at most, and of a line of an ASCII file.
const LONGEST_HEADER: u64 = 1 << 20;
const LONGEST_LINE: u64 = 1 << 28;

/// Names of the list of corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

pub fn read(mut source: &mut dyn BufRead, bytes: u64) -> Result<TriangleMesh, MeshError> {
    let header = Parser::<Row>::new().read_header(&mut (&mut source).take(LONGEST_HEADER)).map_err(broken)?;
    let vertex = header.elements.get("vertex").ok_or(MeshError::Missing("element `vertex`"))?;
    for (name, what) in [("x", "property `x`"), ("y", "property `y`"), ("z", "property `z`")] {
        if scalar_type(vertex, name).is_none() {
            return Err(MeshError::Missing(what));
        }
    }
    let mut mesh = MeshBuilder::default();
    let least = |element: &ElementDef| match header.encoding {
        Encoding::Ascii => 2 * element.properties.len() as u64,
        _ => binary::least_width(element),
    };
    for (name, element) in &header.elements {
        let count = element.count as u64;
        if count.checked_mul(least(element).max(1)).is_none_or(|needed| needed > bytes) {
            return Err(MeshError::TooMany { element: name.clone(), count, bytes });
        }
    }
    // The counts have just been checked.
    mesh.reserve(vertex.count, header.elements.get("face").map_or(0, |face| face.count));
    let mut body = match header.encoding {
        Encoding::Ascii => Body::Text(Lines { source, line: String::new() }),
        Encoding::BinaryLittleEndian => Body::Binary(Bytes::new(source, false)),
        Encoding::BinaryBigEndian => Body::Binary(Bytes::new(source, true)),
    };
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => body.vertices(element, &mut mesh)?,
            "face" => body.lists(element, &mut |corners| mesh.face(corners))?,
            "tristrips" => body.lists(element, &mut |corners| mesh.strip(corners))?,
            _ => body.skip(element)?,
        }
    }
    mesh.finish()
}

/// What follows the header.
enum Body<'a> {
    Text(Lines<'a>),
    Binary(Bytes<'a>),
}

impl Body<'_> {
    fn vertices(&mut self, element: &ElementDef, mesh: &mut MeshBuilder) -> Result<(), MeshError> {
        let roles = VertexRoles::new(element);
        let take = |values: &[f64; Role::COUNT]| roles.add(values, mesh);
        match self {
            Body::Binary(bytes) => binary::vertices(bytes, element, &roles, take),
            Body::Text(lines) => lines.vertices(element, &roles, take),
        }
    }

    fn lists(
        &mut self,
        element: &ElementDef,
        take: &mut dyn FnMut(&[i64]) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        match self {
            Body::Binary(bytes) => binary::lists(bytes, element, &CORNERS, take),
            Body::Text(lines) => lines.lists(element, take),
        }
    }

    fn skip(&mut self, element: &ElementDef) -> Result<(), MeshError> {
        match self {
            Body::Binary(bytes) => binary::skip(bytes, element),
            Body::Text(lines) => lines.lists(element, &mut |_| Ok(())),
        }
    }
}

/// What a number of a vertex is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    X,
    Y,
    Z,
    NormalX,
    NormalY,
    NormalZ,
    U,
    V,
    Red,
    Green,
    Blue,
}

impl Role {
    pub const COUNT: usize = 11;
}

/// Names of texture coordinates that programs write.
const UV_NAMES: [[&str; 2]; 4] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// The properties of a vertex that are used.
pub struct VertexRoles {
    names: Vec<(&'static str, Role)>,
    has_normals: bool,
    has_uvs: bool,
    has_colors: bool,
    /// What a full colour is in the file.
    full: f64,
}

impl VertexRoles {
    fn new(element: &ElementDef) -> VertexRoles {
        let has = |names: &[&str]| names.iter().all(|name| scalar_type(element, name).is_some());
        let mut names = vec![("x", Role::X), ("y", Role::Y), ("z", Role::Z)];
        let has_normals = has(&["nx", "ny", "nz"]);
        if has_normals {
            names.extend([("nx", Role::NormalX), ("ny", Role::NormalY), ("nz", Role::NormalZ)]);
        }
        let uv = UV_NAMES.into_iter().find(|names| has(names));
        names.extend(uv.into_iter().flat_map(|[u, v]| [(u, Role::U), (v, Role::V)]));
        let has_colors = has(&["red", "green", "blue"]);
        if has_colors {
            names.extend([("red", Role::Red), ("green", Role::Green), ("blue", Role::Blue)]);
        }
        let full = match scalar_type(element, "red") {
            Some(ScalarType::Float | ScalarType::Double) => 1.0,
            Some(ScalarType::UShort) => 65_535.0,
            _ => 255.0,
        };
        VertexRoles { names, has_normals, has_uvs: uv.is_some(), has_colors, full }
    }

    pub fn get(&self, name: &str) -> Option<Role> {
        self.names.iter().find(|(known, _)| *known == name).map(|&(_, role)| role)
    }

    #[inline]
    fn add(&self, v: &[f64; Role::COUNT], mesh: &mut MeshBuilder) -> Result<(), MeshError> {
        let color = |value: f64| (255.0 * value / self.full).round().clamp(0.0, 255.0) as u8;
        mesh.vertex(
            [v[0], v[1], v[2]],
            self.has_normals.then_some([v[3], v[4], v[5]]),
            self.has_uvs.then_some([v[6], v[7]]),
            self.has_colors.then(|| [v[8], v[9], v[10]].map(color)),
        )
    }
}

fn scalar_type(element: &ElementDef, name: &str) -> Option<ScalarType> {
    match element.properties.get(name)?.data_type {
        PropertyType::Scalar(ref scalar) => Some(scalar.clone()),
        PropertyType::List(..) => None,
    }
}

/// The lines of an ASCII body.
struct Lines<'a> {
    source: &'a mut dyn BufRead,
    line: String,
}

impl Lines<'_> {
    fn vertices(
        &mut self,
        element: &ElementDef,
        roles: &VertexRoles,
        mut take: impl FnMut(&[f64; Role::COUNT]) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        let mut values = [0.0; Role::COUNT];
        self.each(element, |row| {
            for (name, property) in &row.0 {
                if let (Some(role), Some(value)) = (roles.get(name), scalar(property)) {
                    values[role as usize] = value;
                }
            }
            take(&values)
        })
    }

    fn lists(
        &mut self,
        element: &ElementDef,
        take: &mut dyn FnMut(&[i64]) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        self.each(element, |row| {
            let corners = row.0.into_iter().find(|(name, _)| CORNERS.contains(&name.as_str()));
            take(&corners.map_or(Vec::new(), |(_, list)| integers(list)))
        })
    }

    fn each(
        &mut self,
        element: &ElementDef,
        mut take: impl FnMut(Row) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        let parser = Parser::<Row>::new();
        for index in 0..element.count {
            if !self.next().map_err(|error| at_line(error, element, index))? {
                let (index, count) = (index as u64 + 1, element.count as u64);
                return Err(MeshError::Truncated { element: element.name.clone(), index, count });
            }
            let row = parser.read_ascii_element(&self.line, element);
            take(row.map_err(|error| broken(not_an(element, &self.line, &error)))?)?;
        }
        Ok(())
    }

    /// Goes to the next line that is not blank; false at the end.
    fn next(&mut self) -> Result<bool, Error> {
        loop {
            self.line.clear();
            if (&mut self.source).take(LONGEST_LINE).read_line(&mut self.line)? == 0 {
                return Ok(false);
            }
            if !self.line.trim().is_empty() {
                return Ok(true);
            }
        }
    }
}

fn at_line(error: Error, element: &ElementDef, index: usize) -> MeshError {
    match error.kind() {
        ErrorKind::InvalidData => MeshError::Ply(Error::other(format!("`{}` {} is not text", element.name, index + 1))),
        _ => MeshError::Read(error),
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

/// The properties of one element of an ASCII file.
struct Row(Vec<(String, Property)>);

impl PropertyAccess for Row {
    fn new() -> Row {
        Row(Vec::new())
    }

    fn set_property(&mut self, name: String, property: Property) {
        self.0.push((name, property));
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

    fn load(bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
        super::read(&mut &bytes[..], bytes.len() as u64)
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
        let mesh = load(ascii().as_bytes()).unwrap();
        assert_eq!(mesh.positions, POINTS.map(|p| p.map(|c| c as f32)));
        assert_eq!(mesh.triangles.len(), 3);
        assert!(mesh.normals.is_empty() && mesh.uvs.is_empty());
        assert_eq!(load(&binary(false)).unwrap(), mesh);
        assert_eq!(load(&binary(true)).unwrap(), mesh);
        assert_eq!(load(ascii().replace('\n', "\r\n").as_bytes()).unwrap(), mesh, "CRLF");
        assert_eq!(load(ascii().replace("vertex_indices", "vertex_index").as_bytes()).unwrap(), mesh);
    }

    #[test]
    fn every_cut_is_an_error_and_none_a_panic() {
        for whole in [ascii().into_bytes(), binary(false), binary(true)] {
            for cut in 0..whole.len() - 2 {
                assert!(load(&whole[..cut]).is_err(), "cut at {cut}");
            }
        }
    }

    #[test]
    fn lies_are_found_out() {
        let claim = |from: &str, to: &str| load(ascii().replace(from, to).as_bytes()).unwrap_err();
        assert!(matches!(claim("vertex 5", "vertex 4000000000000"), MeshError::TooMany { .. }));
        assert!(matches!(claim("3 3 2 4", "3 3 2 5"), MeshError::Index { face: 1, index: 5, vertices: 5 }));
        assert!(matches!(claim("3 3 2 4", "3 3 2 -4"), MeshError::Index { index: -4, .. }));
        assert!(matches!(claim("3 3 2 4", "-3 3 2 4"), MeshError::Ply(_)));
        assert!(matches!(claim("0.5 2 1 7", "0.5 2 1e300 7"), MeshError::NotFinite { vertex: 4 }));
        assert!(matches!(claim("property float z", "property float w"), MeshError::Missing("property `z`")));
        assert!(matches!(claim("element vertex", "element point"), MeshError::Missing("element `vertex`")));
        assert!(matches!(load(b"not a mesh"), Err(MeshError::Ply(_))));
        let MeshError::Ply(cause) = claim("0.5 2 1 7", "0.5 nan 1 7") else { panic!("a vertex of words") };
        assert_eq!(cause.to_string(), "`0.5 nan 1 7` is no `vertex` as the header has it");
        let MeshError::Ply(cause) = load(b"not a mesh\n").unwrap_err() else { panic!("no header") };
        assert!(!cause.to_string().contains('\n'), "{cause}");
        assert!(matches!(load(b""), Err(MeshError::Ply(_))));
    }

    #[test]
    fn normals_and_texture_coordinates_come_along() {
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n\
                    element face 1\nproperty list uchar uint vertex_index\nend_header\n\
                    0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n";
        let mesh = load(text.as_bytes()).unwrap();
        assert_eq!(mesh.normals, vec![[0.0, 0.0, 1.0]; 3]);
        assert_eq!(mesh.uvs, vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    }
}
