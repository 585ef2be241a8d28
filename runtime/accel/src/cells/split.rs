//! Where to cut a cell: least expected cost by the surface area heuristic.

use glam::DVec3;

use arsc_geometry::{Aabb, Classification, Placed, Shape};

use crate::expression::{Token, Word, substitute};

/// Cost of visiting a cell, in sphere intersections.
const CELL_COST: f64 = 3.0;
/// Above so many leaves candidates are judged by the leaves' boxes instead of by classification.
const EXACT_LEAVES: usize = 40;
const BINS: usize = 16;
/// Box edges tried per axis.
const EDGES: usize = 4;

/// Cost of intersecting a leaf, in sphere intersections.
pub fn weight(shape: &Shape) -> f64 {
    match shape {
        Shape::Torus { .. } => 7.0,
        Shape::Cone { .. } | Shape::Cylinder { .. } | Shape::Paraboloid(_) | Shape::Hyperboloid(_) => 2.0,
        Shape::Mesh(_) => 40.0,
        Shape::Prism(_) | Shape::Polyhedron(_) => 6.0,
        Shape::Superquadric(_) | Shape::Lathe(_) => 40.0,
        _ => 1.0,
    }
}

/// A plane, and the cost of the two halves relative to the whole.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    pub axis: usize,
    pub position: f64,
    pub relative_cost: f64,
}

fn half_area(b: &Aabb) -> f64 {
    let e = b.extent().max(DVec3::ZERO);
    e.x * e.y + e.y * e.z + e.z * e.x
}

pub fn halves(cell: &Aabb, axis: usize, position: f64) -> [Aabb; 2] {
    let (mut low, mut high) = (*cell, *cell);
    low.max[axis] = position;
    high.min[axis] = position;
    [low, high]
}

/// The best plane found; `None` when the cell is flat or a point. `pad` dilates boxes for classification.
pub fn best_split(cell: &Aabb, leaves: &[u32], tokens: &[Token], placed: &[Placed], pad: f64) -> Option<Split> {
    let whole = half_area(cell) * (CELL_COST + total_weight(leaves, placed));
    let mut best: Option<Split> = None;
    let mut scratch = Vec::new();
    let clipped: Vec<Aabb> = leaves.iter().map(|&leaf| placed[leaf as usize].bounds().intersection(cell)).collect();
    for axis in 0..3 {
        let (low, high) = (cell.min[axis], cell.max[axis]);
        if high - low <= 8.0 * pad {
            continue;
        }
        let planes = positions(low, high, axis, &clipped);
        let exact = leaves.len() <= EXACT_LEAVES;
        let known = if exact { nested_states(cell, axis, &planes, leaves, placed, pad) } else { [vec![], vec![]] };
        for (i, &position) in planes.iter().enumerate() {
            let ranks = [i, planes.len() - 1 - i];
            let halves = halves(cell, axis, position);
            let cost = |side: usize, scratch: &mut Vec<Token>| {
                let half = &halves[side];
                let weight = if exact {
                    exact_weight(leaves, tokens, placed, |leaf| known[side][leaf].at(ranks[side]), scratch)
                } else {
                    overlapping_weight(half, leaves, &clipped, placed)
                };
                half_area(half) * weight
            };
            let relative_cost = (cost(0, &mut scratch) + cost(1, &mut scratch)) / whole;
            if best.is_none_or(|best| relative_cost < best.relative_cost) {
                best = Some(Split { axis, position, relative_cost });
            }
        }
    }
    best
}

fn total_weight(leaves: &[u32], placed: &[Placed]) -> f64 {
    leaves.iter().map(|&leaf| weight(placed[leaf as usize].shape())).sum()
}

/// A leaf's state over nested boxes, which are ranked from the smallest: that of all before `count`; beyond it has none.
#[derive(Clone, Copy)]
struct Nested {
    count: usize,
    state: Option<bool>,
}

impl Nested {
    fn at(self, rank: usize) -> Option<bool> {
        if rank < self.count { self.state } else { None }
    }
}

/// What every leaf is over the lower and over the upper halves that the planes (ascending) make. A state of a box is that of
/// every box within, so bisection finds them all.
fn nested_states(
    cell: &Aabb,
    axis: usize,
    planes: &[f64],
    leaves: &[u32],
    placed: &[Placed],
    pad: f64,
) -> [Vec<Nested>; 2] {
    [0, 1].map(|side| {
        let plane = |rank: usize| planes[if side == 0 { rank } else { planes.len() - 1 - rank }];
        let half = |rank: usize| halves(cell, axis, plane(rank))[side].dilated(pad);
        let nested = |&leaf: &u32| {
            let mut nested = Nested { count: 0, state: None };
            let mut end = planes.len();
            while nested.count < end {
                let middle = (nested.count + end) / 2;
                match state(&placed[leaf as usize], &half(middle)) {
                    Some(state) => nested = Nested { count: middle + 1, state: Some(state) },
                    None => end = middle,
                }
            }
            nested
        };
        leaves.iter().map(nested).collect()
    })
}

/// Planes to try, ascending: even ones, and with few leaves some edges of their boxes.
fn positions(low: f64, high: f64, axis: usize, clipped: &[Aabb]) -> Vec<f64> {
    let even = if clipped.len() > EXACT_LEAVES { BINS } else { 4 };
    let mut list: Vec<f64> = (1..even).map(|i| low + (high - low) * i as f64 / even as f64).collect();
    if clipped.len() <= EXACT_LEAVES {
        let slack = 0.02 * (high - low);
        let within = |&x: &f64| x > low + slack && x < high - slack;
        let mut edges: Vec<f64> = clipped.iter().flat_map(|b| [b.min[axis], b.max[axis]]).filter(within).collect();
        edges.sort_unstable_by(f64::total_cmp);
        edges.dedup();
        let stride = edges.len().div_ceil(EDGES).max(1);
        list.extend(edges.iter().skip(stride / 2).step_by(stride));
        list.sort_unstable_by(f64::total_cmp);
    }
    list
}

fn overlapping_weight(half: &Aabb, leaves: &[u32], clipped: &[Aabb], placed: &[Placed]) -> f64 {
    let overlapping = leaves.iter().zip(clipped).filter(|(_, bounds)| bounds.overlaps(half));
    let sum: f64 = overlapping.map(|(&leaf, _)| weight(placed[leaf as usize].shape())).sum();
    if sum > 0.0 { CELL_COST + sum } else { 0.0 }
}

/// Weight of what is left of the expression; nothing for a cell without surface. `state` gives the state of a leaf by its
/// position in the list.
fn exact_weight(
    leaves: &[u32],
    tokens: &[Token],
    placed: &[Placed],
    state: impl Fn(usize) -> Option<bool>,
    scratch: &mut Vec<Token>,
) -> f64 {
    let value = |leaf: u32| leaves.binary_search(&leaf).ok().and_then(&state);
    scratch.clear();
    if substitute(tokens, value, scratch).is_some() {
        return 0.0;
    }
    let literal = |token: &Token| match token.word() {
        Word::Literal { leaf, .. } => weight(placed[leaf as usize].shape()),
        Word::Node { .. } => 0.0,
    };
    CELL_COST + scratch.iter().map(literal).sum::<f64>()
}

/// The leaf's constant state over the box, if it has one.
pub fn state(leaf: &Placed, region: &Aabb) -> Option<bool> {
    match leaf.classify(region) {
        Classification::Outside => Some(false),
        Classification::Inside => Some(true),
        Classification::Boundary => None,
    }
}
