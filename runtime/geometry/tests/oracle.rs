//! Every intersector against exact arithmetic, on lines that mean no good.
//!
//! The criterion is a sandwich. With `B = K · 2⁻⁵³ · (|origin| + size + |t dir|)` and K as in [`BOUNDS`], the crossings found
//! must hold all of the line that is inside of the shape shrunk by B, and nothing that is outside of the shape grown by B, both
//! computed in 320 bits. So no chord is missed that goes deeper than B, none is invented, the parity is right, and every
//! crossing lies within B of the true surface; along the line that is B over the sine of the angle between line and surface. There is no
//! excuse for grazing lines.
//!
//! Families: lines through the neighbourhood; tangents at a random surface point, moved off or into the surface by 10⁻¹⁸ to 10⁻¹
//! of the size; lines parallel to an axis or within a coordinate plane, at the heights of caps, rims and centres; lines through
//! such points; nearly parallel ones; origins on the surface; origins up to 10⁸ sizes away; directions of length 10⁻³ to 10³.

mod exact;

use arsc_geometry::{Crossings, DAffine3, DVec3, Hyperboloid, Paraboloid, Placed, Shape};
use exact::{Big, Line, LineSet, Poly, between, big};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// Shapes, and K for their kind.
fn shapes() -> Vec<(Shape, f64)> {
    let cone = |base_radius, top_radius, height| Shape::Cone { base_radius, top_radius, height };
    let torus = |major: f64, minor: f64| (Shape::Torus { major, minor }, 8.0 + major / minor);
    let hyperboloid = |radius, slope, half_height, two_sheets| {
        Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets })
    };
    vec![
        (Shape::Sphere { radius: 0.7 }, 8.0),
        (Shape::Box { min: DVec3::new(-0.5, -0.2, 0.1), max: DVec3::new(0.6, 0.9, 0.8) }, 8.0),
        (Shape::Cylinder { radius: 0.4, height: 1.3 }, 8.0),
        (Shape::Cylinder { radius: 2.0, height: 1e-3 }, 8.0),
        (Shape::InfiniteCylinder { radius: 0.5 }, 8.0),
        (cone(0.8, 0.0, 1.1), 8.0),
        (cone(0.0, 0.6, 0.7), 8.0),
        (cone(0.5, 0.3, 0.9), 8.0),
        (cone(3.0, 0.1, 0.05), 8.0),
        torus(1.0, 0.3),
        torus(1.0, 0.06),
        torus(1.0, 1e-3),
        torus(0.5, 0.5),
        torus(0.4, 0.7),
        torus(0.01, 0.7),
        (Shape::HalfSpace, 8.0),
        (Shape::Paraboloid(Paraboloid { radius: 0.8, height: 1.2 }), 8.0),
        (Shape::Paraboloid(Paraboloid { radius: 0.1, height: 2.0 }), 8.0),
        (Shape::Paraboloid(Paraboloid { radius: 2.0, height: 0.1 }), 8.0),
        (hyperboloid(0.4, 0.6, 1.0, false), 8.0),
        (hyperboloid(0.01, 1.0, 1.0, false), 8.0),
        (hyperboloid(0.4, 0.6, 1.0, true), 8.0),
        (hyperboloid(0.01, 3.0, 1.0, true), 8.0),
    ]
}

/// Heights and radii at which something happens.
fn marks(shape: &Shape) -> Vec<f64> {
    match *shape {
        Shape::Sphere { radius } | Shape::InfiniteCylinder { radius } => vec![0.0, radius, -radius],
        Shape::Box { min, max } => [min.to_array(), max.to_array()].concat(),
        Shape::Cylinder { radius, height } => vec![0.0, radius, -radius, height, 0.5 * height],
        Shape::Cone { base_radius, top_radius, height } => {
            vec![0.0, base_radius, -base_radius, top_radius, height, 0.5 * height]
        }
        Shape::Torus { major, minor } => {
            let lens = (minor * minor - major * major).max(0.0).sqrt();
            vec![0.0, major, minor, -minor, major + minor, major - minor, 0.5 * minor, -0.9 * minor, lens, -lens]
        }
        Shape::Paraboloid(Paraboloid { radius, height }) => vec![0.0, radius, height, 0.5 * height],
        Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, .. }) => {
            vec![0.0, radius, half_height, -half_height, radius / slope, slope * half_height]
        }
        _ => vec![0.0],
    }
}

/// The line's part inside of the shape grown by `by` (shrunk where negative).
fn exact_set(shape: &Shape, line: &Line, by: &Big) -> LineSet {
    let square = |x: &Big| Poly::constant(x * x);
    let zero = big(0.0);
    let never = LineSet { before: false, ends: vec![] };
    match *shape {
        Shape::Sphere { radius } => match big(radius) + by {
            r if r <= zero => never,
            r => line.square().minus(&square(&r)).not_positive(),
        },
        Shape::Box { min, max } => [(&line.x, min.x, max.x), (&line.y, min.y, max.y), (&line.z, min.z, max.z)]
            .into_iter()
            .map(|(p, low, high)| between(p, &(big(low) - by), &(big(high) + by)))
            .fold(LineSet::everything(), |set, slab| set.and(&slab)),
        Shape::InfiniteCylinder { radius } => match big(radius) + by {
            r if r <= zero => never,
            r => line.ring().minus(&square(&r)).not_positive(),
        },
        Shape::Cylinder { radius, height } => {
            let side = exact_set(&Shape::InfiniteCylinder { radius }, line, by);
            side.and(&line.slab(&-by.clone(), &(big(height) + by)))
        }
        Shape::Cone { base_radius, top_radius, height } => {
            // Radius at z, and how much of it the offset along the normal is.
            let slope = (big(top_radius) - big(base_radius)) / big(height);
            let across = big((1.0 + ((top_radius - base_radius) / height).powi(2)).sqrt()) * by;
            let radius = line.z.scaled(&slope).plus(&Poly::constant(big(base_radius) + across));
            let side = line.ring().minus(&radius.squared()).not_positive();
            let nappe = radius.scaled(&big(-1.0)).not_positive();
            side.and(&nappe).and(&line.slab(&-by.clone(), &(big(height) + by)))
        }
        Shape::Torus { major, minor } => match big(minor) + by {
            r if r <= zero => never,
            r => {
                // (ρ − R)² + z² <= r²  ⇔  w <= 2 R ρ  with  w = |p|² + R² − r²
                let (major, minor) = (big(major), r);
                let w = line.square().plus(&square(&major)).minus(&square(&minor));
                let tube = w.squared().minus(&line.ring().scaled(&(big(4.0) * &major * &major))).not_positive();
                if minor > major { tube.or(&w.not_positive()) } else { tube }
            }
        },
        Shape::Paraboloid(Paraboloid { radius, height }) => {
            let latus = big(radius) * big(radius) / big(height);
            let steepest = big((4.0 * radius * radius + (radius * radius / height).powi(2)).sqrt());
            let level = line.ring().minus(&line.z.scaled(&latus)).minus(&Poly::constant(by * steepest));
            level.not_positive().and(&line.z.minus(&Poly::constant(big(height) + by)).not_positive())
        }
        Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets }) => {
            let steep = big(slope) * big(slope);
            let offset = big(radius) * big(radius) * big(if two_sheets { -1.0 } else { 1.0 });
            let cap = (slope * half_height).powi(2) + radius * radius;
            let steepest = big(2.0 * (cap + (slope * slope * half_height).powi(2)).sqrt());
            let level = line.ring().minus(&line.z.squared().scaled(&steep));
            let side = level.minus(&Poly::constant(offset + by * steepest)).not_positive();
            let end = big(half_height) + by;
            side.and(&line.slab(&-end.clone(), &end))
        }
        Shape::HalfSpace => line.z.minus(&Poly::constant(by.clone())).not_positive(),
        #[allow(unreachable_patterns)]
        ref other => panic!("no oracle for {other:?}"),
    }
}

fn vector(rng: &mut Pcg64, reach: f64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| rng.random_range(-reach..reach)))
}

/// A number from `low` to 1 in the logarithm, of either sign.
fn tiny(rng: &mut Pcg64, low: f64) -> f64 {
    let size = 10f64.powf(rng.random_range(low.log10()..0.0));
    if rng.random() { size } else { -size }
}

fn on_surface(shape: &Shape, rng: &mut Pcg64) -> (DVec3, DVec3) {
    let placed = Placed::new(shape.clone(), DAffine3::IDENTITY).expect("valid");
    match placed.sample_area([rng.random(), rng.random()]) {
        Some(sample) => (sample.point.p, sample.point.n),
        None => {
            let p = vector(rng, 2.0);
            match *shape {
                Shape::InfiniteCylinder { radius } => {
                    let out = DVec3::new(p.x, p.y, 0.0).normalize();
                    (out * radius + DVec3::Z * p.z, out)
                }
                _ => (DVec3::new(p.x, p.y, 0.0), DVec3::Z),
            }
        }
    }
}

/// A point all of whose coordinates are marks, or on a rim or axis of such.
fn marked_point(shape: &Shape, rng: &mut Pcg64) -> DVec3 {
    let marks = marks(shape);
    let mut pick = || marks[rng.random_range(0..marks.len())];
    let p = DVec3::new(pick(), pick(), pick());
    match rng.random_range(0..3) {
        0 => p,
        1 => DVec3::new(0.0, 0.0, p.z),
        _ => {
            let angle = rng.random_range(0.0..std::f64::consts::TAU);
            DVec3::new(p.x * angle.cos(), p.x * angle.sin(), p.z)
        }
    }
}

fn random_line(shape: &Shape, size: f64, rng: &mut Pcg64) -> (DVec3, DVec3) {
    let (origin, dir) = match rng.random_range(0..10) {
        0 | 1 => (vector(rng, 3.0 * size), vector(rng, 1.0)),
        2..=4 => {
            let (p, n) = on_surface(shape, rng);
            let tangent = n.cross(vector(rng, 1.0)).normalize_or(n.any_orthonormal_vector());
            let depth = tiny(rng, 1e-18) * 0.1 * size;
            (p + n * depth - tangent * rng.random_range(-3.0..3.0) * size, tangent)
        }
        5 => {
            // Within a coordinate plane, at a mark; sometimes along an axis.
            let mut origin = marked_point(shape, rng);
            let axis = rng.random_range(0..3);
            let mut dir = vector(rng, 1.0);
            dir[axis] = 0.0;
            if rng.random() {
                dir[(axis + 1) % 3] = 0.0;
            }
            origin += dir * rng.random_range(-3.0..3.0) * size;
            (origin, dir)
        }
        6 => {
            // At any height within reach, parallel to the plane, or all but.
            let mut dir = vector(rng, 1.0);
            dir.z = if rng.random() { 0.0 } else { tiny(rng, 1e-300) };
            (vector(rng, 1.2 * size), dir)
        }
        7 => {
            let p = marked_point(shape, rng);
            let origin = vector(rng, 3.0 * size);
            (origin, p - origin)
        }
        8 => (on_surface(shape, rng).0, vector(rng, 1.0)),
        _ => {
            let origin = vector(rng, 1.0) * size * 10f64.powf(rng.random_range(0.0..8.0));
            (origin, vector(rng, size) - origin)
        }
    };
    if dir == DVec3::ZERO {
        return random_line(shape, size, rng);
    }
    (origin, dir.normalize() * 10f64.powf(rng.random_range(-3.0..3.0)))
}

fn sandwiched(shape: &Shape, line: &Line, found: &LineSet, by: f64) -> bool {
    exact_set(shape, line, &big(-by)).is_within(found) && found.is_within(&exact_set(shape, line, &big(by)))
}

/// `B / K`.
fn unit_of_error(shape: &Shape, origin: DVec3, dir: DVec3, found: &Crossings) -> f64 {
    let farthest = found.t().iter().map(|t| t.abs()).fold(0.0, f64::max);
    0.5 * f64::EPSILON * (origin.length() + shape.magnitude() + farthest * dir.length())
}

/// Least power of two that serves as K.
fn needed(shape: &Shape, origin: DVec3, dir: DVec3, most: f64) -> f64 {
    let found = shape.crossings(origin, dir);
    assert!(found.t().is_sorted(), "{shape:?} {origin:?} {dir:?}: {found:?}");
    let set = LineSet::from_doubles(found.inside_before, found.t());
    let (line, unit) = (Line::new(origin, dir), unit_of_error(shape, origin, dir, &found));
    let mut k = 1.0;
    while k <= most && !sandwiched(shape, &line, &set, k * unit) {
        k *= 2.0;
    }
    k
}

fn check(lines: usize, seed: u64) {
    let mut failures = Vec::new();
    for (number, (shape, bound)) in shapes().into_iter().enumerate() {
        let mut rng = Pcg64::seed_from_u64(seed + number as u64);
        let size = shape.magnitude().max(1e-3);
        let mut worst: f64 = 0.0;
        let mut crossed = 0;
        for _ in 0..lines {
            let (origin, dir) = random_line(&shape, size, &mut rng);
            let k = needed(&shape, origin, dir, 1e9);
            crossed += usize::from(!shape.crossings(origin, dir).is_empty());
            if k > worst {
                worst = k;
                if k > bound {
                    failures.push(format!(
                        "{shape:?}: needs K = {k}: {origin:?} {dir:?} {:?}",
                        shape.crossings(origin, dir)
                    ));
                }
            }
        }
        println!("{shape:?}: {lines} lines, {crossed} meet it, K = {worst}");
        assert!(crossed * 4 > lines, "{shape:?} is met by {crossed} of {lines} lines");
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn crossings_are_within_their_bound() {
    check(150, 1);
}

/// Lines within planes across the axis, above, in and below the middle: circles of radius R ± √(r² − z²).
#[test]
fn tori_are_met_by_lines_parallel_to_their_plane() {
    for (major, minor) in [(1.0, 0.25), (1.0, 0.06), (0.5, 0.5), (0.4, 0.7)] {
        for i in -19..=19 {
            let z = f64::from(i) / 20.0 * minor;
            let half = (minor * minor - z * z).sqrt();
            let (outer, inner) = (major + half, (major - half).max(0.0));
            for offset in [0.0, 0.3 * outer, 0.9 * outer] {
                let chord = |radius: f64| (radius * radius - offset * offset).max(0.0).sqrt();
                let (far, near) = (chord(outer), chord(inner));
                let expected = if near > 0.0 { vec![-far, -near, near, far] } else { vec![-far, far] };
                let found = Shape::Torus { major, minor }.crossings(DVec3::new(offset, 0.0, z), DVec3::Y);
                let close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-13;
                assert!(
                    found.len() == expected.len() && found.t().iter().zip(&expected).all(close),
                    "{major} {minor} at z = {z}, {offset} beside the axis: {found:?} instead of {expected:?}"
                );
            }
        }
    }
}

/// 20 000 lines per shape; some minutes.
#[test]
#[ignore = "long: run with --release -- --ignored"]
fn crossings_are_within_their_bound_at_length() {
    check(20_000, 1000);
}

/// The quadratic has a double root at the tip, and half of the lines through it go on inside.
#[test]
fn cones_are_met_by_lines_through_their_tip() {
    let mut rng = Pcg64::seed_from_u64(5);
    for (base_radius, top_radius) in [(0.8, 0.0), (0.0, 0.6)] {
        let shape = Shape::Cone { base_radius, top_radius, height: 1.1 };
        let tip = DVec3::new(0.0, 0.0, if top_radius == 0.0 { 1.1 } else { 0.0 });
        for _ in 0..200 {
            let mut dir = vector(&mut rng, 1.0).normalize();
            if rng.random() {
                dir = DVec3::new(0.0, dir.y, dir.z).normalize();
            }
            let origin = tip + dir * rng.random_range(-3.0..3.0);
            let k = needed(&shape, origin, dir, 1e9);
            assert!(k <= 8.0, "{shape:?}: needs K = {k}: {origin:?} {dir:?} {:?}", shape.crossings(origin, dir));
        }
    }
}
