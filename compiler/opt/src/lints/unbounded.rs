//! Solids without an end, and maps that almost flatten what they place.

use arsc_diagnostics::{Diagnostic, codes::geometry as codes};
use arsc_geometry::invert;
use arsc_ir::{Leaf, NodeKind};

use super::Places;
use super::survey::Survey;

/// Ratio of the largest to the least stretch from which a map counts as degenerate.
const MAX_STRETCH_RATIO: f64 = 1e9;

pub(super) fn lint(survey: &Survey, findings: &mut Vec<Diagnostic>) {
    let mut endless: Places<()> = Places::new();
    for &object in &survey.objects {
        let bounds = &survey.bounds[object.index()];
        endless.note(survey.origin(object), (!bounds.is_finite() && !bounds.is_empty()).then_some(()));
    }
    findings.extend(endless.all_found().map(|(origin, ())| {
        Diagnostic::new(codes::UNBOUNDED_SOLID, "an unbounded solid is left in the scene")
            .label(origin, "has no end")
            .help("intersect it with a bounded solid; for a floor without end use the surface `plane()`")
    }));
    let mut flat: Places<()> = Places::new();
    for node in &survey.ir.nodes {
        if let NodeKind::Leaf(leaf) = &node.kind {
            flat.note(node.origin, is_flat(leaf).then_some(()));
        }
    }
    findings.extend(flat.all_found().map(|(origin, ())| {
        Diagnostic::new(codes::NEARLY_FLAT, "a transform flattens a shape almost to nothing")
            .label(origin, "is stretched a billion times more in one direction than in another")
            .help("use scale factors closer to each other, or a shape of other proportions")
    }));
}

fn is_flat(leaf: &Leaf) -> bool {
    let (Leaf::Solid { parent_from_object, .. } | Leaf::Surface { parent_from_object, .. }) = leaf;
    let norm = |m: &arsc_geometry::DMat3| m.x_axis.length().max(m.y_axis.length()).max(m.z_axis.length());
    match invert(parent_from_object) {
        Some(inverse) => norm(&parent_from_object.matrix3) * norm(&inverse.matrix3) > MAX_STRETCH_RATIO,
        None => true,
    }
}
