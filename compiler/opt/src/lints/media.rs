//! Transmissive solids that overlap: which of them a point belongs to is not said.

use arsc_diagnostics::{Diagnostic, codes::geometry as codes};
use arsc_geometry::{Aabb, DVec3};
use arsc_ir::{Leaf, NodeId, NodeKind};

use super::sampling::roberts;
use super::survey::Survey;
use crate::box_tree::BoxTree;

/// Pairs of boxes looked at, per object.
const PAIRS: usize = 16;
/// Points tried in the common box of a pair.
const POINTS: usize = 64;
/// Findings at most.
const FINDINGS: usize = 20;

pub(super) fn lint(survey: &Survey, findings: &mut Vec<Diagnostic>) {
    let independent: Vec<NodeId> = survey
        .ir
        .kind(survey.ir.root)
        .children()
        .iter()
        .copied()
        .filter(|id| survey.transmissive[id.index()])
        .collect();
    overlaps(survey, &independent, findings);
    for node in &survey.ir.nodes {
        if let NodeKind::Union(of) = &node.kind {
            let bsdf = |id: &NodeId| match survey.ir.kind(*id) {
                NodeKind::Leaf(leaf) if matches!(**leaf, Leaf::Solid { .. }) => {
                    survey.material(leaf).filter(|material| survey.is_dielectric(material)).and_then(|m| m.bsdf)
                }
                _ => None,
            };
            let media: Vec<NodeId> = of.iter().copied().filter(|id| bsdf(id).is_some()).collect();
            if media.windows(2).any(|pair| bsdf(&pair[0]) != bsdf(&pair[1])) {
                overlaps_unlike(survey, &media, &bsdf, findings);
            }
        }
    }
}

fn overlaps(survey: &Survey, solids: &[NodeId], findings: &mut Vec<Diagnostic>) {
    overlaps_unlike(survey, solids, &|id: &NodeId| Some(id.0), findings);
}

/// Pairs of solids with a common point, unless both are of one class.
fn overlaps_unlike(
    survey: &Survey,
    solids: &[NodeId],
    class: &dyn Fn(&NodeId) -> Option<u32>,
    findings: &mut Vec<Diagnostic>,
) {
    let boxes: Vec<Aabb> = solids.iter().map(|id| survey.bounds[id.index()]).collect();
    let tree = BoxTree::new(&boxes);
    for (i, id) in solids.iter().enumerate() {
        let mut pairs = PAIRS;
        tree.overlapping(&boxes[i], |j| {
            pairs -= 1;
            let room = || findings.iter().filter(|f| f.code == codes::OVERLAPPING_DIELECTRICS).count() < FINDINGS;
            if j < i && class(id) != class(&solids[j]) && room() && common_point(survey, *id, solids[j]).is_some() {
                findings.push(report(survey, solids[j], *id));
            }
            pairs > 0
        });
    }
}

fn common_point(survey: &Survey, a: NodeId, b: NodeId) -> Option<DVec3> {
    let cell = survey.bounds[a.index()].intersection(&survey.bounds[b.index()]);
    if !cell.is_finite() || cell.is_empty() {
        return None;
    }
    let in_both = |p: &DVec3| survey.contains(a, *p) == Some(true) && survey.contains(b, *p) == Some(true);
    // The middle of the points' box keeps clear of touching faces.
    (0..POINTS).map(|n| cell.min + cell.extent() * (DVec3::splat(0.05) + roberts(n) * 0.9)).find(in_both)
}

fn report(survey: &Survey, first: NodeId, second: NodeId) -> Diagnostic {
    Diagnostic::new(codes::OVERLAPPING_DIELECTRICS, "two transmissive solids overlap")
        .label(survey.origin(second), "shares points with the other")
        .label(survey.origin(first), "which medium fills them is not said")
        .help("subtract one from the other, or leave a gap between them")
}
