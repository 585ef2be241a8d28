//! Surfaces under Embree against plain loops in double precision.

use std::sync::Arc;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, MaterialIndex, PartId, Ray, Scene, SceneGeometry, Shape, Solid, Surface, SurfaceShape,
    TriangleMesh,
};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn vector(rng: &mut Pcg64) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
}

fn random_map(rng: &mut Pcg64, scale: f64) -> DAffine3 {
    let turn = DMat3::from_axis_angle(vector(rng).normalize(), rng.random_range(0.0..6.0));
    let mirror = if rng.random() { DVec3::new(-1.3, 1.0, 0.8) } else { DVec3::ONE };
    DAffine3 { matrix3: turn * DMat3::from_diagonal(mirror * scale), translation: vector(rng) * scale }
}

/// Distance to the plane of three points where the ray is within them.
fn triangle(points: [DVec3; 3], ray: &Ray) -> Option<f64> {
    let [a, b, c] = points;
    let n = (b - a).cross(c - a);
    let t = (a - ray.origin).dot(n) / ray.dir.dot(n);
    let p = ray.at(t);
    let side = |u: DVec3, v: DVec3| (v - u).cross(p - u).dot(n) >= 0.0;
    (t > 0.0 && side(a, b) && side(b, c) && side(c, a)).then_some(t)
}

/// Triangles in the world, with the part that they belong to.
type Soup = Vec<(u32, [DVec3; 3])>;

fn add(soup: &mut Soup, part: u32, map: &DAffine3, points: [DVec3; 3]) {
    soup.push((part, points.map(|p| map.transform_point3(p))));
}

fn random_surfaces(rng: &mut Pcg64, scale: f64) -> (Vec<Surface>, Soup) {
    let (mut surfaces, mut soup) = (Vec::new(), Soup::new());
    for part in 0..40 {
        let map = random_map(rng, scale);
        let shape = match part % 4 {
            0 => {
                let corners = [vector(rng), vector(rng), vector(rng)];
                add(&mut soup, part, &map, corners);
                SurfaceShape::Triangle(corners)
            }
            1 => {
                let [o, x, y] = [vector(rng), vector(rng), vector(rng)];
                let corners = [o, o + x, o + x + y, o + y];
                add(&mut soup, part, &map, [corners[0], corners[1], corners[2]]);
                add(&mut soup, part, &map, [corners[0], corners[2], corners[3]]);
                SurfaceShape::Quad(corners)
            }
            2 => {
                let corner = |x: f64, y: f64| DVec3::new(x * 0.6, y * 0.35, 0.0);
                let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                add(&mut soup, part, &map, [corners[0], corners[1], corners[2]]);
                add(&mut soup, part, &map, [corners[0], corners[2], corners[3]]);
                SurfaceShape::Rectangle { size: DVec2::new(1.2, 0.7) }
            }
            _ => {
                let positions: Vec<[f32; 3]> = (0..60).map(|_| vector(rng).as_vec3().to_array()).collect();
                let triangles: Vec<[u32; 3]> = (0..40)
                    .map(|_| [rng.random_range(0..20), rng.random_range(20..40), rng.random_range(40..60)])
                    .collect();
                let at = |i: u32| glam::Vec3::from_array(positions[i as usize]).as_dvec3();
                for t in &triangles {
                    add(&mut soup, part, &map, t.map(at));
                }
                SurfaceShape::Mesh(Arc::new(TriangleMesh { positions, triangles, ..TriangleMesh::default() }))
            }
        };
        surfaces.push(Surface { shape, world_from_object: map, material: MaterialIndex(part) });
    }
    (surfaces, soup)
}

/// 3 scales × 4 scenes × 3 000 rays; the nearest part and distance are those of the loop, and so is occlusion.
#[test]
fn nearest_triangle_is_that_of_a_loop() {
    let mut rng = Pcg64::seed_from_u64(31);
    let (mut hits, mut edges) = (0, 0);
    for scale in [1e-3, 1.0, 1e6] {
        for _ in 0..4 {
            let (surfaces, soup) = random_surfaces(&mut rng, scale);
            let geometry = SceneGeometry { surfaces, ..SceneGeometry::default() };
            let scene = Scene::build(geometry, BuildOptions::default()).unwrap();
            for _ in 0..3000 {
                let origin = vector(&mut rng) * scale * rng.random_range(1.0..5.0);
                let ray = Ray::new(origin, (vector(&mut rng) * scale - origin).normalize());
                let all = soup.iter().filter_map(|(part, points)| triangle(*points, &ray).map(|t| (t, *part)));
                let expected = all.min_by(|a, b| a.0.total_cmp(&b.0));
                let found = scene.intersect(&ray).map(|hit| (hit.t, hit.part.0));
                match (expected, found) {
                    (None, None) => {}
                    (Some(a), Some(b)) if a.1 == b.1 && (a.0 - b.0).abs() < 1e-9 * scale => hits += 1,
                    _ => edges += 1,
                }
                let t_max = rng.random_range(0.0..6.0) * scale;
                let blocked = expected.is_some_and(|(t, _)| t < t_max);
                edges += u32::from(scene.occluded(&Ray { t_max, ..ray }) != blocked);
            }
        }
    }
    assert!(hits > 10_000, "{hits}");
    // Rays through an edge to within rounding are all that may differ.
    assert_eq!(edges, 0);
}

/// Solids and triangles under one hierarchy: whichever is nearer is met, in double precision.
#[test]
fn solids_and_triangles_are_ordered_in_double_precision() {
    let ball = CsgLeaf {
        shape: Shape::Sphere { radius: 1.0 },
        world_from_object: DAffine3::IDENTITY,
        material: MaterialIndex(0),
    };
    for gap in [1e-9, -1e-9] {
        let z = 1.0 + gap;
        let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z));
        let surface = Surface {
            shape: SurfaceShape::Quad(square),
            world_from_object: DAffine3::IDENTITY,
            material: MaterialIndex(1),
        };
        let geometry = SceneGeometry {
            solids: vec![Solid { tree: Csg::Leaf(0), leaves: vec![ball.clone()] }],
            surfaces: vec![surface],
            ..SceneGeometry::default()
        };
        let scene = Scene::build(geometry, BuildOptions::default()).unwrap();
        let hit = scene.intersect(&Ray::new(DVec3::new(0.0, 0.0, 5.0), DVec3::NEG_Z)).unwrap();
        assert_eq!(hit.part, PartId(u32::from(gap > 0.0)), "gap {gap}: {hit:?}");
        assert!((hit.t - (4.0 - gap.max(0.0))).abs() < 1e-14);
    }
}

/// Area of meshes and flat surfaces, and samples that lie on them with the right density (exact: 1 / area).
#[test]
fn surface_samples_are_uniform_in_area() {
    let mut rng = Pcg64::seed_from_u64(33);
    let (surfaces, soup) = random_surfaces(&mut rng, 1.0);
    let geometry = SceneGeometry { surfaces, ..SceneGeometry::default() };
    let scene = Scene::build(geometry, BuildOptions::default()).unwrap();
    for part in 0..40 {
        let own: Vec<[DVec3; 3]> = soup.iter().filter(|(p, _)| *p == part).map(|(_, t)| *t).collect();
        let area: f64 = own.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum();
        assert!((scene.part_area(PartId(part)) - area).abs() < 1e-9 * area);
        for _ in 0..200 {
            let sample = scene.sample_part(PartId(part), rng.random(), [rng.random(), rng.random()]).unwrap();
            assert!((sample.pdf_area * area - 1.0).abs() < 1e-9);
            let off = own.iter().map(|[a, b, c]| {
                let n = (*b - *a).cross(*c - *a);
                let ray = Ray::new(sample.p + n.normalize() * 0.5, -n.normalize());
                triangle([*a, *b, *c], &ray).map_or(1.0, |t| (t - 0.5).abs())
            });
            assert!(off.fold(1.0, f64::min) < 1e-12);
        }
    }
}
