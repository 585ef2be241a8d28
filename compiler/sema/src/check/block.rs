//! Blocks, loops and conditions; blocks that collect.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast::{self, ExprKind, StmtKind};

use super::{Checker, Typed};
use crate::code::{Arm, Code, For};
use crate::types::Type;
use crate::value::Value;

/// What a collecting block collects.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Collects {
    Shapes,
    Actions,
}

impl Checker<'_> {
    /// A block whose last expression is its value.
    pub(super) fn block(&mut self, block: &ast::Block, hint: Option<&Type>) -> Typed {
        self.push_scope();
        let mut stmts = Vec::new();
        let mut value = Typed::new(Code::Const(Value::unit()), Type::unit());
        for (i, stmt) in block.stmts.iter().enumerate() {
            let last = i + 1 == block.stmts.len();
            match &stmt.kind {
                StmtKind::Expr(expr) if last => value = self.expr(expr, hint),
                StmtKind::Expr(expr) => {
                    let dropped = self.expr(expr, None);
                    self.lint_unused_value(&dropped.ty, expr.span);
                    stmts.push(dropped.code);
                }
                // What could not be read may have been the value.
                StmtKind::Error if last => value = Typed::error(),
                _ => stmts.extend(self.definition(stmt)),
            }
        }
        self.pop_scope();
        if stmts.is_empty() {
            return value;
        }
        Typed::new(Code::Block(stmts, Box::new(value.code)), value.ty)
    }

    /// Code of a `let` or local `fn`.
    fn definition(&mut self, stmt: &ast::Stmt) -> Option<Code> {
        match &stmt.kind {
            StmtKind::Let(decl) => {
                let (code, ty) = match decl.ty.as_ref().map(|ty| self.type_expr(ty)) {
                    Some(ty) => (self.expect(&decl.value, &ty), ty),
                    None => {
                        let value = self.expr(&decl.value, None);
                        (value.code, value.ty)
                    }
                };
                let pattern = self.binding(&decl.pattern, &ty);
                Some(Code::Let { pattern, value: Box::new(code) })
            }
            StmtKind::Fn(decl) => Some(self.local_fn(decl)),
            _ => None,
        }
    }

    fn lint_unused_value(&mut self, ty: &Type, span: Span) {
        let ty = self.known(ty);
        if ty.is_unit() || ty.is_error() {
            return;
        }
        let message = format!("{} is computed and dropped", ty.with_article().replace('`', ""));
        let diagnostic = Diagnostic::new(codes::UNUSED_VALUE, message).label(span, "not used");
        let help = if ty.is_shape() {
            "a block gives its last value: join the shapes by `|`, or write a list"
        } else {
            "remove it, or give it a name by `let`"
        };
        self.report(diagnostic.help(help));
    }

    /// A block of which every expression statement counts.
    pub(super) fn collect_block(&mut self, block: &ast::Block, what: Collects) -> Code {
        self.push_scope();
        let stmts = block.stmts.iter().filter_map(|stmt| match &stmt.kind {
            StmtKind::Expr(expr) => Some(self.collect_expr(expr, what)),
            _ => self.definition(stmt),
        });
        let stmts = stmts.collect();
        self.pop_scope();
        Code::Block(stmts, Box::new(Code::Const(Value::unit())))
    }

    /// An expression in statement position of a collecting block.
    fn collect_expr(&mut self, expr: &ast::Expr, what: Collects) -> Code {
        match &expr.kind {
            ExprKind::Block(block) => self.collect_block(block, what),
            ExprKind::If { condition, then, otherwise } => {
                let condition = Box::new(self.expect(condition, &Type::Bool));
                let then = Box::new(self.collect_block(then, what));
                let otherwise = match otherwise {
                    Some(otherwise) => self.collect_expr(otherwise, what),
                    None => Code::Const(Value::unit()),
                };
                Code::If { condition, then, otherwise: Box::new(otherwise) }
            }
            ExprKind::For { pattern, list, filter, body } => {
                let (pattern, list, filter) = self.loop_head(pattern, list, filter.as_deref());
                let body = self.collect_block(body, what);
                self.pop_scope();
                Code::For(Box::new(For { pattern, list, filter, body, keep: false, span: expr.span }))
            }
            ExprKind::Match { subject, arms } => self.collect_match(subject, arms, what, expr.span),
            _ => {
                let value = self.expr(expr, None);
                self.check_collected(&value.ty, what, expr.span);
                Code::Emit(Box::new(value.code), expr.span)
            }
        }
    }

    fn collect_match(&mut self, subject: &ast::Expr, arms: &[ast::MatchArm], what: Collects, span: Span) -> Code {
        let subject_span = subject.span;
        let subject = self.expr(subject, None);
        let mut checked = Vec::new();
        for arm in arms {
            let (pattern, guard) = self.arm_head(arm, &subject.ty);
            let value = self.collect_expr(&arm.value, what);
            self.pop_scope();
            checked.push(Arm { pattern, guard, value });
        }
        self.check_coverage(&subject.ty, subject_span, arms, &checked, span);
        Code::Match { subject: Box::new(subject.code), arms: checked, span }
    }

    fn check_collected(&mut self, ty: &Type, what: Collects, span: Span) {
        let known = self.known(ty);
        let mut element = known.clone();
        while let Type::List(inner) = element {
            element = inner.as_ref().clone();
        }
        let (fits, block, wanted) = match what {
            Collects::Shapes => (element.is_shape(), "scene", "shapes and lights"),
            Collects::Actions => (element == Type::Action, "`actions` block", "actions"),
        };
        if fits || matches!(element, Type::Error | Type::Infer(_)) {
            return;
        }
        let message = format!("a {block} collects {wanted}, but this is {}", known.with_article());
        let diagnostic = Diagnostic::new(codes::TYPE_MISMATCH, message).label(span, "not part of it");
        let help = match (what, &element) {
            (Collects::Shapes, Type::Camera) => Some("write `camera …` outside of the scene"),
            (Collects::Shapes, Type::Bsdf | Type::Emitter | Type::Attributes) => {
                Some("attach it to a shape: `shape |> with(…)`")
            }
            (Collects::Shapes, Type::Fn(_)) | (Collects::Actions, Type::Fn(_)) => Some("call it: `f(…)`"),
            _ => None,
        };
        self.report(match help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        });
    }

    /// Pattern, list and filter of a loop; leaves a scope open for the body.
    fn loop_head(
        &mut self,
        pattern: &ast::Pattern,
        list: &ast::Expr,
        filter: Option<&ast::Expr>,
    ) -> (crate::code::Pat, Code, Option<Code>) {
        let list_span = list.span;
        let list = self.expr(list, None);
        let element = match self.shallow(&list.ty) {
            Type::List(element) => element.as_ref().clone(),
            Type::Error => Type::Error,
            other => {
                let message = format!("a loop needs a list, but this is {}", self.known(&other).with_article());
                let diagnostic = Diagnostic::new(codes::TYPE_MISMATCH, message).label(list_span, "not a list");
                let help = (other == Type::Int).then_some("count by a range: `0..n`");
                self.report(match help {
                    Some(help) => diagnostic.help(help),
                    None => diagnostic,
                });
                Type::Error
            }
        };
        self.push_scope();
        let pattern = self.binding(pattern, &element);
        let filter = filter.map(|filter| self.expect(filter, &Type::Bool));
        (pattern, list.code, filter)
    }

    pub(super) fn for_value(
        &mut self,
        pattern: &ast::Pattern,
        list: &ast::Expr,
        filter: Option<&ast::Expr>,
        body: &ast::Block,
        hint: Option<&Type>,
        span: Span,
    ) -> Typed {
        let (pattern, list, filter) = self.loop_head(pattern, list, filter);
        let hint = hint.map(|hint| self.shallow(hint));
        let element = match &hint {
            Some(Type::List(element)) => Some(element.as_ref()),
            _ => None,
        };
        let body = self.block(body, element);
        self.pop_scope();
        let ty = Type::list(body.ty);
        Typed::new(Code::For(Box::new(For { pattern, list, filter, body: body.code, keep: true, span })), ty)
    }

    pub(super) fn if_else(
        &mut self,
        condition: &ast::Expr,
        then: &ast::Block,
        otherwise: Option<&ast::Expr>,
        hint: Option<&Type>,
        span: Span,
    ) -> Typed {
        let condition = Box::new(self.expect(condition, &Type::Bool));
        let then_span = then.span;
        let then = self.block(then, hint);
        let Some(otherwise) = otherwise else {
            self.lint_unused_value(&then.ty, span);
            let then = Box::new(Code::Block(vec![then.code], Box::new(Code::Const(Value::unit()))));
            let otherwise = Box::new(Code::Const(Value::unit()));
            return Typed::new(Code::If { condition, then, otherwise }, Type::unit());
        };
        let otherwise_span = otherwise.span;
        let otherwise = self.expr(otherwise, hint);
        let mut branches = vec![(then, then_span), (otherwise, otherwise_span)];
        let Some(ty) = self.common(&mut branches, None, "the branches of an `if`") else { return Typed::error() };
        let mut codes = branches.into_iter().map(|(branch, at)| Box::new(self.coerce(branch, &ty, at, None)));
        let (Some(then), Some(otherwise)) = (codes.next(), codes.next()) else { return Typed::error() };
        Typed::new(Code::If { condition, then, otherwise }, ty)
    }
}
