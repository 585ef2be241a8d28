//! Textures: types of expressions that vary, and the values that they have.

mod common;

use arsc_ir::{Bsdf, Ir, Parameter, Part};
use arsc_texture::Inputs;
use common::{expect, findings, run};
use glam::{DVec2, DVec3};

const MATERIALS: &str = "lambert oren_nayar phong rough_conductor mirror dielectric mix mapped";
const TEXTURES: &str = "position world_position normal uv noise fbm turbulence select step pulse fraction to_nearest \
    checker checker_cubes grid_lines stripes marble wood";

/// With the imports that it needs.
fn script(text: &str) -> String {
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let import = |module: &str, names: &str| {
        let used: Vec<&str> = names.split(' ').filter(|name| words.contains(name)).collect();
        if used.is_empty() { String::new() } else { format!("import std.{module} {{ {} }}\n", used.join(", ")) }
    };
    format!("{}{}{text}", import("material", MATERIALS), import("texture", TEXTURES))
}

fn scene(bsdf: &str) -> String {
    script(&format!("scene {{ sphere() |> with({bsdf}) }}"))
}

#[track_caller]
fn ir(bsdf: &str) -> Ir {
    let analysed = run(&scene(bsdf));
    analysed.ir.unwrap_or_else(|| panic!("{bsdf}: {:?}", findings(&scene(bsdf))))
}

#[track_caller]
fn parts(bsdf: &str) -> Vec<Part> {
    match ir(bsdf).bsdfs.last() {
        Some(Bsdf::Varying(varying)) => varying.parts.clone(),
        other => panic!("{bsdf} does not vary: {other:?}"),
    }
}

fn inputs() -> Inputs {
    Inputs {
        p: DVec3::new(0.3, -1.2, 2.5),
        world_p: DVec3::new(5.0, 6.0, 7.0),
        uv: DVec2::new(0.25, 0.75),
        normal: DVec3::new(0.6, 0.0, 0.8),
        ..Inputs::default()
    }
}

/// The value of an expression at [`inputs`], as the reflectance at 550 nm.
#[track_caller]
fn value(expression: &str) -> f64 {
    let parts = parts(&format!("lambert({expression})"));
    let [Parameter::Reflectance(texture)] = &parts[0].parameters[..] else { panic!("{parts:?}") };
    let term =
        |term: &arsc_ir::SpectrumTerm| term.weight.evaluate(&inputs(), &mut Vec::new()) * term.spectrum.eval(550.0);
    texture.terms.iter().map(term).sum()
}

/// Each operator and function against plain arithmetic.
#[test]
fn expressions_calculate() {
    let (x, y, z) = (0.3f64, -1.2f64, 2.5f64);
    let cases = [
        ("position.x", x),
        ("position.x + 1", x + 1.0),
        ("2 - position.x", 2.0 - x),
        ("position.x * position.z", x * z),
        ("1 / position.z", 1.0 / z),
        ("position.y % 1", y.rem_euclid(1.0)),
        ("position.z ** 2", z * z),
        ("-position.y", -y),
        ("(position * 2).z", 2.0 * z),
        ("(2 * position - (0, 0, 1)).z", 2.0 * z - 1.0),
        ("(position % 1).y", y.rem_euclid(1.0)),
        ("world_position.y", 6.0),
        ("normal.z", 0.8),
        ("uv.y", 0.75),
        ("((identity() |> translate((1, 2, 3))) * position).z", z + 3.0),
        ("sqrt(position.z)", z.sqrt()),
        ("exp(position.y)", y.exp()),
        ("ln(position.z)", z.ln()),
        ("pow(position.z, 1.5)", z.powf(1.5)),
        ("sin(position.x * 1rad)", x.sin()),
        ("cos(position.x * 90deg)", (x * std::f64::consts::FRAC_PI_2).cos()),
        ("degrees(asin(position.x)) / 90", x.asin().to_degrees() / 90.0),
        ("radians(acos(position.x))", x.acos()),
        ("radians(atan2(position.y, position.x))", y.atan2(x)),
        ("abs(position.y)", 1.2),
        ("floor(position.y)", -2.0),
        ("min(position.x, 0.1)", 0.1),
        ("max(0.1, position.x)", x),
        ("clamp(position.z, 0, 1)", 1.0),
        ("lerp(1, 3, position.x)", 1.6),
        ("smoothstep(0, 1, position.x)", x * x * (3.0 - 2.0 * x)),
        ("dot(position, (1, 2, 3))", x + 2.0 * y + 3.0 * z),
        ("cross(position, (0, 0, 1)).x", y),
        ("length(position)", (x * x + y * y + z * z).sqrt()),
        ("normalize(position).z", z / (x * x + y * y + z * z).sqrt()),
        ("distance(position, point(0, 0, 0))", (x * x + y * y + z * z).sqrt()),
        ("vec3(position.z, 0, 1).x", z),
        ("vec2(1, position.x).y", x),
        ("select(position.x > 0.2 && position.y < 0, 0.25, 0.5)", 0.25),
        ("select(position.x <= 0.2 || !(position.y >= 0), 0.25, 0.5)", 0.25),
        ("select(position.x == 0.3, 0.25, 0.5)", 0.25),
        ("select(position.x != 0.3, 0.25, 0.5)", 0.5),
        ("step(0.2, position.x)", 1.0),
        ("pulse(0.4, 0.5, position.x)", 0.0),
        ("fraction(position.z)", 0.5),
        ("to_nearest(position.x)", 0.3),
        ("checker()", (0.0 - 2.0f64).rem_euclid(2.0)),
        ("checker_cubes()", (0.0 - 1.0 + 3.0f64).rem_euclid(2.0)),
        ("grid_lines(width: 0.5)", 1.0),
        ("stripes(position.x)", 1.0),
        ("noise(position)", arsc_texture::perlin(DVec3::new(x, y, z), 0)),
        ("noise(position * 2, seed: 3)", arsc_texture::perlin(DVec3::new(x, y, z) * 2.0, 3)),
        ("fbm(position, octaves: 1)", arsc_texture::perlin(DVec3::new(x, y, z), 0)),
        ("turbulence(position, octaves: 1)", arsc_texture::perlin(DVec3::new(x, y, z), 0).abs()),
    ];
    for (expression, wanted) in cases {
        let found = value(expression);
        assert!((found - wanted).abs() < 1e-12, "{expression} is {found}, not {wanted}");
    }
}

#[test]
fn spectra_blend() {
    let grey = |x: f64| format!("rgb({x}, {x}, {x})");
    let found = value(&format!("lerp({}, {}, position.x)", grey(0.2), grey(0.6)));
    assert!((found - 0.32).abs() < 1e-3, "{found}");
    let found = value(&format!("select(uv.x > 0.5, {}, {})", grey(0.2), grey(0.6)));
    assert!((found - 0.6).abs() < 1e-3, "{found}");
    let found = value(&format!("{} * uv.x + {} * uv.y / 3", grey(0.4), grey(0.8)));
    assert!((found - 0.3).abs() < 1e-3, "{found}");
    let found = value(&format!("{} * lerp(0.2, {}, uv.y)", grey(0.5), grey(0.4)));
    assert!((found - 0.175).abs() < 1e-3, "{found}");
}

/// What is the same everywhere makes the plain bsdf.
#[test]
fn constants_stay_plain() {
    let ir = ir("[lambert(lerp(0.2, 0.4, 0.5)), emitter(constant_emission(1))]");
    assert!(matches!(ir.bsdfs[..], [Bsdf::Lambert { .. }]), "{:?}", ir.bsdfs);
    let folded = ir_of_let("let t: texture = 0.25\nlet c: texture<reflectance> = t * 2", "lambert(c)");
    assert!(matches!(&folded.bsdfs[..], [Bsdf::Lambert { reflectance }] if reflectance.eval(500.0) == 0.5));
}

fn ir_of_let(items: &str, bsdf: &str) -> Ir {
    let analysed = run(&script(&format!("{items}\nscene {{ sphere() |> with({bsdf}) }}")));
    analysed.ir.unwrap_or_else(|| panic!("{:#?}", analysed.diagnostics))
}

#[test]
fn scalar_parameters_vary() {
    let at = |bsdf: &str| -> Vec<f64> {
        let part = parts(bsdf).remove(0);
        let expressions = part.parameters.iter().flat_map(Parameter::expressions);
        expressions.map(|expression| expression.evaluate(&inputs(), &mut Vec::new())).collect()
    };
    assert_eq!(at("oren_nayar(0.5, sigma: uv.x * 1rad)"), [0.25]);
    assert_eq!(at("phong(0.5, exponent: 100 * uv.x)"), [25.0]);
    assert_eq!(at("rough_conductor(0.2, 3, roughness: uv.x)"), [0.25, 0.25]);
    assert_eq!(at("rough_conductor(0.2, 3, roughness: 0.5, across: uv.y)"), [0.5, 0.75]);
    let beta = 0.25f64;
    let alpha = (2.0 / (0.5f64.ln() / beta.cos().ln() + 2.0)).sqrt();
    let found = at("rough_conductor(0.2, 3, beta: uv.x * 1rad)");
    assert!((found[0] - alpha).abs() < 1e-12, "{found:?} is not {alpha}");
}

#[test]
fn mixtures_dissolve_into_parts() {
    let weights = |bsdf: &str| -> Vec<f64> {
        parts(bsdf).iter().map(|part| part.weight.evaluate(&inputs(), &mut Vec::new())).collect()
    };
    assert_eq!(weights("mix([(1, lambert(0.2)), (3, mirror())])"), [1.0, 3.0]);
    assert_eq!(
        weights("mix([(0.5, lambert(0.2)), (uv.x, mix([(1, mirror()), (3, lambert(0.1))]))])"),
        [0.5, 0.0625, 0.1875]
    );
    let stops = "[(0, lambert(0.1)), (0.5, lambert(0.2)), (0.5, mirror()), (1, lambert(0.3))]";
    for (at, wanted) in [
        ("uv.x - 1", [1.0, 0.0, 0.0, 0.0]),
        ("uv.x", [0.5, 0.5, 0.0, 0.0]),
        ("uv.x * 2", [0.0, 0.0, 1.0, 0.0]),
        ("uv.y", [0.0, 0.0, 0.5, 0.5]),
        ("uv.y + 2", [0.0, 0.0, 0.0, 1.0]),
    ] {
        assert_eq!(weights(&format!("mapped({at}, {stops})")), wanted, "{at}");
    }
    assert!(matches!(ir("mix([(1, mirror())])").bsdfs[..], [Bsdf::Mirror { .. }]));
}

#[test]
fn errors() {
    expect(&scene("dielectric(position.x)"), &[("E0102", "position.x")]);
    expect(&scene("lambert(position)"), &[("E0102", "position")]);
    expect(&scene("lambert(sin(position.x))"), &[("E0102", "position.x")]);
    expect(&scene("lambert(if position.x > 0 { 0.2 } else { 0.4 })"), &[("E0102", "position.x > 0")]);
    expect(&scene("lambert(position.x + position)"), &[("E0107", "+")]);
    expect(&scene("lambert(position.w)"), &[("E0106", "w")]);
    let stops = "[(1, mirror()), (0, mirror())]";
    expect(&scene(&format!("mapped(uv.x, {stops})")), &[("E0201", stops)]);
    expect(&scene("mix([])"), &[("E0201", "mix([])")]);
    let found = findings("let t: texture<solid> = 1\nscene { sphere() }");
    assert!(found[0].contains("no textures of `solid`"), "{found:?}");
}

#[test]
fn reflectances_outside_of_their_range_are_found() {
    expect(&scene("lambert(noise(position * 3))"), &[("W0106", "noise(position * 3)")]);
    expect(&scene("lambert(1.5 * uv.x)"), &[("W0106", "1.5 * uv.x")]);
    expect(&scene("lambert(lerp(0.2, 0.9, marble()))"), &[]);
    expect(&scene("lambert(lerp(0.2, 0.9, wood()))"), &[]);
}

/// Expressions stay within their limits.
#[test]
fn endless_expressions_are_refused() {
    let text = script(
        "fn grow(x: texture, n: int) -> texture { if n == 0 { x } else { grow(noise(position * x), n - 1) } }\n\
         fn times(x: texture, n: int) -> texture { if n == 0 { x } else { times(grow(x, 100), n - 1) } }\n\
         scene { sphere() |> with(lambert(times(uv.x, 60))) }",
    );
    let found = findings(&text);
    assert!(found.iter().any(|finding| finding.contains("operations in one expression")), "{found:?}");
}
