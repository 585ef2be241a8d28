//! The same solid or surface twice in one place.
//!
//! Found by giving equal trees (shapes, maps, operands; materials aside) one number, from the leaves up.

use arsc_diagnostics::{Diagnostic, Span, codes::geometry as codes};
use arsc_ir::{Leaf, NodeId, NodeKind};
use rustc_hash::{FxHashMap, FxHashSet};

use super::survey::Survey;

pub(super) fn lint(survey: &Survey, findings: &mut Vec<Diagnostic>) {
    let mut reported: FxHashSet<Span> = FxHashSet::default();
    for node in &survey.ir.nodes {
        let (NodeKind::Union(of) | NodeKind::Group(of)) = &node.kind else { continue };
        let mut first: FxHashMap<NodeId, NodeId> = FxHashMap::default();
        for &operand in of {
            let kind = survey.ir.kind(operand);
            let is_geometry = match kind {
                NodeKind::Leaf(leaf) => matches!(**leaf, Leaf::Solid { .. } | Leaf::Surface { .. }),
                NodeKind::Light(_) | NodeKind::Environment(_) | NodeKind::Transform { .. } => false,
                _ => !kind.children().is_empty(),
            };
            if !is_geometry {
                continue;
            }
            let origin = survey.origin(operand);
            if let Some(earlier) = first.insert(survey.canonical[operand.index()], operand)
                && reported.insert(origin)
            {
                findings.push(report(origin, survey.origin(earlier)));
            }
        }
    }
}

fn report(origin: Span, earlier: Span) -> Diagnostic {
    let diagnostic = Diagnostic::new(codes::DUPLICATE_GEOMETRY, "the same geometry is there twice");
    let diagnostic = if origin == earlier {
        diagnostic.label(origin, "makes the same shape in the same place more than once")
    } else {
        diagnostic.label(origin, "the same shape in the same place").label(earlier, "as this one")
    };
    diagnostic.help("remove one of them, or move it")
}
