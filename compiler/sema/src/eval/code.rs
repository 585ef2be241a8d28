//! Running [`Code`].

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::{Eval, GlobalState, MAX_DEPTH, Machine, is_varying, limit};
use crate::code::{Arm, Code, Coercion, Entry, For, GlobalId, Site};
use crate::registry::BuiltinId;
use crate::types::SpectrumKind;
use crate::value::{Closure, Value};

impl Machine<'_> {
    /// Runs code that stands on its own, in a frame of its own.
    pub fn run_entry(&mut self, entry: &Entry) -> Eval {
        let frame = self.enter(entry.slots, None);
        let result = self.eval(&entry.code);
        self.leave(frame);
        result
    }

    pub(super) fn eval(&mut self, code: &Code) -> Eval {
        match code {
            Code::Const(value) => Ok(value.clone()),
            Code::Local(slot) => Ok(self.stack[self.base + *slot as usize].clone()),
            Code::Captured(i) => Ok(self.captured(*i)),
            Code::This => Ok(self.this()),
            Code::Global(id, span) => self.global(*id, *span),
            other => self.nested(other),
        }
    }

    /// What may recurse deeply is counted here.
    fn nested(&mut self, code: &Code) -> Eval {
        self.depth += 1;
        let result = self.eval_nested(code);
        self.depth -= 1;
        result
    }

    fn eval_nested(&mut self, code: &Code) -> Eval {
        match code {
            Code::And(left, right) => Ok(Value::Bool(self.eval(left)?.as_bool() && self.eval(right)?.as_bool())),
            Code::Or(left, right) => Ok(Value::Bool(self.eval(left)?.as_bool() || self.eval(right)?.as_bool())),
            Code::Field(base, i) => Ok(self.eval_field(base, *i)?),
            Code::Binary { op, left, right, span } => {
                let left = self.eval(left)?;
                let right = self.eval(right)?;
                self.binary(*op, &left, &right, *span)
            }
            Code::Block(stmts, value) => {
                for stmt in stmts {
                    self.eval(stmt)?;
                }
                self.eval(value)
            }
            Code::If { condition, then, otherwise } => {
                if self.eval(condition)?.as_bool() {
                    self.eval(then)
                } else {
                    self.eval(otherwise)
                }
            }
            Code::List(elements) => {
                let list = self.eval_all(elements)?;
                Ok(Value::list(list))
            }
            Code::Tuple(elements) => Ok(Value::Tuple(self.eval_all(elements)?.into())),
            Code::Index { base, index, span } => self.index(base, index, *span),
            Code::Range { start, end, inclusive, span } => {
                let (start, end) = self.range_bounds(start, end, *inclusive)?;
                self.spend_elements(usize::try_from(end.saturating_sub(start)).unwrap_or(0), *span)?;
                Ok(Value::list((start..end).map(Value::Int).collect()))
            }
            Code::Unary { op, operand, span } => {
                let operand = self.eval(operand)?;
                self.unary(*op, &operand, *span)
            }
            Code::Coerce { coercion, value, span } => {
                let value = self.eval(value)?;
                self.coerce(coercion, value, *span)
            }
            Code::Match { subject, arms, span } => self.eval_match(subject, arms, *span),
            Code::For(looping) => self.eval_for(looping),
            Code::Let { pattern, value } => {
                let value = self.eval(value)?;
                self.bind(pattern, &value);
                Ok(Value::unit())
            }
            Code::Closure { function, captures } => {
                let captures = self.eval_all(captures)?.into();
                Ok(Value::Fn(Arc::new(Closure::User { function: *function, captures })))
            }
            Code::CallFn { function, args, span } => {
                let args = self.eval_all(args)?;
                self.call_function(*function, args, None, *span)
            }
            Code::CallBuiltin { builtin, args, site } => self.eval_builtin_call(*builtin, args, site),
            Code::CallValue { callee, args, span } => {
                let callee = self.eval(callee)?;
                let args = self.eval_all(args)?;
                self.call_value(&callee, args, *span)
            }
            Code::Emit(value, span) => {
                let value = self.eval(value)?;
                self.step(*span)?;
                self.collect(value, *span)?;
                Ok(Value::unit())
            }
            Code::Error => panic!("a program with errors is evaluated"),
            Code::Const(_) | Code::Local(_) | Code::Captured(_) | Code::This | Code::Global(..) => self.eval(code),
        }
    }

    fn eval_all(&mut self, codes: &[Code]) -> Eval<Vec<Value>> {
        self.elements += codes.len() as u64 / 4;
        codes.iter().map(|code| self.eval(code)).collect()
    }

    /// Apart, so that its buffer of arguments weighs on the native stack of builtin calls alone.
    #[inline(never)]
    fn eval_builtin_call(&mut self, builtin: BuiltinId, args: &[Code], site: &Site) -> Eval {
        self.step(site.span)?;
        let mut values: SmallVec<[Value; 6]> = SmallVec::new();
        for code in args {
            let value = self.eval(code)?;
            values.push(value);
        }
        self.call_builtin(builtin, &values, site)
    }

    fn eval_field(&mut self, base: &Code, i: u32) -> Eval {
        Ok(match self.eval(base)? {
            Value::Vec2(v) => Value::Float(v[i as usize]),
            Value::Vec3(v) => Value::Float(v[i as usize]),
            Value::Texture(texture) => self.scalar_value(texture.component(i as usize)),
            other => other.as_tuple()[i as usize].clone(),
        })
    }

    fn captured(&self, i: u32) -> Value {
        match self.closure.as_deref() {
            Some(Closure::User { captures, .. }) => captures[i as usize].clone(),
            other => panic!("a capture outside of a closure: {other:?}"),
        }
    }

    fn this(&self) -> Value {
        self.closure.clone().map_or_else(|| panic!("no running closure"), Value::Fn)
    }

    fn index(&mut self, base: &Code, index: &Code, span: Span) -> Eval {
        let base = self.eval(base)?;
        let index = self.eval(index)?.as_int();
        let list = base.as_list();
        let at = usize::try_from(index).ok().and_then(|i| list.get(i));
        at.cloned().ok_or_else(|| {
            let message = format!("index {index} is outside of a list of {}", list.len());
            let failure = Diagnostic::new(codes::INDEX, message).label(span, "this index");
            Box::new(failure.help(match list.len() {
                0 => "the list is empty".to_owned(),
                n => format!("indices go from 0 to {}", n - 1),
            }))
        })
    }

    /// As a half-open range.
    fn range_bounds(&mut self, start: &Code, end: &Code, inclusive: bool) -> Eval<(i64, i64)> {
        let start = self.eval(start)?.as_int();
        let end = self.eval(end)?.as_int();
        Ok((start, if inclusive { end.saturating_add(1) } else { end }))
    }

    pub(super) fn global(&mut self, id: GlobalId, span: Span) -> Eval {
        let i = id.0 as usize;
        match &self.globals[i] {
            GlobalState::Known(value) => return Ok(value.clone()),
            GlobalState::Running => {
                let message = format!("`{}` depends on its own value", self.program.globals[i].name);
                return Err(Box::new(Diagnostic::new(codes::CYCLIC_DEFINITION, message).label(span, "needed here")));
            }
            GlobalState::Unknown => {}
        }
        self.globals[i] = GlobalState::Running;
        let value = self.eval_global(id)?;
        self.globals[i] = GlobalState::Known(value.clone());
        Ok(value)
    }

    fn eval_global(&mut self, id: GlobalId) -> Eval {
        if let Some(value) = self.overrides.get(&id) {
            return Ok(value.clone());
        }
        let program = self.program;
        let global = &program.globals[id.0 as usize];
        if let Some((whole, path)) = &global.part {
            let whole = self.global(*whole, global.entry.span)?;
            return Ok(path.iter().fold(whole, |value, i| value.as_tuple()[*i as usize].clone()));
        }
        self.deepen(global.entry.span)?;
        let entered = self.enter_std(global.is_std, global.entry.span);
        let result = self.run_entry(&global.entry);
        self.leave_std(entered);
        result
    }

    fn eval_match(&mut self, subject: &Code, arms: &[Arm], span: Span) -> Eval {
        let subject = self.eval(subject)?;
        for arm in arms {
            if self.matches(&arm.pattern, &subject) {
                self.bind(&arm.pattern, &subject);
                let taken = match &arm.guard {
                    Some(guard) => self.eval(guard)?.as_bool(),
                    None => true,
                };
                if taken {
                    return self.eval(&arm.value);
                }
            }
        }
        Err(Box::new(Diagnostic::new(codes::NOT_EXHAUSTIVE, "no arm of this `match` fits").label(span, "here")))
    }

    fn eval_for(&mut self, looping: &For) -> Eval {
        let mut kept = Vec::new();
        // Ranges are walked without being made.
        if let Code::Range { start, end, inclusive, .. } = &looping.list {
            let (start, end) = self.range_bounds(start, end, *inclusive)?;
            for i in start..end {
                self.turn(looping, &Value::Int(i), &mut kept)?;
            }
        } else {
            let list = self.eval(&looping.list)?;
            for element in list.as_list().iter() {
                self.turn(looping, element, &mut kept)?;
            }
        }
        Ok(if looping.keep { Value::list(kept) } else { Value::unit() })
    }

    fn turn(&mut self, looping: &For, element: &Value, kept: &mut Vec<Value>) -> Eval<()> {
        self.step(looping.span)?;
        self.bind(&looping.pattern, element);
        if let Some(filter) = &looping.filter
            && !self.eval(filter)?.as_bool()
        {
            return Ok(());
        }
        let value = self.eval(&looping.body)?;
        if looping.keep {
            self.spend_elements(1, looping.span)?;
            kept.push(value);
        }
        Ok(())
    }

    fn coerce(&mut self, coercion: &Coercion, value: Value, span: Span) -> Eval {
        Ok(match coercion {
            Coercion::IntToFloat => Value::Float(value.as_float()),
            Coercion::TupleToVec => {
                let t = value.as_tuple();
                match t.len() {
                    2 => Value::Vec2(DVec2::new(t[0].as_float(), t[1].as_float())),
                    _ => Value::Vec3(DVec3::new(t[0].as_float(), t[1].as_float(), t[2].as_float())),
                }
            }
            // Greys that vary.
            Coercion::Constant(_) if is_varying(&value) => value,
            Coercion::Constant(kind) => {
                let x = value.as_float();
                let low_enough = if *kind == SpectrumKind::RefractiveIndex { x <= 0.0 } else { x < 0.0 };
                if low_enough {
                    let what = crate::types::Type::Spectrum(*kind);
                    let message = format!("{} must not be {x}", what.with_article().replace('`', ""));
                    return Err(Box::new(Diagnostic::new(codes::OUT_OF_RANGE, message).label(span, "this number")));
                }
                Value::spectrum(arsc_ir::Spectrum::Constant(x))
            }
            Coercion::List(element) => {
                let list = value.as_list();
                self.spend_elements(list.len(), span)?;
                let all: Eval<Vec<Value>> = list.iter().map(|x| self.coerce(element, x.clone(), span)).collect();
                Value::list(all?)
            }
            Coercion::Tuple(parts) => {
                let mut all = Vec::with_capacity(parts.len());
                for (part, x) in parts.iter().zip(value.as_tuple().iter()) {
                    all.push(self.converted(part.as_ref(), x.clone(), span)?);
                }
                Value::Tuple(all.into())
            }
            Coercion::Fn(parts) => {
                let inner = value.as_fn().clone();
                Value::Fn(Arc::new(Closure::Converted { inner, parts: parts.clone().into() }))
            }
        })
    }

    pub(super) fn converted(&mut self, coercion: Option<&Coercion>, value: Value, span: Span) -> Eval {
        match coercion {
            Some(coercion) => self.coerce(coercion, value, span),
            None => Ok(value),
        }
    }

    /// Bounds the native stack where definitions and calls nest.
    pub(super) fn deepen(&self, span: Span) -> Eval<()> {
        if self.depth > MAX_DEPTH {
            return Err(limit(span, "nested expressions", MAX_DEPTH as u64, "split this into smaller functions"));
        }
        Ok(())
    }
}
