//! Cameras and reconstruction filters.

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Camera, Filter, Projection};

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Type::{self, Angle, Float, Int, Point, Vec3};
use crate::value::Value;

/// Pixels along one side.
const MAX_RESOLUTION: f64 = 65_536.0;

fn placed(name: &'static str, doc: &'static str) -> Builtin {
    let filter = Filter::Gaussian { radius: 1.5, sigma: 0.5 };
    let resolution = Value::Tuple([Value::Int(512), Value::Int(512)].into());
    Builtin::new(name, doc)
        .param(Param::new("eye", Point, "where the camera is"))
        .param(Param::new("target", Point, "what is in the middle of the picture"))
        .param(Param::new("up", Vec3, "upwards in the picture").vec3([0.0, 0.0, 1.0]))
        .param(
            Param::new("resolution", Type::tuple([Int, Int]), "width and height, pixels")
                .default_value("(512, 512)", resolution)
                .within(1.0, MAX_RESOLUTION),
        )
        .param(
            Param::new("filter", Type::Filter, "reconstruction filter")
                .default_value("gaussian()", Value::Filter(filter.into())),
        )
}

fn with_fov(builtin: Builtin) -> Builtin {
    let fov = Param::new("fov", Angle, "full angle across the shorter side").degrees(40.0).degrees_between(0.0, 180.0);
    let mut builtin = builtin;
    builtin.params.insert(3, fov);
    builtin
}

pub fn builtins() -> Vec<Builtin> {
    let pixels = |name, doc, value| Param::new(name, Float, doc).float(value).positive();
    vec![
        with_fov(placed("perspective", "A pinhole camera.")).runs(Type::Camera, perspective),
        placed("orthographic", "A camera with parallel rays.")
            .param(Param::new("height", Float, "extent of the shorter side").float(2.0).positive())
            .later(Type::Camera, "the orthographic camera"),
        with_fov(placed("fisheye", "An equidistant fisheye.")).later(Type::Camera, "the fisheye camera"),
        with_fov(placed("thin_lens", "A camera with depth of field."))
            .param(Param::new("aperture", Float, "radius of the lens").float(0.01).non_negative())
            .param(Param::new("focus", Float, "distance of the plane in focus").float(1.0).positive())
            .later(Type::Camera, "the thin lens camera"),
        Builtin::new("box_filter", "Constant within its radius.")
            .param(pixels("radius", "pixels", 0.5))
            .runs(Type::Filter, |_, a, _| filter(Filter::Box { radius: a[0].as_float() })),
        Builtin::new("tent", "Falls linearly to 0 at its radius.")
            .param(pixels("radius", "pixels", 1.0))
            .runs(Type::Filter, |_, a, _| filter(Filter::Tent { radius: a[0].as_float() })),
        Builtin::new("gaussian", "A bell curve, shifted to reach 0 at its radius.")
            .param(pixels("radius", "pixels", 1.5))
            .param(pixels("sigma", "standard deviation, pixels", 0.5))
            .runs(Type::Filter, |_, a, _| filter(Filter::Gaussian { radius: a[0].as_float(), sigma: a[1].as_float() })),
        Builtin::new("mitchell", "Mitchell and Netravali 1988.")
            .param(pixels("radius", "pixels", 2.0))
            .param(Param::new("b", Float, "blur").default_value("1/3", Value::Float(1.0 / 3.0)).within(0.0, 1.0))
            .param(Param::new("c", Float, "ringing").default_value("1/3", Value::Float(1.0 / 3.0)).within(0.0, 1.0))
            .runs(Type::Filter, |_, a, _| {
                filter(Filter::Mitchell { radius: a[0].as_float(), b: a[1].as_float(), c: a[2].as_float() })
            }),
    ]
}

fn filter(filter: Filter) -> Eval {
    Ok(Value::Filter(filter.into()))
}

fn perspective(_: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (eye, target, up) = (args[0].as_vec3(), args[1].as_vec3(), args[2].as_vec3());
    let Some(view) = (target - eye).try_normalize() else {
        return Err(site.fail_arg(
            1,
            codes::OUT_OF_RANGE,
            "the camera's `target` must differ from its `eye`",
            "the same point",
        ));
    };
    if view.cross(up).try_normalize().is_none() {
        let message = "`up` must not be parallel to the direction of view";
        let failure = site.fail_arg(2, codes::OUT_OF_RANGE, message, "parallel to `target` - `eye`, or zero");
        return Err(Box::new(failure.help("give another, such as `up: (0, 1, 0)` for a view from above")));
    }
    let size = args[4].as_tuple();
    let camera = Camera {
        projection: Projection::Perspective { fov: args[3].as_float() },
        eye,
        target,
        up,
        resolution: [size[0].as_int() as u32, size[1].as_int() as u32],
        filter: args[5].as_filter(),
    };
    Ok(Value::Camera(camera.into()))
}
