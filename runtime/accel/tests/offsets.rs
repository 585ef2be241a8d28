//! Rays that leave surfaces: no acne, no leaks, from a thousandth to a million units, grazing included.
//!
//! Random numbers are seeded; every assertion is exact ("none of so many"), nothing is statistical.

use std::f64::consts::TAU;
use std::sync::Arc;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, Hit, Instance, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy,
    Surface, SurfaceShape, TriangleMesh,
};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

const SCALES: [f64; 4] = [1e-3, 1.0, 1e3, 1e6];

fn vector(rng: &mut Pcg64) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
}

fn rotation(rng: &mut Pcg64) -> DMat3 {
    DMat3::from_axis_angle(vector(rng).normalize(), rng.random_range(0.0..TAU))
}

/// Under every strategy, if there are solids that they differ in.
fn scenes(geometry: SceneGeometry) -> Vec<Scene> {
    let differ = !geometry.solids.is_empty() || !geometry.instances.is_empty();
    let strategies = if differ { &Strategy::ALL[..] } else { &Strategy::ALL[..1] };
    let build = |&strategy| Scene::build(geometry.clone(), BuildOptions::from(strategy)).unwrap();
    strategies.iter().map(build).collect()
}

fn one(shape: Shape, map: DAffine3) -> Solid {
    let leaf = CsgLeaf { shape, world_from_object: map, material: MaterialIndex(0) };
    Solid { tree: Csg::Leaf(0), leaves: vec![leaf] }
}

/// A direction on the side of `n`, as grazing as `cos`.
fn direction(n: DVec3, cos: f64, rng: &mut Pcg64) -> DVec3 {
    let (a, b) = n.any_orthonormal_pair();
    let (s, c) = rng.random_range(0.0..TAU).sin_cos();
    n * cos + (a * c + b * s) * (1.0 - cos * cos).sqrt()
}

/// Cosines from steep to grazing.
fn cosine(rng: &mut Pcg64) -> f64 {
    10f64.powf(rng.random_range(-8.0..0.0))
}

/// Convex shapes seen from outside: whatever leaves outwards meets nothing, whatever enters meets the far side.
#[test]
fn convex_solids_show_no_acne() {
    let mut rng = Pcg64::seed_from_u64(1);
    let shapes = [
        Shape::Sphere { radius: 1.0 },
        Shape::Box { min: DVec3::NEG_ONE, max: DVec3::new(0.5, 1.0, 2.0) },
        Shape::Cylinder { radius: 0.7, height: 2.0 },
        Shape::Cone { base_radius: 1.0, top_radius: 0.3, height: 1.5 },
    ];
    for scale in SCALES {
        for shape in &shapes {
            for squeeze in [DVec3::ONE, DVec3::new(-1.0, 0.4, 1.7)] {
                let matrix = rotation(&mut rng) * DMat3::from_diagonal(squeeze * scale);
                let map = DAffine3 { matrix3: matrix, translation: vector(&mut rng) * 3.0 * scale };
                for scene in scenes(SceneGeometry { solids: vec![one(shape.clone(), map)], ..SceneGeometry::default() })
                {
                    let mut hits = 0;
                    for _ in 0..2000 {
                        let from = map.translation + vector(&mut rng).normalize() * 8.0 * scale;
                        let to = map.transform_point3(vector(&mut rng));
                        let Some(hit) = scene.intersect(&Ray::new(from, (to - from).normalize())) else { continue };
                        hits += 1;
                        let out = direction(hit.ng, cosine(&mut rng), &mut rng);
                        let again = scene.intersect(&hit.spawn(out));
                        assert!(again.is_none(), "acne on {shape:?} × {scale}: {hit:?} {again:?}");
                        let inwards = direction(-hit.ng, rng.random_range(0.1..1.0), &mut rng);
                        let through = scene.intersect(&hit.spawn(inwards));
                        assert!(through.is_some_and(|far| far.ng.dot(inwards) > 0.0), "leak into {shape:?} × {scale}");
                    }
                    assert!(hits > 300, "only {hits} hits on {shape:?}");
                }
            }
        }
    }
}

/// The inside of a closed room in five makes: 20 bounces from wall to wall, 400 paths, never out.
#[test]
fn nothing_leaks_out_of_closed_rooms() {
    let mut rng = Pcg64::seed_from_u64(2);
    for scale in SCALES {
        let turn = rotation(&mut rng);
        let place = DAffine3 { matrix3: turn * scale, translation: vector(&mut rng) * 2.0 * scale };
        for (name, geometry) in rooms(place) {
            for scene in scenes(geometry) {
                let mut met = 0;
                for _ in 0..400 {
                    let mut ray =
                        Ray::new(place.transform_point3(vector(&mut rng) * 0.9), vector(&mut rng).normalize());
                    for _ in 0..20 {
                        let hit = scene.intersect(&ray);
                        let Some(hit) = hit else { panic!("{name} × {scale} leaks: {ray:?}") };
                        let facing = if hit.ng.dot(ray.dir) > 0.0 { -hit.ng } else { hit.ng };
                        let inside = place.inverse().transform_point3(hit.p).abs().max_element();
                        assert!(inside < 1.0 + 1e-6, "{name} × {scale}: {inside} is beyond the wall");
                        ray = hit.spawn(direction(facing, cosine(&mut rng).max(1e-4), &mut rng));
                        met += 1;
                    }
                }
                assert_eq!(met, 8000);
            }
        }
    }
}

/// The cube from −1 to 1 as: a box from inside, a box cut from a box, an instance, rectangles, quads and a mesh.
fn rooms(place: DAffine3) -> Vec<(&'static str, SceneGeometry)> {
    let cube = |half: f64| Shape::Box { min: DVec3::splat(-half), max: DVec3::splat(half) };
    let leaf = |half, map| CsgLeaf { shape: cube(half), world_from_object: map, material: MaterialIndex(0) };
    let hollow = |map| Solid {
        tree: Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(Csg::Leaf(1))),
        leaves: vec![leaf(1.1, map), leaf(1.0, map)],
    };
    let surface = |shape, map| Surface { shape, world_from_object: map, material: MaterialIndex(0) };
    let wall = |i: usize| {
        let (axis, sign) = (i / 2, if i.is_multiple_of(2) { -1.0 } else { 1.0 });
        let columns = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][axis];
        let matrix = DMat3::from_cols(DVec3::AXES[columns[0]], DVec3::AXES[columns[1]], DVec3::AXES[columns[2]]);
        place * DAffine3 { matrix3: matrix, translation: DVec3::AXES[axis] * sign }
    };
    let square = [
        DVec3::new(-1.0, -1.0, 0.0),
        DVec3::new(1.0, -1.0, 0.0),
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(-1.0, 1.0, 0.0),
    ];
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0f32 } else { 1.0 });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mesh = TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect(),
        ..TriangleMesh::default()
    };
    let surfaces = |surfaces| SceneGeometry { surfaces, ..SceneGeometry::default() };
    let instance = Instance { solid: Arc::new(hollow(DAffine3::IDENTITY)), world_from_object: place };
    vec![
        ("a box", SceneGeometry { solids: vec![one(cube(1.0), place)], ..SceneGeometry::default() }),
        ("a hollow box", SceneGeometry { solids: vec![hollow(place)], ..SceneGeometry::default() }),
        ("an instance", SceneGeometry { instances: vec![instance], ..SceneGeometry::default() }),
        ("quads", surfaces((0..6).map(|i| surface(SurfaceShape::Quad(square), wall(i))).collect())),
        ("rectangles", {
            // A little too large, so that the edges overlap: separate surfaces share no vertices.
            let wide = SurfaceShape::Rectangle { size: DVec2::splat(2.0 + 1e-9) };
            surfaces((0..6).map(|i| surface(wide.clone(), wall(i))).collect())
        }),
        ("a mesh", surfaces(vec![surface(SurfaceShape::Mesh(Arc::new(mesh)), place)])),
    ]
}

/// A lamp in the plane of the ceiling, alone or on a slab: the lamp is seen everywhere on it, whatever the angle.
#[test]
fn coplanar_surfaces_do_not_fight() {
    let mut rng = Pcg64::seed_from_u64(3);
    for scale in SCALES {
        let map = DAffine3 { matrix3: rotation(&mut rng) * scale, translation: vector(&mut rng) * scale };
        let lamp = Surface {
            shape: SurfaceShape::Rectangle { size: DVec2::ONE },
            world_from_object: map,
            material: MaterialIndex(1),
        };
        let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let ceiling =
            Surface { shape: SurfaceShape::Quad(corners), world_from_object: map, material: MaterialIndex(0) };
        let slab = one(Shape::Box { min: DVec3::new(-3.0, -3.0, 0.0), max: DVec3::new(3.0, 3.0, 1.0) }, map);
        for with_slab in [false, true] {
            let solids = if with_slab { vec![slab.clone()] } else { vec![] };
            let geometry =
                SceneGeometry { solids, surfaces: vec![ceiling.clone(), lamp.clone()], ..SceneGeometry::default() };
            for scene in scenes(geometry) {
                for _ in 0..3000 {
                    let eye = map.transform_point3(DVec3::new(0.0, 0.0, -1.0) + vector(&mut rng).with_z(0.0) * 3.0);
                    let target = map.transform_point3((vector(&mut rng) * 0.49).with_z(0.0));
                    let hit = scene.intersect(&Ray::new(eye, (target - eye).normalize())).unwrap();
                    assert_eq!(hit.material, MaterialIndex(1), "with slab {with_slab}: {hit:?}");
                    let away = direction(-map.matrix3.z_axis / scale, cosine(&mut rng).max(1e-6), &mut rng);
                    assert!(scene.intersect(&hit.spawn(away)).is_none(), "a coincident surface is met again");
                }
            }
        }
    }
}

/// Shadow segments between surfaces of a solid that see each other are free, and stop at what is between.
#[test]
fn segments_end_at_their_target() {
    let mut rng = Pcg64::seed_from_u64(4);
    for scale in SCALES {
        let ball =
            |x: f64, r: f64| one(Shape::Sphere { radius: r * scale }, DAffine3::from_translation(DVec3::X * x * scale));
        for with_blocker in [false, true] {
            let mut solids = vec![ball(-3.0, 1.0), ball(3.0, 1.0)];
            solids.extend(with_blocker.then(|| ball(0.0, 2.5)));
            for scene in scenes(SceneGeometry { solids, ..SceneGeometry::default() }) {
                let hit = scene.intersect(&Ray::new(DVec3::new(-1.6, 0.0, 0.0) * scale, DVec3::NEG_X));
                let front = Ray::new(DVec3::new(-2.5, 9.0, 0.2) * scale, DVec3::NEG_Y);
                let hit: Hit = scene.intersect(&front).or(hit).unwrap();
                let mut free = 0;
                for _ in 0..2000 {
                    let part = arsc_accel::PartId(1);
                    let sample = scene.sample_part(part, 0.0, [rng.random(), rng.random()]).unwrap();
                    let towards = hit.p - sample.p;
                    if towards.dot(sample.ng) <= 0.0 || towards.dot(hit.ng) >= 0.0 {
                        continue;
                    }
                    free += 1;
                    let segment = hit.spawn_to_sample(&sample).unwrap();
                    assert_eq!(scene.occluded(&segment), with_blocker, "scale {scale}: {segment:?}");
                    let onwards = Ray { t_max: f64::INFINITY, ..segment };
                    assert!(scene.occluded(&onwards), "the target itself is met");
                }
                assert!(free > 100);
            }
        }
    }
}
