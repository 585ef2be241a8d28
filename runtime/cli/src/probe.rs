//! `arsc probe`: what given rays meet.
//!
//! Rays come as lines `ox,oy,oz,dx,dy,dz`; a header line and blank lines are read over. For each maximal stretch of a
//! ray inside one solid there is a row `ray,t_enter,t_exit,solid,material` with the outward unit normals at both
//! ends. Points of the ray are o + t d with the direction as given, whatever its length. A ray may start inside: then
//! `t_enter` is 0 and the normal at entry is left out; likewise at the end of an unbounded solid, where `t_exit` is
//! `inf` (null in JSON). Solids are numbered in the order of the optimised scene, materials as in `arsc ir`.
//! Open surfaces have no inside and do not appear.

use std::io::Write;
use std::path::{Path, PathBuf};

use arsc_accel::{Interval, Ray, Scene};
use serde::Serialize;

use crate::args::SceneArgs;
use crate::bug;
use crate::compile::{compile, words};
use crate::exit::Exit;
use crate::failure::failure;
use crate::files::read_script;
use crate::render::Csg;

#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Csv,
    Json,
}

/// Prints every interval that given rays spend inside of solids
#[derive(clap::Args, Debug)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// File with a ray `ox,oy,oz,dx,dy,dz` on each line, or `-` for standard input
    #[arg(long, value_name = "FILE")]
    rays: PathBuf,

    #[arg(long, value_enum, default_value = "csv")]
    format: Format,

    /// How CSG is traced
    #[arg(long, value_enum, default_value = "local")]
    csg: Csg,
}

/// A row of the answer.
#[derive(Debug, Serialize)]
struct Row {
    /// Number of the ray, from 0.
    ray: usize,
    t_enter: f64,
    /// `None` for infinity.
    t_exit: Option<f64>,
    solid: u32,
    material: Option<u32>,
    normal_enter: Option<[f64; 3]>,
    normal_exit: Option<[f64; 3]>,
}

/// The names of the columns.
const HEADER: &str = "ray,t_enter,t_exit,solid,material,nx,ny,nz,nx,ny,nz";

pub fn run(args: &Args) -> Exit {
    if args.rays == Path::new("-") && args.scene.scene == Path::new("-") {
        eprintln!("error: the scene and the rays cannot both come from standard input");
        return Exit::CouldNotRun;
    }
    let rays = match rays(&args.rays) {
        Ok(rays) => rays,
        Err(text) => {
            eprintln!("error: {text}");
            return Exit::CouldNotRun;
        }
    };
    let scene = match compile(&args.scene, false) {
        Ok(scene) => scene,
        Err(exit) => return exit,
    };
    bug::stage("build");
    let traced = match arsc_assembly::trace_scene(&scene.ir, args.csg.into()) {
        Ok(traced) => traced,
        Err(error) => return failure(&error),
    };
    bug::stage("probe");
    match print(&traced, &rays, args.format) {
        // A reader that has seen enough, as `head` does, is no failure.
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => failure(&error),
        _ => Exit::Clean,
    }
}

fn print(scene: &Scene, rays: &[ProbeRay], format: Format) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    if format == Format::Csv {
        writeln!(out, "{HEADER}")?;
        for row in rays.iter().enumerate().flat_map(|(i, ray)| rows(scene, i, ray)) {
            write_csv(&mut out, &row)?;
        }
    } else {
        let mut separator = "[";
        for row in rays.iter().enumerate().flat_map(|(i, ray)| rows(scene, i, ray)) {
            write!(out, "{separator}\n  {}", serde_json::to_string(&row)?)?;
            separator = ",";
        }
        writeln!(out, "{}", if separator == "[" { "[]" } else { "\n]" })?;
    }
    out.flush()
}

/// The intervals of a ray, sorted.
fn rows(scene: &Scene, number: usize, ray: &ProbeRay) -> Vec<Row> {
    let mut rows: Vec<Row> = scene.intervals(&ray.ray).iter().map(|i| row(number, i, ray.length)).collect();
    let end = |row: &Row| row.t_exit.unwrap_or(f64::INFINITY);
    rows.sort_by(|a, b| a.t_enter.total_cmp(&b.t_enter).then(end(a).total_cmp(&end(b))).then(a.solid.cmp(&b.solid)));
    rows
}

fn row(ray: usize, interval: &Interval, length: f64) -> Row {
    let material = interval.enter.as_ref().or(interval.exit.as_ref()).map(|hit| hit.material.0);
    let normal = |hit: &arsc_accel::Hit| hit.ng.to_array();
    Row {
        ray,
        t_enter: interval.t_enter / length,
        t_exit: interval.t_exit.is_finite().then_some(interval.t_exit / length),
        solid: interval.solid,
        material,
        normal_enter: interval.enter.as_ref().map(normal),
        normal_exit: interval.exit.as_ref().map(normal),
    }
}

fn write_csv(out: &mut impl Write, row: &Row) -> std::io::Result<()> {
    let normal = |n: Option<[f64; 3]>| n.map_or(",,".into(), |[x, y, z]| format!("{x},{y},{z}"));
    let exit = row.t_exit.unwrap_or(f64::INFINITY);
    let material = row.material.map_or(String::new(), |m| m.to_string());
    let (enter_normal, exit_normal) = (normal(row.normal_enter), normal(row.normal_exit));
    writeln!(out, "{},{},{exit},{},{material},{enter_normal},{exit_normal}", row.ray, row.t_enter, row.solid)
}

/// A ray and the length of its direction as given.
#[derive(Debug)]
struct ProbeRay {
    ray: Ray,
    length: f64,
}

fn rays(path: &Path) -> Result<Vec<ProbeRay>, String> {
    let text = read_script(path).map_err(|error| format!("cannot read {}: {}", path.display(), words(&error)))?;
    parse_rays(&text).map_err(|error| format!("{}: {error}", path.display()))
}

fn parse_rays(text: &str) -> Result<Vec<ProbeRay>, String> {
    let mut rays = Vec::new();
    let mut may_be_header = true;
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let is_header = may_be_header && line.split(',').all(|name| name.trim().parse::<f64>().is_err());
        may_be_header = false;
        if !is_header {
            rays.push(parse_ray(line).map_err(|error| format!("line {}: {error}", number + 1))?);
        }
    }
    Ok(rays)
}

fn parse_ray(line: &str) -> Result<ProbeRay, String> {
    let numbers: Vec<f64> = line
        .split(',')
        .map(|text| text.trim().parse().map_err(|_| format!("`{}` is not a number", text.trim())))
        .collect::<Result<_, _>>()?;
    let [ox, oy, oz, dx, dy, dz] = numbers[..] else {
        return Err(format!("expected ox,oy,oz,dx,dy,dz, found {} values", numbers.len()));
    };
    let (origin, direction) = (glam::DVec3::new(ox, oy, oz), glam::DVec3::new(dx, dy, dz));
    // Scaled first, so that the square neither overflows nor vanishes.
    let scale = direction.abs().max_element();
    let length = (direction / scale).length() * scale;
    if !origin.is_finite() || !length.is_finite() || length == 0.0 {
        return Err("a ray needs a finite origin and a finite direction other than zero".into());
    }
    Ok(ProbeRay { ray: Ray::new(origin, (direction / scale).normalize()), length })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_are_read_with_or_without_header() {
        let rays = parse_rays("ox,oy,oz,dx,dy,dz\n\n 0, 1,2 ,0,0,-3\r\n1e3,0,0,1,0,0\n").unwrap();
        assert_eq!(rays.len(), 2);
        assert_eq!(rays[0].ray.origin, glam::DVec3::new(0.0, 1.0, 2.0));
        assert_eq!((rays[0].ray.dir, rays[0].length), (-glam::DVec3::Z, 3.0));
        assert!(parse_rays("").unwrap().is_empty());
    }

    #[test]
    fn bad_rows_name_their_line() {
        for (text, line) in [
            ("0,0,0,0,0,1\n0,0,0,0,1\n", "line 2: expected"),
            ("0,0,0,0,0,1\n\nox,oy,oz,dx,dy,dz\n", "line 3: `ox` is not a number"),
            ("0,0,0,0,0,0\n", "line 1: a ray needs"),
            ("0,0,nan,0,0,1\n", "line 1: a ray needs"),
            ("inf,0,0,0,0,1\n", "line 1: a ray needs"),
            ("O,0,0,0,0,1\n", "line 1: `O` is not a number"),
            ("0,0,0,inf,0,1\n", "line 1: a ray needs"),
            ("0,0,0,0,0,1,\n", "line 1: `` is not a number"),
        ] {
            let error = parse_rays(text).unwrap_err();
            assert!(error.starts_with(line), "{text:?}: {error}");
        }
    }

    #[test]
    fn tiny_and_huge_directions_keep_their_length() {
        for scale in [1e-300, 1e300] {
            let ray = parse_ray(&format!("0,0,0,{},{},0", 3.0 * scale, 4.0 * scale)).unwrap();
            assert!((ray.length / (5.0 * scale) - 1.0).abs() < 1e-15);
            assert!((ray.ray.dir.length() - 1.0).abs() < 1e-15);
        }
    }
}
