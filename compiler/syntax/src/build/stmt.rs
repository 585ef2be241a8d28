//! Blocks, statements and declarations.

use arsc_diagnostics::{Applicability, Diagnostic, Span, codes};

use super::Builder;
use crate::ast::{Block, Expr, ExprKind, FnDecl, FnParam, Ident, Let, Pattern, PatternKind, Stmt, StmtKind, TypeExpr};
use crate::grammar::{Pair, Rule};

/// What a function and a lambda have in common.
pub(super) struct Signature {
    pub params: Vec<FnParam>,
    pub result: Option<TypeExpr>,
    pub body: Expr,
    pub depth: usize,
}

impl<'t> Builder<'t> {
    pub(super) fn block(&mut self, pair: Pair<'t>) -> (Block, usize) {
        let span = self.span(&pair);
        let mut stmts = Vec::new();
        let mut depth = 0;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::stmt => {
                    let (stmt, stmt_depth) = self.stmt(part);
                    depth = depth.max(stmt_depth);
                    stmts.push(stmt);
                }
                Rule::stmt_error => {
                    let span = self.trimmed(&part);
                    self.unreadable(Rule::strict_stmt, span.start as usize, span.end as usize);
                    let kind = self.declared_by_error(span).map_or(StmtKind::Error, StmtKind::Let);
                    stmts.push(Stmt { allow: Vec::new(), kind, span });
                }
                _ => {}
            }
        }
        (Block { stmts, span }, depth + 1)
    }

    fn trimmed(&self, pair: &Pair<'t>) -> Span {
        let span = self.span(pair);
        Span::new(self.source, span.start as usize, span.start as usize + pair.as_str().trim_end().len())
    }

    fn stmt(&mut self, pair: Pair<'t>) -> (Stmt, usize) {
        let start = self.start(&pair);
        let mut stmt = Stmt { allow: Vec::new(), kind: StmtKind::Error, span: start };
        let mut depth = 0;
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::attribute => stmt.allow.extend(part.into_inner().map(|name| self.ident(name))),
                Rule::let_stmt => {
                    let (declaration, value_depth) = self.let_stmt(part);
                    (stmt.kind, depth) = (StmtKind::Let(declaration), value_depth);
                }
                Rule::fn_decl => {
                    let (declaration, body_depth) = self.fn_decl(part);
                    (stmt.kind, depth) = (StmtKind::Fn(declaration), body_depth);
                }
                Rule::expr => {
                    let (expr, expr_depth) = self.expr(part);
                    (stmt.kind, depth) = (StmtKind::Expr(expr), expr_depth);
                }
                Rule::missing_end => {
                    self.missing_end(stmt.span);
                    continue;
                }
                _ => {}
            }
            stmt.span = start.to(span);
        }
        (stmt, depth)
    }

    /// A name that an unreadable `let` or `fn` would have declared: known, with an error for its value, so that its
    /// uses are not reported as well.
    pub(super) fn declared_by_error(&self, span: Span) -> Option<Let> {
        let text = &self.text[span.start as usize..span.end as usize];
        let rest = ["let", "fn", "param"].iter().find_map(|word| text.strip_prefix(word))?;
        let name = rest.trim_start_matches([' ', '\t']);
        let length = name.bytes().take_while(|b| b.is_ascii_alphanumeric() || *b == b'_').count();
        let starts_well = name.bytes().next().is_some_and(|b| b.is_ascii_alphabetic() || b == b'_');
        if name.len() == rest.len() || !starts_well {
            return None;
        }
        let start = span.end as usize - name.len();
        let name_span = Span::new(self.source, start, start + length);
        let ident = Ident { name: name[..length].to_string(), span: name_span };
        Some(Let {
            pattern: Pattern { kind: PatternKind::Binding(ident), span: name_span },
            ty: None,
            value: Expr { kind: ExprKind::Error, span },
        })
    }

    /// Two statements on one line: `span` is the first one.
    pub(super) fn missing_end(&mut self, span: Span) {
        let end = span.end as usize;
        let at = Span::new(self.source, end, end);
        let is_known = self.follows_crowded(span.start as usize);
        self.crowded_at = Some(end);
        if is_known {
            return;
        }
        let mut diagnostic =
            Diagnostic::new(codes::syntax::STATEMENT_END, "expected a new line or `;` after this statement")
                .label(at, "the statement ends here");
        let before = &self.text[span.start as usize..end];
        diagnostic = match crate::diagnose::adjacent_help(before, self.text[end..].trim_start()) {
            Some(help) => diagnostic.help(help),
            None => diagnostic.suggest(at, ";", Applicability::MaybeIncorrect),
        };
        self.report(diagnostic);
    }

    pub(super) fn let_stmt(&mut self, pair: Pair<'t>) -> (Let, usize) {
        let span = self.span(&pair);
        let mut pattern = Pattern { kind: PatternKind::Error, span };
        let mut ty = None;
        let mut value = (Expr { kind: ExprKind::Error, span }, 0);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::pattern => pattern = self.pattern(part),
                Rule::type_expr => ty = Some(self.type_expr(part)),
                Rule::expr => value = self.expr(part),
                _ => {}
            }
        }
        (Let { pattern, ty, value: value.0 }, value.1)
    }

    pub(super) fn fn_decl(&mut self, pair: Pair<'t>) -> (FnDecl, usize) {
        let span = self.span(&pair);
        let name = pair.clone().into_inner().find(|part| part.as_rule() == Rule::ident);
        let name = name.map_or(Ident { name: String::new(), span }, |name| self.ident(name));
        let Signature { params, result, body, depth } = self.signature(pair);
        (FnDecl { name, params, result, body }, depth)
    }

    pub(super) fn signature(&mut self, pair: Pair<'t>) -> Signature {
        let span = self.span(&pair);
        let body = Expr { kind: ExprKind::Error, span };
        let mut signature = Signature { params: Vec::new(), result: None, body, depth: 0 };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::fn_params => {
                    for param in part.into_inner() {
                        signature.params.extend(self.fn_param(param, &mut signature.depth));
                    }
                }
                Rule::fn_result => signature.result = part.into_inner().last().map(|ty| self.type_expr(ty)),
                Rule::fn_body => {
                    if let Some(body) = part.into_inner().last() {
                        let (body, depth) = self.body(body);
                        (signature.body, signature.depth) = (body, signature.depth.max(depth));
                    }
                }
                _ => {}
            }
        }
        signature
    }

    fn body(&mut self, pair: Pair<'t>) -> (Expr, usize) {
        if pair.as_rule() == Rule::expr {
            return self.expr(pair);
        }
        let span = self.span(&pair);
        let (block, depth) = self.block(pair);
        (Expr { kind: ExprKind::Block(block), span }, depth + 1)
    }

    fn fn_param(&mut self, pair: Pair<'t>, depth: &mut usize) -> Option<FnParam> {
        let (mut name, mut ty, mut default) = (None, None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::ident => name = Some(self.ident(part)),
                Rule::type_expr => ty = Some(self.type_expr(part)),
                Rule::expr => {
                    let (value, value_depth) = self.expr(part);
                    *depth = value_depth.max(*depth);
                    default = Some(value);
                }
                _ => {}
            }
        }
        Some(FnParam { name: name?, ty, default })
    }
}
