//! Faces of unlike material in one place, where it is not clear which should show.
//!
//! Faces are sorted by their carrier (plane, sphere, cylinder); only faces of different objects with one carrier, of
//! different materials and with overlapping boxes are looked at. A finding is proved at a point: both objects have
//! a wall there, and
//! - of two solids, both face the same way, or they touch and one is transmissive;
//! - of a surface and a solid, both face the same way (a box may rest on a plane);
//! - two surfaces overlap.
//!
//! A wall that other opaque solids cover on its outer side cannot be seen and is not reported.

use arsc_diagnostics::{Diagnostic, Span, codes::geometry as codes};
use arsc_geometry::{Aabb, DAffine3, DVec2, DVec3};
use arsc_ir::{Leaf, NodeId, NodeKind, Surface};
use rustc_hash::FxHashSet;

use super::face::Face;
use super::sampling::roberts;
use super::survey::{Membership, Survey};
use crate::box_tree::{BoxTree, Work};

/// Faces per leaf at most.
const FACES: usize = 6;
/// Points tried per pair of faces.
const POINTS: usize = 24;
/// Leaves of all objects at most: with more, listing the faces alone would take longer than the rest of the compiler.
const MAX_LEAVES: u64 = 50_000;
/// Searches among faces and objects whose work is granted.
const SEARCHES: usize = 20_000;
/// Findings at most.
const FINDINGS: usize = 20;

/// A face, before it is looked at: 16 bytes each, for there may be many.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    carrier: u64,
    owner: u32,
    leaf: u32,
    face: u32,
}

struct Search<'a> {
    survey: &'a Survey<'a>,
    /// Solid objects, then surfaces.
    owners: Vec<NodeId>,
    /// Boxes of the solid objects.
    boxes: Vec<Aabb>,
    membership: Membership<'a>,
    /// For searches among faces, and among the objects that may cover them.
    work: Work,
    reported: FxHashSet<(Span, Span)>,
}

pub(super) fn lint(survey: &Survey, findings: &mut Vec<Diagnostic>) {
    let owners: Vec<NodeId> = survey.objects.iter().chain(&survey.surfaces).copied().collect();
    if owners.len() < 2 || survey.ir.materials.len() < 2 {
        return;
    }
    let sizes = survey.ir.expanded_leaves();
    if owners.iter().map(|id| sizes[id.index()]).sum::<u64>() > MAX_LEAVES {
        return;
    }
    let boxes = survey.objects.iter().map(|id| survey.bounds[id.index()]).collect();
    let membership = Membership::new(survey);
    let work = Work::for_searches(SEARCHES);
    let mut search = Search { survey, owners, boxes, membership, work, reported: FxHashSet::default() };
    let entries = search.entries();
    let boxes = std::mem::take(&mut search.boxes);
    let cover = BoxTree::new(&boxes);
    for bucket in entries.chunk_by(|a, b| a.carrier == b.carrier) {
        let unlike = bucket.iter().any(|entry| search.material(entry) != search.material(&bucket[0]));
        if unlike && bucket.iter().any(|entry| entry.owner != bucket[0].owner) {
            search.bucket(bucket, &cover, findings);
        }
        if search.membership.is_spent() || search.work.is_spent() || search.reported.len() >= FINDINGS {
            return;
        }
    }
}

impl Search<'_> {
    /// All faces of all objects, by carrier.
    fn entries(&self) -> Vec<Entry> {
        let finite = self.boxes.iter().filter(|cell| cell.is_finite() && !cell.is_empty());
        let hull = finite.fold(Aabb::new(-DVec3::ONE * 1e-3, DVec3::ONE * 1e-3), |hull, cell| hull.union(cell));
        let unit = 1e-9 * hull.min.abs().max(hull.max.abs()).max_element();
        let mut entries = Vec::new();
        for (owner, &object) in self.owners.iter().enumerate() {
            let mut stack = vec![object];
            while let Some(id) = stack.pop() {
                let NodeKind::Leaf(leaf) = self.survey.ir.kind(id) else {
                    stack.extend(self.survey.ir.kind(id).children());
                    continue;
                };
                for face in 0..FACES {
                    let Some(patch) = Face::of(leaf, face) else { break };
                    if let Some(carrier) = patch.carrier(unit) {
                        entries.push(Entry { carrier, owner: owner as u32, leaf: id.0, face: face as u32 });
                    }
                }
            }
        }
        entries.sort_unstable();
        entries
    }

    fn leaf(&self, entry: &Entry) -> Option<&Leaf> {
        match self.survey.ir.kind(NodeId(entry.leaf)) {
            NodeKind::Leaf(leaf) => Some(leaf),
            _ => None,
        }
    }

    fn material(&self, entry: &Entry) -> Option<arsc_ir::MaterialId> {
        let (Leaf::Solid { material, .. } | Leaf::Surface { material, .. }) = self.leaf(entry)?;
        *material
    }

    fn bucket(&mut self, bucket: &[Entry], cover: &BoxTree, findings: &mut Vec<Diagnostic>) {
        let faces: Option<Vec<Face>> =
            bucket.iter().map(|entry| Face::of(self.leaf(entry)?, entry.face as usize)).collect();
        let Some(faces) = faces else { return };
        let boxes: Vec<Aabb> = faces.iter().map(|face| crate::bounds::padded(&face.bounds())).collect();
        let tree = BoxTree::new(&boxes);
        for i in 0..bucket.len() {
            let mut candidates = Vec::new();
            let mut work = std::mem::take(&mut self.work);
            let unlike = |a: &Entry, b: &Entry| a.owner != b.owner && self.material(a) != self.material(b);
            tree.overlapping(&boxes[i], &mut work, |j| {
                if j > i && unlike(&bucket[i], &bucket[j]) {
                    candidates.push(j);
                }
                candidates.len() < 16
            });
            self.work = work;
            candidates.sort_unstable();
            for j in candidates {
                let spans = [bucket[i], bucket[j]].map(|entry| self.survey.origin(NodeId(entry.leaf)));
                let [first, second] = if spans[0] <= spans[1] { spans } else { [spans[1], spans[0]] };
                if self.reported.len() < FINDINGS
                    && !self.reported.contains(&(first, second))
                    && self.coincide([&bucket[i], &bucket[j]], [&faces[i], &faces[j]], cover)
                {
                    self.reported.insert((first, second));
                    findings.push(report(first, second));
                }
            }
        }
    }

    /// Both are visible walls at some point of both faces.
    fn coincide(&mut self, entries: [&Entry; 2], faces: [&Face; 2], cover: &BoxTree) -> bool {
        // Points are taken from the smaller face: more of them lie in both.
        let extent = |face: &Face| face.bounds().extent().length();
        let [from, other] = if extent(faces[0]) <= extent(faces[1]) { faces } else { [faces[1], faces[0]] };
        let step = 1e-5 * extent(from);
        (0..POINTS).any(|n| {
            let u = roberts(n);
            let (p, n) = from.point(DVec2::new(u.x, u.y));
            step.is_finite() && other.holds(p) && self.conflict(entries, faces, p, n * step, cover).unwrap_or(false)
        })
    }

    /// Whether the walls of the two owners at `p` are in each other's way; `step` leads off the carrier.
    fn conflict(
        &mut self,
        entries: [&Entry; 2],
        faces: [&Face; 2],
        p: DVec3,
        step: DVec3,
        cover: &BoxTree,
    ) -> Option<bool> {
        let solids = self.survey.objects.len() as u32;
        let mut outward = [0.0; 2];
        for (k, entry) in entries.into_iter().enumerate() {
            outward[k] = if entry.owner < solids {
                let owner = self.owners[entry.owner as usize];
                let (behind, before) =
                    (self.membership.contains(owner, p - step)?, self.membership.contains(owner, p + step)?);
                if behind == before {
                    return None;
                }
                if behind { 1.0 } else { -1.0 }
            } else {
                let normal = faces[k].point(DVec2::splat(0.5)).1;
                normal.dot(step).signum()
            };
        }
        let is_surface = entries.map(|entry| entry.owner >= solids);
        let clear = |entry: &Entry| {
            let owner = self.owners[entry.owner as usize];
            entry.owner < solids && self.survey.transmissive[owner.index()]
        };
        let same_way = outward[0] == outward[1];
        let in_the_way = match is_surface {
            [true, true] => true,
            [false, false] => same_way || entries.into_iter().any(clear),
            _ => same_way,
        };
        Some(in_the_way && !self.covered(p + step * outward[0], entries, cover)?)
    }

    /// Some other opaque solid holds the point.
    fn covered(&mut self, p: DVec3, entries: [&Entry; 2], cover: &BoxTree) -> Option<bool> {
        let mut others = Vec::new();
        cover.containing(&Aabb::new(p, p), &mut self.work, |j| {
            let is_other = entries.iter().all(|entry| entry.owner != j as u32);
            if is_other && !self.survey.transmissive[self.owners[j].index()] {
                others.push(self.owners[j]);
            }
            others.len() < 16
        });
        for other in others {
            if self.membership.contains(other, p)? {
                return Some(true);
            }
        }
        Some(false)
    }
}

fn report(first: Span, second: Span) -> Diagnostic {
    let diagnostic = Diagnostic::new(codes::COINCIDENT_FACES, "two faces of unlike material lie in one place")
        .label(second, "has a face in the same place");
    let diagnostic = if first == second { diagnostic } else { diagnostic.label(first, "as this one") };
    diagnostic.help("move one of them by a little, so that it is clear which one shows")
}

/// The box of a surface in its place; infinite for planes and meshes, whose extent is not known here.
pub(super) fn surface_bounds(surface: &Surface, map: &DAffine3) -> Aabb {
    let leaf = Leaf::Surface { surface: surface.clone(), parent_from_object: *map, material: None };
    let faces: Vec<Face> = (0..FACES).map_while(|n| Face::of(&leaf, n)).collect();
    match faces[..] {
        [] => Aabb::EVERYTHING,
        _ => faces.iter().fold(Aabb::EMPTY, |hull, face| hull.union(&face.bounds())),
    }
}
