//! The house rules of `docs/architecture.md`, checked on the source text: ranks of crates, one door for pest, for
//! `unsafe` and for Embree, a compiler without side effects, links that lead somewhere.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Crates by rank; a crate may depend only on crates of lower rank.
const RANKS: &[(&str, u32)] = &[
    ("arsc-diagnostics", 0),
    ("arsc-geometry", 0),
    ("arsc-spectral", 0),
    ("arsc-embree", 0),
    ("arsc-denoise", 0),
    ("arsc-texture", 1),
    ("arsc-syntax", 1),
    ("arsc-accel", 1),
    ("arsc-image", 1),
    ("arsc-mesh", 1),
    ("arsc-ir", 2),
    ("arsc-imaging", 2),
    ("arsc-render", 2),
    ("arsc-sema", 3),
    ("arsc-opt", 3),
    ("arsc-assembly", 3),
    ("arsc-driver", 4),
    ("arsc", 5),
];

/// Crates that neither read files, nor the clock, nor the environment, nor print.
const PURE: &[&str] = &[
    "compiler/diagnostics",
    "compiler/syntax",
    "compiler/ir",
    "compiler/sema",
    "compiler/opt",
    "compiler/driver",
    "runtime/geometry",
    "runtime/spectral",
    "runtime/imaging",
    "runtime/texture",
];

/// Past this many lines a file usually holds two reasons to change.
const LONGEST_FILE: usize = 700;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace is there")
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// All files below `folder` with the extension, sorted; build output and hidden folders left out.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let Ok(entries) = std::fs::read_dir(folder) else { return found };
    for path in entries.map(|entry| entry.expect("readable folder").path()) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && !name.starts_with('.') && name != "target" && name != "out" {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Folder of each crate by name.
fn crates() -> BTreeMap<String, PathBuf> {
    let manifests = ["compiler", "runtime"].map(|part| files(&root().join(part), "toml"));
    let name_of = |manifest: &Path| {
        let line =
            read(manifest).lines().find_map(|l| Some(l.strip_prefix("name = \"")?.trim_end_matches('"').to_owned()));
        line.expect("a manifest has a name")
    };
    let folder = |manifest: PathBuf| (name_of(&manifest), manifest.parent().expect("a folder").to_owned());
    manifests.into_iter().flatten().filter(|m| m.ends_with("Cargo.toml")).map(folder).collect()
}

/// Names under `[dependencies]` and `[build-dependencies]`, not those for tests.
fn dependencies(manifest: &str) -> Vec<String> {
    let mut section = "";
    let mut names = Vec::new();
    for line in manifest.lines().map(str::trim) {
        if line.starts_with('[') {
            section = line;
        } else if matches!(section, "[dependencies]" | "[build-dependencies]")
            && let Some(end) = line.find(['.', '=', ' '])
            && !line.starts_with('#')
        {
            names.push(line[..end].to_owned());
        }
    }
    names
}

/// Source text of a crate without comments and without what follows `#[cfg(test)]`, by file.
fn code(folder: &Path) -> Vec<(PathBuf, String)> {
    let strip = |text: &str| -> String {
        let body = text.split("#[cfg(test)]").next().unwrap_or_default();
        body.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
    };
    files(&folder.join("src"), "rs").into_iter().map(|path| (path.clone(), strip(&read(&path)))).collect()
}

#[test]
fn crates_depend_only_on_lower_ranks() {
    let ranks: BTreeMap<&str, u32> = RANKS.iter().copied().collect();
    let crates = crates();
    assert_eq!(crates.keys().map(String::as_str).collect::<Vec<_>>(), ranks.keys().copied().collect::<Vec<_>>());
    for (name, folder) in &crates {
        for dependency in dependencies(&read(&folder.join("Cargo.toml"))) {
            if let Some(rank) = ranks.get(dependency.as_str()) {
                assert!(*rank < ranks[name.as_str()], "{name} may not depend on {dependency}");
            }
        }
    }
}

#[test]
fn the_map_names_every_crate_with_its_rank() {
    let map = read(&root().join("docs/architecture.md"));
    for (name, rank) in RANKS {
        let short = if *name == "arsc" { "cli" } else { name.trim_start_matches("arsc-") };
        let line = map.lines().find(|line| line.split_whitespace().next() == Some(short));
        let line = line.unwrap_or_else(|| panic!("docs/architecture.md does not name {short}"));
        assert!(line.contains(&format!("rank {rank}")), "docs/architecture.md: {line}");
    }
}

#[test]
fn pest_is_named_only_in_the_syntax_stage() {
    for (name, folder) in crates() {
        if name == "arsc-syntax" {
            continue;
        }
        let direct = dependencies(&read(&folder.join("Cargo.toml")));
        assert!(!direct.iter().any(|d| d.starts_with("pest")), "{name} depends on pest");
        for (path, text) in code(&folder) {
            assert!(!text.contains("pest::") && !text.contains("pest_derive"), "{} names pest", path.display());
        }
    }
}

#[test]
fn unsafe_and_embree_have_one_door() {
    for (name, folder) in crates() {
        if name == "arsc-embree" {
            continue;
        }
        // Open Image Denoise is loaded at run time, not linked: it has a door of its own.
        let may_be_unsafe = name == "arsc-denoise";
        for (path, text) in code(&folder) {
            for word in text.split(|c: char| !c.is_alphanumeric() && c != '_') {
                let calls_embree = word.strip_prefix("rtc").is_some_and(|rest| rest.starts_with(char::is_uppercase));
                assert!(!calls_embree, "{} calls {word}", path.display());
                assert!(
                    may_be_unsafe || word != "unsafe" && word != "unsafe_code",
                    "{} has unsafe code",
                    path.display()
                );
            }
        }
    }
}

#[test]
fn the_compiler_has_no_side_effects() {
    let forbidden = ["std::fs", "std::env", "std::time", "std::net", "std::process", "std::io", "println!", "print!("];
    for folder in PURE {
        for (path, text) in code(&root().join(folder)) {
            for word in forbidden {
                assert!(!text.contains(word), "{} uses {word}", path.display());
            }
        }
    }
}

#[test]
fn files_stay_short() {
    let is_generated = |path: &Path| path.ends_with("runtime/embree/src/bindings.rs");
    let long: Vec<String> = ["compiler", "runtime", "tests"]
        .iter()
        .flat_map(|part| files(&root().join(part), "rs"))
        .filter(|path| !is_generated(path))
        .map(|path| (read(&path).lines().count(), path))
        .filter(|(lines, _)| *lines > LONGEST_FILE)
        .map(|(lines, path)| format!("{}: {lines} lines", path.display()))
        .collect();
    assert!(long.is_empty(), "split these: {long:#?}");
}

#[test]
fn modules_open_with_a_doc_comment() {
    let bare: Vec<PathBuf> = crates()
        .into_values()
        .flat_map(|folder| files(&folder.join("src"), "rs"))
        .filter(|path| !path.ends_with("bindings.rs"))
        .filter(|path| !read(path).trim_start().starts_with("//!"))
        .collect();
    assert!(bare.is_empty(), "these say not what they are: {bare:#?}");
}

#[test]
fn links_in_the_documentation_lead_somewhere() {
    let mut broken = Vec::new();
    for page in files(&root(), "md") {
        let folder = page.parent().expect("a folder");
        for target in link_targets(&read(&page)) {
            let file = target.split('#').next().unwrap_or_default();
            if !file.is_empty()
                && !target.contains("://")
                && !target.starts_with("mailto:")
                && !folder.join(file).exists()
            {
                broken.push(format!("{}: {target}", page.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Targets of `[text](target)` outside of code blocks and code spans.
fn link_targets(markdown: &str) -> Vec<String> {
    let mut targets = Vec::new();
    let mut in_block = false;
    for line in markdown.lines() {
        if line.trim_start().starts_with("```") {
            in_block = !in_block;
        } else if !in_block && !line.starts_with("    ") {
            let prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join("code");
            targets.extend(prose.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0.to_owned())));
        }
    }
    targets
}
