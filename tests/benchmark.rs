//! The benchmark's scripts do not rot: `tests/bench/csg/run` on small scenes and pictures. Every strategy and POV-Ray, where
//! it is installed, see the same in every pixel.

use std::path::Path;
use std::process::Command;

mod common;

#[test]
fn csg_quick() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("skipped: python3 is not here");
        return;
    }
    let has_povray = Command::new("povray").arg("--version").output().is_ok();
    if !has_povray {
        println!("povray is not here: only arsc's strategies are compared");
    }
    let record = tempfile::NamedTempFile::new().expect("a file");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/bench/csg/run");
    let mut command = Command::new("python3");
    command.arg(script).arg(env!("CARGO_BIN_EXE_arsc")).args(["--quick", "--rounds", "1", "--csg", "local,tree"]);
    command.arg("--json").arg(record.path());
    if !has_povray {
        command.arg("--no-povray");
    }
    let run = command.output().expect("python3 starts");
    println!("{}", common::stdout(&run));
    assert!(run.status.success(), "{}", common::stderr(&run));

    let record: serde_json::Value = serde_json::from_reader(record.as_file()).expect("a record in JSON");
    let scenes = record["scenes"].as_array().expect("a list");
    assert_eq!(scenes.len(), 5);
    for scene in scenes {
        let runs = scene["runs"].as_object().expect("runs by program");
        assert_eq!(runs.len(), if has_povray { 3 } else { 2 }, "{}", scene["scene"]);
        for (program, run) in runs {
            let share = run["hits"].as_f64().unwrap() / 14_400.0;
            assert!((0.02..0.98).contains(&share), "{program} hits {share} of {}", scene["scene"]);
            // One program's roundings may differ from another's; two strategies see the same to the pixel.
            let slack = if program == "povray" { 5.0 } else { 0.0 };
            for count in ["hits", "shadow_rays"] {
                let (found, expected) = (run[count].as_f64().unwrap(), runs["arsc local"][count].as_f64().unwrap());
                assert!((found - expected).abs() <= slack, "{program}, {}: {count} {found}", scene["scene"]);
            }
            assert!(run["lit"].as_u64() > Some(0), "{program}, {}", scene["scene"]);
        }
    }
}

#[test]
fn rays_are_refused_without_a_point_light() {
    let (_folder, script) = common::scene("dark.arsl", "scene { sphere() }\n");
    let run = common::arsc(&["bench", "--rays", &script]);
    assert_eq!(run.status.code(), Some(2));
    assert!(common::stderr(&run).contains("point light"), "{}", common::stderr(&run));
}

/// A ball of radius 1 under a light straight above a camera that looks down: every ray that hits sees the lit side.
#[test]
fn rays_see_the_closed_form() {
    let (folder, script) = common::scene(
        "ball.arsl",
        "import std.spectra { d65 }\nscene { sphere(radius: 1)\n point_light(intensity: d65) |> translate((0, 0, 9)) }\n\
         camera perspective(eye: (0, 0, 5), target: (0, 0, 0), up: (0, 1, 0), fov: 60deg, resolution: (200, 200))\n",
    );
    let sights = folder.path().join("ball.pgm");
    let sights = sights.to_str().unwrap();
    let run = common::arsc(&["bench", "--rays", "--repeat", "1", "--format", "json", "--sights", sights, &script]);
    assert!(run.status.success(), "{}", common::stderr(&run));
    let lines: serde_json::Value = serde_json::from_str(&common::stdout(&run)).unwrap();
    // The ball's disc has tangent 1 / sqrt(24) of the half width tan 30°.
    let radius = 100.0 / 24f64.sqrt() / 30f64.to_radians().tan();
    let disc = std::f64::consts::PI * radius * radius;
    let hits = lines[0]["hits"].as_f64().unwrap();
    assert!((hits / disc - 1.0).abs() < 0.01, "{hits} pixels instead of {disc}");
    assert_eq!(lines[0]["shadow_rays"], lines[0]["hits"]);
    assert_eq!(lines[0]["lit"], lines[0]["hits"]);
    assert_eq!(lines[0]["primary_rays"], 40_000);
    let picture = std::fs::read(sights).unwrap();
    let pixels = &picture[picture.len() - 40_000..];
    assert_eq!(pixels.iter().filter(|&&pixel| pixel == 255).count() as f64, hits);
    assert_eq!((pixels[0], pixels[100 * 200 + 100]), (0, 255));
}
