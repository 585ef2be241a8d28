//! Every shape under random affine maps: crossings, bounds, classification, normals and area against membership.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use arsc_geometry::{
    Aabb, Classification, DAffine3, DMat3, DVec2, DVec3, Hyperboloid, Lathe, Paraboloid, Placed, Polygon, Polyhedron,
    Prism, Shape, Superquadric,
};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// One of each kind, tori in all three forms, cones with and without a tip.
fn shapes() -> Vec<Shape> {
    vec![
        Shape::Sphere { radius: 0.7 },
        Shape::Box { min: DVec3::new(-0.5, -0.2, 0.1), max: DVec3::new(0.6, 0.9, 0.8) },
        Shape::Cylinder { radius: 0.4, height: 1.3 },
        Shape::InfiniteCylinder { radius: 0.5 },
        Shape::Cone { base_radius: 0.8, top_radius: 0.0, height: 1.1 },
        Shape::Cone { base_radius: 0.0, top_radius: 0.6, height: 0.7 },
        Shape::Cone { base_radius: 0.5, top_radius: 0.3, height: 0.9 },
        Shape::Cone { base_radius: 3.0, top_radius: 0.1, height: 0.05 },
        Shape::Torus { major: 1.0, minor: 0.3 },
        Shape::Torus { major: 1.0, minor: 0.01 },
        Shape::Torus { major: 0.5, minor: 0.5 },
        Shape::Torus { major: 0.4, minor: 0.7 },
        Shape::Torus { major: 0.01, minor: 0.7 },
        Shape::HalfSpace,
        Shape::Paraboloid(Paraboloid { radius: 0.7, height: 1.2 }),
        Shape::Paraboloid(Paraboloid { radius: 1.5, height: 0.02 }),
        hyperboloid(0.3, 0.8, 0.7, false),
        hyperboloid(0.01, 1.5, 0.5, false),
        hyperboloid(0.3, 0.9, 0.8, true),
        hyperboloid(0.02, 0.4, 0.9, true),
        superquadric(1.0, 1.0),
        superquadric(0.3, 1.5),
        superquadric(0.05, 0.05),
        superquadric(2.0, 2.0),
        superquadric(2.5, 1.0),
        superquadric(0.5, 3.0),
        superquadric(3.0, 3.0),
        lathe(&[(0.0, -0.6), (0.5, -0.6), (0.2, 0.1), (0.7, 0.5), (0.0, 0.8)], false, false),
        lathe(&[(0.3, -0.6), (0.6, -0.1), (0.4, 0.7)], false, false),
        lathe(&[(0.0, -0.6), (0.6, -0.3), (0.1, 0.2), (0.5, 0.7)], false, true),
        lathe(&[(0.4, -0.3), (0.9, -0.2), (0.8, 0.4), (0.5, 0.1)], true, false),
        lathe(&[(0.0, -0.7), (0.6, -0.5), (0.25, 0.0), (0.5, 0.5), (0.0, 0.8)], false, true),
        lathe(&[(0.4, -0.3), (0.9, -0.2), (0.8, 0.4), (0.5, 0.2)], true, true),
        plate(),
        star(7, 0.4),
        star(1000, 0.8),
        gem(),
        ball_of_points(150),
    ]
}

fn hyperboloid(radius: f64, slope: f64, half_height: f64, two_sheets: bool) -> Shape {
    Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets })
}

fn superquadric(e1: f64, e2: f64) -> Shape {
    Shape::Superquadric(Arc::new(Superquadric::new(e1, e2).unwrap()))
}

fn lathe(points: &[(f64, f64)], closed: bool, smooth: bool) -> Shape {
    let points = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    Shape::Lathe(Arc::new(Lathe::new(points, closed, smooth).unwrap()))
}

/// An L with a square hole, the corners clockwise.
fn plate() -> Shape {
    let ring = |corners: &[(f64, f64)]| corners.iter().map(|&(x, y)| DVec2::new(x, y)).collect::<Vec<_>>();
    let outline = ring(&[(-0.8, -0.8), (-0.8, 0.9), (0.1, 0.9), (0.1, 0.02), (0.7, 0.02), (0.7, -0.8)]);
    let hole = ring(&[(-0.5, -0.5), (-0.1, -0.5), (-0.1, 0.4), (-0.5, 0.4)]);
    Shape::Prism(Arc::new(Prism::new(Polygon::new(vec![outline, hole]).unwrap(), 0.6).unwrap()))
}

fn star(points: u32, inner: f64) -> Shape {
    let corner = |i: u32| {
        // Turned, so that no line in a coordinate plane meets a concave corner, where a normal leads into the solid.
        let angle = 0.123 + f64::from(i) * TAU / f64::from(2 * points);
        DVec2::from_angle(angle) * if i.is_multiple_of(2) { 0.9 } else { inner }
    };
    let ring = (0..2 * points).map(corner).collect();
    Shape::Prism(Arc::new(Prism::new(Polygon::new(vec![ring]).unwrap(), 0.5).unwrap()))
}

fn gem() -> Shape {
    let points =
        [(0.0, 0.0, 1.0), (0.7, 0.1, 0.2), (-0.2, 0.8, 0.1), (-0.6, -0.5, 0.3), (0.3, -0.7, -0.1), (0.1, 0.2, -0.9)];
    Shape::Polyhedron(Arc::new(Polyhedron::new(points.map(|(x, y, z)| DVec3::new(x, y, z)).to_vec()).unwrap()))
}

/// Flattened, with the points of one side in a plane.
fn ball_of_points(n: u32) -> Shape {
    let point = |i: u32| {
        let (z, angle) = (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0, f64::from(i) * 2.399_963);
        let ring = (1.0 - z * z).sqrt();
        DVec3::new(ring * angle.cos(), ring * angle.sin() * 0.7, z.min(0.5))
    };
    Shape::Polyhedron(Arc::new(Polyhedron::new((0..n).map(point).collect()).unwrap()))
}

fn random_vector(rng: &mut Pcg64) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
}

/// Rotations, mirrored and sheared maps, at three scales.
fn random_map(rng: &mut Pcg64) -> DAffine3 {
    let scale = [1e-3, 1.0, 1e6][rng.random_range(0..3)];
    let mut matrix = DMat3::from_axis_angle(random_vector(rng).normalize(), rng.random_range(0.0..TAU));
    match rng.random_range(0..4) {
        0 => {}
        1 => matrix = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)) * matrix,
        2 => matrix = DMat3::from_diagonal(DVec3::new(0.5, 2.0, -1.5)) * matrix,
        _ => {
            let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.8, 1.0, 0.0), DVec3::new(-0.3, 0.6, 1.2));
            matrix = shear * matrix;
        }
    }
    DAffine3 { matrix3: matrix * scale, translation: random_vector(rng) * scale * 3.0 }
}

/// A line through the neighbourhood of the shape; one in four lies in a coordinate plane or along an axis of the shape.
fn random_line(placed: &Placed, rng: &mut Pcg64) -> (DVec3, DVec3) {
    let mut origin = random_vector(rng) * 3.0;
    let mut dir = random_vector(rng).normalize();
    match rng.random_range(0..8) {
        0 => {
            let axis = rng.random_range(0..3);
            origin[axis] = [0.0, 0.05, 0.3][rng.random_range(0..3)];
            dir[axis] = 0.0;
        }
        1 => dir = DVec3::AXES[rng.random_range(0..3)],
        _ => dir = (random_vector(rng) - origin).normalize(),
    }
    let map = placed.world_from_object();
    (map.transform_point3(origin), map.transform_vector3(dir).normalize())
}

/// Every shape × 12 maps × 300 lines × 24 points; points within 1e-9 of a crossing, relative to the distance, are left out.
#[test]
fn crossings_agree_with_membership() {
    let mut rng = Pcg64::seed_from_u64(1);
    let (mut checked, mut skipped, mut crossed) = (0u32, 0u32, 0u32);
    for shape in shapes() {
        for _ in 0..12 {
            let placed = Placed::new(shape.clone(), random_map(&mut rng)).unwrap();
            let size = placed.world_from_object().matrix3.x_axis.length();
            for _ in 0..300 {
                let (origin, dir) = random_line(&placed, &mut rng);
                let crossings = placed.crossings(origin, dir);
                assert!(crossings.t().is_sorted(), "{shape:?} {crossings:?}");
                assert_eq!(
                    crossings.len().is_multiple_of(2) && !crossings.inside_before,
                    shape_is_finite_here(&placed, &crossings)
                );
                crossed += crossings.len() as u32;
                for _ in 0..24 {
                    let t = rng.random_range(-2.0..6.0) * size;
                    if crossings.t().iter().any(|root| (root - t).abs() < 1e-9 * size) {
                        skipped += 1;
                        continue;
                    }
                    let p = origin + dir * t;
                    let inside = placed.contains(p);
                    if inside != crossings.inside_after(t) {
                        // Allowed only on the surface itself: a line within a face, or a tangent.
                        let n = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
                        let near = n.iter().any(|n| placed.contains(p + *n * (1e-8 * size)) != inside);
                        assert!(near, "{shape:?} at t = {t}: {p} inside {inside}, {crossings:?}");
                        skipped += 1;
                    }
                    checked += 1;
                }
            }
        }
    }
    assert!(crossed > 20_000, "lines miss: {crossed}");
    assert!(f64::from(skipped) < 5e-3 * f64::from(checked), "{skipped} of {checked} near the surface");
}

fn shape_is_finite_here(placed: &Placed, crossings: &arsc_geometry::Crossings) -> bool {
    match placed.shape() {
        Shape::HalfSpace => crossings.is_empty() && !crossings.inside_before,
        Shape::InfiniteCylinder { .. } => !crossings.inside_before,
        _ => true,
    }
}

#[test]
fn surface_points_are_on_the_surface_with_outward_normals() {
    let mut rng = Pcg64::seed_from_u64(2);
    for shape in shapes() {
        for _ in 0..40 {
            let placed = Placed::new(shape.clone(), random_map(&mut rng)).unwrap();
            let size = placed.world_from_object().matrix3.x_axis.length();
            for _ in 0..40 {
                let (origin, dir) = random_line(&placed, &mut rng);
                if placed.object_from_world().transform_vector3(dir).z.abs() < 1e-9 * dir.length() / size {
                    continue; // May lie within a cap, where the surface has two normals.
                }
                // An infinite cylinder is met arbitrarily far away by nearly parallel lines.
                for (t, face) in placed.crossings(origin, dir).iter().filter(|(t, _)| t.abs() < 100.0 * size) {
                    let s = placed.surface(origin + dir * t, face);
                    let local = placed.object_from_world().transform_point3(s.p);
                    if matches!(shape, Shape::Superquadric(_)) && local.abs().min_element() < 1e-9 {
                        continue; // Edges of rhombic ones.
                    }
                    assert!((s.p - (origin + dir * t)).length() < 1e-7 * size * (1.0 + t.abs() / size), "{shape:?}");
                    assert!((s.n.length() - 1.0).abs() < 1e-12 && s.n.dot(s.dpdu).abs() < 1e-12);
                    let step = s.p_error * 4.0;
                    assert!(step < 1e-10 * (size + s.p.length()), "{shape:?}: error bound {}", s.p_error);
                    let feature = 1e-6 * size;
                    assert!(!placed.contains(s.p + s.n * step) || !placed.contains(s.p + s.n * feature), "{shape:?}");
                    assert!(placed.contains(s.p - s.n * step) || placed.contains(s.p - s.n * feature), "{shape:?}");
                }
            }
        }
    }
}

/// The support of the bounds is attained, and no inside point lies beyond.
#[test]
fn bounds_hold_the_shape_tightly() {
    let mut rng = Pcg64::seed_from_u64(3);
    for shape in shapes().into_iter().filter(Shape::is_bounded) {
        for _ in 0..10 {
            let placed = Placed::new(shape.clone(), random_map(&mut rng)).unwrap();
            let bounds = *placed.bounds();
            let mut hull = Aabb::EMPTY;
            for _ in 0..4000 {
                let p = placed.sample_area([rng.random(), rng.random()]).unwrap().point.p;
                assert!(bounds.contains(p), "{shape:?}: {p} beyond {bounds:?}");
                hull = hull.union(&Aabb::new(p, p));
            }
            let loose = ((bounds.extent() - hull.extent()) / bounds.extent()).max_element();
            assert!(loose < 0.12, "{shape:?}: bounds loose by {loose}");
        }
    }
}

/// Never a wrong proof; and proofs are found: of the random boxes that hold no surface nine in ten are decided.
#[test]
fn classification_is_conservative_and_useful() {
    let mut rng = Pcg64::seed_from_u64(4);
    for shape in shapes() {
        let (mut pure, mut decided) = (0, 0);
        for _ in 0..20 {
            let placed = Placed::new(shape.clone(), random_map(&mut rng)).unwrap();
            let map = *placed.world_from_object();
            let size = map.matrix3.x_axis.length();
            for _ in 0..60 {
                let center = map.transform_point3(random_vector(&mut rng) * 1.5);
                let half = (random_vector(&mut rng).abs() + 0.02) * size * rng.random_range(0.01..0.3);
                let cell = Aabb::new(center - half, center + half);
                let points: Vec<bool> = (0..200)
                    .map(|i| if i < 8 { cell.corners()[i] } else { center + random_vector(&mut rng) * half })
                    .map(|p| placed.contains(p))
                    .collect();
                let (all, none) = (points.iter().all(|&x| x), points.iter().all(|&x| !x));
                match placed.classify(&cell) {
                    Classification::Outside => assert!(none, "{shape:?} {cell:?} is not outside"),
                    Classification::Inside => assert!(all, "{shape:?} {cell:?} is not inside"),
                    Classification::Boundary => {
                        pure += u32::from(all || none);
                        continue;
                    }
                }
                pure += 1;
                decided += 1;
            }
        }
        assert!(decided * 10 > pure * 9, "{shape:?}: {decided} of {pure} decided");
    }
}

/// Mean of 1 / pdf over samples is the area: 20 000 samples; the error of the mean is below one per cent for these maps
/// by more than six standard deviations.
#[test]
fn area_and_its_density_agree() {
    let mut rng = Pcg64::seed_from_u64(5);
    for shape in shapes().into_iter().filter(Shape::is_bounded) {
        for _ in 0..4 {
            let placed = Placed::new(shape.clone(), random_map(&mut rng)).unwrap();
            let n = 20_000;
            let mut sum = 0.0;
            for _ in 0..n {
                let sample = placed.sample_area([rng.random(), rng.random()]).unwrap();
                assert!(
                    (placed.pdf_area(sample.point.p, sample.point.n) - sample.pdf_area).abs() <= 1e-9 * sample.pdf_area
                );
                sum += 1.0 / sample.pdf_area;
            }
            let area = placed.area();
            let error = (sum / f64::from(n) - area).abs() / area;
            assert!(error < 0.02, "{shape:?}: area {area}, error {error}");
        }
    }
    let sphere = Placed::new(Shape::Sphere { radius: 2.0 }, DAffine3::from_scale(DVec3::splat(3.0))).unwrap();
    assert!((sphere.area() - 4.0 * PI * 36.0).abs() < 1e-9);
    let ring = Shape::Torus { major: 3.0, minor: 0.5 };
    assert!((ring.area() - 4.0 * PI * PI * 1.5).abs() < 1e-12);
}

/// The samples' mean of z² on a unit sphere, and of the radius on a torus, against the integrals; 40 000 samples each,
/// bounds above six standard errors.
#[test]
fn samples_are_uniform() {
    let mut rng = Pcg64::seed_from_u64(6);
    let n = 40_000;
    let mut mean = |shape: Shape, value: fn(DVec3) -> f64| {
        let placed = Placed::new(shape, DAffine3::IDENTITY).unwrap();
        (0..n).map(|_| value(placed.sample_area([rng.random(), rng.random()]).unwrap().point.p)).sum::<f64>()
            / f64::from(n)
    };
    assert!((mean(Shape::Sphere { radius: 1.0 }, |p| p.z * p.z) - 1.0 / 3.0).abs() < 0.01);
    // ∫ (R + r cos a)² da / ∫ (R + r cos a) da = R + r² / (2 R)
    assert!((mean(Shape::Torus { major: 1.0, minor: 0.5 }, |p| p.truncate().length()) - 1.125).abs() < 0.015);
    // A full cone's side has its centroid at a third of the height; the base adds z = 0 in proportion of the areas.
    let side = PI * 2f64.sqrt();
    let expected = side / 3.0 / (side + PI);
    assert!((mean(Shape::Cone { base_radius: 1.0, top_radius: 0.0, height: 1.0 }, |p| p.z) - expected).abs() < 0.01);
}

/// Isotropic random lines through a sphere cross a surface at points uniform over it, twice its area over the sphere's
/// times a line (Cauchy and Crofton). So areas, of single faces too, and moments of samples are checked against crossings:
/// 12 000 lines and samples a shape, 14 statistics, bounds of six standard errors.
#[test]
fn areas_and_samples_agree_with_random_lines() {
    let mut rng = Pcg64::seed_from_u64(7);
    for shape in shapes().into_iter().filter(Shape::is_bounded) {
        let placed = Placed::new(shape.clone(), DAffine3::IDENTITY).unwrap();
        let (center, radius) = (placed.bounds().center(), 0.5 * placed.bounds().extent().length());
        let statistics = |p: DVec3, face: u32| -> [f64; 14] {
            let q = (p - center) / radius;
            let moments = [1.0, q.x, q.y, q.z, q.x * q.x, q.y * q.y, q.z * q.z, q.x * q.y * q.z];
            std::array::from_fn(|i| if i < 8 { moments[i] } else { f64::from(u8::from(face as usize % 6 == i - 8)) })
        };
        let (mut by_lines, mut by_samples) = ([Mean::default(); 14], [Mean::default(); 14]);
        let n = 12_000;
        for _ in 0..n {
            let dir = uniform_direction(&mut rng);
            let (x, y) = dir.any_orthonormal_pair();
            let (distance, angle) = (radius * rng.random::<f64>().sqrt(), rng.random_range(0.0..TAU));
            let origin = center + (x * angle.cos() + y * angle.sin()) * distance;
            let mut sums = [0.0; 14];
            for (t, face) in placed.crossings(origin, dir).iter() {
                let values = statistics(origin + dir * t, face);
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value * TAU * radius * radius);
            }
            by_lines.iter_mut().zip(sums).for_each(|(mean, sum)| mean.add(sum));
            let sample = placed.sample_area([rng.random(), rng.random()]).unwrap();
            let values = statistics(sample.point.p, sample.face);
            by_samples.iter_mut().zip(values).for_each(|(mean, value)| mean.add(value / sample.pdf_area));
        }
        for (i, (lines, samples)) in by_lines.iter().zip(&by_samples).enumerate() {
            let error = (lines.variance() + samples.variance()).sqrt();
            let difference = lines.mean() - samples.mean();
            let bound = 6.0 * error + 1e-9 * shape.area();
            assert!(difference.abs() < bound, "{shape:?}, {i}: {} by lines, {}", lines.mean(), samples.mean());
        }
        let area = by_lines[0];
        assert!((area.mean() - shape.area()).abs() < 6.0 * area.variance().sqrt(), "{shape:?}: {}", area.mean());
    }
}

fn uniform_direction(rng: &mut Pcg64) -> DVec3 {
    let (z, angle) = (rng.random_range(-1.0..1.0f64), rng.random_range(0.0..TAU));
    let ring = (1.0 - z * z).sqrt();
    DVec3::new(ring * angle.cos(), ring * angle.sin(), z)
}

/// A mean with its variance.
#[derive(Clone, Copy, Default)]
struct Mean {
    n: f64,
    sum: f64,
    squares: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.n += 1.0;
        self.sum += value;
        self.squares += value * value;
    }

    fn mean(&self) -> f64 {
        self.sum / self.n
    }

    fn variance(&self) -> f64 {
        (self.squares / self.n - self.mean() * self.mean()).max(0.0) / self.n
    }
}

#[test]
fn bad_input_is_an_error() {
    let unit = Shape::Sphere { radius: 1.0 };
    assert!(Placed::new(Shape::Sphere { radius: 0.0 }, DAffine3::IDENTITY).is_err());
    assert!(Placed::new(Shape::Sphere { radius: f64::NAN }, DAffine3::IDENTITY).is_err());
    assert!(Placed::new(unit.clone(), DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))).is_err());
    assert!(Placed::new(unit, DAffine3::from_translation(DVec3::splat(f64::INFINITY))).is_err());
}

/// Lines along the walls of a solid of revolution: beside them, in them, through them.
#[test]
fn lines_along_the_walls_of_a_lathe() {
    let shape = lathe(&[(0.5, 0.25), (0.5, 0.5), (1.0, 1.0), (0.0, 2.0)], false, false);
    let along = |p: DVec3, d: DVec3| {
        let crossings = shape.crossings(p, d.normalize());
        let places = crossings.t().iter().map(|t| p + d.normalize() * *t);
        places.map(|p| (p.truncate().length(), p.z)).collect::<Vec<_>>()
    };
    let near = |found: Vec<(f64, f64)>, expected: &[(f64, f64)]| {
        let close = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs().max((a.1 - b.1).abs()) < 1e-12;
        assert!(found.len() == expected.len() && found.iter().zip(expected).all(close), "{found:?} {expected:?}");
    };
    near(along(DVec3::new(0.25, 0.0, -1.0), DVec3::Z), &[(0.25, 0.25), (0.25, 1.75)]);
    near(along(DVec3::new(0.75, 0.0, -1.0), DVec3::Z), &[(0.75, 0.75), (0.75, 1.25)]);
    near(along(DVec3::new(1.25, 0.0, -1.0), DVec3::Z), &[]);
    // Parallel to the cone that opens upwards, a quarter within it.
    near(along(DVec3::new(-0.25, 0.0, 0.0), DVec3::new(1.0, 0.0, 1.0)), &[(0.0, 0.25), (0.875, 1.125)]);
    for wall in [DVec3::new(0.5, 0.0, 0.0), DVec3::new(0.3, 0.4, -3.0)] {
        assert_eq!(along(wall, DVec3::Z).len() % 2, 0);
    }
    assert_eq!(along(DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 0.0, 1.0)).len() % 2, 0);
}
