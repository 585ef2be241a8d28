//! Type expressions.

use super::Builder;
use crate::ast::{Ident, TypeExpr, TypeKind};
use crate::grammar::{Pair, Rule};

impl<'t> Builder<'t> {
    pub(super) fn type_expr(&mut self, pair: Pair<'t>) -> TypeExpr {
        let outer = self.span(&pair);
        let Some(form) = pair.into_inner().next() else { return TypeExpr { kind: TypeKind::Error, span: outer } };
        let span = self.span(&form);
        let rule = form.as_rule();
        let kind = match rule {
            Rule::type_name => self.type_name(form),
            Rule::type_tuple => TypeKind::Tuple(form.into_inner().map(|ty| self.type_expr(ty)).collect()),
            Rule::type_record => self.type_record(form),
            Rule::type_fn => self.type_fn(form),
            _ => TypeKind::Error,
        };
        TypeExpr { kind, span }
    }

    fn type_name(&mut self, pair: Pair<'t>) -> TypeKind {
        let mut inner = pair.into_inner();
        let Some(name) = inner.next() else { return TypeKind::Error };
        let name = self.ident(name);
        let args = inner.next().map(Pair::into_inner).into_iter().flatten().map(|ty| self.type_expr(ty)).collect();
        TypeKind::Name { name, args }
    }

    fn type_record(&mut self, pair: Pair<'t>) -> TypeKind {
        let mut fields = Vec::new();
        let mut name: Option<Ident> = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::ident => name = Some(self.ident(part)),
                Rule::type_expr => {
                    let ty = self.type_expr(part);
                    fields.extend(name.take().map(|name| (name, ty)));
                }
                _ => {}
            }
        }
        TypeKind::Record(fields)
    }

    fn type_fn(&mut self, pair: Pair<'t>) -> TypeKind {
        let mut types: Vec<TypeExpr> =
            pair.into_inner().filter(|part| part.as_rule() == Rule::type_expr).map(|ty| self.type_expr(ty)).collect();
        match types.pop() {
            Some(result) => TypeKind::Fn { params: types, result: Box::new(result) },
            None => TypeKind::Error,
        }
    }
}
