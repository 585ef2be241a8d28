//! The reference manual is true: generated where it can be, its examples run where it cannot.

mod common;

use common::{Session, describe};

fn read(path: &str) -> String {
    let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn read_bytes(path: &str) -> Vec<u8> {
    let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// `UPDATE_REFERENCE=1 cargo test -p arsc-sema --test reference` writes the manual anew.
#[test]
fn builtins_are_current() {
    let path = format!("{}/../../docs/reference/builtins.md", env!("CARGO_MANIFEST_DIR"));
    let wanted = arsc_sema::reference();
    if std::env::var_os("UPDATE_REFERENCE").is_some() {
        std::fs::write(&path, &wanted).unwrap();
    }
    assert!(read("docs/reference/builtins.md") == wanted, "docs/reference/builtins.md is not what the registry says");
}

/// Runs the examples of a page and gives their number. `//= CODE` at the end of a line: the example shows this finding.
fn run_examples(page: &str) -> usize {
    let text = read(page);
    let blocks = text.split("```arsl\n").skip(1);
    for (i, block) in blocks.clone().enumerate() {
        let script = block.split("```").next().unwrap();
        let mut wanted: Vec<&str> =
            script.lines().filter_map(|line| line.split_once("//= ")).map(|(_, code)| code).collect();
        let mut session = Session::with_files(&[(
            "parts/wheel.arsl",
            "let width = 0.2\nfn wheel(r: float) -> solid { cylinder(r, width) }",
        )]);
        let analysed = session.analyse(script, &[], arsc_sema::Options::default());
        let mut found: Vec<&str> = analysed.diagnostics.iter().map(|d| d.code.id()).collect();
        wanted.sort_unstable();
        found.sort_unstable();
        let shown = describe(&session.sources, &analysed.diagnostics).join("\n");
        assert_eq!(found, wanted, "{page}, example {}:\n{script}\nfound:\n{shown}", i + 1);
    }
    blocks.count()
}

#[test]
fn examples_of_the_language_reference_are_true() {
    assert!(run_examples("docs/reference/language.md") >= 20);
}

/// Every picture has its example, every module with solids its section.
#[test]
fn examples_of_the_library_are_true() {
    assert!(run_examples("docs/reference/library.md") >= 5);
    let page = read("docs/reference/library.md");
    for name in page.lines().filter_map(|line| line.strip_prefix("![")?.split("library/").nth(1)?.strip_suffix(")")) {
        assert!(page.contains(&format!("write_png(\"{name}\")")), "nothing renders {name}");
        read_bytes(&format!("docs/images/library/{name}"));
    }
}

#[test]
fn examples_for_those_who_come_from_art_are_true() {
    assert!(run_examples("docs/migrating-from-arm.md") >= 4);
}
