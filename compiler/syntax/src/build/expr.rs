//! Expressions: operands with their calls, indices and fields. Chains of operators are in `chain`.

use arsc_diagnostics::{Applicability, Diagnostic, Span, codes};

use super::Builder;
use crate::MAX_DEPTH;
use crate::ast::{Arg, Call, Expr, ExprKind, Ident, MatchArm, Pattern, PatternKind};
use crate::grammar::{Pair, Rule};

/// An expression and the depth of its tree.
pub(super) type Deep = (Expr, usize);

impl<'t> Builder<'t> {
    pub(super) fn expr(&mut self, pair: Pair<'t>) -> Deep {
        let outer = self.span(&pair);
        let chain = self.read_chain(pair);
        self.fold_chain(chain, outer)
    }

    /// Gives the node if its tree is not too deep, else an error node and one report for the region.
    pub(super) fn limited(&mut self, expr: Expr, depth: usize) -> Deep {
        if depth <= MAX_DEPTH {
            return (expr, depth);
        }
        let span = expr.span;
        self.too_deep(span);
        (Expr { kind: ExprKind::Error, span }, 0)
    }

    pub(super) fn too_deep(&mut self, span: Span) {
        if !std::mem::replace(&mut self.too_deep, true) {
            let start = span.start as usize;
            self.report(
                Diagnostic::new(codes::syntax::NESTING, format!("an expression is more than {MAX_DEPTH} levels deep"))
                    .label(Span::new(self.source, start, start), "a chain of operators, calls or `else if` starts here")
                    .help("give `union(…)`, `sum(…)` or a `for` a list instead of chaining operators"),
            );
        }
    }

    pub(super) fn operand(&mut self, pair: Pair<'t>) -> Deep {
        let outer = self.span(&pair);
        let mut parts = pair.into_inner();
        let Some(primary) = parts.next() else { return (Expr { kind: ExprKind::Error, span: outer }, 0) };
        let (mut expr, mut depth) = self.primary(primary);
        for postfix in parts {
            let span = expr.span.to(self.span(&postfix));
            let base = Box::new(expr);
            let kind = match postfix.as_rule() {
                Rule::call => {
                    let (args, args_depth) = self.args(postfix);
                    depth = depth.max(args_depth);
                    ExprKind::Call(Call { callee: base, args })
                }
                Rule::index => {
                    let index = postfix.into_inner().next().map(|index| self.expr(index));
                    let (index, index_depth) = index.unwrap_or((Expr { kind: ExprKind::Error, span }, 0));
                    depth = depth.max(index_depth);
                    ExprKind::Index { base, index: Box::new(index) }
                }
                _ => match postfix.into_inner().next().map(|name| self.ident(name)) {
                    Some(name) => ExprKind::Field { base, name },
                    None => ExprKind::Error,
                },
            };
            (expr, depth) = self.limited(Expr { kind, span }, depth + 1);
        }
        (expr, depth)
    }

    fn args(&mut self, pair: Pair<'t>) -> (Vec<Arg>, usize) {
        let mut args: Vec<Arg> = Vec::new();
        let mut depth = 0;
        for part in pair.into_inner() {
            if part.as_rule() == Rule::missing_comma {
                if let Some(before) = args.last() {
                    self.missing_comma(before.value.span);
                }
                continue;
            }
            let (arg, arg_depth) = self.arg(part);
            depth = depth.max(arg_depth);
            args.push(arg);
        }
        (args, depth)
    }

    fn arg(&mut self, pair: Pair<'t>) -> (Arg, usize) {
        let mut arg = Arg { name: None, value: Expr { kind: ExprKind::Error, span: self.span(&pair) } };
        let mut depth = 0;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::arg_name => arg.name = part.into_inner().next().map(|name| self.ident(name)),
                Rule::equals => {
                    let span = self.span(&part);
                    self.equals_for_colon(arg.name.as_ref(), span);
                }
                Rule::expr => (arg.value, depth) = self.expr(part),
                _ => {}
            }
        }
        (arg, depth)
    }

    fn equals_for_colon(&mut self, name: Option<&Ident>, span: Span) {
        let name = name.map_or("", |name| name.name.as_str());
        self.report(
            Diagnostic::new(codes::syntax::NAMED_ARGUMENT, "a named argument is written with `:`")
                .label(span, "`=` stands where `:` is needed")
                .help(format!("write `{name}: value`"))
                .suggest(span, ":", Applicability::Safe),
        );
    }

    fn primary(&mut self, pair: Pair<'t>) -> Deep {
        let span = self.span(&pair);
        let (kind, depth) = match pair.as_rule() {
            Rule::number => (self.number(&pair), 0),
            Rule::string => (ExprKind::Str(self.string(&pair)), 0),
            Rule::boolean => (ExprKind::Bool(pair.as_str() == "true"), 0),
            Rule::name => (ExprKind::Name(self.ident(pair)), 0),
            Rule::group => self.group(pair),
            Rule::list => {
                let (elements, depth, _) = self.elements(pair);
                (ExprKind::List(elements), depth)
            }
            Rule::record => self.record(pair),
            Rule::block => {
                let (block, depth) = self.block(pair);
                (ExprKind::Block(block), depth)
            }
            Rule::if_expr => return self.if_expr(pair),
            Rule::match_expr => self.match_expr(pair),
            Rule::for_expr => self.for_expr(pair),
            Rule::lambda => {
                let signature = self.signature(pair);
                let (params, result, body) = (signature.params, signature.result, Box::new(signature.body));
                (ExprKind::Lambda { params, result, body }, signature.depth)
            }
            _ => (ExprKind::Error, 0),
        };
        self.limited(Expr { kind, span }, depth + 1)
    }

    /// The elements of a list or group, the greatest depth, and whether a comma ends it.
    fn elements(&mut self, pair: Pair<'t>) -> (Vec<Expr>, usize, bool) {
        let mut elements: Vec<Expr> = Vec::new();
        let (mut depth, mut trailing) = (0, false);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::missing_comma => {
                    if let Some(before) = elements.last() {
                        self.missing_comma(before.span);
                    }
                }
                Rule::trailing_comma => trailing = true,
                _ => {
                    let (element, element_depth) = self.expr(part);
                    depth = depth.max(element_depth);
                    elements.push(element);
                }
            }
        }
        (elements, depth, trailing)
    }

    fn group(&mut self, pair: Pair<'t>) -> (ExprKind, usize) {
        let (mut elements, depth, trailing) = self.elements(pair);
        if elements.len() == 1 && !trailing {
            return (ExprKind::Paren(Box::new(elements.swap_remove(0))), depth);
        }
        (ExprKind::Tuple(elements), depth)
    }

    fn record(&mut self, pair: Pair<'t>) -> (ExprKind, usize) {
        let mut fields: Vec<(Ident, Expr)> = Vec::new();
        let mut depth = 0;
        for part in pair.into_inner() {
            if part.as_rule() == Rule::missing_comma {
                if let Some((_, before)) = fields.last() {
                    self.missing_comma(before.span);
                }
                continue;
            }
            let mut name = None;
            for piece in part.into_inner() {
                match piece.as_rule() {
                    Rule::ident => name = Some(self.ident(piece)),
                    Rule::expr => {
                        let (value, value_depth) = self.expr(piece);
                        depth = depth.max(value_depth);
                        fields.extend(name.take().map(|name| (name, value)));
                    }
                    _ => {}
                }
            }
        }
        (ExprKind::Record(fields), depth)
    }

    /// `if … else if … else …`: the grammar keeps the arms flat, the tree nests each in the `otherwise` of the last.
    fn if_expr(&mut self, pair: Pair<'t>) -> Deep {
        let outer = self.span(&pair);
        let mut arms = Vec::new();
        let mut otherwise: Option<Deep> = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::if_arm => arms.push(part),
                Rule::else_if => arms.extend(part.into_inner().filter(|arm| arm.as_rule() == Rule::if_arm)),
                Rule::block => {
                    let span = self.span(&part);
                    let (block, depth) = self.block(part);
                    otherwise = Some((Expr { kind: ExprKind::Block(block), span }, depth + 1));
                }
                _ => {}
            }
        }
        // Reports stay in the order of the text because they are sorted at the end.
        for arm in arms.into_iter().rev() {
            let start = self.start(&arm);
            let mut end = self.span(&arm);
            let mut parts = arm.into_inner().filter(|part| part.as_rule() != Rule::kw_if);
            let (Some(condition), Some(then)) = (parts.next(), parts.next()) else { continue };
            let (condition, condition_depth) = self.expr(condition);
            let (then, then_depth) = self.block(then);
            end = otherwise.as_ref().map_or(end, |(otherwise, _)| otherwise.span);
            let depth = condition_depth.max(then_depth).max(otherwise.as_ref().map_or(0, |(_, depth)| *depth));
            let otherwise_expr = otherwise.take().map(|(expr, _)| Box::new(expr));
            let kind = ExprKind::If { condition: Box::new(condition), then, otherwise: otherwise_expr };
            otherwise = Some(self.limited(Expr { kind, span: start.to(end) }, depth + 1));
        }
        otherwise.unwrap_or((Expr { kind: ExprKind::Error, span: outer }, 0))
    }

    fn match_expr(&mut self, pair: Pair<'t>) -> (ExprKind, usize) {
        let mut subject = None;
        let mut arms = Vec::new();
        let mut depth = 0;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::expr => {
                    let (expr, expr_depth) = self.expr(part);
                    (subject, depth) = (Some(Box::new(expr)), depth.max(expr_depth));
                }
                Rule::match_arm => {
                    if let Some(body) = part.into_inner().next() {
                        arms.push(self.match_arm(body, &mut depth));
                    }
                }
                _ => {}
            }
        }
        (subject.map_or(ExprKind::Error, |subject| ExprKind::Match { subject, arms }), depth)
    }

    fn match_arm(&mut self, pair: Pair<'t>, depth: &mut usize) -> MatchArm {
        let span = self.span(&pair);
        let mut arm = MatchArm {
            pattern: Pattern { kind: PatternKind::Error, span },
            guard: None,
            value: Expr { kind: ExprKind::Error, span },
            span,
        };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::pattern => arm.pattern = self.pattern(part),
                Rule::guard => arm.guard = self.guard(part, depth),
                Rule::expr => {
                    let (value, value_depth) = self.expr(part);
                    *depth = value_depth.max(*depth);
                    arm.value = value;
                }
                _ => {}
            }
        }
        arm.span = self.start_of(span).to(arm.value.span);
        arm
    }

    fn start_of(&self, span: Span) -> Span {
        Span { end: span.start, ..span }
    }

    fn guard(&mut self, pair: Pair<'t>, depth: &mut usize) -> Option<Expr> {
        let (guard, guard_depth) = self.expr(pair.into_inner().last()?);
        *depth = guard_depth.max(*depth);
        Some(guard)
    }

    fn for_expr(&mut self, pair: Pair<'t>) -> (ExprKind, usize) {
        let (mut pattern, mut list, mut filter, mut body) = (None, None, None, None);
        let mut depth = 0;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::pattern => pattern = Some(self.pattern(part)),
                Rule::expr => {
                    let (expr, expr_depth) = self.expr(part);
                    (list, depth) = (Some(Box::new(expr)), depth.max(expr_depth));
                }
                Rule::guard => filter = self.guard(part, &mut depth).map(Box::new),
                Rule::block => {
                    let (block, block_depth) = self.block(part);
                    (body, depth) = (Some(block), depth.max(block_depth));
                }
                _ => {}
            }
        }
        match (pattern, list, body) {
            (Some(pattern), Some(list), Some(body)) => (ExprKind::For { pattern, list, filter, body }, depth),
            _ => (ExprKind::Error, depth),
        }
    }
}
