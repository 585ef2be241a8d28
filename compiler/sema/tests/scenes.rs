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
    assert!(count >= 4);
}

#[test]
fn minimal() {
    let ir = run("scene { sphere() }").ir.unwrap();
    assert_eq!(ir.nodes.len(), 2);
}

/// As a root script every value of a module is evaluated, and every function checked.
#[test]
fn standard_library_is_clean_and_documented() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../stdlib/std");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let mut session = Session::default();
        let name = format!("std.{}", path.file_stem().unwrap().to_str().unwrap());
        let analysed = session.analyse_std(&name, &text);
        let found = describe(&session.sources, &analysed.diagnostics);
        assert!(analysed.ir.is_some() && found.is_empty(), "{}:\n{}", path.display(), found.join("\n"));
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("//! "), "{} says not what it is", path.display());
        for pair in lines.windows(2).filter(|pair| pair[1].starts_with("fn ") || pair[1].starts_with("let ")) {
            assert!(pair[0].starts_with("/// "), "{}: `{}` is not documented", path.display(), pair[1]);
        }
        count += 1;
    }
    assert!(count >= 8);
}

/// The luminance of every illuminant is that of the constant spectrum 1, and D65 is white.
#[test]
fn illuminants_have_one_luminance() {
    let text = "import std.spectra { illuminant_a, d50, d65, fl2, fl7, fl11, hp1, led_b1, led_b4, equal_energy }
        scene { for s in [equal_energy, d65, illuminant_a, d50, fl2, fl7, fl11, hp1, led_b1, led_b4] { point_light(s) } }";
    let ir = run(text).ir.unwrap();
    let mut luminances = Vec::new();
    for node in &ir.nodes {
        if let arsc_ir::NodeKind::Light(light) = &node.kind
            && let arsc_ir::Light::Point { intensity } = &**light
        {
            luminances.push(arsc_spectral::xyz_of_radiance(intensity)[1]);
        }
    }
    assert_eq!(luminances.len(), 10);
    for luminance in &luminances {
        assert!((luminance / luminances[0] - 1.0).abs() < 1e-3, "{luminances:?}");
    }
}
