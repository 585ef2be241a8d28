//! Which argument goes to which parameter.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span, closest};
use arsc_syntax::ast;

use super::Checker;
use super::names::with_suggestion;

/// One argument: what was piped in comes first.
#[derive(Clone, Copy)]
pub(super) struct Given<'e> {
    pub name: Option<&'e ast::Ident>,
    pub value: &'e ast::Expr,
}

/// A parameter as far as matching is concerned.
pub(super) struct Slot<'s> {
    pub name: &'s str,
    pub required: bool,
}

/// Arguments by parameter; several only for the last one of a variadic function.
pub(super) struct Matched<'e> {
    pub by_param: Vec<Vec<Given<'e>>>,
}

pub(super) fn given<'e>(piped: Option<&'e ast::Expr>, args: &'e [ast::Arg]) -> Vec<Given<'e>> {
    let piped = piped.map(|value| Given { name: None, value });
    piped.into_iter().chain(args.iter().map(|arg| Given { name: arg.name.as_ref(), value: &arg.value })).collect()
}

impl Checker<'_> {
    /// `None` if something was wrong; reported.
    pub(super) fn match_args<'e>(
        &mut self,
        function: &str,
        slots: &[Slot<'_>],
        variadic: bool,
        given: &[Given<'e>],
        span: Span,
    ) -> Option<Matched<'e>> {
        let mut by_param: Vec<Vec<Given<'e>>> = slots.iter().map(|_| Vec::new()).collect();
        let mut position = 0;
        let mut fine = true;
        for arg in given {
            let i = match arg.name {
                Some(name) => match slots.iter().position(|slot| slot.name == name.name) {
                    Some(i) => i,
                    None => {
                        self.unknown_argument(function, slots, name);
                        fine = false;
                        continue;
                    }
                },
                None => {
                    let i = position;
                    position += usize::from(!(variadic && i + 1 == slots.len()));
                    i
                }
            };
            if i >= slots.len() {
                self.too_many(function, slots.len(), given, arg.value.span);
                return None;
            }
            let many = variadic && i + 1 == slots.len();
            if !by_param[i].is_empty() && !many {
                let message = format!("`{}` of {function} is given twice", slots[i].name);
                let diagnostic = Diagnostic::new(codes::WRONG_ARGUMENTS, message).label(arg.value.span, "the second");
                self.report(diagnostic.label(by_param[i][0].value.span, "the first"));
                fine = false;
                continue;
            }
            by_param[i].push(*arg);
        }
        let missing: Vec<String> = slots
            .iter()
            .zip(&by_param)
            .filter(|(slot, args)| slot.required && args.is_empty())
            .map(|(slot, _)| format!("`{}`", slot.name))
            .collect();
        if !missing.is_empty() && fine {
            let message = format!("{function} needs {}", missing.join(" and "));
            self.error(codes::WRONG_ARGUMENTS, message, span, format!("{} is missing", missing.join(", ")));
            return None;
        }
        fine.then_some(Matched { by_param })
    }

    fn unknown_argument(&mut self, function: &str, slots: &[Slot<'_>], name: &ast::Ident) {
        let message = format!("{function} has no parameter `{}`", name.name);
        let diagnostic = Diagnostic::new(codes::WRONG_ARGUMENTS, message).label(name.span, "unknown parameter");
        let names: Vec<&str> = slots.iter().map(|slot| slot.name).collect();
        let near = closest(&name.name, names.iter().copied());
        self.report(match near {
            Some(_) => with_suggestion(diagnostic, name.span, near),
            None if names.is_empty() => diagnostic.help("it takes no arguments"),
            None => diagnostic.help(format!("it has: {}", names.join(", "))),
        });
    }

    fn too_many(&mut self, function: &str, takes: usize, given: &[Given<'_>], at: Span) {
        let positional = given.iter().filter(|arg| arg.name.is_none()).count();
        let plural = if takes == 1 { "" } else { "s" };
        let message = format!("{function} takes {takes} argument{plural}, but {positional} are given by position");
        self.error(codes::WRONG_ARGUMENTS, message, at, "one too many");
    }
}
