//! `match`.

use arsc_diagnostics::Span;
use arsc_syntax::ast;

use super::{Checker, Typed};
use crate::code::{Arm, Code, Pat};
use crate::types::Type;

impl Checker<'_> {
    pub(super) fn match_value(
        &mut self,
        subject: &ast::Expr,
        arms: &[ast::MatchArm],
        hint: Option<&Type>,
        span: Span,
    ) -> Typed {
        let subject_span = subject.span;
        let subject = self.expr(subject, None);
        let mut heads = Vec::new();
        let mut values = Vec::new();
        for arm in arms {
            heads.push(self.arm_head(arm, &subject.ty));
            values.push((self.expr(&arm.value, hint), arm.value.span));
            self.pop_scope();
        }
        let ty = self.common(&mut values, None, "the arms of a `match`").unwrap_or(Type::Error);
        let mut checked = Vec::new();
        for ((pattern, guard), (value, at)) in heads.into_iter().zip(values) {
            checked.push(Arm { pattern, guard, value: self.coerce(value, &ty, at, None) });
        }
        self.check_coverage(&subject.ty, subject_span, arms, &checked, span);
        Typed::new(Code::Match { subject: Box::new(subject.code), arms: checked, span }, ty)
    }

    /// Pattern and guard of an arm; leaves a scope open for its value.
    pub(super) fn arm_head(&mut self, arm: &ast::MatchArm, subject: &Type) -> (Pat, Option<Code>) {
        self.push_scope();
        let pattern = self.pattern(&arm.pattern, subject);
        let guard = arm.guard.as_ref().map(|guard| self.expect(guard, &Type::Bool));
        (pattern, guard)
    }
}
