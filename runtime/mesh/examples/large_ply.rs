//! Writes a large binary PLY: a rippled torus of about as many triangles as asked for, in a stream.
//!
//! `cargo run --release -p arsc-mesh --example large_ply -- 28000000 torus.ply`, then `arsc render` a script with
//! `mesh("torus.ply")`: what the biggest meshes cost in time and memory.

use std::io::{BufWriter, Result, Write};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [count, path] = &arguments[..] else {
        eprintln!("usage: large_ply TRIANGLES FILE");
        std::process::exit(2);
    };
    let triangles: u64 = count.parse().map_err(std::io::Error::other)?;
    let columns = ((triangles as f64 / 4.0).sqrt() as u64).max(3);
    let rows = (triangles / (2 * columns)).max(3);
    write(rows, columns, &mut BufWriter::with_capacity(1 << 20, std::fs::File::create(path)?))
}

fn write(rows: u64, columns: u64, out: &mut impl Write) -> Result<()> {
    let (vertices, faces) = (rows * columns, 2 * rows * columns);
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
         property float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    )?;
    let turn = |i: u64, n: u64| std::f64::consts::TAU * i as f64 / n as f64;
    for i in 0..rows {
        let around = turn(i, rows);
        for j in 0..columns {
            let across = turn(j, columns);
            let minor = 0.35 + 0.01 * (40.0 * around).sin() * (30.0 * across).cos();
            let ring = 0.8 + minor * across.cos();
            for x in [ring * around.cos(), ring * around.sin(), minor * across.sin()] {
                out.write_all(&(x as f32).to_le_bytes())?;
            }
        }
    }
    let at = |i: u64, j: u64| ((i % rows) * columns + j % columns) as i32;
    for i in 0..rows {
        for j in 0..columns {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            for corners in [[a, b, c], [a, c, d]] {
                out.write_all(&[3])?;
                for corner in corners {
                    out.write_all(&corner.to_le_bytes())?;
                }
            }
        }
    }
    out.flush()
}
