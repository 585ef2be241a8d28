//! `arsc render` from outside: pictures, options, refusals, interrupts.

mod common;

use common::{arsc, scene, stderr, stdout};

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const BALL: &str = "
import std.material { lambert }
import std.spectra { d65 }
param albedo: float = 0.5
scene {
    sphere(radius: 1) - box(size: (1, 1, 4)) |> with(lambert(albedo))
    environment(d65)
}
camera perspective(eye: (0, -4, 2), target: (0, 0, 0), fov: 40deg, resolution: (32, 24))
actions {
    path_trace(samples: 4, max_depth: 4)
    write_exr(\"ball.exr\")
    tone_map(exposure: auto)
    write_png(\"ball.png\")
}
";

fn files(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn image(path: &Path) -> arsc_image::SpectralImage {
    arsc_image::decode_exr(&std::fs::read(path).unwrap()).unwrap()
}

fn metadata<'a>(image: &'a arsc_image::SpectralImage, name: &str) -> Option<&'a str> {
    image.metadata.iter().find(|(n, _)| n == name).map(|(_, value)| value.as_str())
}

#[test]
fn writes_what_the_script_says_below_the_output_folder() {
    let (folder, script) = scene("ball.arsl", BALL);
    let out = folder.path().join("new/out");
    let run = arsc(&["render", &script, "-o", out.to_str().unwrap(), "--seed", "7", "--stats"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    assert_eq!(files(&out), ["ball.exr", "ball.png"]);
    for name in ["ball.exr", "ball.png"] {
        assert!(stdout(&run).lines().any(|l| l.starts_with("wrote ") && l.ends_with(name)), "{}", stdout(&run));
    }
    assert!(stderr(&run).contains("samples/s"), "{}", stderr(&run));
    let image = image(&out.join("ball.exr"));
    assert_eq!((image.width, image.height, image.bands()), (32, 24, 47));
    assert_eq!(metadata(&image, "seed"), Some("7"));
    assert_eq!(metadata(&image, "samples"), Some("4"));
    assert_eq!(metadata(&image, "version"), Some(env!("CARGO_PKG_VERSION")));
    assert_eq!(metadata(&image, "sceneHash").map(str::len), Some(32));
    assert!(metadata(&image, "commandLine").unwrap().starts_with("arsc render "));
    assert!(metadata(&image, "renderSeconds").unwrap().parse::<f64>().is_ok());
    assert!(image.xyz.iter().all(|p| p.iter().all(|c| c.is_finite() && *c >= 0.0)));
}

#[test]
fn statistics_are_for_people_or_for_programs() {
    let (folder, script) = scene("ball.arsl", BALL);
    let out = folder.path().join("out");
    let run = |more: &[&str]| {
        let args = [&["render", &script, "-q", "--samples", "1", "-o", out.to_str().unwrap()], more].concat();
        let run = arsc(&args);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        run
    };
    let text = stderr(&run(&["--stats"]));
    for word in ["csg            local", "cells", "per camera ray", "B per primitive", "ms per primitive"] {
        assert!(text.contains(word), "{word} is not in\n{text}");
    }
    for strategy in ["local", "native", "collect", "tree", "kd", "hybrid", "incremental"] {
        let printed = stdout(&run(&["--stats=json", "--csg", strategy, "--max-cells", "5", "--max-cell-memory", "1M"]));
        let json: serde_json::Value = serde_json::from_str(&printed).unwrap();
        assert_eq!(json[0]["csg"], strategy);
        for name in ["primitives", "cells", "tests_per_ray", "bytes", "build_seconds", "bytes_per_primitive"] {
            assert!(json[0][name].as_f64().unwrap() > 0.0, "{strategy}: {name} in {printed}");
        }
    }
}

#[test]
fn an_unknown_strategy_is_told_the_known_ones() {
    let (_folder, script) = scene("ball.arsl", BALL);
    let run = arsc(&["render", &script, "--csg", "fastest"]);
    assert_eq!(run.status.code(), Some(2));
    for name in ["local", "native", "collect", "tree", "kd", "hybrid", "incremental"] {
        assert!(stderr(&run).contains(name), "{}", stderr(&run));
    }
}

#[test]
fn reproducible_renders_are_equal_files_whatever_the_threads() {
    let (folder, script) = scene("ball.arsl", BALL);
    let render = |name: &str, threads: &str| {
        let out = folder.path().join(name);
        let run = arsc(&["render", &script, "-q", "--reproducible", "-j", threads, "-o", out.to_str().unwrap()]);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        assert!(run.stdout.is_empty() && run.stderr.is_empty(), "quiet is quiet");
        ["ball.exr", "ball.png"].map(|file| std::fs::read(out.join(file)).unwrap())
    };
    assert_eq!(render("one", "1"), render("four", "4"));
}

#[test]
fn options_override_the_script() {
    let (folder, script) = scene("ball.arsl", BALL);
    let out = folder.path().join("picture.exr");
    let arguments = ["render", &script, "-o", out.to_str().unwrap(), "--samples", "2", "--resolution", "20x10"];
    let more = ["--crop", "5,2,12,9", "--csg", "tree", "--set", "albedo=1", "--max-depth", "2"];
    let run = arsc(&[&arguments[..], &more[..]].concat());
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    assert_eq!(files(folder.path()), ["ball.arsl", "picture.exr"], "the PNG was not asked for");
    let image = image(&out);
    assert_eq!((image.width, image.height), (20, 10));
    assert_eq!((metadata(&image, "samples"), metadata(&image, "maxDepth")), (Some("2"), Some("2")));
    assert_eq!((metadata(&image, "csg"), metadata(&image, "crop")), (Some("tree"), Some("5,2,12,9")));
    for (i, pixel) in image.xyz.iter().enumerate() {
        let inside = (5..12).contains(&(i % 20)) && (2..9).contains(&(i / 20));
        assert_eq!(pixel[1] > 0.0, inside, "pixel {i}");
    }
}

#[test]
fn a_script_from_standard_input_has_default_actions() {
    let folder = tempfile::tempdir().unwrap();
    let script = "scene { sphere(radius: 1)\n environment(constant_emission(1)) }";
    let out = folder.path().to_str().unwrap();
    let run = common::arsc_with_input(&["render", "-", "-o", out, "--samples", "1", "--resolution", "16x16"], script);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    assert_eq!(files(folder.path()), ["scene.exr", "scene.png"]);
}

#[test]
fn nothing_is_written_outside_of_the_output_folder() {
    for name in ["../escaped.png", "/tmp/arsc-escaped.png", "a/../../escaped.png"] {
        let (folder, script) = scene("ball.arsl", &BALL.replace("ball.png", name));
        let out = folder.path().join("out");
        let run = arsc(&["render", &script, "-o", out.to_str().unwrap()]);
        assert_ne!(run.status.code(), Some(0), "{name}");
        assert!(stderr(&run).contains("output folder"), "{name}: {}", stderr(&run));
        assert!(!folder.path().join("escaped.png").exists() && !Path::new("/tmp/arsc-escaped.png").exists());
    }
}

#[test]
fn refusals_come_before_the_render_and_name_the_reason() {
    let (folder, script) = scene("ball.arsl", BALL);
    let file = folder.path().join("file");
    std::fs::write(&file, "in the way").unwrap();
    let blocked = file.join("out");
    let photograph = folder.path().join("ball.jpg");
    let cases: [(&[&str], &str); 10] = [
        (&["-o", blocked.to_str().unwrap()], "cannot use the output folder"),
        (&["--resolution", "0x7"], "WIDTHxHEIGHT"),
        (&["--crop", "0,0,99,99"], "does not lie in the image"),
        (&["--samples", "0"], "samples"),
        (&["-j", "0"], "threads"),
        (&["--set", "albedo"], "NAME=VALUE"),
        (&["-o", photograph.to_str().unwrap()], "not as .jpg"),
        (&["--crop", "-1,0,5,5"], "expected x0,y0,x1,y1"),
        (&["--seed", "-1"], "'-1' for '--seed"),
        (&["--max-depth", "0"], "0 is not in 1..="),
    ];
    for (arguments, reason) in cases {
        let out = folder.path().join("unused");
        let mut all = vec!["render", script.as_str(), "--samples", "1000000"];
        if arguments[0] == "--samples" {
            all.truncate(2);
        }
        if arguments[0] != "-o" {
            all.extend(["-o", out.to_str().unwrap()]);
        }
        all.extend(arguments);
        let run = arsc(&all);
        assert_eq!(run.status.code(), Some(2), "{arguments:?}: {}", stderr(&run));
        assert!(stderr(&run).contains(reason), "{arguments:?}: {}", stderr(&run));
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "in the way");
}

#[test]
fn a_library_is_not_rendered() {
    let (folder, script) = scene("parts.arsl", "fn wheel(r: float) -> solid { cylinder(r, 0.1) }");
    let out = folder.path().join("out");
    let run = arsc(&["render", &script, "-o", out.to_str().unwrap()]);
    assert_eq!(run.status.code(), Some(2), "{}", stderr(&run));
    assert!(stderr(&run).contains("parts.arsl has no `scene { … }`") && !out.exists(), "{}", stderr(&run));
}

#[test]
fn a_script_with_errors_is_not_rendered() {
    let (folder, script) = scene("bad.arsl", "scene { sphere(radios: 1) }");
    let out = folder.path().join("out");
    let run = arsc(&["render", &script, "-o", out.to_str().unwrap()]);
    assert_eq!(run.status.code(), Some(1), "{}", stderr(&run));
    assert!(stderr(&run).contains("radios") && !out.exists());
    let missing = arsc(&["render", "there-is-no-such.arsl"]);
    assert_eq!(missing.status.code(), Some(2), "{}", stderr(&missing));
}

/// The render would take hours; one interrupt ends it with a picture of what there was.
#[cfg(unix)]
#[test]
fn an_interrupt_writes_what_has_been_rendered() {
    let (folder, script) = scene("ball.arsl", BALL);
    let out = folder.path().join("out");
    let child = Command::new(env!("CARGO_BIN_EXE_arsc"))
        .args(["render", &script, "--samples", "60000", "--resolution", "160x120", "-o", out.to_str().unwrap()])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_secs(2));
    let start = Instant::now();
    // The shell's own `kill`: a bare Debian has no program of that name.
    Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    let run = child.wait_with_output().unwrap();
    assert_eq!(run.status.code(), Some(130), "{}", stderr(&run));
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    assert!(stderr(&run).contains("interrupted after"), "{}", stderr(&run));
    assert_eq!(files(&out), ["ball.exr", "ball.png"]);
    let image = image(&out.join("ball.exr"));
    assert!(metadata(&image, "interrupted").unwrap().contains("60000"));
    assert!(image.xyz[0][1] > 0.0, "the corner sees the sky");
}
