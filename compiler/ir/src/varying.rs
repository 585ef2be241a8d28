//! Scattering that varies over a surface.
//!
//! At every point the surface is one of its parts, chosen at random in proportion to their weights there; so any bsdfs
//! mix, and the mean is that of their sum. A part's parameters are given by expressions in place of its bsdf's numbers.
//! Expressions read places in the space in which the material was attached: `texture_from_object` leads there from the
//! object space of the leaf, and the pass that moves attributes to the leaves completes it.

use std::sync::Arc;

use arsc_geometry::DAffine3;
use arsc_spectral::Spectrum;
use arsc_texture::{Expression, ImageMap, Needs};

use crate::Bsdf;

/// See the module's documentation.
#[derive(Clone, Debug, PartialEq)]
pub struct Varying {
    /// At least one.
    pub parts: Vec<Part>,
    pub texture_from_object: DAffine3,
}

/// A bsdf with what varies in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Relative to the sum over the parts; negative values count as 0. Where all are 0 the first part has everything.
    pub weight: Expression,
    /// Not itself varying; its own values of the parameters below do not count.
    pub bsdf: Bsdf,
    pub parameters: Vec<Parameter>,
}

/// A parameter of a bsdf and its values, limited to what the bsdf allows.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameter {
    /// Of Lambert, Oren–Nayar, Phong and mirror.
    Reflectance(SpectrumTexture),
    /// Of Oren–Nayar, radians.
    Sigma(Expression),
    /// Of Phong.
    Exponent(Expression),
    /// Alpha of microfacets, along and across the direction of growing u.
    Roughness([Expression; 2]),
    /// Of any bsdf: how far the surface seems to stand out along its normal, in the space in which the material was
    /// attached. Only the shading normal changes.
    Height(Expression),
    /// Of any bsdf: the shading normal, of any length, by the direction of growing u, that across it, and the normal.
    Normal([Expression; 3]),
}

/// A spectrum that varies over a surface: the sum of weighted spectra.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumTexture {
    pub terms: Vec<SpectrumTerm>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumTerm {
    pub weight: Expression,
    pub spectrum: Spectrum,
    /// The term is multiplied by a colour that varies.
    pub color: Option<ColorTexture>,
}

/// A reflectance of a colour that varies.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorTexture {
    /// Linear sRGB.
    Rgb([Expression; 3]),
    /// A picture at surface coordinates.
    Image { image: Arc<ImageMap>, uv: [Expression; 2] },
}

impl ColorTexture {
    pub fn expressions(&self) -> &[Expression] {
        match self {
            ColorTexture::Rgb(rgb) => rgb,
            ColorTexture::Image { uv, .. } => uv,
        }
    }
}

impl Varying {
    /// All expressions.
    pub fn expressions(&self) -> impl Iterator<Item = &Expression> {
        self.parts.iter().flat_map(|part| {
            let of_parameters = part.parameters.iter().flat_map(Parameter::expressions);
            std::iter::once(&part.weight).chain(of_parameters)
        })
    }

    /// The space in which the material was attached matters.
    pub fn is_local(&self) -> bool {
        let is_height = |parameter: &Parameter| matches!(parameter, Parameter::Height(_));
        let has_height = self.parts.iter().any(|part| part.parameters.iter().any(is_height));
        has_height || self.expressions().any(|expression| expression.needs().local)
    }

    /// What the expressions read.
    pub fn needs(&self) -> Needs {
        self.expressions().map(Expression::needs).fold(Needs::default(), |a, b| Needs {
            local: a.local || b.local,
            uv: a.uv || b.uv,
            color: a.color || b.color,
        })
    }
}

impl Parameter {
    pub fn expressions<'a>(&'a self) -> Vec<&'a Expression> {
        match self {
            Parameter::Reflectance(texture) => {
                let of_color = |term: &'a SpectrumTerm| term.color.iter().flat_map(ColorTexture::expressions);
                texture.terms.iter().flat_map(|term| std::iter::once(&term.weight).chain(of_color(term))).collect()
            }
            Parameter::Sigma(expression) | Parameter::Exponent(expression) | Parameter::Height(expression) => {
                vec![expression]
            }
            Parameter::Roughness(alpha) => alpha.iter().collect(),
            Parameter::Normal(normal) => normal.iter().collect(),
        }
    }
}
