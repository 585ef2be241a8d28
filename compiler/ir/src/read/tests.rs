//! What is written reads back, and what has no form is refused where it has none.

use super::*;
use crate::{
    Across, Builder, Camera, Environment, Filter, FisheyeMapping, Focus, Lens, Light, Projection, Sky, SkyModel, verify,
};
use arsc_geometry::DAffine3;
use arsc_spectral::{Channels, PhotometricWeb};
use proptest::prelude::*;

fn tone(ev: f64) -> crate::ToneMap {
    crate::ToneMap { exposure: crate::Exposure::Ev(ev), ..crate::ToneMap::default() }
}

fn number() -> impl Strategy2<Value = f64> {
    prop_oneof![-10.0..10.0f64, Just(-0.0), Just(1e-300), Just(0.1), -1e300..1e300f64]
}

// The name of proptest's trait is taken by CSG strategies.
use proptest::strategy::Strategy as Strategy2;

fn positive() -> impl Strategy2<Value = f64> {
    prop_oneof![1e-3..1e3f64, Just(f64::MIN_POSITIVE)]
}

fn vector() -> impl Strategy2<Value = DVec3> {
    [number(), number(), number()].prop_map(DVec3::from_array)
}

fn any_spectrum() -> impl Strategy2<Value = Spectrum> {
    let leaf = prop_oneof![
        number().prop_map(Spectrum::Constant),
        positive().prop_map(|kelvin| Spectrum::Blackbody { kelvin }),
        (number(), positive(), number()).prop_map(|(center_nm, sigma_nm, peak)| Spectrum::Gaussian {
            center_nm,
            sigma_nm,
            peak
        }),
        (number(), prop::collection::vec((number(), number()), 1..5)).prop_map(|(a, terms)| {
            let (b, c_um2): (Vec<f64>, Vec<f64>) = terms.into_iter().unzip();
            Spectrum::Sellmeier { a, b: b.into(), c_um2: c_um2.into() }
        }),
        (number(), number(), number()).prop_map(|(a, b_um2, c_um4)| Spectrum::Cauchy { a, b_um2, c_um4 }),
        [number(), number(), number()].prop_map(|coefficients| Spectrum::Sigmoid { coefficients }),
        prop::collection::vec(number(), 1..5).prop_map(|values| Spectrum::Tabulated {
            lambda_nm: (0..values.len()).map(|i| 400.0 + i as f64).collect(),
            values: values.into(),
        }),
    ];
    leaf.prop_recursive(3, 8, 2, |inner| {
        prop_oneof![
            (number(), inner.clone())
                .prop_map(|(factor, spectrum)| Spectrum::Scaled { factor, spectrum: Arc::new(spectrum) }),
            (positive(), inner.clone()).prop_map(|(thickness, transmission)| Spectrum::Absorbance {
                transmission: Arc::new(transmission),
                thickness
            }),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| Spectrum::Product(Arc::new(a), Arc::new(b))),
            (inner.clone(), inner).prop_map(|(a, b)| Spectrum::Sum(Arc::new(a), Arc::new(b))),
        ]
    })
}

fn any_map() -> impl Strategy2<Value = DAffine3> {
    prop_oneof![
        Just(DAffine3::IDENTITY),
        vector().prop_map(DAffine3::from_translation),
        (-3.0..3.0f64, [0.1..5.0f64, 0.1..5.0f64, -5.0..-0.1f64], vector()).prop_map(|(angle, scale, by)| {
            let turned = DAffine3::from_rotation_z(angle) * DAffine3::from_scale(DVec3::from_array(scale));
            DAffine3 { translation: by, ..turned }
        }),
    ]
}

fn tetrahedron() -> Arc<TriangleMesh> {
    Arc::new(TriangleMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        ..TriangleMesh::default()
    })
}

fn any_leaf() -> impl Strategy2<Value = Leaf> {
    let mesh_solid = "[a-z]{1,8}".prop_map(|path| {
        let (mesh, _) = ClosedMesh::new(path.into(), (*tetrahedron()).clone()).unwrap();
        Shape::Mesh(Arc::new(mesh))
    });
    let shape = prop_oneof![9 => crate::shape_text::tests::any_shape(), 1 => mesh_solid];
    let surface = prop_oneof![
        [vector(), vector(), vector()].prop_map(Surface::Triangle),
        [vector(), vector(), vector(), vector()].prop_map(Surface::Quad),
        (positive(), positive()).prop_map(|(width, depth)| Surface::Rectangle { width, depth }),
        positive().prop_map(|radius| Surface::Disk { radius }),
        Just(Surface::Plane),
        "[ -~é\n\"\\\\]{1,8}".prop_map(|path| Surface::Mesh { path: path.into(), mesh: tetrahedron() }),
    ];
    prop_oneof![
        (shape, any_map()).prop_map(|(shape, parent_from_object)| Leaf::Solid {
            shape,
            parent_from_object,
            material: None
        }),
        (surface, any_map()).prop_map(|(surface, parent_from_object)| Leaf::Surface {
            surface,
            parent_from_object,
            material: None
        }),
    ]
}

/// What a node is made of, with operands as numbers to be taken modulo the nodes so far.
#[derive(Clone, Debug)]
enum Recipe {
    Leaf(Leaf),
    Boolean(u8, Vec<usize>),
    Transform(DAffine3, usize),
    Attributes(Attributes, bool, usize),
    Light(Spectrum, bool),
    Sky(Spectrum, bool),
}

fn any_recipe() -> impl Strategy2<Value = Recipe> {
    let cut = prop_oneof![Just(None), Just(Some(CutRule::Inherit)), Just(Some(CutRule::Bsdf(1)))];
    let (bsdf, emitter, medium) = (prop::option::of(0..2u32), prop::option::of(0..1u32), prop::option::of(0..3u32));
    let bundle = (bsdf, emitter, medium, cut, prop::option::of(0..9u32))
        .prop_map(|(bsdf, emitter, medium, cut, face)| Attributes { bsdf, emitter, medium, cut, face });
    prop_oneof![
        4 => any_leaf().prop_map(Recipe::Leaf),
        4 => (0..4u8, prop::collection::vec(any::<usize>(), 1..4)).prop_map(|(kind, of)| Recipe::Boolean(kind, of)),
        2 => (any_map(), any::<usize>()).prop_map(|(map, of)| Recipe::Transform(map, of)),
        2 => (bundle, any::<bool>(), any::<usize>()).prop_map(|(a, inner, of)| Recipe::Attributes(a, inner, of)),
        1 => (any_spectrum(), any::<bool>()).prop_map(|(s, distant)| Recipe::Light(s, distant)),
        1 => (any_spectrum(), any::<bool>()).prop_map(|(s, sky)| Recipe::Sky(s, sky)),
    ]
}

fn any_ir() -> impl Strategy2<Value = Ir> {
    let tables = (any_spectrum(), any_spectrum(), number());
    (prop::collection::vec(any_recipe(), 1..30), tables, any::<[u32; 3]>()).prop_map(|(recipes, tables, numbers)| {
        let mut b = Builder::new();
        b.bsdf(Bsdf::OrenNayar { reflectance: tables.0.clone(), sigma: tables.2 });
        b.bsdf(Bsdf::Conductor { eta: tables.0.clone(), k: tables.1.clone() });
        let media = [
            (PhaseFunction::Isotropic, Density::Uniform),
            (PhaseFunction::HenyeyGreenstein { g: tables.2 }, Density::Gaussian { center: DVec3::X, sigma: tables.2 }),
            (
                PhaseFunction::Rayleigh { depolarisation: tables.2 },
                Density::Exponential { ground: -0.0, height: tables.2 },
            ),
        ];
        for (phase, density) in media {
            let (absorption, scattering) = (tables.0.clone(), tables.1.clone());
            let dye = Dye { absorption: absorption.clone(), emission: scattering.clone(), quantum_yield: tables.2 };
            let dyes = vec![dye; numbers[0] as usize % 3];
            b.medium(Medium { absorption, scattering, emission: tables.0.clone(), dyes, phase, density });
        }
        b.bsdf(Bsdf::Inert);
        let distribution = Distribution::ALL[numbers[1] as usize % 3];
        let facets = Facets { distribution, alpha: [0.1, 0.7] };
        b.bsdf(Bsdf::RoughConductor { eta: tables.1.clone(), k: tables.0.clone(), facets });
        b.bsdf(Bsdf::RoughDielectric { ior: tables.1.clone(), facets });
        b.bsdf(Bsdf::ThinDielectric { ior: tables.0.clone() });
        b.bsdf(Bsdf::Phong { reflectance: tables.1.clone(), exponent: tables.2 });
        b.bsdf(Bsdf::Polariser { transmittance: tables.0.clone(), angle: tables.2 });
        b.bsdf(Bsdf::Retarder { retardance: tables.2, angle: -0.5 });
        b.bsdf(Bsdf::Depolariser { transmittance: tables.0.clone() });
        b.bsdf(Bsdf::Measured { path: "a.binary".into(), brdf: table() });
        b.bsdf(Bsdf::Layered {
            coat: Arc::new(Bsdf::RoughDielectric { ior: tables.1.clone(), facets }),
            base: Arc::new(Bsdf::Lambert { reflectance: tables.0.clone() }),
            absorption: tables.1.clone(),
            thickness: tables.2,
        });
        let dye = Dye { absorption: tables.0.clone(), emission: tables.1.clone(), quantum_yield: 0.5 };
        let (excitation_nm, emission_nm) = ([400.0, 10.0], [tables.2, 5.0]);
        let matrix = DonaldsonMatrix { excitation_nm, emission_nm, columns: 2, entries: [0.0, tables.2].into() };
        for fluorescence in [Fluorescence::Dye(dye), Fluorescence::Matrix(matrix)] {
            let reradiation = Reradiation { reflectance: tables.0.clone(), fluorescence };
            b.bsdf(Bsdf::Fluorescent { reradiation, sigma: 0.25 });
        }
        b.emitter(Emitter {
            radiance: tables.1,
            two_sided: numbers[0].is_multiple_of(2),
            thermal: numbers[1].is_multiple_of(2),
        });
        for (i, recipe) in recipes.into_iter().enumerate() {
            let origin = Span { source: SourceId(i as u32), start: numbers[1] / 2, end: u32::MAX };
            let id = |of: usize| NodeId((of % i.max(1)) as u32);
            let kind = match recipe {
                Recipe::Boolean(kind, of) if i > 0 => {
                    let of = of.into_iter().map(id).collect();
                    [NodeKind::Union, NodeKind::Intersection, NodeKind::Difference, NodeKind::Group][kind as usize](of)
                }
                Recipe::Transform(map, of) if i > 0 => {
                    NodeKind::Transform { parent_from_child: Box::new(map), child: id(of) }
                }
                Recipe::Attributes(attributes, inner, of) if i > 0 => {
                    let precedence = if inner { Precedence::Inner } else { Precedence::Outer };
                    NodeKind::Attributes { attributes, precedence, child: id(of) }
                }
                Recipe::Light(intensity, false) if numbers[0] % 3 == 0 => {
                    NodeKind::Light(Box::new(Light::Spot { intensity, exponent: tables.2, angle: 0.7 }))
                }
                Recipe::Light(spectrum, false) if numbers[0] % 3 == 1 => {
                    let web = PhotometricWeb::new(vec![0.0, 90.0], vec![0.0, 360.0], vec![1.0, 0.5, 1.0, 0.5]);
                    let web = web.expect("a valid table").into();
                    NodeKind::Light(Box::new(Light::Photometric { web, spectrum }))
                }
                Recipe::Light(intensity, false) => NodeKind::Light(Box::new(Light::Point { intensity })),
                Recipe::Light(irradiance, true) => {
                    NodeKind::Light(Box::new(Light::Distant { irradiance, direction: DVec3::Z }))
                }
                Recipe::Sky(radiance, false) => NodeKind::Environment(Box::new(Environment::Constant { radiance })),
                Recipe::Sky(_, true) if numbers[0] % 3 == 0 => {
                    NodeKind::Environment(Box::new(Environment::Medium { medium: 2 }))
                }
                Recipe::Sky(_, true) if numbers[0] % 3 == 1 => NodeKind::Environment(Box::new(Environment::Image {
                    path: "a\u{e9}.hdr".into(),
                    image: pixel(),
                    scale: tables.2,
                })),
                Recipe::Sky(_, true) => NodeKind::Environment(Box::new(Environment::Sky(Sky {
                    model: SkyModel::ALL[numbers[1] as usize % 2],
                    turbidity: tables.2,
                    ground_albedo: 0.1,
                    sun: DVec3::new(-0.0, 0.6, 0.8),
                    solar_disc: numbers[2] % 2 == 0,
                    scale: 1.0,
                    star_temperature: (numbers[2] % 3 == 0).then_some(9600.0),
                    star_intensity: 1.5,
                    polarised: numbers[2] % 2 == 1,
                }))),
                Recipe::Leaf(leaf) => NodeKind::Leaf(Box::new(leaf)),
                _ => NodeKind::Union(Vec::new()),
            };
            b.push(kind, origin);
        }
        let last = NodeId(b.len() as u32 - 1);
        b.camera(some_camera(tables.2, numbers[0], numbers[1]));
        let at = Span::new(SourceId(0), 3, 9);
        let wavelengths = WavelengthRange::new(300.0, 777.5).unwrap();
        let (band_nm, observer) = (tables.2, Observer::Cie2015Deg10);
        let sampling = Sampling {
            samples: numbers[2],
            seed: u64::MAX,
            sampler: Sampler::ALL[numbers[0] as usize % 3],
            noise: (numbers[1].is_multiple_of(2)).then_some(tables.2),
            time_limit: (numbers[1].is_multiple_of(3)).then_some(tables.2),
        };
        let trace = PathTrace {
            sampling,
            max_depth: 3,
            wavelengths,
            band_nm,
            observer,
            polarised: true,
            features: numbers[0].is_multiple_of(2),
        };
        b.action(Action::PathTrace(trace), at);
        b.action(Action::AmbientOcclusion { distance: f64::INFINITY, sampling: Sampling::of(3) }, at);
        b.action(Action::Preview { sampling, features: numbers[1].is_multiple_of(2) }, at);
        b.action(Action::ToneMap { tone: tone(tables.2), slice_nm: None }, at);
        b.action(Action::WritePng { path: "a \"quoted\\\" \u{1} path.png".to_owned(), sixteen_bit: true }, at);
        b.finish(last)
    })
}

fn pixel() -> Arc<Raster> {
    Arc::new(Raster::new(1, 1, Channels::Rgb, vec![1.0; 3]).expect("a pixel"))
}

fn table() -> Arc<MerlBrdf> {
    static TABLE: std::sync::LazyLock<Arc<MerlBrdf>> =
        std::sync::LazyLock::new(|| Arc::new(MerlBrdf::from_fn(|_| [0.1; 3])));
    TABLE.clone()
}

/// A file of each kind under every name.
struct Files;

impl Contents for Files {
    fn mesh(&self, _path: &str) -> Option<Arc<TriangleMesh>> {
        Some(tetrahedron())
    }

    fn brdf(&self, _path: &str) -> Option<Arc<MerlBrdf>> {
        Some(table())
    }

    fn image(&self, _path: &str) -> Option<Arc<Raster>> {
        Some(pixel())
    }
}

/// A camera of any kind, with and without what may be left out.
fn some_camera(x: f64, kind: u32, resolution: u32) -> Camera {
    let across = Across::ALL[kind as usize / 8 % 4];
    let focus = [Focus::Distance(x), Focus::Point(DVec3::splat(x)), Focus::Target][kind as usize % 3];
    let lens = Lens { radius: x, blades: kind, rotation: -x, focus };
    let mapping = FisheyeMapping::ALL[kind as usize / 32 % 2];
    let filters = [Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: x }, Filter::Lanczos { radius: x }];
    let all = (kind / 64).is_multiple_of(2);
    Camera {
        projection: match kind % 5 {
            0 => Projection::Perspective { fov: x, across },
            1 => Projection::ThinLens { fov: x, across, lens },
            2 => Projection::Orthographic { extent: x, across },
            3 => Projection::Fisheye { mapping, fov: x, across },
            _ => Projection::Panorama,
        },
        eye: DVec3::X,
        target: all.then_some(DVec3::new(x, -0.0, 1e-9)),
        up: DVec3::Z,
        twist: if all { x } else { 0.0 },
        fit: all.then_some(x),
        resolution: [kind, resolution],
        pixel_aspect: if all { x } else { 1.0 },
        crop: all.then_some([0.0, x, 0.5, 1.0]),
        filter: filters[kind as usize % 2],
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_printed_reads_back_and_prints_the_same(ir in any_ir()) {
        let text = ir.to_string();
        let back = read_with(&text, &Files).map_err(|error| TestCaseError::fail(format!("{error}\n{text}")))?;
        prop_assert_eq!(&back, &ir);
        prop_assert_eq!(back.to_string(), text);
    }

    #[test]
    fn garbage_is_an_error_and_no_panic(prefix in 0..400usize, garbage in "[ -~é\n]{0,30}") {
        let text = "ir 1\nbsdf b0 = lambert(reflectance: tabulated(lambda_nm: [1.0], values: [2.0]))\n\
                    material m0 = material(bsdf: b0)\n%0 = sphere(radius: 1.0, at: [1.0, 2.0, 3.0]) @0:1..2\n\
                    %1 = mesh(path: \"a\\u{e9}\") @0:1..2\n%2 = with(%0, cut: b0) @0:2..3\nroot %2\n";
        let mut end = prefix.min(text.len());
        while !text.is_char_boundary(end) { end -= 1; }
        let damaged = format!("{}{garbage}{}", &text[..end], &text[end..]);
        if let Ok(ir) = read_with(&damaged, &Files) {
            let _ = verify(&ir);
        }
    }
}

#[test]
fn errors_name_the_place() {
    let cases = [
        ("", "1:1: expected `ir`"),
        ("ir 1\n%0 = sphere() @0:1..2\nroot %0", "2:6: `sphere` lacks `radius`"),
        ("ir 1\n%0 = union(%0) @0:1..2\nroot %0", "2:12: not defined before its use"),
        ("ir 1\n%1 = union() @0:1..2\nroot %1", "2:1: expected the next node, `%0`"),
        ("ir 1\n%0 = union() @0:1..2\n", "3:1: there is no `root`"),
        ("ir 1\n%0 = plane(at: [1, 2]) @0:1..2", "2:16: expected 3 numbers"),
        ("ir 1\n%0 = mesh(path: \"a.ply\") @0:1..2", "2:6: there is no mesh `a.ply`"),
        ("ir 1\n%0 = plane(size: 2) @0:1..2", "2:18: `plane` takes no such argument"),
    ];
    for (text, expected) in cases {
        assert_eq!(read(text).expect_err(text).to_string(), expected);
    }
}

#[test]
fn deep_nesting_is_an_error() {
    let text = format!("ir 1\nbsdf b0 = mirror(reflectance: {}", "scaled(2.0, ".repeat(100_000));
    assert!(read(&text).expect_err("too deep").message.contains("nested"));
}

/// Every operation, input and parameter of what varies.
#[test]
fn what_varies_reads_back() {
    use arsc_texture::{Binary, Input, Unary};
    let mut steps: Vec<String> = Input::ALL.iter().map(|input| input.name().to_owned()).collect();
    steps.push("-2.5".into());
    steps.extend(Unary::ALL.iter().map(|op| format!("{}(3)", op.name())));
    steps.extend(Binary::ALL.iter().map(|op| format!("{}(3, 17)", op.name())));
    steps.push("select(1, 2, 3)".into());
    steps.push("noise(0, 1, 2, seed: 4294967295)".into());
    steps.push("fbm(0, 1, 2, seed: 1, octaves: 6, lacunarity: 2.0, gain: 0.5)".into());
    steps.push("turbulence(0, 1, 2, seed: 1, octaves: 6, lacunarity: 2.0, gain: 0.5)".into());
    let laid = "path: \"a.png\", repeat: true, smooth: false, data: false";
    steps.push(format!("image(6, 7, channel: 2, {laid})"));
    let long = format!("expression({})", steps.join(", "));
    let rough = "rough_conductor(eta: constant(0.2), k: constant(3.0), distribution: ggx, alpha: [0.1, 0.1])";
    let text = format!(
        "ir 1\nbsdf b0 = varying(part(oren_nayar(reflectance: constant(0.5), sigma: 0.0), weight: {long}, reflectance: \
         blend(term(expression(u), constant(1.0)), term({long}, constant(0.5), color: rgb(expression(u), expression(v), \
         expression(1.0))), term(expression(1.0), constant(1.0), color: image(expression(u), expression(v), {laid}))), sigma: expression(v)), \
         part(phong(reflectance: constant(0.5), exponent: 1.0), weight: expression(1.0), exponent: expression(u), height: expression(v), normal: \
         normal(expression(u), expression(v), expression(1.0))), \
         part({rough}, weight: expression(1.0), roughness: expression(u), across: expression(v)), \
         at: [1.0, 2.0, 3.0])\n%0 = sphere(radius: 1.0) @0:0..1\nroot %0\n"
    );
    let ir = read_with(&text, &Files).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(ir.to_string(), text);
    assert_eq!(verify(&ir), Ok(()));
    let broken = [
        ("expression(u)", "expression(add(0, 0))", "an operand does not stand before its step"),
        ("expression(u)", "expression()", "an expression has no steps"),
        ("expression(u)", "expression(inf)", "`inf` is no input"),
        ("octaves: 6", "octaves: 60", "a noise has too many octaves"),
        ("part(phong", "part(varying", "lacks an operand"),
        ("weight: expression(1.0), exponent", "exponent", "`part` lacks `weight`"),
    ];
    for (from, to, wanted) in broken {
        let error = read_with(&text.replacen(from, to, 1), &Files).expect_err(to);
        assert!(error.message.contains(wanted), "{to}: {error}");
    }
    let wrong = text.replacen("sigma: expression(v)", "exponent: expression(v)", 1);
    let found = verify(&read_with(&wrong, &Files).unwrap()).unwrap_err();
    assert_eq!(found[0].message, "a bsdf has no such parameter");
}
