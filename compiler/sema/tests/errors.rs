//! One finding per root cause, at the right place.

mod common;

use common::{Session, expect, findings};

#[test]
fn names() {
    expect("scene { spehre(radius: 1) }", &[("E0101", "spehre")]);
    expect("import std.material { lambrt }\nscene { sphere() |> with(lambrt(0.5)) }", &[("E0101", "lambrt")]);
    expect("import std.material\nscene { sphere() |> with(material.lambrt(0.5)) }", &[("E0101", "lambrt")]);
    expect("scene { sphere() |> with(lambert(0.5)) }", &[("E0101", "lambert")]);
    expect("let a = 1\nfn a() -> int { 2 }", &[("E0103", "a")]);
    expect("fn f(x: int, x: int) -> int { x }", &[("E0103", "x"), ("W0108", "x"), ("W0102", "x")]);
    expect("let r = { a: 1, a: 2 }", &[("E0103", "a")]);
    expect("let r = { width: 1 }\nlet x = r.widht", &[("E0106", "widht")]);
    expect("let x = (1, 2).x", &[("E0106", "x")]);
    expect("scene { sphere() |> with(emitter(d65)) }", &[("E0101", "d65")]);
    // A name that could not be found silences what depends on it.
    expect("let a = nope\nlet b = a + 1\nscene { sphere(b).foo }", &[("E0101", "nope"), ("E0106", "foo")]);
    let found = findings("scene { spehre() }");
    assert_eq!(found, ["E0101 \"spehre\": `spehre` is not defined"]);
}

#[test]
fn suggestions() {
    let mut session = Session::default();
    let analysed = session.analyse("scene { spehre() }", &[], arsc_sema::Options::default());
    assert_eq!(analysed.diagnostics[0].suggestions[0].replacement, "sphere");
    let mut session = Session::default();
    let analysed = session.analyse("let b = lambert(0.5)", &[], arsc_sema::Options::default());
    assert_eq!(
        analysed.diagnostics[0].help.as_deref(),
        Some("it is in std.material: `import std.material { lambert }`")
    );
    for (text, help) in [
        ("let a = sphere().translate(x: 1)", "functions are applied by `|>`: `value |> translate(…)`"),
        (
            "let a = cube() |> color(1)",
            "colours are materials: `shape |> with(lambert(rgb(0.8, 0.1, 0.1)))`, with `lambert` of std.material",
        ),
        ("let a = cube() |> translate([1, 2, 3])", "write a vector: `(x, y, z)`"),
        (
            "camera perspective(eye: (0, 0, 5), target: (0, 0, 0))",
            "give another, such as `up: (0, 1, 0)` for a view from above",
        ),
    ] {
        let mut session = Session::default();
        let analysed = session.analyse(text, &[], arsc_sema::Options::default());
        assert_eq!(analysed.diagnostics[0].help.as_deref(), Some(help), "{:#?}", analysed.diagnostics);
    }
}

#[test]
fn several_errors_in_one_run() {
    expect(
        "fn f(n: int) -> solid { cube(m) }\nscene {\n    sphere(radius: \"a\")\n    box(size: 3)\n    f(1deg)\n}",
        &[("E0101", "m"), ("W0102", "n"), ("E0102", "\"a\""), ("E0102", "3"), ("E0102", "1deg")],
    );
}

#[test]
fn types() {
    expect("scene { cube(1) |> rotate_z(45) }", &[("E0102", "45")]);
    expect("let a: angle = 3", &[("E0102", "3")]);
    expect("let n: int = 2.5", &[("E0102", "2.5")]);
    expect("let d: direction = (0, 0, 1)", &[("E0102", "(0, 0, 1)")]);
    expect("let p: point = vec3(0, 0, 1)", &[("E0102", "vec3(0, 0, 1)")]);
    expect("let x = 45deg + 1", &[("E0107", "+")]);
    expect("let x = 45deg * 45deg", &[("E0107", "*")]);
    expect("let x = 500nm < 6500K", &[("E0107", "<")]);
    expect("let x = \"a\" + 1", &[("E0107", "+")]);
    expect("let x = !3", &[("E0107", "!")]);
    expect("let x = [1, \"a\"]", &[("E0102", "\"a\"")]);
    expect("let x = if true { 1 } else { \"a\" }", &[("E0102", "{ \"a\" }")]);
    expect("let x = 3(4)", &[("E0105", "3")]);
    expect("let x: spectrum = 3", &[("E0111", "spectrum")]);
    expect("let x: list = [3]", &[("E0111", "list")]);
    expect("let x = (1, 2)[0]", &[("E0102", "(1, 2)")]);
    expect("let x = for i in 5 { i }", &[("E0102", "5")]);
    expect("let f = fn(x) => x * 2", &[("E0109", "x")]);
    expect("fn f(x) { x }", &[("E0109", "x")]);
    expect("fn f(n: int) { if n == 0 { 1 } else { f(n - 1) } }", &[("E0109", "f")]);
    expect("let x: float = if true { 1 }", &[("W0105", "if true { 1 }"), ("E0102", "if true { 1 }")]);
    expect("scene { sphere }", &[("E0102", "sphere")]);
    expect("import std.material { lambert }\nscene { lambert(0.5) }", &[("E0102", "lambert(0.5)")]);
    expect("scene { 3 }", &[("E0102", "3")]);
    expect("camera sphere()", &[("E0102", "sphere()")]);
    expect("actions { sphere() }", &[("E0102", "sphere()")]);
}

#[test]
fn kinds_of_spectra_do_not_mix() {
    expect(
        "import std.material { lambert }\nimport std.spectra { d65, macbeth }\nlet a = lambert(d65)\nlet b = emitter(macbeth.red)\nlet c = emitter(3)",
        &[("E0102", "d65"), ("E0102", "macbeth.red"), ("E0102", "3")],
    );
}

#[test]
fn booleans_take_solids_only() {
    expect("scene { sphere() | disk() }", &[("E0110", "disk()")]);
    expect("scene { sphere() - plane() }", &[("E0110", "plane()")]);
    expect("scene { union(sphere(), [disk()]) }", &[("E0110", "[disk()]")]);
    expect("scene { difference(disk(), sphere()) }", &[("E0110", "disk()")]);
    expect("scene { sphere() & point_light(blackbody(6000K)) }", &[("E0107", "&")]);
    expect("scene { sphere() | point_light(blackbody(6000K)) | environment(blackbody(6000K)) }", &[]);
    expect("scene { disk() - disk() }", &[("E0107", "-")]);
}

#[test]
fn arguments() {
    expect("scene { torus(major: 1, minr: 0.2) }", &[("E0104", "minr")]);
    expect("scene { sphere(1, (0, 0, 0), 3) }", &[("E0104", "3")]);
    expect("scene { sphere(1, radius: 2) }", &[("E0104", "2")]);
    expect("scene { ellipsoid() }", &[("E0104", "ellipsoid()")]);
    expect("fn f(a: int, b: int = 2) -> int { a + b }\nlet x = f(b: 1)", &[("E0104", "f(b: 1)")]);
    expect("fn f(g: fn(int) -> int) -> int { g(1, 2) }", &[("E0104", "g(1, 2)")]);
    expect("let x = map([1], fn(a, b) => a)", &[("W0102", "b"), ("E0102", "fn(a, b) => a")]);
}

#[test]
fn patterns() {
    expect("let (a, b) = (1, 2, 3)", &[("E0115", "(a, b)")]);
    expect(
        "fn f(n: int) -> int { match n { 0..=5 => 1, 7.. 9 => 2 } }",
        &[("E0108", "match n { 0..=5 => 1, 7.. 9 => 2 }")],
    );
    expect("fn f(n: int) -> int { match n { 0..=5 => 1, 6 => 3, k => k } }", &[]);
    expect("fn f(b: bool) -> int { match b { true => 1, false => 2, _ => 3 } }", &[("W0104", "_")]);
    expect(
        "fn f(b: bool, c: bool) -> int { match (b, c) { (true, _) => 1, (_, false) => 2 } }",
        &[("E0108", "match (b, c) { (true, _) => 1, (_, false) => 2 }")],
    );
    expect("fn f(s: string) -> int { match s { \"a\" => 1, \"a\" => 2, _ => 3 } }", &[("W0104", "\"a\"")]);
    expect("fn f(n: int) -> int { match n { 1 | 2 => 1, 2 => 3, _ => 4 } }", &[("W0104", "2")]);
    expect("fn f(n: int) -> int { match n { k if k > 0 => 1, _ => 4 } }", &[]);
    expect("fn f(n: int) -> int { match n { \"a\" => 1, _ => 4 } }", &[("E0102", "\"a\"")]);
    let found = findings("fn f(b: bool, c: bool) -> int { match (b, c) { (true, _) => 1, (_, false) => 2 } }");
    assert!(found[0].contains("does not cover `(false, true)`"), "{found:?}");
}

#[test]
fn cycles() {
    expect("let a = b\nlet b = a", &[("E0112", "a")]);
    expect("type a = list<b>\ntype b = a", &[("E0112", "a")]);
    expect("fn f() -> int { x }\nlet x = f()\nscene { sphere(x) }", &[("E0112", "x")]);
}

#[test]
fn values() {
    expect("scene { sphere(radius: -1) }", &[("E0201", "-1")]);
    expect("scene { sphere(radius: 0) }", &[("E0201", "0")]);
    expect("scene { box(min: (0, 0, 0), max: (1, 0, 1)) }", &[("E0201", "(1, 0, 1)")]);
    expect(
        "scene { box(min: (0, 0, 0), max: (1, 1, 1), center: true) }",
        &[("E0104", "box(min: (0, 0, 0), max: (1, 1, 1), center: true)")],
    );
    expect("scene { box(center: false) }", &[]);
    expect("scene { sphere(1 / 0) }", &[("E0202", "/")]);
    expect("scene { sphere(5 % 0) }", &[("E0202", "%")]);
    expect("scene { sphere(1e300 * 1e300) }", &[("E0202", "*")]);
    expect("scene { sphere((-1.0) ** 0.5) }", &[("E0202", "**")]);
    expect("scene { cube(9223372036854775807 + 1) }", &[("E0202", "+")]);
    expect("scene { sphere(sqrt(-1)) }", &[("E0201", "-1")]);
    expect("scene { sphere([1, 2][2]) }", &[("E0203", "2")]);
    expect("scene { sphere([1, 2][-1]) }", &[("E0203", "-1")]);
    expect("scene { sphere() |> scale(0) }", &[("E0206", "scale(0)")]);
    expect("scene { sphere() |> scale(x: 1e-9) }", &[]);
    expect("scene { sphere() |> mirror((0, 0, 0)) }", &[("E0201", "(0, 0, 0)")]);
    expect("scene { union([]) }", &[("E0207", "union([])")]);
    expect("scene { mesh(\"bunny.ply\"); mesh(\"hare.ply\") }", &[("E0210", "\"hare.ply\"")]);
    expect("scene { mesh(\"torn.ply\"); mesh_solid(\"torn.ply\") }", &[("E0214", "\"torn.ply\"")]);
    expect("scene { environment_map(\"broken.hdr\") }", &[("E0215", "\"broken.hdr\"")]);
    expect("scene { environment_map(\"none.hdr\") }", &[("E0210", "\"none.hdr\"")]);
    let measured =
        |path| format!("import std.material {{ measured }}\nscene {{ sphere() |> with(measured(\"{path}\")) }}");
    expect(&measured("broken.hdr"), &[("E0215", "\"broken.hdr\"")]);
    expect("scene { ies_light(\"data/a.csv\") }", &[("E0215", "\"data/a.csv\"")]);
    expect("scene { mesh_solid(\"broken.ply\") }", &[("E0213", "\"broken.ply\"")]);
    expect("scene { mesh_solid(\"bunny.ply\") - mesh_solid(\"bunny.ply\") }", &[]);
    expect("scene { mesh_solid(\"flipped.ply\") }", &[("W0114", "\"flipped.ply\"")]);
    expect("scene { mesh_solid(\"inverted.ply\") }", &[("W0114", "\"inverted.ply\"")]);
    expect("scene { mesh(\"degenerate.ply\") }", &[("W0115", "\"degenerate.ply\"")]);
    expect("camera perspective(eye: (0, 0, 0), target: (0, 0, 0))", &[("E0201", "(0, 0, 0)")]);
    expect(
        "camera perspective(eye: (0, 0, 5), target: (0, 0, 0))",
        &[("E0201", "perspective(eye: (0, 0, 5), target: (0, 0, 0))")],
    );
    expect("camera perspective(eye: (0, 5, 5), target: (0, 0, 0), fov: 180deg)", &[("E0201", "180deg")]);
    expect("import std.material { lambert }\nscene { sphere() |> with(lambert(-0.1)) }", &[("E0201", "-0.1")]);
    // The three blocks fail independently.
    expect(
        "scene { sphere(0) }\ncamera perspective((0, 5, 5), (0, 0, 0), fov: 0deg)\nactions { write_png(\"a.png\") }",
        &[("E0201", "0"), ("E0201", "0deg"), ("E0301", "write_png(\"a.png\")")],
    );
}

#[test]
fn calls_are_shown() {
    let text =
        "fn inner(r: float) -> solid { sphere(r) }\nfn outer(r: float) -> solid { inner(r - 1) }\nscene { outer(1) }";
    let mut session = Session::default();
    let analysed = session.analyse(text, &[], arsc_sema::Options::default());
    let labels: Vec<(&str, &str)> = analysed.diagnostics[0]
        .labels
        .iter()
        .map(|label| (session.sources.text(label.span), label.text.as_str()))
        .collect();
    let wanted = [("r", "this is 0"), ("inner(r - 1)", "in a call of `inner`"), ("outer(1)", "in a call of `outer`")];
    assert_eq!(labels, wanted);
}

#[test]
fn action_stacks() {
    expect("actions { tone_map() }", &[("E0301", "tone_map()")]);
    let found = findings("actions { tone_map(exposure: auto) }");
    assert!(found[0].ends_with("`tone_map` needs an image, but the stack holds a scene"), "{found:?}");
    expect("actions { path_trace(); path_trace(); write_exr(\"a.exr\") }", &[("E0301", "path_trace()")]);
    expect("actions { path_trace(); swap(); drop(); write_exr(\"a.exr\") }", &[]);
    expect("actions { path_trace(); dup(); tone_map(); write_png(\"a.png\"); drop(); write_exr(\"b.exr\") }", &[]);
    expect("actions { drop(); drop() }", &[("E0301", "drop()")]);
    expect("actions { }", &[]);
    expect("actions { path_trace() }", &[("W0111", "actions { path_trace() }")]);
    expect("import std.action { standard_render }\nactions { standard_render(\"a\") }", &[]);
    expect(
        "fn both(n: int) -> list<action> { [path_trace(n), tone_map()] }\nactions { both(3); write_png(\"a.png\") }",
        &[],
    );
    expect("actions { path_trace(); tone_map(exposure: ev(1.5)); write_png(\"a.png\") }", &[]);
    expect("actions { path_trace(); tone_map(exposure: atuo); write_png(\"a.png\") }", &[("E0101", "atuo")]);
    for name in ["a", "a.png", ".exr", "../a.exr", "/a.exr", "a/../../b.exr"] {
        let quoted = format!("\"{name}\"");
        expect(&format!("actions {{ path_trace(); write_exr({quoted}) }}"), &[("E0201", &quoted)]);
    }
    expect("actions { path_trace(); write_exr(\"sub/a.EXR\") }", &[]);
    expect(
        "actions { path_trace(); write_exr(\"a.exr\"); dup(); write_exr(\"a.exr\") }",
        &[("E0301", "write_exr(\"a.exr\")")],
    );
    expect("actions { accelerate(strategy: tree); path_trace(); write_exr(\"a.exr\") }", &[]);
}

#[test]
fn one_of_each_block() {
    expect("scene { sphere() }\nscene { sphere() }", &[("E0113", "scene { sphere() }")]);
    let camera = "camera perspective((0, 5, 5), (0, 0, 0))";
    expect(&format!("{camera}\n{camera}"), &[("E0113", camera)]);
}

#[test]
fn not_implemented_is_said() {
    let with = |density: &str| {
        let import = "import std.medium { medium, grid_density }";
        format!("{import}\nscene {{ sphere() |> with(medium(1, density: {density})) }}")
    };
    let grid = "grid_density(\"a.raw\", (8, 8, 8), (0, 0, 0), (1, 1, 1))";
    expect(&with(grid), &[("E0901", grid)]);
    // Arguments are checked all the same.
    let wrong = "grid_density(2, (8, 8, 8), (0, 0, 0), (1, 1, 1))";
    expect(&with(wrong), &[("E0102", "2"), ("E0901", wrong)]);
}

#[test]
fn faces_that_are_not_there() {
    expect("scene { sphere() |> with_face(1, emitter(blackbody(3000K))) }", &[("E0201", "1")]);
    expect("scene { cylinder() |> rotate_x(9deg) |> with_face(3, emitter(blackbody(3000K))) }", &[("E0201", "3")]);
    expect("scene { cylinder() |> with_face(2, emitter(blackbody(3000K))) }", &[]);
    expect("scene { cylinder() |> with_face(-1, emitter(blackbody(3000K))) }", &[("E0201", "-1")]);
    expect("scene { disk() |> with_face(0, emitter(blackbody(3000K))) }", &[("E0110", "disk()")]);
}

#[test]
fn sizes_that_make_no_solid() {
    for (bad, label) in [
        ("paraboloid(radius: -1)", "-1"),
        ("paraboloid(radius: 1e200, height: 1e-200)", "paraboloid(radius: 1e200, height: 1e-200)"),
        ("hyperboloid(sheets: 3)", "3"),
        ("hyperboloid(radius: 1, height: 2, slope: 1, sheets: 2)", "2"),
        ("hyperboloid(slope: 0)", "0"),
        ("superquadric(e1: 0.01)", "0.01"),
        ("superquadric(e2: 50)", "50"),
        ("prism([(0, 0), (1, 1), (1, 0), (0, 1)])", "[(0, 0), (1, 1), (1, 0), (0, 1)]"),
        ("prism([(0, 0), (1, 0)])", "[(0, 0), (1, 0)]"),
        ("prism([(0, 0), (1, 0), (0, 1)], height: 0)", "0"),
        ("prism([(0, 0), (4, 0), (0, 4)], 1, [[(3, 3), (4, 3), (3, 4)]])", "[[(3, 3), (4, 3), (3, 4)]]"),
        ("prism([(0, 0), (4, 0), (0, 4)], holes: [[(-1, 1), (1, 1), (1, 2)]])", "[[(-1, 1), (1, 1), (1, 2)]]"),
        ("lathe([(1, 0)])", "[(1, 0)]"),
        ("lathe([(1, 0), (-1, 1)])", "[(1, 0), (-1, 1)]"),
        ("lathe([(1, 0), (1, 0), (1, 1)])", "[(1, 0), (1, 0), (1, 1)]"),
        ("lathe([(1, 0), (2, 1), (2, 0), (1, 1)])", "[(1, 0), (2, 1), (2, 0), (1, 1)]"),
        ("lathe([(1, 0), (0.01, 1), (1, 1.1)], smooth: true)", "[(1, 0), (0.01, 1), (1, 1.1)]"),
        ("lathe([(1, 0), (2, 0)], closed: true)", "[(1, 0), (2, 0)]"),
        ("polyhedron([(0, 0, 0), (1, 0, 0), (0, 1, 0)])", "[(0, 0, 0), (1, 0, 0), (0, 1, 0)]"),
        ("polyhedron([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)])", "[(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]"),
        ("polyhedron(for i in 0..5000 { (i * i, i, 1) })", "for i in 0..5000 { (i * i, i, 1) }"),
    ] {
        expect(&format!("scene {{ {bad} }}"), &[("E0201", label)]);
    }
}

#[test]
fn modules_keep_their_names() {
    let files = [(
        "parts.arsl",
        "let width = 2\nfn wheel(r: float) -> solid { cylinder(r, width) }\nfn _hidden() -> int { 1 }\ntype size = float",
    )];
    let check = |text: &str| {
        let mut session = Session::with_files(&files);
        let analysed = session.analyse(text, &[], arsc_sema::Options::default());
        common::describe(&session.sources, &analysed.diagnostics)
    };
    assert!(check("import \"parts.arsl\"\nscene { parts.wheel(parts.width) }").is_empty());
    assert!(check("import \"parts.arsl\" as p\nfn f(s: float) -> solid { p.wheel(s) }\nscene { f(1) }").is_empty());
    assert!(
        check("import \"parts.arsl\" { wheel as w, size }\nfn f(s: size) -> solid { w(s) }\nscene { f(1) }").is_empty()
    );
    assert_eq!(check("import \"parts.arsl\" { _hidden }\nscene { sphere(_hidden()) }").len(), 1);
    assert_eq!(
        check("import \"parts.arsl\"\nscene { sphere(parts) }"),
        ["E0114 \"parts\": `parts` is a module, not a value"]
    );
    assert_eq!(check("import \"parts.arsl\"\nscene { parts.whel(1) }").len(), 1);
}

#[test]
fn text_lints() {
    expect("scene { let a = 1; sphere() }", &[("W0101", "a")]);
    expect("let a = 1\nscene { sphere() }", &[("W0101", "a")]);
    expect("let a = 1", &[]);
    expect("import std.spectra { d65 }\nscene { sphere() }", &[("W0103", "d65")]);
    expect("param n: int = 3\nscene { sphere() }", &[("W0102", "n")]);
    expect("scene { for _ in 0..3 { sphere() } }", &[]);
    expect("let a = 1.5708deg", &[("W0107", "1.5708deg")]);
    expect("let a = 3.14159deg\nlet b = 1deg\nlet c = 3deg\nlet d = 1.5deg", &[("W0107", "3.14159deg")]);
    expect("let a = 90rad", &[("W0107", "90rad")]);
    expect("let a = 0.55nm", &[("W0107", "0.55nm")]);
    expect("import std.material { lambert }\nscene { sphere() |> with(lambert(1.5)) }", &[("W0106", "1.5")]);
    expect("import std.material { paint }\nscene { sphere() |> with(paint(1, 0.5, 0)) }", &[]);
    expect("scene { sphere() |> with(emitter(constant_emission(0))) }", &[("W0110", "constant_emission(0)")]);
    expect("scene { sky(sun: direction(elevation: -5deg)) }", &[("W0110", "direction(elevation: -5deg)")]);
    expect("scene { }", &[("W0112", "scene { }")]);
    expect("fn f() -> int { 1; 2 }", &[("W0105", "1")]);
}

#[test]
fn media_are_possible_matter() {
    for (bad, code, label) in [
        ("medium(water_absorption * -1)", "E0201", "*"),
        ("medium(absorption_colour(0))", "E0201", "0"),
        ("medium(phase: henyey_greenstein(1))", "E0201", "1"),
        ("medium(phase: rayleigh(0.6))", "E0201", "0.6"),
        ("mist(1, gaussian_density(sigma: 0))", "E0201", "0"),
    ] {
        let script = format!("from_std!scene {{ sphere() |> with({bad}) }}");
        let imports: Vec<&str> = [
            "medium",
            "water_absorption",
            "absorption_colour",
            "henyey_greenstein",
            "rayleigh",
            "mist",
            "gaussian_density",
        ]
        .into_iter()
        .filter(|name| bad.contains(&format!("{name}(")) || bad.contains(&format!("{name} ")))
        .collect();
        let script = script.replace("from_std!", &format!("import std.medium {{ {} }}\n", imports.join(", ")));
        expect(&script, &[(code, label)]);
    }
}
