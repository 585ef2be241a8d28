//! Matching and binding.

use super::Machine;
use crate::code::Pat;
use crate::value::Value;

impl Machine<'_> {
    pub(super) fn matches(&self, pattern: &Pat, value: &Value) -> bool {
        match pattern {
            Pat::Any | Pat::Bind(_) => true,
            Pat::Bool(b) => value.as_bool() == *b,
            Pat::Int(i) => value.as_int() == *i,
            Pat::Float(x) => value.as_float() == *x,
            Pat::Str(text) => **value.as_str() == **text,
            Pat::IntRange { start, end, inclusive } => {
                let i = value.as_int();
                i >= *start && (i < *end || *inclusive && i == *end)
            }
            Pat::FloatRange { start, end, inclusive } => {
                let x = value.as_float();
                x >= *start && (x < *end || *inclusive && x == *end)
            }
            Pat::Tuple(parts) => {
                parts.iter().zip(value.as_tuple().iter()).all(|(part, value)| self.matches(part, value))
            }
            Pat::Error => false,
            Pat::Either(alternatives) => alternatives.iter().any(|pattern| self.matches(pattern, value)),
        }
    }

    /// Fills the slots of a pattern that fits.
    pub(super) fn bind(&mut self, pattern: &Pat, value: &Value) {
        match pattern {
            Pat::Bind(slot) => self.stack[self.base + *slot as usize] = value.clone(),
            Pat::Tuple(parts) => {
                let elements = value.as_tuple().clone();
                parts.iter().zip(elements.iter()).for_each(|(part, value)| self.bind(part, value));
            }
            _ => {}
        }
    }
}
