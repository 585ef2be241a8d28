//! The wrapper against hand-computed answers.

use std::sync::Arc;

use arsc_embree::{
    Bounds, BuildQuality, Callbacks, Candidate, Device, EmbreeError, GeometryId, Scene, SceneBuilder, Segment, Step,
};

/// Unit spheres along x, four apart, intersected in double precision; the query is the ray and what was seen.
struct Spheres {
    bounds_panic: bool,
}

struct Query {
    origin: [f64; 3],
    dir: [f64; 3],
    offset: f64,
    best: f64,
    candidates: Vec<Candidate>,
    instances: Vec<Option<GeometryId>>,
    panic: bool,
}

impl Query {
    fn new(segment: &Segment) -> Query {
        Query {
            origin: segment.origin.map(f64::from),
            dir: segment.dir.map(f64::from),
            offset: 0.0,
            best: f64::INFINITY,
            candidates: Vec::new(),
            instances: Vec::new(),
            panic: false,
        }
    }

    fn sphere(&self, primitive: u32) -> Option<f64> {
        let center = [4.0 * f64::from(primitive) + self.offset, 0.0, 0.0];
        let oc: Vec<f64> = (0..3).map(|i| self.origin[i] - center[i]).collect();
        let b: f64 = (0..3).map(|i| oc[i] * self.dir[i]).sum();
        let c: f64 = oc.iter().map(|x| x * x).sum::<f64>() - 1.0;
        let disc = b * b - c;
        (disc >= 0.0 && -b - disc.sqrt() > 0.0).then(|| -b - disc.sqrt())
    }
}

impl Callbacks for Spheres {
    type Query = Query;

    fn bounds(&self, _: GeometryId, primitive: u32) -> Bounds {
        assert!(!self.bounds_panic, "bounds");
        let x = 4.0 * primitive as f32;
        Bounds { min: [x - 1.0, -1.0, -1.0], max: [x + 1.0, 1.0, 1.0] }
    }

    fn intersect(&self, query: &mut Query, _: GeometryId, primitive: u32, instance: Option<GeometryId>) -> Step {
        assert!(!query.panic, "boom");
        query.instances.push(instance);
        if instance.is_some() {
            query.offset = 100.0;
        }
        match query.sphere(primitive) {
            Some(t) if t < query.best => {
                query.best = t;
                Step::Hit((t as f32).next_up())
            }
            _ => Step::Miss,
        }
    }

    fn occluded(&self, query: &mut Query, _: GeometryId, primitive: u32, _: Option<GeometryId>) -> bool {
        assert!(!query.panic, "boom");
        query.sphere(primitive).is_some()
    }

    fn filter(&self, query: &mut Query, candidate: Candidate) -> Step {
        query.candidates.push(candidate);
        // Offer everything up to 1 % further, so that coincident primitives are seen too.
        Step::Hit(candidate.t * 1.01)
    }
}

fn builder(device: &Device) -> SceneBuilder<Spheres> {
    SceneBuilder::new(device, Arc::new(Spheres { bounds_panic: false }), BuildQuality::Medium).expect("a scene")
}

fn along_x(x: f32, y: f32) -> Segment {
    Segment { origin: [x, y, 0.0], dir: [1.0, 0.0, 0.0], t_near: 0.0, t_far: f32::INFINITY }
}

fn down(x: f32, y: f32) -> Segment {
    Segment { origin: [x, y, 5.0], dir: [0.0, 0.0, -1.0], t_near: 0.0, t_far: f32::INFINITY }
}

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn user_geometry_gives_the_nearest_hit_in_double_precision() {
    let device = Device::new(1).expect("a device");
    let mut builder = builder(&device);
    builder.user_geometry(10).expect("user geometry");
    let scene = builder.commit().expect("a committed scene");
    let segment = along_x(-3.0, 0.3);
    let mut query = Query::new(&segment);
    let hit = scene.intersect(&segment, &mut query).expect("a hit");
    assert_eq!(hit.primitive, 0);
    let y = f64::from(0.3f32);
    assert!((query.best - (3.0 - (1.0 - y * y).sqrt())).abs() < 1e-14);
    assert!(scene.occluded(&segment, &mut Query::new(&segment)));
    let above = along_x(-3.0, 1.5);
    assert!(scene.intersect(&above, &mut Query::new(&above)).is_none());
    assert!(!scene.occluded(&above, &mut Query::new(&above)));
}

#[test]
fn triangles_and_quads_report_primitive_and_parameters() {
    let device = Device::new(1).expect("a device");
    let mut builder = builder(&device);
    let triangles = builder.triangles(&SQUARE, &[[0, 1, 2], [0, 2, 3]], false).expect("triangles");
    let lower = SQUARE.map(|[x, y, _]| [x + 2.0, y, -1.0]);
    let quads = builder.quads(&lower, &[[0, 1, 2, 3]], false).expect("a quad");
    let scene = builder.commit().expect("a committed scene");
    let segment = down(0.25, 0.75);
    let hit = scene.intersect(&segment, &mut Query::new(&segment)).expect("a hit");
    assert_eq!((hit.geometry, hit.primitive), (triangles, 1));
    assert!((hit.t - 5.0).abs() < 1e-6);
    let segment = down(2.5, 0.25);
    let hit = scene.intersect(&segment, &mut Query::new(&segment)).expect("a hit");
    assert_eq!((hit.geometry, hit.primitive), (quads, 0));
    assert!((hit.t - 6.0).abs() < 1e-6);
}

#[test]
fn a_filter_that_lengthens_the_ray_is_offered_coincident_primitives() {
    let device = Device::new(1).expect("a device");
    let mut builder = builder(&device);
    for z in [0.0, 0.0, 0.01, -3.0] {
        builder.quads(&SQUARE.map(|[x, y, _]| [x, y, z]), &[[0, 1, 2, 3]], true).expect("a quad");
    }
    let scene = builder.commit().expect("a committed scene");
    let segment = down(0.4, 0.3);
    let mut query = Query::new(&segment);
    scene.intersect(&segment, &mut query).expect("a hit");
    let mut seen: Vec<u32> = query.candidates.iter().map(|c| c.geometry.0).collect();
    seen.sort_unstable();
    assert!([0, 1, 2].iter().all(|id| seen.contains(id)), "coincident quads were not offered: {seen:?}");
}

#[test]
fn instances_reach_the_callbacks_by_number() {
    let device = Device::new(1).expect("a device");
    let mut inner = builder(&device);
    inner.user_geometry(1).expect("user geometry");
    let inner: Arc<Scene<Spheres>> = Arc::new(inner.commit().expect("a committed scene"));
    let mut outer = builder(&device);
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [100.0, 0.0, 0.0]];
    let id = outer.instance(&inner, &columns).expect("an instance");
    let scene = outer.commit().expect("a committed scene");
    let segment = along_x(90.0, 0.0);
    let mut query = Query::new(&segment);
    let hit = scene.intersect(&segment, &mut query).expect("a hit");
    assert_eq!(hit.instance, Some(id));
    assert_eq!(query.instances, [Some(id)]);
    assert!((query.best - 9.0).abs() < 1e-12);
}

#[test]
fn a_panic_in_a_callback_reaches_the_caller_and_the_scene_stays_usable() {
    let device = Device::new(1).expect("a device");
    let mut builder = builder(&device);
    builder.user_geometry(3).expect("user geometry");
    let scene = builder.commit().expect("a committed scene");
    let segment = along_x(-3.0, 0.0);
    for occluded in [false, true] {
        let caught = std::panic::catch_unwind(|| {
            let mut query = Query { panic: true, ..Query::new(&segment) };
            if occluded {
                scene.occluded(&segment, &mut query);
            } else {
                scene.intersect(&segment, &mut query);
            }
        });
        assert_eq!(caught.expect_err("the panic goes on").downcast_ref(), Some(&"boom"));
    }
    assert!(scene.occluded(&segment, &mut Query::new(&segment)));
}

#[test]
fn a_panic_in_bounds_is_an_error() {
    let device = Device::new(1).expect("a device");
    let callbacks = Arc::new(Spheres { bounds_panic: true });
    let mut builder = SceneBuilder::new(&device, callbacks, BuildQuality::Low).expect("a scene");
    builder.user_geometry(3).expect("user geometry");
    assert!(matches!(builder.commit().err(), Some(EmbreeError::Invalid(_))));
}

#[test]
fn bad_input_is_refused_before_embree_sees_it() {
    let device = Device::new(1).expect("a device");
    let mut builder = builder(&device);
    let nan = [[f32::NAN, 0.0, 0.0]; 3];
    assert!(matches!(builder.triangles(&nan, &[[0, 1, 2]], false), Err(EmbreeError::Invalid(_))));
    assert!(matches!(builder.triangles(&SQUARE, &[[0, 1, 4]], false), Err(EmbreeError::Invalid(_))));
    builder.triangles(&SQUARE, &[[0, 1, 2]], false).expect("triangles");
    builder.triangles(&[], &[], false).expect("no triangles at all");
    let scene = builder.commit().expect("a committed scene");
    let mut segment = down(0.5, 0.25);
    segment.dir[1] = f32::NAN;
    assert!(scene.intersect(&segment, &mut Query::new(&segment)).is_none());
    assert!(!scene.occluded(&segment, &mut Query::new(&segment)));
    let backwards = Segment { t_near: 2.0, t_far: 1.0, ..down(0.5, 0.25) };
    assert!(scene.intersect(&backwards, &mut Query::new(&backwards)).is_none());
}

#[test]
fn memory_is_counted_and_given_back() {
    let device = Device::new(1).expect("a device");
    let before = device.bytes();
    let positions: Vec<[f32; 3]> = (0..30_000).map(|i| [i as f32, (i % 7) as f32, (i % 3) as f32]).collect();
    let triangles: Vec<[u32; 3]> = (0..10_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut builder = builder(&device);
    builder.triangles(&positions, &triangles, false).expect("triangles");
    let scene = builder.commit().expect("a committed scene");
    assert!(device.bytes() > before + 30_000 * 12, "{} bytes", device.bytes());
    assert!(device.peak_bytes() >= device.bytes());
    let held = device.bytes();
    drop(scene);
    assert!(device.bytes() < held / 10, "{} of {held} bytes are still held", device.bytes());
}
