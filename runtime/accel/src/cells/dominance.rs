//! Leaves that decide each other within a cell.
//!
//! For two spheres `f_A − f_B` is linear (the radical plane), so "A within the cell lies in B" is an exact test over the
//! box; the same holds for half-spaces. Below an OR with the literal B everything may assume to be outside B (below an
//! AND, inside), so a leaf that B decides becomes a constant. Replacements are made one after the other, each sound in
//! the expression that the ones before left. All relations are strict by several tolerances: leaves that coincide never
//! dominate each other, so the owner of a coincident face stays.

use glam::DVec3;

use arsc_geometry::{Aabb, Placed, Shape};

use crate::expression::{Op, Token, Word};

/// A leaf as `f <= 0` with a known quadratic part: 1 for spheres, 0 for half-spaces.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    Sphere { center: DVec3, radius: f64 },
    HalfSpace { normal: DVec3, offset: f64 },
}

impl Form {
    /// `None` for shapes that have no such form, ellipsoids among them.
    pub fn new(leaf: &Placed) -> Option<Form> {
        let map = leaf.world_from_object();
        match *leaf.shape() {
            Shape::Sphere { radius } => {
                let m = map.matrix3;
                let scale = m.x_axis.length();
                let off = m.transpose() * m - glam::DMat3::from_diagonal(DVec3::splat(scale * scale));
                let skew = off.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
                let similar = skew <= 1e-14 * scale * scale;
                similar.then_some(Form::Sphere { center: map.translation, radius: radius * scale })
            }
            Shape::HalfSpace => {
                let inverse = leaf.object_from_world();
                let row = inverse.matrix3.transpose().z_axis;
                let length = row.length();
                Some(Form::HalfSpace { normal: row / length, offset: inverse.translation.z / length })
            }
            _ => None,
        }
    }

    /// Value and gradient of the non-quadratic part at `p` (`f` itself for the value).
    fn at(&self, p: DVec3) -> (f64, DVec3) {
        match *self {
            Form::Sphere { center, radius } => {
                let distance = p.distance(center);
                ((distance - radius) * (distance + radius), -2.0 * center)
            }
            Form::HalfSpace { normal, offset } => (normal.dot(p) + offset, normal),
        }
    }

    /// What `f` must differ by so that surfaces are `gap` apart.
    fn margin(&self, gap: f64) -> f64 {
        match self {
            Form::Sphere { radius, .. } => gap * (2.0 * radius + gap),
            Form::HalfSpace { .. } => gap,
        }
    }
}

/// The state of `a` in the cell where that of `b` is known, if it follows.
fn decided(a: &Form, b: &Form, b_inside: bool, cell: &Aabb, gap: f64) -> Option<bool> {
    let same_kind = matches!(a, Form::Sphere { .. }) == matches!(b, Form::Sphere { .. });
    if !same_kind {
        return None;
    }
    let (center, half) = (cell.center(), cell.extent() * 0.5);
    let ((fa, ga), (fb, gb)) = (a.at(center), b.at(center));
    let margin = a.margin(gap) + b.margin(gap);
    let reach = |gradient: DVec3| gradient.abs().dot(half);
    let difference = fa - fb;
    let spread = reach(ga - gb);
    if b_inside {
        // f_A < f_B throughout: whatever is in B is in A.
        if difference + spread < -margin {
            return Some(true);
        }
    } else if difference - spread > margin {
        return Some(false);
    }
    if let (Form::HalfSpace { .. }, Form::HalfSpace { .. }) = (a, b) {
        let (sum, spread) = (fa + fb, reach(ga + gb));
        if b_inside && sum - spread > margin {
            return Some(false);
        }
        if !b_inside && sum + spread < -margin {
            return Some(true);
        }
    }
    None
}

/// A literal that its relatives below may take for granted.
struct Given {
    position: usize,
    leaf: u32,
    inside: bool,
}

/// Constants for token positions (literals) that others decide in the cell; `None` where nothing is known.
pub fn replacements(
    tokens: &[Token],
    form: impl Fn(u32) -> Option<Form>,
    cell: &Aabb,
    gap: f64,
) -> Option<Vec<Option<bool>>> {
    let mut known: Vec<Option<bool>> = vec![None; tokens.len()];
    let mut any = false;
    // Ancestors: end of the node, and how many of `given` are from above it.
    let mut ancestors: Vec<(usize, usize)> = Vec::new();
    let mut given: Vec<Given> = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        while let Some(&(end, outer)) = ancestors.last()
            && i >= end
        {
            given.truncate(outer);
            ancestors.pop();
        }
        match token.word() {
            Word::Node { op, length } => {
                ancestors.push((i + length as usize, given.len()));
                push_given(tokens, i, op, length as usize, &mut given);
            }
            Word::Literal { leaf, .. } => {
                let Some(a) = form(leaf) else { continue };
                let decides = |other: &Given| {
                    if other.position == i || known[other.position].is_some() {
                        return None;
                    }
                    if other.leaf == leaf {
                        return Some(other.inside);
                    }
                    form(other.leaf).and_then(|b| decided(&a, &b, other.inside, cell, gap))
                };
                known[i] = given.iter().find_map(decides);
                any |= known[i].is_some();
            }
        }
    }
    any.then_some(known)
}

/// The literals among a node's children.
fn push_given(tokens: &[Token], node: usize, op: Op, length: usize, given: &mut Vec<Given>) {
    let mut position = node + 1;
    while position < node + length {
        match tokens[position].word() {
            Word::Literal { leaf, negated } => {
                // Elsewhere in the node this literal is true (AND) or false (OR), or nothing matters.
                given.push(Given { position, leaf, inside: (op == Op::And) != negated });
                position += 1;
            }
            Word::Node { length, .. } => position += length as usize,
        }
    }
}
