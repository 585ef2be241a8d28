//! Operators.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_ir::{NodeKind, Spectrum};
use arsc_syntax::ast::UnaryOp;

use super::{Eval, Machine};
use crate::code::{Binary, Unary};
use crate::registry::flatten_nodes;
use crate::value::Value;

/// `x`, unless it is infinite or no number; `what` as in "this sum".
pub fn finite(x: f64, what: &str, span: Span) -> Eval<f64> {
    if x.is_finite() { Ok(x) } else { Err(no_result(&format!("{what} is not a finite number"), span)) }
}

fn no_result(message: &str, span: Span) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(codes::ARITHMETIC, message).label(span, "here"))
}

fn zero_division(span: Span) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(codes::ARITHMETIC, "division by zero").label(span, "the divisor is 0"))
}

fn int(result: Option<i64>, span: Span) -> Eval {
    result.map(Value::Int).ok_or_else(|| no_result("the result does not fit an int of 64 bits", span))
}

fn number(x: f64, span: Span) -> Eval {
    finite(x, "the result", span).map(Value::Float)
}

/// The sum of two values of one type of [`crate::types::Class::Linear`].
pub fn add_values(a: &Value, b: &Value, span: Span) -> Eval {
    match (a, b) {
        (Value::Int(x), Value::Int(y)) => int(x.checked_add(*y), span),
        (Value::Spectrum(x), Value::Spectrum(y)) => Ok(Value::spectrum(Spectrum::Sum(x.clone(), y.clone()))),
        (Value::Vec2(_) | Value::Vec3(_), _) => vector(a, b, span, |x, y| x + y),
        _ => number(a.as_float() + b.as_float(), span),
    }
}

/// A value of a type of [`crate::types::Class::Linear`] times a number.
pub fn scale_value(a: &Value, factor: f64, span: Span) -> Eval {
    match a {
        Value::Vec2(v) => vec2(*v * factor, span),
        Value::Vec3(v) => vec3(*v * factor, span),
        Value::Spectrum(s) => scale_spectrum(s, factor, span),
        other => number(other.as_float() * factor, span),
    }
}

fn scale_spectrum(s: &Arc<Spectrum>, factor: f64, span: Span) -> Eval {
    if factor < 0.0 {
        let message = format!("a spectrum cannot be scaled by {factor}: it would be negative");
        return Err(Box::new(Diagnostic::new(codes::OUT_OF_RANGE, message).label(span, "here")));
    }
    Ok(Value::spectrum(match &**s {
        Spectrum::Constant(x) => Spectrum::Constant(finite(x * factor, "the result", span)?),
        Spectrum::Scaled { factor: inner, spectrum } => {
            let factor = finite(inner * factor, "the result", span)?;
            Spectrum::Scaled { factor, spectrum: spectrum.clone() }
        }
        _ => Spectrum::Scaled { factor, spectrum: s.clone() },
    }))
}

fn vec2(v: glam::DVec2, span: Span) -> Eval {
    if v.is_finite() { Ok(Value::Vec2(v)) } else { Err(no_result("the result is not finite", span)) }
}

fn vec3(v: glam::DVec3, span: Span) -> Eval {
    if v.is_finite() { Ok(Value::Vec3(v)) } else { Err(no_result("the result is not finite", span)) }
}

/// Component by component.
fn vector(a: &Value, b: &Value, span: Span, f: fn(f64, f64) -> f64) -> Eval {
    match (a, b) {
        (Value::Vec2(a), Value::Vec2(b)) => vec2(glam::DVec2::new(f(a.x, b.x), f(a.y, b.y)), span),
        (a, b) => {
            let (a, b) = (a.as_vec3(), b.as_vec3());
            vec3(glam::DVec3::new(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)), span)
        }
    }
}

impl Machine<'_> {
    pub(super) fn unary(&mut self, op: Unary, a: &Value, span: Span) -> Eval {
        match op {
            Unary::NegInt => int(a.as_int().checked_neg(), span),
            Unary::NegFloat => Ok(Value::Float(-a.as_float())),
            Unary::NegVec2 => scale_value(a, -1.0, span),
            Unary::NegVec3 => Ok(Value::Vec3(-a.as_vec3())),
            Unary::Not => Ok(Value::Bool(!a.as_bool())),
            Unary::Texture(UnaryOp::Neg) => Ok(self.texture_map(arsc_texture::Unary::Negate, a)),
            Unary::Texture(UnaryOp::Not) => Ok(self.texture_map(arsc_texture::Unary::Not, a)),
        }
    }

    pub(super) fn binary(&mut self, op: Binary, a: &Value, b: &Value, span: Span) -> Eval {
        use Binary::*;
        match op {
            AddInt => int(a.as_int().checked_add(b.as_int()), span),
            SubInt => int(a.as_int().checked_sub(b.as_int()), span),
            MulInt => int(a.as_int().checked_mul(b.as_int()), span),
            RemInt if b.as_int() == 0 => Err(zero_division(span)),
            RemInt => int(Some(a.as_int().wrapping_rem_euclid(b.as_int())), span),
            PowInt => power(a.as_int(), b.as_int(), span),
            AddFloat => number(a.as_float() + b.as_float(), span),
            SubFloat => number(a.as_float() - b.as_float(), span),
            MulFloat => number(a.as_float() * b.as_float(), span),
            DivFloat | RemFloat | DivVec | DivSpectrum if b.as_float() == 0.0 => Err(zero_division(span)),
            DivFloat => number(a.as_float() / b.as_float(), span),
            RemFloat => number(a.as_float().rem_euclid(b.as_float()), span),
            PowFloat => number(a.as_float().powf(b.as_float()), span),
            Eq => Ok(Value::Bool(self.equal(a, b, span)?)),
            Ne => Ok(Value::Bool(!self.equal(a, b, span)?)),
            Lt | Le | Gt | Ge => Ok(Value::Bool(ordered(op, a, b))),
            Texture(op) => self.texture_binary(op, a, b, span),
            Union | Intersection | Difference => self.boolean(op, a, b, span),
            _ => self.compound(op, a, b, span),
        }
    }

    fn compound(&mut self, op: Binary, a: &Value, b: &Value, span: Span) -> Eval {
        match op {
            Binary::AddVec => vector(a, b, span, |x, y| x + y),
            Binary::SubVec => vector(a, b, span, |x, y| x - y),
            Binary::ScaleVec | Binary::ScaleSpectrum => scale_value(a, b.as_float(), span),
            Binary::DivVec => match a {
                Value::Vec2(v) => vec2(*v / b.as_float(), span),
                other => vec3(other.as_vec3() / b.as_float(), span),
            },
            Binary::DivSpectrum => scale_value(a, 1.0 / b.as_float(), span),
            Binary::AddSpectrum => add_values(a, b, span),
            Binary::MulSpectrum => {
                Ok(Value::spectrum(Spectrum::Product(a.as_spectrum().clone(), b.as_spectrum().clone())))
            }
            Binary::Compose => Ok(Value::Transform((*a.as_transform() * *b.as_transform()).into())),
            Binary::TransformPoint => vec3(a.as_transform().transform_point3(b.as_vec3()), span),
            Binary::TransformVector => vec3(a.as_transform().transform_vector3(b.as_vec3()), span),
            Binary::Concat => self.concat(a, b, span),
            other => panic!("operator {other:?} reached the compound operators"),
        }
    }

    fn concat(&mut self, a: &Value, b: &Value, span: Span) -> Eval {
        match (a, b) {
            (Value::Str(a), Value::Str(b)) => {
                self.spend_elements((a.len() + b.len()) / 16, span)?;
                Ok(Value::str(format!("{a}{b}")))
            }
            (a, b) => {
                let (a, b) = (a.as_list(), b.as_list());
                self.spend_elements(a.len() + b.len(), span)?;
                Ok(Value::list(a.iter().chain(b.iter()).cloned().collect()))
            }
        }
    }

    fn boolean(&mut self, op: Binary, a: &Value, b: &Value, span: Span) -> Eval {
        let mut left = Vec::new();
        flatten_nodes(self, a, &mut left, span)?;
        let mut right = Vec::new();
        flatten_nodes(self, b, &mut right, span)?;
        let (kind, operands): (fn(Vec<_>) -> NodeKind, Vec<_>) = match op {
            Binary::Union => (NodeKind::Union, [left, right].concat()),
            Binary::Intersection => (NodeKind::Intersection, [left, right].concat()),
            _ => {
                // A list on the left is the union of its elements.
                let from = if left.len() == 1 { left[0] } else { self.union_of(left, span)? };
                (NodeKind::Difference, std::iter::once(from).chain(right).collect())
            }
        };
        match operands.len() {
            0 => Err(Box::new(Diagnostic::new(codes::EMPTY_LIST, "both operands are empty lists").label(span, "here"))),
            1 => Ok(Value::Node(operands[0])),
            _ => self.node(kind(operands), span).map(Value::Node),
        }
    }

    fn union_of(&mut self, operands: Vec<arsc_ir::NodeId>, span: Span) -> Eval<arsc_ir::NodeId> {
        if operands.is_empty() {
            let message = "nothing is left to cut: the list is empty";
            return Err(Box::new(Diagnostic::new(codes::EMPTY_LIST, message).label(span, "here")));
        }
        self.node(NodeKind::Union(operands), span)
    }
}

fn power(base: i64, exponent: i64, span: Span) -> Eval {
    let Ok(exponent) = u32::try_from(exponent) else {
        let failure = no_result("an int cannot be raised to this power", span);
        return Err(Box::new(failure.help("write the base as a float: `10.0 ** -3`")));
    };
    int(base.checked_pow(exponent), span)
}

fn ordered(op: Binary, a: &Value, b: &Value) -> bool {
    let order = match (a, b) {
        (Value::Str(a), Value::Str(b)) => a.cmp(b),
        (Value::Int(a), Value::Int(b)) => a.cmp(b),
        // Values are finite, so there is an order; -0 equals 0.
        (a, b) => a.as_float().partial_cmp(&b.as_float()).unwrap_or(std::cmp::Ordering::Equal),
    };
    match op {
        Binary::Lt => order.is_lt(),
        Binary::Le => order.is_le(),
        Binary::Gt => order.is_gt(),
        _ => order.is_ge(),
    }
}

impl Machine<'_> {
    /// Values that are shared stand for as many as they would be if written out: comparing them counts as steps.
    pub(super) fn equal(&mut self, a: &Value, b: &Value, span: Span) -> Eval<bool> {
        Ok(match (a, b) {
            (Value::Bool(a), Value::Bool(b)) => a == b,
            (Value::Int(a), Value::Int(b)) => a == b,
            (Value::Float(a), Value::Float(b)) => a == b,
            (Value::Vec2(a), Value::Vec2(b)) => a == b,
            (Value::Vec3(a), Value::Vec3(b)) => a == b,
            (Value::Str(a), Value::Str(b)) => a == b,
            (Value::Tuple(a), Value::Tuple(b)) => self.all_equal(a, b, span)?,
            (Value::List(a), Value::List(b)) => self.all_equal(a, b, span)?,
            _ => false,
        })
    }

    fn all_equal(&mut self, a: &[Value], b: &[Value], span: Span) -> Eval<bool> {
        if a.len() != b.len() {
            return Ok(false);
        }
        for (a, b) in a.iter().zip(b) {
            self.step(span)?;
            if !self.equal(a, b, span)? {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
