//! Scripts that would run for ever, or fill the memory, end in a diagnostic.

mod common;

use arsc_sema::{Limits, Options};
use common::Session;

/// Analysis recurses; tests run on small stacks otherwise.
fn codes(text: &str, limits: Limits) -> Vec<&'static str> {
    let text = text.to_owned();
    let run = move || {
        let analysed = Session::default().analyse(&text, &[], Options { limits, ..Options::default() });
        analysed.diagnostics.iter().map(|d| d.code.id()).collect()
    };
    std::thread::Builder::new().stack_size(256 << 20).spawn(run).unwrap().join().unwrap()
}

fn small() -> Limits {
    Limits { steps: 100_000, recursion: 200, nodes: 10_000, elements: 100_000 }
}

#[test]
fn loops_and_recursion_end() {
    assert_eq!(codes("scene { for _ in 0..9223372036854775807 { } }", small()), ["E0204"]);
    assert_eq!(codes("scene { for _ in 0..1000 { for _ in 0..1000 { } } }", small()), ["E0204"]);
    assert_eq!(codes("fn f(n: int) -> int { f(n + 1) }\nscene { sphere(f(0)) }", small()), ["E0205"]);
    assert_eq!(
        codes("fn f(n: int) -> int { g(n) }\nfn g(n: int) -> int { f(n) }\nscene { sphere(f(0)) }", small()),
        ["E0205"]
    );
    // Twofold recursion: shallow, but exponential.
    let text = "fn f(n: int) -> int { if n == 0 { 1 } else { f(n - 1) + f(n - 1) } }\nscene { sphere(f(100)) }";
    assert_eq!(codes(text, small()), ["E0204"]);
    let text =
        "let f = fn(x: int) => x\nscene { for _ in 0..10 { sphere(fold(0..1_000_000_000, 0, fn(a, b) => f(a) + b)) } }";
    assert_eq!(codes(text, small()), ["E0204"]);
}

#[test]
fn memory_is_bounded() {
    assert_eq!(codes("let x = range(0, 1_000_000_000_000)\nscene { sphere(len(x)) }", small()), ["E0204"]);
    assert_eq!(codes("let x = random_floats(1, 9223372036854775807)\nscene { sphere(len(x)) }", small()), ["E0204"]);
    let doubled = "fn f(n: int) -> list<int> { if n == 0 { [1] } else { let x = f(n - 1); x + x } }\nscene { sphere(len(f(60))) }";
    assert_eq!(codes(doubled, small()), ["E0204"]);
    let text = "fn f(n: int) -> string { if n == 0 { \"abcdefgh\" } else { let x = f(n - 1); x + x } }\nactions { write_exr(f(60)) }";
    assert_eq!(codes(text, small()), ["E0204"]);
    assert_eq!(codes("scene { for i in 0..20_000 { sphere() |> translate(x: i) } }", small()), ["E0204"]);
}

/// Sharing makes small what would be huge if written out; whoever writes it out counts.
#[test]
fn doubling_is_bounded() {
    let chain = |first: &str, next: fn(usize) -> String, last: &str| {
        let steps: Vec<String> = (1..60).map(next).collect();
        codes(&format!("scene {{ let x0 = {first}; {}; {last} }}", steps.join("; ")), small())
    };
    let tuples = |i: usize| format!("let x{i} = (x{}, x{})", i - 1, i - 1);
    let lists = |i: usize| format!("let x{i} = [x{}, x{}]", i - 1, i - 1);
    let zips = |i: usize| format!("let x{i} = zip(x{}, x{})", i - 1, i - 1);
    let sums = |i: usize| format!("let x{i} = fn() => (x{}, x{})", i - 1, i - 1);
    assert_eq!(codes_of_types(&chain("1", tuples, "sphere()")), ["E0204"]);
    assert_eq!(codes_of_types(&chain("[1]", zips, "sphere()")), ["E0204"]);
    assert_eq!(codes_of_types(&chain("1", sums, "sphere()")), ["E0204"]);
    assert_eq!(chain("sphere()", lists, "x59"), ["E0204"]);
    assert_eq!(chain("sphere()", lists, "union(x59)"), ["E0204"]);
    assert_eq!(chain("sphere()", lists, "x59 |> translate(x: 1)"), ["E0204"]);
    assert_eq!(chain("1", lists, "if x59 == x59 { sphere() }"), ["E0204"]);
    assert_eq!(chain("1", lists, "sphere(radius: if str(x59) == \"\" { 1 } else { 2 })"), ["E0204"]);
}

/// Without the lints.
fn codes_of_types(codes: &[&'static str]) -> Vec<&'static str> {
    codes.iter().copied().filter(|code| !code.starts_with('W')).collect()
}

#[test]
fn defaults_are_generous() {
    let text = "scene { for p in random_points(1, 20_000) { sphere(0.01) |> translate(by: p) } }";
    assert!(codes(text, Limits::default()).is_empty());
    let deep = "fn f(n: int) -> int { if n == 0 { 0 } else { 1 + f(n - 1) } }\nscene { sphere(f(190)) }";
    assert!(codes(deep, Limits::default()).is_empty());
}

#[test]
fn deep_texts_are_survived() {
    let chain = format!("scene {{ sphere({}1) }}", "1 + ".repeat(1900));
    assert!(codes(&chain, Limits::default()).is_empty());
    let pipes = format!("scene {{ sphere(){} }}", " |> translate(x: 1)".repeat(900));
    assert!(codes(&pipes, Limits::default()).is_empty());
    let brackets = format!("scene {{ sphere({}1{}) }}", "(".repeat(200), ")".repeat(200));
    assert!(codes(&brackets, Limits::default()).is_empty());
    // Deep expressions within deep recursion.
    let text = format!(
        "fn f(n: int) -> int {{ if n == 0 {{ 0 }} else {{ {}f(n - 1){} }} }}\nscene {{ sphere(f(150)) }}",
        "(1 + ".repeat(150),
        ")".repeat(150)
    );
    let found = codes(&text, Limits::default());
    assert!(found.is_empty() || found == ["E0204"], "{found:?}");
}

/// The time is not asserted, for machines differ: it is printed, and stays far below a second even unoptimised.
#[test]
fn a_hundred_thousand_primitives() {
    let text = "
        fn ball(i: int, j: int) -> solid {
            let r = 0.2 + 0.1 * sin(i * 7deg) * cos(j * 11deg)
            sphere(radius: r) |> translate(x: i, y: j) |> rotate_z(1deg * i)
        }
        scene { for i in 0..400 { for j in 0..250 { ball(i, j) } } }";
    let start = std::time::Instant::now();
    let analysed = Session::default().analyse(text, &[], Options::default());
    println!("100 000 primitives: {:?}", start.elapsed());
    // A leaf and two transforms each, and the root.
    assert_eq!(analysed.ir.unwrap().nodes.len(), 300_001);
}
