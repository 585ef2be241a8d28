//! The syntax tree: what was written, with the span of every node.
//!
//! Invariants: nesting is at most [`crate::MAX_NESTING`], so recursion over the tree and its drop are safe;
//! [`ExprKind::Error`] and [`StmtKind::Error`] stand where a statement could not be read, each already
//! reported; comments are kept beside the items for the formatter.
//! Not here: meaning. Names, types and units are the business of `arsc-sema`.

use arsc_diagnostics::Span;

/// A file.
#[derive(Clone, Debug)]
pub struct Module {
    /// The `//!` lines at the top, without the marks.
    pub docs: Option<String>,
    pub items: Vec<Item>,
    /// Every comment of the file in order, doc comments included.
    pub comments: Vec<Comment>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub struct Comment {
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Ident {
    pub name: String,
    pub span: Span,
}

/// A top-level declaration.
#[derive(Clone, Debug)]
pub struct Item {
    /// The `///` lines before it, without the marks.
    pub docs: Option<String>,
    /// Lints named in `@allow(…)` before it.
    pub allow: Vec<Ident>,
    pub kind: ItemKind,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum ItemKind {
    /// `allow(unused_name, empty_csg)`: for the whole file.
    Allow(Vec<Ident>),
    Import(Import),
    Param(Param),
    Let(Let),
    Fn(FnDecl),
    /// `type wheel = { radius: float, width: float }`
    Type {
        name: Ident,
        ty: TypeExpr,
    },
    /// `scene { … }`
    Scene(Block),
    /// `camera perspective(…)`
    Camera(Expr),
    /// `actions { … }`
    Actions(Block),
    /// Could not be read; reported.
    Error,
}

/// `import std.material { lambert, oren_nayar as on }`, `import "parts/wheel.arsl" as wheel`.
#[derive(Clone, Debug)]
pub struct Import {
    pub path: ImportPath,
    pub names: ImportNames,
}

#[derive(Clone, Debug)]
pub enum ImportPath {
    /// `std.material`
    Std { segments: Vec<Ident>, span: Span },
    /// `"parts/wheel.arsl"`, relative to the importing file.
    File { path: String, span: Span },
}

#[derive(Clone, Debug)]
pub enum ImportNames {
    /// The module under one name: `as name`, else the last segment or the file's stem.
    Module(Option<Ident>),
    /// `{ a, b as c }`
    Names(Vec<ImportName>),
}

#[derive(Clone, Debug)]
pub struct ImportName {
    pub name: Ident,
    pub alias: Option<Ident>,
}

/// `param samples: int = 128 in 1..=4096`
#[derive(Clone, Debug)]
pub struct Param {
    pub name: Ident,
    pub ty: Option<TypeExpr>,
    pub default: Expr,
    /// A range, or a list of allowed values.
    pub range: Option<Expr>,
}

/// `let name: type = value`; the pattern is a name or a tuple of patterns.
#[derive(Clone, Debug)]
pub struct Let {
    pub pattern: Pattern,
    pub ty: Option<TypeExpr>,
    pub value: Expr,
}

#[derive(Clone, Debug)]
pub struct FnDecl {
    pub name: Ident,
    pub params: Vec<FnParam>,
    pub result: Option<TypeExpr>,
    pub body: Expr,
}

#[derive(Clone, Debug)]
pub struct FnParam {
    pub name: Ident,
    pub ty: Option<TypeExpr>,
    pub default: Option<Expr>,
}

#[derive(Clone, Debug)]
pub struct TypeExpr {
    pub kind: TypeKind,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum TypeKind {
    /// `int`, `solid`, `list<solid>`, `image<spectral>`
    Name {
        name: Ident,
        args: Vec<TypeExpr>,
    },
    Tuple(Vec<TypeExpr>),
    Record(Vec<(Ident, TypeExpr)>),
    /// `fn(int, float) -> solid`
    Fn {
        params: Vec<TypeExpr>,
        result: Box<TypeExpr>,
    },
    Error,
}

/// `{ statement* }`. In `scene` and `actions` each expression statement counts; elsewhere the last is the value.
#[derive(Clone, Debug)]
pub struct Block {
    pub stmts: Vec<Stmt>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub struct Stmt {
    pub allow: Vec<Ident>,
    pub kind: StmtKind,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum StmtKind {
    Let(Let),
    /// A local function.
    Fn(FnDecl),
    Expr(Expr),
    /// Could not be read; reported.
    Error,
}

#[derive(Clone, Debug)]
pub struct Expr {
    pub kind: ExprKind,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum ExprKind {
    Bool(bool),
    Int(i64),
    Float(f64),
    /// `180deg`, `0.5rad`, `550nm`, `6500K`
    Quantity {
        value: f64,
        unit: Unit,
    },
    Str(String),
    Name(Ident),
    /// `( )` is the empty tuple; `(a)` is no tuple but [`ExprKind::Paren`].
    Tuple(Vec<Expr>),
    Paren(Box<Expr>),
    List(Vec<Expr>),
    /// `{ radius: 1, width: 2 }`
    Record(Vec<(Ident, Expr)>),
    /// `module.name` or `record.field`
    Field {
        base: Box<Expr>,
        name: Ident,
    },
    Index {
        base: Box<Expr>,
        index: Box<Expr>,
    },
    Call(Call),
    /// `value |> call(args)`: the value becomes the first positional argument. The right side is a call or a name.
    Pipe {
        value: Box<Expr>,
        call: Box<Expr>,
    },
    Unary {
        op: UnaryOp,
        op_span: Span,
        operand: Box<Expr>,
    },
    Binary {
        op: BinaryOp,
        op_span: Span,
        left: Box<Expr>,
        right: Box<Expr>,
    },
    /// `a..b`, `a..=b`
    Range {
        start: Box<Expr>,
        end: Box<Expr>,
        inclusive: bool,
    },
    If {
        condition: Box<Expr>,
        then: Block,
        otherwise: Option<Box<Expr>>,
    },
    Match {
        subject: Box<Expr>,
        arms: Vec<MatchArm>,
    },
    /// `for pattern in list if filter { body }`: a list of the bodies' values.
    For {
        pattern: Pattern,
        list: Box<Expr>,
        filter: Option<Box<Expr>>,
        body: Block,
    },
    Block(Block),
    /// `fn(x: float, y) => expr` or `fn(x) -> float { … }`
    Lambda {
        params: Vec<FnParam>,
        result: Option<TypeExpr>,
        body: Box<Expr>,
    },
    /// Could not be read; reported.
    Error,
}

#[derive(Clone, Debug)]
pub struct Call {
    pub callee: Box<Expr>,
    pub args: Vec<Arg>,
}

#[derive(Clone, Debug)]
pub struct Arg {
    pub name: Option<Ident>,
    pub value: Expr,
}

#[derive(Clone, Debug)]
pub struct MatchArm {
    pub pattern: Pattern,
    pub guard: Option<Expr>,
    pub value: Expr,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub struct Pattern {
    pub kind: PatternKind,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum PatternKind {
    Wildcard,
    Binding(Ident),
    /// A literal, possibly negated.
    Literal(Box<Expr>),
    /// `0..10`, `0..=10` of literals.
    Range {
        start: Box<Expr>,
        end: Box<Expr>,
        inclusive: bool,
    },
    Tuple(Vec<Pattern>),
    /// `a | b`
    Either(Vec<Pattern>),
    Error,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    Deg,
    Rad,
    Nm,
    Kelvin,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOp {
    Neg,
    Not,
}

/// From loosest to tightest: `|>`; `||`; `&&`; comparisons (not associative); `..`; `|`; `&`; `+ -`; `* / %`;
/// prefix `- !`; `**` (right); call, field, index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    Or,
    And,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    /// `|` on solids
    Union,
    /// `&` on solids
    Intersection,
    Add,
    /// `-`: numbers, vectors, and difference of solids
    Sub,
    Mul,
    Div,
    Rem,
    Pow,
}
