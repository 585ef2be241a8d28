//! The gallery and the standard library are free of findings.

mod common;

use common::{Session, describe, run};

#[test]
fn gallery_is_clean() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "arsl") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let mut session = Session::default();
        let analysed = session.analyse(&text, &[], arsc_sema::Options::default());
        let found = describe(&session.sources, &analysed.diagnostics);
        assert!(analysed.ir.is_some() && found.is_empty(), "{}:\n{}", path.display(), found.join("\n"));
        count += 1;
    }
    assert!(count >= 6);
}

#[test]
fn minimal() {
    let ir = run("scene { sphere() }").ir.unwrap();
    assert_eq!(ir.nodes.len(), 2);
}
