//! The checked program: names resolved to slots, operators to typed instructions, coercions explicit.
//!
//! A function's frame holds its parameters in slots 0…, then its locals; what it uses of enclosing functions it
//! captures by value. A frame never shrinks while the function runs.

use arsc_diagnostics::Span;
use arsc_syntax::ast::{BinaryOp, UnaryOp};

use crate::registry::BuiltinId;
use crate::value::Value;

/// Index into [`Program::functions`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FnId(pub u32);

/// Index into [`Program::globals`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GlobalId(pub u32);

/// Everything that evaluation needs.
#[derive(Default)]
pub struct Program {
    pub functions: Vec<Function>,
    pub globals: Vec<Global>,
    pub scene: Option<Entry>,
    pub camera: Option<Entry>,
    pub actions: Option<Entry>,
}

/// Code that runs on its own, with its frame size.
pub struct Entry {
    pub code: Code,
    pub slots: usize,
    pub span: Span,
}

pub struct Function {
    pub name: String,
    /// One per parameter; evaluated in the function's frame when the argument is missing.
    pub defaults: Vec<Option<Code>>,
    pub slots: usize,
    pub body: Code,
    pub is_std: bool,
}

/// A top-level `let` or `param`; evaluated once, when first needed.
pub struct Global {
    pub name: String,
    pub entry: Entry,
    /// Which element of the tuple that `entry` gives, for `let (a, b) = …`: the global holding it, then the path.
    pub part: Option<(GlobalId, Vec<u32>)>,
    /// A param's allowed values.
    pub allowed: Option<Allowed>,
    pub is_std: bool,
}

/// What a param may be.
pub enum Allowed {
    Range { start: Entry, end: Entry, inclusive: bool },
    OneOf(Entry),
}

/// Where a call stands, and its arguments, for diagnostics.
#[derive(Debug)]
pub struct Site {
    pub span: Span,
    /// As many as parameters; the call's span where an argument was not given.
    pub args: Box<[Span]>,
}

pub enum Code {
    Const(Value),
    Local(u32),
    Captured(u32),
    /// The running closure: a local function that calls itself.
    This,
    Global(GlobalId, Span),
    List(Vec<Code>),
    Tuple(Vec<Code>),
    Field(Box<Code>, u32),
    Index {
        base: Box<Code>,
        index: Box<Code>,
        span: Span,
    },
    Range {
        start: Box<Code>,
        end: Box<Code>,
        inclusive: bool,
        span: Span,
    },
    Unary {
        op: Unary,
        operand: Box<Code>,
        span: Span,
    },
    Binary {
        op: Binary,
        left: Box<Code>,
        right: Box<Code>,
        span: Span,
    },
    And(Box<Code>, Box<Code>),
    Or(Box<Code>, Box<Code>),
    Coerce {
        coercion: Box<Coercion>,
        value: Box<Code>,
        span: Span,
    },
    If {
        condition: Box<Code>,
        then: Box<Code>,
        otherwise: Box<Code>,
    },
    Match {
        subject: Box<Code>,
        arms: Vec<Arm>,
        span: Span,
    },
    For(Box<For>),
    /// Statements for their effect on slots and collectors, then the value.
    Block(Vec<Code>, Box<Code>),
    Let {
        pattern: Pat,
        value: Box<Code>,
    },
    Closure {
        function: FnId,
        captures: Vec<Code>,
    },
    CallFn {
        function: FnId,
        args: Vec<Code>,
        span: Span,
    },
    CallBuiltin {
        builtin: BuiltinId,
        args: Vec<Code>,
        site: Box<Site>,
    },
    CallValue {
        callee: Box<Code>,
        args: Vec<Code>,
        span: Span,
    },
    /// Adds a value, or the values of nested lists, to what the scene or action block collects.
    Emit(Box<Code>, Span),
    /// Stands where an error was reported; never evaluated.
    Error,
}

pub struct For {
    pub pattern: Pat,
    pub list: Code,
    pub filter: Option<Code>,
    pub body: Code,
    /// Whether the bodies' values are wanted as a list.
    pub keep: bool,
    pub span: Span,
}

pub struct Arm {
    pub pattern: Pat,
    pub guard: Option<Code>,
    pub value: Code,
}

/// A pattern with its bindings resolved to slots.
#[derive(Clone, Debug)]
pub enum Pat {
    Any,
    Bind(u32),
    Bool(bool),
    Int(i64),
    Float(f64),
    Str(String),
    /// Bounds included on the left; on the right if `inclusive`.
    IntRange {
        start: i64,
        end: i64,
        inclusive: bool,
    },
    FloatRange {
        start: f64,
        end: f64,
        inclusive: bool,
    },
    Tuple(Vec<Pat>),
    Either(Vec<Pat>),
    /// Stands where an error was reported.
    Error,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    NegInt,
    NegFloat,
    NegVec2,
    NegVec3,
    Not,
    /// Of what varies over a surface.
    Texture(UnaryOp),
}

/// Typed operators. `Float` stands for every quantity that is one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    AddInt,
    SubInt,
    MulInt,
    RemInt,
    PowInt,
    AddFloat,
    SubFloat,
    MulFloat,
    DivFloat,
    RemFloat,
    PowFloat,
    AddVec,
    SubVec,
    /// Vector by number.
    ScaleVec,
    DivVec,
    Concat,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    Union,
    Intersection,
    Difference,
    AddSpectrum,
    MulSpectrum,
    /// Spectrum by number.
    ScaleSpectrum,
    DivSpectrum,
    /// `a * b` first applies `b`.
    Compose,
    TransformPoint,
    TransformVector,
    /// Of what varies over a surface.
    Texture(BinaryOp),
}

/// Conversions that keep the meaning.
#[derive(Clone, Debug, PartialEq)]
pub enum Coercion {
    IntToFloat,
    /// A number as a constant spectrum of any kind but emission.
    Constant(crate::types::SpectrumKind),
    /// A tuple of two or three ints or floats.
    TupleToVec,
    List(Box<Coercion>),
    /// Element by element; `None` leaves it.
    Tuple(Vec<Option<Coercion>>),
    /// Of each argument, then of the result.
    Fn(Vec<Option<Coercion>>),
}
