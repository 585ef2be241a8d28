//! Actions on pictures: tone mapping, filters, sums, comparisons, files. The stack effect of each stands in
//! [`crate::actions`].

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Action, Exposure, ImageAction, ToneMap};
use arsc_spectral::adaptation::Adaptation;
use arsc_spectral::colour_space::ColourSpace;
use arsc_spectral::illuminant::white_point;
use arsc_spectral::pictures::{Metric, Overlay, Quantity, Question, View};
use arsc_spectral::tone::{Calibration, Curve, Gamut};

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Type::{self, Angle, Bool, Float, Int, Str, Wavelength};
use crate::value::Value;

/// Where the words live that would be in the way of other names.
const MODULE: &str = "std.action";

pub fn builtins() -> Vec<Builtin> {
    let mut list = exposures();
    list.push(tone_map_builtin());
    list.extend(filters());
    list.extend(views());
    list.extend(files());
    list
}

fn exposures() -> Vec<Builtin> {
    let exposure = |name, doc| Builtin::new(name, doc);
    vec![
        exposure("ev", "Exposure in stops: radiances are multiplied by 2^stops.")
            .param(Param::new("stops", Float, "may be negative"))
            .runs(Type::Exposure, |_, a, _| Ok(Value::Exposure(Exposure::Ev(a[0].as_float())))),
        exposure("key", "Exposure that brings the log-average luminance to a level.")
            .param(Param::new("luminance", Float, "of the display's white").float(0.18).positive())
            .module(MODULE)
            .runs(Type::Exposure, |_, a, _| Ok(Value::Exposure(Exposure::Key(a[0].as_float())))),
        exposure("percentile", "Exposure that makes a percentile of the luminances the display's white.")
            .param(Param::new("percent", Float, "100 for the brightest pixel").float(99.0).within(1e-6, 100.0))
            .module(MODULE)
            .runs(Type::Exposure, |_, a, _| Ok(Value::Exposure(Exposure::Percentile(a[0].as_float())))),
    ]
}

fn word(name: &'static str, default: &'static str, doc: &'static str) -> Param {
    Param::new(name, Str, doc).default_value(format!("\"{default}\""), Value::Str(default.into()))
}

fn tone_map_builtin() -> Builtin {
    Builtin::new("tone_map", "Maps radiance to what a display shows. Stack: image<spectral> → image<display>.")
        .param(
            Param::new("exposure", Type::Exposure, "`auto`, `ev(stops)`, `key(…)` or `percentile(…)`")
                .default_value("auto", Value::Exposure(Exposure::Auto)),
        )
        .param(word("curve", "shoulder", "shoulder, linear, exponential, calibrated, aces or agx"))
        .param(
            Param::new("target", Float, "of `exponential`: what the log-average becomes")
                .within(1e-6, 0.999)
                .optional(),
        )
        .param(Param::new("aperture", Float, "of `calibrated`: stops by which the average is moved").float(0.0))
        .param(Param::new("contrast", Float, "of `calibrated`, percent").float(100.0).positive())
        .param(Param::new("white", Str, "light that looks white: \"D50\", \"3200K\" or \"x,y\"").optional())
        .param(word("adaptation", "bradford", "to that white: bradford or cat16"))
        .param(
            Param::new("white_lightness", Float, "L* from which on colours are white; 150 as in ART")
                .within(100.0, 1e6)
                .optional(),
        )
        .param(word("gamut", "desaturate", "of colours that the display cannot mix: desaturate, lab or clip"))
        .param(word("space", "srgb", "srgb, display_p3, rec2020 or adobe_rgb"))
        .param(Param::new("slice", Wavelength, "one wavelength in grey instead of the colours").positive().optional())
        .runs(Type::Action, tone_map)
}

fn tone_map(_: &mut Machine<'_>, a: &[Value], site: &Site) -> Eval {
    let target = given(&a[2]);
    let curve = match choice(&a[1], 1, &Curve::NAMES, |name| name, site)? {
        "linear" => Curve::Linear,
        "exponential" => Curve::Exponential { target },
        "calibrated" => {
            Curve::Calibrated(Calibration { aperture: a[3].as_float(), contrast: a[4].as_float(), line: None })
        }
        "aces" => Curve::Aces,
        "agx" => Curve::Agx,
        _ => Curve::Shoulder,
    };
    if target.is_some() && !matches!(curve, Curve::Exponential { .. }) {
        let message = "`target` goes with the curve \"exponential\"";
        return Err(site.fail_arg(2, codes::OUT_OF_RANGE, message, "this target"));
    }
    let white = match &a[5] {
        Value::Missing => None,
        name => {
            Some(white_point(name.as_str()).map_err(|text| site.fail_arg(5, codes::OUT_OF_RANGE, text, "this white"))?)
        }
    };
    let tone = ToneMap {
        exposure: a[0].as_exposure(),
        white,
        adaptation: choice(&a[6], 6, &Adaptation::ALL, Adaptation::name, site)?,
        curve,
        white_lightness: given(&a[7]),
        gamut: choice(&a[8], 8, &Gamut::ALL, Gamut::name, site)?,
        space: choice(&a[9], 9, &ColourSpace::ALL, ColourSpace::name, site)?,
    };
    Ok(Value::action(Action::ToneMap { tone, slice_nm: given(&a[10]) }, site.span))
}

fn given(value: &Value) -> Option<f64> {
    if value.is_given() { Some(value.as_float()) } else { None }
}

/// The value that a text names.
fn choice<T: Copy>(value: &Value, arg: usize, all: &[T], name: fn(T) -> &'static str, site: &Site) -> Eval<T> {
    let text = value.as_str();
    all.iter().copied().find(|value| name(*value) == &**text).ok_or_else(|| {
        let names: Vec<String> = all.iter().map(|value| format!("\"{}\"", name(*value))).collect();
        let message = format!("\"{text}\" is none of {}", names.join(", "));
        site.fail_arg(arg, codes::OUT_OF_RANGE, message, "this name")
    })
}

fn image(action: ImageAction, site: &Site) -> Eval {
    Ok(Value::action(Action::Image(action), site.span))
}

fn filters() -> Vec<Builtin> {
    let pixel = |name, doc| Param::new(name, Int, doc).within(0.0, 65_536.0);
    vec![
        Builtin::new(
            "linear_polariser",
            "Puts a linear polariser before a picture. Stack: image<spectral> → image<spectral>.",
        )
        .param(Param::new("angle", Angle, "of its transmission axis, from the horizontal"))
        .param(Param::new("strength", Float, "0 for no filter, 1 for an ideal one").float(1.0).within(0.0, 1.0))
        .module(MODULE)
        .runs(Type::Action, |_, a, site| {
            image(ImageAction::LinearPolariser { angle: a[0].as_float(), strength: a[1].as_float() }, site)
        }),
        Builtin::new("multiply", "Multiplies radiances. Stack: image<spectral> → image<spectral>.")
            .param(Param::new("factor", Float, "of every radiance").positive())
            .module(MODULE)
            .runs(Type::Action, |_, a, site| image(ImageAction::Multiply { factor: a[0].as_float() }, site)),
        Builtin::new("crop", "Cuts out a rectangle. Stack: image<spectral> → image<spectral>.")
            .param(pixel("x0", "first column"))
            .param(pixel("y0", "first row, from the top"))
            .param(pixel("x1", "column behind the last"))
            .param(pixel("y1", "row behind the last"))
            .module(MODULE)
            .runs(Type::Action, crop),
        Builtin::new("downscale", "Averages squares of pixels. Stack: image<spectral> → image<spectral>.")
            .param(Param::new("factor", Int, "side of the squares").int(2).within(1.0, 65_536.0))
            .module(MODULE)
            .runs(Type::Action, |_, a, site| image(ImageAction::Downscale { factor: a[0].as_int() as u32 }, site)),
        Builtin::new(
            "add",
            "Adds the light of two pictures. Stack: image<spectral> image<spectral> → image<spectral>.",
        )
        .module(MODULE)
        .runs(Type::Action, |_, _, site| image(ImageAction::Add, site)),
        Builtin::new(
            "merge",
            "Averages two renders by their samples. Stack: image<spectral> image<spectral> → image<spectral>.",
        )
        .module(MODULE)
        .runs(Type::Action, |_, _, site| image(ImageAction::Merge, site)),
        Builtin::new(
            "denoise",
            "Takes the noise out, by Intel Open Image Denoise where it is installed. Stack: image<spectral> → image<spectral>.",
        )
        .runs(Type::Action, |_, _, site| image(ImageAction::Denoise, site)),
    ]
}

fn crop(_: &mut Machine<'_>, a: &[Value], site: &Site) -> Eval {
    let rectangle: [u32; 4] = std::array::from_fn(|i| a[i].as_int() as u32);
    let [x0, y0, x1, y1] = rectangle;
    if x0 >= x1 || y0 >= y1 {
        let message = format!("the crop from {x0},{y0} to {x1},{y1} is empty");
        return Err(site.fail_arg(2, codes::OUT_OF_RANGE, message, "must be greater than the first"));
    }
    image(ImageAction::Crop { rectangle }, site)
}

fn views() -> Vec<Builtin> {
    vec![
        Builtin::new(
            "visualise_polarisation",
            "Shows polarisation in false colours. Stack: image<spectral> → image<display>.",
        )
        .param(word(
            "quantity",
            "degree",
            "degree, linear, circular, type, orientation, chirality, s1, s2 or s3",
        ))
        .param(Param::new("wavelength", Wavelength, "at this one instead of all").positive().optional())
        .param(Param::new("most", Float, "the value with the full colour").float(1.0).positive())
        .param(word("overlay", "none", "none, luminance or picture"))
        .param(Param::new("legend", Bool, "beside the picture").bool(true))
        .runs(Type::Action, |_, a, site| {
            let view = View {
                quantity: choice(&a[0], 0, &Quantity::ALL, Quantity::name, site)?,
                wavelength_nm: given(&a[1]),
                most: a[2].as_float(),
                overlay: choice(&a[3], 3, &Overlay::ALL, Overlay::name, site)?,
                legend: a[4].as_bool(),
            };
            image(ImageAction::VisualisePolarisation(view), site)
        }),
        Builtin::new(
            "difference_to",
            "Shows the difference to a reference in false colours, and prints it. Stack: image<spectral> → image<display>.",
        )
        .param(Param::new("path", Str, "the reference, a file below the script's folder"))
        .param(word("metric", "ciede2000", "ciede2000, cie76, lightness, chroma, hue, flip or plus_minus"))
        .param(Param::new("wavelength", Wavelength, "of `plus_minus`: radiances instead of luminances").positive().optional())
        .param(Param::new("exposure", Type::Exposure, "of both pictures").optional())
        .param(Param::new("most", Float, "the difference with the last colour of the scale").positive().optional())
        .runs(Type::Action, difference_to),
    ]
}

fn difference_to(_: &mut Machine<'_>, a: &[Value], site: &Site) -> Eval {
    let metric = choice(&a[1], 1, &Metric::ALL, Metric::name, site)?;
    if a[2].is_given() && metric != Metric::PlusMinus {
        let message = "a wavelength goes with the metric \"plus_minus\"";
        return Err(site.fail_arg(2, codes::OUT_OF_RANGE, message, "this wavelength"));
    }
    let exposure = a[3].is_given().then(|| a[3].as_exposure());
    let question = Question { metric, wavelength_nm: given(&a[2]), exposure };
    let action = ImageAction::DifferenceTo { path: a[0].as_str().to_string(), question, most: given(&a[4]) };
    image(action, site)
}

fn files() -> Vec<Builtin> {
    let path = |doc| Param::new("path", Str, doc);
    let deep = || Param::new("sixteen_bit", Bool, "16 bits for each component instead of 8").bool(false);
    vec![
        Builtin::new("write_exr", "Writes a spectral EXR file. Stack: image<spectral> → image<spectral>.")
            .param(path("file name within the output directory, ending in `.exr`"))
            .runs(Type::Action, |_, a, site| {
                let path = picture_name(&a[0], &[".exr"], site)?;
                Ok(Value::action(Action::WriteExr { path }, site.span))
            }),
        Builtin::new("write_csv", "Writes the bands as text. Stack: image<spectral> → image<spectral>.")
            .param(path("file name within the output directory, ending in `.csv`"))
            .runs(Type::Action, |_, a, site| {
                let path = picture_name(&a[0], &[".csv"], site)?;
                Ok(Value::action(Action::WriteCsv { path }, site.span))
            }),
        Builtin::new("write_png", "Writes a PNG file. Stack: image<display> → image<display>.")
            .param(path("file name within the output directory, ending in `.png`"))
            .param(deep())
            .runs(Type::Action, |_, a, site| {
                let path = picture_name(&a[0], &[".png"], site)?;
                Ok(Value::action(Action::WritePng { path, sixteen_bit: a[1].as_bool() }, site.span))
            }),
        Builtin::new("write_tiff", "Writes a TIFF file. Stack: image<display> → image<display>.")
            .param(path("file name within the output directory, ending in `.tif` or `.tiff`"))
            .param(deep())
            .runs(Type::Action, |_, a, site| {
                let path = picture_name(&a[0], &[".tif", ".tiff"], site)?;
                Ok(Value::action(Action::WriteTiff { path, sixteen_bit: a[1].as_bool() }, site.span))
            }),
    ]
}

/// The name of a picture: it says what kind of file it is, and does not lead out of the output folder.
fn picture_name(value: &Value, endings: &[&str], site: &Site) -> Eval<String> {
    let path = value.as_str();
    let fits = |ending: &&str| path.to_ascii_lowercase().ends_with(ending) && path.len() > ending.len();
    let message = if path.starts_with('/') || path.split('/').any(|part| part == "..") {
        "a picture's name must not lead out of the output folder".to_owned()
    } else if !endings.iter().any(fits) {
        format!("the picture's name must end in `{}`", endings[0])
    } else {
        return Ok(path.to_string());
    };
    Err(site.fail_arg(0, codes::OUT_OF_RANGE, message, "this name"))
}
