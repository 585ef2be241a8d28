//! Parameters of builtins: type, default, allowed range.

use glam::DVec3;

use crate::types::Type;
use crate::value::Value;

#[derive(Clone, Debug)]
pub enum Default {
    Required,
    /// May be left out; the builtin then sees [`Value::Missing`].
    Optional,
    Value {
        text: String,
        value: Value,
    },
}

/// What a number may be; vectors are held to it in every component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint {
    None,
    Positive,
    NonNegative,
    /// Both ends included.
    Within(f64, f64),
    /// Angles, both ends excluded, in degrees.
    DegreesBetween(f64, f64),
    /// Angles above 0, the end in degrees included.
    DegreesUpTo(f64),
    /// Angles from 0, the end in degrees excluded.
    DegreesBelow(f64),
}

impl Constraint {
    /// `None` when the value is allowed, else what it must be.
    pub fn violation(self, value: &Value) -> Option<String> {
        let holds = |x: f64| match self {
            Constraint::None => true,
            Constraint::Positive => x > 0.0,
            Constraint::NonNegative => x >= 0.0,
            Constraint::Within(low, high) => x >= low && x <= high,
            Constraint::DegreesBetween(low, high) => x > low.to_radians() && x < high.to_radians(),
            Constraint::DegreesUpTo(high) => x > 0.0 && x <= high.to_radians(),
            Constraint::DegreesBelow(high) => x >= 0.0 && x < high.to_radians(),
        };
        let all_hold = match value {
            Value::Int(i) => holds(*i as f64),
            Value::Float(x) => holds(*x),
            Value::Vec2(v) => holds(v.x) && holds(v.y),
            Value::Vec3(v) => holds(v.x) && holds(v.y) && holds(v.z),
            Value::Tuple(elements) => elements.iter().all(|element| self.violation(element).is_none()),
            _ => true,
        };
        (!all_hold).then(|| self.description())
    }

    /// As in "must be …".
    pub fn description(self) -> String {
        match self {
            Constraint::None => "anything".into(),
            Constraint::Positive => "greater than 0".into(),
            Constraint::NonNegative => "at least 0".into(),
            Constraint::Within(low, high) => format!("from {low} to {high}"),
            Constraint::DegreesBetween(low, high) => format!("between {low}deg and {high}deg"),
            Constraint::DegreesUpTo(high) => format!("more than 0deg and at most {high}deg"),
            Constraint::DegreesBelow(high) => format!("at least 0deg and less than {high}deg"),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Param {
    pub name: &'static str,
    pub ty: Type,
    pub default: Default,
    pub constraint: Constraint,
    pub doc: &'static str,
}

impl Param {
    pub fn new(name: &'static str, ty: Type, doc: &'static str) -> Param {
        Param { name, ty, default: Default::Required, constraint: Constraint::None, doc }
    }

    pub fn optional(mut self) -> Param {
        self.default = Default::Optional;
        self
    }

    pub fn default_value(mut self, text: impl Into<String>, value: Value) -> Param {
        self.default = Default::Value { text: text.into(), value };
        self
    }

    pub fn float(self, value: f64) -> Param {
        self.default_value(value.to_string(), Value::Float(value))
    }

    pub fn int(self, value: i64) -> Param {
        self.default_value(value.to_string(), Value::Int(value))
    }

    pub fn bool(self, value: bool) -> Param {
        self.default_value(value.to_string(), Value::Bool(value))
    }

    pub fn vec3(self, value: [f64; 3]) -> Param {
        let text = format!("({}, {}, {})", value[0], value[1], value[2]);
        self.default_value(text, Value::Vec3(DVec3::from_array(value)))
    }

    pub fn degrees(self, value: f64) -> Param {
        self.default_value(format!("{value}deg"), Value::Float(value.to_radians()))
    }

    pub fn positive(mut self) -> Param {
        self.constraint = Constraint::Positive;
        self
    }

    pub fn non_negative(mut self) -> Param {
        self.constraint = Constraint::NonNegative;
        self
    }

    pub fn within(mut self, low: f64, high: f64) -> Param {
        self.constraint = Constraint::Within(low, high);
        self
    }

    pub fn degrees_between(mut self, low: f64, high: f64) -> Param {
        self.constraint = Constraint::DegreesBetween(low, high);
        self
    }

    pub fn degrees_up_to(mut self, high: f64) -> Param {
        self.constraint = Constraint::DegreesUpTo(high);
        self
    }

    pub fn degrees_below(mut self, high: f64) -> Param {
        self.constraint = Constraint::DegreesBelow(high);
        self
    }
}
