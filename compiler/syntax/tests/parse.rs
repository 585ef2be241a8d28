//! The tree that texts become, printed in a short form that shows the structure.

mod common;

use arsc_diagnostics::SourceId;
use arsc_syntax::ast::{ItemKind, StmtKind};
use common::{items, show, show_expr};

/// Reads one expression that must be right.
fn expr(text: &str) -> String {
    let (expr, diagnostics) = arsc_syntax::parse_expr(SourceId(0), text);
    assert!(diagnostics.is_empty(), "{text}: {diagnostics:?}");
    show_expr(&expr)
}

#[test]
fn precedence_is_that_of_the_reference() {
    for (text, tree) in [
        ("a | b - c", "(a | (b - c))"),
        ("a - b |> f(x: 1)", "(pipe (a - b) f(x: 1))"),
        ("a - b - c", "((a - b) - c)"),
        ("a | b & c | d", "((a | (b & c)) | d)"),
        ("-a ** b", "(-(a ** b))"),
        ("a ** -b ** c", "(a ** (-(b ** c)))"),
        ("-a.b(c)[d]", "(-a.b(c)[d])"),
        ("!a && b || c == d", "(((!a) && b) || (c == d))"),
        ("0..n - 1", "(0 .. (n - 1))"),
        ("0..=2 * n", "(0 ..= (2 * n))"),
        ("i * 180deg / n", "((i * 180deg) / n)"),
        ("a < b && c >= d + 1", "((a < b) && (c >= (d + 1)))"),
        ("x |> f |> g(1)", "(pipe (pipe x f) g(1))"),
        ("a - - b", "(a - (-b))"),
        ("fn(x: float, y = 2) => x + y", "fn(x, y) (x + y)"),
        ("(1, 2)", "tuple(1, 2)"),
        ("(1,)", "tuple(1)"),
        ("()", "tuple()"),
        ("(1)", "paren(1)"),
        ("{a: 1, b: [2, 3,]}", "{a: 1, b: [2, 3]}"),
        ("if a { b } else if c { d } else { e }", "if a {b} else if c {d} else {e}"),
        ("for i in 0..3 if i > 1 { i }", "for (0 .. 3) if (i > 1) {i}"),
        ("match x { 0 | 1 => a, -2..3 => b, (p, _) if p => c, _ => d }", "match x {a; b; if p c; d}"),
        ("{ let a = 1; a }", "{let; a}"),
    ] {
        assert_eq!(expr(text), tree, "{text}");
    }
}

#[test]
fn line_breaks_end_statements_but_for_operators_and_fields() {
    let text = "scene {\n a\n (b)\n c\n |> d()\n e\n [f]\n g -\n h\n i\n .j\n k /* */ // x\n - l; m; n }";
    assert_eq!(items(text), ["scene {a; paren(b); (pipe c d()); e; [f]; (g - h); i.j; (k - l); m; n}"]);
}

#[test]
fn every_item_is_read() {
    let text = r#"//! About
//! this file.

allow(unused_name, empty_csg)
import std.material { lambert, oren_nayar as on }
import std.spectra
import "parts/wheel.arsl" as wheel
/// How many.
/// Rays.
param samples: int = 128 in 1..=4096
@allow(unused_name)
let (a, (b, _)): (int, (int, int)) = (1, (2, 3))
fn f(n: int, g: fn(int) -> solid = h) -> list<list<solid>> { n }
type wheel = { radius: float, width: float }
scene { }
camera perspective(fov: 35deg)
actions { write_png("a\u{41}\n.png") }"#;
    let parsed = arsc_syntax::parse(SourceId(0), text);
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
    assert_eq!(parsed.module.docs.as_deref(), Some("About\nthis file."));
    let kinds: Vec<String> = parsed.module.items.iter().map(show).collect();
    assert_eq!(
        kinds,
        [
            "allow unused_name empty_csg",
            "import std.material",
            "import std.spectra",
            "import parts/wheel.arsl",
            "param samples = 128 in (1 ..= 4096)",
            "let = tuple(1, tuple(2, 3))",
            "fn f(n, g) {n}",
            "type wheel",
            "scene {}",
            "camera perspective(fov: 35deg)",
            "actions {write_png(\"aA\\n.png\")}",
        ]
    );
    assert_eq!(parsed.module.items[4].docs.as_deref(), Some("How many.\nRays."));
    assert_eq!(parsed.module.items[5].allow.len(), 1);
}

#[test]
fn an_unreadable_statement_costs_only_itself_and_keeps_its_name() {
    let text = "let a = \nscene {\n  sphere(1)\n  let b = = 2\n  cube(1) cube(2)\n  for i in 0..2 { ? ; torus(1) }\n}\nlet c = 3";
    let parsed = arsc_syntax::parse(SourceId(0), text);
    assert_eq!(parsed.diagnostics.len(), 4, "{:#?}", parsed.diagnostics);
    assert_eq!(parsed.module.items.len(), 3);
    let ItemKind::Scene(block) = &parsed.module.items[1].kind else { panic!("no scene") };
    assert_eq!(block.stmts.len(), 5);
    assert!(matches!(&block.stmts[1].kind, StmtKind::Let(_)));
    assert_eq!(
        show(&parsed.module.items[1]),
        "scene {sphere(1); let; cube(1); cube(2); for (0 .. 2) {error; torus(1)}}"
    );
}

#[test]
fn a_block_left_open_ends_at_the_next_item() {
    let text = "scene {\n  for i in 0..3 {\n    sphere(i)\n\ncamera perspective()\nactions {}\n";
    let parsed = arsc_syntax::parse(SourceId(0), text);
    assert_eq!(parsed.diagnostics.len(), 1, "{:#?}", parsed.diagnostics);
    let kinds: Vec<String> = parsed.module.items.iter().map(show).collect();
    assert_eq!(kinds, ["scene {for (0 .. 3) {sphere(i)}}", "camera perspective()", "actions {}"]);
}

/// What people of other languages write is answered with what to write here.
#[test]
fn slips_are_told_their_remedy() {
    for (text, remedy) in [
        ("scene { sphere(5.) }", "write `5.0`"),
        ("scene { f(45 deg) }", "a unit stands right behind its number: `45deg`"),
        ("let a = [1.5 rad]", "a unit stands right behind its number: `1.5rad`"),
        ("let a = 550 nm", "a unit stands right behind its number: `550nm`"),
        ("#include \"a.inc\"", "modules are loaded with `import \"file.arsl\" { name }`; comments start with `//`"),
        ("#declare R = 2;", "names are bound with `let name = value`; comments start with `//`"),
        ("# a comment", "write `// comment`"),
        ("scene { sphere { <0, 1, 2>, 2 } }", "a shape is a call: `sphere(…)`, and vectors are written `(x, y, z)`"),
        ("let a = f(<0, 1, 2>)", "vectors are written `(x, y, z)`"),
    ] {
        let diagnostics = arsc_syntax::parse(SourceId(0), text).diagnostics;
        assert_eq!(diagnostics[0].help.as_deref(), Some(remedy), "{text}: {diagnostics:#?}");
    }
    let missing = arsc_syntax::parse(SourceId(0), "let a = f(x y)").diagnostics;
    assert!(missing[0].help.is_none() && missing[0].suggestions[0].replacement == ",", "{missing:#?}");
}
