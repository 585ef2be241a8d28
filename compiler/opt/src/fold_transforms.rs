//! Folds transforms into the leaves, and lights and environments into the frame of the world.
//!
//! A member of the root group that is a large solid used by several members stays an instance, if the optimisation
//! is on: `Transform` over the shared solid, whose inner transforms are folded.
//!
//! Rewrites: `fold_into_leaf`, `fold_into_light`, `keep_instance`, `ungroup`.

use arsc_geometry::{DAffine3, DVec3, invert};
use arsc_ir::{Environment, Ir, Leaf, Light, Node, NodeId, NodeKind};
use rustc_hash::FxHashMap;

use crate::bounds::place;
use crate::pipeline::Log;

/// Solids with fewer leaves are copied instead of instanced.
pub(crate) const INSTANCE_LEAVES: u64 = 8;

enum Task {
    /// `map` indexes the table of maps; 0 is the identity.
    Enter {
        node: NodeId,
        map: u32,
    },
    Rebuild {
        node: NodeId,
        map: u32,
    },
}

struct Folding<'a, 'b> {
    source: &'a mut Ir,
    uses: Vec<u32>,
    out: Vec<Node>,
    maps: Vec<DAffine3>,
    memo: FxHashMap<(NodeId, u32), NodeId>,
    log: &'a mut Log<'b>,
}

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let places = member_count(&ir);
    if places > log.options.max_leaves {
        log.too_many_leaves(&ir, places);
        return ir;
    }
    let members = members(&ir, log);
    let uses = ir.uses();
    let expanded = ir.expanded_leaves();
    let instances = shared_solids(&ir, &members, &expanded, log.options.optimise);
    let mut total = 0u64;
    let mut counted: FxHashMap<NodeId, ()> = FxHashMap::default();
    for &(id, _) in &members {
        if !instances.contains_key(&id) || counted.insert(id, ()).is_none() {
            total = total.saturating_add(expanded[id.index()]);
        }
    }
    if total > log.options.max_leaves {
        log.too_many_leaves(&ir, total);
        return ir;
    }
    let origin = ir.node(ir.root).origin;
    let mut folding = Folding {
        uses,
        out: Vec::with_capacity(ir.nodes.len()),
        maps: vec![DAffine3::IDENTITY],
        memo: FxHashMap::default(),
        log,
        source: &mut ir,
    };
    let mut folded: Vec<NodeId> = Vec::with_capacity(members.len());
    for (id, map) in members {
        folded.push(folding.member(id, map, instances.contains_key(&id)));
    }
    let mut nodes = folding.out;
    folded.sort_by_key(|&id| rank(&nodes, id));
    nodes.push(Node { kind: NodeKind::Group(folded), origin });
    ir.root = NodeId(nodes.len() as u32 - 1);
    ir.nodes = nodes;
    ir
}

/// How many members [`members`] will find; saturating.
fn member_count(ir: &Ir) -> u64 {
    let mut counts = vec![1u64; ir.nodes.len()];
    for (id, node) in ir.nodes.iter().enumerate() {
        if let NodeKind::Group(_) | NodeKind::Transform { .. } = node.kind {
            let children = node.kind.children().iter();
            counts[id] = children.fold(0, |sum: u64, child| sum.saturating_add(counts[child.index()]));
        }
    }
    counts[ir.root.index()]
}

/// The members of the root group with nested groups dissolved and outer transforms taken off.
fn members(ir: &Ir, log: &mut Log) -> Vec<(NodeId, Option<DAffine3>)> {
    let mut members = Vec::new();
    let mut stack: Vec<(NodeId, Option<DAffine3>)> = vec![(ir.root, None)];
    while let Some((id, map)) = stack.pop() {
        match ir.kind(id) {
            NodeKind::Group(parts) => {
                if id != ir.root {
                    log.fire("ungroup");
                }
                stack.extend(parts.iter().rev().map(|&part| (part, map)));
            }
            NodeKind::Transform { parent_from_child, child } => {
                stack.push((*child, Some(map.map_or(**parent_from_child, |map| map * **parent_from_child))));
            }
            _ => members.push((id, map)),
        }
    }
    members
}

/// Solids that several members place, and that are worth an instance.
fn shared_solids(
    ir: &Ir,
    members: &[(NodeId, Option<DAffine3>)],
    expanded: &[u64],
    optimise: bool,
) -> FxHashMap<NodeId, u32> {
    let mut shared: FxHashMap<NodeId, u32> = FxHashMap::default();
    if optimise {
        for (id, _) in members {
            let is_boolean = !ir.kind(*id).children().is_empty();
            if is_boolean && expanded[id.index()] >= INSTANCE_LEAVES {
                *shared.entry(*id).or_default() += 1;
            }
        }
        shared.retain(|_, uses| *uses > 1);
    }
    shared
}

fn rank(nodes: &[Node], id: NodeId) -> u8 {
    match &nodes[id.index()].kind {
        NodeKind::Leaf(leaf) if matches!(**leaf, Leaf::Surface { .. }) => 1,
        NodeKind::Light(_) => 2,
        NodeKind::Environment(_) => 3,
        NodeKind::Transform { child, .. } => rank(nodes, *child),
        _ => 0,
    }
}

/// Nothing of the leaf is left in double precision.
fn is_degenerate(leaf: &Leaf) -> bool {
    match leaf {
        Leaf::Solid { .. } => place(leaf, &DAffine3::IDENTITY).is_none(),
        Leaf::Surface { parent_from_object, .. } => invert(parent_from_object).is_none(),
    }
}

impl Folding<'_, '_> {
    fn member(&mut self, id: NodeId, map: Option<DAffine3>, instance: bool) -> NodeId {
        let origin = self.source.node(id).origin;
        match self.source.kind(id) {
            NodeKind::Light(light) => {
                let light = (**light).clone();
                self.light(light, map.unwrap_or(DAffine3::IDENTITY), origin)
            }
            NodeKind::Environment(environment) => {
                let environment = environment.clone();
                let child = self.push(NodeKind::Environment(environment.clone()), origin);
                match map {
                    Some(map) if !matches!(*environment, Environment::Constant { .. } | Environment::Medium { .. }) => {
                        self.log.fire("fold_into_light");
                        let linear = DAffine3 { translation: DVec3::ZERO, ..map };
                        self.place(child, linear, origin)
                    }
                    _ => child,
                }
            }
            _ if instance => {
                self.log.fire("keep_instance");
                let child = self.fold(id, 0);
                self.place(child, map.unwrap_or(DAffine3::IDENTITY), origin)
            }
            _ => {
                let map = map.map_or(0, |map| self.map(map));
                self.fold(id, map)
            }
        }
    }

    fn light(&mut self, light: Light, map: DAffine3, origin: arsc_diagnostics::Span) -> NodeId {
        match light {
            Light::Point { intensity } => {
                let child = self.push(NodeKind::Light(Box::new(Light::Point { intensity })), origin);
                if map.translation == DVec3::ZERO {
                    return child;
                }
                self.log.fire("fold_into_light");
                self.place(child, DAffine3::from_translation(map.translation), origin)
            }
            light @ (Light::Spot { .. } | Light::Photometric { .. }) => {
                let child = self.push(NodeKind::Light(Box::new(light)), origin);
                if map == DAffine3::IDENTITY {
                    return child;
                }
                self.log.fire("fold_into_light");
                self.place(child, map, origin)
            }
            Light::Distant { irradiance, direction } => {
                let mapped = map.transform_vector3(direction);
                // A direction that is unit already keeps its bits.
                let direction = if mapped == direction { direction } else { mapped.normalize_or(direction) };
                self.push(NodeKind::Light(Box::new(Light::Distant { irradiance, direction })), origin)
            }
        }
    }

    fn place(&mut self, child: NodeId, map: DAffine3, origin: arsc_diagnostics::Span) -> NodeId {
        if invert(&map).is_none() {
            self.log.degenerate(origin);
        }
        self.push(NodeKind::Transform { parent_from_child: Box::new(map), child }, origin)
    }

    fn map(&mut self, map: DAffine3) -> u32 {
        self.maps.push(map);
        self.maps.len() as u32 - 1
    }

    fn push(&mut self, kind: NodeKind, origin: arsc_diagnostics::Span) -> NodeId {
        self.out.push(Node { kind, origin });
        NodeId(self.out.len() as u32 - 1)
    }

    fn fold(&mut self, id: NodeId, map: u32) -> NodeId {
        let mut tasks = vec![Task::Enter { node: id, map }];
        let mut results: Vec<NodeId> = Vec::new();
        while let Some(task) = tasks.pop() {
            match task {
                Task::Enter { node, map } => self.enter(node, map, &mut tasks, &mut results),
                Task::Rebuild { node, map } => {
                    let mut kind = self.source.kind(node).clone();
                    let children = kind.children_mut();
                    let first = results.len() - children.len();
                    children.copy_from_slice(&results[first..]);
                    results.truncate(first);
                    results.push(self.finish(node, map, kind));
                }
            }
        }
        results[0]
    }

    fn enter(&mut self, id: NodeId, map: u32, tasks: &mut Vec<Task>, results: &mut Vec<NodeId>) {
        if self.uses[id.index()] > 1
            && let Some(&done) = self.memo.get(&(id, map))
        {
            results.push(done);
            return;
        }
        match &self.source.nodes[id.index()].kind {
            NodeKind::Leaf(leaf) => {
                let mut leaf = leaf.clone();
                if map != 0 {
                    let (Leaf::Solid { parent_from_object, .. } | Leaf::Surface { parent_from_object, .. }) =
                        &mut *leaf;
                    *parent_from_object = self.maps[map as usize] * *parent_from_object;
                    if is_degenerate(&leaf) {
                        self.log.degenerate(self.source.node(id).origin);
                    }
                    self.log.fire("fold_into_leaf");
                }
                results.push(self.finish(id, map, NodeKind::Leaf(leaf)));
            }
            NodeKind::Transform { parent_from_child, child } => {
                let inner = if map == 0 { **parent_from_child } else { self.maps[map as usize] * **parent_from_child };
                tasks.push(Task::Enter { node: *child, map: self.maps.len() as u32 });
                self.maps.push(inner);
            }
            kind => {
                tasks.push(Task::Rebuild { node: id, map });
                tasks.extend(kind.children().iter().rev().map(|&node| Task::Enter { node, map }));
            }
        }
    }

    fn finish(&mut self, id: NodeId, map: u32, kind: NodeKind) -> NodeId {
        let result = self.push(kind, self.source.node(id).origin);
        if self.uses[id.index()] > 1 {
            self.memo.insert((id, map), result);
        }
        result
    }
}
