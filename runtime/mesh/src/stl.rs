//! STL (stereolithography), text and binary, by stl_io. Corners at equal positions become one vertex; the normals in the
//! file are those of the facets and are not kept.

use std::collections::HashMap;
use std::io::{BufRead, Cursor, Read};

use arsc_geometry::TriangleMesh;

use crate::{MeshBuilder, MeshError};

/// Bytes before the facets of a binary file, and of each facet.
const HEADER: u64 = 84;
const FACET: u64 = 50;

pub fn read(source: &mut dyn BufRead, bytes: u64) -> Result<TriangleMesh, MeshError> {
    let mut content = Vec::new();
    source.take(bytes).read_to_end(&mut content).map_err(MeshError::Read)?;
    if is_binary(&content) {
        let count = facets(&content);
        if HEADER + count * FACET > content.len() as u64 {
            return Err(MeshError::TooMany { element: "facet".into(), count, bytes: content.len() as u64 });
        }
        // Some programs begin binary files like text ones.
        content[..5].fill(b' ');
    }
    let mut cursor = Cursor::new(content);
    let facets = stl_io::create_stl_reader(&mut cursor).map_err(MeshError::Stl)?;
    let mut builder = MeshBuilder::default();
    let mut known: HashMap<[u32; 3], i64> = HashMap::new();
    for facet in facets {
        let facet = facet.map_err(MeshError::Stl)?;
        let mut corners = [0; 3];
        for (corner, vertex) in corners.iter_mut().zip(facet.vertices) {
            // Minus zero and zero are one position.
            let p = vertex.0.map(|x| x + 0.0);
            let next = builder.vertices() as i64;
            *corner = *known.entry(p.map(f32::to_bits)).or_insert(next);
            if *corner == next {
                builder.vertex(p.map(f64::from), None, None, None)?;
            }
        }
        builder.face(&corners)?;
    }
    builder.finish()
}

/// Binary files have no mark of their own: the length says it, or else that the text does not begin with `solid`.
fn is_binary(content: &[u8]) -> bool {
    let counted = content.len() as u64 >= HEADER && HEADER + facets(content) * FACET == content.len() as u64;
    counted || (content.len() as u64 >= HEADER && !content.trim_ascii_start().starts_with(b"solid"))
}

fn facets(content: &[u8]) -> u64 {
    content[80..84].iter().rev().fold(0, |count, &byte| count << 8 | u64::from(byte))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
        read(&mut &bytes[..], bytes.len() as u64)
    }

    const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, -0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn binary(begin: &[u8]) -> Vec<u8> {
        let mut bytes = begin.to_vec();
        bytes.resize(80, 0);
        bytes.extend(4u32.to_le_bytes());
        for face in FACES {
            bytes.extend([0; 12]);
            face.iter().flat_map(|&i| CORNERS[i]).for_each(|x| bytes.extend(x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn text() -> String {
        let mut text = String::from("solid tetrahedron\n");
        for face in FACES {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in face.map(|i| CORNERS[i]) {
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
        text + "endsolid tetrahedron\n"
    }

    #[test]
    fn text_and_binary_give_the_same_welded_mesh() {
        let mesh = load(text().as_bytes()).unwrap();
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4, 4));
        assert_eq!(load(&binary(b"made by hand")).unwrap(), mesh);
        assert_eq!(load(&binary(b"solid but binary")).unwrap(), mesh);
    }

    #[test]
    fn every_cut_is_an_error_and_none_a_panic() {
        let text = text();
        let body = text.len() - "endsolid tetrahedron\n".len();
        (0..body).for_each(|cut| assert!(load(&text.as_bytes()[..cut]).is_err(), "cut at {cut}"));
        let binary = binary(b"x");
        (0..binary.len()).for_each(|cut| assert!(load(&binary[..cut]).is_err(), "cut at {cut}"));
    }

    #[test]
    fn lies_are_found_out() {
        let mut lie = binary(b"x");
        lie[83] = 0x7f;
        assert!(matches!(load(&lie), Err(MeshError::TooMany { .. })));
        let mut nan = binary(b"x");
        nan[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(matches!(load(&nan), Err(MeshError::NotFinite { .. })));
    }
}
