//! The reference manual is true: generated where it can be, its examples run where it cannot.

mod common;

use common::{Session, describe};

fn read(path: &str) -> String {
    let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
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

#[test]
fn examples_of_the_language_reference_are_true() {
    let page = read("docs/reference/language.md");
    let mut count = 0;
    for (i, block) in page.split("```arsl\n").skip(1).enumerate() {
        let script = block.split("```").next().unwrap();
        // `//= CODE` at the end of a line: the example shows this finding.
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
        assert_eq!(found, wanted, "example {}:\n{script}\nfound:\n{shown}", i + 1);
        count += 1;
    }
    assert!(count >= 20, "{count}");
}
