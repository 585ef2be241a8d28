//! Values that vary over a surface: where they come from, and what the functions on numbers and vectors do with them.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::ImageMap;
use arsc_texture::{Binary, Input, MAX_OCTAVES, Noise, Step, StepId, Unary};

use super::{Builtin, Param, TEXTURE_OVERLOADS};
use crate::code::Site;
use crate::eval::{Color, Eval, Machine, Texture};
use crate::types::Class;
use crate::types::TextureKind::{self, Angle, Float, Vec2, Vec3};
use crate::types::Type::{self, Bool, Int, Texture as Of, Var};
use crate::value::Value;

const TEXTURE: &str = "std.texture";

pub fn builtins() -> Vec<Builtin> {
    let mut list = sources();
    list.extend(noises());
    list.extend(images());
    list.push(
        Builtin::new("select", "`then` where the condition holds, else `otherwise`: an `if` for what varies.")
            .module(TEXTURE)
            .var(Class::Textured)
            .param(Param::new("condition", Of(TextureKind::Bool), "such as `noise(position) > 0`"))
            .param(Param::new("then", Var(0), "value"))
            .param(Param::new("otherwise", Var(0), "value of the same kind"))
            .runs(Var(0), |m, a, site| m.texture_select(&a[0], &a[1], &a[2], site.span)),
    );
    list
}

fn sources() -> Vec<Builtin> {
    let of = |name, doc| Builtin::new(name, doc).module(TEXTURE);
    let world = || {
        Param::new("world", Bool, "in the world instead of the space in which the material was attached").bool(false)
    };
    vec![
        of("surface_position", "The point on the surface; `position` and `world_position` are it.")
            .param(world())
            .runs(Of(Vec3), |m, a, _| {
                let local = [Input::X, Input::Y, Input::Z];
                Ok(Texture::inputs(
                    m,
                    if a[0].as_bool() { &[Input::WorldX, Input::WorldY, Input::WorldZ] } else { &local },
                ))
            }),
        of("surface_normal", "The outward unit normal; `normal` and `world_normal` are it.").param(world()).runs(
            Of(Vec3),
            |m, a, _| {
                let world = [Input::WorldNormalX, Input::WorldNormalY, Input::WorldNormalZ];
                let local = [Input::NormalX, Input::NormalY, Input::NormalZ];
                Ok(Texture::inputs(m, if a[0].as_bool() { &world } else { &local }))
            },
        ),
        of("surface_uv", "The surface coordinates of the shape or the mesh; `uv` is it.")
            .runs(Of(Vec2), |m, _, _| Ok(Texture::inputs(m, &[Input::U, Input::V]))),
        of(
            "surface_color",
            "The colour of a mesh's vertices, linear sRGB; white without. `vertex_color` is it: `rgb(c.x, c.y, c.z)`.",
        )
        .runs(Of(Vec3), |m, _, _| Ok(Texture::inputs(m, &[Input::Red, Input::Green, Input::Blue]))),
    ]
}

fn images() -> Vec<Builtin> {
    let of = |name, doc| {
        Builtin::new(name, doc)
            .module(TEXTURE)
            .param(Param::new(
                "path",
                Type::Str,
                "PNG, JPEG, TIFF, EXR (spectral or not) or HDR file, relative to the script",
            ))
            .param(
                Param::new(
                    "at",
                    Of(Vec2),
                    "surface coordinates, the picture filling (0, 0) to (1, 1); `uv` by default",
                )
                .optional(),
            )
            .param(
                Param::new("repeat", Bool, "the picture goes on again and again; otherwise its border goes on")
                    .bool(true),
            )
            .param(
                Param::new("smooth", Bool, "linear between pixels; otherwise each pixel is of one colour").bool(true),
            )
    };
    vec![
        of("image", "A picture as reflectance: that of each colour, or the spectra of a spectral picture.").runs(
            super::materials::varying_reflectance(),
            |m, args, site| {
                let (image, uv) = image_of(m, args, false, site)?;
                Ok(m.color_value(Color::Image { image, uv }))
            },
        ),
        of(
            "image_data",
            "A picture as numbers: red, green and blue from 0 to 1 as the file has them, without the transfer function \
            of colours. For roughness, heights, normals.",
        )
        .runs(Of(Vec3), |m, args, site| {
            let (image, uv) = image_of(m, args, true, site)?;
            let channels = [0, 1, 2].map(|channel| m.expressions.image(&image, channel, uv));
            Ok(m.vector_value(channels.to_vec()))
        }),
    ]
}

fn image_of(m: &mut Machine<'_>, args: &[Value], data: bool, site: &Site) -> Eval<(Arc<ImageMap>, [StepId; 2])> {
    let (path, raster) = m.picture(args[0].as_str(), site)?;
    let at = if args[1].is_given() { args[1].clone() } else { Texture::inputs(m, &[Input::U, Input::V]) };
    let uv = m.components(&at);
    let image = ImageMap::new(path, raster, args[2].as_bool(), args[3].as_bool(), data);
    Ok((Arc::new(image), [uv[0], uv[1]]))
}

fn noises() -> Vec<Builtin> {
    let of = |name, doc| {
        Builtin::new(name, doc).module(TEXTURE).param(Param::new(
            "p",
            Of(Vec3),
            "where; one unit is the size of a feature",
        ))
    };
    let seed = || Param::new("seed", Int, "each gives a noise of its own").int(0).within(0.0, f64::from(u32::MAX));
    let fractal = |name, doc| {
        of(name, doc)
            .param(Param::new("octaves", Int, "number of noises").int(6).within(1.0, f64::from(MAX_OCTAVES)))
            .param(
                Param::new("lacunarity", Type::Float, "each is so much finer than the one before")
                    .float(2.0)
                    .positive(),
            )
            .param(Param::new("gain", Type::Float, "and has so much of its weight").float(0.5).non_negative())
            .param(seed())
    };
    vec![
        of("noise", "Gradient noise within (-1.04, 1.04), 0 on average (Perlin 2002).")
            .param(seed())
            .runs(Of(Float), |m, a, site| noise(m, &a[0], Noise::Perlin { seed: a[1].as_int() as u32 }, site)),
        fractal("fbm", "Fractional Brownian motion: noises of growing fineness, added.").runs(
            Of(Float),
            |m, a, site| {
                let (octaves, lacunarity, gain, seed) = fractal_args(a);
                noise(m, &a[0], Noise::Fbm { seed, octaves, lacunarity, gain }, site)
            },
        ),
        fractal("turbulence", "The absolute values of noises of growing fineness, added: creases, never below 0.")
            .runs(Of(Float), |m, a, site| {
                let (octaves, lacunarity, gain, seed) = fractal_args(a);
                noise(m, &a[0], Noise::Turbulence { seed, octaves, lacunarity, gain }, site)
            }),
    ]
}

fn fractal_args(a: &[Value]) -> (u32, f64, f64, u32) {
    (a[1].as_int() as u32, a[2].as_float(), a[3].as_float(), a[4].as_int() as u32)
}

fn noise(m: &mut Machine<'_>, place: &Value, noise: Noise, site: &Site) -> Eval {
    m.spend_elements(1, site.span)?;
    let p = m.components(place);
    let id = m.expressions.add(Step::Noise(noise, [p[0].0, p[1].0, p[2].0]));
    Ok(m.scalar_value(id))
}

/// What functions of the prelude become when an argument varies; parameters are those of the prelude's.
pub fn overloads() -> Vec<Builtin> {
    let of = |name, doc| Builtin::new(name, doc).module(TEXTURE_OVERLOADS);
    let on = |name, doc, kind: TextureKind| of(name, doc).param(Param::new("x", Of(kind), "varies"));
    let of_angle = |name, doc| of(name, doc).param(Param::new("angle", Of(Angle), "varies"));
    let each = |name, doc| of(name, doc).var(Class::TexturedNumber).param(Param::new("x", Var(0), "varies"));
    let of_vector = |name, doc| of(name, doc).var(Class::TexturedVector).param(Param::new("v", Var(0), "vector"));
    let number = |name| Param::new(name, Of(Float), "number");
    let mut list = vec![
        of("rgb", "A reflectance of a linear sRGB colour that varies; components limited to [0, 1].")
            .param(number("r"))
            .param(number("g"))
            .param(number("b"))
            .runs(super::materials::varying_reflectance(), |m, a, _| {
                let rgb = [m.scalar(&a[0]), m.scalar(&a[1]), m.scalar(&a[2])];
                Ok(m.color_value(Color::Rgb(rgb)))
            }),
        on("sqrt", "Square root; 0 for what is negative.", Float)
            .runs(Of(Float), |m, a, _| Ok(m.texture_map(Unary::Sqrt, &a[0]))),
        on("exp", "e to the power of x.", Float).runs(Of(Float), |m, a, _| Ok(m.texture_map(Unary::Exp, &a[0]))),
        on("ln", "Natural logarithm; -708.4 for what is not positive.", Float)
            .runs(Of(Float), |m, a, _| Ok(m.texture_map(Unary::Ln, &a[0]))),
        on("pow", "x to the power of y; 0 where it is no finite number.", Float)
            .param(number("y"))
            .runs(Of(Float), |m, a, _| Ok(m.texture_map2(Binary::Power, &a[0], &a[1]))),
        of_angle("sin", "Sine.").runs(Of(Float), |m, a, _| Ok(m.texture_map(Unary::Sin, &a[0]))),
        of_angle("cos", "Cosine.").runs(Of(Float), |m, a, _| Ok(m.texture_map(Unary::Cos, &a[0]))),
        of_angle("degrees", "The angle as a number of degrees.").runs(Of(Float), |m, a, _| {
            Ok(m.texture_map2(Binary::Multiply, &a[0], &Value::Float(180.0 / std::f64::consts::PI)))
        }),
        of_angle("radians", "The angle as a number of radians.").runs(Of(Float), |_, a, _| Ok(a[0].clone())),
        on("asin", "The angle with this sine; x limited to [-1, 1].", Float)
            .runs(Of(Angle), |m, a, _| Ok(m.texture_map(Unary::Asin, &a[0]))),
        on("acos", "The angle with this cosine; x limited to [-1, 1].", Float)
            .runs(Of(Angle), |m, a, _| Ok(m.texture_map(Unary::Acos, &a[0]))),
        of("atan2", "The angle of the point (x, y) from the x axis; 0 for the origin.")
            .param(number("y"))
            .param(number("x"))
            .runs(Of(Angle), |m, a, _| Ok(m.texture_map2(Binary::Atan2, &a[0], &a[1]))),
        each("abs", "The absolute value, of vectors by component.")
            .runs(Var(0), |m, a, _| Ok(m.texture_map(Unary::Abs, &a[0]))),
        each("floor", "The largest whole number that is not above x, of vectors by component.")
            .runs(Var(0), |m, a, _| Ok(m.texture_map(Unary::Floor, &a[0]))),
        each("min", "The smaller of two, of vectors by component.")
            .param(Param::new("y", Var(0), "the same kind"))
            .runs(Var(0), |m, a, _| Ok(m.texture_map2(Binary::Min, &a[0], &a[1]))),
        each("max", "The larger of two, of vectors by component.")
            .param(Param::new("y", Var(0), "the same kind"))
            .runs(Var(0), |m, a, _| Ok(m.texture_map2(Binary::Max, &a[0], &a[1]))),
        each("clamp", "x, or the nearer bound if it is outside of them.")
            .param(Param::new("low", Var(0), "the same kind"))
            .param(Param::new("high", Var(0), "the same kind"))
            .runs(Var(0), |m, a, _| {
                let high = m.texture_map2(Binary::Min, &a[0], &a[2]);
                Ok(m.texture_map2(Binary::Max, &high, &a[1]))
            }),
        of("lerp", "(1 - t) a + t b, of spectra as well.")
            .var(Class::Textured)
            .param(Param::new("a", Var(0), "value at t = 0"))
            .param(Param::new("b", Var(0), "value at t = 1, the same kind"))
            .param(Param::new("t", Of(Float), "weight"))
            .runs(Var(0), |m, a, site| m.texture_lerp(&a[0], &a[1], &a[2], site.span)),
        of("smoothstep", "0 below `low`, 1 above `high`, 3t² - 2t³ between.")
            .param(number("low"))
            .param(number("high"))
            .param(number("x"))
            .runs(Of(Float), |m, a, _| Ok(smoothstep(m, &a[0], &a[1], &a[2]))),
    ];
    list.extend(vectors(of, of_vector));
    list
}

fn vectors(
    of: impl Fn(&'static str, &'static str) -> Builtin,
    of_vector: impl Fn(&'static str, &'static str) -> Builtin,
) -> Vec<Builtin> {
    let pair = |builtin: Builtin, first: &'static str, second: &'static str, ty: Type| {
        builtin.param(Param::new(first, ty.clone(), "vector")).param(Param::new(second, ty, "vector of the same kind"))
    };
    let from_components = |builtin: Builtin, names: &[&'static str]| {
        names.iter().fold(builtin, |b, name| b.param(Param::new(name, Of(Float), "component")))
    };
    vec![
        from_components(of("vec2", "A vector of two."), &["x", "y"]).runs(Of(Vec2), |m, a, _| Ok(of_parts(m, a))),
        from_components(of("vec3", "A vector of three."), &["x", "y", "z"])
            .runs(Of(Vec3), |m, a, _| Ok(of_parts(m, a))),
        from_components(of("point", "A place."), &["x", "y", "z"]).runs(Of(Vec3), |m, a, _| Ok(of_parts(m, a))),
        pair(of("dot", "Scalar product.").var(Class::TexturedVector), "a", "b", Var(0)).runs(Of(Float), |m, a, _| {
            let dot = dot(m, &a[0], &a[1]);
            Ok(m.scalar_value(dot))
        }),
        pair(of("cross", "Vector product."), "a", "b", Of(Vec3)).runs(Of(Vec3), |m, args, _| {
            let (a, b) = (m.components(&args[0]), m.components(&args[1]));
            let parts = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
                let left = m.expressions.binary(Binary::Multiply, a[i], b[j]);
                let right = m.expressions.binary(Binary::Multiply, a[j], b[i]);
                m.expressions.binary(Binary::Subtract, left, right)
            });
            Ok(m.vector_value(parts.to_vec()))
        }),
        of_vector("length", "Euclidean length.").runs(Of(Float), |m, a, _| {
            let length = length(m, &a[0]);
            Ok(m.scalar_value(length))
        }),
        of("normalize", "The vector of length 1 with this direction; that of length 0 stays.")
            .param(Param::new("v", Of(Vec3), "vector"))
            .runs(Of(Vec3), |m, a, _| {
                let length = length(m, &a[0]);
                let length = m.scalar_value(length);
                Ok(m.texture_map2(Binary::Divide, &a[0], &length))
            }),
        pair(of("distance", "Distance of two points."), "a", "b", Of(Vec3)).runs(Of(Float), |m, a, _| {
            let difference = m.texture_map2(Binary::Subtract, &a[0], &a[1]);
            let length = length(m, &difference);
            Ok(m.scalar_value(length))
        }),
    ]
}

fn of_parts(m: &mut Machine<'_>, parts: &[Value]) -> Value {
    let parts = parts.iter().map(|part| m.scalar(part)).collect();
    m.vector_value(parts)
}

fn dot(m: &mut Machine<'_>, a: &Value, b: &Value) -> StepId {
    let (a, b) = (m.components(a), m.components(b));
    let mut sum = m.expressions.constant(0.0);
    for (a, b) in a.into_iter().zip(b) {
        let product = m.expressions.binary(Binary::Multiply, a, b);
        sum = m.expressions.binary(Binary::Add, sum, product);
    }
    sum
}

fn length(m: &mut Machine<'_>, v: &Value) -> StepId {
    let square = dot(m, v, v);
    m.expressions.unary(Unary::Sqrt, square)
}

fn smoothstep(m: &mut Machine<'_>, low: &Value, high: &Value, x: &Value) -> Value {
    let span = m.texture_map2(Binary::Subtract, high, low);
    let from_low = m.texture_map2(Binary::Subtract, x, low);
    let t = m.texture_map2(Binary::Divide, &from_low, &span);
    let t = m.texture_map2(Binary::Min, &t, &Value::Float(1.0));
    let t = m.texture_map2(Binary::Max, &t, &Value::Float(0.0));
    let twice = m.texture_map2(Binary::Multiply, &t, &Value::Float(2.0));
    let rest = m.texture_map2(Binary::Subtract, &Value::Float(3.0), &twice);
    let square = m.texture_map2(Binary::Multiply, &t, &t);
    m.texture_map2(Binary::Multiply, &square, &rest)
}

/// The weights of stops: piecewise linear between neighbours, constant beyond the ends.
///
/// # Errors
/// Stops that do not ascend; argument 1 of the call.
pub fn stop_weights(m: &mut Machine<'_>, x: &Value, stops: &[f64], site: &Site) -> Eval<Vec<StepId>> {
    if let Some(pair) = stops.windows(2).find(|pair| pair[0] > pair[1]) {
        let label = format!("{} stands before {}", pair[0], pair[1]);
        return Err(site.fail_arg(1, codes::OUT_OF_RANGE, "the stops must ascend", label));
    }
    let x = m.scalar(x);
    let (zero, one) = (m.expressions.constant(0.0), m.expressions.constant(1.0));
    // How far x is past each gap.
    let mut past = vec![one];
    for pair in stops.windows(2) {
        let low = m.expressions.constant(pair[0]);
        past.push(if pair[0] == pair[1] {
            m.expressions.binary(Binary::LessOrEqual, low, x)
        } else {
            let width = m.expressions.constant(pair[1] - pair[0]);
            let from_low = m.expressions.binary(Binary::Subtract, x, low);
            let t = m.expressions.binary(Binary::Divide, from_low, width);
            let t = m.expressions.binary(Binary::Max, t, zero);
            m.expressions.binary(Binary::Min, t, one)
        });
    }
    past.push(zero);
    Ok(past.windows(2).map(|pair| m.expressions.binary(Binary::Subtract, pair[0], pair[1])).collect())
}
