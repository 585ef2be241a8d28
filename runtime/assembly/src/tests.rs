//! From an IR to pictures, with a host in memory.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use arsc_diagnostics::{SourceId, Span};
use arsc_geometry::{ClosedMesh, DAffine3, DVec3, TriangleMesh};
use arsc_ir::{
    Action, ActionAt, Attributes, Bsdf, Builder, Emitter, Environment, Exposure, Ir, NodeId, NodeKind, PathTrace,
    Precedence, Sampling, Shape, Spectrum, Surface, ToneMap,
};

use crate::{AssemblyError, Host, HostError, Outcome, Settings, run};

/// Keeps what is written; `cancel_after` counts the questions whether to stop.
#[derive(Default)]
struct Memory {
    written: Mutex<BTreeMap<String, Vec<u8>>>,
    said: Mutex<Vec<String>>,
    cancelled: bool,
}

struct Flag(bool);

impl arsc_render::Progress for Flag {
    fn advance(&self, _: u64) {}
    fn cancelled(&self) -> bool {
        self.0
    }
}

impl Host for Memory {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<Option<PathBuf>, HostError> {
        self.written.lock().unwrap().insert(name.to_owned(), bytes.to_vec());
        Ok(Some(PathBuf::from(name)))
    }

    fn say(&self, line: &str) {
        self.said.lock().unwrap().push(line.to_owned());
    }

    fn begin(&self, _: u64, _: Option<f64>) -> Box<dyn arsc_render::Progress + '_> {
        Box::new(Flag(self.cancelled))
    }

    fn seconds(&self) -> f64 {
        0.0
    }
}

const NOWHERE: Span = Span { source: SourceId(0), start: 0, end: 0 };

fn environment(builder: &mut Builder, radiance: f64) -> NodeId {
    let environment = Environment::Constant { radiance: Spectrum::Constant(radiance) };
    builder.push(NodeKind::Environment(Box::new(environment)), NOWHERE)
}

/// Everything in `parts`, in the normal form.
fn scene(mut builder: Builder, parts: Vec<NodeId>, actions: Vec<Action>) -> Ir {
    let root = builder.union(parts, NOWHERE);
    let mut ir = builder.finish(root);
    ir.actions = actions.into_iter().map(|action| ActionAt { action, origin: NOWHERE }).collect();
    let optimised = arsc_opt::optimise(ir, &arsc_opt::Options::default());
    assert!(!optimised.diagnostics.iter().any(arsc_diagnostics::Diagnostic::is_error));
    optimised.ir
}

/// A white sphere with a bite taken out, under a constant sky.
fn bitten_sphere(actions: Vec<Action>) -> Ir {
    let mut b = Builder::new();
    let ball = b.solid(Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY, NOWHERE);
    let bite = b.solid(Shape::Sphere { radius: 0.8 }, DAffine3::from_translation(DVec3::new(0.5, -0.8, 0.5)), NOWHERE);
    let solid = b.difference(vec![ball, bite], NOWHERE);
    let bsdf = Some(b.bsdf(Bsdf::Lambert { reflectance: Spectrum::Constant(0.8) }));
    let attributes = Attributes { bsdf, ..Attributes::default() };
    let solid = b.attributes(attributes, Precedence::Inner, solid, NOWHERE);
    let sky = environment(&mut b, 1.0);
    scene(b, vec![solid, sky], actions)
}

fn small() -> Settings {
    Settings { samples: Some(4), resolution: Some([24, 16]), scene_name: "bitten".into(), ..Settings::default() }
}

fn render(ir: &Ir, settings: &Settings) -> (Outcome, BTreeMap<String, Vec<u8>>) {
    let host = Memory::default();
    let outcome = run(ir, settings, &host).unwrap();
    (outcome, host.written.into_inner().unwrap())
}

#[test]
fn a_scene_without_camera_and_actions_gives_two_pictures() {
    let (outcome, files) = render(&bitten_sphere(vec![]), &small());
    assert_eq!(outcome.written, [PathBuf::from("bitten.exr"), PathBuf::from("bitten.png")]);
    assert_eq!(outcome.renders[0].camera_paths, 24 * 16 * 4);
    assert!(!outcome.interrupted);
    let image = arsc_image::decode_exr(&files["bitten.exr"]).unwrap();
    assert_eq!((image.width, image.height), (24, 16));
    // The corner sees the sky, radiance 1; the middle of the picture sees the darker ball.
    let radiance = |x: usize, y: usize| image.radiance[(y * 24 + x) * image.bands() + 20];
    assert!((radiance(0, 0) - 1.0).abs() < 1e-3, "{}", radiance(0, 0));
    assert!(radiance(12, 8) > 0.2 && radiance(12, 8) < 0.95, "{}", radiance(12, 8));
    let of = |name: &str| image.metadata.iter().find(|(n, _)| n == name).map(|(_, value)| value.as_str());
    assert_eq!((of("samples"), of("seed"), of("renderSeconds")), (Some("4"), Some("0"), None));
}

#[test]
fn threads_and_strategies_do_not_change_a_byte_of_the_pixels() {
    let ir = bitten_sphere(vec![]);
    let one = render(&ir, &Settings { threads: Some(1), ..small() }).1;
    let three = render(&ir, &Settings { threads: Some(3), ..small() }).1;
    assert_eq!(one, three);
    let pixels = |files: &BTreeMap<String, Vec<u8>>| arsc_image::decode_exr(&files["bitten.exr"]).unwrap().radiance;
    let local = pixels(&one);
    for strategy in arsc_accel::Strategy::ALL {
        let other = pixels(&render(&ir, &Settings { strategy: Some(strategy), ..small() }).1);
        let worst = local.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-3, "{} differs by {worst}", strategy.name());
    }
    let seed = render(&ir, &Settings { seed: Some(1), ..small() }).1;
    assert_ne!(pixels(&one), pixels(&seed));
}

#[test]
fn a_crop_gives_the_pixels_of_the_whole_picture() {
    let ir = bitten_sphere(vec![]);
    let pixels = |settings: &Settings| arsc_image::decode_exr(&render(&ir, settings).1["bitten.exr"]).unwrap().xyz;
    let whole = pixels(&small());
    let cropped = pixels(&Settings { crop: Some([5, 3, 20, 9]), ..small() });
    for (i, (whole, cropped)) in whole.iter().zip(&cropped).enumerate() {
        let inside = (5..20).contains(&(i % 24)) && (3..9).contains(&(i / 24));
        assert_eq!(*cropped, if inside { *whole } else { [0.0; 3] }, "pixel {i}");
    }
    for crop in [[0, 0, 25, 4], [5, 5, 5, 6]] {
        let refused = run(&ir, &Settings { crop: Some(crop), ..small() }, &Memory::default());
        assert!(matches!(refused, Err(AssemblyError::Settings(_))));
    }
}

#[test]
fn stack_words_do_what_they_say() {
    let trace = Action::PathTrace(PathTrace {
        sampling: Sampling { seed: 9, ..Sampling::of(1) },
        max_depth: 3,
        ..PathTrace::default()
    });
    let exr = |name: &str| Action::WriteExr { path: name.into() };
    let tone_map =
        Action::ToneMap { tone: ToneMap { exposure: Exposure::Ev(0.0), ..ToneMap::default() }, slice_nm: None };
    let png = |name: &str| Action::WritePng { path: name.into(), sixteen_bit: false };
    let actions = vec![
        trace.clone(),
        Action::Dup,
        tone_map.clone(),
        png("a.png"),
        Action::Drop,
        exr("b.exr"),
        Action::Over,
        trace,
        exr("c.exr"),
        Action::Swap,
        Action::Drop,
        tone_map,
        png("d.png"),
    ];
    let (outcome, files) = render(&bitten_sphere(actions), &Settings { samples: None, ..small() });
    assert_eq!(outcome.renders.len(), 2);
    assert_eq!(files.keys().collect::<Vec<_>>(), ["a.png", "b.exr", "c.exr", "d.png"]);
    assert_eq!(files["b.exr"], files["c.exr"], "the same render twice");
    assert_eq!(files["a.png"], files["d.png"]);
}

#[test]
fn a_sequence_that_does_not_fit_is_an_error() {
    let refused = |actions: Vec<Action>| run(&bitten_sphere(actions), &small(), &Memory::default()).unwrap_err();
    let stack = |error: AssemblyError| match error {
        AssemblyError::Stack { action, found, .. } => (action, found),
        other => panic!("{other}"),
    };
    let exr = Action::WriteExr { path: "a.exr".into() };
    assert_eq!(stack(refused(vec![exr.clone()])), ("write_exr", "a scene"));
    assert_eq!(stack(refused(vec![Action::Drop, Action::Drop])), ("drop", "nothing"));
    assert_eq!(stack(refused(vec![Action::Swap])), ("swap", "a scene"));
    assert_eq!(stack(refused(vec![Action::Drop, exr])), ("write_exr", "nothing"));
}

#[test]
fn a_render_without_a_sample_writes_nothing() {
    let host = Memory { cancelled: true, ..Memory::default() };
    let outcome = run(&bitten_sphere(vec![]), &small(), &host).unwrap();
    assert!(outcome.interrupted && outcome.written.is_empty());
    assert!(host.written.into_inner().unwrap().is_empty());
}

#[test]
fn lights_and_bounds_are_told() {
    let mut b = Builder::new();
    let lamp = b.surface(Surface::Rectangle { width: 2.0, depth: 3.0 }, DAffine3::IDENTITY, NOWHERE);
    let emitter = Some(b.emitter(Emitter { radiance: Spectrum::Constant(1.0), two_sided: false, thermal: false }));
    let lamp = b.attributes(Attributes { emitter, ..Attributes::default() }, Precedence::Inner, lamp, NOWHERE);
    let ball = b.solid(Shape::Sphere { radius: 2.0 }, DAffine3::from_translation(DVec3::Z * 5.0), NOWHERE);
    let ir = scene(b, vec![ball, lamp], vec![Action::BoundingBoxes, Action::CollectLights]);
    let host = Memory::default();
    run(&ir, &small(), &host).unwrap();
    let said = host.said.into_inner().unwrap().join("\n");
    assert!(said.contains("bounds of the scene: [-2, -2, 0] to [2, 2, 7]"), "{said}");
    // pi W m^-2 nm^-1 on 6 m^2 over 470 nm.
    assert!(said.contains("light sources: 1\n") && said.contains(": 8.8593e3 W"), "{said}");
}

#[test]
fn an_endless_floor_does_not_make_the_sky_outweigh_the_lamps() {
    let mut b = Builder::new();
    let floor = b.surface(Surface::Plane, DAffine3::IDENTITY, NOWHERE);
    let ball = b.solid(Shape::Sphere { radius: 2.0 }, DAffine3::from_translation(DVec3::Z * 5.0), NOWHERE);
    let sky = environment(&mut b, 1.0);
    let ir = scene(b, vec![floor, ball, sky], vec![Action::CollectLights]);
    let host = Memory::default();
    run(&ir, &small(), &host).unwrap();
    // 4 pi^2 W m^-2 nm^-1 on the square of 12^(1/2) m, the radius of a sphere about the ball's box, over 470 nm.
    let said = host.said.into_inner().unwrap().join("\n");
    assert!(said.contains("environment 0: 2.2266e5 W"), "{said}");
}

#[test]
fn a_lamp_goes_behind_the_ceiling_in_whose_plane_it_lies() {
    let mut b = Builder::new();
    let ceiling = b.surface(Surface::Rectangle { width: 9.0, depth: 9.0 }, DAffine3::IDENTITY, NOWHERE);
    let lamp = b.surface(Surface::Rectangle { width: 2.0, depth: 3.0 }, DAffine3::IDENTITY, NOWHERE);
    let emitter = Some(b.emitter(Emitter { radiance: Spectrum::Constant(1.0), two_sided: false, thermal: false }));
    let lamp = b.attributes(Attributes { emitter, ..Attributes::default() }, Precedence::Inner, lamp, NOWHERE);
    let ir = scene(b, vec![lamp, ceiling], vec![]);
    let surfaces = crate::geometry::lower(&ir).unwrap().surfaces;
    let emits = |i: usize| ir.materials[surfaces[i].material.0 as usize].emitter.is_some();
    assert!(surfaces.len() == 2 && !emits(0) && emits(1));
}

#[test]
fn meshes_are_traced_as_surfaces_and_as_solids() {
    let mesh = TriangleMesh {
        positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        ..TriangleMesh::default()
    };
    let (closed, _) = ClosedMesh::new("a.ply".into(), mesh.clone()).unwrap();
    let closed = Arc::new(closed);
    for open in [true, false] {
        let mut b = Builder::new();
        let part = if open {
            let surface = Surface::Mesh { path: "a.ply".into(), mesh: Arc::new(mesh.clone()) };
            b.surface(surface, DAffine3::IDENTITY, NOWHERE)
        } else {
            b.solid(Shape::Mesh(closed.clone()), DAffine3::IDENTITY, NOWHERE)
        };
        let sky = environment(&mut b, 1.0);
        let ir = scene(b, vec![part, sky], vec![Action::BoundingBoxes]);
        let host = Memory::default();
        run(&ir, &small(), &host).unwrap();
        assert!(host.said.into_inner().unwrap()[0].ends_with("[0, 0, 0] to [2, 3, 1]"));
    }
}
