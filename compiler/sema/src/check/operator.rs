//! Operators: which types they take, and which typed instruction they become.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast::{self, BinaryOp, UnaryOp};

use super::{Checker, Typed, texture};
use crate::code::{Binary, Code, Coercion, Unary};
use crate::types::{Class, SpectrumKind, TextureKind, Type};

/// An instruction, the types to which its operands are converted, and its result.
struct Rule {
    op: Binary,
    left: Type,
    right: Type,
    result: Type,
    swap: bool,
}

fn rule(op: Binary, left: Type, right: Type, result: Type) -> Option<Rule> {
    Some(Rule { op, left, right, result, swap: false })
}

/// The same, with operands that the instruction wants the other way round.
fn swapped(op: Binary, left: Type, right: Type, result: Type) -> Option<Rule> {
    Some(Rule { op, left, right, result, swap: true })
}

fn is_number(ty: &Type) -> bool {
    matches!(ty, Type::Int | Type::Float)
}

fn is_quantity(ty: &Type) -> bool {
    matches!(ty, Type::Angle | Type::Wavelength | Type::Temperature)
}

/// A direction is a vector in calculations; a tuple of numbers next to a vector is one too.
fn as_vector(ty: &Type) -> Option<Type> {
    match ty {
        Type::Vec2 => Some(Type::Vec2),
        Type::Vec3 | Type::Direction => Some(Type::Vec3),
        Type::Tuple(parts) if parts.iter().all(is_number) && parts.len() == 2 => Some(Type::Vec2),
        Type::Tuple(parts) if parts.iter().all(is_number) && parts.len() == 3 => Some(Type::Vec3),
        _ => None,
    }
}

fn additive(op: BinaryOp, a: &Type, b: &Type) -> Option<Rule> {
    use Type::*;
    let add = op == BinaryOp::Add;
    let pick = |plus: Binary, minus: Binary| if add { plus } else { minus };
    let float = pick(Binary::AddFloat, Binary::SubFloat);
    let vec = pick(Binary::AddVec, Binary::SubVec);
    match (a, b) {
        (Int, Int) => rule(pick(Binary::AddInt, Binary::SubInt), Int, Int, Int),
        (a, b) if is_number(a) && is_number(b) => rule(float, Float, Float, Float),
        (a, b) if is_quantity(a) && a == b => rule(float, a.clone(), a.clone(), a.clone()),
        (Point, Point) if !add => rule(vec, Point, Point, Vec3),
        (Point, b) if as_vector(b) == Some(Vec3) => rule(vec, Point, Vec3, Point),
        (a, Point) if add && as_vector(a) == Some(Vec3) => rule(vec, Vec3, Point, Point),
        (Str, Str) if add => rule(Binary::Concat, Str, Str, Str),
        (Spectrum(x), Spectrum(y)) if add && x == y => rule(Binary::AddSpectrum, a.clone(), b.clone(), a.clone()),
        (a, b) if !add && Class::SolidOperand.contains(a) && Class::SolidOperand.contains(b) => {
            rule(Binary::Difference, a.clone(), b.clone(), Solid)
        }
        (a, b) => {
            let vector = as_vector(a)?;
            (as_vector(b)? == vector).then(|| rule(vec, vector.clone(), vector.clone(), vector))?
        }
    }
}

fn product(a: &Type, b: &Type) -> Option<Rule> {
    use SpectrumKind::{Emission, Reflectance, Transmission};
    use Type::*;
    match (a, b) {
        (Int, Int) => rule(Binary::MulInt, Int, Int, Int),
        (a, b) if is_number(a) && is_number(b) => rule(Binary::MulFloat, Float, Float, Float),
        (a, b) if is_quantity(a) && is_number(b) => rule(Binary::MulFloat, a.clone(), Float, a.clone()),
        (a, b) if is_number(a) && is_quantity(b) => rule(Binary::MulFloat, Float, b.clone(), b.clone()),
        (Spectrum(_), b) if is_number(b) => rule(Binary::ScaleSpectrum, a.clone(), Float, a.clone()),
        (a, Spectrum(_)) if is_number(a) => swapped(Binary::ScaleSpectrum, Float, b.clone(), b.clone()),
        (Spectrum(Reflectance), Spectrum(Reflectance | Emission))
        | (Spectrum(Transmission), Spectrum(Transmission | Emission)) => {
            rule(Binary::MulSpectrum, a.clone(), b.clone(), b.clone())
        }
        (Spectrum(Emission), Spectrum(Reflectance | Transmission)) => {
            rule(Binary::MulSpectrum, a.clone(), b.clone(), a.clone())
        }
        (Transform, Transform) => rule(Binary::Compose, Transform, Transform, Transform),
        (Transform, Point) => rule(Binary::TransformPoint, Transform, Point, Point),
        (Transform, Vec3 | Direction) => rule(Binary::TransformVector, Transform, Vec3, Vec3),
        (a, b) if is_number(b) => as_vector(a).and_then(|v| rule(Binary::ScaleVec, v.clone(), Float, v)),
        (a, b) if is_number(a) => as_vector(b).and_then(|v| swapped(Binary::ScaleVec, Float, v.clone(), v)),
        _ => None,
    }
}

fn quotient(a: &Type, b: &Type) -> Option<Rule> {
    use Type::*;
    match (a, b) {
        (a, b) if is_number(a) && is_number(b) => rule(Binary::DivFloat, Float, Float, Float),
        (a, b) if is_quantity(a) && is_number(b) => rule(Binary::DivFloat, a.clone(), Float, a.clone()),
        (a, b) if is_quantity(a) && a == b => rule(Binary::DivFloat, a.clone(), a.clone(), Float),
        (Spectrum(_), b) if is_number(b) => rule(Binary::DivSpectrum, a.clone(), Float, a.clone()),
        (a, b) if is_number(b) => as_vector(a).and_then(|v| rule(Binary::DivVec, v.clone(), Float, v)),
        _ => None,
    }
}

fn remainder(a: &Type, b: &Type) -> Option<Rule> {
    match (a, b) {
        (Type::Int, Type::Int) => rule(Binary::RemInt, Type::Int, Type::Int, Type::Int),
        (a, b) if is_number(a) && is_number(b) => rule(Binary::RemFloat, Type::Float, Type::Float, Type::Float),
        (a, b) if is_quantity(a) && a == b => rule(Binary::RemFloat, a.clone(), a.clone(), a.clone()),
        _ => None,
    }
}

fn power(a: &Type, b: &Type) -> Option<Rule> {
    match (a, b) {
        (Type::Int, Type::Int) => rule(Binary::PowInt, Type::Int, Type::Int, Type::Int),
        (a, b) if is_number(a) && is_number(b) => rule(Binary::PowFloat, Type::Float, Type::Float, Type::Float),
        _ => None,
    }
}

fn order(op: BinaryOp, a: &Type, b: &Type) -> Option<Rule> {
    let op = match op {
        BinaryOp::Lt => Binary::Lt,
        BinaryOp::Le => Binary::Le,
        BinaryOp::Gt => Binary::Gt,
        _ => Binary::Ge,
    };
    match (a, b) {
        (Type::Int, Type::Int) | (Type::Str, Type::Str) => rule(op, a.clone(), b.clone(), Type::Bool),
        (a, b) if is_number(a) && is_number(b) => rule(op, Type::Float, Type::Float, Type::Bool),
        (a, b) if is_quantity(a) && a == b => rule(op, a.clone(), a.clone(), Type::Bool),
        _ => None,
    }
}

fn boolean(op: BinaryOp, a: &Type, b: &Type) -> Option<Rule> {
    let (op, class) = match op {
        BinaryOp::Union => (Binary::Union, Class::UnionOperand),
        _ => (Binary::Intersection, Class::SolidOperand),
    };
    (class.contains(a) && class.contains(b)).then(|| rule(op, a.clone(), b.clone(), Type::Solid))?
}

impl Checker<'_> {
    pub(super) fn unary(&mut self, op: UnaryOp, op_span: Span, operand: &ast::Expr) -> Typed {
        let operand_span = operand.span;
        let operand = self.expr(operand, None);
        let ty = self.shallow(&operand.ty);
        let (op, ty) = match (op, &ty) {
            (_, Type::Error) => return Typed::error(),
            (_, Type::Infer(_)) => {
                self.needs_type(operand_span);
                return Typed::error();
            }
            (UnaryOp::Not, Type::Bool) => (Unary::Not, ty),
            (UnaryOp::Neg, Type::Int) => (Unary::NegInt, ty),
            (UnaryOp::Neg, ty) if ty.is_float_like() => (Unary::NegFloat, ty.clone()),
            (UnaryOp::Neg, Type::Vec2) => (Unary::NegVec2, ty),
            (UnaryOp::Neg, Type::Vec3 | Type::Direction) => (Unary::NegVec3, ty),
            (UnaryOp::Not, Type::Texture(TextureKind::Bool)) => (Unary::Texture(op), ty),
            (UnaryOp::Neg, Type::Texture(kind)) if !matches!(kind, TextureKind::Bool | TextureKind::Spectrum(_)) => {
                (Unary::Texture(op), ty)
            }
            (UnaryOp::Neg, Type::Tuple(_)) if as_vector(&self.known(&ty)).is_some() => {
                return self.negated_tuple(operand, op_span, operand_span);
            }
            _ => {
                let sign = if op == UnaryOp::Not { "!" } else { "-" };
                let message = format!("`{sign}` does not apply to {}", self.known(&ty).with_article());
                self.error(codes::OPERANDS, message, op_span, "this operator");
                return Typed::error();
            }
        };
        if let (Unary::NegInt | Unary::NegFloat, Code::Const(value)) = (op, &operand.code)
            && let Some(negated) = negated(value)
        {
            return Typed::new(Code::Const(negated), ty);
        }
        Typed::new(Code::Unary { op, operand: Box::new(operand.code), span: op_span }, ty)
    }

    fn negated_tuple(&mut self, operand: Typed, op_span: Span, span: Span) -> Typed {
        let vector = as_vector(&self.known(&operand.ty)).unwrap_or(Type::Error);
        let op = if vector == Type::Vec2 { Unary::NegVec2 } else { Unary::NegVec3 };
        let code = Code::Coerce { coercion: Box::new(Coercion::TupleToVec), value: Box::new(operand.code), span };
        Typed::new(Code::Unary { op, operand: Box::new(code), span: op_span }, vector)
    }

    pub(super) fn binary(
        &mut self,
        op: BinaryOp,
        op_span: Span,
        left: &ast::Expr,
        right: &ast::Expr,
        span: Span,
    ) -> Typed {
        if let BinaryOp::And | BinaryOp::Or = op {
            let (a, b) = (self.expr(left, Some(&Type::Bool)), self.expr(right, Some(&Type::Bool)));
            if self.shallow(&a.ty).holds_texture() || self.shallow(&b.ty).holds_texture() {
                return self.texture_operation(op, op_span, (a, left.span), (b, right.span));
            }
            let a = Box::new(self.coerce(a, &Type::Bool, left.span, None));
            let b = Box::new(self.coerce(b, &Type::Bool, right.span, None));
            return Typed::new(if op == BinaryOp::And { Code::And(a, b) } else { Code::Or(a, b) }, Type::Bool);
        }
        let a = self.expr(left, None);
        let b = self.expr(right, None);
        let (ta, tb) = (self.known(&a.ty), self.known(&b.ty));
        if ta.is_error() || tb.is_error() {
            return Typed::new(Code::Error, result_anyway(op));
        }
        for (ty, at) in [(&ta, left.span), (&tb, right.span)] {
            if let Type::Infer(_) = ty {
                self.needs_type(at);
                return Typed::error();
            }
        }
        if ta.holds_texture() || tb.holds_texture() {
            return self.texture_operation(op, op_span, (a, left.span), (b, right.span));
        }
        if let BinaryOp::Eq | BinaryOp::Ne = op {
            return self.equality(op, op_span, (a, left.span), (b, right.span));
        }
        let found = match op {
            BinaryOp::Add | BinaryOp::Sub => self.lists(op, &ta, &tb).or_else(|| additive(op, &ta, &tb)),
            BinaryOp::Mul => product(&ta, &tb),
            BinaryOp::Div => quotient(&ta, &tb),
            BinaryOp::Rem => remainder(&ta, &tb),
            BinaryOp::Pow => power(&ta, &tb),
            BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge => order(op, &ta, &tb),
            _ => boolean(op, &ta, &tb),
        };
        let Some(found) = found else {
            self.wrong_operands(op, op_span, (&ta, left.span), (&tb, right.span));
            return Typed::new(Code::Error, result_anyway(op));
        };
        let a = self.coerce(a, &found.left, left.span, None);
        let b = self.coerce(b, &found.right, right.span, None);
        let (a, b) = if found.swap { (b, a) } else { (a, b) };
        // Geometry remembers the whole expression, arithmetic the operator that failed.
        let at = if found.result == Type::Solid { span } else { op_span };
        Typed::new(Code::Binary { op: found.op, left: Box::new(a), right: Box::new(b), span: at }, found.result)
    }

    fn texture_operation(&mut self, op: BinaryOp, op_span: Span, a: (Typed, Span), b: (Typed, Span)) -> Typed {
        let (ta, tb) = (self.known(&a.0.ty), self.known(&b.0.ty));
        let Some([_, _, result]) = texture::rule(op, &ta, &tb) else {
            self.wrong_operands(op, op_span, (&ta, a.1), (&tb, b.1));
            return Typed::new(Code::Error, result_anyway(op));
        };
        let (left, right) = (Box::new(a.0.code), Box::new(b.0.code));
        Typed::new(Code::Binary { op: Binary::Texture(op), left, right, span: op_span }, Type::Texture(result))
    }

    fn lists(&mut self, op: BinaryOp, a: &Type, b: &Type) -> Option<Rule> {
        if op != BinaryOp::Add || !matches!((a, b), (Type::List(_), Type::List(_))) {
            return None;
        }
        let joined = self.join(a, b)?;
        rule(Binary::Concat, joined.clone(), joined.clone(), joined)
    }

    fn equality(&mut self, op: BinaryOp, op_span: Span, a: (Typed, Span), b: (Typed, Span)) -> Typed {
        let (ta, tb) = (self.known(&a.0.ty), self.known(&b.0.ty));
        let Some(joined) = self.join(&ta, &tb).filter(comparable) else {
            self.wrong_operands(op, op_span, (&ta, a.1), (&tb, b.1));
            return Typed::new(Code::Error, Type::Bool);
        };
        let left = Box::new(self.coerce(a.0, &joined, a.1, None));
        let right = Box::new(self.coerce(b.0, &joined, b.1, None));
        let op = if op == BinaryOp::Eq { Binary::Eq } else { Binary::Ne };
        Typed::new(Code::Binary { op, left, right, span: op_span }, Type::Bool)
    }

    fn wrong_operands(&mut self, op: BinaryOp, op_span: Span, a: (&Type, Span), b: (&Type, Span)) {
        if let BinaryOp::Union | BinaryOp::Intersection | BinaryOp::Sub = op {
            let solids = [&a, &b].iter().any(|(ty, _)| Class::SolidOperand.contains(ty));
            for (ty, span) in [a, b] {
                let open = Class::Geometry.contains(ty) && !Class::SolidOperand.contains(ty);
                if open && (solids || op != BinaryOp::Sub) {
                    return self.not_a_solid(ty, span);
                }
            }
        }
        let message = format!("`{}` does not apply to `{}` and `{}`", symbol(op), a.0, b.0);
        let diagnostic = Diagnostic::new(codes::OPERANDS, message)
            .label(op_span, "this operator")
            .label(a.1, format!("this is {}", a.0.with_article()))
            .label(b.1, format!("this is {}", b.0.with_article()));
        self.report(match advice(op, a.0, b.0) {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        });
    }
}

fn negated(value: &crate::value::Value) -> Option<crate::value::Value> {
    use crate::value::Value;
    match value {
        Value::Int(i) => i.checked_neg().map(Value::Int),
        Value::Float(x) => Some(Value::Float(-x)),
        _ => None,
    }
}

/// What an operator gives whatever its operands: errors in them need not spread.
fn result_anyway(op: BinaryOp) -> Type {
    match op {
        BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge | BinaryOp::Eq | BinaryOp::Ne => Type::Bool,
        BinaryOp::Union | BinaryOp::Intersection => Type::Solid,
        _ => Type::Error,
    }
}

/// Whether `==` has a meaning.
fn comparable(ty: &Type) -> bool {
    match ty {
        Type::Bool | Type::Int | Type::Str | Type::Vec2 => true,
        Type::List(element) => comparable(element),
        Type::Tuple(parts) => parts.iter().all(comparable),
        Type::Record(fields) => fields.iter().all(|(_, ty)| comparable(ty)),
        Type::Error | Type::Infer(_) => true,
        ty => ty.is_float_like() || ty.is_vec3_like(),
    }
}

fn symbol(op: BinaryOp) -> &'static str {
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

/// One thing to do about wrong operands.
fn advice(op: BinaryOp, a: &Type, b: &Type) -> Option<&'static str> {
    let solids = Class::UnionOperand.contains(a) && Class::UnionOperand.contains(b);
    let angle = *a == Type::Angle && is_number(b) || *b == Type::Angle && is_number(a);
    let vectors = as_vector(a).is_some() && as_vector(b).is_some();
    Some(match op {
        BinaryOp::Add if solids => "the union of solids is `a | b`",
        BinaryOp::Mul if solids => "the intersection of solids is `a & b`",
        BinaryOp::Sub | BinaryOp::Intersection if solids => "only solids can be cut; lights can only be joined by `|`",
        BinaryOp::Mul if vectors => "products of vectors are `dot(a, b)` and `cross(a, b)`",
        BinaryOp::Union if *a == Type::Bool => "`or` is written `||`",
        BinaryOp::Intersection if *a == Type::Bool => "`and` is written `&&`",
        BinaryOp::Add if *a == Type::Str || *b == Type::Str => "`str(x)` makes a string of a value",
        BinaryOp::Add if *a == Type::Point && *b == Type::Point => "points have a difference, but no sum",
        _ if angle => "write the unit of the number: `45deg` or `0.5rad`",
        _ => return None,
    })
}
