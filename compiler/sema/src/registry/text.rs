//! Text, and random numbers that depend on nothing but their seed.
//!
//! Random numbers are PCG-XSH-RR 64/32 (O'Neill 2014): two outputs of 32 bits give 53 bits of a float in [0, 1).
//! The algorithm is part of the language: the same seed gives the same scene in every version.

use std::fmt::Write;

use glam::DVec3;

use arsc_diagnostics::codes::sema as codes;

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Class;
use crate::types::Type::{self, Float, Int, Str, Vec3};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let seeded = |name, doc| {
        Builtin::new(name, doc)
            .param(Param::new("seed", Int, "any int"))
            .param(Param::new("n", Int, "how many").non_negative())
    };
    let bound = |name, doc, value| Param::new(name, Float, doc).float(value);
    vec![
        Builtin::new("str", "A value as text; angles in radians.")
            .param(Param::new(
                "value",
                Type::AnyOf(Class::Any),
                "bool, number, quantity, string, vector, or lists and tuples of these",
            ))
            .runs(Str, |m, args, site| {
                let mut text = String::new();
                write_value(&args[0], &mut text);
                if text.len() > MAX_TEXT {
                    let message = format!("the text of this value has more than {MAX_TEXT} characters");
                    return Err(site.fail_arg(0, codes::LIMIT, message, "too long"));
                }
                m.spend_elements(text.len() / 16, site.span)?;
                Ok(Value::str(text))
            }),
        seeded("random_floats", "`n` numbers, uniform from `low` up to but not including `high`.")
            .param(bound("low", "lower bound", 0.0))
            .param(bound("high", "upper bound", 1.0))
            .runs(Type::list(Float), random_floats),
        seeded("random_ints", "`n` ints, uniform from `low` up to but not including `high`.")
            .param(Param::new("low", Int, "lower bound"))
            .param(Param::new("high", Int, "upper bound, above `low`"))
            .runs(Type::list(Int), random_ints),
        seeded("random_points", "`n` vectors, uniform in the box from `low` to `high`.")
            .param(Param::new("low", Vec3, "one corner").vec3([0.0; 3]))
            .param(Param::new("high", Vec3, "the other corner").vec3([1.0; 3]))
            .runs(Type::list(Vec3), random_points),
    ]
}

/// Bytes of a value's text.
const MAX_TEXT: usize = 1 << 20;

/// Stops soon after the text has become too long.
fn write_value(value: &Value, text: &mut String) {
    if text.len() > MAX_TEXT {
        return;
    }
    let mut parts = |open: char, values: &[Value], close: char| {
        text.push(open);
        for (i, value) in values.iter().enumerate() {
            text.push_str(if i == 0 { "" } else { ", " });
            write_value(value, text);
        }
        text.push(close);
    };
    match value {
        Value::List(list) => parts('[', list, ']'),
        Value::Tuple(elements) => parts('(', elements, ')'),
        Value::Vec2(v) => parts('(', &[Value::Float(v.x), Value::Float(v.y)], ')'),
        Value::Vec3(v) => parts('(', &[Value::Float(v.x), Value::Float(v.y), Value::Float(v.z)], ')'),
        Value::Bool(b) => text.push_str(if *b { "true" } else { "false" }),
        // Writing to a string cannot fail.
        Value::Int(i) => drop(write!(text, "{i}")),
        Value::Float(x) => drop(write!(text, "{x}")),
        Value::Str(s) => text.push_str(s),
        _ => text.push('…'),
    }
}

struct Pcg32 {
    state: u64,
}

impl Pcg32 {
    const MULTIPLIER: u64 = 6_364_136_223_846_793_005;
    const INCREMENT: u64 = 1_442_695_040_888_963_407;

    fn new(seed: i64) -> Pcg32 {
        let mut pcg = Pcg32 { state: (seed as u64).wrapping_add(Self::INCREMENT) };
        pcg.next();
        pcg
    }

    fn next(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(Self::MULTIPLIER).wrapping_add(Self::INCREMENT);
        let shifted = (((old >> 18) ^ old) >> 27) as u32;
        shifted.rotate_right((old >> 59) as u32)
    }

    /// Uniform in [0, 1).
    fn float(&mut self) -> f64 {
        let bits = u64::from(self.next()) << 32 | u64::from(self.next());
        (bits >> 11) as f64 / 9_007_199_254_740_992.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.float()
    }
}

fn start(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval<(Pcg32, i64)> {
    let n = args[1].as_int();
    m.spend_elements(n as usize, site.span)?;
    Ok((Pcg32::new(args[0].as_int()), n))
}

fn random_floats(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (mut pcg, n) = start(m, args, site)?;
    let (low, high) = (args[2].as_float(), args[3].as_float());
    Ok(Value::list((0..n).map(|_| Value::Float(pcg.between(low, high))).collect()))
}

fn random_ints(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (mut pcg, n) = start(m, args, site)?;
    let (low, high) = (args[2].as_int(), args[3].as_int());
    if low >= high {
        return Err(site.fail_arg(3, codes::OUT_OF_RANGE, "`high` must be above `low`", "not above `low`"));
    }
    let count = (i128::from(high) - i128::from(low)) as f64;
    let pick = |pcg: &mut Pcg32| i128::from(low) + (pcg.float() * count) as i128;
    Ok(Value::list((0..n).map(|_| Value::Int(pick(&mut pcg) as i64)).collect()))
}

fn random_points(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (mut pcg, n) = start(m, args, site)?;
    let (low, high) = (args[2].as_vec3(), args[3].as_vec3());
    let mut point = || {
        let (x, y, z) = (pcg.float(), pcg.float(), pcg.float());
        Value::Vec3(low + (high - low) * DVec3::new(x, y, z))
    };
    Ok(Value::list((0..n).map(|_| point()).collect()))
}
