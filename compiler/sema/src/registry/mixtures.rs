//! Bsdfs made of others: fixed mixtures, and those that an expression picks from.

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Attributes, Bsdf, Parameter, Part, Varying};
use arsc_texture::{Binary, StepId};
use glam::DAffine3;

use super::materials::{MATERIAL, bsdf};
use super::textures::stop_weights;
use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::TextureKind;
use crate::types::Type::{self, Float, Texture};
use crate::value::Value;

/// Bsdfs in one mixture.
const MAX_PARTS: usize = 256;

pub fn builtins() -> Vec<Builtin> {
    let pairs = |weight: Type| Type::list(Type::tuple([weight, Type::Bsdf]));
    vec![
        Builtin::new("mix", "Bsdfs side by side, finer than can be seen: each has its share of the surface.")
            .module(MATERIAL)
            .param(Param::new(
                "parts",
                pairs(Texture(TextureKind::Float)),
                "weights, relative to their sum, and bsdfs: `[(1, silver), (3, white_paint)]`",
            ))
            .runs(Type::Bsdf, |m, args, site| {
                let parts: Vec<(Value, u32)> = pairs_of(&args[0], site)?;
                let weights = parts.iter().map(|(weight, _)| m.scalar(weight)).collect();
                mixture(m, weights, parts.into_iter().map(|part| part.1).collect(), site)
            }),
        Builtin::new("mapped", "The bsdf that belongs to a value: between two stops a mixture of theirs.")
            .module(MATERIAL)
            .param(Param::new("value", Texture(TextureKind::Float), "varies over the surface"))
            .param(Param::new(
                "stops",
                pairs(Float),
                "values, ascending, and bsdfs: `[(0.2, gold), (0.3, silver)]`; two at one value make a sharp edge",
            ))
            .runs(Type::Bsdf, |m, args, site| {
                let parts: Vec<(Value, u32)> = pairs_of(&args[1], site)?;
                let stops: Vec<f64> = parts.iter().map(|(stop, _)| stop.as_float()).collect();
                let weights = stop_weights(m, &args[0], &stops, site)?;
                mixture(m, weights, parts.into_iter().map(|part| part.1).collect(), site)
            }),
    ]
}

/// Bsdfs with another shading normal.
pub fn reliefs() -> Vec<Builtin> {
    let of = |name, doc| {
        Builtin::new(name, doc).module(MATERIAL).param(Param::new("bsdf", Type::Bsdf, "what is lit that way"))
    };
    vec![
        of("bumped", "A bsdf on a surface that seems to stand out by a height: `lambert(0.5) |> bumped(0.01 * noise(position * 20))`. Light is \
            scattered as by the raised surface; outlines and shadows stay.")
            .param(Param::new("height", Texture(TextureKind::Float), "along the normal, where the material is attached"))
            .runs(Type::Bsdf, |m, args, site| {
                let height = m.scalar(&args[1]);
                let parameter = Parameter::Height(m.expression(height, site.args[1])?);
                relief(m, &args[0], &parameter)
            }),
        of("normal_mapped", "A bsdf on a surface with a normal from a map.")
            .param(Param::new("normal", Texture(TextureKind::Vec3), "along growing u, across it, along the normal; of any length"))
            .runs(Type::Bsdf, |m, args, site| {
                let mut normal = Vec::new();
                for component in m.components(&args[1]) {
                    normal.push(m.expression(component, site.args[1])?);
                }
                let Ok(normal) = <[_; 3]>::try_from(normal) else { panic!("the checker let pass a vector of another size") };
                relief(m, &args[0], &Parameter::Normal(normal))
            }),
    ]
}

/// The bsdf, each of its parts with this parameter.
fn relief(m: &mut Machine<'_>, on: &Value, parameter: &Parameter) -> Eval {
    let index = on.as_attributes().bsdf.unwrap_or_default();
    let mut parts = match m.bsdfs[index as usize].clone() {
        Bsdf::Varying(inner) => inner.parts.clone(),
        plain => vec![Part { weight: arsc_ir::Expression::constant(1.0), bsdf: plain, parameters: Vec::new() }],
    };
    for part in &mut parts {
        // The outermost counts.
        part.parameters.retain(|old| !matches!(old, Parameter::Height(_) | Parameter::Normal(_)));
        part.parameters.push(parameter.clone());
    }
    bsdf(m, varying(parts))
}

fn pairs_of(list: &Value, site: &Site) -> Eval<Vec<(Value, u32)>> {
    let list = list.as_list();
    if list.is_empty() || list.len() > MAX_PARTS {
        let message = format!("a mixture has 1 to {MAX_PARTS} parts, but here are {}", list.len());
        return Err(Box::new(site.fail(codes::OUT_OF_RANGE, message)));
    }
    let pair = |pair: &Value| {
        let pair = pair.as_tuple();
        (pair[0].clone(), pair[1].as_attributes().bsdf.unwrap_or_default())
    };
    Ok(list.iter().map(pair).collect())
}

/// Mixtures within are dissolved: their parts take their shares of the weight.
fn mixture(m: &mut Machine<'_>, weights: Vec<StepId>, bsdfs: Vec<u32>, site: &Site) -> Eval {
    if let [only] = bsdfs[..] {
        return Ok(Value::Attributes(Attributes { bsdf: Some(only), ..Attributes::default() }));
    }
    let mut parts = Vec::new();
    for (weight, index) in weights.into_iter().zip(bsdfs) {
        if m.expressions.as_constant(weight).is_some_and(|weight| weight <= 0.0) {
            continue;
        }
        match m.bsdfs[index as usize].clone() {
            Bsdf::Varying(inner) => {
                for (share, part) in shares(m, &inner).into_iter().zip(&inner.parts) {
                    let weight = m.expressions.binary(Binary::Multiply, weight, share);
                    parts.push(Part { weight: m.expression(weight, site.span)?, ..part.clone() });
                }
            }
            plain => {
                let weight = m.expression(weight, site.span)?;
                parts.push(Part { weight, bsdf: plain, parameters: Vec::new() });
            }
        }
        if parts.len() > MAX_PARTS {
            let message = format!("a mixture has more than {MAX_PARTS} parts");
            return Err(Box::new(site.fail(codes::OUT_OF_RANGE, message)));
        }
    }
    if parts.is_empty() {
        return Err(Box::new(site.fail(codes::OUT_OF_RANGE, "no weight of this mixture is positive")));
    }
    bsdf(m, varying(parts))
}

/// The parts' weights over their sum.
fn shares(m: &mut Machine<'_>, varying: &Varying) -> Vec<StepId> {
    let zero = m.expressions.constant(0.0);
    let weights: Vec<StepId> = varying
        .parts
        .iter()
        .map(|part| {
            let weight = m.expressions.insert(&part.weight);
            m.expressions.binary(Binary::Max, weight, zero)
        })
        .collect();
    let sum = weights.iter().fold(zero, |sum, weight| m.expressions.binary(Binary::Add, sum, *weight));
    weights.into_iter().map(|weight| m.expressions.binary(Binary::Divide, weight, sum)).collect()
}

fn varying(parts: Vec<Part>) -> Bsdf {
    Bsdf::Varying(Varying { parts, texture_from_object: DAffine3::IDENTITY }.into())
}

/// The bsdf, with parameters that vary if there are any.
pub fn with_parameters(m: &mut Machine<'_>, plain: Bsdf, parameters: Vec<Parameter>) -> Eval {
    if parameters.is_empty() {
        return bsdf(m, plain);
    }
    let weight = arsc_ir::Expression::constant(1.0);
    bsdf(m, varying(vec![Part { weight, bsdf: plain, parameters }]))
}
