//! The commands about pictures from outside: what they write, what they say, what they refuse.

mod common;

use std::path::{Path, PathBuf};

use arsc_image::{Channel, Picture, SpectralImage, encode_exr};
use common::{arsc, stderr, stdout};

/// A polarised picture with a ramp of grey over which the upper half is polarised horizontally.
fn picture(gain: f32) -> SpectralImage {
    let (width, height, bands) = (24, 16, 10);
    let level = |pixel: usize| gain * 0.05 * (1 + pixel % width) as f32;
    let band = |i: usize| level(i / bands);
    let is_upper = |i: usize| i / bands / width < height / 2;
    let stokes = |i: usize| if is_upper(i) { [band(i), 0.0, 0.0] } else { [0.0; 3] };
    let mut image = SpectralImage {
        width,
        height,
        band_edges_nm: (0..=bands).map(|i| 380.0 + 35.0 * i as f64).collect(),
        radiance: (0..width * height * bands).map(band).collect(),
        stokes: Some((0..width * height * bands).map(stokes).collect()),
        xyz: vec![],
        channels: vec![Channel { name: "depth.Z".into(), samples: vec![2.0; width * height] }],
        metadata: vec![("samples".into(), "8".into())],
    };
    image.xyz = arsc_image::xyz_of_bands(&image.radiance, &image.band_edges_nm, Default::default());
    image
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Folder {
        let folder = Folder(tempfile::tempdir().expect("a folder"));
        folder.put("a.exr", &encode_exr(&picture(1.0)).expect("encoded"));
        folder.put("b.exr", &encode_exr(&picture(1.1)).expect("encoded"));
        folder
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.path(name), bytes).expect("written");
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn open(&self, name: &str) -> Picture {
        Picture::decode(&std::fs::read(self.path(name)).expect("there")).expect("a picture")
    }

    /// Runs with every argument that names a file of the folder made a path; gives status and all output.
    fn run(&self, line: &str) -> (i32, String) {
        let is_file = |word: &str| {
            Path::new(word)
                .extension()
                .is_some_and(|e| e.to_str().is_some_and(|e| e.len() >= 3 && e.starts_with(char::is_alphabetic)))
        };
        let words: Vec<String> = line
            .split_whitespace()
            .map(|word| if is_file(word) { self.path(word).display().to_string() } else { word.to_owned() })
            .collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let run = arsc(&words);
        (run.status.code().expect("not killed"), stdout(&run) + &stderr(&run))
    }

    fn expect(&self, line: &str, status: i32, words: &[&str]) -> String {
        let (found, text) = self.run(line);
        assert_eq!(found, status, "{line}: {text}");
        for word in words {
            assert!(text.contains(word), "{line}: `{word}` is not in {text}");
        }
        text
    }
}

#[test]
fn tonemap_writes_every_kind_of_display_picture() {
    let folder = Folder::new();
    for line in [
        "tonemap a.exr -o out.png",
        "tonemap a.exr -o out.png --bits 16 --space display_p3 --curve agx",
        "tonemap a.exr -o out.tif --bits 16 --space rec2020 --curve aces --key 0.25",
        "tonemap a.exr -o out.tiff --curve calibrated --contrast 80 --aperture -0.5 --white-lightness",
        "tonemap a.exr -o out.exr --curve exponential --target 0.4 --white 3200K --adaptation cat16 --gamut lab",
        "tonemap a.exr -o out.png --slice 550nm --percentile 100",
        "tonemap a.exr -o out.png --space adobe_rgb --ev -1 --white D50",
    ] {
        folder.expect(line, 0, &["wrote"]);
        let name = line.split_whitespace().nth(3).expect("a name");
        assert_eq!((folder.open(name).width(), folder.open(name).height()), (24, 16), "{line}");
    }
}

/// Crossed with the light of the upper half, the filter leaves the lower half alone.
#[test]
fn a_polariser_darkens_what_is_polarised() {
    let folder = Folder::new();
    folder.expect("tonemap a.exr -o p.exr --polariser 90deg --scale 0.5 --curve linear", 0, &[]);
    let picture = folder.open("p.exr");
    assert!(picture.xyz()[12][1].abs() < 1e-3 && picture.xyz()[15 * 24 + 12][1] > 1.0);
}

#[test]
fn diff_measures_draws_and_fails_above_a_threshold() {
    let folder = Folder::new();
    folder.expect("diff a.exr a.exr --fail-above 0", 0, &["ciede2000: mean 0.000000", "PSNR inf dB"]);
    folder.expect("diff a.exr b.exr --fail-above 0.001", 1, &["ciede2000"]);
    folder.expect("diff a.exr b.exr --metric flip --fail-above 0.9 -o d.png", 0, &["flip: mean", "wrote"]);
    assert!(folder.open("d.png").width() > 24, "with a scale bar");
    folder.expect("diff a.exr b.exr --metric plus_minus --wavelength 550nm -o d.tif --no-scale", 0, &["SNR 20.00 dB"]);
    assert_eq!(folder.open("d.tif").width(), 24);
    let (status, text) = folder.run("diff a.exr b.exr --format json --metric cie76");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert!(status == 0 && json["metric"] == "cie76" && json["mean"].as_f64() > Some(0.5), "{json}");
}

#[test]
fn polvis_shows_every_quantity() {
    let folder = Folder::new();
    for quantity in ["degree", "linear", "circular", "type", "orientation", "chirality", "s1", "s2", "s3"] {
        folder.expect(&format!("polvis a.exr -o v.png -q {quantity} --wavelength 500nm --max 0.5"), 0, &["wrote"]);
        assert!(folder.open("v.png").width() > 24, "{quantity} has a legend");
    }
    folder.expect("polvis a.exr -o v.png --overlay picture --no-legend", 0, &[]);
    assert_eq!(folder.open("v.png").width(), 24);
}

#[test]
fn image_cuts_adds_merges_and_converts() {
    let folder = Folder::new();
    folder.expect("image info a.exr", 0, &["24 x 16 pixels", "10 bands, 380 nm to 730 nm", "polarised", "depth.Z"]);
    let text = folder.expect("image pixel a.exr 3,2 --plot p.svg", 0, &["pixel 3,2", "depth.Z: 2", "397.5"]);
    assert!(text.contains("wrote"));
    folder.expect("image pixel a.exr 3,2 --plot p.png", 0, &[]);
    assert_eq!(folder.open("p.png").width(), 720);
    folder.expect("image crop a.exr 4,2,10,5 -o c.exr", 0, &[]);
    assert_eq!((folder.open("c.exr").width(), folder.open("c.exr").height()), (6, 3));
    folder.expect("image downscale a.exr 4 -o s.exr", 0, &[]);
    assert_eq!(folder.open("s.exr").width(), 6);
    folder.expect("image add a.exr b.exr -o sum.exr", 0, &[]);
    folder.expect("image merge a.exr b.exr a.exr -o m.exr", 0, &[]);
    assert_eq!(folder.open("m.exr").noted("samples"), Some("24"));
    folder.expect("image convert a.exr --multiply 2.1 -o twice.exr", 0, &[]);
    folder.expect("diff sum.exr twice.exr --fail-above 0.001", 0, &[]);
    folder.expect("image convert a.exr -o a.csv", 0, &[]);
    folder.expect("image convert a.csv -o back.exr", 0, &[]);
    folder.expect("diff a.exr back.exr --fail-above 0.001 --statistic greatest", 0, &[]);
    folder.expect("tonemap a.exr -o t.png", 0, &[]);
    folder.expect("image convert t.png -o t.tif --bits 16", 0, &[]);
    folder.expect("diff t.png t.tif --fail-above 0.01 --statistic greatest", 0, &[]);
}

#[test]
fn slips_and_bad_files_are_refused_and_leave_nothing() {
    let folder = Folder::new();
    let whole = encode_exr(&picture(1.0)).expect("encoded");
    folder.put("cut.exr", &whole[..whole.len() / 2]);
    folder.put("text.exr", b"scene { sphere() }");
    folder.put("empty.png", b"");
    let mut plain = picture(1.0);
    plain.stokes = None;
    folder.put("plain.exr", &encode_exr(&plain).expect("encoded"));
    folder.expect("tonemap a.exr -o small.png", 0, &[]);
    for (line, words) in [
        ("tonemap cut.exr -o out.png", &["cut.exr", "because"][..]),
        ("tonemap text.exr -o out.png", &["text.exr", "not a picture of a kind that is read"]),
        ("tonemap empty.png -o out.png", &["not a picture"]),
        ("tonemap missing.exr -o out.png", &["missing.exr"]),
        ("tonemap a.exr -o out.jpg", &[".jpg"]),
        ("tonemap a.exr -o missing/out.png", &["cannot write"]),
        ("tonemap a.exr -o out.png --curve linear --target 0.5", &["--target goes with"]),
        ("tonemap a.exr -o out.png --white D66", &["D66", "FL12"]),
        ("tonemap a.exr -o out.png --ev 1 --key 0.2", &["cannot be used"]),
        ("tonemap a.exr -o out.png --slice 200nm", &["200 nm lies outside", "380 nm"]),
        ("tonemap small.png -o out.png --slice 500nm", &["no spectrum"]),
        ("polvis plain.exr -o out.png", &["not polarised"]),
        ("diff a.exr small.png --metric plus_minus --wavelength 500nm", &["no spectrum"]),
        ("diff a.exr b.exr --wavelength 500nm", &["plus_minus"]),
        ("image crop a.exr 0,0,99,1 -o out.exr", &["does not lie in the picture"]),
        ("image pixel a.exr 24,0", &["does not lie in the picture"]),
        ("image add a.exr plain.exr -o out.exr", &["bands"]),
        ("image convert small.png -o out.csv", &["no spectrum"]),
        ("denoise a.exr -o out.exr --library text.exr", &["cannot load"]),
    ] {
        folder.expect(line, 2, words);
        for name in ["out.png", "out.exr", "out.csv", "out.jpg"] {
            assert!(!folder.path(name).exists(), "{line} left {name}");
        }
    }
}

const SCRIPT: &str = "
import std.action { add, crop, downscale, key, linear_polariser, merge, multiply }
import std.material { dielectric }
scene {
    sphere() |> with(dielectric(1.5))
    environment(constant_emission(1))
}
camera perspective(eye: (0, -4, 2), target: (0, 0, 0), fov: 40deg, resolution: (16, 12))
actions {
    path_trace(samples: 2, polarised: true)
    over()
    path_trace(samples: 2, polarised: true, seed: 1)
    swap()
    drop()
    merge()
    write_csv(\"bands.csv\")
    dup()
    visualise_polarisation(quantity: \"orientation\", most: 0.5, overlay: \"picture\")
    write_tiff(\"orientation.tif\", sixteen_bit: true)
    drop()
    crop(2, 2, 14, 12)
    downscale()
    multiply(2)
    dup()
    add()
    linear_polariser(30deg, strength: 0.5)
    write_exr(\"small.exr\")
    tone_map(exposure: key(0.3), curve: \"agx\", white: \"D50\", space: \"display_p3\", slice: 550nm)
    write_png(\"small.png\", sixteen_bit: true)
}";

#[test]
fn actions_do_what_the_commands_do() {
    let folder = Folder::new();
    folder.put("scene.arsl", SCRIPT.as_bytes());
    let (script, out) = (folder.path("scene.arsl").display().to_string(), folder.0.path().display().to_string());
    let run = arsc(&["render", &script, "-o", &out, "--quiet"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    assert_eq!((folder.open("small.exr").width(), folder.open("small.exr").height()), (6, 5));
    assert_eq!(folder.open("small.exr").noted("samples"), Some("4"));
    assert!(folder.open("orientation.tif").width() > 16 && folder.open("bands.csv").width() == 16);
    assert_eq!(folder.open("small.png").width(), 6);
    let compare = "path_trace(samples: 1); difference_to(\"REFERENCE\", metric: \"flip\"); write_png(\"d.png\")";
    for (reference, status, words) in [
        ("small.exr", 2, "differ in size"),
        ("bands.csv", 0, "difference to bands.csv: flip mean"),
        ("missing.exr", 2, "missing.exr"),
        ("../outside.exr", 2, "outside.exr"),
    ] {
        let actions = format!("actions {{ {} }}", compare.replace("REFERENCE", reference));
        let text = format!("{}{actions}", SCRIPT.split("actions {").next().expect("a scene"));
        folder.put("compare.arsl", text.as_bytes());
        let script = folder.path("compare.arsl").display().to_string();
        let run = arsc(&["render", &script, "-o", &out, "--quiet"]);
        assert_eq!(run.status.code(), Some(status), "{reference}: {}", stderr(&run));
        assert!(stderr(&run).contains(words), "{reference}: {}", stderr(&run));
    }
}

#[test]
fn wrong_words_in_actions_are_findings() {
    let folder = Folder::new();
    for (action, words) in [
        ("tone_map(curve: \"agxx\")", "\"agxx\" is none of"),
        ("tone_map(white: \"D66\")", "no white point is called"),
        ("tone_map(target: 0.5)", "exponential"),
        ("visualise_polarisation(quantity: \"dop\")", "none of \"degree\""),
        ("difference_to(\"a.exr\", wavelength: 500nm)", "plus_minus"),
        ("merge()", "needs two spectral images"),
        ("crop(3, 0, 3, 1)", "is empty"),
        ("write_tiff(\"a.png\")", "must end in `.tif`"),
    ] {
        let text = format!(
            "import std.action {{ crop, merge }}\nscene {{ sphere() }}\nactions {{ path_trace(); {action}; write_png(\"b.png\") }}"
        );
        folder.put("wrong.arsl", text.as_bytes());
        let run = arsc(&["check", &folder.path("wrong.arsl").display().to_string()]);
        let said = stdout(&run) + &stderr(&run);
        // Findings are wrapped to the width of the page.
        let flat: String = said.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert!(run.status.code() == Some(1) && flat.contains(words), "{action}: {said}");
    }
}
