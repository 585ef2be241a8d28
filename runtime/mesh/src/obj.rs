//! OBJ (Wavefront): geometry of all groups and objects as one mesh, by tobj. Materials are not read.

use std::io::BufRead;

use arsc_geometry::TriangleMesh;
use tobj::{LoadError, LoadOptions, Mesh};

use crate::{MeshBuilder, MeshError};

pub fn read(mut source: &mut dyn BufRead) -> Result<TriangleMesh, MeshError> {
    // Polygons are cut by the builder, which handles concave ones.
    let options = LoadOptions { single_index: true, ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let (models, _) = tobj::load_obj_buf(&mut source, &options, |_| Ok(Default::default())).map_err(obj_error)?;
    let mut builder = MeshBuilder::default();
    for model in &models {
        add(&model.mesh, &mut builder)?;
    }
    builder.finish()
}

/// tobj gives each object vertices of its own.
fn add(mesh: &Mesh, builder: &mut MeshBuilder) -> Result<(), MeshError> {
    let first = builder.vertices() as i64;
    let triple = |values: &[f32], i: usize| values.get(3 * i..3 * i + 3).map(|v| [v[0], v[1], v[2]].map(f64::from));
    for (i, p) in mesh.positions.chunks_exact(3).enumerate() {
        let uv = mesh.texcoords.get(2 * i..2 * i + 2).map(|v| [v[0].into(), v[1].into()]);
        let color = triple(&mesh.vertex_color, i).map(|c| c.map(|x| (x * 255.0).round().clamp(0.0, 255.0) as u8));
        builder.vertex([p[0], p[1], p[2]].map(f64::from), triple(&mesh.normals, i), uv, color)?;
    }
    let mut rest = &mesh.indices[..];
    let mut arities = mesh.face_arities.iter().map(|&n| n as usize);
    while !rest.is_empty() {
        let (face, others) = rest.split_at(arities.next().unwrap_or(3).clamp(1, rest.len()));
        let corners: Vec<i64> = face.iter().map(|&i| first + i64::from(i)).collect();
        builder.face(&corners)?;
        rest = others;
    }
    Ok(())
}

fn obj_error(error: LoadError) -> MeshError {
    MeshError::Obj(match error {
        LoadError::ReadError => "a line that is not text",
        LoadError::PositionParseError => "a vertex that is not made of numbers",
        LoadError::NormalParseError => "a normal that is not made of numbers",
        LoadError::TexcoordParseError => "texture coordinates that are not numbers",
        LoadError::ColorParseError => "a vertex colour that is not made of three numbers",
        LoadError::FaceParseError | LoadError::InvalidPolygon => "a face that is not made of indices",
        LoadError::FaceVertexOutOfBounds => "a face that names a vertex which does not exist",
        LoadError::FaceTexCoordOutOfBounds => "a face that names texture coordinates which do not exist",
        LoadError::FaceNormalOutOfBounds => "a face that names a normal which does not exist",
        LoadError::FaceColorOutOfBounds => "a face that names a colour which does not exist",
        LoadError::ScalingByZeroError => "a vertex with the weight zero",
        _ => "a line that is none of this format",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(text: &str) -> Result<TriangleMesh, MeshError> {
        read(&mut text.as_bytes())
    }

    const SQUARE: &str = "o square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";

    #[test]
    fn polygons_attributes_and_groups_come_along() {
        let mesh = load(&format!("{SQUARE}f 1/1/1 2/2/1 3/3/1 4/4/1\ng other\nf -4/1/1 -2/3/1 -1/4/1\n")).unwrap();
        assert_eq!(mesh.triangles.len(), 3);
        assert!(mesh.is_valid());
        assert_eq!(mesh.normals[0], [0.0, 0.0, 1.0]);
        assert_eq!(mesh.corner_uvs(2).unwrap()[1], glam::DVec2::ONE);
        assert_eq!(mesh.corners(2)[1], glam::DVec3::new(1.0, 1.0, 0.0));
    }

    #[test]
    fn bad_files_are_errors() {
        let fails = |text: &str| load(&format!("{SQUARE}{text}")).unwrap_err().to_string();
        assert!(fails("f 1 2 9\n").contains("does not exist"));
        assert!(fails("f 1 2 x\n").contains("face"));
        assert!(fails("v 1 2 y\nf 1 2 3\n").contains("numbers"));
        assert!(fails("v 1 2 nan\nf 1 2 5\n").contains("not finite"));
        assert!(matches!(load(SQUARE), Err(MeshError::Empty)));
        assert!(matches!(load(""), Err(MeshError::Empty)));
        assert!(load("\u{1}\u{2}f\n").is_err());
        let whole = format!("{SQUARE}f 1/1/1 2/2/1 3/3/1\n");
        (0..whole.len()).for_each(|cut| drop(load(&whole[..cut])));
    }
}
