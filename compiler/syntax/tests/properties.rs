//! What holds for every text: no panic, spans that nest and lie within it, all comments kept, bounded depth.

use arsc_diagnostics::{SourceId, Span};
use arsc_syntax::visit::Node;
use arsc_syntax::{MAX_DEPTH, Parsed, parse};
use proptest::prelude::*;

/// Pieces of scripts; strung together at random they are nearly scripts.
const PIECES: &[&str] = &[
    "let ",
    "fn ",
    "scene ",
    "actions ",
    "camera ",
    "import ",
    "param ",
    "type ",
    "if ",
    "else ",
    "for ",
    "in ",
    "match ",
    "allow",
    "@allow",
    "x",
    "sphere",
    "std.material",
    "_",
    "1",
    "2.5",
    "45deg",
    "1e",
    "\"s\"",
    "\"",
    "\\",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "<",
    ">",
    ",",
    ";",
    ":",
    "=",
    "=>",
    "->",
    "==",
    "|>",
    "|",
    "&",
    "+",
    "-",
    "*",
    "/",
    "**",
    "!",
    "..",
    "..=",
    ".",
    "\n",
    "\n",
    "\n",
    " ",
    "// c\n",
    "/* c */",
    "/*",
    "*/",
    "/// doc\n",
    "//! doc\n",
    "ä",
    "“",
    "\u{1F600}",
    "\u{0}",
    "'",
    "#",
    "?",
    "$",
    "\r\n",
    "\t",
    "true",
];

fn nearly_a_script() -> impl Strategy<Value = String> {
    prop::collection::vec(prop::sample::select(PIECES), 0..120).prop_map(|pieces| pieces.concat())
}

/// Checks the tree below a node: spans lie in their parents' and on character boundaries. Gives its depth.
fn check(node: Node<'_>, parent: Span, text: &str) -> usize {
    let span = node.span();
    assert!(parent.contains(span), "{span:?} is not in {parent:?} of {text:?}: {node:?}");
    assert!(text.get(span.start as usize..span.end as usize).is_some(), "{span:?} cuts a character of {text:?}");
    let mut depth = 0;
    node.children(&mut |child| depth = check(child, span, text).max(depth));
    depth + 1
}

fn check_all(text: &str) -> Parsed {
    let parsed = parse(SourceId(7), text);
    for item in &parsed.module.items {
        // Patterns, types and blocks count here and not for the limit: at most one more each level.
        assert!(check(Node::Item(item), parsed.module.span, text) <= 3 * MAX_DEPTH);
    }
    for diagnostic in &parsed.diagnostics {
        assert!(diagnostic.message.chars().count() <= 80, "too long: {}", diagnostic.message);
        assert!(diagnostic.primary_span().is_some(), "{diagnostic:?} has no place");
        let suggested = diagnostic.suggestions.iter().map(|suggestion| suggestion.span);
        for span in diagnostic.labels.iter().map(|label| label.span).chain(suggested) {
            assert!(text.get(span.start as usize..span.end as usize).is_some(), "{span:?} of {diagnostic:?}");
        }
    }
    parsed
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2_000) })]

    #[test]
    fn nearly_scripts_are_read_without_harm(text in nearly_a_script()) {
        let parsed = check_all(&text);
        // What is read again is the same.
        prop_assert_eq!(format!("{:?}", parsed), format!("{:?}", check_all(&text)));
    }

    #[test]
    fn garbage_is_read_without_harm(text in "\\PC{0,200}") {
        check_all(&text);
    }

    #[test]
    fn expressions_are_read_without_harm(text in nearly_a_script()) {
        let (expr, _) = arsc_syntax::parse_expr(SourceId(0), &text);
        check(Node::Expr(&expr), Span::new(SourceId(0), 0, text.len()), &text);
    }

    /// A statement that is an error or not, whatever its neighbours are: recovery neither loses nor invents items.
    #[test]
    fn good_items_survive_between_bad_ones(bad in prop::collection::vec(any::<bool>(), 1..30)) {
        let text: String = (0..).zip(&bad).map(|(i, bad)| {
            if *bad { format!("let b{i} = = {i} +\n") } else { format!("let g{i} = {i}\n") }
        }).collect();
        let parsed = check_all(&text);
        prop_assert_eq!(parsed.module.items.len(), bad.len());
        prop_assert_eq!(parsed.diagnostics.len(), bad.iter().filter(|bad| **bad).count());
    }
}

#[test]
fn all_comments_are_kept() {
    let text =
        "//! top\n/* a /* b */ c */ let x = /* in */ 1 // end\n\n/// doc\nscene { // open\n \"// no\" /**/\n}\n// last";
    let parsed = check_all(text);
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
    let comments: Vec<&str> =
        parsed.module.comments.iter().map(|c| &text[c.span.start as usize..c.span.end as usize]).collect();
    assert_eq!(
        comments,
        ["//! top", "/* a /* b */ c */", "/* in */", "// end", "/// doc", "// open", "/**/", "// last"]
    );
}

/// Texts that are made to hurt, each with the number of findings that one cause deserves.
#[test]
fn hostile_texts_give_one_finding_each() {
    let n = 100_000;
    for (what, text, findings) in [
        ("round", "(".repeat(n), 1),
        ("square", "let x = ".to_string() + &"[".repeat(n) + &"]".repeat(n), 1),
        ("braces", "scene ".to_string() + &"{".repeat(n), 1),
        ("comments", "/*".repeat(n), 1),
        ("types", "let x: ".to_string() + &"list<".repeat(n), 1),
        ("lambdas", "let x = ".to_string() + &"fn(a) => ".repeat(n) + "1", 1),
        ("conditions", "let x = ".to_string() + &"if ".repeat(n), 1),
        ("function types", "let x: ".to_string() + &"fn() -> ".repeat(n) + "int = 1", 1),
        ("sums", "let x = 1".to_string() + &" + 1".repeat(n), 1),
        ("powers", "let x = 1".to_string() + &" ** 1".repeat(n), 1),
        ("prefixes", "let x = ".to_string() + &"- ".repeat(n) + "1", 1),
        ("calls", "let x = f".to_string() + &"()".repeat(n), 1),
        ("fields", "let x = f".to_string() + &".f".repeat(n), 1),
        ("pipes", "let x = f".to_string() + &"\n |> f()".repeat(n), 1),
        ("else if", "let x = if a { 1 }".to_string() + &" else if a { 1 }".repeat(n), 1),
        (
            "sums in brackets",
            "let x = ".to_string() + &"(".repeat(200) + "1" + &(" + 1".repeat(500) + ")").repeat(200),
            1,
        ),
        ("one string", "let x = \"".to_string() + &"a".repeat(n), 1),
        ("backslashes", "let x = \"".to_string() + &"\\".repeat(n), 1),
        ("alternatives", "let x = match 1 { 1".to_string() + &" | 1".repeat(n) + " => 2 }", 0),
        ("elements", "let x = [".to_string() + &"1,".repeat(n) + "]", 0),
        ("semicolons", ";".repeat(n), 0),
        ("empty lines", "\n".repeat(n), 0),
        ("statements", "let x = 1\n".repeat(n), 0),
    ] {
        let parsed = std::thread::Builder::new()
            .stack_size(64 << 20)
            .spawn(move || check_all(&text))
            .expect("a thread starts")
            .join()
            .unwrap_or_else(|_| panic!("{what}"));
        assert_eq!(parsed.diagnostics.len(), findings, "{what}: {:?}", parsed.diagnostics.first());
    }
}

#[test]
fn many_errors_are_all_reported() {
    let parsed = check_all(&"let = 1\n".repeat(10_000));
    assert_eq!(parsed.diagnostics.len(), 10_000);
}

/// Spaces of Unicode that the grammar does not know, before and behind words; found by chance.
#[test]
fn foreign_spaces_are_read_without_harm() {
    for text in ["\u{a0}z\u{cb2}\u{11338}.", "\u{a0}sceen {}", "\u{2003}x = 1", "let\u{a0}x = 1", "let x =\u{a0}1"] {
        check_all(text);
    }
}
