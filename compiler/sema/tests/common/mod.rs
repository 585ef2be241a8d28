//! Analysis of texts, with std modules and tables of the repository.
#![allow(dead_code)]

use std::sync::Arc;

use arsc_diagnostics::{Diagnostic, SourceFile, SourceId, SourceMap};
use arsc_geometry::TriangleMesh;
use arsc_sema::{Analysed, AssetError, Assets, DataFile, MeshFile, Module, Options, Setting, analyse};
use arsc_syntax::ast::{ImportPath, ItemKind};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Modules of the standard library and their tables, from the repository.
struct Files;

impl Assets for Files {
    fn text(&self, _from: SourceId, path: &str) -> Result<Arc<str>, AssetError> {
        std::fs::read_to_string(format!("{ROOT}/stdlib/{path}")).map(Arc::from).map_err(|_| AssetError::NotFound)
    }

    fn mesh(&self, _from: SourceId, path: &str) -> Result<MeshFile, AssetError> {
        let mut mesh = TriangleMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            ..TriangleMesh::default()
        };
        match path {
            "bunny.ply" => {}
            "torn.ply" => drop(mesh.triangles.pop()),
            "flipped.ply" => mesh.triangles[1].swap(0, 1),
            "inverted.ply" => mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1)),
            "degenerate.ply" => mesh.triangles.push([0, 1, 1]),
            "broken.ply" => return Err(AssetError::Malformed("the file ends in `face` 2 of 9".into())),
            _ => return Err(AssetError::NotFound),
        }
        Ok(MeshFile { path: path.into(), mesh: Arc::new(mesh) })
    }

    fn bytes(&self, _from: SourceId, path: &str) -> Result<DataFile, AssetError> {
        match path {
            "broken.hdr" => Ok(DataFile { path: path.into(), bytes: b"#?RADIANCE\n\n-Y 2 +X 2\n".as_slice().into() }),
            _ => Err(AssetError::NotFound),
        }
    }
}

#[derive(Default)]
pub struct Session {
    pub sources: SourceMap,
    modules: Vec<Module>,
    files: Vec<(String, String)>,
}

impl Session {
    /// A session in which `import "name"` finds these texts.
    pub fn with_files(files: &[(&str, &str)]) -> Session {
        let files = files.iter().map(|(name, text)| (name.to_string(), text.to_string())).collect();
        Session { files, ..Session::default() }
    }

    fn load(&mut self, name: &str, text: &str, is_std: bool) -> usize {
        let source = self.sources.add(SourceFile::new(name, text));
        let parsed = arsc_syntax::parse(source, text);
        assert!(parsed.diagnostics.is_empty(), "{name} does not parse: {:#?}", parsed.diagnostics);
        let mut imports = Vec::new();
        for item in &parsed.module.items {
            if let ItemKind::Import(import) = &item.kind {
                let name = match &import.path {
                    ImportPath::Std { segments, .. } => {
                        segments.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(".")
                    }
                    ImportPath::File { path, .. } => path.clone(),
                };
                imports.push(Some(self.module(&name)));
            }
        }
        self.modules.push(Module { source, name: name.to_owned(), is_std, ast: parsed.module, imports });
        self.modules.len() - 1
    }

    fn module(&mut self, name: &str) -> usize {
        if let Some(i) = self.modules.iter().position(|module| module.name == name) {
            return i;
        }
        if let Some((_, text)) = self.files.iter().find(|(known, _)| known == name).cloned() {
            return self.load(name, &text, false);
        }
        let file = format!("{ROOT}/stdlib/{}.arsl", name.replace('.', "/"));
        let text = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("{file}: {e}"));
        self.load(name, &text, true)
    }

    /// As [`Session::analyse`] for a text that may have slips; those of imports are not followed: then `None`.
    pub fn analyse_any(&mut self, text: &str, options: Options) -> Option<Analysed> {
        let source = self.sources.add(SourceFile::new("scene.arsl", text));
        let parsed = arsc_syntax::parse(source, text);
        let mut imports = Vec::new();
        for item in &parsed.module.items {
            if let ItemKind::Import(import) = &item.kind {
                let ImportPath::Std { segments, .. } = &import.path else { return None };
                let name = segments.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(".");
                let known = std::fs::exists(format!("{ROOT}/stdlib/{}.arsl", name.replace('.', "/")));
                imports.push(known.is_ok_and(|known| known).then(|| self.module(&name)));
            }
        }
        let options = Options { check_only: !parsed.diagnostics.is_empty() || imports.contains(&None), ..options };
        let check_only = options.check_only;
        self.modules.push(Module { source, name: "scene.arsl".into(), is_std: false, ast: parsed.module, imports });
        let analysed = analyse(&self.modules, &Files, &options);
        (!check_only).then_some(analysed)
    }

    /// A module of the standard library by itself.
    pub fn analyse_std(&mut self, name: &str, text: &str) -> Analysed {
        self.load(name, text, true);
        analyse(&self.modules, &Files, &Options::default())
    }

    pub fn analyse(&mut self, text: &str, params: &[(&str, &str)], options: Options) -> Analysed {
        self.load("scene.arsl", text, false);
        let params = params.iter().map(|(name, text)| {
            let source = self.sources.add(SourceFile::new(format!("--set {name}"), *text));
            let (value, diagnostics) = arsc_syntax::parse_expr(source, text);
            assert!(diagnostics.is_empty(), "{diagnostics:?}");
            Setting { name: name.to_string(), value }
        });
        let options = Options { params: params.collect(), ..options };
        analyse(&self.modules, &Files, &options)
    }
}

pub fn run(text: &str) -> Analysed {
    Session::default().analyse(text, &[], Options::default())
}

/// One line per finding: code, text of the primary label, message.
pub fn findings(text: &str) -> Vec<String> {
    let mut session = Session::default();
    let analysed = session.analyse(text, &[], Options::default());
    describe(&session.sources, &analysed.diagnostics)
}

pub fn describe(sources: &SourceMap, diagnostics: &[Diagnostic]) -> Vec<String> {
    let line = |d: &Diagnostic| {
        let at = d.primary_span().map_or("", |span| sources.text(span));
        format!("{} {:?}: {}", d.code.id(), at, d.message)
    };
    diagnostics.iter().map(line).collect()
}

/// Demands exactly these codes, in order, each with the text of its primary label.
#[track_caller]
pub fn expect(text: &str, wanted: &[(&str, &str)]) {
    let mut session = Session::default();
    let analysed = session.analyse(text, &[], Options::default());
    let found: Vec<(&str, &str)> = analysed
        .diagnostics
        .iter()
        .map(|d| (d.code.id(), d.primary_span().map_or("", |span| session.sources.text(span))))
        .collect();
    let shown = describe(&session.sources, &analysed.diagnostics).join("\n");
    assert_eq!(found, wanted, "\nin {text}\nfound:\n{shown}");
}
