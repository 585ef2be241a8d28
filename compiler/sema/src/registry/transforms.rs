//! Placement. Each function takes a shape, a light, a list of these, or a `transform`, which it extends.

use glam::{DAffine3, DMat3, DVec3};

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::NodeKind;

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Class;
use crate::types::Type::{self, Angle, Float, Point, Transform, Vec3};
use crate::value::Value;

fn placing(name: &'static str, doc: &'static str) -> Builtin {
    Builtin::new(name, doc).var(Class::Placeable).param(Param::new("shape", Type::Var(0), "what is moved"))
}

pub fn builtins() -> Vec<Builtin> {
    let mut list = rigid();
    list.extend(affine());
    list
}

fn rigid() -> Vec<Builtin> {
    let offset = |name, doc| Param::new(name, Float, doc).float(0.0);
    let angle = || Param::new("angle", Angle, "counter-clockwise as seen against the axis");
    vec![
        placing("translate", "Moves by `by` + (`x`, `y`, `z`).")
            .param(Param::new("by", Vec3, "vector").vec3([0.0; 3]))
            .param(offset("x", "along x"))
            .param(offset("y", "along y"))
            .param(offset("z", "along z"))
            .runs(Type::Var(0), |m, args, site| {
                let by = args[1].as_vec3() + DVec3::new(args[2].as_float(), args[3].as_float(), args[4].as_float());
                place(m, &args[0], &DAffine3::from_translation(by), site)
            }),
        placing("rotate_x", "Turns about the x axis.").param(angle()).runs(Type::Var(0), |m, args, site| {
            place(m, &args[0], &DAffine3::from_mat3(DMat3::from_rotation_x(args[1].as_float())), site)
        }),
        placing("rotate_y", "Turns about the y axis.").param(angle()).runs(Type::Var(0), |m, args, site| {
            place(m, &args[0], &DAffine3::from_mat3(DMat3::from_rotation_y(args[1].as_float())), site)
        }),
        placing("rotate_z", "Turns about the z axis.").param(angle()).runs(Type::Var(0), |m, args, site| {
            place(m, &args[0], &DAffine3::from_mat3(DMat3::from_rotation_z(args[1].as_float())), site)
        }),
        placing("rotate", "Turns about an axis through the origin.")
            .param(Param::new("axis", Vec3, "axis; any length but 0"))
            .param(angle())
            .runs(Type::Var(0), |m, args, site| {
                let axis = unit(&args[1], 1, site)?;
                place(m, &args[0], &DAffine3::from_mat3(DMat3::from_axis_angle(axis, args[2].as_float())), site)
            }),
        placing("look_at", "Places the origin at `from` and turns the z axis towards `to`.")
            .param(Param::new("from", Point, "where the origin goes"))
            .param(Param::new("to", Point, "where the z axis points"))
            .param(Param::new("up", Vec3, "the y axis leans this way").vec3([0.0, 0.0, 1.0]))
            .runs(Type::Var(0), look_at),
    ]
}

fn affine() -> Vec<Builtin> {
    let factor = |name, doc| Param::new(name, Float, doc).float(1.0);
    let shear = |name, doc| Param::new(name, Float, doc).float(0.0);
    vec![
        placing(
            "scale",
            "Scales about the origin, by `factor` in all directions times (`x`, `y`, `z`). A negative factor mirrors.",
        )
        .param(factor("factor", "uniform factor"))
        .param(factor("x", "along x"))
        .param(factor("y", "along y"))
        .param(factor("z", "along z"))
        .runs(Type::Var(0), |m, args, site| {
            let factors = DVec3::new(args[2].as_float(), args[3].as_float(), args[4].as_float());
            place(m, &args[0], &DAffine3::from_scale(args[1].as_float() * factors), site)
        }),
        placing("mirror", "Mirrors in the plane through the origin with this normal.")
            .param(Param::new("normal", Vec3, "any length but 0"))
            .runs(Type::Var(0), |m, args, site| {
                let n = unit(&args[1], 1, site)?;
                let map =
                    DMat3::from_cols(DVec3::X - 2.0 * n.x * n, DVec3::Y - 2.0 * n.y * n, DVec3::Z - 2.0 * n.z * n);
                place(m, &args[0], &DAffine3::from_mat3(map), site)
            }),
        placing("shear", "Adds to each coordinate a multiple of another: x += `xy` y + `xz` z, and so on.")
            .param(shear("xy", "x by y"))
            .param(shear("xz", "x by z"))
            .param(shear("yx", "y by x"))
            .param(shear("yz", "y by z"))
            .param(shear("zx", "z by x"))
            .param(shear("zy", "z by y"))
            .runs(Type::Var(0), |m, args, site| {
                let f = |i: usize| args[i].as_float();
                let map = DMat3::from_cols(
                    DVec3::new(1.0, f(3), f(5)),
                    DVec3::new(f(1), 1.0, f(6)),
                    DVec3::new(f(2), f(4), 1.0),
                );
                place(m, &args[0], &DAffine3::from_mat3(map), site)
            }),
        placing("transform", "Applies a transform.")
            .param(Param::new("map", Transform, "what to apply"))
            .runs(Type::Var(0), |m, args, site| place(m, &args[0], args[1].as_transform(), site)),
        Builtin::new("identity", "The transform that moves nothing: the start of `identity() |> rotate_x(…) |> …`.")
            .runs(Transform, |_, _, _| Ok(Value::Transform(DAffine3::IDENTITY.into()))),
        Builtin::new("matrix", "The transform with these columns: images of the axes, then of the origin.")
            .param(Param::new("x", Vec3, "image of the x axis"))
            .param(Param::new("y", Vec3, "image of the y axis"))
            .param(Param::new("z", Vec3, "image of the z axis"))
            .param(Param::new("origin", Point, "image of the origin").vec3([0.0; 3]))
            .runs(Transform, |_, args, site| {
                let v = |i: usize| args[i].as_vec3();
                let map = DAffine3::from_cols(v(0), v(1), v(2), v(3));
                check_invertible(&map, site)?;
                Ok(Value::Transform(map.into()))
            }),
        Builtin::new("inverse", "The transform that undoes another.")
            .param(Param::new("map", Transform, "what to undo"))
            .runs(Transform, |_, args, site| {
                let map = args[0].as_transform();
                check_invertible(map, site)?;
                Ok(Value::Transform(map.inverse().into()))
            }),
    ]
}

/// The vector of an argument, normalised.
pub fn unit(value: &Value, arg: usize, site: &Site) -> Eval<DVec3> {
    value
        .as_vec3()
        .try_normalize()
        .ok_or_else(|| site.fail_arg(arg, codes::OUT_OF_RANGE, "a direction needs a length", "this is the zero vector"))
}

/// Volume factors relative to the axes below this are flat for all that double precision can tell.
const FLAT: f64 = 1e-14;

pub fn check_invertible(map: &DAffine3, site: &Site) -> Eval<()> {
    let m = &map.matrix3;
    let lengths = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    let determinant = m.determinant().abs();
    if map.is_finite() && determinant > FLAT * lengths && determinant.is_normal() {
        return Ok(());
    }
    Err(Box::new(
        site.fail(codes::DEGENERATE_TRANSFORM, "the transform flattens space and cannot be undone")
            .help("every scale factor must differ from 0"),
    ))
}

fn place(m: &mut Machine<'_>, value: &Value, map: &DAffine3, site: &Site) -> Eval {
    check_invertible(map, site)?;
    place_checked(m, value, map, site)
}

fn place_checked(m: &mut Machine<'_>, value: &Value, map: &DAffine3, site: &Site) -> Eval {
    match value {
        Value::Node(child) => {
            let kind = NodeKind::Transform { parent_from_child: Box::new(*map), child: *child };
            m.node(kind, site.span).map(Value::Node)
        }
        Value::Transform(inner) => {
            let both = *map * **inner;
            check_invertible(&both, site)?;
            Ok(Value::Transform(both.into()))
        }
        Value::List(list) => {
            m.spend_elements(list.len(), site.span)?;
            let moved: Eval<Vec<Value>> = list.iter().map(|element| place_checked(m, element, map, site)).collect();
            moved.map(Value::list)
        }
        other => panic!("the checker let pass {other:?} to a transform"),
    }
}

fn look_at(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (from, to) = (args[1].as_vec3(), args[2].as_vec3());
    let Some(z) = (to - from).try_normalize() else {
        return Err(site.fail_arg(2, codes::OUT_OF_RANGE, "`to` must differ from `from`", "the same point"));
    };
    let Some(x) = args[3].as_vec3().cross(z).try_normalize() else {
        let message = "`up` must not be parallel to the direction of view";
        return Err(site.fail_arg(3, codes::OUT_OF_RANGE, message, "parallel, or zero"));
    };
    let map = DAffine3 { matrix3: DMat3::from_cols(x, z.cross(x), z), translation: from };
    place(m, &args[0], &map, site)
}
