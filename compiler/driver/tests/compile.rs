//! The driver on small programs in memory: modules, settings, lint levels.

use std::collections::BTreeMap;
use std::sync::Arc;

use arsc_diagnostics::{Severity, codes};
use arsc_driver::{Compiled, LoadError, Loader, Options};
use arsc_geometry::TriangleMesh;

/// Files in memory.
#[derive(Default)]
struct Files(BTreeMap<&'static str, Result<&'static str, LoadError>>);

impl Loader for Files {
    fn load(&self, path: &str) -> Result<Arc<str>, LoadError> {
        match self.0.get(path) {
            Some(Ok(text)) => Ok((*text).into()),
            Some(Err(error)) => Err(error.clone()),
            None => Err(LoadError::NotFound),
        }
    }

    fn mesh(&self, _path: &str) -> Result<Arc<TriangleMesh>, LoadError> {
        Err(LoadError::NotFound)
    }

    fn list(&self, folder: &str) -> Vec<String> {
        let below = |path: &&str| path.strip_prefix(folder).map(|rest| rest.trim_start_matches('/').to_string());
        self.0.keys().filter_map(below).filter(|name| !name.contains('/')).collect()
    }
}

fn compile_with(root: &str, files: &[(&'static str, &'static str)], options: &Options) -> Compiled {
    let files = Files(files.iter().map(|&(path, text)| (path, Ok(text))).collect());
    arsc_driver::compile("scenes/root.arsl", root.into(), &files, options)
}

fn compile(root: &str, files: &[(&'static str, &'static str)]) -> Compiled {
    compile_with(root, files, &Options::default())
}

/// Ids of the findings and the files they are in.
fn ids(compiled: &Compiled) -> Vec<(&'static str, &str)> {
    let file = |d: &arsc_diagnostics::Diagnostic| {
        d.primary_span().map_or("", |span| compiled.sources.get(span.source).name.as_str())
    };
    compiled.diagnostics.iter().map(|d| (d.code.id(), file(d))).collect()
}

#[test]
fn modules_are_found_relative_to_the_file_that_names_them_and_read_once() {
    let files = [
        ("parts/wheel.arsl", "import \"hub.arsl\" as hub\nimport \"../size.arsl\" as size\nlet r = hub.r * size.s"),
        ("parts/hub.arsl", "import \"../size.arsl\" as size\nlet r = size.s"),
        ("size.arsl", "let s = 2"),
    ];
    let compiled = compile("import \"parts/wheel.arsl\" { r }\nlet x = r", &files);
    assert_eq!(ids(&compiled), []);
    let names: Vec<&str> = compiled.sources.iter().map(|(_, file)| file.name.as_str()).collect();
    assert_eq!(names, ["scenes/root.arsl", "parts/wheel.arsl", "parts/hub.arsl", "size.arsl"]);
}

#[test]
fn what_cannot_be_loaded_says_why() {
    let errors = [
        (LoadError::NotFound, "E0501"),
        (LoadError::NotText(3), "E0004"),
        (LoadError::TooLarge { bytes: 1 << 40 }, "E0005"),
        (LoadError::Forbidden, "E0502"),
        (LoadError::Other("out of paper".into()), "E0502"),
    ];
    for (error, id) in errors {
        let files = Files([("a.arsl", Err(error))].into());
        let compiled = arsc_driver::compile("root.arsl", "import \"a.arsl\" as a".into(), &files, &Options::default());
        assert_eq!(ids(&compiled), [(id, "root.arsl")]);
        assert!(compiled.ir.is_none());
    }
}

#[test]
fn names_close_by_are_suggested() {
    let compiled = compile("import \"parts/wheal.arsl\" as w", &[("parts/wheel.arsl", "")]);
    assert!(compiled.diagnostics[0].help.as_ref().is_some_and(|help| help.contains("wheel.arsl")));
    let compiled = compile("import std.materials as m", &[]);
    assert_eq!(compiled.diagnostics[0].suggestions[0].replacement, "std.material");
}

#[test]
fn settings_are_expressions_with_a_source_of_their_own() {
    let set = |value: &str| Options { settings: vec![("n".into(), value.into())], ..Options::default() };
    let root = "param n: int = 1 in 1..=9\nlet x = n";
    assert_eq!(ids(&compile_with(root, &[], &set("2 + 3"))), []);
    assert_eq!(ids(&compile_with(root, &[], &set("2 +"))), [("E0001", "--set n")]);
    let wrong_type = compile_with(root, &[], &set("\"a\""));
    assert_eq!(wrong_type.diagnostics.len(), 1);
    assert!(wrong_type.has_errors());
}

#[test]
fn scripts_allow_and_the_command_line_sets_levels() {
    let bad = "fn f(x: float) -> float { 1.0 }\n";
    let level =
        |name: &str, severity| Options { lint_levels: vec![(name.to_string(), severity)], ..Options::default() };
    let severity = |root: &str, options: &Options| {
        let compiled = compile_with(root, &[], options);
        let found = compiled.diagnostics.iter().find(|d| d.code == codes::find("unused_param").expect("a lint"));
        found.map(|d| d.severity)
    };
    let default = Options::default();
    assert_eq!(severity(bad, &default), Some(Severity::Warning));
    assert_eq!(severity(bad, &level("unused_param", Severity::Error)), Some(Severity::Error));
    assert_eq!(severity(bad, &level("warnings", Severity::Error)), Some(Severity::Error));
    assert_eq!(severity(bad, &level("W0102", Severity::Allow)), None);
    assert_eq!(severity(bad, &level("unused_name", Severity::Error)), Some(Severity::Warning));
    for allowed in
        [format!("allow(unused_param)\n{bad}"), format!("@allow(W0102)\n{bad}"), format!("allow(warnings)\n{bad}")]
    {
        assert_eq!(severity(&allowed, &level("warnings", Severity::Error)), None, "{allowed}");
    }
    assert_eq!(severity(&format!("@allow(unused_param)\nlet a = 1\n{bad}"), &default), Some(Severity::Warning));
    // A denied lint is an error, and an error stops.
    assert!(compile_with(bad, &[], &level("warnings", Severity::Error)).has_errors());
}

#[test]
fn findings_are_sorted_and_given_once() {
    let compiled = compile("let b = 1 +\nlet a = .5\nlet c = 45degrees", &[]);
    assert_eq!(
        ids(&compiled),
        [("E0001", "scenes/root.arsl"), ("E0001", "scenes/root.arsl"), ("E0003", "scenes/root.arsl")]
    );
    let starts: Vec<_> = compiled.diagnostics.iter().map(|d| d.primary_span().map(|span| span.start)).collect();
    assert!(starts.is_sorted());
}

#[test]
fn texts_beyond_the_limit_are_not_read() {
    let options = Options { source_bytes: 20, ..Options::default() };
    let compiled = compile_with("let x = 1 + 2 + 3 + 4 + 5", &[], &options);
    assert_eq!(ids(&compiled), [("E0005", "")]);
    assert!(compiled.ir.is_none());
}

/// A Donaldson matrix: the diagonal is the reflectance, the rest re-radiates.
#[test]
fn matrices_of_reradiation_are_read_from_files() {
    let script = r#"
        import std.material { fluorescent }
        scene { sphere() |> with(fluorescent(tabulated_reradiation("paint.csv"))) }
    "#;
    let table = "nm,400,450,500\n400,0.25,0.2,0.1\n450,0,0.5,0.125\n";
    let compiled = compile(script, &[("paint.csv", table)]);
    let ir = compiled.ir.expect("it compiles");
    let arsc_ir::Bsdf::Fluorescent { reradiation, .. } = &ir.bsdfs[0] else { panic!("{:?}", ir.bsdfs) };
    assert_eq!([400.0, 425.0, 450.0].map(|nm| reradiation.reflectance.eval(nm)), [0.25, 0.375, 0.5]);
    assert_eq!(reradiation.fluorescence.density(400.0, 500.0), 0.1 / 50.0);
    assert_eq!(reradiation.fluorescence.density(450.0, 500.0), 0.125 / 50.0);
    assert_eq!(reradiation.fluorescence.density(450.0, 450.0), 0.0);
    for (table, part) in [
        ("nm,400,450,510\n400,0.25,0.2,0.1\n450,0,0.5,0.125\n", "equal steps"),
        ("nm,400,blue\n400,0.25,0.2\n", "`blue` is no wavelength"),
        ("nm,410,460\n400,0.25,0.2\n450,0,0.2\n", "the reflectance is not known"),
        ("nm,400,450\n400,0.25,-0.2\n450,0,0.2\n", "must not be negative"),
        ("nm,400,450\n400,0.25,1.2\n450,0,0.2\n", "photons of one at 400nm"),
    ] {
        let compiled = compile(script, &[("paint.csv", table)]);
        let message = &compiled.diagnostics[0].message;
        assert!(message.contains(part), "{table:?}: {message}");
    }
}
