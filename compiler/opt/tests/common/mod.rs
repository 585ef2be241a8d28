//! A small, obvious evaluator of scenes along rays, and random scenes to try it on.

pub mod random;

use arsc_geometry::{DAffine3, DVec3, Placed};
use arsc_ir::{Ir, Leaf, NodeId, NodeKind};

/// A wall: where, of which material, and whether the ray gets into the solid there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    pub t: f64,
    pub material: u32,
    pub enters: bool,
}

/// A leaf of one member with the crossings of a ray.
struct Line {
    material: u32,
    crossings: arsc_geometry::Crossings,
}

/// Every wall of every solid of an IR in the normal form along a ray, sorted by `t`, for `t > 0`.
///
/// Crossings closer than `tolerance` are one event; the first leaf that matters in the event owns the wall.
pub fn walls(ir: &Ir, origin: DVec3, dir: DVec3, tolerance: f64) -> Vec<Wall> {
    let NodeKind::Group(members) = ir.kind(ir.root) else { panic!("the root is no group") };
    let mut walls = Vec::new();
    for &member in members {
        let (solid, map) = match ir.kind(member) {
            NodeKind::Transform { parent_from_child, child } => (*child, **parent_from_child),
            _ => (member, DAffine3::IDENTITY),
        };
        let mut lines = Vec::new();
        collect(ir, solid, &map, origin, dir, &mut lines);
        if !lines.is_empty() {
            walls.extend(solid_walls(ir, solid, &lines, tolerance));
        }
    }
    walls.sort_by(|a, b| a.t.total_cmp(&b.t));
    walls
}

fn collect(ir: &Ir, id: NodeId, map: &DAffine3, origin: DVec3, dir: DVec3, lines: &mut Vec<Line>) {
    match ir.kind(id) {
        NodeKind::Leaf(leaf) => {
            if let Leaf::Solid { shape, parent_from_object, material } = &**leaf {
                let placed = Placed::new(shape.clone(), *map * *parent_from_object).expect("leaves can be placed");
                let material = material.expect("every leaf has a material").0;
                lines.push(Line { material, crossings: placed.crossings(origin, dir) });
            }
        }
        kind => kind.children().iter().for_each(|&child| collect(ir, child, map, origin, dir, lines)),
    }
}

/// Whether a point is in the solid, given for each leaf whether it is in that; leaves in the order of `collect`.
fn inside(ir: &Ir, id: NodeId, leaves: &[bool], next: &mut usize) -> bool {
    match ir.kind(id) {
        NodeKind::Leaf(_) => {
            *next += 1;
            leaves[*next - 1]
        }
        kind => {
            let of: Vec<bool> = kind.children().iter().map(|&child| inside(ir, child, leaves, next)).collect();
            match kind {
                NodeKind::Union(_) => of.iter().any(|&x| x),
                NodeKind::Intersection(_) => of.iter().all(|&x| x),
                NodeKind::Difference(_) => of[0] && !of[1..].iter().any(|&x| x),
                _ => panic!("a solid holds only Boolean nodes and leaves"),
            }
        }
    }
}

fn solid_walls(ir: &Ir, id: NodeId, lines: &[Line], tolerance: f64) -> Vec<Wall> {
    let mut events: Vec<(f64, usize)> =
        lines.iter().enumerate().flat_map(|(i, line)| line.crossings.t().iter().map(move |&t| (t, i))).collect();
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let value = |leaves: &[bool]| inside(ir, id, leaves, &mut 0);
    let mut before: Vec<bool> = lines.iter().map(|line| line.crossings.inside_before).collect();
    let mut walls: Vec<Wall> = Vec::new();
    let mut state = value(&before);
    let mut first = 0;
    while first < events.len() {
        let mut last = first;
        while last + 1 < events.len() && events[last + 1].0 - events[last].0 < tolerance {
            last += 1;
        }
        let mut after = before.clone();
        events[first..=last].iter().for_each(|&(_, leaf)| after[leaf] = !after[leaf]);
        if value(&after) != state {
            state = !state;
            // The first leaf that makes the difference on its own, or without which there is none.
            let mut crossed: Vec<usize> = (0..lines.len()).filter(|&leaf| before[leaf] != after[leaf]).collect();
            let flipped = |leaves: &[bool], leaf: usize| {
                let mut leaves = leaves.to_vec();
                leaves[leaf] = !leaves[leaf];
                value(&leaves)
            };
            let all = crossed.clone();
            crossed.retain(|&leaf| flipped(&before, leaf) == state || flipped(&after, leaf) != state);
            let owner = *crossed.first().or(all.first()).expect("some leaf changed");
            walls.push(Wall { t: events[first].0, material: lines[owner].material, enters: state });
        }
        before = after;
        first = last + 1;
    }
    walls.retain(|wall| wall.t > 0.0);
    walls
}
