//! Values of params: given from outside, and held to their ranges.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};

use super::call::shown;
use super::{Eval, Machine};
use crate::code::{Allowed, Entry, GlobalId};
use crate::types::Type;

impl Machine<'_> {
    /// Takes the given values, then checks those of all params. Every failure is returned.
    pub fn set_params(&mut self, settings: &[(GlobalId, Entry)]) -> Vec<Diagnostic> {
        let mut failures = Vec::new();
        for (id, entry) in settings {
            match self.run_entry(entry) {
                Ok(value) => {
                    self.overrides.insert(*id, value);
                }
                Err(failure) => failures.push(*failure),
            }
        }
        let program = self.program;
        for (i, global) in program.globals.iter().enumerate() {
            let Some(allowed) = &global.allowed else { continue };
            let id = GlobalId(i as u32);
            let set_at = settings.iter().find(|(set, _)| *set == id).map(|(_, entry)| entry.span);
            if let Err(failure) = self.check_param(id, allowed, set_at.unwrap_or(global.entry.span)) {
                failures.push(*failure);
            }
        }
        failures
    }

    fn check_param(&mut self, id: GlobalId, allowed: &Allowed, span: Span) -> Eval<()> {
        let name = &self.program.globals[id.0 as usize].name;
        let value = self.global(id, span)?;
        let wanted = match allowed {
            Allowed::Range { start, end, inclusive } => {
                let (low, high) = (self.run_entry(start)?, self.run_entry(end)?);
                let order = crate::registry::compare;
                let below = order(&value, &high).is_lt() || *inclusive && order(&value, &high).is_eq();
                if order(&value, &low).is_ge() && below {
                    return Ok(());
                }
                let dots = if *inclusive { "..=" } else { ".." };
                format!("in {}{dots}{}", shown(&low, &Type::Float), shown(&high, &Type::Float))
            }
            Allowed::OneOf(entry) => {
                let list = self.run_entry(entry)?;
                for one in list.as_list().iter() {
                    if self.equal(one, &value, span)? {
                        return Ok(());
                    }
                }
                let all: Vec<String> = list.as_list().iter().map(|one| shown(one, &Type::Float)).collect();
                format!("one of {}", all.join(", "))
            }
        };
        let message = format!("the param `{name}` must be {wanted}");
        let label = format!("this is {}", shown(&value, &Type::Float));
        Err(Box::new(Diagnostic::new(codes::PARAM_VALUE, message).label(span, label)))
    }
}
