//! Camera paths per second on one thread: a Cornell-like box (a rectangle light, five walls, a block, spheres of glass and
//! metal), the same light alone on a floor, and an outdoor scene under the sky.

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, MaterialIndex, Scene, SceneGeometry, Shape, Solid, Surface, SurfaceShape,
};
use arsc_render::{
    AreaEmitter, Bsdf, Camera, Environment, FilterShape, Material, PathTraceSettings, ReconstructionFilter, Sampling,
    SkySettings, World, path_trace,
};
use arsc_spectral::{Spectrum, uplift_rgb};
use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use glam::{DAffine3, DMat3, DVec2, DVec3};

const PIXELS: u32 = 64;
const SAMPLES: u32 = 16;

#[derive(Default)]
struct Stage {
    geometry: SceneGeometry,
    materials: Vec<Material>,
}

impl Stage {
    fn solid(&mut self, shape: Shape, at: DVec3, bsdf: Bsdf) {
        let material = MaterialIndex(self.materials.len() as u32);
        self.materials.push(Material { bsdf, ..Material::default() });
        let leaf = CsgLeaf { shape, world_from_object: DAffine3::from_translation(at), material };
        self.geometry.solids.push(Solid { tree: Csg::Leaf(0), leaves: vec![leaf] });
    }

    fn light(&mut self, center: DVec3, size: f64, spectrum: Spectrum) {
        let material = MaterialIndex(self.materials.len() as u32);
        let emitter = Some(AreaEmitter::new(&spectrum, false));
        self.materials.push(Material { bsdf: Bsdf::lambert(&Spectrum::Constant(0.0)), emitter, ..Material::default() });
        let place = DAffine3 { matrix3: DMat3::from_rotation_x(std::f64::consts::PI), translation: center };
        let shape = SurfaceShape::Rectangle { size: DVec2::splat(size) };
        self.geometry.surfaces.push(Surface { shape, world_from_object: place, material });
    }

    fn world(self, environments: Vec<Environment>) -> World {
        let scene = Scene::build(self.geometry, BuildOptions::default()).expect("valid geometry");
        World::new(scene, self.materials, vec![], environments)
    }
}

fn colour(rgb: [f64; 3]) -> Bsdf {
    Bsdf::lambert(&Spectrum::Sigmoid { coefficients: uplift_rgb(rgb) })
}

fn cuboid(x: f64, y: f64, z: f64) -> Shape {
    Shape::Box { min: DVec3::new(-x, -y, -z), max: DVec3::new(x, y, z) }
}

fn cornell() -> (World, Camera) {
    let mut stage = Stage::default();
    let white = || colour([0.73, 0.73, 0.72]);
    stage.solid(cuboid(1.0, 1.0, 0.1), DVec3::new(0.0, 0.0, -1.1), white());
    stage.solid(cuboid(1.0, 1.0, 0.1), DVec3::new(0.0, 0.0, 1.1), white());
    stage.solid(cuboid(1.0, 0.1, 1.0), DVec3::new(0.0, 1.1, 0.0), white());
    stage.solid(cuboid(0.1, 1.0, 1.0), DVec3::new(-1.1, 0.0, 0.0), colour([0.6, 0.05, 0.05]));
    stage.solid(cuboid(0.1, 1.0, 1.0), DVec3::new(1.1, 0.0, 0.0), colour([0.1, 0.45, 0.1]));
    stage.solid(cuboid(0.3, 0.3, 0.6), DVec3::new(-0.4, 0.4, -0.4), white());
    stage.solid(Shape::Sphere { radius: 0.3 }, DVec3::new(0.45, -0.2, -0.7), glass());
    let gold = Bsdf::conductor(&Spectrum::Constant(0.27), &Spectrum::Constant(2.95));
    stage.solid(Shape::Sphere { radius: 0.25 }, DVec3::new(0.3, 0.5, -0.75), gold);
    stage.light(DVec3::new(0.0, 0.0, 0.99), 0.5, Spectrum::Blackbody { kelvin: 3000.0 });
    (stage.world(vec![]), camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO))
}

fn glass() -> Bsdf {
    Bsdf::dielectric(&Spectrum::Cauchy { a: 1.5046, b_um2: 0.0042, c_um4: 0.0 })
}

fn floor_and_light() -> (World, Camera) {
    let mut stage = Stage::default();
    stage.solid(cuboid(3.0, 3.0, 0.1), DVec3::ZERO, colour([0.5, 0.4, 0.3]));
    stage.light(DVec3::new(0.0, 0.0, 2.0), 0.5, Spectrum::Blackbody { kelvin: 3000.0 });
    (stage.world(vec![]), camera(DVec3::new(0.0, -4.0, 3.0), DVec3::ZERO))
}

fn outdoors() -> (World, Camera) {
    let mut stage = Stage::default();
    stage.solid(cuboid(5.0, 5.0, 0.1), DVec3::ZERO, colour([0.5, 0.4, 0.3]));
    stage.solid(Shape::Sphere { radius: 1.0 }, DVec3::new(0.0, 0.0, 1.1), colour([0.3, 0.4, 0.7]));
    stage.solid(Shape::Sphere { radius: 0.5 }, DVec3::new(1.5, -0.5, 0.6), glass());
    let sun = DVec3::new(-1.0, -1.0, 1.5);
    let settings = SkySettings { ground_albedo: 0.3, sun, ..SkySettings::default() };
    let sky = Environment::sky(&settings);
    (stage.world(vec![sky]), camera(DVec3::new(0.0, -6.0, 2.0), DVec3::new(0.0, 0.0, 0.8)))
}

fn camera(eye: DVec3, target: DVec3) -> Camera {
    let filter = ReconstructionFilter::new(FilterShape::default());
    Camera::perspective(eye, target, DVec3::Z, 0.7, [PIXELS; 2], filter)
}

fn paths(criterion: &mut Criterion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let sampling = Sampling { samples: SAMPLES, ..Sampling::default() };
    let settings = PathTraceSettings { sampling, max_depth: 16, ..PathTraceSettings::default() };
    let mut group = criterion.benchmark_group("path_trace");
    group.sampling_mode(SamplingMode::Flat).sample_size(10);
    group.throughput(Throughput::Elements(u64::from(PIXELS * PIXELS * SAMPLES)));
    for (name, (world, camera)) in
        [("cornell", cornell()), ("floor_and_light", floor_and_light()), ("outdoors", outdoors())]
    {
        let render = || path_trace(&world, &camera, &settings, &());
        group.bench_function(name, |bencher| pool.install(|| bencher.iter(render)));
    }
    group.finish();
}

criterion_group!(benches, paths);
criterion_main!(benches);
