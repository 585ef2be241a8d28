//! Closed primitives.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use arsc_diagnostics::codes::sema as codes;
use arsc_geometry::{EXPONENTS, Hyperboloid, Paraboloid, Superquadric};
use arsc_ir::Shape;

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Type;
use crate::types::Type::{Bool, Float, Point, Solid, Str, Vec3};
use crate::value::Value;

fn solid(name: &'static str, doc: &'static str) -> Builtin {
    Builtin::new(name, doc)
}

pub fn builtins() -> Vec<Builtin> {
    let mut list = round();
    list.extend(quadrics());
    list.extend(flat());
    list.extend(files());
    list.extend(super::outlines::builtins());
    list
}

fn round() -> Vec<Builtin> {
    let center = || Param::new("center", Point, "centre").vec3([0.0; 3]);
    vec![
        solid("sphere", "A ball. One face.")
            .param(Param::new("radius", Float, "radius").float(1.0).positive())
            .param(center())
            .runs(Solid, |m, args, site| {
                let map = DAffine3::from_translation(args[1].as_vec3());
                m.solid(Shape::Sphere { radius: args[0].as_float() }, map, site)
            }),
        solid("ellipsoid", "An ellipsoid with its axes along x, y and z. One face.")
            .param(Param::new("radii", Vec3, "half axes").positive())
            .param(center())
            .runs(Solid, |m, args, site| {
                let map = DAffine3::from_scale(args[0].as_vec3());
                let map = DAffine3::from_translation(args[1].as_vec3()) * map;
                m.solid(Shape::Sphere { radius: 1.0 }, map, site)
            }),
        solid(
            "cylinder",
            "A cylinder about the z axis, from z = 0 to z = `height`; a truncated cone if `top_radius` is given. \
             Faces: 0 side, 1 bottom, 2 top.",
        )
        .param(Param::new("radius", Float, "radius").float(1.0).positive())
        .param(Param::new("height", Float, "height").float(1.0).positive())
        .param(Param::new("top_radius", Float, "radius at the top, if it differs").optional().non_negative())
        .runs(Solid, |m, args, site| {
            let (radius, height) = (args[0].as_float(), args[1].as_float());
            let shape = match args[2] {
                Value::Missing => Shape::Cylinder { radius, height },
                ref top => frustum(radius, top.as_float(), height),
            };
            m.solid(shape, DAffine3::IDENTITY, site)
        }),
        solid("infinite_cylinder", "A cylinder about the z axis without ends. Unbounded: intersect it with something. One face.")
            .param(Param::new("radius", Float, "radius").float(1.0).positive())
            .runs(Solid, |m, args, site| {
                m.solid(Shape::InfiniteCylinder { radius: args[0].as_float() }, DAffine3::IDENTITY, site)
            }),
        solid("cone", "A cone about the z axis, from z = 0 to z = `height`; truncated if `top_radius` is not 0. Faces: 0 side, 1 bottom, 2 top.")
            .param(Param::new("radius", Float, "radius at the base").float(1.0).non_negative())
            .param(Param::new("height", Float, "height").float(1.0).positive())
            .param(Param::new("top_radius", Float, "radius at the top").float(0.0).non_negative())
            .runs(Solid, cone),
        solid(
            "torus",
            "A torus about the z axis: ring, horn (`minor` = `major`) or spindle (`minor` > `major`, filled). One face.",
        )
        .param(Param::new("major", Float, "radius of the centre circle").float(1.0).positive())
        .param(Param::new("minor", Float, "radius of the tube").float(0.25).positive())
        .runs(Solid, |m, args, site| {
            let shape = Shape::Torus { major: args[0].as_float(), minor: args[1].as_float() };
            m.solid(shape, DAffine3::IDENTITY, site)
        }),
    ]
}

fn frustum(base_radius: f64, top_radius: f64, height: f64) -> Shape {
    if base_radius == top_radius {
        return Shape::Cylinder { radius: base_radius, height };
    }
    Shape::Cone { base_radius, top_radius, height }
}

fn cone(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (base, height, top) = (args[0].as_float(), args[1].as_float(), args[2].as_float());
    if base == 0.0 && top == 0.0 {
        return Err(site.fail_arg(
            0,
            codes::OUT_OF_RANGE,
            "a cone needs one radius greater than 0",
            "this is 0, and so is `top_radius`",
        ));
    }
    m.solid(frustum(base, top, height), DAffine3::IDENTITY, site)
}

fn quadrics() -> Vec<Builtin> {
    vec![
        solid(
            "paraboloid",
            "A bowl of parabolic section about the z axis: vertex at the origin, closed by a disk at z = `height`. Faces: 0 side, 2 top.",
        )
        .param(Param::new("radius", Float, "radius at the top").float(1.0).positive())
        .param(Param::new("height", Float, "height").float(1.0).positive())
        .runs(Solid, |m, args, site| {
            let shape = Shape::Paraboloid(Paraboloid { radius: args[0].as_float(), height: args[1].as_float() });
            if !shape.is_valid() {
                return Err(site.fail(codes::OUT_OF_RANGE, "this paraboloid is too flat or too slender").into());
            }
            m.solid(shape, DAffine3::IDENTITY, site)
        }),
        solid(
            "hyperboloid",
            "A hyperboloid of revolution about the z axis, centred at the origin and cut off at z = ± `height` / 2. One \
             sheet: x² + y² <= (`slope` z)² + `radius`², a column with a waist. Two sheets: x² + y² <= (`slope` z)² - \
             `radius`², two bowls with their vertices at z = ± `radius` / `slope`. Faces: 0 side, \
             1 bottom, 2 top.",
        )
        .param(Param::new("radius", Float, "radius of the waist; sets the gap of two sheets").float(1.0).positive())
        .param(Param::new("height", Float, "height").float(2.0).positive())
        .param(Param::new("slope", Float, "radius over height of the cone that both forms approach").float(1.0).positive())
        .param(Param::new("sheets", Type::Int, "1 or 2").int(1).within(1.0, 2.0))
        .runs(Solid, hyperboloid),
        solid(
            "superquadric",
            "A superellipsoid: (|x|^(2/`e2`) + |y|^(2/`e2`))^(`e2`/`e1`) + |z|^(2/`e1`) <= 1 in units of the half axes. \
             Exponents near 0 make boxes, 1 is round, 2 flat, beyond 2 pinched. One face.",
        )
        .param(Param::new("radii", Vec3, "half axes").vec3([1.0; 3]).positive())
        .param(exponent("e1", "exponent from pole to pole"))
        .param(exponent("e2", "exponent around the z axis"))
        .runs(Solid, |m, args, site| {
            let Some(solid) = Superquadric::new(args[1].as_float(), args[2].as_float()) else {
                return Err(site.fail(codes::OUT_OF_RANGE, "an exponent is out of range").into());
            };
            m.solid(Shape::Superquadric(Arc::new(solid)), DAffine3::from_scale(args[0].as_vec3()), site)
        }),
    ]
}

fn exponent(name: &'static str, doc: &'static str) -> Param {
    Param::new(name, Float, doc).float(1.0).within(*EXPONENTS.start(), *EXPONENTS.end())
}

fn hyperboloid(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (radius, half_height, slope) = (args[0].as_float(), 0.5 * args[1].as_float(), args[2].as_float());
    let two_sheets = args[3].as_int() == 2;
    let shape = Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets });
    if shape.is_valid() {
        return m.solid(shape, DAffine3::IDENTITY, site);
    }
    if two_sheets && half_height <= radius / slope {
        let least = 2.0 * radius / slope;
        let message = "this hyperboloid is cut off before its sheets begin";
        let label = format!("must be greater than 2 `radius` / `slope`, here {least}");
        return Err(site.fail_arg(1, codes::OUT_OF_RANGE, message, label));
    }
    Err(site.fail(codes::OUT_OF_RANGE, "the sizes of this hyperboloid lie too far apart").into())
}

fn flat() -> Vec<Builtin> {
    vec![
        solid("box", "A box with faces parallel to the axes: by `size`, or by two opposite corners `min` and `max`. Faces: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z.")
            .param(Param::new("size", Vec3, "edge lengths; (1, 1, 1) if no corner is given").optional().positive())
            .param(
                Param::new(
                    "center",
                    Bool,
                    "with `size`: centred at the origin, as if left out; else the smallest corner is there",
                )
                .optional(),
            )
            .param(Param::new("min", Point, "smallest corner").optional())
            .param(Param::new("max", Point, "largest corner").optional())
            .runs(Solid, block),
        solid("cube", "A cube with faces parallel to the axes, numbered as those of a box.")
            .param(Param::new("size", Float, "edge length").float(1.0).positive())
            .param(Param::new("center", Bool, "centred at the origin; else the smallest corner is there").bool(true))
            .runs(Solid, |m, args, site| sized_box(m, DVec3::splat(args[0].as_float()), args[1].as_bool(), site)),
        solid("half_space", "All points p with dot(p, `normal`) <= `offset`: the normal points out. Unbounded. One face.")
            .param(Param::new("normal", Vec3, "out of the solid; any length but 0").vec3([0.0, 0.0, 1.0]))
            .param(Param::new("offset", Float, "distance of the plane from the origin along the normal").float(0.0))
            .runs(Solid, |m, args, site| {
                let Some(normal) = args[0].as_vec3().try_normalize() else {
                    return Err(site.fail_arg(
                        0,
                        codes::OUT_OF_RANGE,
                        "a normal needs a length",
                        "this is the zero vector",
                    ));
                };
                let rotation = glam::DQuat::from_rotation_arc(DVec3::Z, normal);
                let map = DAffine3::from_rotation_translation(rotation, normal * args[1].as_float());
                m.solid(Shape::HalfSpace, map, site)
            }),
    ]
}

fn sized_box(m: &mut Machine<'_>, size: DVec3, center: bool, site: &Site) -> Eval {
    let min = if center { -0.5 * size } else { DVec3::ZERO };
    m.solid(Shape::Box { min, max: min + size }, DAffine3::IDENTITY, site)
}

fn block(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    match (&args[0], &args[2], &args[3]) {
        (size, Value::Missing, Value::Missing) => {
            let size = if size.is_given() { size.as_vec3() } else { DVec3::ONE };
            sized_box(m, size, !args[1].is_given() || args[1].as_bool(), site)
        }
        (Value::Missing, min, max) if min.is_given() && max.is_given() && !args[1].is_given() => {
            let (min, max) = (min.as_vec3(), max.as_vec3());
            if !min.cmplt(max).all() {
                let message = "`max` of a box must exceed `min` in every axis";
                return Err(site.fail_arg(3, codes::OUT_OF_RANGE, message, "the larger corner"));
            }
            m.solid(Shape::Box { min, max }, DAffine3::IDENTITY, site)
        }
        _ => Err(site
            .fail(codes::WRONG_ARGUMENTS, "a box takes either `size`, and `center` if it must, or both `min` and `max`")
            .help("write `box(size: (1, 2, 3))` or `box(min: (0, 0, 0), max: (1, 2, 3))`")
            .into()),
    }
}

fn files() -> Vec<Builtin> {
    vec![
        solid(
            "mesh_solid",
            "A closed triangle mesh from a file. Its faces are its triangles, in the order of the file.",
        )
        .param(Param::new("path", Str, "PLY, OBJ or STL file, relative to the script"))
        .runs(Solid, |m, args, site| {
            let shape = m.closed_mesh(args[0].as_str(), site)?;
            m.solid(shape, DAffine3::IDENTITY, site)
        }),
        solid(
            "height_field",
            "A solid whose top is given by a grey image: black is at z = 0, white at `size`.z, its lower left corner at \
             the origin. It goes down to z = -`size`.z / 16, so that black parts have a thickness. Its faces are triangles.",
        )
        .param(Param::new("path", Str, "PNG image, relative to the script; one vertex a pixel"))
        .param(Param::new("size", Vec3, "extent along x and y, and height of white").vec3([1.0; 3]).positive())
        .runs(Solid, |m, args, site| {
            let path = args[0].as_str();
            if !path.to_ascii_lowercase().ends_with(".png") {
                let message = "a height field comes from a PNG image";
                return Err(site.fail_arg(0, codes::ASSET, message, "has another extension"));
            }
            let shape = m.closed_mesh(path, site)?;
            m.solid(shape, DAffine3::from_scale(args[1].as_vec3()), site)
        }),
    ]
}
