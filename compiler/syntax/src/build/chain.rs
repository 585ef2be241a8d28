//! Chains of operators: from the grammar's flat list to a tree by precedence climbing.

use arsc_diagnostics::{Diagnostic, Span, codes};

use super::Builder;
use super::expr::Deep;
use crate::MAX_DEPTH;
use crate::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::grammar::{Pair, Rule};

#[derive(Clone, Copy)]
enum Infix {
    Pipe,
    Range { inclusive: bool },
    Binary(BinaryOp),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Associativity {
    Left,
    Right,
    None,
}

/// Binding power of prefixes: tighter than every infix but `**`.
const PREFIX: u8 = 10;

impl Infix {
    fn of(text: &str) -> Infix {
        use BinaryOp::{Add, And, Div, Eq, Ge, Gt, Intersection, Le, Lt, Mul, Ne, Or, Pow, Rem, Sub, Union};
        Infix::Binary(match text {
            "|>" => return Infix::Pipe,
            ".." => return Infix::Range { inclusive: false },
            "..=" => return Infix::Range { inclusive: true },
            "||" => Or,
            "&&" => And,
            "==" => Eq,
            "!=" => Ne,
            "<" => Lt,
            "<=" => Le,
            ">" => Gt,
            ">=" => Ge,
            "|" => Union,
            "&" => Intersection,
            "+" => Add,
            "-" => Sub,
            "*" => Mul,
            "/" => Div,
            "%" => Rem,
            _ => Pow,
        })
    }

    /// Higher binds tighter.
    fn power(self) -> (u8, Associativity) {
        use Associativity::{Left, None, Right};
        match self {
            Infix::Pipe => (1, Left),
            Infix::Range { .. } => (5, None),
            Infix::Binary(op) => match op {
                BinaryOp::Or => (2, Left),
                BinaryOp::And => (3, Left),
                BinaryOp::Eq | BinaryOp::Ne | BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge => (4, None),
                BinaryOp::Union => (6, Left),
                BinaryOp::Intersection => (7, Left),
                BinaryOp::Add | BinaryOp::Sub => (8, Left),
                BinaryOp::Mul | BinaryOp::Div | BinaryOp::Rem => (9, Left),
                BinaryOp::Pow => (11, Right),
            },
        }
    }
}

/// A chain as the grammar gives it, its operands already made: folding it needs no look at the pairs.
pub(super) struct Chain {
    /// For each operand its prefixes; reversed, so that reading is popping.
    operands: Vec<(Vec<(UnaryOp, Span)>, Deep)>,
    /// The operators between them, reversed.
    infixes: Vec<(Infix, Span)>,
    length: usize,
}

impl<'t> Builder<'t> {
    pub(super) fn read_chain(&mut self, pair: Pair<'t>) -> Chain {
        let mut chain = Chain { operands: Vec::new(), infixes: Vec::new(), length: 0 };
        let mut prefixes = Vec::new();
        for part in pair.into_inner() {
            chain.length += 1;
            let span = self.span(&part);
            match part.as_rule() {
                Rule::prefix => prefixes.push((if part.as_str() == "-" { UnaryOp::Neg } else { UnaryOp::Not }, span)),
                Rule::infix => chain.infixes.push((Infix::of(part.as_str()), span)),
                _ => {
                    let operand = self.operand(part);
                    chain.operands.push((std::mem::take(&mut prefixes), operand));
                }
            }
        }
        chain.operands.reverse();
        chain.infixes.reverse();
        chain
    }

    pub(super) fn fold_chain(&mut self, mut chain: Chain, outer: Span) -> Deep {
        if chain.length > 2 * MAX_DEPTH {
            self.too_deep(outer);
            return (Expr { kind: ExprKind::Error, span: outer }, 0);
        }
        self.climb(&mut chain, 0).unwrap_or((Expr { kind: ExprKind::Error, span: outer }, 0))
    }

    /// Reads operators that bind tighter than `floor`. Recursion is as deep as there are levels of precedence, and
    /// for `**` as long as its chain.
    fn climb(&mut self, chain: &mut Chain, floor: u8) -> Option<Deep> {
        let mut left = self.unary(chain)?;
        let mut last: Option<(u8, Span)> = None;
        while let Some(&(infix, op_span)) = chain.infixes.last() {
            let (power, associativity) = infix.power();
            if power <= floor {
                break;
            }
            chain.infixes.pop();
            let right = self.climb(chain, if associativity == Associativity::Right { power - 1 } else { power })?;
            if associativity == Associativity::None {
                if let Some((_, first)) = last.filter(|&(last_power, _)| last_power == power) {
                    self.chained(infix, first, op_span);
                }
                last = Some((power, op_span));
            }
            left = self.combine(infix, op_span, left, right);
        }
        Some(left)
    }

    /// An operand with its prefixes, and with the `**` that binds tighter than they do.
    fn unary(&mut self, chain: &mut Chain) -> Option<Deep> {
        let (prefixes, mut operand) = chain.operands.pop()?;
        if prefixes.is_empty() {
            return Some(operand);
        }
        while let Some(&(infix, op_span)) = chain.infixes.last() {
            let (power, _) = infix.power();
            if power <= PREFIX {
                break;
            }
            chain.infixes.pop();
            let right = self.climb(chain, power - 1)?;
            operand = self.combine(infix, op_span, operand, right);
        }
        for (op, op_span) in prefixes.into_iter().rev() {
            let (expr, depth) = operand;
            let span = op_span.to(expr.span);
            let kind = ExprKind::Unary { op, op_span, operand: Box::new(expr) };
            operand = self.limited(Expr { kind, span }, depth + 1);
        }
        Some(operand)
    }

    fn combine(&mut self, infix: Infix, op_span: Span, left: Deep, right: Deep) -> Deep {
        let ((left, left_depth), (right, right_depth)) = (left, right);
        let span = left.span.to(right.span);
        let (left, right) = (Box::new(left), Box::new(right));
        let kind = match infix {
            Infix::Pipe => {
                self.check_pipe_target(&right, op_span);
                ExprKind::Pipe { value: left, call: right }
            }
            Infix::Range { inclusive } => ExprKind::Range { start: left, end: right, inclusive },
            Infix::Binary(op) => ExprKind::Binary { op, op_span, left, right },
        };
        self.limited(Expr { kind, span }, left_depth.max(right_depth) + 1)
    }

    fn check_pipe_target(&mut self, target: &Expr, op_span: Span) {
        let callable = matches!(
            target.kind,
            ExprKind::Call(_)
                | ExprKind::Name(_)
                | ExprKind::Field { .. }
                | ExprKind::Index { .. }
                | ExprKind::Paren(_)
                | ExprKind::Lambda { .. }
                | ExprKind::Error
        );
        if !callable {
            self.report(
                Diagnostic::new(codes::syntax::SYNTAX, "expected a function or a call after `|>`")
                    .label(target.span, "this cannot be called")
                    .label(op_span, "passes its left side on")
                    .help("`|>` binds loosest of all operators: put parentheses around what belongs together"),
            );
        }
    }

    fn chained(&mut self, infix: Infix, first: Span, second: Span) {
        let (what, help) = match infix {
            Infix::Range { .. } => ("ranges do not chain", "for steps use `range(start, end, step)`"),
            _ => ("comparisons do not chain", "write `a < b && b < c`"),
        };
        self.report(
            Diagnostic::new(codes::syntax::CHAINED_COMPARISON, what)
                .label(second, "a second one")
                .label(first, "after this one")
                .help(help),
        );
    }
}
