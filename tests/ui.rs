//! Findings are exactly those that the scripts under `tests/ui` announce, and every code is documented and shown.
//!
//! Annotations stand in comments: `//~ E0101` for a finding on this line, `//~^ E0101` on the line above (one more `^`
//! for each further line), `//~v E0101` on the line below, `//~@ E0101` for one in another file or without a place;
//! several codes may follow. A first line `//# --deny warnings` holds arguments for `arsc check`.
//!
//! The renderings of the bad examples in `docs/diagnostics` are pinned in `tests/ui/snapshots`: after a change that is
//! meant, `INSTA_UPDATE=always cargo test -p arsc --test ui` writes them anew, and the difference is to be read.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use arsc_diagnostics::{Code, codes};
use serde_json::Value;

/// Codes that no script can show: `tests/bad_input.rs` does.
const NO_SCRIPT: [&str; 2] = ["E0004", "E0005"];
/// Codes that no single script on standard input can show.
const NO_EXAMPLE: [&str; 4] = ["E0004", "E0005", "E0209", "E0504"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs `arsc check` in `tests/ui` with a text on standard input.
fn check(args: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_arsc"))
        .current_dir(root().join("tests/ui"))
        .env_clear()
        .envs([("LANG", "C.UTF-8"), ("COLUMNS", "100")])
        .arg("check")
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("arsc starts");
    child.stdin.take().expect("piped").write_all(input.as_bytes()).expect("arsc reads its input");
    child.wait_with_output().expect("arsc ends")
}

/// The findings of `arsc check --format json`: code, file and line.
fn findings(args: &[&str], input: &str) -> Vec<(String, Option<(String, usize)>)> {
    let output = check(&[&["--format", "json"], args].concat(), input);
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let document: Value = serde_json::from_str(&text)
        .unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&output.stderr)));
    let found = document["findings"].as_array().expect("a list").iter().map(|finding| {
        let code = finding["code"].as_str().expect("a code").trim_start_matches("arsl::").to_string();
        let place = &finding["place"];
        let line = place["line"].as_u64().map(|line| (place["file"].as_str().unwrap_or("").to_string(), line as usize));
        (code, line)
    });
    let found: Vec<_> = found.collect();
    let expected = if found.is_empty() { 0 } else { 1 };
    assert_eq!(output.status.code(), Some(expected), "the exit status of {args:?}: {found:?}");
    found
}

fn scripts(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a readable folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(scripts(&path));
        } else if path.extension().is_some_and(|extension| extension == "arsl") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// How often each code is expected on each line; line 0 stands for other places.
type Expected = BTreeMap<(usize, String), usize>;

fn annotations(text: &str) -> Expected {
    let mut expected = Expected::new();
    for (number, line) in (1..).zip(text.lines()) {
        let Some((_, annotation)) = line.split_once("//~") else { continue };
        let marks = annotation.len() - annotation.trim_start_matches(['^', 'v', '@']).len();
        let line = match annotation.as_bytes().first() {
            Some(b'^') => number - marks,
            Some(b'v') => number + marks,
            Some(b'@') => 0,
            _ => number,
        };
        for code in annotation[marks..].split_whitespace() {
            assert!(codes::find(code).is_some_and(|known| known.id() == code), "line {number}: no code {code}");
            *expected.entry((line, code.to_string())).or_default() += 1;
        }
    }
    expected
}

#[test]
fn findings_are_those_that_the_scripts_announce() {
    let folder = root().join("tests/ui");
    let mut wrong = Vec::new();
    for path in scripts(&folder) {
        let name = path.strip_prefix(&folder).expect("below").to_str().expect("UTF-8").to_string();
        let text = std::fs::read_to_string(&path).expect("readable");
        let mut args: Vec<&str> =
            text.lines().next().and_then(|line| line.strip_prefix("//#")).unwrap_or("").split_whitespace().collect();
        args.push(&name);
        let mut found = Expected::new();
        for (code, place) in findings(&args, "") {
            let line = place.filter(|(file, _)| *file == name).map_or(0, |(_, line)| line);
            *found.entry((line, code)).or_default() += 1;
        }
        let expected = annotations(&text);
        if found != expected {
            wrong.push(format!("{name}\n  announced: {expected:?}\n  found:     {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_code_is_announced_by_a_script() {
    let all: Vec<String> = scripts(&root().join("tests/ui"))
        .iter()
        .flat_map(|path| annotations(&std::fs::read_to_string(path).expect("readable")))
        .map(|((_, code), _)| code)
        .collect();
    let missing: Vec<Code> =
        codes::all().filter(|code| !NO_SCRIPT.contains(&code.id()) && !all.iter().any(|id| id == code.id())).collect();
    assert!(missing.is_empty(), "no script in tests/ui shows {missing:?}");
}

/// The first script block below a heading of a page.
fn example<'t>(page: &'t str, heading: &str) -> Option<&'t str> {
    let (_, section) = page.split_once(&format!("\n## {heading}\n"))?;
    let section = section.split("\n## ").next()?;
    let (_, block) = section.split_once("```arsl\n")?;
    block.split_once("```").map(|(script, _)| script)
}

#[test]
fn every_code_has_a_page_whose_examples_are_true() {
    let mut wrong = Vec::new();
    for code in codes::all() {
        let Some(page) = code.page() else {
            wrong.push(format!("{code} has no page in docs/diagnostics"));
            continue;
        };
        let title = format!("# {}: {}\n", code.id(), code.name());
        if !page.starts_with(&title) {
            wrong.push(format!("the page of {code} does not begin with `{}`", title.trim()));
        }
        if NO_EXAMPLE.contains(&code.id()) {
            continue;
        }
        let (Some(bad), Some(good)) = (example(page, "Bad"), example(page, "Good")) else {
            wrong.push(format!("the page of {code} has no script below `## Bad` and `## Good`"));
            continue;
        };
        let bad: Vec<String> = findings(&["-"], bad).into_iter().map(|(code, _)| code).collect();
        if !bad.iter().any(|id| id == code.id()) {
            wrong.push(format!("the bad example of {code} gives {bad:?}"));
        }
        let good = findings(&["-"], good);
        if !good.is_empty() {
            wrong.push(format!("the good example of {code} gives {good:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_page_belongs_to_a_code() {
    for entry in std::fs::read_dir(root().join("docs/diagnostics")).expect("readable").flatten() {
        let path = entry.path();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        assert!(stem == "README" || codes::find(stem).is_some_and(|code| code.id() == stem), "{}", path.display());
    }
}

/// The rendering of every bad example, pinned at width 100 without colour.
#[test]
fn renderings_are_pinned() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("tests/ui/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    for code in codes::all() {
        let Some(bad) = code.page().and_then(|page| example(page, "Bad")) else { continue };
        let text = String::from_utf8(check(&["-"], bad).stdout).expect("UTF-8");
        settings.bind(|| insta::assert_snapshot!(code.id(), text));
    }
}
