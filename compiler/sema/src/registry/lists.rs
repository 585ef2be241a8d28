//! Lists. Functions that take a function call it in order, from the first element on.

use std::cmp::Ordering;

use arsc_diagnostics::codes::sema as codes;

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine, add_values, scale_value};
use crate::types::Class;
use crate::types::Type::{self, Bool, Float, Int, Var};
use crate::value::Value;

fn list_of(i: u8) -> Type {
    Type::list(Var(i))
}

fn on_list(name: &'static str, doc: &'static str) -> Builtin {
    Builtin::new(name, doc).var(Class::Any).param(Param::new("list", list_of(0), "list"))
}

fn function(params: &[Type], result: Type) -> Param {
    Param::new("f", Type::function(params.to_vec(), result), "function")
}

pub fn builtins() -> Vec<Builtin> {
    let mut list = higher();
    list.extend(shape());
    list.extend(numbers());
    list
}

fn higher() -> Vec<Builtin> {
    vec![
        on_list("map", "The values of `f` at each element.").var(Class::Any).param(function(&[Var(0)], Var(1))).runs(
            list_of(1),
            |m, args, site| {
                let list = args[0].as_list().clone();
                m.spend_elements(list.len(), site.span)?;
                let mapped: Eval<Vec<Value>> =
                    list.iter().map(|element| m.call_value(&args[1], vec![element.clone()], site.span)).collect();
                mapped.map(Value::list)
            },
        ),
        on_list("filter", "The elements for which `f` is true.").param(function(&[Var(0)], Bool)).runs(
            list_of(0),
            |m, args, site| {
                let list = args[0].as_list().clone();
                m.spend_elements(list.len(), site.span)?;
                let mut kept = Vec::new();
                for element in list.iter() {
                    if m.call_value(&args[1], vec![element.clone()], site.span)?.as_bool() {
                        kept.push(element.clone());
                    }
                }
                Ok(Value::list(kept))
            },
        ),
        on_list("fold", "`f(… f(f(start, a), b) …, z)` over the elements a, b … z.")
            .var(Class::Any)
            .param(Param::new("start", Var(1), "result for the empty list"))
            .param(function(&[Var(1), Var(0)], Var(1)))
            .runs(Var(1), |m, args, site| {
                let list = args[0].as_list().clone();
                let start = args[1].clone();
                list.iter().try_fold(start, |so_far, x| m.call_value(&args[2], vec![so_far, x.clone()], site.span))
            }),
        on_list("any", "Whether `f` is true for some element.")
            .param(function(&[Var(0)], Bool))
            .runs(Bool, |m, args, site| quantify(m, args, site, true)),
        on_list("all", "Whether `f` is true for every element.")
            .param(function(&[Var(0)], Bool))
            .runs(Bool, |m, args, site| quantify(m, args, site, false)),
    ]
}

fn quantify(m: &mut Machine<'_>, args: &[Value], site: &Site, wanted: bool) -> Eval {
    for element in args[0].as_list().clone().iter() {
        if m.call_value(&args[1], vec![element.clone()], site.span)?.as_bool() == wanted {
            return Ok(Value::Bool(wanted));
        }
    }
    Ok(Value::Bool(!wanted))
}

fn shape() -> Vec<Builtin> {
    vec![
        on_list("len", "Number of elements.").runs(Int, |_, args, _| Ok(Value::Int(args[0].as_list().len() as i64))),
        on_list("enumerate", "Pairs of index, from 0, and element.").runs(
            Type::list(Type::tuple([Int, Var(0)])),
            |m, args, site| {
                let list = args[0].as_list();
                m.spend_elements(3 * list.len(), site.span)?;
                let pair = |(i, x): (usize, &Value)| Value::Tuple([Value::Int(i as i64), x.clone()].into());
                Ok(Value::list(list.iter().enumerate().map(pair).collect()))
            },
        ),
        on_list("zip", "Pairs of elements of two lists, as many as the shorter one has.")
            .var(Class::Any)
            .param(Param::new("other", list_of(1), "second list"))
            .runs(Type::list(Type::tuple([Var(0), Var(1)])), |m, args, site| {
                let (a, b) = (args[0].as_list(), args[1].as_list());
                m.spend_elements(3 * a.len().min(b.len()), site.span)?;
                let pair = |(x, y): (&Value, &Value)| Value::Tuple([x.clone(), y.clone()].into());
                Ok(Value::list(a.iter().zip(b.iter()).map(pair).collect()))
            }),
        on_list("reverse", "The elements from last to first.").runs(list_of(0), |m, args, site| {
            let list = args[0].as_list();
            m.spend_elements(list.len(), site.span)?;
            Ok(Value::list(list.iter().rev().cloned().collect()))
        }),
        Builtin::new("concat", "The elements of all lists, one after the other.")
            .var(Class::Any)
            .variadic(Param::new("lists", list_of(0), "lists"))
            .runs(list_of(0), |m, args, site| join_lists(m, args[0].as_list(), site)),
        Builtin::new("flatten", "The elements of a list of lists, one after the other.")
            .var(Class::Any)
            .param(Param::new("lists", Type::list(list_of(0)), "list of lists"))
            .runs(list_of(0), |m, args, site| join_lists(m, args[0].as_list(), site)),
        on_list("slice", "The elements from index `start` up to but not including `end`.")
            .param(Param::new("start", Int, "first index").non_negative())
            .param(Param::new("end", Int, "index after the last; the length if not given").optional().non_negative())
            .runs(list_of(0), |m, args, site| {
                let list = args[0].as_list();
                let end = if args[2].is_given() { args[2].as_int() as usize } else { list.len() };
                let start = args[1].as_int() as usize;
                if start > end || end > list.len() {
                    let message = format!("the slice {start}..{end} is not within a list of {}", list.len());
                    return Err(Box::new(site.fail(codes::INDEX, message)));
                }
                m.spend_elements(end - start, site.span)?;
                Ok(Value::list(list[start..end].to_vec()))
            }),
    ]
}

fn join_lists(m: &mut Machine<'_>, lists: &[Value], site: &Site) -> Eval {
    m.spend_elements(lists.iter().map(|list| list.as_list().len()).sum(), site.span)?;
    Ok(Value::list(lists.iter().flat_map(|list| list.as_list().iter().cloned()).collect()))
}

fn numbers() -> Vec<Builtin> {
    let ordered = |name, doc| {
        Builtin::new(name, doc).var(Class::Quantity).param(Param::new("list", list_of(0), "list of one kind"))
    };
    vec![
        Builtin::new("range", "The ints from `start` up to but not including `end`, by `step`.")
            .param(Param::new("start", Int, "first"))
            .param(Param::new("end", Int, "limit"))
            .param(Param::new("step", Int, "difference; not 0").int(1))
            .runs(Type::list(Int), range),
        Builtin::new("linspace", "`n` evenly spaced numbers from `start` to `end`, both included.")
            .var(Class::Continuous)
            .param(Param::new("start", Var(0), "first"))
            .param(Param::new("end", Var(0), "last"))
            .param(Param::new("n", Int, "how many").non_negative())
            .runs(list_of(0), linspace),
        Builtin::new("sum", "The sum of the elements, at least one.")
            .var(Class::Linear)
            .param(Param::new("list", list_of(0), "list"))
            .runs(Var(0), |_, args, site| {
                let list = args[0].as_list();
                let Some((first, rest)) = list.split_first() else {
                    return Err(empty(site, "the sum of an empty list has no value"));
                };
                rest.iter().try_fold(first.clone(), |sum, x| add_values(&sum, x, site.span))
            }),
        Builtin::new("product", "The product of the elements; 1 for an empty list.")
            .var(Class::Number)
            .param(Param::new("list", list_of(0), "list of numbers"))
            .runs(Float, |_, args, site| {
                let product: f64 = args[0].as_list().iter().map(Value::as_float).product();
                crate::eval::finite(product, "this product", site.span).map(Value::Float)
            }),
        ordered("sort", "The elements from smallest to largest.").runs(list_of(0), |m, args, site| {
            let mut sorted = args[0].as_list().to_vec();
            m.spend_elements(sorted.len(), site.span)?;
            sorted.sort_by(compare);
            Ok(Value::list(sorted))
        }),
        ordered("minimum", "The smallest element.").runs(Var(0), |_, args, site| {
            let least = args[0].as_list().iter().min_by(|a, b| compare(a, b)).cloned();
            least.ok_or_else(|| empty(site, "an empty list has no smallest element"))
        }),
        ordered("maximum", "The largest element.").runs(Var(0), |_, args, site| {
            let largest = args[0].as_list().iter().max_by(|a, b| compare(a, b)).cloned();
            largest.ok_or_else(|| empty(site, "an empty list has no largest element"))
        }),
    ]
}

fn empty(site: &Site, message: &str) -> Box<arsc_diagnostics::Diagnostic> {
    site.fail_arg(0, codes::EMPTY_LIST, message, "this list is empty")
}

/// Order of two numbers of one kind; both are finite.
pub fn compare(a: &Value, b: &Value) -> Ordering {
    match (a, b) {
        (Value::Int(a), Value::Int(b)) => a.cmp(b),
        (a, b) => a.as_float().total_cmp(&b.as_float()),
    }
}

fn range(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (start, end, step) = (args[0].as_int(), args[1].as_int(), args[2].as_int());
    if step == 0 {
        return Err(site.fail_arg(2, codes::OUT_OF_RANGE, "the step of a range must not be 0", "this is 0"));
    }
    let (start, end, step) = (i128::from(start), i128::from(end), i128::from(step));
    let count = ((end - start + step - step.signum()) / step).max(0);
    m.spend_elements(usize::try_from(count).unwrap_or(usize::MAX), site.span)?;
    Ok(Value::list((0..count).map(|i| Value::Int((start + i * step) as i64)).collect()))
}

fn linspace(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let n = args[2].as_int();
    m.spend_elements(n as usize, site.span)?;
    let last = (n - 1).max(1) as f64;
    let at = |i: i64| {
        let t = i as f64 / last;
        let (start, end) = (scale_value(&args[0], 1.0 - t, site.span)?, scale_value(&args[1], t, site.span)?);
        add_values(&start, &end, site.span)
    };
    let values: Eval<Vec<Value>> = (0..n).map(at).collect();
    values.map(Value::list)
}
