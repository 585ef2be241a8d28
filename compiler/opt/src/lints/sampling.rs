//! Test lines: does a set have any volume?
//!
//! Lines go through points inside of the leaves that matter, in directions of a fixed low-discrepancy sequence (Roberts'
//! generalisation of the golden ratio). Along a line the set is known exactly, so a thin plate or rod is found by
//! any line that crosses it. A line that meets the set proves that it has volume; no line meeting it proves nothing,
//! hence the word "seems" in messages.

use arsc_geometry::{Crossings, DAffine3, DVec3, Placed};
use arsc_ir::{Leaf, NodeId, NodeKind};

use super::survey::Survey;
use crate::bounds::place;

/// Leaves per set at most: larger sets are not judged.
const MAX_LEAVES: usize = 64;
/// Lines through each leaf.
const LINES: usize = 48;
/// Leaf tests for the whole scene.
const BUDGET: usize = 600_000;

pub(super) struct Sampling<'a> {
    survey: &'a Survey<'a>,
    budget: usize,
}

/// A Boolean combination of two solids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Set {
    /// A node on its own.
    One(NodeId),
    /// Points in both.
    Both(NodeId, NodeId),
}

impl<'a> Sampling<'a> {
    pub fn new(survey: &'a Survey<'a>) -> Sampling<'a> {
        Sampling { survey, budget: BUDGET }
    }

    /// `Some(true)`: has volume, proved. `Some(false)`: no line met it. `None`: not judged.
    pub fn has_volume(&mut self, set: Set) -> Option<bool> {
        let nodes = match set {
            Set::One(a) => vec![a],
            Set::Both(a, b) => vec![a, b],
        };
        let mut lines = Vec::new();
        for &node in &nodes {
            let leaves = self.survey.leaves(node, MAX_LEAVES)?;
            lines.push(leaves.into_iter().map(|leaf| self.placed(leaf)).collect::<Option<Vec<Placed>>>()?);
        }
        let leaves: usize = lines.iter().map(Vec::len).sum();
        let mut tried = 0;
        let through: Vec<&Placed> = lines.iter().flatten().filter(|leaf| leaf.shape().is_bounded()).collect();
        for round in 0..LINES {
            for leaf in &through {
                let Some((origin, dir)) = line(leaf, round) else { continue };
                self.budget = self.budget.checked_sub(leaves)?;
                tried += 1;
                if self.meets(&nodes, &lines, origin, dir) {
                    return Some(true);
                }
            }
        }
        (tried >= LINES).then_some(false)
    }

    fn placed(&self, leaf: NodeId) -> Option<Placed> {
        let NodeKind::Leaf(leaf) = self.survey.ir.kind(leaf) else { return None };
        place(leaf, &DAffine3::IDENTITY)
    }

    /// All of the nodes hold a common stretch of the line.
    fn meets(&self, nodes: &[NodeId], leaves: &[Vec<Placed>], origin: DVec3, dir: DVec3) -> bool {
        let crossings: Vec<Vec<Crossings>> =
            leaves.iter().map(|of| of.iter().map(|leaf| leaf.crossings(origin, dir)).collect()).collect();
        let mut t: Vec<f64> = crossings.iter().flatten().flat_map(|c| c.t().to_vec()).collect();
        t.sort_by(f64::total_cmp);
        // Stretches that rounding may have made do not count.
        let scale = origin.length() + t.iter().fold(0.0, |sum: f64, t| sum.max(t.abs()));
        t.windows(2).filter(|pair| pair[1] - pair[0] > 1e-9 * scale).any(|pair| {
            let middle = (pair[0] + pair[1]) * 0.5;
            nodes.iter().zip(&crossings).all(|(&node, crossings)| {
                let mut next = crossings.iter();
                self.inside(node, &mut next, middle)
            })
        })
    }

    fn inside(&self, id: NodeId, next: &mut std::slice::Iter<Crossings>, t: f64) -> bool {
        let kind = self.survey.ir.kind(id);
        if let NodeKind::Leaf(leaf) = kind {
            return matches!(**leaf, Leaf::Solid { .. }) && next.next().is_some_and(|line| line.inside_after(t));
        }
        // Every operand takes its leaves, whatever the others say.
        let of: Vec<bool> = kind.children().iter().map(|&child| self.inside(child, next, t)).collect();
        match kind {
            NodeKind::Union(_) => of.contains(&true),
            NodeKind::Intersection(_) => !of.contains(&false),
            NodeKind::Difference(_) => of[0] && !of[1..].contains(&true),
            _ => false,
        }
    }
}

/// A line through a point inside of a bounded leaf: the n-th of a fixed sequence.
fn line(leaf: &Placed, n: usize) -> Option<(DVec3, DVec3)> {
    let bounds = leaf.shape().bounds();
    // Candidates for the point; most shapes fill a good part of their box, thin tori do not.
    let point =
        (0..16).map(|k| bounds.min + bounds.extent() * roberts(16 * n + k)).find(|&p| leaf.shape().contains(p))?;
    let u = roberts(7 * n + 1);
    let (z, phi) = (1.0 - 2.0 * u.x, std::f64::consts::TAU * u.y);
    let rho = (1.0 - z * z).sqrt();
    let dir = DVec3::new(rho * phi.cos(), rho * phi.sin(), z);
    Some((leaf.world_from_object().transform_point3(point), dir))
}

/// The n-th point of the R₃ sequence in the unit cube.
pub(super) fn roberts(n: usize) -> DVec3 {
    // The real root of x⁴ = x + 1, and its powers.
    const G: f64 = 1.220_744_084_605_759_6;
    let n = n as f64 + 1.0;
    DVec3::new((0.5 + n / G).fract(), (0.5 + n / (G * G)).fract(), (0.5 + n / (G * G * G)).fract())
}
