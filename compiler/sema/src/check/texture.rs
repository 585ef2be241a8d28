//! Operators on values that vary over a surface: as on ordinary ones, point by point.

use arsc_syntax::ast::BinaryOp;

use crate::types::{SpectrumKind, TextureKind, Type};

impl Type {
    /// The kind of texture that a value of the type is or may stand for: what is the same everywhere is a texture, too.
    pub(super) fn texture_kind(&self) -> Option<TextureKind> {
        let is_number = |ty: &Type| matches!(ty.texture_kind(), Some(TextureKind::Float));
        match self {
            Type::Texture(kind) => Some(*kind),
            Type::Bool => Some(TextureKind::Bool),
            Type::Int | Type::Float => Some(TextureKind::Float),
            Type::Angle => Some(TextureKind::Angle),
            Type::Vec2 => Some(TextureKind::Vec2),
            Type::Vec3 | Type::Point | Type::Direction => Some(TextureKind::Vec3),
            Type::Spectrum(kind) => Some(TextureKind::Spectrum(*kind)),
            Type::Tuple(parts) if parts.iter().all(is_number) => match parts.len() {
                2 => Some(TextureKind::Vec2),
                3 => Some(TextureKind::Vec3),
                _ => None,
            },
            _ => None,
        }
    }

    /// A texture, or a tuple that holds one.
    pub(super) fn holds_texture(&self) -> bool {
        match self {
            Type::Texture(_) => true,
            Type::Tuple(parts) => parts.iter().any(Type::holds_texture),
            _ => false,
        }
    }
}

/// The kinds that the operands are converted to, and that of the result.
pub(super) fn rule(op: BinaryOp, a: &Type, b: &Type) -> Option<[TextureKind; 3]> {
    use TextureKind::{Angle, Bool, Float, Spectrum, Vec2, Vec3};
    if (a, b.texture_kind()) == (&Type::Transform, Some(Vec3)) && op == BinaryOp::Mul {
        return Some([Vec3; 3]);
    }
    let (a, b) = (a.texture_kind()?, b.texture_kind()?);
    let is_linear = |kind: TextureKind| !matches!(kind, Bool);
    let is_quantity = |kind: TextureKind| matches!(kind, Float | Angle);
    let result = match op {
        BinaryOp::Add if a == b && is_linear(a) => a,
        BinaryOp::Sub if a == b && is_linear(a) && !matches!(a, Spectrum(_)) => a,
        BinaryOp::Mul if b == Float && is_linear(a) => a,
        BinaryOp::Mul if a == Float && is_linear(b) => b,
        BinaryOp::Mul => spectrum_product(a, b)?,
        BinaryOp::Div if b == Float && is_linear(a) => a,
        BinaryOp::Div if a == b && is_quantity(a) => Float,
        BinaryOp::Rem if a == b && is_quantity(a) => a,
        BinaryOp::Rem if b == Float && matches!(a, Vec2 | Vec3) => a,
        BinaryOp::Pow if a == Float && b == Float => Float,
        BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge if a == b && is_quantity(a) => Bool,
        BinaryOp::Eq | BinaryOp::Ne if a == b && (is_quantity(a) || a == Bool) => Bool,
        BinaryOp::And | BinaryOp::Or if a == Bool && b == Bool => Bool,
        _ => return None,
    };
    Some([a, b, result])
}

/// As of plain spectra.
fn spectrum_product(a: TextureKind, b: TextureKind) -> Option<TextureKind> {
    use SpectrumKind::{Emission, Reflectance, Transmission};
    let (TextureKind::Spectrum(x), TextureKind::Spectrum(y)) = (a, b) else { return None };
    match (x, y) {
        (Reflectance, Reflectance | Emission) | (Transmission, Transmission | Emission) => Some(b),
        (Emission, Reflectance | Transmission) => Some(a),
        _ => None,
    }
}
