//! A short printed form of the tree.

use arsc_diagnostics::SourceId;
use arsc_syntax::ast::*;

/// The items of a text that must be right.
pub fn items(text: &str) -> Vec<String> {
    let parsed = arsc_syntax::parse(SourceId(0), text);
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
    parsed.module.items.iter().map(show).collect()
}

fn names(idents: impl IntoIterator<Item = Ident>, separator: &str) -> String {
    idents.into_iter().map(|ident| ident.name).collect::<Vec<_>>().join(separator)
}

pub fn show(item: &Item) -> String {
    match &item.kind {
        ItemKind::Allow(lints) => format!("allow {}", names(lints.clone(), " ")),
        ItemKind::Import(import) => match &import.path {
            ImportPath::Std { segments, .. } => format!("import {}", names(segments.clone(), ".")),
            ImportPath::File { path, .. } => format!("import {path}"),
        },
        ItemKind::Param(param) => {
            let range = param.range.as_ref().map_or(String::new(), |range| format!(" in {}", show_expr(range)));
            format!("param {} = {}{range}", param.name.name, show_expr(&param.default))
        }
        ItemKind::Let(binding) => format!("let = {}", show_expr(&binding.value)),
        ItemKind::Fn(f) => {
            let params = names(f.params.iter().map(|p| p.name.clone()), ", ");
            format!("fn {}({params}) {}", f.name.name, show_expr(&f.body))
        }
        ItemKind::Type { name, .. } => format!("type {}", name.name),
        ItemKind::Scene(block) => format!("scene {}", show_block(block)),
        ItemKind::Camera(expr) => format!("camera {}", show_expr(expr)),
        ItemKind::Actions(block) => format!("actions {}", show_block(block)),
        ItemKind::Error => "error".to_string(),
    }
}

fn show_block(block: &Block) -> String {
    let stmts = block.stmts.iter().map(|stmt| match &stmt.kind {
        StmtKind::Let(_) => "let".to_string(),
        StmtKind::Fn(f) => format!("fn {}", f.name.name),
        StmtKind::Expr(expr) => show_expr(expr),
        StmtKind::Error => "error".to_string(),
    });
    format!("{{{}}}", stmts.collect::<Vec<_>>().join("; "))
}

fn show_all(exprs: &[Expr]) -> String {
    exprs.iter().map(show_expr).collect::<Vec<_>>().join(", ")
}

pub fn show_expr(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Bool(value) => value.to_string(),
        ExprKind::Int(value) => value.to_string(),
        ExprKind::Float(value) => format!("{value:?}"),
        ExprKind::Quantity { value, unit } => {
            let unit = match unit {
                Unit::Deg => "deg",
                Unit::Rad => "rad",
                Unit::Nm => "nm",
                Unit::Kelvin => "K",
            };
            format!("{value}{unit}")
        }
        ExprKind::Str(value) => format!("{value:?}"),
        ExprKind::Name(name) => name.name.clone(),
        ExprKind::Tuple(elements) => format!("tuple({})", show_all(elements)),
        ExprKind::Paren(inner) => format!("paren({})", show_expr(inner)),
        ExprKind::List(elements) => format!("[{}]", show_all(elements)),
        ExprKind::Record(fields) => {
            let fields = fields.iter().map(|(name, value)| format!("{}: {}", name.name, show_expr(value)));
            format!("{{{}}}", fields.collect::<Vec<_>>().join(", "))
        }
        ExprKind::Field { base, name } => format!("{}.{}", show_expr(base), name.name),
        ExprKind::Index { base, index } => format!("{}[{}]", show_expr(base), show_expr(index)),
        ExprKind::Call(call) => {
            let args = call.args.iter().map(|arg| {
                let name = arg.name.as_ref().map_or(String::new(), |name| format!("{}: ", name.name));
                name + &show_expr(&arg.value)
            });
            format!("{}({})", show_expr(&call.callee), args.collect::<Vec<_>>().join(", "))
        }
        ExprKind::Pipe { value, call } => format!("(pipe {} {})", show_expr(value), show_expr(call)),
        ExprKind::Unary { op, operand, .. } => {
            let op = if *op == UnaryOp::Neg { '-' } else { '!' };
            format!("({op}{})", show_expr(operand))
        }
        ExprKind::Binary { op, left, right, .. } => {
            format!("({} {} {})", show_expr(left), show_op(*op), show_expr(right))
        }
        ExprKind::Range { start, end, inclusive } => {
            format!("({} {} {})", show_expr(start), if *inclusive { "..=" } else { ".." }, show_expr(end))
        }
        ExprKind::If { condition, then, otherwise } => {
            let otherwise = otherwise.as_ref().map_or(String::new(), |e| format!(" else {}", show_expr(e)));
            format!("if {} {}{otherwise}", show_expr(condition), show_block(then))
        }
        ExprKind::Match { subject, arms } => {
            let arms = arms.iter().map(|arm| {
                let guard = arm.guard.as_ref().map_or(String::new(), |guard| format!("if {} ", show_expr(guard)));
                guard + &show_expr(&arm.value)
            });
            format!("match {} {{{}}}", show_expr(subject), arms.collect::<Vec<_>>().join("; "))
        }
        ExprKind::For { list, filter, body, .. } => {
            let filter = filter.as_ref().map_or(String::new(), |filter| format!("if {} ", show_expr(filter)));
            format!("for {} {filter}{}", show_expr(list), show_block(body))
        }
        ExprKind::Block(block) => show_block(block),
        ExprKind::Lambda { params, body, .. } => {
            format!("fn({}) {}", names(params.iter().map(|p| p.name.clone()), ", "), show_expr(body))
        }
        ExprKind::Error => "error".to_string(),
    }
}

fn show_op(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Or => "||",
        BinaryOp::And => "&&",
        BinaryOp::Eq => "==",
        BinaryOp::Ne => "!=",
        BinaryOp::Lt => "<",
        BinaryOp::Le => "<=",
        BinaryOp::Gt => ">",
        BinaryOp::Ge => ">=",
        BinaryOp::Union => "|",
        BinaryOp::Intersection => "&",
        BinaryOp::Add => "+",
        BinaryOp::Sub => "-",
        BinaryOp::Mul => "*",
        BinaryOp::Div => "/",
        BinaryOp::Rem => "%",
        BinaryOp::Pow => "**",
    }
}
