//! Leaves that decide each other within a cell.
//!
//! For two spheres `f_A − f_B` is linear (the radical plane), so "A within the cell lies in B" is an exact test over the
//! box; the same holds for half-spaces. Below an OR with the literal B everything may assume to be outside B (below an
//! AND, inside), so a leaf that B decides becomes a constant. Replacements are made one after the other, each sound in
//! the expression that the ones before left. All relations are strict by several tolerances: leaves that coincide never
//! dominate each other, so the owner of a coincident face stays.

use glam::DVec3;

use arsc_geometry::{Aabb, Direct, Placed};

use crate::expression::{Op, Token, Word};

/// A leaf as `f <= 0` seen from a cell: spheres have quadratic part 1, half-spaces 0.
#[derive(Clone, Copy, Debug)]
struct Form {
    quadratic: bool,
    /// `f` at the cell's centre.
    value: f64,
    /// Gradient of the linear part.
    gradient: DVec3,
    /// What `f` must differ by so that surfaces are apart.
    margin: f64,
}

impl Form {
    /// `None` for shapes that have no such form, ellipsoids among them.
    fn new(leaf: &Placed, center: DVec3, gap: f64) -> Option<Form> {
        match *leaf.direct()? {
            Direct::Ball { center: c, radius } => {
                let distance = center.distance(c);
                let value = (distance - radius) * (distance + radius);
                Some(Form { quadratic: true, value, gradient: -2.0 * c, margin: gap * (2.0 * radius + gap) })
            }
            Direct::HalfSpace { normal, offset } => {
                Some(Form { quadratic: false, value: normal.dot(center) + offset, gradient: normal, margin: gap })
            }
            Direct::Box { .. } => None,
        }
    }
}

/// The state of `a` in the cell (half extent `half`) where that of `b` is known, if it follows.
fn decided(a: &Form, b: &Form, b_inside: bool, half: DVec3) -> Option<bool> {
    if a.quadratic != b.quadratic {
        return None;
    }
    let margin = a.margin + b.margin;
    let reach = |gradient: DVec3| gradient.abs().dot(half);
    let difference = a.value - b.value;
    let spread = reach(a.gradient - b.gradient);
    if b_inside {
        // f_A < f_B throughout: whatever is in B is in A.
        if difference + spread < -margin {
            return Some(true);
        }
    } else if difference - spread > margin {
        return Some(false);
    }
    if !a.quadratic {
        let (sum, spread) = (a.value + b.value, reach(a.gradient + b.gradient));
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
pub fn replacements(tokens: &[Token], placed: &[Placed], cell: &Aabb, gap: f64) -> Option<Vec<Option<bool>>> {
    let (center, half) = (cell.center(), cell.extent() * 0.5);
    let form = |token: &Token| match token.word() {
        Word::Literal { leaf, .. } => Form::new(&placed[leaf as usize], center, gap),
        Word::Node { .. } => None,
    };
    let forms: Vec<Option<Form>> = tokens.iter().map(form).collect();
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
                let decides = |other: &Given| {
                    if other.position == i || known[other.position].is_some() {
                        return None;
                    }
                    if other.leaf == leaf {
                        return Some(other.inside);
                    }
                    let (a, b) = (forms[i].as_ref()?, forms[other.position].as_ref()?);
                    decided(a, b, other.inside, half)
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
