//! Actions: what is done with the scene. The stack effect of each stands in [`crate::actions`].

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Action, Observer, PathTrace, WavelengthRange};
use arsc_spectral::{TABLE_MAX_NM, TABLE_MIN_NM};

use super::{Builtin, Param, image_actions};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Type::{self, Bool, Int};
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
            .param(Param::new("samples", Int, "per pixel").int(128).within(1.0, 4_294_967_295.0))
            .param(Param::new("max_depth", Int, "longest path, in scattering events").int(16).within(1.0, 65_536.0))
            .param(Param::new("seed", Int, "of the random numbers").int(0).non_negative())
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
            .runs(Type::Action, path_trace),
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

fn path_trace(_: &mut Machine<'_>, a: &[Value], site: &Site) -> Eval {
    let [first, last] = [0, 1].map(|end| a[4].as_tuple()[end].as_float());
    let Some(wavelengths) = WavelengthRange::new(first, last) else {
        let message = format!("the wavelengths from {first}nm to {last}nm are no range of at least 5nm");
        return Err(site.fail_arg(4, codes::OUT_OF_RANGE, message, "first and last wavelength"));
    };
    let trace = PathTrace {
        samples: a[0].as_int() as u32,
        max_depth: a[1].as_int() as u32,
        seed: a[2].as_int() as u64,
        wavelengths,
        band_nm: a[5].as_float(),
        observer: a[6].as_observer(),
        polarised: a[3].as_bool(),
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
