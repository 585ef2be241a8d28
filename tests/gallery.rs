//! The scenes: `arsc check` finds nothing in them, those of the thesis have as many solids and primitives of each kind as
//! it says, every one of the gallery has its line and its picture, and `arsc bench thesis` measures them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use arsc_ir::{Ir, Leaf, NodeId, NodeKind};

mod common;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace is there")
}

/// The scripts of a folder that describe a scene, sorted.
fn scripts(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("readable").path());
    let mut scripts: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|e| e == "arsl")).collect();
    scripts.sort();
    scripts
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

/// Scripts that cannot do without what `meshes/fetch` makes.
fn wants_mesh(script: &Path) -> bool {
    let meshes = root().join("scenes/gallery/meshes/data");
    let missing = |name: &str| !meshes.join(name).exists();
    match script.file_stem().and_then(|stem| stem.to_str()) {
        Some("mesh") => missing("teapot.ply"),
        Some("mesh_csg") => missing("rock.ply") || missing("buddha.ply"),
        _ => false,
    }
}

#[test]
fn scenes_are_clean() {
    let all = [scripts("scenes"), scripts("scenes/gallery")].concat();
    assert!(all.len() > 12);
    for script in all.iter().filter(|script| !wants_mesh(script)) {
        let run = common::arsc(&["check", text(script)]);
        assert_eq!(run.status.code(), Some(0), "{}", common::stderr(&run));
        assert_eq!(common::stderr(&run) + &common::stdout(&run), "", "{}", script.display());
    }
}

/// Primitives of a subtree by kind, with every use of what is shared.
fn primitives(ir: &Ir, id: NodeId) -> BTreeMap<String, usize> {
    match ir.kind(id) {
        NodeKind::Leaf(leaf) => {
            let kind = match &**leaf {
                Leaf::Solid { shape, .. } => format!("{shape:?}"),
                Leaf::Surface { surface, .. } => format!("{surface:?}"),
            };
            let name = kind.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_lowercase();
            BTreeMap::from([(name, 1)])
        }
        kind => {
            let mut sum = BTreeMap::new();
            for &child in kind.children() {
                for (name, n) in primitives(ir, child) {
                    *sum.entry(name).or_default() += n;
                }
            }
            sum
        }
    }
}

/// Topmost CSG nodes, sorted by their numbers of primitives.
fn solids(ir: &Ir) -> Vec<usize> {
    let mut sizes = Vec::new();
    let mut open = ir.kind(ir.root).children().to_vec();
    while let Some(id) = open.pop() {
        match ir.kind(id) {
            NodeKind::Union(_) | NodeKind::Intersection(_) | NodeKind::Difference(_) => {
                sizes.push(primitives(ir, id).values().sum());
            }
            kind => open.extend(kind.children()),
        }
    }
    sizes.sort();
    sizes
}

/// The scene before the optimiser, by way of its text form.
fn source(name: &str) -> Ir {
    let script = root().join(format!("scenes/gallery/{name}.arsl"));
    let run = common::arsc(&["ir", "--pass", "source", text(&script)]);
    assert!(run.status.success(), "{}", common::stderr(&run));
    arsc_ir::read(&common::stdout(&run)).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

/// Primitives by kind, topmost CSG nodes, and primitives in these.
#[test]
fn scenes_of_the_thesis_are_built_as_it_says() {
    type Scene = (&'static str, &'static [(&'static str, usize)], usize, usize);
    let expected: [Scene; 9] = [
        ("shell", &[("box", 257), ("sphere", 2144)], 1, 2144),
        ("oren_nayar_spheres", &[("cylinder", 1), ("sphere", 3), ("torus", 54)], 3, 57),
        ("villa_rotonda", &[("box", 778), ("cone", 55), ("cylinder", 300), ("sphere", 122)], 2, 1254),
        ("torrance_sparrow_spheres", &[("box", 3), ("cylinder", 1), ("sphere", 12), ("torus", 216)], 12, 228),
        ("biplane", &[("box", 54), ("cone", 2), ("cylinder", 229), ("sphere", 45), ("torus", 7)], 28, 119),
        (
            "locomotive",
            &[
                ("box", 1302),
                ("cone", 236),
                ("cylinder", 707),
                ("hyperboloid", 2),
                ("paraboloid", 1124),
                ("sphere", 168),
                ("torus", 56),
            ],
            354,
            1637,
        ),
        ("colorchecker", &[("box", 25), ("cylinder", 1)], 0, 0),
        ("textured_cornell_box", &[("quad", 20)], 0, 0),
        ("glowing_spheres", &[("cylinder", 1), ("sphere", 12)], 0, 0),
    ];
    for (name, kinds, tops, within) in expected {
        let ir = source(name);
        let found = primitives(&ir, ir.root);
        let expected: BTreeMap<String, usize> = kinds.iter().map(|&(kind, n)| (kind.to_owned(), n)).collect();
        assert_eq!(found, expected, "{name}");
        let sizes = solids(&ir);
        assert_eq!((sizes.len(), sizes.iter().sum::<usize>()), (tops, within), "{name}");
    }
    assert_eq!(solids(&source("villa_rotonda")), [2, 1252]);
    let biplane = solids(&source("biplane"));
    assert_eq!((biplane.iter().filter(|&&size| size == 2).count(), biplane.last()), (19, Some(&27)));
    let exoplanet = source("exoplanet");
    assert_eq!(solids(&exoplanet).len(), 11, "ten grooved spheres, and a rabbit in place of the mesh");
}

#[test]
fn every_scene_has_a_line_and_a_picture() {
    let page = std::fs::read_to_string(root().join("scenes/README.md")).expect("the page is there");
    for script in [scripts("scenes"), scripts("scenes/gallery")].concat() {
        let name = script.file_name().expect("a file").to_string_lossy().into_owned();
        assert!(page.lines().any(|line| line.contains(&format!("{name}`"))), "scenes/README.md says nothing of {name}");
    }
    for entry in std::fs::read_dir(root().join("docs/images/gallery")).expect("the folder is there") {
        let path = entry.expect("readable").path();
        let mut file = std::fs::File::open(&path).expect("opens");
        assert!(file.metadata().expect("a file").len() < 700_000, "{} is large", path.display());
        let reader = png::Decoder::new(std::io::BufReader::new(&mut file)).read_info().expect("a PNG");
        assert!(reader.info().width <= 700 && reader.info().height <= 700, "{} is large", path.display());
    }
}

#[test]
fn bench_thesis_prints_tables() {
    let scenes = root().join("scenes/gallery");
    let only = "4.1b,4.3b,4.5f";
    let bench = |format: &str| {
        let size = ["--samples", "1", "--size", "8x8", "--quiet", "--format", format];
        let run = common::arsc(&[&["bench", "thesis", "--scenes", text(&scenes), "--only", only][..], &size].concat());
        assert!(run.status.success(), "{}", common::stderr(&run));
        common::stdout(&run)
    };
    let record: serde_json::Value = serde_json::from_str(&bench("json")).expect("a record in JSON");
    let rows = record["rows"].as_array().expect("a list");
    let spheres = &rows[0];
    assert_eq!((&spheres["figure"], &spheres["solids"]), (&"4.1b".into(), &3.into()));
    let csg: Vec<&str> =
        spheres["runs"].as_array().expect("runs").iter().filter_map(|run| run["csg"].as_str()).collect();
    assert_eq!(csg, ["native", "tree", "kd", "local"]);
    for row in rows {
        for run in row["runs"].as_array().expect("runs") {
            assert_eq!(run["camera_paths"], 64, "{row}");
            assert!(run["trace_seconds"].as_f64() > Some(0.0), "{row}");
        }
    }
    // Tables 4.3 and 4.4 have the Cornell box, as surfaces and as solids.
    assert_eq!(rows.iter().filter(|row| row["figure"] == "4.3b").count(), 2);
    assert!(rows.iter().skip(1).take(2).all(|row| row["geometries"] == 20), "{rows:?}");

    let tables = bench("text");
    for part in ["Table 4.1", "oren_nayar_spheres", "791.71", "gain of local", "Table 4.4", "454.60", "default / ART"] {
        assert!(tables.contains(part), "{part} is not in\n{tables}");
    }
    // The thesis' own gain: (791.71 - 522.97) / 791.71.
    assert!(tables.contains("(33.9 %)"), "{tables}");
    if !scenes.join("meshes/data/lucy.ply").exists() {
        assert!(tables.contains("skipped 4.5f mesh lucy: meshes/data/lucy.ply is not there"), "{tables}");
    }

    let values = bench("csv");
    let mut lines = values.lines().map(|line| line.split(',').count());
    let columns = lines.next();
    assert!(columns == Some(14) && lines.all(|n| Some(n) == columns), "{values}");
}

#[test]
fn bench_thesis_says_where_it_looked() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = common::arsc(&["bench", "thesis", "--scenes", text(folder.path())]);
    assert_eq!(run.status.code(), Some(2));
    assert!(common::stderr(&run).contains("none of the scenes is in"), "{}", common::stderr(&run));
}
