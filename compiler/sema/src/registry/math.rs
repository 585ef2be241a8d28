//! Numbers and quantities. Results that are not finite are diagnostics, never values.

use arsc_diagnostics::codes::sema as codes;

use super::{Builtin, Constant, Param};
use crate::code::Site;
use crate::eval::{Eval, finite};
use crate::types::Class;
use crate::types::Type::{Angle, Float, Int, Var};
use crate::value::Value;

pub fn constants() -> Vec<Constant> {
    let number = |name, doc, value| Constant { name, doc, ty: Float, value: Value::Float(value) };
    vec![number("pi", "The number π.", std::f64::consts::PI), number("tau", "The number 2π.", std::f64::consts::TAU)]
}

pub fn builtins() -> Vec<Builtin> {
    let mut list = elementary();
    list.extend(trigonometry());
    list.extend(integers());
    list.extend(quantities());
    list
}

fn of_float(name: &'static str, doc: &'static str) -> Builtin {
    Builtin::new(name, doc).param(Param::new("x", Float, "number"))
}

/// A result that may leave the domain.
fn result(x: f64, site: &Site) -> Eval {
    finite(x, "this result", site.span).map(Value::Float)
}

fn elementary() -> Vec<Builtin> {
    vec![
        Builtin::new("sqrt", "Square root.")
            .param(Param::new("x", Float, "number").non_negative())
            .runs(Float, |_, a, site| result(a[0].as_float().sqrt(), site)),
        of_float("exp", "e to the power of x.").runs(Float, |_, a, site| result(a[0].as_float().exp(), site)),
        Builtin::new("ln", "Natural logarithm.")
            .param(Param::new("x", Float, "number").positive())
            .runs(Float, |_, a, site| result(a[0].as_float().ln(), site)),
        Builtin::new("log10", "Logarithm to base 10.")
            .param(Param::new("x", Float, "number").positive())
            .runs(Float, |_, a, site| result(a[0].as_float().log10(), site)),
        of_float("pow", "x to the power of y, like `x ** y`.")
            .param(Param::new("y", Float, "exponent"))
            .runs(Float, |_, a, site| result(a[0].as_float().powf(a[1].as_float()), site)),
        Builtin::new("hypot", "The length of (x, y).")
            .param(Param::new("x", Float, "number"))
            .param(Param::new("y", Float, "number"))
            .runs(Float, |_, a, site| result(a[0].as_float().hypot(a[1].as_float()), site)),
    ]
}

fn trigonometry() -> Vec<Builtin> {
    let of_angle = |name, doc| Builtin::new(name, doc).param(Param::new("angle", Angle, "angle"));
    let inverse = |name, doc| Builtin::new(name, doc).param(Param::new("x", Float, "number").within(-1.0, 1.0));
    vec![
        of_angle("sin", "Sine.").runs(Float, |_, a, site| result(a[0].as_float().sin(), site)),
        of_angle("cos", "Cosine.").runs(Float, |_, a, site| result(a[0].as_float().cos(), site)),
        of_angle("tan", "Tangent.").runs(Float, |_, a, site| result(a[0].as_float().tan(), site)),
        inverse("asin", "The angle from -90deg to 90deg with this sine.")
            .runs(Angle, |_, a, site| result(a[0].as_float().asin(), site)),
        inverse("acos", "The angle from 0deg to 180deg with this cosine.")
            .runs(Angle, |_, a, site| result(a[0].as_float().acos(), site)),
        of_float("atan", "The angle between -90deg and 90deg with this tangent.")
            .runs(Angle, |_, a, site| result(a[0].as_float().atan(), site)),
        Builtin::new("atan2", "The angle of the point (x, y) from the x axis, from -180deg to 180deg.")
            .param(Param::new("y", Float, "ordinate"))
            .param(Param::new("x", Float, "abscissa"))
            .runs(Angle, |_, a, site| result(a[0].as_float().atan2(a[1].as_float()), site)),
        of_angle("degrees", "The angle as a number of degrees.")
            .runs(Float, |_, a, site| result(a[0].as_float().to_degrees(), site)),
        of_angle("radians", "The angle as a number of radians.").runs(Float, |_, a, _| Ok(a[0].clone())),
    ]
}

fn integers() -> Vec<Builtin> {
    let pair = |name, doc| {
        Builtin::new(name, doc).param(Param::new("a", Int, "dividend")).param(Param::new("b", Int, "divisor; not 0"))
    };
    vec![
        pair("div", "Integer division, rounded down.").runs(Int, |_, a, site| {
            let (x, y) = (a[0].as_int(), a[1].as_int());
            if y == 0 {
                return Err(site.fail_arg(1, codes::ARITHMETIC, "division by zero", "this is 0"));
            }
            let quotient = x.checked_div_euclid(y).map(|q| if y < 0 && x.rem_euclid(y) != 0 { q - 1 } else { q });
            quotient
                .map(Value::Int)
                .ok_or_else(|| Box::new(site.fail(codes::ARITHMETIC, "the result does not fit an int")))
        }),
        rounding("floor", "The largest int that is not above x.")
            .runs(Int, |_, a, site| whole(a[0].as_float().floor(), site)),
        rounding("ceil", "The smallest int that is not below x.")
            .runs(Int, |_, a, site| whole(a[0].as_float().ceil(), site)),
        rounding("round", "The nearest int, halves away from 0.")
            .runs(Int, |_, a, site| whole(a[0].as_float().round(), site)),
        Builtin::new("float", "A number as a float.")
            .param(Param::new("x", Float, "number"))
            .runs(Float, |_, a, _| Ok(Value::Float(a[0].as_float()))),
    ]
}

fn rounding(name: &'static str, doc: &'static str) -> Builtin {
    of_float(name, doc)
}

fn whole(x: f64, site: &Site) -> Eval {
    // 2^63 is exact in a double and the first that does not fit.
    if x >= -(2f64.powi(63)) && x < 2f64.powi(63) {
        return Ok(Value::Int(x as i64));
    }
    Err(Box::new(site.fail(codes::ARITHMETIC, "the result does not fit an int")))
}

fn quantities() -> Vec<Builtin> {
    let on = |name, doc| Builtin::new(name, doc).var(Class::Quantity);
    let x = || Param::new("x", Var(0), "number or quantity");
    vec![
        on("abs", "The absolute value.").param(x()).runs(Var(0), |_, a, site| match a[0] {
            Value::Int(i) => match i.checked_abs() {
                Some(i) => Ok(Value::Int(i)),
                None => Err(Box::new(site.fail(codes::ARITHMETIC, "the result does not fit an int"))),
            },
            ref other => Ok(Value::Float(other.as_float().abs())),
        }),
        on("sign", "-1, 0 or 1.").param(x()).runs(Int, |_, a, _| {
            let x = a[0].as_float();
            Ok(Value::Int(i64::from(x > 0.0) - i64::from(x < 0.0)))
        }),
        on("min", "The smaller of two.")
            .param(x())
            .param(Param::new("y", Var(0), "the same kind"))
            .runs(Var(0), |_, a, _| {
                Ok(if super::lists::compare(&a[0], &a[1]).is_le() { a[0].clone() } else { a[1].clone() })
            }),
        on("max", "The larger of two.")
            .param(x())
            .param(Param::new("y", Var(0), "the same kind"))
            .runs(Var(0), |_, a, _| {
                Ok(if super::lists::compare(&a[0], &a[1]).is_ge() { a[0].clone() } else { a[1].clone() })
            }),
        on("clamp", "x, or the nearer bound if it is outside of them.")
            .param(x())
            .param(Param::new("low", Var(0), "the same kind"))
            .param(Param::new("high", Var(0), "the same kind; not below `low`"))
            .runs(Var(0), |_, a, site| {
                let order = super::lists::compare;
                if order(&a[1], &a[2]).is_gt() {
                    return Err(site.fail_arg(
                        1,
                        codes::OUT_OF_RANGE,
                        "`low` must not exceed `high`",
                        "larger than `high`",
                    ));
                }
                let pick = if order(&a[0], &a[1]).is_lt() {
                    1
                } else if order(&a[0], &a[2]).is_gt() {
                    2
                } else {
                    0
                };
                Ok(a[pick].clone())
            }),
        Builtin::new("lerp", "(1 - t) a + t b.")
            .var(Class::Continuous)
            .param(Param::new("a", Var(0), "value at t = 0"))
            .param(Param::new("b", Var(0), "value at t = 1, the same kind"))
            .param(Param::new("t", Float, "weight"))
            .runs(Var(0), |_, a, site| {
                let t = a[2].as_float();
                let (x, y) = (
                    crate::eval::scale_value(&a[0], 1.0 - t, site.span)?,
                    crate::eval::scale_value(&a[1], t, site.span)?,
                );
                crate::eval::add_values(&x, &y, site.span)
            }),
        Builtin::new("smoothstep", "0 below `low`, 1 above `high`, 3t² - 2t³ between.")
            .param(Param::new("low", Float, "number"))
            .param(Param::new("high", Float, "number above `low`"))
            .param(Param::new("x", Float, "number"))
            .runs(Float, |_, a, site| {
                let (low, high) = (a[0].as_float(), a[1].as_float());
                if low >= high {
                    return Err(site.fail_arg(
                        0,
                        codes::OUT_OF_RANGE,
                        "`low` must be below `high`",
                        "not below `high`",
                    ));
                }
                let t = ((a[2].as_float() - low) / (high - low)).clamp(0.0, 1.0);
                result(t * t * (3.0 - 2.0 * t), site)
            }),
    ]
}
