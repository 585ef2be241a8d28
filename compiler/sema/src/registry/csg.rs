//! Boolean operations as functions; the operators `|`, `&` and `-` do the same.

use arsc_diagnostics::Span;
use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{NodeId, NodeKind};

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Class;
use crate::types::Type::{self, Solid};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let solids = |name, doc| Param::new(name, Type::AnyOf(Class::SolidOperand), doc);
    vec![
        Builtin::new("union", "Points in any of the operands. Lights and environments may be among them.")
            .variadic(Param::new("operands", Type::AnyOf(Class::UnionOperand), "solids, lights, or lists of them"))
            .runs(Solid, |m, args, site| boolean(m, &args[..1], site, NodeKind::Union)),
        Builtin::new("intersection", "Points in all of the operands.")
            .variadic(solids("operands", "solids or lists of solids"))
            .runs(Solid, |m, args, site| boolean(m, &args[..1], site, NodeKind::Intersection)),
        Builtin::new("difference", "Points in the first operand and in none of the others.")
            .param(Param::new("from", Solid, "what is cut"))
            .variadic(solids("cut", "solids or lists of solids"))
            .runs(Solid, |m, args, site| {
                let mut cut = Vec::new();
                flatten(m, &args[1], &mut cut, site.span)?;
                if cut.is_empty() {
                    return Ok(args[0].clone());
                }
                cut.insert(0, args[0].as_node());
                m.node(NodeKind::Difference(cut), site.span).map(Value::Node)
            }),
    ]
}

/// Appends the nodes of nested lists, in order.
pub fn flatten(m: &mut Machine<'_>, value: &Value, nodes: &mut Vec<NodeId>, span: Span) -> Eval<()> {
    match value {
        Value::List(list) => {
            m.spend_elements(list.len(), span)?;
            list.iter().try_for_each(|element| flatten(m, element, nodes, span))
        }
        other => {
            nodes.push(other.as_node());
            Ok(())
        }
    }
}

fn boolean(m: &mut Machine<'_>, args: &[Value], site: &Site, kind: fn(Vec<NodeId>) -> NodeKind) -> Eval {
    let mut operands = Vec::new();
    args.iter().try_for_each(|arg| flatten(m, arg, &mut operands, site.span))?;
    match operands.len() {
        0 => Err(Box::new(site.fail(codes::EMPTY_LIST, "a Boolean operation needs at least one operand"))),
        1 => Ok(Value::Node(operands[0])),
        _ => m.node(kind(operands), site.span).map(Value::Node),
    }
}
