//! Boolean expressions over leaves: negation normal form as a prefix string of tokens.
//!
//! A node is an operator with the length of its part of the string; a literal is a leaf with a sign. No node has a
//! child of its own operator or fewer than two children, so AND and OR alternate. Nothing here recurses: chains of
//! many thousand operands are ordinary. Substituting constants is one scan that truncates what it has written when a
//! node turns out constant.

use smallvec::SmallVec;

use arsc_geometry::Aabb;

use crate::Csg;

/// n-ary operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op {
    And,
    Or,
}

impl Op {
    /// The operand value that decides the result.
    pub fn absorbing(self) -> bool {
        self == Op::Or
    }

    fn dual(self) -> Op {
        match self {
            Op::And => Op::Or,
            Op::Or => Op::And,
        }
    }
}

/// One word of the string.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token(u32);

/// A token, unpacked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    Literal {
        leaf: u32,
        negated: bool,
    },
    /// `length` counts the tokens of the node, itself included.
    Node {
        op: Op,
        length: u32,
    },
}

const PAYLOAD: u32 = (1 << 30) - 1;
/// A literal of this leaf is the constant false (negated: true); only before simplification.
const NO_LEAF: u32 = PAYLOAD;
impl Token {
    pub fn literal(leaf: u32, negated: bool) -> Token {
        Token(leaf | u32::from(negated) << 30)
    }

    pub fn node(op: Op, length: usize) -> Token {
        Token(length as u32 | if op == Op::And { 2 << 30 } else { 3 << 30 })
    }

    /// The same token with the leaf of a literal renumbered.
    pub fn renumbered(self, number: impl Fn(u32) -> u32) -> Token {
        match self.word() {
            Word::Literal { leaf, negated } => Token::literal(number(leaf), negated),
            Word::Node { .. } => self,
        }
    }

    pub fn word(self) -> Word {
        let payload = self.0 & PAYLOAD;
        match self.0 >> 30 {
            0 => Word::Literal { leaf: payload, negated: false },
            1 => Word::Literal { leaf: payload, negated: true },
            2 => Word::Node { op: Op::And, length: payload },
            _ => Word::Node { op: Op::Or, length: payload },
        }
    }
}

/// An expression or what became of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expression {
    Constant(bool),
    Tokens(Vec<Token>),
}

/// Work that is left while a tree is written out.
enum Step<'a> {
    Visit { node: &'a Csg, negated: bool, parent: Option<Op> },
    Close { header: usize, op: Op },
}

impl Expression {
    /// Negation normal form of a tree. An empty union is empty, an empty intersection everything.
    pub fn from_csg(tree: &Csg) -> Expression {
        let mut tokens = Vec::new();
        let mut steps = vec![Step::Visit { node: tree, negated: false, parent: None }];
        while let Some(step) = steps.pop() {
            match step {
                Step::Visit { node: Csg::Leaf(leaf), negated, .. } => tokens.push(Token::literal(*leaf, negated)),
                Step::Visit { node, negated, parent } => {
                    let op = operator(node, negated);
                    if parent != Some(op) {
                        steps.push(Step::Close { header: tokens.len(), op });
                        tokens.push(Token::node(op, 1));
                    }
                    push_children(node, negated, op, &mut steps);
                }
                Step::Close { header, op } => {
                    if tokens.len() == header + 1 {
                        tokens[header] = Token::literal(NO_LEAF, op == Op::And);
                    } else {
                        tokens[header] = Token::node(op, tokens.len() - header);
                    }
                }
            }
        }
        let mut out = Vec::with_capacity(tokens.len());
        match substitute(&tokens, |leaf| (leaf == NO_LEAF).then_some(false), &mut out) {
            Some(value) => Expression::Constant(value),
            None => Expression::Tokens(out),
        }
    }
}

impl Expression {
    /// A box that holds the solid, from those of the leaves.
    pub fn bounds(&self, leaf_bounds: impl Fn(u32) -> Aabb) -> Aabb {
        match self {
            Expression::Constant(false) => Aabb::EMPTY,
            Expression::Constant(true) => Aabb::EVERYTHING,
            Expression::Tokens(tokens) => bounds(tokens, false, &leaf_bounds),
        }
    }
}

/// A box that holds where the expression (or, `complement`, its negation) is true.
pub fn bounds(tokens: &[Token], complement: bool, leaf_bounds: impl Fn(u32) -> Aabb) -> Aabb {
    // Prefix read backwards is postfix: operands lie on the stack when their operator comes.
    let mut stack: SmallVec<[(Aabb, usize); 32]> = SmallVec::new();
    for (i, token) in tokens.iter().enumerate().rev() {
        match token.word() {
            Word::Literal { leaf, negated } => {
                let hull = if negated == complement { leaf_bounds(leaf) } else { Aabb::EVERYTHING };
                stack.push((hull, i));
            }
            Word::Node { op, length } => {
                let intersect = (op == Op::And) != complement;
                let mut hull = if intersect { Aabb::EVERYTHING } else { Aabb::EMPTY };
                while let Some(&(operand, start)) = stack.last()
                    && start < i + length as usize
                {
                    hull = if intersect { hull.intersection(&operand) } else { hull.union(&operand) };
                    stack.pop();
                }
                stack.push((hull, i));
            }
        }
    }
    stack.pop().map_or(Aabb::EMPTY, |(hull, _)| if hull.is_empty() { Aabb::EMPTY } else { hull })
}

fn operator(node: &Csg, negated: bool) -> Op {
    let op = if matches!(node, Csg::Union(_)) { Op::Or } else { Op::And };
    if negated { op.dual() } else { op }
}

fn push_children<'a>(node: &'a Csg, negated: bool, op: Op, steps: &mut Vec<Step<'a>>) {
    let parent = Some(op);
    match node {
        Csg::Leaf(_) => {}
        Csg::Union(children) | Csg::Intersection(children) => {
            steps.extend(children.iter().rev().map(|node| Step::Visit { node, negated, parent }));
        }
        Csg::Difference(a, b) => {
            steps.push(Step::Visit { node: b, negated: !negated, parent });
            steps.push(Step::Visit { node: a, negated, parent });
        }
    }
}

/// A node that is being read or written.
struct Frame {
    op: Op,
    end: usize,
    written: usize,
    children: u32,
}

/// Appends to `out` the expression with constants for the leaves that `value` knows; returns the constant instead if
/// that is what is left, and then `out` is as before.
pub fn substitute(tokens: &[Token], value: impl Fn(u32) -> Option<bool>, out: &mut Vec<Token>) -> Option<bool> {
    let mut stack: SmallVec<[Frame; 16]> = SmallVec::new();
    let mut i = 0;
    loop {
        let mut result = match tokens[i].word() {
            Word::Node { op, length } => {
                stack.push(Frame { op, end: i + length as usize, written: out.len(), children: 0 });
                out.push(tokens[i]);
                i += 1;
                continue;
            }
            Word::Literal { leaf, negated } => {
                let known = value(leaf).map(|v| v != negated);
                if known.is_none() {
                    out.push(tokens[i]);
                }
                i += 1;
                known
            }
        };
        // Close every node that ends here or is decided.
        loop {
            let Some(top) = stack.last_mut() else { return result };
            match result {
                Some(v) if v == top.op.absorbing() => {
                    out.truncate(top.written);
                    i = top.end;
                    stack.pop();
                    continue;
                }
                Some(_) => {}
                None => top.children += 1,
            }
            if i < top.end {
                break;
            }
            result = close(&mut stack, out);
        }
    }
}

/// Ends the top node: constant, its only child, spliced into a parent of the same operator, or with its new length.
fn close(stack: &mut SmallVec<[Frame; 16]>, out: &mut Vec<Token>) -> Option<bool> {
    let Frame { op, written, children, .. } = stack.pop()?;
    if children == 0 {
        out.truncate(written);
        return Some(!op.absorbing());
    }
    if children == 1 {
        out.remove(written);
    } else {
        out[written] = Token::node(op, out.len() - written);
    }
    if let (Some(parent), Word::Node { op, .. }) = (stack.last_mut(), out[written].word())
        && op == parent.op
    {
        out.remove(written);
        parent.children += 1;
    }
    None
}

/// Value under the given states of the leaves; stops as early as each node is decided.
pub fn eval(tokens: &[Token], state: impl Fn(u32) -> bool) -> bool {
    let mut stack: SmallVec<[(Op, usize); 32]> = SmallVec::new();
    let mut i = 0;
    loop {
        let mut value = match tokens[i].word() {
            Word::Node { op, length } => {
                stack.push((op, i + length as usize));
                i += 1;
                continue;
            }
            Word::Literal { leaf, negated } => {
                i += 1;
                state(leaf) != negated
            }
        };
        loop {
            let Some(&(op, end)) = stack.last() else { return value };
            if value == op.absorbing() {
                i = end;
            } else if i < end {
                break;
            } else {
                value = !op.absorbing();
            }
            stack.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaf(i: u32) -> Csg {
        Csg::Leaf(i)
    }

    fn tokens(tree: &Csg) -> Vec<Token> {
        match Expression::from_csg(tree) {
            Expression::Tokens(tokens) => tokens,
            Expression::Constant(value) => panic!("constant {value}"),
        }
    }

    fn plain(tree: &Csg, bits: u32) -> bool {
        match tree {
            Csg::Leaf(i) => bits >> i & 1 == 1,
            Csg::Union(list) => list.iter().any(|n| plain(n, bits)),
            Csg::Intersection(list) => list.iter().all(|n| plain(n, bits)),
            Csg::Difference(a, b) => plain(a, bits) && !plain(b, bits),
        }
    }

    /// A tree from the digits of a number; leaves 0 to 5 may repeat.
    fn random_tree(seed: &mut u64, depth: u32) -> Csg {
        *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let digit = (*seed >> 33) as u32;
        if depth == 0 || digit.is_multiple_of(5) {
            return leaf(digit / 5 % 6);
        }
        let mut children = |n: u32| (0..n).map(|_| random_tree(seed, depth - 1)).collect::<Vec<_>>();
        match digit % 5 {
            1 => Csg::Union(children(digit / 5 % 4)),
            2 => Csg::Intersection(children(1 + digit / 5 % 3)),
            _ => {
                let mut two = children(2);
                let b = two.pop().unwrap();
                Csg::Difference(Box::new(two.pop().unwrap()), Box::new(b))
            }
        }
    }

    #[test]
    fn normal_form_and_substitution_keep_the_value() {
        let mut seed = 7;
        for _ in 0..500 {
            let tree = random_tree(&mut seed, 5);
            let expression = Expression::from_csg(&tree);
            for bits in 0..64u32 {
                let expected = plain(&tree, bits);
                let Expression::Tokens(tokens) = &expression else {
                    assert_eq!(expression, Expression::Constant(expected));
                    continue;
                };
                assert_eq!(eval(tokens, |i| bits >> i & 1 == 1), expected);
                // Fix leaves 0 to 2, evaluate the rest.
                let mut out = Vec::new();
                let value = match substitute(tokens, |i| (i < 3).then_some(bits >> i & 1 == 1), &mut out) {
                    Some(value) => {
                        assert!(out.is_empty());
                        value
                    }
                    None => eval(&out, |i| {
                        assert!(i >= 3);
                        bits >> i & 1 == 1
                    }),
                };
                assert_eq!(value, expected);
            }
        }
    }

    #[test]
    fn differences_flatten() {
        let chain = (1..4).fold(leaf(0), |a, i| Csg::Difference(Box::new(a), Box::new(leaf(i))));
        let expected = [
            Token::node(Op::And, 5),
            Token::literal(0, false),
            Token::literal(1, true),
            Token::literal(2, true),
            Token::literal(3, true),
        ];
        assert_eq!(tokens(&chain), expected);
    }

    #[test]
    fn deep_chains_do_not_recurse() {
        let mut chain = leaf(0);
        for i in 1..3000 {
            chain = if i % 2 == 0 {
                Csg::Union(vec![chain, leaf(i)])
            } else {
                Csg::Difference(Box::new(chain), Box::new(leaf(i)))
            };
        }
        let tokens = tokens(&chain);
        assert!(eval(&tokens, |i| i == 2998));
        assert!(!eval(&tokens, |i| i == 2998 || i == 2999));
    }

    #[test]
    fn empty_operands_are_constants() {
        assert_eq!(Expression::from_csg(&Csg::Union(vec![])), Expression::Constant(false));
        assert_eq!(Expression::from_csg(&Csg::Intersection(vec![])), Expression::Constant(true));
        let nothing = Csg::Intersection(vec![leaf(0), Csg::Union(vec![])]);
        assert_eq!(Expression::from_csg(&nothing), Expression::Constant(false));
    }
}
