//! Unions of leaves, the short way: the leaves themselves are Embree's primitives, without cells and lists of crossings.
//!
//! Seen from outside all of them, a union is met where its first leaf is entered. That is the whole answer unless the ray
//! starts in a leaf (then walls within the union must be passed over), two leaves are entered within the tolerance of each
//! other, or one is thinner than it (then the rule for coincident faces decides). Each visit notices these cases. Then the
//! traversal is done again: leaves are only taken note of, and evaluated together when it is over, as they always are where
//! every transition is asked for.
//!
//! Whether a ray starts outside is known in the end, because every box that holds its start is visited: nothing that is
//! found brings the end of the ray before its start. A traversal that stops at the first blocker knows less, so what blocks
//! a ray does so tentatively, until a probe of the boxes that hold the start has found none of their leaves to.
//!
//! A solid of one leaf needs no such care.

use arsc_geometry::Aabb;
use glam::DVec3;
use smallvec::SmallVec;

use crate::cells::{self, CellLeaf, Entry, Line, Window};
use crate::expression::{Expression, Op, Word};
use crate::level::Solids;
use crate::nearest::Candidate;
use crate::query::{Extent, Mode, PreparedRay, Query, View};
use crate::solid::SolidModel;
use crate::strategies::PAD;
use crate::transition::Transition;

/// Where leaves overlap more than this, cells, which leave out what is hidden, are faster.
const DEEPEST: usize = 3;
/// Leaves at whose centres the depth is looked at.
const PROBES: usize = 64;

/// A leaf of a union.
struct Member {
    solid: u32,
    /// The solid has no other.
    alone: bool,
    leaf: CellLeaf,
}

#[derive(Default)]
pub struct Members {
    members: Vec<Member>,
    /// Some solid has several leaves.
    several: bool,
}

impl Members {
    /// Takes up the solid if it is a union of bounded leaves that do not overlap much.
    pub fn admit(&mut self, number: u32, solid: &SolidModel) -> bool {
        let Some(leaves) = union_leaves(solid) else { return false };
        let admitted = |leaf: &u32| Extent::admits(solid.leaves[*leaf as usize].bounds());
        if !leaves.iter().all(admitted) || depth(solid, &leaves) > DEEPEST as f64 {
            return false;
        }
        let alone = leaves.len() == 1;
        self.several |= !alone;
        let member = |leaf: u32| Member { solid: number, alone, leaf: CellLeaf::new(leaf, &solid.leaves) };
        self.members.extend(by_place(leaves, solid).into_iter().map(member));
        true
    }

    pub fn len(&self) -> usize {
        self.members.len()
    }

    pub fn bounds(&self, solids: &Solids, index: u32) -> Aabb {
        let Member { solid, leaf, .. } = &self.members[index as usize];
        solids.models[*solid as usize].leaves[leaf.leaf as usize].bounds().dilated(PAD * solids.tolerance(*solid))
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.members[..])
    }

    /// Some answer may have to wait for the end of the traversal.
    pub fn has_several(&self) -> bool {
        self.several
    }

    #[inline]
    pub fn visit(&self, solids: &Solids, index: u32, query: &mut Query) {
        let member = &self.members[index as usize];
        if solids.is_left_out(member.solid, query) {
            return;
        }
        if query.probing {
            if !member.alone {
                let mut moved = None;
                let (line, window) = whole(solids, member.solid, &query.view, 0.0, &mut moved);
                query.unclear |=
                    matches!(cells::entry(&member.leaf, &line, &window, &mut query.scratch), Entry::Unclear);
            }
            return;
        }
        query.tests += 1;
        if member.alone {
            return self.visit_alone(solids, member, query);
        }
        if query.gathering {
            return query.scratch.whole.met.push((member.solid, index));
        }
        let (end, mut moved) = (query.limit(), None);
        let (line, window) = whole(solids, member.solid, &query.view, end, &mut moved);
        match cells::entry(&member.leaf, &line, &window, &mut query.scratch) {
            Entry::Missed => {}
            Entry::Unclear => query.unclear = true,
            Entry::At { t, face } => {
                let leaf = member.leaf.leaf;
                let transition = Transition { t, leaf, face, entering: true, flipped: false, shared: false };
                let candidate = solids.candidate(member.solid, transition, window.start, &query.view);
                if query.mode == Mode::Occluded {
                    query.tentative |= candidate.t > 0.0 && candidate.t < query.ray.t_max;
                } else {
                    query.unclear |= query.nearest.coincides_within_solid(&candidate);
                    query.offer(candidate);
                }
            }
        }
    }

    fn visit_alone(&self, solids: &Solids, member: &Member, query: &mut Query) {
        let (end, mut moved) = (query.limit(), None);
        let (line, window) = whole(solids, member.solid, &query.view, end, &mut moved);
        let mut found: SmallVec<[Transition; 4]> = SmallVec::new();
        let all = query.mode == Mode::Collect;
        cells::leaf_transitions(&member.leaf, false, &line, &window, &mut query.scratch, |transition| {
            found.push(transition);
            all
        });
        for transition in found {
            query.offer(solids.candidate(member.solid, transition, window.start, &query.view));
        }
    }

    /// Evaluates the leaves that have been taken note of since `mark`.
    pub fn finish(&self, solids: &Solids, mark: usize, query: &mut Query) {
        if query.scratch.whole.met.len() == mark {
            return;
        }
        let mut met = query.scratch.whole.met.split_off(mark);
        let place = |&(solid, index): &(u32, u32)| (solid, self.members[index as usize].leaf.leaf);
        met.sort_unstable_by_key(place);
        met.dedup();
        for group in met.chunk_by(|a, b| a.0 == b.0) {
            if query.blocked {
                return;
            }
            let solid = group[0].0;
            let (view, end, mut moved) = (query.view, query.limit(), None);
            let (line, window) = whole(solids, solid, &view, end, &mut moved);
            let leaves: SmallVec<[CellLeaf; 16]> =
                group.iter().map(|&(_, index)| self.members[index as usize].leaf).collect();
            let mut found: SmallVec<[Candidate; 4]> = SmallVec::new();
            let all = query.mode == Mode::Collect;
            cells::union_transitions(&leaves, &line, &window, &mut query.scratch, |transition| {
                found.push(solids.candidate(solid, transition, window.start, &view));
                all
            });
            found.into_iter().for_each(|candidate| {
                query.offer(candidate);
            });
        }
    }
}

/// All of a solid along a ray from its start to `end`, a parameter of the scene's ray.
#[inline(always)]
fn whole<'a>(
    solids: &'a Solids,
    solid: u32,
    view: &'a View,
    end: f64,
    moved: &'a mut Option<PreparedRay>,
) -> (Line<'a>, Window) {
    let (ray, start) = solids.near(solid, view, moved);
    let window = Window { low: start, high: start + end * view.scale, start, tolerance: solids.tolerance(solid) };
    (Line::new(&solids.models[solid as usize], solid, ray, view), window)
}

/// The leaves that the solid is the union of, ascending; `None` for other solids.
fn union_leaves(solid: &SolidModel) -> Option<Vec<u32>> {
    let Expression::Tokens(tokens) = &solid.expression else { return None };
    let operands = match tokens[0].word() {
        Word::Node { op: Op::Or, .. } => &tokens[1..],
        Word::Node { op: Op::And, .. } => return None,
        Word::Literal { .. } => &tokens[..],
    };
    let leaf = |word| match word {
        Word::Literal { leaf, negated: false } => Some(leaf),
        _ => None,
    };
    let mut leaves = operands.iter().map(|token| leaf(token.word())).collect::<Option<Vec<u32>>>()?;
    leaves.sort_unstable();
    leaves.dedup();
    Some(leaves)
}

/// In the order of a Morton curve through their centres, so that neighbours in space are neighbours in memory.
fn by_place(leaves: Vec<u32>, solid: &SolidModel) -> Vec<u32> {
    let extent = solid.bounds.extent().max(DVec3::splat(f64::MIN_POSITIVE));
    let spread = |x: f64| {
        let cell = (x * 1023.0) as u64;
        (0..10).fold(0, |code, bit| code | (cell >> bit & 1) << (3 * bit))
    };
    let code = |leaf: u32| {
        let at = (solid.leaves[leaf as usize].bounds().center() - solid.bounds.min) / extent;
        spread(at.x) | spread(at.y) << 1 | spread(at.z) << 2
    };
    let mut placed: Vec<(u64, u32)> = leaves.into_iter().map(|leaf| (code(leaf), leaf)).collect();
    placed.sort_unstable();
    placed.into_iter().map(|(_, leaf)| leaf).collect()
}

/// In how many leaves' boxes the centre of one is, on average.
fn depth(solid: &SolidModel, leaves: &[u32]) -> f64 {
    let bounds = |leaf: &u32| solid.leaves[*leaf as usize].bounds();
    let centers = leaves.iter().step_by(leaves.len().div_ceil(PROBES)).map(|leaf| bounds(leaf).center());
    let depths: Vec<usize> = centers.map(|p| leaves.iter().filter(|leaf| bounds(leaf).contains(p)).count()).collect();
    depths.iter().sum::<usize>() as f64 / depths.len().max(1) as f64
}
