//! Light that cannot reach the picture: no light at all, lights and cameras inside of opaque solids.

use arsc_diagnostics::{Diagnostic, Span, codes::geometry as codes};
use arsc_geometry::{Aabb, DVec3};
use arsc_ir::{Leaf, NodeId, NodeKind};

use super::survey::{Membership, Survey};
use super::{Places, is_rendered};
use crate::bounds::padded;
use crate::box_tree::{BoxTree, Work};
use crate::drop_operands::Proof;

/// Candidates per light.
const CANDIDATES: usize = 64;
/// Nodes looked at for all proofs.
const VISITS: usize = 200_000;

/// Opaque solids, to look up what lies in which.
struct Opaque<'a> {
    survey: &'a Survey<'a>,
    solids: &'a [NodeId],
    tree: BoxTree<'a>,
    work: Work,
    membership: Membership<'a>,
    proof: Proof<'a>,
}

impl Opaque<'_> {
    /// A solid that holds the point.
    fn holder(&mut self, p: DVec3) -> Option<NodeId> {
        let mut candidates = CANDIDATES;
        let mut found = None;
        self.tree.containing(&Aabb::new(p, p), &mut self.work, |j| {
            candidates -= 1;
            if self.membership.contains(self.solids[j], p) == Some(true) {
                found = Some(self.solids[j]);
            }
            found.is_none() && candidates > 0
        });
        found
    }

    /// A solid other than the emitting one that holds all of the box.
    fn cover(&mut self, emitting: NodeId, cell: &Aabb) -> Option<NodeId> {
        let mut candidates = CANDIDATES;
        let mut found = None;
        self.tree.containing(cell, &mut self.work, |j| {
            candidates -= 1;
            if self.solids[j] != emitting && self.proof.inside(self.solids[j], cell, 0) {
                found = Some(self.solids[j]);
            }
            found.is_none() && candidates > 0
        });
        found
    }
}

pub(super) fn lint(survey: &Survey, findings: &mut Vec<Diagnostic>) {
    let ir = survey.ir;
    if is_rendered(ir) && !has_light(survey) && !(survey.objects.is_empty() && survey.surfaces.is_empty()) {
        findings.push(
            Diagnostic::new(codes::NO_LIGHT, "the scene has no light")
                .label(survey.origin(ir.root), "nothing in here emits: the picture will be black")
                .help("add a light, an emitter or an environment, for example `sky()`"),
        );
    }
    let opaque: Vec<NodeId> = survey.objects.iter().copied().filter(|id| !survey.transmissive[id.index()]).collect();
    let boxes: Vec<Aabb> = opaque.iter().map(|id| survey.bounds[id.index()]).collect();
    let mut opaque = Opaque {
        survey,
        solids: &opaque,
        tree: BoxTree::new(&boxes),
        work: Work::for_searches(ir.nodes.len()),
        membership: Membership::new(survey),
        proof: Proof { ir, visits: VISITS },
    };
    if let Some(camera) = &ir.camera
        && camera.fit.is_none()
        && let Some(id) = opaque.holder(camera.eye)
    {
        findings.push(
            Diagnostic::new(codes::CAMERA_INSIDE, "the camera is inside of an opaque solid")
                .label(survey.origin(id), "the camera's eye is in here")
                .help("move the camera out, or cut a room for it"),
        );
    }
    hidden_lights(&mut opaque, findings);
}

fn has_light(survey: &Survey) -> bool {
    let ir = survey.ir;
    let lights = |kind: &NodeKind| matches!(kind, NodeKind::Light(_) | NodeKind::Environment(_));
    (0..ir.nodes.len() as u32).map(NodeId).any(|id| lights(ir.kind(id)) || survey.emits(id))
}

fn hidden_lights(opaque: &mut Opaque, findings: &mut Vec<Diagnostic>) {
    let survey = opaque.survey;
    let mut hidden: Places<Span> = Places::new();
    for &member in survey.ir.kind(survey.ir.root).children() {
        if let Some(p) = point_light(survey, member) {
            hidden.note(survey.origin(member), opaque.holder(p).map(|by| survey.origin(by)));
        }
    }
    for &emitting in survey.objects.iter().chain(&survey.surfaces) {
        let NodeKind::Leaf(leaf) = survey.ir.kind(emitting) else { continue };
        if survey.emits(emitting) {
            let cell = padded(&extent(survey, emitting, leaf));
            let by = if cell.is_finite() { opaque.cover(emitting, &cell) } else { None };
            hidden.note(survey.origin(emitting), by.map(|by| survey.origin(by)));
        }
    }
    findings.extend(hidden.all_found().map(|(origin, by)| {
        Diagnostic::new(codes::HIDDEN_LIGHT, "a light is inside of an opaque solid")
            .label(origin, "its light cannot get out")
            .label(by, "all of it is in here")
            .help("move the light out, or cut a room for it")
    }));
}

/// Where a point light of the root group is.
fn point_light(survey: &Survey, member: NodeId) -> Option<DVec3> {
    let is_point = |id: NodeId| match survey.ir.kind(id) {
        NodeKind::Light(light) => light.is_point(),
        _ => false,
    };
    match survey.ir.kind(member) {
        NodeKind::Transform { parent_from_child, child } if is_point(*child) => Some(parent_from_child.translation),
        _ if is_point(member) => Some(DVec3::ZERO),
        _ => None,
    }
}

fn extent(survey: &Survey, id: NodeId, leaf: &Leaf) -> Aabb {
    match leaf {
        Leaf::Solid { .. } => survey.bounds[id.index()],
        Leaf::Surface { surface, parent_from_object, .. } => {
            super::coincident::surface_bounds(surface, parent_from_object)
        }
    }
}
