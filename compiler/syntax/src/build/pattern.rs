//! Patterns of `let`, `for` and `match`.

use arsc_diagnostics::Span;

use super::Builder;
use crate::ast::{Expr, ExprKind, Pattern, PatternKind, UnaryOp};
use crate::grammar::{Pair, Rule};

impl<'t> Builder<'t> {
    pub(super) fn pattern(&mut self, pair: Pair<'t>) -> Pattern {
        let outer = self.span(&pair);
        let mut alternatives: Vec<Pattern> = pair.into_inner().map(|part| self.simple_pattern(part)).collect();
        match alternatives.len() {
            0 => Pattern { kind: PatternKind::Error, span: outer },
            1 => alternatives.swap_remove(0),
            n => {
                let span = alternatives[0].span.to(alternatives[n - 1].span);
                Pattern { kind: PatternKind::Either(alternatives), span }
            }
        }
    }

    fn simple_pattern(&mut self, pair: Pair<'t>) -> Pattern {
        let span = self.span(&pair);
        match pair.as_rule() {
            Rule::wildcard => Pattern { kind: PatternKind::Wildcard, span },
            Rule::ident => Pattern { kind: PatternKind::Binding(self.ident(pair)), span },
            Rule::tuple_pattern => self.tuple_pattern(pair, span),
            Rule::literal_pattern => self.literal_pattern(pair),
            _ => Pattern { kind: PatternKind::Error, span },
        }
    }

    /// `(a, b)`; `(a)` is `a` and `(a,)` a tuple of one.
    fn tuple_pattern(&mut self, pair: Pair<'t>, span: Span) -> Pattern {
        let mut parts = Vec::new();
        let mut trailing = false;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::trailing_comma => trailing = true,
                _ => parts.push(self.pattern(part)),
            }
        }
        if parts.len() == 1 && !trailing {
            return parts.swap_remove(0);
        }
        Pattern { kind: PatternKind::Tuple(parts), span }
    }

    fn literal_pattern(&mut self, pair: Pair<'t>) -> Pattern {
        let outer = self.span(&pair);
        let mut inclusive = false;
        let mut literals = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::range_op => inclusive = part.as_str() == "..=",
                _ => literals.push(self.literal(part)),
            }
        }
        let mut literals = literals.into_iter();
        match (literals.next(), literals.next()) {
            (Some(start), Some(end)) => {
                let span = start.span.to(end.span);
                Pattern { kind: PatternKind::Range { start: Box::new(start), end: Box::new(end), inclusive }, span }
            }
            (Some(only), None) => {
                let span = only.span;
                Pattern { kind: PatternKind::Literal(Box::new(only)), span }
            }
            _ => Pattern { kind: PatternKind::Error, span: outer },
        }
    }

    fn literal(&mut self, pair: Pair<'t>) -> Expr {
        let span = self.span(&pair);
        let mut minus = None;
        for part in pair.into_inner() {
            let part_span = self.span(&part);
            let kind = match part.as_rule() {
                Rule::minus => {
                    minus = Some(part_span);
                    continue;
                }
                Rule::number => self.number(&part),
                Rule::boolean => ExprKind::Bool(part.as_str() == "true"),
                Rule::string => ExprKind::Str(self.string(&part)),
                _ => ExprKind::Error,
            };
            let literal = Expr { kind, span: part_span };
            return match minus {
                Some(op_span) => Expr {
                    span: op_span.to(part_span),
                    kind: ExprKind::Unary { op: UnaryOp::Neg, op_span, operand: Box::new(literal) },
                },
                None => literal,
            };
        }
        Expr { kind: ExprKind::Error, span }
    }
}
