//! Triangle meshes: plain ones beside a bare Embree loop over the same rays, and Boolean operations on closed ones beside
//! the same two meshes rendered plainly. One primary and one shadow ray per pixel, one thread.
//!
//! `cargo bench -p arsc-accel --bench meshes` prints million rays per CPU-second of the tracing thread, and ratios. Loops
//! take turns, so that a shared machine slows all of them alike; the best of each counts.

#[path = "../../../tests/common/meshes.rs"]
mod meshes;

use std::sync::Arc;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, MaterialIndex, Ray, Scene, SceneGeometry, Shape, Solid, Strategy, Surface,
    SurfaceShape, TriangleMesh,
};
use arsc_embree::{Bounds, BuildQuality, Callbacks, Device, GeometryId, SceneBuilder, Segment, Step};
use arsc_geometry::ClosedMesh;
use glam::{DAffine3, DVec3};

const WIDTH: usize = 400;
const ROUNDS: usize = 5;

/// Embree alone: nothing of ours is called.
struct Bare;

impl Callbacks for Bare {
    type Query = ();

    fn bounds(&self, _: GeometryId, _: u32) -> Bounds {
        Bounds { min: [0.0; 3], max: [0.0; 3] }
    }

    fn intersect(&self, _: &mut (), _: GeometryId, _: u32, _: Option<GeometryId>) -> Step {
        Step::Miss
    }

    fn occluded(&self, _: &mut (), _: GeometryId, _: u32, _: Option<GeometryId>) -> bool {
        false
    }
}

fn thread_seconds() -> f64 {
    // The first word is nanoseconds on the processor.
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split_whitespace().next().and_then(|word| word.parse::<f64>().ok()).unwrap_or(0.0) * 1e-9
}

fn primary(i: usize) -> Ray {
    let (x, y) = ((i % WIDTH) as f64 + 0.5, (i / WIDTH) as f64 + 0.5);
    let eye = DVec3::new(2.0, -3.5, 1.6);
    let forward = -eye.normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let up = right.cross(forward);
    let at = |x: f64| (2.0 * x / WIDTH as f64 - 1.0) * 0.36;
    Ray::new(eye, (forward + right * at(x) - up * at(y)).normalize())
}

const SUN: DVec3 = DVec3::new(0.302, -0.503, 0.810);

/// Primary and shadow rays through a scene; gives the rays and how many met something.
fn trace(scene: &Scene) -> (usize, usize) {
    let (mut rays, mut met) = (0, 0);
    for i in 0..WIDTH * WIDTH {
        rays += 1;
        if let Some(hit) = scene.intersect(&primary(i)) {
            rays += 1;
            met += 1 + usize::from(scene.occluded(&hit.spawn(SUN)));
        }
    }
    (rays, met)
}

/// The same for Embree alone, with the usual offset against self-shadowing.
fn trace_bare(scene: &arsc_embree::Scene<Bare>, positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> (usize, usize) {
    let (mut rays, mut met) = (0, 0);
    let single = |v: DVec3| v.as_vec3().to_array();
    for i in 0..WIDTH * WIDTH {
        rays += 1;
        let Ray { origin, dir, .. } = primary(i);
        let segment = Segment { origin: single(origin), dir: single(dir), t_near: 0.0, t_far: f32::INFINITY };
        let Some(hit) = scene.intersect(&segment, &mut ()) else { continue };
        let [a, b, c] = triangles[hit.primitive as usize].map(|i| glam::Vec3::from_array(positions[i as usize]));
        let n = (b - a).cross(c - a).normalize().as_dvec3();
        let p = origin + dir * f64::from(hit.t) + n * 1e-4f64.copysign(n.dot(SUN));
        let shadow = Segment { origin: single(p), dir: single(SUN), t_near: 0.0, t_far: f32::INFINITY };
        rays += 1;
        met += 1 + usize::from(scene.occluded(&shadow, &mut ()));
    }
    (rays, met)
}

/// Million rays per CPU-second of each loop, the best of several rounds in turn.
fn compare(loops: &[&dyn Fn() -> (usize, usize)]) -> Vec<f64> {
    let mut best = vec![0.0f64; loops.len()];
    for _ in 0..ROUNDS {
        for (rate, run) in best.iter_mut().zip(loops) {
            let start = thread_seconds();
            let (rays, met) = run();
            assert!(met > 0);
            *rate = rate.max(rays as f64 * 1e-6 / (thread_seconds() - start));
        }
    }
    best
}

fn surfaces(parts: &[(Arc<TriangleMesh>, DAffine3)]) -> Scene {
    let surface = |(mesh, map): &(Arc<TriangleMesh>, DAffine3)| Surface {
        shape: SurfaceShape::Mesh(mesh.clone()),
        world_from_object: *map,
        material: MaterialIndex(0),
    };
    let geometry = SceneGeometry { surfaces: parts.iter().map(surface).collect(), ..SceneGeometry::default() };
    Scene::build(geometry, BuildOptions::default()).expect("a scene")
}

fn bare(mesh: &TriangleMesh) -> arsc_embree::Scene<Bare> {
    let device = Device::new(0).expect("a device");
    let mut builder = SceneBuilder::new(&device, Arc::new(Bare), BuildQuality::High).expect("a scene");
    builder.triangles(&mesh.positions, &mesh.triangles, false).expect("triangles");
    builder.commit().expect("a scene")
}

fn plain(name: &str, mesh: &TriangleMesh) {
    let scene = surfaces(&[(Arc::new(mesh.clone()), DAffine3::IDENTITY)]);
    let embree = bare(mesh);
    let rates = compare(&[&|| trace(&scene), &|| trace_bare(&embree, &mesh.positions, &mesh.triangles)]);
    println!(
        "{name:<26} {:>9} triangles: {:6.3} Mrays/s, bare Embree {:6.3}, ratio {:.3}",
        mesh.triangles.len(),
        rates[0],
        rates[1],
        rates[0] / rates[1]
    );
}

fn boolean(name: &str, a: &TriangleMesh, b: &TriangleMesh, map: DAffine3, strategies: &[Strategy]) {
    let parts = [(Arc::new(a.clone()), DAffine3::IDENTITY), (Arc::new(b.clone()), map)];
    let scene = surfaces(&parts);
    let leaf = |(mesh, map): &(Arc<TriangleMesh>, DAffine3)| {
        let (closed, _) = ClosedMesh::new("bench".into(), (**mesh).clone()).expect("a closed mesh");
        CsgLeaf { shape: Shape::Mesh(Arc::new(closed)), world_from_object: *map, material: MaterialIndex(0) }
    };
    let tree = Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(Csg::Leaf(1)));
    let solid = Solid { tree, leaves: parts.iter().map(leaf).collect() };
    for &strategy in strategies {
        let geometry = SceneGeometry { solids: vec![solid.clone()], ..SceneGeometry::default() };
        let carved = Scene::build(geometry, BuildOptions { strategy, ..BuildOptions::default() }).expect("a scene");
        let rates = compare(&[&|| trace(&carved), &|| trace(&scene)]);
        println!(
            "{name:<26} {:>9} triangles, {strategy:?}: {:6.3} Mrays/s, plain {:6.3}, time ratio {:.2}, build {:.2} s, {} cells",
            a.triangles.len() + b.triangles.len(),
            rates[0],
            rates[1],
            rates[1] / rates[0],
            carved.stats().build_time.as_secs_f64(),
            carved.stats().cells,
        );
    }
}

fn main() {
    // Under `cargo test` nothing is measured.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    // `-- plain`, `-- spheres` or `-- torus` measure that alone.
    let wanted = |name: &str| {
        let mut names = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).peekable();
        names.peek().is_none() || names.any(|argument| argument == name)
    };
    if wanted("plain") {
        all_plain();
    }
    let aside = DAffine3::from_translation(DVec3::new(0.5, -0.6, 0.3));
    let all = &[Strategy::Local, Strategy::Tree][..if std::env::var_os("LOCAL").is_some() { 1 } else { 2 }];
    if wanted("spheres") {
        boolean("spheres", &meshes::sphere(50, 100, 1.0), &meshes::sphere(50, 100, 0.8), aside, all);
    }
    if wanted("torus") {
        let torus = meshes::torus(300, 150, 0.8, 0.35);
        boolean("torus less sphere", &torus, &meshes::sphere(190, 190, 0.7), aside, all);
    }
}

fn all_plain() {
    plain("sphere", &meshes::sphere(100, 200, 1.0));
    plain("torus", &meshes::torus(600, 300, 0.8, 0.35));
    plain("large torus", &meshes::torus(2000, 1000, 0.8, 0.35));
}
