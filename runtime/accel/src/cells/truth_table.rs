//! Expressions of few leaves as bit sets: bit `i` is the value when leaf state `j` is bit `j` of `i`.

use smallvec::SmallVec;

use crate::expression::{Op, Token, Word};

/// Columns: bit `i` of `VARIABLE[j]` is bit `j` of `i`.
const VARIABLE: [u64; 6] = [
    0xAAAA_AAAA_AAAA_AAAA,
    0xCCCC_CCCC_CCCC_CCCC,
    0xF0F0_F0F0_F0F0_F0F0,
    0xFF00_FF00_FF00_FF00,
    0xFFFF_0000_FFFF_0000,
    0xFFFF_FFFF_0000_0000,
];

/// The table of an expression; `slot` numbers its leaves from 0 to at most 5.
pub fn table(tokens: &[Token], slot: impl Fn(u32) -> u32) -> u64 {
    // Prefix read backwards is postfix.
    let mut stack: SmallVec<[(u64, usize); 16]> = SmallVec::new();
    for (i, token) in tokens.iter().enumerate().rev() {
        match token.word() {
            Word::Literal { leaf, negated } => {
                let column = VARIABLE[slot(leaf) as usize];
                stack.push((if negated { !column } else { column }, i));
            }
            Word::Node { op, length } => {
                let mut value = if op == Op::And { u64::MAX } else { 0 };
                while let Some(&(operand, start)) = stack.last()
                    && start < i + length as usize
                {
                    value = if op == Op::And { value & operand } else { value | operand };
                    stack.pop();
                }
                stack.push((value, i));
            }
        }
    }
    stack.pop().map_or(0, |(value, _)| value)
}

/// The table depends on this leaf: its two cofactors differ.
pub fn depends_on(table: u64, slot: usize) -> bool {
    let high = table & VARIABLE[slot];
    let low = table & !VARIABLE[slot];
    high >> (1 << slot) != low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_small_expressions() {
        // x0 and (x1 or not x2)
        let tokens = [
            Token::node(Op::And, 5),
            Token::literal(10, false),
            Token::node(Op::Or, 3),
            Token::literal(11, false),
            Token::literal(12, true),
        ];
        let table = table(&tokens, |leaf| leaf - 10);
        for i in 0..64u64 {
            let x = |j: u64| i >> j & 1 == 1;
            assert_eq!(table >> i & 1 == 1, x(0) && (x(1) || !x(2)));
        }
        assert!((0..3).all(|slot| depends_on(table, slot)));
        assert!((3..6).all(|slot| !depends_on(table, slot)));
    }
}
