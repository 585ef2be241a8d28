//! Bad input from outside: each gets a clear finding or error and the documented exit status, in bounded time and
//! memory. Nothing panics (exit 101) and nothing is killed by a signal.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A ceiling for debug builds on a busy machine: what hangs takes longer.
const PATIENCE: Duration = Duration::from_secs(240);

/// Runs arsc in a folder of its own.
fn arsc(folder: &Path, args: &[&str], input: &[u8]) -> Output {
    let start = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_arsc"))
        .current_dir(folder)
        .args(args)
        .env_clear()
        .env("LANG", "C.UTF-8")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("arsc starts");
    // A command that refuses its arguments closes the pipe early.
    let _ = child.stdin.take().expect("piped").write_all(input);
    let output = child.wait_with_output().expect("arsc ends");
    assert!(start.elapsed() < PATIENCE, "{args:?} took {:?}", start.elapsed());
    output
}

/// Asserts the exit status and that the output names what is wrong, on standard output or standard error.
fn expect(output: &Output, status: i32, words: &[&str]) {
    let all = [output.stdout.as_slice(), output.stderr.as_slice()].concat();
    let text = String::from_utf8_lossy(&all);
    let shown: String = text.chars().take(2_000).collect();
    assert_eq!(output.status.code(), Some(status), "{shown}");
    for word in words {
        assert!(text.contains(word), "`{word}` is not in: {shown}");
    }
    assert!(all.len() < 200_000, "too much output: {} bytes", all.len());
}

/// Checks a script on standard input.
fn check(input: &[u8]) -> Output {
    let folder = tempfile::tempdir().expect("a folder");
    arsc(folder.path(), &["check", "-"], input)
}

#[test]
fn an_empty_file_declares_nothing() {
    expect(&check(b""), 1, &["W0113"]);
    expect(&check(b"\xEF\xBB\xBF"), 1, &["W0113"]);
    expect(&check(b"\n\n// nothing\n"), 1, &["W0113"]);
}

#[test]
fn binary_files_are_refused() {
    let garbage: Vec<u8> = (0..100_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    expect(&check(&garbage), 1, &["E0004"]);
    expect(&check(b"let x = 1\0"), 1, &["E0004", "U+0000"]);
    expect(&check(b"let x = \"\xFF\""), 1, &["E0004", "byte 9"]);
}

#[test]
fn files_beyond_the_limit_are_refused() {
    expect(&check(&vec![b' '; (16 << 20) + 1]), 1, &["E0005"]);
}

#[test]
fn a_line_of_ten_megabytes_is_read() {
    let good = format!("let x = [{}]", "1, ".repeat(3_300_000));
    expect(&check(good.as_bytes()), 0, &[]);
    // Behind column 65 535, where miette would panic.
    let bad = format!("let x = [{}] +", "1, ".repeat(33_000));
    expect(&check(bad.as_bytes()), 1, &["E0001", "expected an expression"]);
}

#[test]
fn a_line_of_garbage_is_read() {
    expect(&check("?a]} ) ".repeat(300_000).as_bytes()), 1, &["E0006", "not shown"]);
}

#[test]
fn a_hundred_thousand_brackets_give_one_finding() {
    for bracket in ["(", "[", "{", "[{("] {
        expect(&check(bracket.repeat(100_000).as_bytes()), 1, &["E0002", "1 error\n"]);
    }
    let closed = format!("let x = {}1{}", "(".repeat(100_000), ")".repeat(100_000));
    expect(&check(closed.as_bytes()), 1, &["E0002", "1 error\n"]);
    let sum = format!("let x = 1{}", " + 1".repeat(100_000));
    expect(&check(sum.as_bytes()), 1, &["E0002", "1 error\n"]);
    let longest = format!("let x = 1{}", " + 1".repeat(1_990));
    expect(&check(longest.as_bytes()), 0, &[]);
}

#[test]
fn cyclic_imports_are_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    for (file, next) in [("a.arsl", "b.arsl"), ("b.arsl", "c.arsl"), ("c.arsl", "a.arsl")] {
        std::fs::write(folder.path().join(file), format!("import \"{next}\" as next")).expect("written");
    }
    let output = arsc(folder.path(), &["check", "a.arsl"], b"");
    expect(&output, 1, &["E0503", "a.arsl → b.arsl → c.arsl → a.arsl"]);
}

#[test]
fn endless_programs_are_stopped() {
    expect(&check(b"fn f(n: int) -> int { f(n + 1) }\nlet x = f(0)"), 1, &["E02"]);
    expect(&check(b"fn f(n: int) -> int { g(n) }\nfn g(n: int) -> int { f(n) }\nlet x = f(0)"), 1, &["E02"]);
    expect(&check(b"let x = len(for i in 0..1000000000000 { i })"), 1, &["E02"]);
    expect(&check(b"let x = sum(for i in 0..100000 { sum(for j in 0..100000 { i * j }) })"), 1, &["E02"]);
    expect(&check(b"let x = fold(0..1000, \"a\", fn(s, i) => s + s)"), 1, &[]);
}

/// Quadratic searches would take minutes here.
#[test]
fn solids_that_all_overlap_are_checked_quickly() {
    const QUICK: Duration = Duration::from_secs(30);
    for solid in
        ["sphere(radius: 1)", "sphere(radius: 1 + 0.001 * i)", "box(size: (1, 1, 1)) |> translate(x: 1e-6 * i)"]
    {
        let start = Instant::now();
        let script = format!("scene {{ for i in 0..50_000 {{ {solid} }} }}");
        let folder = tempfile::tempdir().expect("a folder");
        expect(&arsc(folder.path(), &["check", "-", "--allow", "warnings"], script.as_bytes()), 0, &[]);
        assert!(start.elapsed() < QUICK, "{solid} took {:?}", start.elapsed());
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    expect(&check(b"let x = 1/0"), 1, &["E02", "1/0"]);
    expect(&check(b"let x = 0.0/0.0"), 1, &["E02"]);
    expect(&check(b"let x = sqrt(-1)"), 1, &["E02"]);
    expect(&check(b"let x = 1e308 * 10"), 1, &["E02"]);
    expect(&check(b"scene { sphere(radius: 0/0) }"), 1, &["E02"]);
    expect(&check(b"scene { sphere(radius: -1) }"), 1, &["E02"]);
    expect(&check(b"scene { sphere(radius: 1) |> scale(0) }"), 1, &["E02"]);
    expect(&check(b"scene { sphere(radius: nan) }"), 1, &["E0101"]);
}

#[test]
fn files_that_are_missing_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = b"scene { mesh(\"no_such.ply\") }";
    std::fs::write(folder.path().join("mesh.arsl"), script).expect("written");
    expect(&arsc(folder.path(), &["check", "mesh.arsl"], b""), 1, &["no_such.ply"]);
    expect(&arsc(folder.path(), &["check", "no_such.arsl"], b""), 2, &["no_such.arsl"]);
    expect(&arsc(folder.path(), &["check", "."], b""), 2, &["folder"]);
    expect(&arsc(folder.path(), &["render", "no_such.arsl"], b""), 2, &["no_such.arsl"]);
    expect(&arsc(folder.path(), &["check", "-"], b"import \"/etc/passwd\" as p"), 1, &["E0502", "outside"]);
    expect(&arsc(folder.path(), &["check", "-"], b"import \"../../../etc/passwd\" as p"), 1, &["E050"]);
}

#[test]
fn wrong_arguments_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    expect(&arsc(folder.path(), &["check"], b""), 2, &["Usage"]);
    expect(&arsc(folder.path(), &["check", "-", "--deny", "unused_nmae"], b""), 2, &["unused_name"]);
    expect(&arsc(folder.path(), &["check", "-", "--deny", "E0101"], b""), 2, &["errors have no level"]);
    expect(&arsc(folder.path(), &["check", "-", "--set", "x"], b""), 2, &["NAME=VALUE"]);
    expect(&arsc(folder.path(), &["explain", "E9999"], b""), 2, &["E9999"]);
    expect(&arsc(folder.path(), &["check", "-", "--set", "n=("], b"param n: int = 1"), 1, &["--set n"]);
    expect(&arsc(folder.path(), &["check", "-", "--set", "m=1"], b"param n: int = 1"), 1, &["m"]);
}

#[test]
fn pictures_that_cannot_be_written_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = "scene { sphere(radius: 1) |> with(emitter(constant_emission(1))) }\n\
                  camera perspective(eye: (0, -5, 0), target: (0, 0, 0), fov: 35deg, resolution: (4, 4))\n\
                  actions { path_trace(samples: 1); tone_map(); write_png(\"a.png\") }";
    std::fs::write(folder.path().join("a.arsl"), script).expect("written");
    std::fs::write(folder.path().join("file"), "in the way").expect("written");
    expect(&arsc(folder.path(), &["render", "a.arsl", "--quiet", "-o", "file/below"], b""), 2, &["file"]);
    expect(&arsc(folder.path(), &["render", "a.arsl", "--quiet", "-o", "out"], b""), 0, &[]);
    assert!(folder.path().join("out/a.png").is_file());
}

#[test]
fn machine_formats_survive_every_character() {
    let script = "let x = \"\u{7f}\\q\u{1F600}\" + \u{201C}\u{A0}\nlet y = 1 + é";
    for format in ["json", "sarif"] {
        let folder = tempfile::tempdir().expect("a folder");
        let output = arsc(folder.path(), &["check", "-", "--format", format], script.as_bytes());
        assert_eq!(output.status.code(), Some(1));
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let findings = document["findings"].as_array().or(document["runs"][0]["results"].as_array()).expect("a list");
        assert!(findings.len() >= 2, "{document}");
    }
}

/// The Static Analysis Results Interchange Format: what consumers rely on.
#[test]
fn sarif_points_at_the_script() {
    let output = {
        let folder = tempfile::tempdir().expect("a folder");
        arsc(folder.path(), &["check", "-", "--format", "sarif"], b"let a = f(x = 1)\nlet b = 1 +")
    };
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(document["version"], "2.1.0");
    let run = &document["runs"][0];
    let results = run["results"].as_array().expect("a list");
    let rules = run["tool"]["driver"]["rules"].as_array().expect("a list");
    for result in results {
        assert_eq!(rules[result["ruleIndex"].as_u64().expect("an index") as usize]["id"], result["ruleId"]);
    }
    let region = &results[0]["locations"][0]["physicalLocation"]["region"];
    assert_eq!(
        (&region["startLine"], &region["startColumn"], &region["endColumn"]),
        (&1.into(), &13.into(), &14.into())
    );
    let fix = &results[0]["fixes"][0]["artifactChanges"][0]["replacements"][0];
    assert_eq!(fix["insertedContent"]["text"], ":");
}
