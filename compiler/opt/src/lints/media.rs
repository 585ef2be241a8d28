//! Transmissive objects that overlap: the earlier one fills the common part, which may not be what was meant. A union
//! `a | b` says it: `a` comes first.

use arsc_diagnostics::{Diagnostic, codes::geometry as codes};
use arsc_geometry::{Aabb, DVec3};
use arsc_ir::NodeId;

use super::sampling::roberts;
use super::survey::{Membership, Survey};
use crate::box_tree::{BoxTree, Work};

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
    let mut lint = Lint { survey, membership: Membership::new(survey), found: 0, findings };
    lint.overlaps(&independent);
}

struct Lint<'a> {
    survey: &'a Survey<'a>,
    membership: Membership<'a>,
    found: usize,
    findings: &'a mut Vec<Diagnostic>,
}

impl Lint<'_> {
    /// Pairs of solids with a common point.
    fn overlaps(&mut self, solids: &[NodeId]) {
        let boxes: Vec<Aabb> = solids.iter().map(|id| self.survey.bounds[id.index()]).collect();
        let tree = BoxTree::new(&boxes);
        let mut work = Work::for_searches(solids.len());
        for (i, id) in solids.iter().enumerate() {
            let mut pairs = PAIRS;
            tree.overlapping(&boxes[i], &mut work, |j| {
                pairs -= 1;
                if j < i && self.common_point(*id, solids[j]).is_some() {
                    self.findings.push(report(self.survey, solids[j], *id));
                    self.found += 1;
                }
                pairs > 0 && self.found < FINDINGS
            });
            if self.found >= FINDINGS || self.membership.is_spent() {
                return;
            }
        }
    }

    fn common_point(&mut self, a: NodeId, b: NodeId) -> Option<DVec3> {
        let cell = self.survey.bounds[a.index()].intersection(&self.survey.bounds[b.index()]);
        if !cell.is_finite() || cell.is_empty() {
            return None;
        }
        let mut contains = |id: NodeId, p: DVec3| self.membership.contains(id, p) == Some(true);
        // The middle of the points' box keeps clear of touching faces.
        (0..POINTS)
            .map(|n| cell.min + cell.extent() * (DVec3::splat(0.05) + roberts(n) * 0.9))
            .find(|&p| contains(a, p) && contains(b, p))
    }
}

fn report(survey: &Survey, first: NodeId, second: NodeId) -> Diagnostic {
    Diagnostic::new(codes::OVERLAPPING_DIELECTRICS, "two transmissive solids overlap")
        .label(survey.origin(second), "shares points with the other")
        .label(survey.origin(first), "this one comes first and fills what they share")
        .help("join them as `a | b` to say that `a` fills what they share, or leave a gap between them")
}
