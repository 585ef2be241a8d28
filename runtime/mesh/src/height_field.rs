//! Height fields from grey PNG images (8 or 16 bits, or fewer), as closed meshes.
//!
//! Pixels are vertices: x from left to right and y from bottom to top over [0, 1], z from 0 (black) to 1 (white). Each
//! square of four is cut along the diagonal from its lower left. Sides go down to the floor at z = −`FLOOR`, so that black
//! parts have a thickness too. The values are used as they are: no gamma is undone.

use std::io::{BufRead, Cursor, Read};

use arsc_geometry::TriangleMesh;
use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

use crate::{MeshBuilder, MeshError};

/// Depth of the floor below black.
const FLOOR: f64 = 1.0 / 16.0;
/// More pixels than this are an error.
const MOST_PIXELS: u64 = 1 << 22;

/// Heights over [0, 1], rows from the top.
struct Heights {
    width: usize,
    rows: usize,
    values: Vec<f64>,
}

pub fn read(source: &mut dyn BufRead, bytes: u64) -> Result<TriangleMesh, MeshError> {
    let mut content = Vec::new();
    source.take(bytes).read_to_end(&mut content).map_err(MeshError::Read)?;
    let heights = decode(content)?;
    let (w, h) = (heights.width, heights.rows);
    let mut builder = MeshBuilder::default();
    let place = |column: usize, row: usize| [column as f64 / (w - 1) as f64, 1.0 - row as f64 / (h - 1) as f64];
    for (i, &z) in heights.values.iter().enumerate() {
        let uv = place(i % w, i / w);
        builder.vertex([uv[0], uv[1], z], None, Some(uv), None)?;
    }
    let at = |column: usize, row: usize| (row * w + column) as i64;
    for row in 1..h {
        for column in 1..w {
            let (low_left, low_right) = (at(column - 1, row), at(column, row));
            let (high_left, high_right) = (at(column - 1, row - 1), at(column, row - 1));
            builder.face(&[low_left, low_right, high_right])?;
            builder.face(&[low_left, high_right, high_left])?;
        }
    }
    // The rim, counter-clockwise from above, and what hangs from it.
    let bottom = (0..w - 1).map(|column| (column, h - 1));
    let right = (1..h).rev().map(|row| (w - 1, row));
    let top = (1..w).rev().map(|column| (column, 0));
    let left = (0..h - 1).map(|row| (0, row));
    let rim: Vec<(usize, usize)> = bottom.chain(right).chain(top).chain(left).collect();
    let center = builder.vertices() as i64;
    builder.vertex([0.5, 0.5, -FLOOR], None, Some([0.5, 0.5]), None)?;
    for &(column, row) in &rim {
        let uv = place(column, row);
        builder.vertex([uv[0], uv[1], -FLOOR], None, Some(uv), None)?;
    }
    for i in 0..rim.len() {
        let next = (i + 1) % rim.len();
        let (a, b) = (at(rim[i].0, rim[i].1), at(rim[next].0, rim[next].1));
        let (below_a, below_b) = (center + 1 + i as i64, center + 1 + next as i64);
        builder.face(&[a, below_a, below_b])?;
        builder.face(&[a, below_b, b])?;
        builder.face(&[center, below_b, below_a])?;
    }
    builder.finish()
}

fn decode(content: Vec<u8>) -> Result<Heights, MeshError> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(content), Limits { bytes: 16 << 20 });
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(MeshError::Png)?;
    let (width, rows) = reader.info().size();
    if width < 2 || rows < 2 || u64::from(width) * u64::from(rows) > MOST_PIXELS {
        return Err(MeshError::Image("it must have 2 by 2 to 4 million pixels"));
    }
    let size = reader.output_buffer_size().ok_or(MeshError::Image("it is too large"))?;
    let mut pixels = vec![0; size];
    let frame = reader.next_frame(&mut pixels).map_err(MeshError::Png)?;
    let channels = match frame.color_type {
        ColorType::Grayscale => 1,
        ColorType::GrayscaleAlpha => 2,
        _ => return Err(MeshError::Image("it is coloured; heights are grey")),
    };
    let values: Vec<f64> = match frame.bit_depth {
        BitDepth::Sixteen => pixels
            .chunks_exact(2 * channels)
            .map(|sample| f64::from(u16::from_be_bytes([sample[0], sample[1]])) / f64::from(u16::MAX))
            .collect(),
        _ => pixels.chunks_exact(channels).map(|sample| f64::from(sample[0]) / f64::from(u8::MAX)).collect(),
    };
    let (width, rows) = (width as usize, rows as usize);
    if values.len() < width * rows {
        return Err(MeshError::Image("it ends too early"));
    }
    Ok(Heights { width, rows, values })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use arsc_geometry::{ClosedMesh, DVec3, Shape};

    use super::*;

    fn grey(width: u32, rows: u32, color: ColorType, pixels: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, rows);
        encoder.set_color(color);
        encoder.set_depth(BitDepth::Eight);
        encoder.write_header().unwrap().write_image_data(pixels).unwrap();
        bytes
    }

    fn load(bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
        read(&mut &bytes[..], bytes.len() as u64)
    }

    #[test]
    fn a_ramp_is_a_closed_solid() {
        // White on the left, black on the right.
        let mesh = load(&grey(3, 2, ColorType::Grayscale, &[255, 51, 0, 255, 51, 0])).unwrap();
        let (closed, repairs) = ClosedMesh::new("ramp.png".into(), mesh).unwrap();
        assert_eq!((repairs.flipped, repairs.degenerate), (0, 0));
        let solid = Shape::Mesh(Arc::new(closed));
        for (p, inside) in [
            (DVec3::new(0.05, 0.4, 0.8), true),
            (DVec3::new(0.5, 0.6, 0.19), true),
            (DVec3::new(0.5, 0.6, 0.21), false),
            (DVec3::new(0.9, 0.5, -0.03), true),
            (DVec3::new(0.9, 0.5, 0.1), false),
            (DVec3::new(0.5, 0.5, -0.07), false),
        ] {
            assert_eq!(solid.contains(p), inside, "{p}");
        }
    }

    #[test]
    fn bad_images_are_errors() {
        assert!(matches!(load(&grey(1, 2, ColorType::Grayscale, &[0, 0])), Err(MeshError::Image(_))));
        assert!(matches!(load(&grey(2, 2, ColorType::Rgb, &[0; 12])), Err(MeshError::Image(_))));
        let good = grey(9, 7, ColorType::Grayscale, &[100; 63]);
        assert!(load(&good).is_ok());
        for end in 0..good.len() {
            // Cut after the last pixel it may still be read; it never panics.
            if load(&good[..end]).is_ok() {
                assert!(end > good.len() - 24);
            }
        }
    }
}
