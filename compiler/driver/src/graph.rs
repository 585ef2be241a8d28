//! The graph of modules: the root script and everything that it imports, dependencies first.

use std::collections::BTreeMap;
use std::sync::Arc;

use arsc_diagnostics::{Applicability, Diagnostic, SourceFile, SourceId, SourceMap, Span, closest, codes};
use arsc_sema::Module;
use arsc_syntax::ast::{Import, ImportPath, ItemKind};

use crate::assets::Origin;
use crate::{LoadError, Loader, Options, paths, stdlib};

/// What was loaded. Sources are numbered in the order in which they were met: the root is the first.
pub(crate) struct Graph {
    pub sources: SourceMap,
    /// By source.
    pub origins: Vec<Origin>,
    /// Dependencies first, the root last.
    pub modules: Vec<Module>,
    pub diagnostics: Vec<Diagnostic>,
}

enum State {
    /// Its imports are being loaded.
    Open,
    /// Its index in `modules`, `None` if it could not be read.
    Done(Option<usize>),
}

/// Where a module's text is.
struct Place {
    /// Unique among all modules, and shown to people.
    name: String,
    origin: Origin,
}

struct Walk<'a> {
    loader: &'a dyn Loader,
    options: &'a Options,
    graph: Graph,
    states: BTreeMap<String, State>,
    /// The modules that are open, outermost first.
    open: Vec<String>,
}

/// Reads the root script and loads what it imports.
pub(crate) fn load(name: &str, text: Arc<str>, loader: &dyn Loader, options: &Options) -> Graph {
    let graph =
        Graph { sources: SourceMap::default(), origins: Vec::new(), modules: Vec::new(), diagnostics: Vec::new() };
    let mut walk = Walk { loader, options, graph, states: BTreeMap::new(), open: Vec::new() };
    // Loaders know paths relative to the root's folder: in it, the root goes by its last part.
    let file = name.rsplit('/').next().unwrap_or(name).to_string();
    if let Some(module) = walk.module(name, &file, Origin::File(file.clone()), text) {
        walk.graph.modules.push(module);
    }
    walk.graph
}

impl Walk<'_> {
    /// Reads a module and all that it imports. `key` is its place among the open modules.
    fn module(&mut self, shown: &str, key: &str, origin: Origin, text: Arc<str>) -> Option<Module> {
        let size = text.len();
        let limit = self.options.source_bytes;
        let is_std = matches!(origin, Origin::Std);
        let kept: Arc<str> = if size > limit { Arc::from("") } else { text.clone() };
        let source = self.graph.sources.add(SourceFile::new(shown, kept));
        self.graph.origins.push(origin);
        if size > limit {
            self.graph.diagnostics.push(too_large(shown, size as u64, limit));
            return None;
        }
        let parsed = arsc_syntax::parse(source, &text);
        self.graph.diagnostics.extend(parsed.diagnostics);
        self.states.insert(key.to_string(), State::Open);
        self.open.push(key.to_string());
        let mut imports = Vec::new();
        for item in &parsed.module.items {
            if let ItemKind::Import(import) = &item.kind {
                imports.push(self.import(source, import));
            }
        }
        self.open.pop();
        Some(Module { source, name: shown.to_string(), is_std, ast: parsed.module, imports })
    }

    /// The index of the module that an import names.
    fn import(&mut self, from: SourceId, import: &Import) -> Option<usize> {
        let (span, place) = self.place(from, &import.path)?;
        match self.states.get(&place.name) {
            Some(State::Done(index)) => return *index,
            Some(State::Open) => {
                self.cycle(span, &place.name);
                return None;
            }
            None => {}
        }
        if self.open.len() > self.options.include_depth {
            self.graph.diagnostics.push(
                Diagnostic::new(codes::driver::IMPORT_DEPTH, "imports are nested too deeply")
                    .label(span, format!("more than {} levels", self.options.include_depth)),
            );
            return None;
        }
        let text = match place.origin {
            Origin::Std => stdlib::module(&place.name).map(Arc::from).ok_or(LoadError::NotFound),
            Origin::File(_) => self.loader.load(&place.name),
        };
        let module = match text {
            Ok(text) => self.module(&place.name, &place.name, place.origin, text),
            Err(error) => {
                self.unreadable(span, &place, &error);
                None
            }
        };
        let index = module.map(|module| {
            self.graph.modules.push(module);
            self.graph.modules.len() - 1
        });
        self.states.insert(place.name, State::Done(index));
        index
    }

    fn place(&mut self, from: SourceId, path: &ImportPath) -> Option<(Span, Place)> {
        match path {
            ImportPath::File { path, span } => {
                let Origin::File(file) = self.graph.origins.get(from.0 as usize)? else {
                    let message = "modules of `std` import only modules of `std`";
                    self.graph
                        .diagnostics
                        .push(Diagnostic::new(codes::driver::MODULE_UNREADABLE, message).label(*span, "a file"));
                    return None;
                };
                let name = paths::join(file, path);
                Some((*span, Place { name: name.clone(), origin: Origin::File(name) }))
            }
            ImportPath::Std { segments, span } => {
                let name = segments.iter().map(|segment| segment.name.as_str()).collect::<Vec<_>>().join(".");
                if segments.first().is_none_or(|first| first.name != "std") {
                    self.graph.diagnostics.push(
                        Diagnostic::new(codes::driver::MODULE_NOT_FOUND, format!("there is no module `{name}`"))
                            .label(*span, "not found")
                            .help("modules without quotes begin with `std.`; a file is imported by its path in quotes"),
                    );
                    return None;
                }
                Some((*span, Place { name, origin: Origin::Std }))
            }
        }
    }

    fn cycle(&mut self, span: Span, name: &str) {
        let start = self.open.iter().position(|open| open == name).unwrap_or(0);
        let mut path: Vec<&str> = self.open[start..].iter().map(String::as_str).collect();
        path.push(name);
        let help = format!("the cycle is {}", path.join(" → "));
        let label = if path.len() == 2 { "imports itself" } else { "closes the cycle" };
        self.graph.diagnostics.push(
            Diagnostic::new(codes::driver::IMPORT_CYCLE, "modules import each other in a cycle")
                .label(span, label)
                .help(help),
        );
    }

    fn unreadable(&mut self, span: Span, place: &Place, error: &LoadError) {
        let name = &place.name;
        let (code, message, label) = match error {
            LoadError::NotFound => {
                (codes::driver::MODULE_NOT_FOUND, format!("there is no module `{name}`"), "not found".to_string())
            }
            LoadError::NotText(offset) => {
                let label = format!("not UTF-8 at byte {offset}");
                (codes::syntax::NOT_TEXT, format!("the module `{name}` is not text"), label)
            }
            LoadError::TooLarge { bytes } => {
                (codes::syntax::TOO_LARGE, format!("the module `{name}` is too large"), format!("{bytes} bytes"))
            }
            LoadError::Forbidden => {
                let message = format!("the module `{name}` lies outside of what may be read");
                (codes::driver::MODULE_UNREADABLE, message, "not allowed".to_string())
            }
            LoadError::Malformed(reason) | LoadError::Other(reason) => {
                (codes::driver::MODULE_UNREADABLE, format!("the module `{name}` cannot be read"), reason.clone())
            }
        };
        let mut diagnostic = Diagnostic::new(code, message).label(span, label);
        if *error == LoadError::NotFound {
            diagnostic = self.did_you_mean(diagnostic, span, place);
        }
        self.graph.diagnostics.push(diagnostic);
    }

    fn did_you_mean(&self, diagnostic: Diagnostic, span: Span, place: &Place) -> Diagnostic {
        match &place.origin {
            Origin::Std => {
                let modules: Vec<String> = stdlib::modules().collect();
                match closest(&place.name, modules.iter().map(String::as_str)) {
                    Some(meant) => diagnostic.suggest(span, meant, Applicability::MaybeIncorrect),
                    None => diagnostic.help(format!("there are {}", modules.join(", "))),
                }
            }
            Origin::File(path) => {
                let (folder, file) = path.rsplit_once('/').unwrap_or(("", path));
                let siblings = self.loader.list(folder);
                match closest(file, siblings.iter().map(String::as_str)) {
                    Some(meant) => diagnostic.help(format!("there is a file `{meant}` in that folder")),
                    None => diagnostic.help("paths are relative to the folder of the script that names them"),
                }
            }
        }
    }
}

pub(crate) fn too_large(name: &str, bytes: u64, limit: usize) -> Diagnostic {
    Diagnostic::new(codes::syntax::TOO_LARGE, format!("the script `{name}` is too large"))
        .help(format!("it has {bytes} bytes, the limit is {limit}: keep bulk data in meshes"))
}
