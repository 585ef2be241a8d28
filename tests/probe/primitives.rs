//! Every primitive's intervals and normals against its defining inequality, which is written here: `f(p) <= 0`, sampled
//! densely along the ray, ends bisected to the last place. Nothing of the crates' intersectors is used.
//!
//! Rays go from one point towards another, which is at t = 1, so that directions have any length.

use std::fmt::Write;
use std::path::Path;

use glam::{DVec2, DVec3, dvec2, dvec3};

use crate::common::{arsc_with_input, stderr, stdout};

/// Of t; what is shorter than a sample is not seen here, so no ray passes through less.
const SAMPLES: usize = 20_000;
const T_MAX: f64 = 4.0;
/// Of t, absolute: solids and rays are a few units large, and no ray meets a surface at less than a hundredth.
const TOLERANCE: f64 = 1e-12;

type Implicit = Box<dyn Fn(DVec3) -> f64>;
type Segment = ([f64; 3], [f64; 3]);

/// A solid as the script has it and as its inequality.
struct Primitive {
    script: &'static str,
    f: Implicit,
    rays: Rays,
}

struct Rays {
    /// A chord shorter than half of t, of a deeper solid.
    grazing: Segment,
    /// From within.
    inside: Segment,
    /// Within a plane of symmetry.
    symmetric: Segment,
    oblique: Segment,
}

/// A stretch with f <= 0; infinite where it has no end.
fn stretches(f: &Implicit, origin: DVec3, dir: DVec3) -> Vec<(f64, f64)> {
    let is_inside = |t: f64| f(origin + dir * t) <= 0.0;
    let end = |mut low: f64, mut high: f64| {
        let before = is_inside(low);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *(if is_inside(middle) == before { &mut low } else { &mut high }) = middle;
        }
        0.5 * (low + high)
    };
    let mut found = Vec::new();
    let mut start = is_inside(0.0).then_some(0.0);
    let sample = |i: usize| T_MAX * i as f64 / SAMPLES as f64;
    for i in 1..=SAMPLES {
        let (last, now) = (sample(i - 1), sample(i));
        match (start, is_inside(now)) {
            (None, true) => start = Some(end(last, now)),
            (Some(enter), false) => {
                found.push((enter, end(last, now)));
                start = None;
            }
            _ => {}
        }
    }
    found.extend(start.map(|enter| (enter, f64::INFINITY)));
    found
}

/// Outwards, by differences; `None` at a crease, where those to both sides are not the same.
fn normal(f: &Implicit, p: DVec3) -> Option<DVec3> {
    let h = 1e-6;
    let here = f(p);
    let after = DVec3::from_array(DVec3::AXES.map(|axis| f(p + axis * h) - here));
    let before = DVec3::from_array(DVec3::AXES.map(|axis| here - f(p - axis * h)));
    let is_smooth = after.distance(before) < 1e-3 * after.length();
    is_smooth.then(|| (after + before).normalize())
}

fn all_of<const N: usize>(values: [f64; N]) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

fn axial(p: DVec3) -> f64 {
    p.x.hypot(p.y)
}

fn slab(x: f64, low: f64, high: f64) -> f64 {
    (low - x).max(x - high)
}

fn primitive(script: &'static str, f: impl Fn(DVec3) -> f64 + 'static, rays: Rays) -> Primitive {
    Primitive { script, f: Box::new(f), rays }
}

fn quadrics() -> Vec<Primitive> {
    vec![
        primitive(
            "sphere(radius: 1.3, center: (0.2, -0.1, 0.4))",
            |p| p.distance(dvec3(0.2, -0.1, 0.4)) - 1.3,
            Rays {
                grazing: ([-3.0, -0.1, 1.699], [2.0, -0.1, 1.699]),
                inside: ([0.3, 0.2, 0.1], [1.0, 3.0, 0.5]),
                symmetric: ([-3.0, -0.1, 0.0], [1.0, -0.1, 0.9]),
                oblique: ([3.0, 2.0, -1.5], [0.0, 0.3, 0.2]),
            },
        ),
        primitive(
            "ellipsoid(radii: (0.5, 1.2, 0.8), center: (0, 0.1, 0))",
            |p| ((p - dvec3(0.0, 0.1, 0.0)) / dvec3(0.5, 1.2, 0.8)).length() - 1.0,
            Rays {
                grazing: ([-2.0, 0.1, 0.799], [1.0, 0.1, 0.799]),
                inside: ([0.1, 0.3, 0.2], [1.0, 3.0, 0.5]),
                symmetric: ([0.0, 3.0, -0.5], [0.0, 0.0, 0.2]),
                oblique: ([3.0, 2.0, -1.5], [0.0, 0.3, 0.2]),
            },
        ),
        primitive(
            "cylinder(radius: 0.7, height: 1.5)",
            |p| all_of([axial(p) - 0.7, slab(p.z, 0.0, 1.5)]),
            Rays {
                grazing: ([-2.0, 0.6985, 0.3], [1.0, 0.6985, 0.9]),
                inside: ([0.1, 0.3, 0.2], [0.4, 0.1, 2.5]),
                symmetric: ([0.0, 3.0, -0.5], [0.0, 0.2, 0.2]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.3, 0.2]),
            },
        ),
        primitive(
            "cylinder(radius: 0.9, height: 1.2, top_radius: 0.4)",
            |p| all_of([axial(p) - 0.9 + 0.5 * p.z / 1.2, slab(p.z, 0.0, 1.2)]),
            Rays {
                grazing: ([-2.0, 0.648, 0.6], [1.0, 0.648, 0.6]),
                inside: ([0.1, 0.3, 0.2], [2.0, 0.1, 0.5]),
                symmetric: ([0.0, 3.0, -0.5], [0.0, 0.2, 0.6]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.3, 0.2]),
            },
        ),
        primitive(
            "cone(radius: 0.9, height: 1.2)",
            |p| all_of([axial(p) - 0.9 + 0.9 * p.z / 1.2, -p.z]),
            Rays {
                grazing: ([-2.0, 0.0, 1.19], [1.0, 0.0, 1.195]),
                inside: ([0.1, 0.3, 0.2], [2.0, 0.1, 0.5]),
                symmetric: ([0.0, 0.0, 3.0], [0.0, 0.2, 0.6]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.3, 0.2]),
            },
        ),
        primitive(
            "paraboloid(radius: 0.8, height: 1.1)",
            |p| all_of([p.x * p.x + p.y * p.y - 0.64 * p.z / 1.1, p.z - 1.1]),
            Rays {
                grazing: ([-2.0, 0.0, 0.002], [1.0, 0.0, 0.002]),
                inside: ([0.1, 0.3, 0.6], [2.0, 0.1, 0.9]),
                symmetric: ([0.0, 0.3, 3.0], [0.0, 0.2, 0.6]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.1, 0.5]),
            },
        ),
        primitive(
            "hyperboloid(radius: 0.4, height: 2.2, slope: 0.7)",
            |p| all_of([axial(p) - (0.49 * p.z * p.z + 0.16).sqrt(), p.z.abs() - 1.1]),
            Rays {
                // Beside the waist, leaning less than the asymptotes.
                grazing: ([-2.0, 0.399, 0.0], [1.0, 0.399, 0.0]),
                inside: ([0.1, 0.2, 0.1], [0.7, 0.2, 1.0]),
                // In and out of both flares.
                symmetric: ([0.0, 0.6, 3.0], [0.0, 0.55, 0.0]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.1, 0.5]),
            },
        ),
        primitive(
            "hyperboloid(radius: 0.4, height: 2.4, slope: 0.8, sheets: 2)",
            |p| all_of([p.x * p.x + p.y * p.y - 0.64 * p.z * p.z + 0.16, p.z.abs() - 1.2]),
            Rays {
                grazing: ([-2.0, 0.0, 0.503], [1.0, 0.0, 0.503]),
                inside: ([0.1, 0.2, -0.9], [0.15, 0.2, 0.8]),
                symmetric: ([0.0, 0.6, 3.0], [0.0, 0.1, 0.0]),
                oblique: ([2.0, 1.0, 2.9], [0.1, 0.1, 0.9]),
            },
        ),
        primitive(
            "infinite_cylinder(radius: 0.6)",
            |p| axial(p) - 0.6,
            Rays {
                grazing: ([-2.0, 0.598, 0.3], [1.0, 0.598, 0.9]),
                inside: ([0.1, 0.2, 0.5], [0.1, 0.2, 2.0]),
                symmetric: ([0.0, 3.0, -0.5], [0.0, 0.2, 0.2]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.3, 0.2]),
            },
        ),
    ]
}

fn torus_rays(major: f64, minor: f64, symmetric: Segment) -> Rays {
    let (outer, top) = (major + minor, 0.999 * minor);
    Rays {
        grazing: ([major + 0.1, -2.0, top], [major - 0.1, 1.0, top]),
        inside: ([major, 0.1, 0.1 * minor], [-outer, 0.3, 0.2 * minor]),
        symmetric,
        oblique: ([outer, 2.0, 0.9], [-0.3 * outer, -0.5, -0.1]),
    }
}

fn others() -> Vec<Primitive> {
    let torus =
        |script, major: f64, minor: f64, rays| primitive(script, move |p| (axial(p) - major).hypot(p.z) - minor, rays);
    let gauge = |script, radii: DVec3, e1: f64, e2: f64, rays| {
        let f = move |p: DVec3| {
            let [x, y, z] = (p / radii).abs().to_array();
            (x.powf(2.0 / e2) + y.powf(2.0 / e2)).powf(e2 / e1) + z.powf(2.0 / e1) - 1.0
        };
        primitive(script, f, rays)
    };
    vec![
        primitive(
            "box(min: (-0.5, -0.7, 0.1), max: (0.4, 0.6, 1.0))",
            |p| all_of([slab(p.x, -0.5, 0.4), slab(p.y, -0.7, 0.6), slab(p.z, 0.1, 1.0)]),
            Rays {
                // Across an edge.
                grazing: ([0.4, -2.0, 2.98], [0.4 - 0.01, 0.595, 0.99]),
                inside: ([0.1, 0.2, 0.5], [0.3, -0.2, 2.0]),
                symmetric: ([-0.05, 3.0, -0.5], [-0.05, 0.2, 0.5]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.3, 0.2]),
            },
        ),
        // Through the hole; the horn beside its point; the spindle along its axis, through the lens.
        torus("torus(major: 1, minor: 0.3)", 1.0, 0.3, torus_rays(1.0, 0.3, ([-3.0, 0.0, 0.1], [1.0, 0.0, -0.05]))),
        torus("torus(major: 0.7, minor: 0.7)", 0.7, 0.7, torus_rays(0.7, 0.7, ([-3.0, 0.0, 0.9], [0.5, 0.0, 0.2]))),
        torus("torus(major: 0.5, minor: 0.8)", 0.5, 0.8, torus_rays(0.5, 0.8, ([0.0, 0.1, 3.0], [0.0, 0.1, 0.5]))),
        gauge(
            "superquadric(radii: (1, 1.5, 0.8), e1: 0.4, e2: 0.6)",
            dvec3(1.0, 1.5, 0.8),
            0.4,
            0.6,
            Rays {
                grazing: ([-2.0, 1.405, 0.6], [0.5, 1.405, 0.6]),
                inside: ([0.1, 0.2, 0.3], [0.3, -0.2, 2.0]),
                symmetric: ([-2.0, 0.0, 0.9], [0.5, 0.0, 0.2]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.3, 0.2]),
            },
        ),
        gauge(
            "superquadric(e1: 3, e2: 2.5)",
            DVec3::ONE,
            3.0,
            2.5,
            Rays {
                grazing: ([-2.0, 0.01, 0.9], [0.5, 0.0, 0.3]),
                inside: ([0.05, 0.04, 0.03], [0.3, -0.2, 2.0]),
                // Along spikes: two of them and the body.
                symmetric: ([-2.0, 0.0, 0.05], [0.5, 0.0, -0.02]),
                oblique: ([3.0, 2.0, 2.9], [0.01, 0.03, 0.02]),
            },
        ),
        primitive(
            "half_space(normal: (0.3, -0.5, 0.8), offset: 0.2)",
            |p| p.dot(dvec3(0.3, -0.5, 0.8).normalize()) - 0.2,
            Rays {
                // Nearly along the plane, and out of it.
                grazing: ([-0.1, 0.2, 0.4], [5.9, 3.92, 0.496]),
                inside: ([0.0, 0.0, 0.0], [0.4, -0.2, 0.6]),
                symmetric: ([0.6, -1.0, 1.6], [-0.3, 0.5, -0.8]),
                oblique: ([3.0, 2.0, 2.9], [0.0, 0.3, 0.2]),
            },
        ),
        primitive(
            "prism([(-1, -0.8), (1, -0.8), (1, 0.1), (0.2, 0.1), (0.2, 0.9), (-1, 0.9)], height: 0.7,
                holes: [[(-0.7, -0.5), (-0.1, -0.5), (-0.4, 0.4)]])",
            |p| {
                let low = all_of([slab(p.x, -1.0, 1.0), slab(p.y, -0.8, 0.1)]);
                let high = all_of([slab(p.x, -1.0, 0.2), slab(p.y, -0.8, 0.9)]);
                // Sides of slope ± 3 from the base of the hole to its tip.
                let hole = all_of([-0.5 - p.y, p.y + 3.0 * (p.x + 0.4).abs() - 0.4]);
                all_of([low.min(high), -hole, slab(p.z, 0.0, 0.7)])
            },
            Rays {
                grazing: ([0.9, -2.0, 0.3], [1.06, 0.0, 0.4]),
                inside: ([-0.9, 0.2, 0.5], [0.3, -0.2, 0.4]),
                symmetric: ([-3.0, 0.0, 0.35], [1.0, -0.4, 0.35]),
                oblique: ([-2.0, -2.0, 2.0], [-0.3, 0.3, 0.2]),
            },
        ),
        primitive(
            "lathe([(0.8, -0.6), (0.9, 0.5), (0.7, 0.5), (0.5, -0.3)])",
            |p| {
                let outer = axial(p) - 0.8 - 0.1 * (p.z + 0.6) / 1.1;
                let bowl = all_of([axial(p) - 0.5 - 0.2 * (p.z + 0.3) / 0.8, -0.3 - p.z]);
                all_of([outer, slab(p.z, -0.6, 0.5), -bowl])
            },
            Rays {
                grazing: ([-2.0, 0.845, -0.1], [1.0, 0.845, 0.0]),
                inside: ([0.75, 0.1, 0.2], [-0.7, 0.2, 0.25]),
                symmetric: ([-3.0, 0.0, 0.4], [1.0, 0.0, -0.35]),
                oblique: ([1.0, 2.0, 1.9], [0.2, -0.1, -0.2]),
            },
        ),
        primitive(
            "lathe([(0, -1), (0.8, -0.5), (0.6, 0.4), (0.9, 1)], smooth: true)",
            |p| all_of([axial(p) - spline_radius(p.z), slab(p.z, -1.0, 1.0)]),
            Rays {
                // Beside the waist, through both swellings.
                grazing: ([0.0, 0.88, 1.5], [0.0, 0.64, 0.5]),
                inside: ([0.1, 0.2, 0.3], [1.0, 0.3, 0.2]),
                symmetric: ([-2.0, 0.0, -1.4], [0.3, 0.0, 0.0]),
                oblique: ([1.0, 2.0, 1.9], [0.2, -0.1, -0.2]),
            },
        ),
    ]
}

/// Of the spline lathe above: z grows along every cubic, so that it is bisected for the height.
fn spline_radius(z: f64) -> f64 {
    let p = [dvec2(0.0, -1.0), dvec2(0.8, -0.5), dvec2(0.6, 0.4), dvec2(0.9, 1.0)];
    // Half of what the neighbours are apart; across the axis on it; along the last line at the other end.
    let tangents = [dvec2(p[1].x, 0.0), (p[2] - p[0]) / 2.0, (p[3] - p[1]) / 2.0, p[3] - p[2]];
    let i = (0..3).rfind(|&i| p[i].y <= z).unwrap_or(0);
    let hermite = |s: f64| -> DVec2 {
        let (s2, s3) = (s * s, s * s * s);
        p[i] * (2.0 * s3 - 3.0 * s2 + 1.0)
            + tangents[i] * (s3 - 2.0 * s2 + s)
            + p[i + 1] * (3.0 * s2 - 2.0 * s3)
            + tangents[i + 1] * (s3 - s2)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..54 {
        let middle = 0.5 * (low + high);
        *(if hermite(middle).y < z { &mut low } else { &mut high }) = middle;
    }
    hermite(0.5 * (low + high)).x
}

/// An arrow head: an octahedron whose lower tip is pushed in.
const OBJ: &str = "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\nv 0 0 0.25\n\
    f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n";

/// Grey, rows from the top.
const HEIGHTS: [[u8; 3]; 3] = [[30, 200, 90], [255, 0, 160], [70, 120, 10]];

fn faceted() -> Vec<Primitive> {
    vec![
        // A cuboctahedron.
        primitive(
            "polyhedron([(1, 1, 0), (1, -1, 0), (-1, 1, 0), (-1, -1, 0), (0, 1, 1), (0, 1, -1), (0, -1, 1),
                (0, -1, -1), (1, 0, 1), (1, 0, -1), (-1, 0, 1), (-1, 0, -1)])",
            |p| all_of([p.abs().max_element() - 1.0, p.abs().element_sum() - 2.0]),
            Rays {
                // Across an edge.
                grazing: ([0.99, -2.0, 2.5], [0.98, 0.5, 0.51]),
                inside: ([0.1, 0.2, 0.3], [1.0, 0.3, 0.2]),
                symmetric: ([-2.0, 0.0, 1.6], [0.3, 0.0, 0.0]),
                oblique: ([3.0, 2.0, 2.9], [0.2, -0.1, -0.2]),
            },
        ),
        primitive(
            "mesh_solid(\"arrow.obj\")",
            |p| {
                let left = 1.0 - p.x.abs() - p.y.abs();
                all_of([p.z - left, 0.25 * left - p.z])
            },
            Rays {
                grazing: ([-2.0, 0.01, 0.95], [1.0, 0.01, 0.96]),
                inside: ([0.1, 0.2, 0.5], [1.0, 0.3, -0.2]),
                // Along the two edges of the dent, on both sides of it.
                symmetric: ([-2.0, 0.0, 0.15], [1.0, 0.0, 0.1]),
                oblique: ([3.0, 2.0, 2.9], [0.2, -0.1, 0.3]),
            },
        ),
        primitive(
            "height_field(\"heights.png\", size: (2, 4, 1))",
            |p| {
                let (x, y) = (p.x.clamp(0.0, 2.0), (p.y / 2.0).clamp(0.0, 2.0));
                let (i, j) = (x.floor().min(1.0), y.floor().min(1.0));
                // Vertices are single precision; rows of the image go down, y goes up.
                let h = |i: usize, j: usize| f64::from((f64::from(HEIGHTS[2 - j][i]) / 255.0) as f32);
                let (u, v, i, j) = (x - i, y - j, i as usize, j as usize);
                let (low, high) = (h(i, j), h(i + 1, j + 1));
                let corner = if u >= v { h(i + 1, j) } else { h(i, j + 1) };
                // Along the diagonal to the middle corner, then on.
                let top = low + (corner - low) * u.max(v) + (high - corner) * u.min(v);
                all_of([slab(p.x, 0.0, 2.0), slab(p.y, 0.0, 4.0), p.z - top, -1.0 / 16.0 - p.z])
            },
            Rays {
                // Through the hill at the left edge.
                grazing: ([-0.5, 1.7, 0.95], [0.5, 2.3, 0.9]),
                inside: ([0.3, 2.2, 0.1], [1.9, 3.3, 0.2]),
                // Above a line of vertices.
                symmetric: ([-1.0, 2.0, 0.7], [2.0, 2.0, 0.3]),
                oblique: ([3.0, 5.0, 2.9], [0.9, 1.7, 0.1]),
            },
        ),
    ]
}

fn write_files(folder: &Path) {
    std::fs::write(folder.join("arrow.obj"), OBJ).unwrap();
    let mut encoder = png::Encoder::new(std::fs::File::create(folder.join("heights.png")).unwrap(), 3, 3);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(HEIGHTS.as_flattened()).unwrap();
}

/// One run of the command: differences as text, and how many normals were compared.
fn differences(folder: &Path, primitive: &Primitive) -> (String, usize) {
    let Primitive { script, f, rays } = primitive;
    let path = folder.join("primitive.arsl");
    std::fs::write(&path, format!("scene {{\n{script}\n}}\n")).unwrap();
    let all = [rays.grazing, rays.inside, rays.symmetric, rays.oblique].map(|(from, to)| {
        let from = DVec3::from_array(from);
        (from, DVec3::from_array(to) - from)
    });
    let mut input = String::new();
    for (o, d) in all {
        writeln!(input, "{},{},{},{},{},{}", o.x, o.y, o.z, d.x, d.y, d.z).unwrap();
    }
    let run = arsc_with_input(&["probe", path.to_str().unwrap(), "--rays", "-"], &input);
    assert_eq!(run.status.code(), Some(0), "{script}: {}", stderr(&run));
    let rows: Vec<Vec<f64>> = stdout(&run)
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
        .collect();

    let (mut text, mut normals) = (String::new(), 0);
    for (number, (origin, dir)) in all.into_iter().enumerate() {
        let expected = stretches(f, origin, dir);
        let kind = ["grazing", "inside", "symmetric", "oblique"][number];
        let is_fit = match kind {
            "grazing" => expected.iter().any(|(enter, exit)| exit - enter < 0.5),
            "inside" => expected.first().is_some_and(|stretch| stretch.0 == 0.0),
            _ => !expected.is_empty(),
        };
        assert!(is_fit, "{script}: the {kind} ray is none: {expected:?}");
        let found: Vec<&Vec<f64>> = rows.iter().filter(|row| row[0] == number as f64).collect();
        let ends: Vec<(f64, f64)> = found.iter().map(|row| (row[1], row[2])).collect();
        let is_near = |a: f64, b: f64| a == b || (a - b).abs() < TOLERANCE;
        let agree = |(a, b): (&(f64, f64), &(f64, f64))| is_near(a.0, b.0) && is_near(a.1, b.1);
        if ends.len() != expected.len() || !ends.iter().zip(&expected).all(agree) {
            writeln!(text, "{script}, {kind}: {ends:?} instead of {expected:?}").unwrap();
            continue;
        }
        for (row, (enter, exit)) in found.iter().zip(expected) {
            for (t, column) in [(enter, 5), (exit, 8)].into_iter().filter(|(t, _)| *t > 0.0 && t.is_finite()) {
                let printed = DVec3::from_slice(&row[column..column + 3]);
                let Some(outwards) = normal(f, origin + dir * t) else { continue };
                normals += 1;
                if printed.is_nan() || printed.distance(outwards) > 1e-4 {
                    writeln!(text, "{script}, {kind}: normal {printed} instead of {outwards} at {t}").unwrap();
                }
            }
        }
    }
    (text, normals)
}

#[test]
fn every_primitive_is_its_inequality() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let all = quadrics().into_iter().chain(others()).chain(faceted());
    let (texts, normals): (Vec<String>, Vec<usize>) =
        all.map(|primitive| differences(folder.path(), &primitive)).unzip();
    let text = texts.concat();
    assert!(text.is_empty(), "\n{text}");
    let normals: usize = normals.into_iter().sum();
    assert!(normals > 160, "only {normals} normals are off creases");
}
