//! Static types of the language.
//!
//! Invariants: [`Type::Var`] and [`Type::AnyOf`] occur in signatures of builtins alone, [`Type::Infer`] only while
//! a module is checked. Quantities carry one unit each: angles radians, wavelengths nanometres, temperatures kelvin.

use std::fmt;
use std::sync::Arc;

/// What a spectrum means. Kinds do not mix: an emission cannot be passed as a reflectance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpectrumKind {
    /// Share of the light that comes back, within [0, 1].
    Reflectance,
    /// Share of the light that goes through, within [0, 1].
    Transmission,
    /// Radiance, intensity or irradiance per nanometre.
    Emission,
    /// Real part of the index of refraction.
    RefractiveIndex,
    /// Imaginary part k of the index of refraction; dimensionless.
    Extinction,
    /// Absorption or scattering per metre.
    Coefficient,
}

impl SpectrumKind {
    /// The name of its type.
    pub const fn name(self) -> &'static str {
        match self {
            SpectrumKind::Reflectance => "reflectance",
            SpectrumKind::Transmission => "transmission",
            SpectrumKind::Emission => "emission",
            SpectrumKind::RefractiveIndex => "refractive_index",
            SpectrumKind::Extinction => "extinction",
            SpectrumKind::Coefficient => "coefficient",
        }
    }

    /// What its values are, as in "a reflectance is …".
    pub const fn meaning(self) -> &'static str {
        match self {
            SpectrumKind::Reflectance => "the share of light that comes back",
            SpectrumKind::Transmission => "the share of light that goes through",
            SpectrumKind::Emission => "light per nanometre",
            SpectrumKind::RefractiveIndex => "the real part of the index, eta",
            SpectrumKind::Extinction => "the imaginary part of the index, k",
            SpectrumKind::Coefficient => "absorption or scattering per metre",
        }
    }
}

/// What varies over a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureKind {
    Bool,
    Float,
    Angle,
    Vec2,
    Vec3,
    Spectrum(SpectrumKind),
}

impl TextureKind {
    /// The type of one of its values.
    pub const fn value_type(self) -> Type {
        match self {
            TextureKind::Bool => Type::Bool,
            TextureKind::Float => Type::Float,
            TextureKind::Angle => Type::Angle,
            TextureKind::Vec2 => Type::Vec2,
            TextureKind::Vec3 => Type::Vec3,
            TextureKind::Spectrum(kind) => Type::Spectrum(kind),
        }
    }

    /// The name of that type.
    pub const fn name(self) -> &'static str {
        match self {
            TextureKind::Bool => "bool",
            TextureKind::Float => "float",
            TextureKind::Angle => "angle",
            TextureKind::Vec2 => "vec2",
            TextureKind::Vec3 => "vec3",
            TextureKind::Spectrum(kind) => kind.name(),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Type {
    /// Something was wrong and has been reported; agrees with everything.
    Error,
    Bool,
    Int,
    Float,
    Str,
    Angle,
    Wavelength,
    Temperature,
    Vec2,
    Vec3,
    Point,
    /// A unit vector.
    Direction,
    Transform,
    Spectrum(SpectrumKind),
    Bsdf,
    Emitter,
    /// `cut_with(…)`, `inherit()` as attributes.
    Attributes,
    Medium,
    /// What a fluorescent surface gives back.
    Reradiation,
    /// A fluorescent substance in a medium.
    Dye,
    PhaseFunction,
    Density,
    /// A value that varies over a surface.
    Texture(TextureKind),
    /// Closed geometry.
    Solid,
    /// Open geometry.
    Surface,
    Light,
    Environment,
    /// Any of solid, surface, light, environment.
    Shape,
    Camera,
    Filter,
    /// What a field of view refers to.
    Across,
    FisheyeMapping,
    Action,
    Sampler,
    Exposure,
    Observer,
    Strategy,
    /// Of the normals of microfacets.
    Distribution,
    SkyModel,
    List(Arc<Type>),
    /// The empty tuple is the value of what has none.
    Tuple(Arc<[Type]>),
    Record(Arc<[(String, Type)]>),
    Fn(Arc<FnType>),
    /// Variable of a builtin's signature.
    Var(u8),
    /// In a builtin's signature: any one type of the class.
    AnyOf(Class),
    /// Not known yet: a variable of the checker.
    Infer(u32),
}

#[derive(Clone, Debug, PartialEq)]
pub struct FnType {
    pub params: Vec<Type>,
    pub result: Type,
}

/// Sets of types that builtins accept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    Any,
    /// `int`, `float`.
    Number,
    /// Numbers and quantities with a unit: what can be compared and ordered.
    Quantity,
    /// What can be added and scaled: quantities, vectors, spectra.
    Linear,
    /// As `Linear`, ints taken as floats and tuples of numbers as vectors.
    Continuous,
    /// Vectors: `vec2`, `vec3`, `direction`.
    Vector,
    /// Whatever a transform moves: shapes, lights, transforms, and lists of these.
    Placeable,
    /// Solids and surfaces, and lists of these.
    Geometry,
    /// Solids, lights, environments, and lists of these.
    UnionOperand,
    /// Solids and lists of these.
    SolidOperand,
    /// Bsdfs, emitters, media, bundles, and lists of these.
    Attribute,
    /// What may vary over a surface, taken as such.
    Textured,
    /// Numbers, angles and vectors that may vary over a surface, taken as such.
    TexturedNumber,
    /// Vectors that may vary.
    TexturedVector,
}

impl Class {
    pub fn contains(self, ty: &Type) -> bool {
        use Type::*;
        match ty {
            Error | Infer(_) => return true,
            List(element)
                if !matches!(
                    self,
                    Class::Any | Class::Number | Class::Quantity | Class::Linear | Class::Continuous
                ) =>
            {
                return self.contains(element);
            }
            _ => {}
        }
        match self {
            Class::Any => true,
            Class::Number => matches!(ty, Int | Float),
            Class::Quantity => matches!(ty, Int | Float | Angle | Wavelength | Temperature),
            Class::Linear => Class::Quantity.contains(ty) || matches!(ty, Vec2 | Vec3 | Spectrum(_)),
            Class::Continuous => Class::Linear.contains(ty) && *ty != Int,
            Class::Vector => matches!(ty, Vec2 | Vec3 | Direction),
            Class::Placeable => matches!(ty, Solid | Surface | Light | Environment | Shape | Transform),
            Class::Geometry => matches!(ty, Solid | Surface | Shape),
            Class::UnionOperand => matches!(ty, Solid | Light | Environment),
            Class::SolidOperand => matches!(ty, Solid),
            Class::Textured => matches!(ty, Texture(_)),
            Class::TexturedNumber => {
                matches!(ty, Texture(TextureKind::Float | TextureKind::Angle | TextureKind::Vec2 | TextureKind::Vec3))
            }
            Class::TexturedVector => matches!(ty, Texture(TextureKind::Vec2 | TextureKind::Vec3)),
            Class::Attribute => matches!(ty, Bsdf | Emitter | Medium | Attributes),
        }
    }

    /// As in "needs …".
    pub fn description(self) -> &'static str {
        match self {
            Class::Any => "a value",
            Class::Number => "a number",
            Class::Quantity => "a number or quantity",
            Class::Linear | Class::Continuous => "a number, quantity, vector or spectrum",
            Class::Vector => "a vector",
            Class::Placeable => "a shape, light, transform or a list of these",
            Class::Geometry => "a solid, a surface or a list of these",
            Class::UnionOperand => "solids, lights or lists of these",
            Class::SolidOperand => "solids or lists of solids",
            Class::Textured => "a texture of numbers, vectors or spectra",
            Class::TexturedNumber => "a texture of numbers, angles or vectors",
            Class::TexturedVector => "a texture of vectors",
            Class::Attribute => "a bsdf, an emitter, a medium or a list of these",
        }
    }
}

/// Names of types as they are written, except the compound ones.
pub const NAMED: &[(&str, Type)] = &[
    ("bool", Type::Bool),
    ("int", Type::Int),
    ("float", Type::Float),
    ("string", Type::Str),
    ("angle", Type::Angle),
    ("wavelength", Type::Wavelength),
    ("temperature", Type::Temperature),
    ("vec2", Type::Vec2),
    ("vec3", Type::Vec3),
    ("point", Type::Point),
    ("direction", Type::Direction),
    ("transform", Type::Transform),
    ("reflectance", Type::Spectrum(SpectrumKind::Reflectance)),
    ("transmission", Type::Spectrum(SpectrumKind::Transmission)),
    ("emission", Type::Spectrum(SpectrumKind::Emission)),
    ("refractive_index", Type::Spectrum(SpectrumKind::RefractiveIndex)),
    ("extinction", Type::Spectrum(SpectrumKind::Extinction)),
    ("coefficient", Type::Spectrum(SpectrumKind::Coefficient)),
    ("reradiation", Type::Reradiation),
    ("bsdf", Type::Bsdf),
    ("emitter", Type::Emitter),
    ("attributes", Type::Attributes),
    ("medium", Type::Medium),
    ("dye", Type::Dye),
    ("phase_function", Type::PhaseFunction),
    ("density", Type::Density),
    ("texture", Type::Texture(TextureKind::Float)),
    ("solid", Type::Solid),
    ("surface", Type::Surface),
    ("light", Type::Light),
    ("environment", Type::Environment),
    ("shape", Type::Shape),
    ("camera", Type::Camera),
    ("filter", Type::Filter),
    ("across", Type::Across),
    ("fisheye_mapping", Type::FisheyeMapping),
    ("action", Type::Action),
    ("sampler", Type::Sampler),
    ("exposure", Type::Exposure),
    ("observer", Type::Observer),
    ("strategy", Type::Strategy),
    ("distribution", Type::Distribution),
    ("sky_model", Type::SkyModel),
];

impl Type {
    pub fn list(element: Type) -> Type {
        Type::List(Arc::new(element))
    }

    pub fn tuple(elements: impl Into<Arc<[Type]>>) -> Type {
        Type::Tuple(elements.into())
    }

    pub fn function(params: Vec<Type>, result: Type) -> Type {
        Type::Fn(Arc::new(FnType { params, result }))
    }

    /// The type of what has no value.
    pub fn unit() -> Type {
        Type::tuple([])
    }

    pub fn is_unit(&self) -> bool {
        matches!(self, Type::Tuple(elements) if elements.is_empty())
    }

    pub fn is_error(&self) -> bool {
        matches!(self, Type::Error)
    }

    /// Represented by one `f64`.
    pub fn is_float_like(&self) -> bool {
        matches!(self, Type::Float | Type::Angle | Type::Wavelength | Type::Temperature)
    }

    /// Represented by a vector of three.
    pub fn is_vec3_like(&self) -> bool {
        matches!(self, Type::Vec3 | Type::Point | Type::Direction)
    }

    /// Can be part of a scene by itself.
    pub fn is_shape(&self) -> bool {
        matches!(self, Type::Solid | Type::Surface | Type::Light | Type::Environment | Type::Shape)
    }

    /// With the article, as in "found a `solid`".
    pub fn with_article(&self) -> String {
        let text = self.to_string();
        let article = if text.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        format!("{article} `{text}`")
    }

    /// Calls `visit` for each direct part.
    pub fn map(&self, f: &mut dyn FnMut(&Type) -> Type) -> Type {
        match self {
            Type::List(element) => Type::list(f(element)),
            Type::Tuple(elements) => Type::Tuple(elements.iter().map(f).collect()),
            Type::Record(fields) => Type::Record(fields.iter().map(|(name, ty)| (name.clone(), f(ty))).collect()),
            Type::Fn(function) => {
                let params = function.params.iter().map(&mut *f).collect();
                Type::function(params, f(&function.result))
            }
            other => other.clone(),
        }
    }
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |f: &mut fmt::Formatter<'_>, types: &[Type]| {
            for (i, ty) in types.iter().enumerate() {
                write!(f, "{}{ty}", if i == 0 { "" } else { ", " })?;
            }
            Ok(())
        };
        match self {
            Type::Error | Type::Infer(_) => f.write_str("_"),
            Type::List(element) => write!(f, "list<{element}>"),
            Type::Tuple(elements) => {
                f.write_str("(")?;
                list(f, elements)?;
                f.write_str(if elements.len() == 1 { ",)" } else { ")" })
            }
            Type::Record(fields) => {
                f.write_str("{ ")?;
                for (i, (name, ty)) in fields.iter().enumerate() {
                    write!(f, "{}{name}: {ty}", if i == 0 { "" } else { ", " })?;
                }
                f.write_str(" }")
            }
            Type::Fn(function) => {
                f.write_str("fn(")?;
                list(f, &function.params)?;
                write!(f, ") -> {}", function.result)
            }
            Type::Var(i) => write!(f, "{}", ['T', 'U', 'V', 'W'][usize::from(*i) % 4]),
            Type::Texture(kind) => write!(f, "texture<{}>", kind.name()),
            Type::AnyOf(class) => f.write_str(class.description()),
            simple => {
                let name = NAMED.iter().find(|(_, ty)| ty == simple).map_or("?", |(name, _)| name);
                f.write_str(name)
            }
        }
    }
}
