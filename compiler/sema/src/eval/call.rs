//! Calls: frames, defaults, constraints, provenance.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};

use super::{Eval, Machine};
use crate::code::{FnId, Site};
use crate::registry::{BuiltinId, Constraint, Default, Implementation, Registry};
use crate::value::{Closure, Value};

/// What a callee's frame replaces.
pub(super) struct Frame {
    base: usize,
    closure: Option<Arc<Closure>>,
}

/// What entering a std module replaces.
pub(super) struct StdFrame {
    caller: Option<Span>,
    in_std: bool,
}

/// How many calls are shown along with a failure.
const SHOWN_CALLS: usize = 3;

impl Machine<'_> {
    pub(super) fn enter(&mut self, slots: usize, closure: Option<Arc<Closure>>) -> Frame {
        let frame = Frame { base: self.base, closure: std::mem::replace(&mut self.closure, closure) };
        self.base = self.stack.len();
        self.stack.resize(self.base + slots, Value::Missing);
        frame
    }

    pub(super) fn leave(&mut self, frame: Frame) {
        self.stack.truncate(self.base);
        self.base = frame.base;
        self.closure = frame.closure;
    }

    pub(super) fn enter_std(&mut self, callee_is_std: bool, span: Span) -> StdFrame {
        let frame = StdFrame { caller: self.std_caller, in_std: self.in_std };
        if callee_is_std && !self.in_std {
            self.std_caller = Some(span);
        } else if !callee_is_std {
            self.std_caller = None;
        }
        self.in_std = callee_is_std;
        frame
    }

    pub(super) fn leave_std(&mut self, frame: StdFrame) {
        self.std_caller = frame.caller;
        self.in_std = frame.in_std;
    }

    /// Calls a function value with as many arguments as its type says.
    pub fn call_value(&mut self, callee: &Value, mut args: Vec<Value>, span: Span) -> Eval {
        let closure = callee.as_fn().clone();
        match &*closure {
            Closure::User { function, .. } => self.call_function(*function, args, Some(closure.clone()), span),
            Closure::Converted { inner, parts } => {
                self.deepen(span)?;
                for (arg, part) in args.iter_mut().zip(parts.iter()) {
                    *arg = self.converted(part.as_ref(), arg.clone(), span)?;
                }
                let result = self.call_value(&Value::Fn(inner.clone()), args, span)?;
                self.converted(parts.last().and_then(Option::as_ref), result, span)
            }
            Closure::Builtin(id) => {
                let params = &Registry::get().builtin(*id).params;
                args.extend(params[args.len()..].iter().map(|param| default_value(&param.default)));
                let site = Site { span, args: vec![span; params.len()].into() };
                self.step(span)?;
                self.call_builtin(*id, &args, &site)
            }
        }
    }

    pub(super) fn call_function(
        &mut self,
        id: FnId,
        args: Vec<Value>,
        closure: Option<Arc<Closure>>,
        span: Span,
    ) -> Eval {
        self.step(span)?;
        let program = self.program;
        let function = &program.functions[id.0 as usize];
        if self.calls >= self.limits.recursion {
            let message = format!("calls of `{}` nest more than {} deep", function.name, self.limits.recursion);
            let failure = Diagnostic::new(codes::RECURSION, message).label(span, "this call");
            return Err(Box::new(failure.help("does the recursion end?")));
        }
        self.deepen(span)?;
        self.calls += 1;
        let frame = self.enter(function.slots, closure);
        let std_frame = self.enter_std(function.is_std, span);
        for (slot, arg) in args.into_iter().enumerate() {
            self.stack[self.base + slot] = arg;
        }
        let result = self.fill_defaults(id).and_then(|()| self.eval(&function.body));
        self.leave_std(std_frame);
        self.leave(frame);
        self.calls -= 1;
        result.map_err(|failure| with_call(failure, &function.name, span))
    }

    fn fill_defaults(&mut self, id: FnId) -> Eval<()> {
        let program = self.program;
        for (slot, default) in program.functions[id.0 as usize].defaults.iter().enumerate() {
            if let Some(default) = default
                && !self.stack[self.base + slot].is_given()
            {
                let value = self.eval(default)?;
                self.stack[self.base + slot] = value;
            }
        }
        Ok(())
    }

    pub(super) fn call_builtin(&mut self, id: BuiltinId, args: &[Value], site: &Site) -> Eval {
        let builtin = Registry::get().builtin(id);
        for (i, param) in builtin.params.iter().enumerate() {
            if param.constraint != Constraint::None
                && let Some(wanted) = param.constraint.violation(&args[i])
            {
                let message = format!("`{}` of `{}` must be {wanted}", param.name, builtin.name);
                return Err(site.fail_arg(
                    i,
                    codes::OUT_OF_RANGE,
                    message,
                    format!("this is {}", shown(&args[i], &param.ty)),
                ));
            }
        }
        let Implementation::Now(run) = builtin.implementation else {
            panic!("`{}` is called but not implemented", builtin.name)
        };
        let value = run(self, args, site)?;
        if is_finite(&value) {
            return Ok(value);
        }
        let message = format!("the result of `{}` is not finite", builtin.name);
        Err(Box::new(Diagnostic::new(codes::ARITHMETIC, message).label(site.span, "not a finite number")))
    }
}

pub fn default_value(default: &Default) -> Value {
    match default {
        Default::Value { value, .. } => value.clone(),
        Default::Required | Default::Optional => Value::Missing,
    }
}

fn is_finite(value: &Value) -> bool {
    match value {
        Value::Float(x) => x.is_finite(),
        Value::Vec2(v) => v.is_finite(),
        Value::Vec3(v) => v.is_finite(),
        _ => true,
    }
}

/// A value in the unit of its type.
pub(super) fn shown(value: &Value, ty: &crate::types::Type) -> String {
    use crate::types::Type;
    match (value, ty) {
        (Value::Float(x), Type::Angle) => format!("{}deg", (x.to_degrees() * 1e6).round() / 1e6),
        (Value::Float(x), Type::Wavelength) => format!("{x}nm"),
        (Value::Float(x), Type::Temperature) => format!("{x}K"),
        (Value::Float(x), _) => x.to_string(),
        (Value::Int(i), _) => i.to_string(),
        (Value::Vec2(v), _) => format!("({}, {})", v.x, v.y),
        (Value::Vec3(v), _) => format!("({}, {}, {})", v.x, v.y, v.z),
        (Value::Str(s), _) => format!("\"{s}\""),
        (Value::Bool(b), _) => b.to_string(),
        (Value::Tuple(t), _) => {
            let parts: Vec<String> = t.iter().map(|x| shown(x, &Type::Error)).collect();
            format!("({})", parts.join(", "))
        }
        _ => "something else".into(),
    }
}

/// Adds the call that led to a failure, for the first few.
fn with_call(mut failure: Box<Diagnostic>, name: &str, span: Span) -> Box<Diagnostic> {
    let known = failure.labels.iter().any(|label| label.span == span);
    let name = if name.is_empty() { "the function" } else { name };
    if failure.labels.len() <= SHOWN_CALLS && !known {
        *failure =
            failure.clone().label(span, format!("in a call of `{name}`").replace("`the function`", "the function"));
    }
    failure
}
