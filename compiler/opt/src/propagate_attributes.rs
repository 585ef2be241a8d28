//! Moves attributes to the leaves, resolves cut rules, and interns materials.
//!
//! For each kind of attribute (bsdf, emitter, medium, cut rule) on its own: `with` nearest to the leaf wins; an `override`
//! beats every `with` inside of it, and the outermost `override` wins. A material that a leaf already has counts as
//! a `with` at the leaf.
//!
//! Cut rules say what covers the walls that a subtraction leaves. In A − B the rule comes from the first of: a rule
//! on or inside B; a rule on A itself; a rule around the difference (or further out); otherwise a wall shows B's own
//! material. A rule for a bsdf replaces the whole material (a cut wall does not
//! emit), but for what an `override` further out forces. The rule *inherit* takes the
//! material of what is cut, which is the material of A at that point: of the first operand of a difference or an
//! intersection, and of the first operand of a union that holds the point. Where that is not one material
//! everywhere, the difference is distributed over the union: (X ∪ Y) − B = (X − B') ∪ (Y − B''), B' covered like X
//! and B'' like Y. Where X and Y overlap, both walls coincide and the first operand has precedence, which is X.
//!
//! What is attached to a face of primitives (`with_face`) wins over what is attached to the whole, nearest first, but not
//! over an `override`. A cut wall has no such faces: it is covered as a whole.
//!
//! Textures stick to what they are attached to: a bsdf that varies with places in its own space is followed from where it
//! was attached, through the transforms below, to the object space of the leaf ([`crate::texture_space`]).
//!
//! Rewrites: `attach`, `override`, `cut_with`, `inherit`, `distribute_inherit`.

use arsc_diagnostics::Span;
use arsc_geometry::DAffine3;
use arsc_ir::{Attributes, CutRule, Environment, Ir, Leaf, Material, MaterialId, Node, NodeId, NodeKind, Precedence};
use rustc_hash::FxHashMap;

use crate::intern::Interner;
use crate::pipeline::Log;
use crate::texture_space::{TextureSpaces, inverse};

/// What surrounds a node: the attributes that reach it from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct State {
    attached: Attributes,
    forced: Attributes,
    /// `Some` inside of a subtrahend; the inner value is the material of what is cut, where it is one.
    cutting: Option<Option<MaterialId>>,
    /// Inside of a subtrahend to which a cut rule applies.
    cover: Option<MaterialId>,
    /// Index into [`Propagation::faces`].
    faces: u32,
}

/// What is attached to a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct FaceAttributes {
    face: u32,
    bsdf: Option<u32>,
    emitter: Option<u32>,
}

/// The material of a solid at its inner points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Interior {
    Empty,
    One(MaterialId),
    Mixed,
}

/// Work to do; results of earlier tasks lie on a stack.
enum Task {
    Enter {
        node: NodeId,
        state: State,
    },
    /// Takes the operands from the results.
    Rebuild {
        node: NodeId,
        state: State,
    },
    /// The first operand of a difference is done: now the others.
    Minuend {
        node: NodeId,
        state: State,
    },
    /// Subtracts the next of the remaining operands from the last result.
    SubtractNext {
        node: NodeId,
        operand: usize,
        state: State,
    },
    /// Subtracts one operand of the source from a finished node; `minuend_from_here` maps from the frame of the
    /// operand to the frame of the node.
    Subtract {
        minuend: NodeId,
        operand: NodeId,
        minuend_from_here: Option<Box<DAffine3>>,
        state: State,
        origin: Span,
    },
    Difference {
        minuend: NodeId,
        minuend_from_here: Option<Box<DAffine3>>,
        origin: Span,
    },
    Union {
        operands: usize,
        origin: Span,
    },
    ReplaceFirst {
        node: NodeId,
    },
    Wrap {
        parent_from_child: Box<DAffine3>,
        origin: Span,
    },
}

struct Propagation<'a, 'b> {
    source: &'a Ir,
    uses: Vec<u32>,
    has_inherit: Vec<bool>,
    out: Vec<Node>,
    interior: Vec<Interior>,
    /// Lists of what is attached to faces, by face; the first is empty.
    faces: Vec<Vec<FaceAttributes>>,
    memo: FxHashMap<(NodeId, State), NodeId>,
    tasks: Vec<Task>,
    results: Vec<NodeId>,
    bsdfs: TextureSpaces,
    emitter: Vec<u32>,
    medium: Vec<u32>,
    materials: Interner<Material>,
    log: &'a mut Log<'b>,
}

pub(crate) fn run(ir: Ir, log: &mut Log) -> Ir {
    let mut emitters = Interner::new();
    let emitter = ir.emitters.iter().map(|emitter| emitters.intern(emitter.clone())).collect();
    let mut media = Interner::new();
    let medium = ir.media.iter().map(|medium| media.intern(medium.clone())).collect();
    let mut propagation = Propagation {
        uses: ir.uses(),
        has_inherit: has_inherit(&ir),
        source: &ir,
        out: Vec::with_capacity(ir.nodes.len()),
        interior: Vec::with_capacity(ir.nodes.len()),
        memo: FxHashMap::default(),
        faces: vec![Vec::new()],
        tasks: vec![Task::Enter { node: ir.root, state: State::default() }],
        results: Vec::new(),
        bsdfs: TextureSpaces::new(&ir.bsdfs),
        emitter,
        medium,
        materials: Interner::new(),
        log,
    };
    while let Some(task) = propagation.tasks.pop() {
        propagation.step(task);
    }
    let root = propagation.pop();
    let (nodes, materials) = (propagation.out, propagation.materials.values);
    let bsdfs = propagation.bsdfs.into_values();
    Ir {
        nodes,
        root,
        bsdfs,
        emitters: emitters.values,
        media: media.values,
        materials,
        camera: ir.camera,
        actions: ir.actions,
    }
}

/// Whether the rule `inherit` stands on or below a node.
fn has_inherit(ir: &Ir) -> Vec<bool> {
    let mut found = vec![false; ir.nodes.len()];
    for (id, node) in ir.nodes.iter().enumerate() {
        let here =
            matches!(&node.kind, NodeKind::Attributes { attributes, .. } if attributes.cut == Some(CutRule::Inherit));
        found[id] = here || node.kind.children().iter().any(|child| found[child.index()]);
    }
    found
}

impl Propagation<'_, '_> {
    fn pop(&mut self) -> NodeId {
        self.results.pop().expect("every task leaves one result")
    }

    fn step(&mut self, task: Task) {
        match task {
            Task::Enter { node, state } => self.enter(node, state),
            Task::Rebuild { node, state } => self.rebuild(node, state),
            Task::Minuend { node, state } => self.minuend(node, state),
            Task::SubtractNext { node, operand, state } => self.subtract_next(node, operand, state),
            Task::Subtract { minuend, operand, minuend_from_here, state, origin } => {
                self.subtract(minuend, operand, minuend_from_here, state, origin)
            }
            Task::Difference { minuend, minuend_from_here, origin } => {
                let mut operand = self.pop();
                if let Some(map) = minuend_from_here {
                    operand = self.push(NodeKind::Transform { parent_from_child: map, child: operand }, origin);
                }
                let result = self.push(NodeKind::Difference(vec![minuend, operand]), origin);
                self.results.push(result);
            }
            Task::Union { operands, origin } => {
                let operands = self.results.split_off(self.results.len() - operands);
                let result = self.push(NodeKind::Union(operands), origin);
                self.results.push(result);
            }
            Task::ReplaceFirst { node } => {
                let Node { mut kind, origin } = self.out[node.index()].clone();
                kind.children_mut()[0] = self.pop();
                let result = self.push(kind, origin);
                self.results.push(result);
            }
            Task::Wrap { parent_from_child, origin } => {
                let child = self.pop();
                let result = self.push(NodeKind::Transform { parent_from_child, child }, origin);
                self.results.push(result);
            }
        }
    }

    fn enter(&mut self, id: NodeId, state: State) {
        let shared = self.uses[id.index()] > 1;
        if shared && let Some(&done) = self.memo.get(&(id, state)) {
            self.results.push(done);
            return;
        }
        let source = self.source;
        let node = source.node(id);
        match &node.kind {
            NodeKind::Leaf(leaf) => {
                let kind = NodeKind::Leaf(Box::new(self.leaf(leaf, &state)));
                self.finish(id, state, kind);
            }
            NodeKind::Environment(environment) => {
                let environment = match **environment {
                    Environment::Medium { medium } => Environment::Medium { medium: self.medium[medium as usize] },
                    ref other => other.clone(),
                };
                self.finish(id, state, NodeKind::Environment(Box::new(environment)));
            }
            NodeKind::Light(_) => self.finish(id, state, node.kind.clone()),
            NodeKind::Attributes { attributes, precedence, child } => {
                let state = self.attach(state, *attributes, *precedence);
                self.tasks.push(Task::Enter { node: *child, state });
            }
            NodeKind::Transform { parent_from_child, child } => {
                self.tasks.push(Task::Rebuild { node: id, state });
                let state = self.moved(state, parent_from_child);
                self.tasks.push(Task::Enter { node: *child, state });
            }
            NodeKind::Difference(operands) if operands.len() > 1 => {
                self.tasks.push(Task::Minuend { node: id, state });
                self.tasks.push(Task::Enter { node: operands[0], state });
            }
            kind => {
                self.tasks.push(Task::Rebuild { node: id, state });
                let children = kind.children().iter().rev();
                self.tasks.extend(children.map(|&node| Task::Enter { node, state }));
            }
        }
    }

    /// Collects the operands of a node that keeps its kind.
    fn rebuild(&mut self, id: NodeId, state: State) {
        let mut kind = self.source.kind(id).clone();
        let children = kind.children_mut();
        let first = self.results.len() - children.len();
        children.copy_from_slice(&self.results[first..]);
        self.results.truncate(first);
        self.finish(id, state, kind);
    }

    fn finish(&mut self, id: NodeId, state: State, kind: NodeKind) {
        let result = self.push(kind, self.source.node(id).origin);
        if self.uses[id.index()] > 1 {
            self.memo.insert((id, state), result);
        }
        self.results.push(result);
    }

    fn push(&mut self, kind: NodeKind, origin: Span) -> NodeId {
        let mut interior = self.interior_of(&kind);
        if let Interior::One(material) = interior {
            // Faces are the leaf's, not what fills it.
            interior = Interior::One(self.with_faces(material, Vec::new()));
        }
        self.out.push(Node { kind, origin });
        self.interior.push(interior);
        NodeId(self.out.len() as u32 - 1)
    }

    /// Materials of interiors are in the node's own space.
    fn interior_of(&mut self, kind: &NodeKind) -> Interior {
        match kind {
            NodeKind::Leaf(leaf) => match **leaf {
                Leaf::Solid { material: Some(material), ref parent_from_object, .. } => {
                    Interior::One(self.moved_material(material, &inverse(parent_from_object)))
                }
                _ => Interior::Empty,
            },
            NodeKind::Transform { parent_from_child, child } => match self.interior[child.index()] {
                Interior::One(material) => Interior::One(self.moved_material(material, &inverse(parent_from_child))),
                other => other,
            },
            NodeKind::Union(operands) | NodeKind::Group(operands) => {
                operands.iter().fold(Interior::Empty, |sum, operand| match (sum, self.interior[operand.index()]) {
                    (Interior::Empty, other) | (other, Interior::Empty) => other,
                    (a, b) if a == b => a,
                    _ => Interior::Mixed,
                })
            }
            NodeKind::Light(_) | NodeKind::Environment(_) => Interior::Empty,
            kind => kind.children().first().map_or(Interior::Empty, |first| self.interior[first.index()]),
        }
    }

    fn attach(&mut self, mut state: State, attributes: Attributes, precedence: Precedence) -> State {
        self.log.fire(if precedence == Precedence::Inner { "attach" } else { "override" });
        if let Some(face) = attributes.face {
            state.faces = self.attach_to_face(state.faces, face, attributes);
            return state;
        }
        match precedence {
            Precedence::Inner => {
                let attached = &mut state.attached;
                attached.bsdf = attributes.bsdf.or(attached.bsdf);
                attached.emitter = attributes.emitter.or(attached.emitter);
                attached.medium = attributes.medium.or(attached.medium);
                attached.cut = attributes.cut.or(attached.cut);
            }
            Precedence::Outer => {
                let forced = &mut state.forced;
                forced.bsdf = forced.bsdf.or(attributes.bsdf);
                forced.emitter = forced.emitter.or(attributes.emitter);
                forced.medium = forced.medium.or(attributes.medium);
                forced.cut = forced.cut.or(attributes.cut);
            }
        }
        if let (Some(minuend), Some(_)) = (state.cutting, attributes.cut) {
            state.cover = self.cover(&state, minuend);
        }
        state
    }

    /// The list with more on a face. Few lists differ, so that looking them up one by one is enough.
    fn attach_to_face(&mut self, list: u32, face: u32, attributes: Attributes) -> u32 {
        let mut faces = self.faces[list as usize].clone();
        let at = faces.partition_point(|entry| entry.face < face);
        if faces.get(at).is_none_or(|entry| entry.face != face) {
            faces.insert(at, FaceAttributes { face, bsdf: None, emitter: None });
        }
        let entry = &mut faces[at];
        entry.bsdf = attributes.bsdf.or(entry.bsdf);
        entry.emitter = attributes.emitter.or(entry.emitter);
        self.face_list(faces)
    }

    fn face_list(&mut self, faces: Vec<FaceAttributes>) -> u32 {
        let known = self.faces.iter().rposition(|list| *list == faces);
        known.unwrap_or_else(|| {
            self.faces.push(faces);
            self.faces.len() - 1
        }) as u32
    }

    /// What a wall shows under the cut rule in force, if there is one.
    fn cover(&mut self, state: &State, minuend: Option<MaterialId>) -> Option<MaterialId> {
        match state.forced.cut.or(state.attached.cut)? {
            CutRule::Inherit => {
                self.log.fire("inherit");
                minuend
            }
            CutRule::Bsdf(bsdf) => {
                self.log.fire("cut_with");
                Some(self.material(state.forced.bsdf.or(Some(bsdf)), state.forced.emitter, None))
            }
        }
    }

    fn leaf(&mut self, leaf: &Leaf, state: &State) -> Leaf {
        let mut leaf = leaf.clone();
        let (Leaf::Solid { material, parent_from_object, .. } | Leaf::Surface { material, parent_from_object, .. }) =
            &leaf;
        let own = *material;
        let state = &self.moved(*state, parent_from_object);
        let own = own.map(|id| &self.source.materials[id.0 as usize]);
        let forced = state.forced;
        let mut bsdf = own.and_then(|own| own.bsdf).or(state.attached.bsdf);
        let mut emitter = own.and_then(|own| own.emitter).or(state.attached.emitter);
        let medium = forced.medium.or(own.and_then(|own| own.medium)).or(state.attached.medium);
        let count = match &leaf {
            Leaf::Solid { shape, .. } => shape.face_count(),
            Leaf::Surface { .. } => 0,
        };
        let mut faces = self.face_attributes(own, state);
        faces.retain(|entry| entry.face < count);
        if count == 1 {
            // One face is the whole, and stays so when an unbounded shape is given ends.
            for entry in faces.drain(..) {
                bsdf = entry.bsdf.or(bsdf);
                emitter = entry.emitter.or(emitter);
            }
        }
        let (bsdf, emitter) = (forced.bsdf.or(bsdf), forced.emitter.or(emitter));
        let covered = state.cover.unwrap_or_else(|| {
            let plain = self.material(bsdf, emitter, medium);
            let mut others = Vec::new();
            for entry in faces {
                let bsdf = forced.bsdf.or(entry.bsdf).or(bsdf);
                let emitter = forced.emitter.or(entry.emitter).or(emitter);
                let material = self.material(bsdf, emitter, medium);
                others.extend((material != plain).then_some((entry.face, material)));
            }
            self.with_faces(plain, others)
        });
        let (Leaf::Solid { material, .. } | Leaf::Surface { material, .. }) = &mut leaf;
        *material = Some(covered);
        leaf
    }

    /// What is attached to faces, with those of a material that the leaf already has.
    fn face_attributes(&self, own: Option<&Material>, state: &State) -> Vec<FaceAttributes> {
        let mut faces = self.faces[state.faces as usize].clone();
        for &(face, id) in own.map_or(&[][..], |own| &own.faces) {
            let Material { bsdf, emitter, .. } = self.source.materials[id.0 as usize];
            faces.retain(|entry| entry.face != face);
            faces.push(FaceAttributes { face, bsdf, emitter });
        }
        faces.sort_unstable_by_key(|entry| entry.face);
        faces
    }

    /// The material of these entries of the source's tables.
    fn material(&mut self, bsdf: Option<u32>, emitter: Option<u32>, medium: Option<u32>) -> MaterialId {
        MaterialId(self.materials.intern(Material {
            bsdf: bsdf.map(|bsdf| self.bsdfs.index(bsdf)),
            emitter: emitter.map(|emitter| self.emitter[emitter as usize]),
            medium: medium.map(|medium| self.medium[medium as usize]),
            inside: None,
            faces: Vec::new(),
        }))
    }

    /// What surrounds a node, for its child or the object under its map.
    fn moved(&mut self, mut state: State, parent_from_child: &DAffine3) -> State {
        if !self.bsdfs.any_local() {
            return state;
        }
        for attributes in [&mut state.attached, &mut state.forced] {
            attributes.bsdf = attributes.bsdf.map(|bsdf| self.bsdfs.moved(bsdf, parent_from_child));
            if let Some(CutRule::Bsdf(bsdf)) = &mut attributes.cut {
                *bsdf = self.bsdfs.moved(*bsdf, parent_from_child);
            }
        }
        let mut faces = self.faces[state.faces as usize].clone();
        for bsdf in faces.iter_mut().filter_map(|entry| entry.bsdf.as_mut()) {
            *bsdf = self.bsdfs.moved(*bsdf, parent_from_child);
        }
        state.faces = self.face_list(faces);
        state.cutting = state.cutting.map(|cut| cut.map(|id| self.moved_material(id, parent_from_child)));
        state.cover = state.cover.map(|id| self.moved_material(id, parent_from_child));
        state
    }

    /// A finished material in the space of a child.
    fn moved_material(&mut self, id: MaterialId, parent_from_child: &DAffine3) -> MaterialId {
        let material = &self.materials.values[id.0 as usize];
        let Some(bsdf) = material.bsdf else { return id };
        let bsdf = self.bsdfs.moved_index(bsdf, parent_from_child);
        let material = Material { bsdf: Some(bsdf), ..material.clone() };
        MaterialId(self.materials.intern(material))
    }

    /// A material with these faces instead of its own.
    fn with_faces(&mut self, id: MaterialId, faces: Vec<(u32, MaterialId)>) -> MaterialId {
        let material = &self.materials.values[id.0 as usize];
        if material.faces == faces {
            return id;
        }
        let material = Material { faces, ..material.clone() };
        MaterialId(self.materials.intern(material))
    }

    /// The minuend of a difference is the last result: goes on to what is subtracted from it.
    fn minuend(&mut self, id: NodeId, state: State) {
        let NodeKind::Difference(operands) = self.source.kind(id) else { unreachable!("a difference was entered") };
        let minuend = self.results[self.results.len() - 1];
        let own_rule = self.rule_on(operands[0]);
        let mut inner = state;
        if state.forced.cut.is_none() {
            inner.attached.cut = own_rule.or(state.attached.cut);
        }
        let rule = inner.forced.cut.or(inner.attached.cut);
        let inherits = rule == Some(CutRule::Inherit) || operands[1..].iter().any(|b| self.has_inherit[b.index()]);
        if inherits && self.interior[minuend.index()] == Interior::Mixed {
            self.log.fire("distribute_inherit");
            self.tasks.push(Task::SubtractNext { node: id, operand: 1, state: inner });
            return;
        }
        let inner = self.cutting(inner, minuend, None);
        self.tasks.push(Task::Rebuild { node: id, state });
        self.tasks.extend(operands[1..].iter().rev().map(|&node| Task::Enter { node, state: inner }));
    }

    /// The state for what is subtracted from a finished node.
    fn cutting(&mut self, mut state: State, minuend: NodeId, minuend_from_here: Option<&DAffine3>) -> State {
        let material = match self.interior[minuend.index()] {
            Interior::One(material) => {
                Some(minuend_from_here.map_or(material, |map| self.moved_material(material, map)))
            }
            Interior::Empty | Interior::Mixed => None,
        };
        state.cutting = Some(material);
        state.cover = self.cover(&state, material);
        state
    }

    /// The cut rule at the head of a node.
    fn rule_on(&self, mut id: NodeId) -> Option<CutRule> {
        let mut rule = None;
        loop {
            match self.source.kind(id) {
                NodeKind::Attributes { attributes, precedence, child } => {
                    match precedence {
                        Precedence::Inner => rule = attributes.cut.or(rule),
                        Precedence::Outer if attributes.cut.is_some() => return attributes.cut,
                        Precedence::Outer => {}
                    }
                    id = *child;
                }
                NodeKind::Transform { child, .. } => id = *child,
                _ => return rule,
            }
        }
    }

    fn subtract_next(&mut self, id: NodeId, operand: usize, state: State) {
        let NodeKind::Difference(operands) = self.source.kind(id) else { unreachable!("a difference was entered") };
        let Some(&subtrahend) = operands.get(operand) else { return };
        let (minuend, origin) = (self.pop(), self.source.node(id).origin);
        self.tasks.push(Task::SubtractNext { node: id, operand: operand + 1, state });
        self.tasks.push(Task::Subtract { minuend, operand: subtrahend, minuend_from_here: None, state, origin });
    }

    fn subtract(
        &mut self,
        minuend: NodeId,
        operand: NodeId,
        minuend_from_here: Option<Box<DAffine3>>,
        state: State,
        origin: Span,
    ) {
        let kind = self.out[minuend.index()].kind.clone();
        match kind {
            _ if self.interior[minuend.index()] != Interior::Mixed => {
                let state = self.cutting(state, minuend, minuend_from_here.as_deref());
                self.tasks.push(Task::Difference { minuend, minuend_from_here, origin });
                self.tasks.push(Task::Enter { node: operand, state });
            }
            NodeKind::Transform { parent_from_child, child } => {
                let child_from_parent = parent_from_child.inverse();
                let map = minuend_from_here.map_or(child_from_parent, |map| child_from_parent * *map);
                let minuend_from_here = Some(Box::new(map));
                self.tasks.push(Task::Wrap { parent_from_child, origin });
                self.tasks.push(Task::Subtract { minuend: child, operand, minuend_from_here, state, origin });
            }
            NodeKind::Union(parts) | NodeKind::Group(parts) => {
                self.tasks.push(Task::Union { operands: parts.len(), origin });
                self.tasks.extend(parts.into_iter().rev().map(|minuend| {
                    let minuend_from_here = minuend_from_here.clone();
                    Task::Subtract { minuend, operand, minuend_from_here, state, origin }
                }));
            }
            kind => {
                let first = kind.children()[0];
                self.tasks.push(Task::ReplaceFirst { node: minuend });
                self.tasks.push(Task::Subtract { minuend: first, operand, minuend_from_here, state, origin });
            }
        }
    }
}
