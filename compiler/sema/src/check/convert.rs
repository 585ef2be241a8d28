//! Inference variables, conversions that keep the meaning, common types.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast;

use super::{Checker, Typed};
use crate::code::{Code, Coercion};
use crate::types::{Class, SpectrumKind, TextureKind, Type};

/// Parts of one type, its own parts' included.
const MAX_TYPE_PARTS: usize = 1_000;

/// How a value becomes one of another type.
pub(super) enum Conversion {
    Same,
    By(Coercion),
}

impl Checker<'_> {
    /// A type that is not known yet.
    pub(super) fn fresh(&mut self, class: Option<Class>) -> Type {
        self.infer.push((None, class));
        Type::Infer(self.infer.len() as u32 - 1)
    }

    /// The type with a variable at its root replaced by what is known of it.
    pub(super) fn shallow(&self, ty: &Type) -> Type {
        let mut ty = ty;
        while let Type::Infer(i) = ty {
            match &self.infer[*i as usize].0 {
                Some(known) => ty = known,
                None => break,
            }
        }
        ty.clone()
    }

    /// The type with every variable replaced by what is known of it.
    pub(super) fn known(&self, ty: &Type) -> Type {
        self.shallow(ty).map(&mut |part| self.known(part))
    }

    pub(super) fn has_unknown(&self, ty: &Type) -> bool {
        let ty = self.shallow(ty);
        let mut unknown = matches!(ty, Type::Infer(_));
        ty.map(&mut |part| {
            unknown |= self.has_unknown(part);
            part.clone()
        });
        unknown
    }

    /// The type, unless it has so many parts that checking would take for ever: `let b = (a, a)`, again and again.
    pub(super) fn bounded(&mut self, ty: Type, span: Span) -> Type {
        let mut fuel = MAX_TYPE_PARTS;
        self.count_parts(&ty, &mut fuel);
        if fuel > 0 {
            return ty;
        }
        // Once is enough: what grew so large goes on growing below.
        if !self.diagnostics.iter().any(|old| old.code == codes::LIMIT) {
            let message = format!("the type of this has more than {MAX_TYPE_PARTS} parts");
            self.error(codes::LIMIT, message, span, "too large a type");
        }
        Type::Error
    }

    fn count_parts(&self, ty: &Type, fuel: &mut usize) {
        *fuel = fuel.saturating_sub(1);
        if *fuel > 0 {
            match self.shallow(ty) {
                Type::List(element) => self.count_parts(&element, fuel),
                Type::Tuple(parts) => parts.iter().for_each(|part| self.count_parts(part, fuel)),
                Type::Record(fields) => fields.iter().for_each(|(_, part)| self.count_parts(part, fuel)),
                Type::Fn(function) => {
                    function.params.iter().chain([&function.result]).for_each(|part| self.count_parts(part, fuel));
                }
                _ => {}
            }
        }
    }

    /// Gives a variable a type; `None` if its class forbids.
    fn bind(&mut self, variable: u32, ty: &Type) -> Option<Conversion> {
        if *ty == Type::Infer(variable) {
            return Some(Conversion::Same);
        }
        let class = self.infer[variable as usize].1;
        let (ty, conversion) = self.promoted(ty, class);
        if let Some(class) = class {
            if let Type::Infer(other) = ty {
                self.infer[other as usize].1.get_or_insert(class);
            } else if !class.contains(&ty) {
                return None;
            }
        }
        if self.occurs(variable, &ty) {
            return None;
        }
        self.infer[variable as usize].0 = Some(ty);
        Some(conversion)
    }

    fn occurs(&self, variable: u32, ty: &Type) -> bool {
        let ty = self.shallow(ty);
        let mut found = ty == Type::Infer(variable);
        ty.map(&mut |part| {
            found |= self.occurs(variable, part);
            part.clone()
        });
        found
    }

    /// What a type becomes where a class prefers another: ints as floats, tuples as vectors.
    pub(super) fn promoted(&self, ty: &Type, class: Option<Class>) -> (Type, Conversion) {
        match (class, ty) {
            (Some(Class::Continuous), Type::Int) => (Type::Float, Conversion::By(Coercion::IntToFloat)),
            (Some(Class::Continuous | Class::Vector), Type::Tuple(parts)) if self.is_numeric_tuple(ty) => {
                let vector = if parts.len() == 2 { Type::Vec2 } else { Type::Vec3 };
                (vector, Conversion::By(Coercion::TupleToVec))
            }
            (Some(Class::Textured | Class::TexturedNumber | Class::TexturedVector), ty) => {
                let kind = self.known(ty).texture_kind();
                let conversion = match ty {
                    Type::Int => Conversion::By(Coercion::IntToFloat),
                    _ => Conversion::Same,
                };
                (kind.map_or_else(|| ty.clone(), Type::Texture), conversion)
            }
            _ => (ty.clone(), Conversion::Same),
        }
    }

    /// A tuple of two or three numbers.
    pub(super) fn is_numeric_tuple(&self, ty: &Type) -> bool {
        let Type::Tuple(parts) = ty else { return false };
        let number = |part: &Type| matches!(self.shallow(part), Type::Int | Type::Float);
        (parts.len() == 2 || parts.len() == 3) && parts.iter().all(number)
    }

    /// Whether a value of one type may stand where another is wanted, and how.
    pub(super) fn convert(&mut self, from: &Type, to: &Type) -> Option<Conversion> {
        use Type::*;
        let (from, to) = (self.shallow(from), self.shallow(to));
        match (&from, &to) {
            (Error, _) | (_, Error) => Some(Conversion::Same),
            (_, Infer(variable)) => self.bind(*variable, &from),
            (_, AnyOf(class)) => self.known(&from).within(*class).then_some(Conversion::Same),
            (Infer(variable), _) => self.bind(*variable, &to).map(|_| Conversion::Same),
            (Int, Float) => Some(Conversion::By(Coercion::IntToFloat)),
            (Int | Float, Spectrum(kind)) if *kind != SpectrumKind::Emission => {
                Some(Conversion::By(Coercion::Constant(*kind)))
            }
            (Int | Float | Texture(TextureKind::Float), Texture(TextureKind::Spectrum(kind)))
                if *kind != SpectrumKind::Emission =>
            {
                Some(Conversion::By(Coercion::Constant(*kind)))
            }
            (Int, Texture(TextureKind::Float)) => Some(Conversion::By(Coercion::IntToFloat)),
            (from, Texture(wanted)) => (self.known(from).texture_kind()? == *wanted).then_some(Conversion::Same),
            (Tuple(parts), Vec2) if parts.len() == 2 && self.is_numeric_tuple(&from) => {
                Some(Conversion::By(Coercion::TupleToVec))
            }
            (Tuple(parts), Vec3 | Point) if parts.len() == 3 && self.is_numeric_tuple(&from) => {
                Some(Conversion::By(Coercion::TupleToVec))
            }
            (Direction, Vec3) => Some(Conversion::Same),
            (from, Shape) if from.is_shape() => Some(Conversion::Same),
            (Bsdf | Emitter | Medium, Attributes) => Some(Conversion::Same),
            (List(from), List(to)) => Some(match self.convert(from, to)? {
                Conversion::Same => Conversion::Same,
                Conversion::By(element) => Conversion::By(Coercion::List(Box::new(element))),
            }),
            (Tuple(from), Tuple(to)) if from.len() == to.len() => {
                self.convert_parts(from.iter().zip(to.iter()).collect())
            }
            (Record(from), Record(to)) if from.len() == to.len() => {
                if from.iter().zip(to.iter()).any(|((a, _), (b, _))| a != b) {
                    return None;
                }
                self.convert_parts(from.iter().zip(to.iter()).map(|((_, from), (_, to))| (from, to)).collect())
            }
            (Fn(from), Fn(to)) if from.params.len() == to.params.len() => {
                let mut parts: Vec<(&Type, &Type)> = to.params.iter().zip(from.params.iter()).collect();
                parts.push((&from.result, &to.result));
                match self.convert_parts(parts)? {
                    Conversion::By(Coercion::Tuple(parts)) => Some(Conversion::By(Coercion::Fn(parts))),
                    same => Some(same),
                }
            }
            (from, to) => (from == to).then_some(Conversion::Same),
        }
    }

    fn convert_parts(&mut self, parts: Vec<(&Type, &Type)>) -> Option<Conversion> {
        let mut coercions = Vec::with_capacity(parts.len());
        for (from, to) in parts {
            coercions.push(match self.convert(from, to)? {
                Conversion::Same => None,
                Conversion::By(coercion) => Some(coercion),
            });
        }
        let same = coercions.iter().all(Option::is_none);
        Some(if same { Conversion::Same } else { Conversion::By(Coercion::Tuple(coercions)) })
    }

    /// The type that both can be converted to.
    pub(super) fn join(&mut self, a: &Type, b: &Type) -> Option<Type> {
        let (a, b) = (self.shallow(a), self.shallow(b));
        if let (Type::List(a), Type::List(b)) = (&a, &b) {
            return self.join(a, b).map(Type::list);
        }
        if let (Type::Tuple(x), Type::Tuple(y)) = (&a, &b)
            && x.len() == y.len()
        {
            let parts: Option<Vec<Type>> = x.iter().zip(y.iter()).map(|(x, y)| self.join(x, y)).collect();
            return parts.map(Type::tuple);
        }
        if a.is_error() || b.is_error() {
            return Some(Type::Error);
        }
        if self.convert(&a, &b).is_some() {
            return Some(b);
        }
        if self.convert(&b, &a).is_some() {
            return Some(a);
        }
        if a.is_shape() && b.is_shape() {
            return Some(Type::Shape);
        }
        let attribute = |ty: &Type| matches!(ty, Type::Bsdf | Type::Emitter | Type::Medium | Type::Attributes);
        (attribute(&a) && attribute(&b)).then_some(Type::Attributes)
    }

    /// Checks an expression that must have a type, and converts it.
    pub(super) fn expect(&mut self, expr: &ast::Expr, wanted: &Type) -> Code {
        let found = self.expr(expr, Some(wanted));
        self.coerce(found, wanted, expr.span, None)
    }

    /// Converts to the wanted type, or reports. `role`: as in "`radius` of `sphere`".
    pub(super) fn coerce(&mut self, found: Typed, wanted: &Type, span: Span, role: Option<&str>) -> Code {
        match self.convert(&found.ty, wanted) {
            Some(Conversion::Same) => found.code,
            Some(Conversion::By(coercion)) => apply(coercion, found.code, span),
            None => {
                self.mismatch(&found.ty, wanted, span, role);
                Code::Error
            }
        }
    }

    pub(super) fn mismatch(&mut self, found: &Type, wanted: &Type, span: Span, role: Option<&str>) {
        let (found, mut wanted) = (self.known(found), self.known(wanted));
        if let Type::Texture(kind) = wanted
            && !found.holds_texture()
        {
            // Who does not think of textures need not hear of them.
            wanted = kind.value_type();
        }
        let open = |ty: &Type| matches!(ty, Type::Surface) || matches!(ty, Type::List(t) if **t == Type::Surface);
        if wanted == Type::Solid && open(&found) {
            return self.not_a_solid(&found, span);
        }
        let needs = match &wanted {
            Type::AnyOf(class) => class.description().to_owned(),
            Type::Infer(i) => self.infer[*i as usize].1.map_or("a value", Class::description).to_owned(),
            ty => ty.with_article(),
        };
        let message = match role {
            Some(role) => format!("{role} needs {needs}, but this is {}", found.with_article()),
            None => format!("expected {needs}, found {}", found.with_article()),
        };
        let diagnostic =
            Diagnostic::new(codes::TYPE_MISMATCH, message).label(span, format!("this is {}", found.with_article()));
        self.report(match advice(&found, &wanted) {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        });
    }

    pub(super) fn not_a_solid(&mut self, found: &Type, span: Span) {
        let mut element = found.clone();
        while let Type::List(inner) = element {
            element = inner.as_ref().clone();
        }
        let (message, label, help) = if element == Type::Shape {
            let message = "only solids can be operands of a Boolean operation, but this may be open or a light";
            (message, "not known to be solid", "keep solids apart from other shapes: in a list of their own")
        } else {
            let message = "a surface cannot be an operand of a Boolean operation";
            (message, "and encloses no volume", "use a closed solid, such as `half_space()` for a plane")
        };
        let label = format!("this is {} {label}", found.with_article()).replace("` not", "`, not");
        self.report(Diagnostic::new(codes::NOT_A_SOLID, message).label(span, label).help(help));
    }
}

impl Type {
    fn within(&self, class: Class) -> bool {
        class.contains(self)
    }
}

/// Converts now where the value is known.
fn apply(coercion: Coercion, code: Code, span: Span) -> Code {
    match (&coercion, &code) {
        (Coercion::IntToFloat, Code::Const(value)) => Code::Const(crate::value::Value::Float(value.as_float())),
        _ => Code::Coerce { coercion: Box::new(coercion), value: Box::new(code), span },
    }
}

/// One thing to do about a mismatch.
fn advice(found: &Type, wanted: &Type) -> Option<String> {
    use Type::*;
    let text = match (found, wanted) {
        (Int | Float, Angle) => "write the unit: `45deg` or `0.5rad`",
        (Texture(TextureKind::Bool), Bool) => {
            "what varies over a surface is chosen by `select(condition, then, otherwise)` from std.texture"
        }
        (Texture(TextureKind::Float), Texture(TextureKind::Angle)) => "multiply by a unit: `x * 1deg` or `x * 1rad`",
        (Texture(_), wanted) if wanted.texture_kind().is_none() || !wanted.holds_texture() => {
            "this varies over a surface, but only one value can stand here"
        }
        (Int | Float, Wavelength) => "write the unit: `550nm`",
        (Int | Float, Temperature) => "write the unit: `6500K`",
        (Angle, Int | Float) => "`degrees(angle)` and `radians(angle)` give numbers",
        (Float, Int) => "`round(x)`, `floor(x)` and `ceil(x)` give ints",
        (Int | Float, Spectrum(SpectrumKind::Emission)) => {
            "write `constant_emission(x)`, or scale a spectrum: `d65 * x` (from std.spectra)"
        }
        (Int | Float, Vec3) => "write a vector: `(x, y, z)`",
        (List(_), Vec2) => "write a vector: `(x, y)`",
        (List(_), Vec3 | Point) => "write a vector: `(x, y, z)`",
        (Tuple(_) | Vec3 | Point, Direction) => "`direction(x, y, z)` and `normalize(v)` give directions",
        (Point, Vec3) => "the vector from the origin is `p - point(0, 0, 0)`",
        (Vec3 | Direction, Point) => "the point at the end of a vector is `point(0, 0, 0) + v`",
        (Bsdf | Emitter | Medium | Attributes, ty) if ty.is_shape() => "attach it to a shape: `shape |> with(…)`",
        (Spectrum(_), Bsdf) => "make a bsdf of it: `lambert(…)` from std.material",
        (Spectrum(_), Emitter) => "make an emitter of it: `emitter(…)`",
        (Spectrum(found), Spectrum(wanted)) => {
            let kind = |kind: &SpectrumKind| format!("`{}` is {}", kind.name(), kind.meaning());
            return Some(format!("kinds of spectra do not mix: {}, {}", kind(found), kind(wanted)));
        }
        (Fn(_), Fn(_)) => return None,
        (Fn(_), _) => "call it: `f(…)`",
        (ty, _) if ty.is_unit() => "an `if` without `else`, and a block that ends in a definition, have no value",
        (found, List(element)) if found == &**element => "write a list: `[x]`",
        _ => return None,
    };
    Some(text.to_owned())
}

/// Makes one of the parts of a generic signature.
pub(super) fn instantiate(ty: &Type, variables: &[Type]) -> Type {
    match ty {
        Type::Var(i) => variables[usize::from(*i)].clone(),
        other => other.map(&mut |part| instantiate(part, variables)),
    }
}

/// Field types sorted by name: the order of a record's fields has no meaning.
pub(super) fn record(mut fields: Vec<(String, Type)>) -> Type {
    fields.sort_by(|a, b| a.0.cmp(&b.0));
    Type::Record(Arc::from(fields))
}
