//! The value of an expression kept up to date while leaves flip, in time proportional to the depth and not to the length.
//!
//! Each node counts its operands that decide it (true ones of an OR, false ones of an AND), so a flip goes up only as far
//! as values change. Setting up reads the whole string once: worth it for rays with many crossings in one cell.

use crate::coincidence::States;
use crate::expression::{Op, Token, Word};

const NONE: u32 = u32::MAX;

/// A node, or the literal at this position.
#[derive(Clone, Copy)]
struct Entry {
    /// Position of the node that this is an operand of.
    parent: u32,
    /// Node: operands with the deciding value. Literal: the next literal of the same leaf.
    link: u32,
    /// Value of the node; for a literal the leaf's state differs if negated.
    value: bool,
    /// Node: the operand value that decides it.
    absorbing: bool,
}

/// States of leaves with the value of each node.
pub struct Counted {
    entries: Vec<Entry>,
    /// First literal of each leaf.
    first: Vec<u32>,
    states: Vec<bool>,
}

impl Counted {
    /// `tokens` over positions in `states`.
    pub fn new(tokens: &[Token], states: &[bool]) -> Counted {
        let mut counted = Counted {
            entries: Vec::with_capacity(tokens.len()),
            first: vec![NONE; states.len()],
            states: states.to_vec(),
        };
        let mut open: Vec<(u32, usize)> = Vec::new();
        for (i, token) in tokens.iter().enumerate() {
            while open.last().is_some_and(|&(_, end)| i >= end) {
                open.pop();
            }
            let parent = open.last().map_or(NONE, |&(node, _)| node);
            counted.entries.push(match token.word() {
                Word::Literal { leaf, negated } => {
                    let link = std::mem::replace(&mut counted.first[leaf as usize], i as u32);
                    Entry { parent, link, value: states[leaf as usize] != negated, absorbing: false }
                }
                Word::Node { op, length } => {
                    open.push((i as u32, i + length as usize));
                    let absorbing = op == Op::Or;
                    Entry { parent, link: 0, value: !absorbing, absorbing }
                }
            });
        }
        // Operands come after their nodes, so backwards every node is complete when its parent counts it.
        for i in (0..tokens.len()).rev() {
            let Entry { parent, value, .. } = counted.entries[i];
            if parent != NONE {
                let node = &mut counted.entries[parent as usize];
                if value == node.absorbing {
                    node.link += 1;
                    node.value = value;
                }
            }
        }
        counted
    }

    /// Flips the value at a position and what follows from it.
    fn flip_entry(&mut self, mut at: u32) {
        loop {
            let entry = &mut self.entries[at as usize];
            entry.value = !entry.value;
            let (parent, value) = (entry.parent, entry.value);
            if parent == NONE {
                return;
            }
            let node = &mut self.entries[parent as usize];
            let before = node.link;
            node.link = if value == node.absorbing { before + 1 } else { before - 1 };
            if (before == 0) == (node.link == 0) {
                return;
            }
            at = parent;
        }
    }
}

impl States for Counted {
    fn get(&self, slot: u32) -> bool {
        self.states[slot as usize]
    }

    fn flip(&mut self, slot: u32) {
        self.states[slot as usize] = !self.states[slot as usize];
        let mut literal = self.first[slot as usize];
        while literal != NONE {
            let next = self.entries[literal as usize].link;
            self.flip_entry(literal);
            literal = next;
        }
    }

    fn value(&self) -> bool {
        self.entries[0].value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::eval;

    #[test]
    fn counting_agrees_with_evaluation() {
        let literal = |leaf| Token::literal(leaf, false);
        let without = |leaf| Token::literal(leaf, true);
        // 0 or (1 and not 2 and (3 or 0)) or not 1
        let tokens = [
            Token::node(Op::Or, 9),
            literal(0),
            Token::node(Op::And, 6),
            literal(1),
            without(2),
            Token::node(Op::Or, 3),
            literal(3),
            literal(0),
            without(1),
        ];
        let mut seed = 1u64;
        for start in 0..16u32 {
            let mut states: Vec<bool> = (0..4).map(|i| start >> i & 1 == 1).collect();
            let mut counted = Counted::new(&tokens, &states);
            for _ in 0..50 {
                assert_eq!(counted.value(), eval(&tokens, |leaf| states[leaf as usize]), "{states:?}");
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                let slot = (seed >> 60) as usize % 4;
                states[slot] = !states[slot];
                counted.flip(slot as u32);
                assert_eq!(counted.get(slot as u32), states[slot]);
            }
        }
    }
}
