//! Spectra as scripts write them, and the tables of the standard library against published values.

mod common;

use std::sync::Arc;

use arsc_ir::{Bsdf, Light, NodeKind, Spectrum};
use arsc_spectral::{chromaticity, colour, d65, srgb, xyz_of_radiance, xyz_of_reflectance};
use common::{Session, describe, expect, findings, run};

const IMPORTS: &str =
    "import std.spectra as s\nimport std.metal as m\nimport std.glass as g\nimport std.material as mat\n";

fn ir(text: &str) -> arsc_ir::Ir {
    let text = format!("{IMPORTS}{text}");
    let analysed = run(&text);
    analysed.ir.unwrap_or_else(|| panic!("{text}\n{:#?}", analysed.diagnostics))
}

/// Emissions, in the order in which they are written.
fn emissions(expressions: &[&str]) -> Vec<Spectrum> {
    let lights: String = expressions.iter().map(|e| format!("point_light({e}) ")).collect();
    let spectrum = |node: &arsc_ir::Node| match &node.kind {
        NodeKind::Light(light) => match &**light {
            Light::Point { intensity } => Some(intensity.clone()),
            _ => None,
        },
        _ => None,
    };
    let ir = ir(&format!("scene {{ union({}) }}", lights.trim().replace(") point", "), point")));
    ir.nodes.iter().filter_map(spectrum).collect()
}

fn emission(expression: &str) -> Spectrum {
    emissions(&[expression]).remove(0)
}

fn bsdf(expression: &str) -> Bsdf {
    ir(&format!("scene {{ sphere() |> with({expression}) }}")).bsdfs.remove(0)
}

fn reflectance(expression: &str) -> Spectrum {
    match bsdf(&format!("mat.lambert({expression})")) {
        Bsdf::Lambert { reflectance } => reflectance,
        other => panic!("{other:?}"),
    }
}

fn ior(expression: &str) -> Spectrum {
    match bsdf(&format!("mat.dielectric({expression})")) {
        Bsdf::Dielectric { ior } => ior,
        other => panic!("{other:?}"),
    }
}

/// Chromaticities of the CIE 1931 observer, CIE 15:2018, tables T.3, T.6 to T.8 and 5.1, as rounded there.
const ILLUMINANTS: &[(&str, [f64; 2])] = &[
    ("illuminant_a", [0.44758, 0.40745]),
    ("illuminant_b", [0.34842, 0.35161]),
    ("illuminant_c", [0.31006, 0.31616]),
    ("d50", [0.34567, 0.35851]),
    ("d55", [0.33243, 0.34744]),
    ("d65", [0.31272, 0.32903]),
    ("d75", [0.29903, 0.31488]),
    ("fl1", [0.3131, 0.3371]),
    ("fl2", [0.3721, 0.3751]),
    ("fl3", [0.4091, 0.3941]),
    ("fl4", [0.4402, 0.4031]),
    ("fl5", [0.3138, 0.3452]),
    ("fl6", [0.3779, 0.3882]),
    ("fl7", [0.3129, 0.3292]),
    ("fl8", [0.3458, 0.3586]),
    ("fl9", [0.3741, 0.3727]),
    ("fl10", [0.3458, 0.3588]),
    ("fl11", [0.3805, 0.3769]),
    ("fl12", [0.437, 0.4042]),
    ("fl3_1", [0.4407, 0.4033]),
    ("fl3_2", [0.3808, 0.3734]),
    ("fl3_3", [0.3153, 0.3439]),
    ("fl3_4", [0.4429, 0.4043]),
    ("fl3_5", [0.3749, 0.3672]),
    ("fl3_6", [0.3488, 0.36]),
    ("fl3_7", [0.4384, 0.4045]),
    ("fl3_8", [0.382, 0.3832]),
    ("fl3_9", [0.3499, 0.3591]),
    ("fl3_10", [0.3455, 0.356]),
    ("fl3_11", [0.3245, 0.3434]),
    ("fl3_12", [0.4377, 0.4037]),
    ("fl3_13", [0.383, 0.3724]),
    ("fl3_14", [0.3447, 0.3609]),
    ("fl3_15", [0.3127, 0.3288]),
    ("hp1", [0.533, 0.415]),
    ("hp2", [0.4778, 0.4158]),
    ("hp3", [0.4302, 0.4075]),
    ("hp4", [0.3812, 0.3797]),
    ("hp5", [0.3776, 0.3713]),
    ("led_b1", [0.456, 0.4078]),
    ("led_b2", [0.4357, 0.4012]),
    ("led_b3", [0.3756, 0.3723]),
    ("led_b4", [0.3422, 0.3502]),
    ("led_b5", [0.3118, 0.3236]),
    ("led_bh1", [0.4474, 0.4066]),
    ("led_rgb1", [0.4557, 0.4211]),
    ("led_v1", [0.4548, 0.4044]),
    ("led_v2", [0.3781, 0.3775]),
];

/// Against the published chromaticity as white, at equal luminance; and all are as bright as `equal_energy`.
#[test]
fn illuminants_have_their_published_colours() {
    let names: Vec<String> = ILLUMINANTS.iter().map(|(name, _)| format!("s.{name}")).collect();
    let spectra = emissions(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let unit = xyz_of_radiance(&Spectrum::Constant(1.0))[1];
    let mut off = Vec::new();
    for ((name, [x, y]), spectrum) in ILLUMINANTS.iter().zip(&spectra) {
        let xyz = xyz_of_radiance(spectrum);
        assert!((xyz[1] / unit - 1.0).abs() < 1e-6, "{name}: {}", xyz[1] / unit);
        let white = colour::xyz_from_xyy([*x, *y, xyz[1]]);
        let difference = colour::delta_e_2000(colour::lab_from_xyz(xyz, white), [100.0, 0.0, 0.0]);
        if difference.is_nan() || difference >= 0.1 {
            off.push(format!("{name}: {difference:.3}, {:?}", chromaticity(xyz)));
        }
    }
    assert!(off.is_empty(), "{off:#?}");
}

/// x, y, Y under D50 as published with the averages (BabelColor).
const PATCHES: &[(&str, [f64; 3])] = &[
    ("dark_skin", [0.4325, 0.3788, 0.1034]),
    ("light_skin", [0.4191, 0.3748, 0.3525]),
    ("blue_sky", [0.2761, 0.3004, 0.1847]),
    ("foliage", [0.3700, 0.4501, 0.1335]),
    ("blue_flower", [0.3020, 0.2877, 0.2324]),
    ("bluish_green", [0.2856, 0.3910, 0.4174]),
    ("orange", [0.5291, 0.4075, 0.3117]),
    ("purplish_blue", [0.2339, 0.2155, 0.1140]),
    ("moderate_red", [0.5008, 0.3293, 0.1979]),
    ("purple", [0.3326, 0.2556, 0.0644]),
    ("yellow_green", [0.3989, 0.4998, 0.4435]),
    ("orange_yellow", [0.4962, 0.4428, 0.4358]),
    ("blue", [0.2040, 0.1696, 0.0579]),
    ("green", [0.3270, 0.5033, 0.2307]),
    ("red", [0.5709, 0.3298, 0.1268]),
    ("yellow", [0.4694, 0.4732, 0.6081]),
    ("magenta", [0.4177, 0.2704, 0.2007]),
    ("cyan", [0.2151, 0.3037, 0.1903]),
    ("white", [0.3488, 0.3628, 0.9129]),
    ("neutral_8", [0.3451, 0.3596, 0.5885]),
    ("neutral_6_5", [0.3446, 0.3590, 0.3595]),
    ("neutral_5", [0.3438, 0.3589, 0.1912]),
    ("neutral_3_5", [0.3423, 0.3576, 0.0893]),
    ("black", [0.3439, 0.3565, 0.0320]),
];

/// To 0.1. The reflectances are published to three decimals: half a unit of the last is worth as much again in the two
/// darkest colours.
#[test]
fn patches_of_the_colour_checker_have_their_published_colours() {
    let d50 = emission("s.d50");
    let white = xyz_of_reflectance(&Spectrum::Constant(1.0), &d50);
    let published_white = colour::xyz_from_xyy([0.34570291, 0.35853860, 1.0]);
    let mut off = Vec::new();
    for (name, xyy) in PATCHES {
        let xyz = xyz_of_reflectance(&reflectance(&format!("s.macbeth.{name}")), &d50);
        let published = colour::lab_from_xyz(colour::xyz_from_xyy(*xyy), published_white);
        let lab = |xyz| colour::lab_from_xyz(xyz, white);
        let difference = colour::delta_e_2000(lab(xyz), published);
        let half_unit = colour::delta_e_2000(lab(xyz), lab(std::array::from_fn(|c| xyz[c] + 0.0005 * white[c])));
        let rounding = if matches!(*name, "dark_skin" | "black") { half_unit } else { 0.0 };
        if difference.is_nan() || difference >= 0.1 + rounding {
            off.push(format!("{name}: {difference:.3}"));
        }
    }
    assert!(off.is_empty(), "{off:#?}");
}

/// The uplifted colours of the newer charts come back, and the charts of two sources are alike.
#[test]
fn newer_charts_have_the_colours_that_are_stated() {
    let d50 = emission("s.d50");
    let white = xyz_of_reflectance(&Spectrum::Constant(1.0), &d50);
    let lab = |expression: &str| colour::lab_from_xyz(xyz_of_reflectance(&reflectance(expression), &d50), white);
    for (name, stated) in
        [("red", [42.43, 51.05, 28.62]), ("cyan", [49.57, -29.71, -28.32]), ("white", [95.19, -1.03, 2.93])]
    {
        let new = lab(&format!("s.macbeth_2014.{name}"));
        let difference = colour::delta_e_2000(new, stated);
        assert!(difference < 0.1, "{name}: {difference}, {new:?}");
        assert!(colour::delta_e_2000(lab(&format!("s.macbeth.{name}")), new) < 3.0, "{name}");
        assert!(colour::delta_e_2000(lab(&format!("s.macbeth_ohta.{name}")), new) < 4.0, "{name}");
    }
}

/// Every table of the library: wavelengths increase, values are finite and not negative, and cover what is rendered.
#[test]
fn tables_are_in_order_and_cover_the_visible_range() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../stdlib/data");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "csv") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(
            text.lines().take_while(|line| line.starts_with('#')).count() >= 2,
            "{path:?} does not tell its origin"
        );
        let row = |line: &str| line.split(',').map(|cell| cell.parse::<f64>()).collect::<Result<Vec<f64>, _>>().ok();
        let rows: Vec<Vec<f64>> = text.lines().filter_map(row).collect();
        assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{path:?} is not in order");
        let signed = path.file_stem().is_some_and(|name| name == "daylight");
        assert!(rows.iter().flatten().all(|value| value.is_finite() && (signed || *value >= 0.0)), "{path:?}");
        let (first, last) = (rows[0][0], rows[rows.len() - 1][0]);
        assert!(first <= 400.0 && last >= 700.0, "{path:?} goes from {first} to {last} nm");
        seen += 1;
    }
    assert!(seen > 25, "{seen} tables");
}

/// Against the sources: Johnson and Christy's gold and copper at 589.3 nm (interpolated), diamond, water, sapphire, quartz.
#[test]
fn indices_have_their_published_values() {
    for (metal, eta, k) in [("gold", 0.2734, 2.948), ("copper", 0.6170, 2.808), ("silver", 0.0521, 3.919)] {
        let Bsdf::Conductor { eta: e, k: i } = bsdf(&format!("mat.conductor(m.{metal}.eta, m.{metal}.k)")) else {
            panic!("no conductor")
        };
        let (found_eta, found_k) = (e.eval(589.3), i.eval(589.3));
        assert!((found_eta - eta).abs() < 1e-3 && (found_k - k).abs() < 2e-3, "{metal}: {found_eta} + {found_k}i");
    }
    for (glass, nm, n) in [
        ("bk7", 587.5618, 1.51680),
        ("sf11", 587.5618, 1.78472),
        ("lasf9", 587.5618, 1.85025),
        ("f2", 587.5618, 1.62004),
        ("fused_silica", 589.3, 1.45840),
        ("diamond", 589.3, 2.4173),
        ("water", 589.3, 1.33335),
        ("sapphire_o", 589.3, 1.76810),
        ("sapphire_e", 589.3, 1.76004),
        ("quartz_o", 589.3, 1.54424),
        ("quartz_e", 589.3, 1.55335),
    ] {
        let found = ior(&format!("g.{glass}")).eval(nm);
        assert!((found - n).abs() < 1e-4, "{glass}: {found}");
    }
    for name in ["aluminium", "chromium", "iron", "mercury", "nickel", "platinum", "selenium", "titanium", "tungsten"] {
        assert!(matches!(bsdf(&format!("mat.conductor(m.{name}.eta, m.{name}.k)")), Bsdf::Conductor { .. }), "{name}");
    }
}

#[test]
fn colours_come_back() {
    let chart = |r: [f64; 3], xyz: [f64; 3]| (0..3).all(|c| (r[c] - xyz[c]).abs() < 2e-3);
    let of = |expression: &str, light: &Spectrum| xyz_of_reflectance(&reflectance(expression), light);
    assert!(chart(of("xyz(0.2, 0.3, 0.15)", d65()), [0.2, 0.3, 0.15]));
    assert!(chart(of("xyy(0.4, 0.4, 0.3)", d65()), [0.3, 0.3, 0.15]));
    let a = emission("s.illuminant_a");
    assert!(chart(of("xyy(0.4, 0.4, 0.3, s.illuminant_a)", &a), [0.3, 0.3, 0.15]));
    let lab = colour::lab_from_xyz(of("lab(60, 30, -20)", d65()), xyz_of_reflectance(&Spectrum::Constant(1.0), d65()));
    assert!(colour::delta_e_2000(lab, [60.0, 30.0, -20.0]) < 0.1, "{lab:?}");

    let white = xyz_of_radiance(d65());
    let relative = |e: &str| xyz_of_radiance(&emission(e)).map(|c| c / white[1]);
    assert!(chart(relative("rgb_emission(1, 1, 1)"), [white[0] / white[1], 1.0, white[2] / white[1]]));
    let red = (srgb::xyz_from_rgb() * glam::DVec3::new(3.0, 0.1, 0.0)).to_array();
    assert!((0..3).all(|c| (relative("rgb_emission(3, 0.1, 0)")[c] - red[c]).abs() < 0.02), "{red:?}");
    let lamp = relative("xyy_emission(0.55, 0.41, 2)");
    assert!((lamp[1] - 2.0).abs() < 0.01 && (chromaticity(lamp)[0] - 0.55).abs() < 2e-3, "{lamp:?}");
    assert_eq!(emission("xyz_emission(0, 0, 0)"), Spectrum::Constant(0.0));
}

#[test]
fn sources_have_their_colour_and_the_brightness_of_equal_energy() {
    let unit = xyz_of_radiance(&Spectrum::Constant(1.0))[1];
    for (expression, x, y) in [
        ("daylight(6504K)", 0.31272, 0.32903),
        ("incandescent(2856K)", 0.44758, 0.40745),
        ("daylight(10000K)", 0.27866, 0.29163),
    ] {
        let xyz = xyz_of_radiance(&emission(expression));
        let [found_x, found_y] = chromaticity(xyz);
        assert!((xyz[1] / unit - 1.0).abs() < 1e-6, "{expression}");
        assert!((found_x - x).abs() < 3e-4 && (found_y - y).abs() < 3e-4, "{expression}: {found_x} {found_y}");
    }
}

#[test]
fn regular_samples_are_irregular_ones() {
    assert_eq!(
        reflectance("reflectance(regular(400nm, 10nm, [0.1, 0.4, 0.2]))"),
        reflectance("reflectance([(400nm, 0.1), (410nm, 0.4), (420nm, 0.2)])")
    );
}

#[test]
fn filters_colour_light() {
    let filtered = emission("transmission([(500nm, 0.5)]) * constant_emission(4)");
    assert_eq!(filtered.eval(620.0), 2.0);
    assert_eq!(emission("constant_emission(4) * (constant_transmission(0.5) * 0.5)").eval(620.0), 1.0);
}

/// Files next to the script; the assets of these tests are those of the library.
#[test]
fn files_are_read_by_their_form() {
    assert_eq!(emission("tabulated_emission(\"data/d65.csv\")").eval(560.0), d65().eval(560.0));
}

#[test]
fn each_kind_is_a_type_of_its_own() {
    for (expression, wanted) in [
        ("mat.lambert(s.d65)", "`reflectance` of `lambert` needs a `reflectance`, but this is an `emission`"),
        ("mat.lambert(constant_transmission(0.5))", "needs a `reflectance`, but this is a `transmission`"),
        ("mat.conductor(m.gold.k, m.gold.k)", "needs a `refractive_index`, but this is an `extinction`"),
        ("mat.conductor(m.gold.eta, coefficient([(500nm, 1)]))", "needs an `extinction`, but this is a `coefficient`"),
        ("emitter(macbeth_red())", "needs an `emission`, but this is a `reflectance`"),
    ] {
        let text = format!(
            "{IMPORTS}fn macbeth_red() -> reflectance {{ s.macbeth.red }}\nscene {{ sphere() |> with({expression}) }}"
        );
        let found = findings(&text);
        assert!(
            found.iter().any(|line| line.starts_with("E0102") && line.contains(wanted)),
            "{expression}: {found:#?}"
        );
    }
    let mut session = Session::default();
    let text = "import std.material { lambert }\nimport std.spectra { d65 }\nscene { sphere() |> with(lambert(d65)) }";
    let analysed = session.analyse(text, &[], arsc_sema::Options::default());
    let help = analysed.diagnostics[0].help.clone().unwrap_or_default();
    assert!(
        help.contains("`emission` is light per nanometre"),
        "{help} {:?}",
        describe(&session.sources, &analysed.diagnostics)
    );
}

#[test]
fn bad_spectra_are_refused_where_they_stand() {
    let lambert = |e: &str| format!("import std.material {{ lambert }}\nscene {{ sphere() |> with(lambert({e})) }}");
    let light = |e: &str| format!("scene {{ point_light({e}) }}");
    expect(&lambert("xyy(0.17, 0.02, 0.5)"), &[("E0201", "xyy(0.17, 0.02, 0.5)")]);
    expect(&lambert("xyy(0.7, 0.4, 0.5)"), &[("E0201", "0.4")]);
    expect(&lambert("reflectance([(500nm, -0.1)])"), &[("E0201", "[(500nm, -0.1)]")]);
    expect(&lambert("reflectance([(500nm, 0.1), (500nm, 0.2)])"), &[("E0211", "[(500nm, 0.1), (500nm, 0.2)]")]);
    expect(&light("daylight(3000K)"), &[("E0201", "3000K")]);
    expect(&light("xyy_emission(0.1, 0.0, 1)"), &[("E0201", "0.0")]);
    expect(
        "import std.material { dielectric }\nscene { sphere() |> with(dielectric(sellmeier(b: [1.0], c: [0.1, 0.2]))) }",
        &[("E0201", "[0.1, 0.2]")],
    );
    expect(
        "scene { sphere() |> with(emitter(constant_emission(1))) }\nactions { path_trace(wavelengths: (500nm, 400nm)); write_exr(\"a.exr\") }",
        &[("E0201", "(500nm, 400nm)")],
    );
    expect(
        "scene { sphere() |> with(emitter(constant_emission(1))) }\nactions { path_trace(wavelengths: (100nm, 400nm)); write_exr(\"a.exr\") }",
        &[("E0201", "(100nm, 400nm)")],
    );
}

#[test]
fn the_range_and_the_observer_reach_the_action() {
    let ir = ir("scene { sphere() |> with(emitter(constant_emission(1))) }\n\
                 actions { path_trace(wavelengths: (300nm, 830nm), band_width: 5nm, observer: cie2015_2); write_exr(\"a.exr\") }");
    let arsc_ir::Action::PathTrace(trace) = &ir.actions[0].action else { panic!("{:?}", ir.actions) };
    assert_eq!((trace.wavelengths.min_nm(), trace.wavelengths.max_nm(), trace.band_nm), (300.0, 830.0, 5.0));
    assert_eq!(trace.observer, arsc_ir::Observer::Cie2015Deg2);
}

#[test]
fn coefficients_follow_from_transmissions() {
    let half: Arc<Spectrum> = Arc::new(Spectrum::Constant(0.5));
    let spectrum = Spectrum::Absorbance { transmission: half, thickness: 2.0 };
    assert!((spectrum.eval(500.0) - 0.5 * std::f64::consts::LN_2).abs() < 1e-15);
}
