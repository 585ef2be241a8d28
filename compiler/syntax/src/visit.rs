//! Walking the syntax tree without knowing all of its forms.
//!
//! Recursion is bounded by [`crate::MAX_DEPTH`].

use arsc_diagnostics::Span;

use crate::ast::{
    Arg, Block, Expr, ExprKind, FnParam, Item, ItemKind, Let, Pattern, PatternKind, Stmt, StmtKind, TypeExpr, TypeKind,
};

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub enum Node<'a> {
    Item(&'a Item),
    Stmt(&'a Stmt),
    Block(&'a Block),
    Expr(&'a Expr),
    Pattern(&'a Pattern),
    Type(&'a TypeExpr),
}

impl<'a> Node<'a> {
    pub fn span(self) -> Span {
        match self {
            Node::Item(item) => item.span,
            Node::Stmt(stmt) => stmt.span,
            Node::Block(block) => block.span,
            Node::Expr(expr) => expr.span,
            Node::Pattern(pattern) => pattern.span,
            Node::Type(ty) => ty.span,
        }
    }

    /// Calls `f` with every node directly below this one, in the order of the text.
    pub fn children(self, f: &mut dyn FnMut(Node<'a>)) {
        match self {
            Node::Item(item) => item_children(&item.kind, f),
            Node::Stmt(stmt) => match &stmt.kind {
                StmtKind::Let(binding) => let_children(binding, f),
                StmtKind::Fn(decl) => function(&decl.params, decl.result.as_ref(), &decl.body, f),
                StmtKind::Expr(expr) => f(Node::Expr(expr)),
                StmtKind::Error => {}
            },
            Node::Block(block) => block.stmts.iter().for_each(|stmt| f(Node::Stmt(stmt))),
            Node::Expr(expr) => expr_children(&expr.kind, f),
            Node::Pattern(pattern) => pattern_children(&pattern.kind, f),
            Node::Type(ty) => type_children(&ty.kind, f),
        }
    }
}

fn item_children<'a>(kind: &'a ItemKind, f: &mut dyn FnMut(Node<'a>)) {
    match kind {
        ItemKind::Allow(_) | ItemKind::Import(_) | ItemKind::Error => {}
        ItemKind::Param(param) => {
            param.ty.iter().for_each(|ty| f(Node::Type(ty)));
            f(Node::Expr(&param.default));
            param.range.iter().for_each(|range| f(Node::Expr(range)));
        }
        ItemKind::Let(binding) => let_children(binding, f),
        ItemKind::Fn(decl) => function(&decl.params, decl.result.as_ref(), &decl.body, f),
        ItemKind::Type { ty, .. } => f(Node::Type(ty)),
        ItemKind::Scene(block) | ItemKind::Actions(block) => f(Node::Block(block)),
        ItemKind::Camera(expr) => f(Node::Expr(expr)),
    }
}

fn let_children<'a>(binding: &'a Let, f: &mut dyn FnMut(Node<'a>)) {
    f(Node::Pattern(&binding.pattern));
    binding.ty.iter().for_each(|ty| f(Node::Type(ty)));
    f(Node::Expr(&binding.value));
}

fn function<'a>(params: &'a [FnParam], result: Option<&'a TypeExpr>, body: &'a Expr, f: &mut dyn FnMut(Node<'a>)) {
    for param in params {
        param.ty.iter().for_each(|ty| f(Node::Type(ty)));
        param.default.iter().for_each(|default| f(Node::Expr(default)));
    }
    result.into_iter().for_each(|ty| f(Node::Type(ty)));
    f(Node::Expr(body));
}

fn expr_children<'a>(kind: &'a ExprKind, f: &mut dyn FnMut(Node<'a>)) {
    match kind {
        ExprKind::Bool(_)
        | ExprKind::Int(_)
        | ExprKind::Float(_)
        | ExprKind::Quantity { .. }
        | ExprKind::Str(_)
        | ExprKind::Name(_)
        | ExprKind::Error => {}
        ExprKind::Tuple(elements) | ExprKind::List(elements) => elements.iter().for_each(|e| f(Node::Expr(e))),
        ExprKind::Paren(inner) => f(Node::Expr(inner)),
        ExprKind::Record(fields) => fields.iter().for_each(|(_, value)| f(Node::Expr(value))),
        ExprKind::Field { base, .. } => f(Node::Expr(base)),
        ExprKind::Index { base, index } => [base, index].into_iter().for_each(|e| f(Node::Expr(e))),
        ExprKind::Call(call) => {
            f(Node::Expr(&call.callee));
            call.args.iter().for_each(|Arg { value, .. }| f(Node::Expr(value)));
        }
        ExprKind::Pipe { value, call } => [value, call].into_iter().for_each(|e| f(Node::Expr(e))),
        ExprKind::Unary { operand, .. } => f(Node::Expr(operand)),
        ExprKind::Binary { left, right, .. } => [left, right].into_iter().for_each(|e| f(Node::Expr(e))),
        ExprKind::Range { start, end, .. } => [start, end].into_iter().for_each(|e| f(Node::Expr(e))),
        ExprKind::If { condition, then, otherwise } => {
            f(Node::Expr(condition));
            f(Node::Block(then));
            otherwise.iter().for_each(|e| f(Node::Expr(e)));
        }
        ExprKind::Match { subject, arms } => {
            f(Node::Expr(subject));
            for arm in arms {
                f(Node::Pattern(&arm.pattern));
                arm.guard.iter().for_each(|guard| f(Node::Expr(guard)));
                f(Node::Expr(&arm.value));
            }
        }
        ExprKind::For { pattern, list, filter, body } => {
            f(Node::Pattern(pattern));
            f(Node::Expr(list));
            filter.iter().for_each(|filter| f(Node::Expr(filter)));
            f(Node::Block(body));
        }
        ExprKind::Block(block) => f(Node::Block(block)),
        ExprKind::Lambda { params, result, body } => function(params, result.as_ref(), body, f),
    }
}

fn pattern_children<'a>(kind: &'a PatternKind, f: &mut dyn FnMut(Node<'a>)) {
    match kind {
        PatternKind::Wildcard | PatternKind::Binding(_) | PatternKind::Error => {}
        PatternKind::Literal(literal) => f(Node::Expr(literal)),
        PatternKind::Range { start, end, .. } => [start, end].into_iter().for_each(|e| f(Node::Expr(e))),
        PatternKind::Tuple(patterns) | PatternKind::Either(patterns) => {
            patterns.iter().for_each(|pattern| f(Node::Pattern(pattern)));
        }
    }
}

fn type_children<'a>(kind: &'a TypeKind, f: &mut dyn FnMut(Node<'a>)) {
    match kind {
        TypeKind::Name { args, .. } => args.iter().for_each(|ty| f(Node::Type(ty))),
        TypeKind::Tuple(types) => types.iter().for_each(|ty| f(Node::Type(ty))),
        TypeKind::Record(fields) => fields.iter().for_each(|(_, ty)| f(Node::Type(ty))),
        TypeKind::Fn { params, result } => {
            params.iter().for_each(|ty| f(Node::Type(ty)));
            f(Node::Type(result));
        }
        TypeKind::Error => {}
    }
}
