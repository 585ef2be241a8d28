//! Actions: what is done with the scene. The stack effect of each stands in [`crate::actions`].

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Action, Observer, PathTrace, Sampler, Sampling, WavelengthRange};
use arsc_spectral::{TABLE_MAX_NM, TABLE_MIN_NM};

use super::{Builtin, Param, image_actions};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Type::{self, Bool, Float, Int};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let mut list = scene_actions();
    list.extend(image_actions::builtins());
    list.extend(words());
    list
}

fn scene_actions() -> Vec<Builtin> {
    vec![
        Builtin::new("path_trace", "Renders by path tracing. Stack: scene → scene image<spectral>.")
            .param(samples(128))
            .param(Param::new("max_depth", Int, "longest path, in scattering events").int(16).within(1.0, 65_536.0))
            .param(seed())
            .param(Param::new("polarised", Bool, "trace Stokes vectors and write S0 to S3").bool(false))
            .param(
                Param::new("wavelengths", Type::tuple([Type::Wavelength, Type::Wavelength]), "first and last sampled")
                    .default_value("(360nm, 830nm)", Value::Tuple([Value::Float(360.0), Value::Float(830.0)].into()))
                    .within(TABLE_MIN_NM, TABLE_MAX_NM),
            )
            .param(
                Param::new("band_width", Type::Wavelength, "of the picture's bands")
                    .default_value("10nm", Value::Float(10.0))
                    .within(1.0, TABLE_MAX_NM),
            )
            .param(
                Param::new("observer", Type::Observer, "whose X, Y and Z the picture holds")
                    .default_value("cie1931", Value::Observer(Observer::Cie1931)),
            )
            .param(sampler())
            .param(noise())
            .param(time_limit())
            .param(Param::new("features", Bool, "write what is seen first beside the picture, as `render_features` does").bool(false))
            .runs(Type::Action, path_trace),
        Builtin::new("ambient_occlusion", "Renders how open the space above surfaces is: the share of directions, weighted by the cosine, in which nothing lies within a distance. Stack: scene → scene image<spectral>.")
            .param(samples(64))
            .param(Param::new("distance", Float, "without it, any").positive().optional())
            .param(seed())
            .param(sampler())
            .param(noise())
            .param(time_limit())
            .runs(Type::Action, |_, a, site| {
                let distance = if a[1].is_given() { a[1].as_float() } else { f64::INFINITY };
                let sampling = sampling(&a[0], &a[2], &a[3], &a[4], &a[5]);
                Ok(Value::action(Action::AmbientOcclusion { distance, sampling }, site.span))
            }),
        Builtin::new("preview", "Renders surfaces in their colours, lit from the camera: a quick look. Stack: scene → scene image<spectral>.")
            .param(samples(4))
            .param(seed())
            .param(sampler())
            .runs(Type::Action, |_, a, site| preview(false, a, site)),
        Builtin::new("render_features", "As `preview`, with what is seen first as further channels of the EXR file: `albedo`, `normal`, `position`, `depth`, `uv`, `coverage`, `material` and `part`. Stack: scene → scene image<spectral>.")
            .param(samples(16))
            .param(seed())
            .param(sampler())
            .runs(Type::Action, |_, a, site| preview(true, a, site)),
        Builtin::new("accelerate", "Names how CSG is traced from here on. Stack: scene → scene.")
            .param(Param::new(
                "strategy",
                Type::Strategy,
                "`local`, the fastest, or one of those that it is measured against",
            ))
            .runs(Type::Action, |_, a, site| {
                Ok(Value::action(Action::Accelerate { strategy: a[0].as_strategy() }, site.span))
            }),
        Builtin::new("bounding_boxes", "Prints the bounds of the scene. Stack: scene → scene.")
            .runs(Type::Action, |_, _, site| Ok(Value::action(Action::BoundingBoxes, site.span))),
        Builtin::new("collect_lights", "Prints the light sources. Stack: scene → scene.")
            .runs(Type::Action, |_, _, site| Ok(Value::action(Action::CollectLights, site.span))),
    ]
}

fn samples(usual: i64) -> Param {
    Param::new("samples", Int, "per pixel; with `noise` or `time_limit`, at most")
        .int(usual)
        .within(1.0, 4_294_967_295.0)
}

fn seed() -> Param {
    Param::new("seed", Int, "of the random numbers").int(0).non_negative()
}

fn sampler() -> Param {
    Param::new(
        "sampler",
        Type::Sampler,
        "how samples are spread: `sobol` (scrambled by Owen's method), `halton` (likewise) or `independent`",
    )
    .default_value("sobol", Value::Sampler(Sampler::Sobol))
}

fn noise() -> Param {
    Param::new("noise", Float, "relative standard error of pixels that is enough, such as 0.01: quiet parts of the picture then get fewer samples")
        .within(1e-6, 1.0)
        .optional()
}

fn time_limit() -> Param {
    Param::new(
        "time_limit",
        Float,
        "seconds after which the render ends with what it has; the picture then depends on the machine",
    )
    .positive()
    .optional()
}

fn sampling(samples: &Value, seed: &Value, sampler: &Value, noise: &Value, time_limit: &Value) -> Sampling {
    let given = |value: &Value| value.is_given().then(|| value.as_float());
    Sampling {
        samples: samples.as_int() as u32,
        seed: seed.as_int() as u64,
        sampler: sampler.as_sampler(),
        noise: given(noise),
        time_limit: given(time_limit),
    }
}

fn preview(features: bool, a: &[Value], site: &Site) -> Eval {
    let sampling = sampling(&a[0], &a[1], &a[2], &Value::Missing, &Value::Missing);
    Ok(Value::action(Action::Preview { sampling, features }, site.span))
}

fn path_trace(_: &mut Machine<'_>, a: &[Value], site: &Site) -> Eval {
    let [first, last] = [0, 1].map(|end| a[4].as_tuple()[end].as_float());
    let Some(wavelengths) = WavelengthRange::new(first, last) else {
        let message = format!("the wavelengths from {first}nm to {last}nm are no range of at least 5nm");
        return Err(site.fail_arg(4, codes::OUT_OF_RANGE, message, "first and last wavelength"));
    };
    let trace = PathTrace {
        sampling: sampling(&a[0], &a[2], &a[7], &a[8], &a[9]),
        max_depth: a[1].as_int() as u32,
        wavelengths,
        band_nm: a[5].as_float(),
        observer: a[6].as_observer(),
        polarised: a[3].as_bool(),
        features: a[10].as_bool(),
    };
    Ok(Value::action(Action::PathTrace(trace), site.span))
}

fn words() -> Vec<Builtin> {
    vec![
        Builtin::new("dup", "Stack: a → a a.").runs(Type::Action, |_, _, s| Ok(Value::action(Action::Dup, s.span))),
        Builtin::new("swap", "Stack: a b → b a.").runs(Type::Action, |_, _, s| Ok(Value::action(Action::Swap, s.span))),
        Builtin::new("drop", "Stack: a →.").runs(Type::Action, |_, _, s| Ok(Value::action(Action::Drop, s.span))),
        Builtin::new("over", "Stack: a b → a b a.")
            .runs(Type::Action, |_, _, s| Ok(Value::action(Action::Over, s.span))),
    ]
}
