//! The operator tree of a solid with a box at every node: the structure of `tree`.
//!
//! A node's box holds where it is true, and beyond it is false; below a subtraction it holds where the node is false,
//! and beyond it is true. A node whose box the ray misses is the constant that it is outside; an operator that one
//! operand decides all along the ray is not looked at further (an intersection of which the ray misses one operand). What is
//! asked below a node is only what lies in the part of the ray that is within the boxes above. Operands of one operator,
//! however the script nested them, are grouped by place into a hierarchy of boxes: order does not matter to the value, and
//! owners of coincident faces go by the numbers of leaves.
//!
//! Why leaving out is right: let every literal have either its true value or the one that it has outside its box. Then by
//! induction every node with a box has its outside value beyond it, and its true value within the boxes of all nodes
//! above it; the root is right along the whole ray. This is the scene graph with its bounding boxes of the thesis's
//! section 3.5.2 (T. L. Kay and J. T. Kajiya, "Ray tracing complex scenes", 1986; S. D. Roth, 1982), well cared for.

use glam::DVec3;

use arsc_geometry::Aabb;

use crate::expression::{Expression, Op, Token, Word};
use crate::query::slab;
use crate::solid::SolidModel;
use crate::strategies::gather::{Gathered, Mark, SolidLine};
use crate::strategies::kd_tree::Mailbox;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Literal {
        leaf: u32,
        negated: bool,
    },
    Operator(Op),
    /// Never other than beyond its box.
    Absent,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// The value of a node beyond its box.
    beyond: bool,
    /// Position after the last node below.
    end: u32,
    kind: Kind,
}

/// Nodes in prefix order.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    nodes: Vec<Node>,
}

/// An operator under way.
#[derive(Clone, Copy, Debug)]
pub struct Open {
    op: Op,
    end: u32,
    mark: Mark,
    /// Of the ray, above the operator.
    range: (f64, f64),
    varies: bool,
    bare: bool,
}

impl BoxTree {
    pub fn new(solid: &SolidModel, pad: f64) -> BoxTree {
        let Expression::Tokens(tokens) = &solid.expression else { return BoxTree::default() };
        Builder::new(solid, tokens, pad).build()
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
    }

    /// Crosses the leaves that may matter to the value between the ray's start and its end.
    pub fn gather(&self, line: &SolidLine, open: &mut Vec<Open>, met: &mut Mailbox, gathered: &mut Gathered) {
        met.begin(line.solid.leaves.len());
        open.clear();
        let (mut low, mut high) = (line.ray.start, line.ray.end);
        let mut i = 0;
        while let Some(node) = self.nodes.get(i as usize) {
            let (enter, exit) = slab(&node.bounds, line.ray.origin, line.inverse_dir);
            let within = (earlier(enter).max(low), (-earlier(-exit)).min(high));
            let mut along = if within.0 <= within.1 {
                match node.kind {
                    Kind::Operator(op) => {
                        open.push(Open::new(op, node.end, gathered.mark(), (low, high)));
                        (low, high) = within;
                        i += 1;
                        continue;
                    }
                    Kind::Absent => Along::Constant { value: node.beyond, bare: true },
                    Kind::Literal { leaf, negated } => literal(line, leaf, negated, within, met, gathered),
                }
            } else {
                Along::Constant { value: node.beyond, bare: true }
            };
            i = node.end;
            // Close every operator that ends here or is decided.
            while let Some(top) = open.last_mut() {
                along = match top.take(along) {
                    Some(decided) => decided,
                    None if i < top.end => break,
                    None => top.sum(),
                };
                if let Along::Constant { bare: true, .. } = along {
                    gathered.rewind(top.mark, |leaf| met.forget(leaf));
                }
                i = top.end;
                (low, high) = top.range;
                open.pop();
            }
        }
    }
}

/// Before `t` by more than the roundings of a crossing there: boxes of unbounded solids are met far away in terms of their
/// padding.
#[inline]
fn earlier(t: f64) -> f64 {
    const ROUNDING: f64 = 1.0 / (1u64 << 44) as f64;
    t * if t > 0.0 { 1.0 - ROUNDING } else { 1.0 + ROUNDING }
}

/// What is known of a node's value between two points of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Along {
    Varies,
    /// `bare`: also if the leaves below it count as outside.
    Constant {
        value: bool,
        bare: bool,
    },
}

fn literal(
    line: &SolidLine,
    leaf: u32,
    negated: bool,
    (low, high): (f64, f64),
    met: &mut Mailbox,
    gathered: &mut Gathered,
) -> Along {
    if !met.is_new(leaf) {
        return Along::Varies;
    }
    let mark = gathered.mark();
    gathered.cross(line, leaf);
    let Some(inside) = gathered.constant_since(mark, low, high) else { return Along::Varies };
    if !inside {
        gathered.rewind(mark, |_| {});
        met.forget(leaf);
    }
    Along::Constant { value: inside != negated, bare: !inside }
}

impl Open {
    fn new(op: Op, end: u32, mark: Mark, range: (f64, f64)) -> Open {
        Open { op, end, mark, range, varies: false, bare: true }
    }

    /// Takes note of an operand; the operator's value if that decides it.
    fn take(&mut self, operand: Along) -> Option<Along> {
        match operand {
            Along::Varies => self.varies = true,
            Along::Constant { value, .. } if value == self.op.absorbing() => return Some(operand),
            Along::Constant { bare, .. } => self.bare &= bare,
        }
        None
    }

    /// The operator's value when no operand decides it.
    fn sum(&self) -> Along {
        if self.varies { Along::Varies } else { Along::Constant { value: !self.op.absorbing(), bare: self.bare } }
    }
}

/// Writes the nodes.
struct Builder<'a> {
    tokens: &'a [Token],
    /// Box and outside value of every token's node.
    operands: Vec<(Aabb, bool)>,
    nodes: Vec<Node>,
}

/// What is still to be written.
enum Step {
    Operand(usize),
    /// Operands that are neutral beyond their boxes, under a box for all.
    Group {
        op: Op,
        operands: Vec<usize>,
    },
    Close(usize),
}

impl<'a> Builder<'a> {
    fn new(solid: &SolidModel, tokens: &'a [Token], pad: f64) -> Builder<'a> {
        let operands = operand_boxes(tokens, |leaf| solid.leaves[leaf as usize].bounds().dilated(pad));
        Builder { tokens, operands, nodes: Vec::with_capacity(2 * tokens.len()) }
    }

    fn build(mut self) -> BoxTree {
        let mut steps = vec![Step::Operand(0)];
        while let Some(step) = steps.pop() {
            match step {
                Step::Close(node) => self.nodes[node].end = self.nodes.len() as u32,
                Step::Operand(token) => self.operand(token, &mut steps),
                Step::Group { op, operands } => self.group(op, operands, &mut steps),
            }
        }
        BoxTree { nodes: self.nodes }
    }

    fn push(&mut self, kind: Kind, (bounds, beyond): (Aabb, bool)) {
        let end = self.nodes.len() as u32 + 1;
        self.nodes.push(Node { bounds, beyond, end, kind });
    }

    fn operand(&mut self, token: usize, steps: &mut Vec<Step>) {
        if self.operands[token].0.is_empty() {
            return self.push(Kind::Absent, self.operands[token]);
        }
        match self.tokens[token].word() {
            Word::Literal { leaf, negated } => self.push(Kind::Literal { leaf, negated }, self.operands[token]),
            Word::Node { op, length } => {
                steps.push(Step::Close(self.nodes.len()));
                self.push(Kind::Operator(op), self.operands[token]);
                let neutral = |&operand: &usize| self.operands[operand].1 != op.absorbing();
                let (mut groups, mut deciding): (Vec<usize>, Vec<usize>) =
                    children(self.tokens, token + 1, token + length as usize).partition(neutral);
                // Those that decide when they are missed come first, short ones before long ones.
                deciding.sort_by_key(|&operand| length_of(self.tokens[operand]));
                if groups.len() > 1 {
                    let operands = std::mem::take(&mut groups);
                    steps.push(Step::Group { op, operands });
                }
                deciding.extend(groups);
                steps.extend(deciding.into_iter().rev().map(Step::Operand));
            }
        }
    }

    fn group(&mut self, op: Op, mut operands: Vec<usize>, steps: &mut Vec<Step>) {
        let boxes = operands.iter().map(|&operand| self.operands[operand].0);
        let bounds = boxes.fold(Aabb::EMPTY, |hull, b| hull.union(&b));
        steps.push(Step::Close(self.nodes.len()));
        self.push(Kind::Operator(op), (bounds, !op.absorbing()));
        let above = halve(&mut operands, |operand| self.operands[operand].0);
        for half in [above, operands] {
            match half[..] {
                [operand] => steps.push(Step::Operand(operand)),
                _ => steps.push(Step::Group { op, operands: half }),
            }
        }
    }
}

fn length_of(token: Token) -> usize {
    match token.word() {
        Word::Literal { .. } => 1,
        Word::Node { length, .. } => length as usize,
    }
}

/// Positions of the operands between two positions.
fn children(tokens: &[Token], first: usize, end: usize) -> impl Iterator<Item = usize> + '_ {
    let within = move |at: usize| (at < end).then_some(at);
    std::iter::successors(within(first), move |&at| within(at + length_of(tokens[at])))
}

/// For every token the box of its node, and the node's value beyond it: where it may be true, or if that is not finite
/// where it may be false.
fn operand_boxes(tokens: &[Token], leaf_bounds: impl Fn(u32) -> Aabb) -> Vec<(Aabb, bool)> {
    // Where each is true, and where it is false; operands come after their operators.
    let mut boxes = vec![(Aabb::EVERYTHING, Aabb::EVERYTHING); tokens.len()];
    for at in (0..tokens.len()).rev() {
        boxes[at] = match tokens[at].word() {
            Word::Literal { leaf, negated: false } => (leaf_bounds(leaf), Aabb::EVERYTHING),
            Word::Literal { leaf, negated: true } => (Aabb::EVERYTHING, leaf_bounds(leaf)),
            Word::Node { op, length } => {
                let operands = || children(tokens, at + 1, at + length as usize).map(|operand| boxes[operand]);
                let all = |pick: fn((Aabb, Aabb)) -> Aabb| {
                    operands().map(pick).fold(Aabb::EVERYTHING, |hull, b| hull.intersection(&b))
                };
                let any =
                    |pick: fn((Aabb, Aabb)) -> Aabb| operands().map(pick).fold(Aabb::EMPTY, |hull, b| hull.union(&b));
                if op == Op::And { (all(|b| b.0), any(|b| b.1)) } else { (any(|b| b.0), all(|b| b.1)) }
            }
        };
    }
    let usable = |b: &Aabb| b.is_finite() || b.is_empty();
    let choose = |(holds, fails): (Aabb, Aabb)| {
        let complement = !usable(&holds) && (usable(&fails) || holds == Aabb::EVERYTHING);
        let (bounds, beyond) = if complement { (fails, true) } else { (holds, false) };
        (if bounds.is_empty() { Aabb::EMPTY } else { bounds }, beyond)
    };
    boxes.into_iter().map(choose).collect()
}

const BINS: usize = 16;

/// Splits a list of two or more in two by place, after the surface area heuristic over bins of the centres; returns the
/// upper part.
fn halve(list: &mut Vec<usize>, bounds: impl Fn(usize) -> Aabb) -> Vec<usize> {
    let center = |item: usize| {
        let b = bounds(item);
        if b.is_finite() { b.center() } else { DVec3::ZERO }
    };
    let spread = list.iter().fold(Aabb::EMPTY, |hull, &item| hull.union(&Aabb::new(center(item), center(item))));
    let extent = spread.extent();
    let axis = if extent.x >= extent.y.max(extent.z) { 0 } else { usize::from(extent.y < extent.z) + 1 };
    let scale = BINS as f64 / extent[axis];
    let bin = |item: usize| (((center(item)[axis] - spread.min[axis]) * scale) as usize).min(BINS - 1);
    let mut bins = [(Aabb::EMPTY, 0usize); BINS];
    for &item in list.iter() {
        let (hull, count) = &mut bins[bin(item)];
        (*hull, *count) = (hull.union(&bounds(item)), *count + 1);
    }
    let sum = |part: &[(Aabb, usize)]| {
        let (hull, count) = part.iter().fold((Aabb::EMPTY, 0), |(h, n), (b, m)| (h.union(b), n + m));
        let e = hull.extent();
        if count == 0 { f64::INFINITY } else { count as f64 * (e.x * e.y + e.y * e.z + e.z * e.x) }
    };
    let cost = |cut: &usize| sum(&bins[..*cut]) + sum(&bins[*cut..]);
    let cut = (1..BINS).min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(1);
    let (below, above): (Vec<usize>, Vec<usize>) = list.iter().partition(|&&item| bin(item) < cut);
    if below.is_empty() || above.is_empty() {
        return list.split_off(list.len() / 2);
    }
    *list = below;
    above
}
