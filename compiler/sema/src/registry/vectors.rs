//! Vectors, points and directions.

use glam::{DVec2, DVec3};

use arsc_diagnostics::codes::sema as codes;

use super::transforms::unit;
use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, finite};
use crate::types::Class;
use crate::types::Type::{self, Angle, Direction, Float, Point, Vec2, Vec3};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let xyz = |builtin: Builtin| {
        ["x", "y", "z"].into_iter().fold(builtin, |b, name| b.param(Param::new(name, Float, "component")))
    };
    vec![
        Builtin::new("vec2", "A vector of two.")
            .param(Param::new("x", Float, "component"))
            .param(Param::new("y", Float, "component"))
            .runs(Vec2, |_, a, _| Ok(Value::Vec2(DVec2::new(a[0].as_float(), a[1].as_float())))),
        xyz(Builtin::new("vec3", "A vector of three.")).runs(Vec3, |_, a, _| Ok(of_three(a))),
        xyz(Builtin::new("point", "A place.")).runs(Point, |_, a, _| Ok(of_three(a))),
        Builtin::new(
            "direction",
            "A unit vector: from components, which are normalised, or from `elevation` above the horizon and `azimuth`, \
             0 along +y (north) and growing clockwise towards +x (east).",
        )
        .param(Param::new("x", Float, "component").optional())
        .param(Param::new("y", Float, "component").optional())
        .param(Param::new("z", Float, "component").optional())
        .param(Param::new("elevation", Angle, "above the plane z = 0").optional())
        .param(Param::new("azimuth", Angle, "clockwise from +y").optional())
        .runs(Direction, |_, args, site| direction(args, site)),
        Builtin::new("dot", "Scalar product.")
            .var(Class::Vector)
            .param(Param::new("a", Type::Var(0), "vector"))
            .param(Param::new("b", Type::Var(0), "vector of the same kind"))
            .runs(Float, |_, a, site| {
                let dot = match (&a[0], &a[1]) {
                    (Value::Vec2(a), Value::Vec2(b)) => a.dot(*b),
                    (a, b) => a.as_vec3().dot(b.as_vec3()),
                };
                finite(dot, "this product", site.span).map(Value::Float)
            }),
        Builtin::new("cross", "Vector product.")
            .param(Param::new("a", Vec3, "vector"))
            .param(Param::new("b", Vec3, "vector"))
            .runs(Vec3, |_, a, _| Ok(Value::Vec3(a[0].as_vec3().cross(a[1].as_vec3())))),
        Builtin::new("length", "Euclidean length.").var(Class::Vector).param(Param::new("v", Type::Var(0), "vector")).runs(
            Float,
            |_, a, site| {
                let length = match &a[0] {
                    Value::Vec2(v) => v.length(),
                    other => other.as_vec3().length(),
                };
                finite(length, "this length", site.span).map(Value::Float)
            },
        ),
        Builtin::new("normalize", "The direction of a vector.")
            .param(Param::new("v", Vec3, "any length but 0"))
            .runs(Direction, |_, a, site| unit(&a[0], 0, site).map(Value::Vec3)),
        Builtin::new("distance", "Distance of two points.")
            .param(Param::new("a", Point, "point"))
            .param(Param::new("b", Point, "point"))
            .runs(Float, |_, a, site| {
                finite(a[0].as_vec3().distance(a[1].as_vec3()), "this distance", site.span).map(Value::Float)
            }),
        Builtin::new("lerp_points", "(1 - t) a + t b for points.")
            .param(Param::new("a", Point, "point at t = 0"))
            .param(Param::new("b", Point, "point at t = 1"))
            .param(Param::new("t", Float, "weight"))
            .runs(Point, |_, a, _| Ok(Value::Vec3(a[0].as_vec3().lerp(a[1].as_vec3(), a[2].as_float())))),
    ]
}

fn of_three(args: &[Value]) -> Value {
    Value::Vec3(DVec3::new(args[0].as_float(), args[1].as_float(), args[2].as_float()))
}

fn direction(args: &[Value], site: &Site) -> Eval {
    let given: Vec<bool> = args.iter().map(Value::is_given).collect();
    match given[..] {
        [true, true, true, false, false] => unit(&of_three(args), 0, site).map(Value::Vec3),
        [false, false, false, true, _] => {
            let azimuth = if given[4] { args[4].as_float() } else { 0.0 };
            let (sin, cos) = args[3].as_float().sin_cos();
            Ok(Value::Vec3(DVec3::new(cos * azimuth.sin(), cos * azimuth.cos(), sin)))
        }
        _ => Err(Box::new(
            site.fail(codes::WRONG_ARGUMENTS, "a direction needs x, y and z, or an elevation")
                .help("write `direction(0, 0, 1)` or `direction(elevation: 45deg, azimuth: 120deg)`"),
        )),
    }
}
