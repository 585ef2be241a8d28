//! Attributes: what a surface does with light, and what fills a solid.

use std::sync::Arc;

use arsc_spectral::{MerlBrdf, Reradiation, Spectrum};

use crate::Varying;

/// Index into [`crate::Ir::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// The function that the normals of microfacets follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Distribution {
    Ggx,
    Beckmann,
    Blinn,
}

impl Distribution {
    pub const ALL: [Distribution; 3] = [Distribution::Ggx, Distribution::Beckmann, Distribution::Blinn];

    pub const fn name(self) -> &'static str {
        match self {
            Distribution::Ggx => "ggx",
            Distribution::Beckmann => "beckmann",
            Distribution::Blinn => "blinn",
        }
    }
}

/// Roughness of a surface of microfacets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets {
    pub distribution: Distribution,
    /// Along and across the direction of growing u. Blinn's exponent is 2 / alpha^2 - 2, by the first.
    pub alpha: [f64; 2],
}

/// Scattering at a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Bsdf {
    Lambert {
        reflectance: Spectrum,
    },
    /// `sigma` is the standard deviation of the facet slope angle, radians.
    OrenNayar {
        reflectance: Spectrum,
        sigma: f64,
    },
    /// Ideal mirror with the given reflectance at every angle.
    Mirror {
        reflectance: Spectrum,
    },
    /// Smooth interface between vacuum outside and this index inside.
    Dielectric {
        ior: Spectrum,
    },
    /// Smooth metal, complex index `eta + i k`.
    Conductor {
        eta: Spectrum,
        k: Spectrum,
    },
    /// No interface: light goes straight on, into whatever fills the solid.
    Inert,
    /// A pane: both interfaces at once, nothing is bent.
    ThinDielectric {
        ior: Spectrum,
    },
    /// cos^exponent about the mirrored direction.
    Phong {
        reflectance: Spectrum,
        exponent: f64,
    },
    RoughConductor {
        eta: Spectrum,
        k: Spectrum,
        facets: Facets,
    },
    /// Between vacuum outside and this index inside.
    RoughDielectric {
        ior: Spectrum,
        facets: Facets,
    },
    /// Lets the field along its axis through. The axis is at `angle` from the direction of growing u, radians.
    Polariser {
        transmittance: Spectrum,
        angle: f64,
    },
    /// Delays the field across its fast axis by `retardance`, radians.
    Retarder {
        retardance: f64,
        angle: f64,
    },
    Depolariser {
        transmittance: Spectrum,
    },
    /// Parts and parameters that vary over the surface.
    Varying(Arc<Varying>),
    /// Measured reflection from a file; the path is relative to the root script's folder. Its content comes along.
    Measured {
        path: Arc<str>,
        brdf: Arc<MerlBrdf>,
    },
    /// A clear coat over an opaque base, with a film between the two that absorbs (per metre) over a thickness (metres). [`Bsdf::is_coat`] and
    /// [`Bsdf::is_base`] say what may be which.
    Layered {
        coat: Arc<Bsdf>,
        base: Arc<Bsdf>,
        absorption: Spectrum,
        thickness: f64,
    },
    /// Diffuse, with light that changes its wavelength; `sigma` as in `OrenNayar`, 0 for Lambert's law.
    Fluorescent {
        reradiation: Reradiation,
        sigma: f64,
    },
}

/// Emission of a surface towards the side of its normal (solids: outwards).
#[derive(Clone, Debug, PartialEq)]
pub struct Emitter {
    /// W m^-2 sr^-1 nm^-1.
    pub radiance: Spectrum,
    /// Surfaces only: both sides emit.
    pub two_sided: bool,
    /// Radiance times the absorptance of the bsdf, which depends on direction (Kirchhoff); otherwise Lambertian.
    pub thermal: bool,
}

/// How the wall that a subtraction leaves is covered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CutRule {
    /// By this bsdf of [`crate::Ir::bsdfs`].
    Bsdf(u32),
    /// By the material of the solid that was cut.
    Inherit,
}

/// A bundle as `with(…)` attaches it; indices into the tables of [`crate::Ir`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Attributes {
    pub bsdf: Option<u32>,
    pub emitter: Option<u32>,
    /// Fills solids.
    pub medium: Option<u32>,
    /// For walls cut into the subtree by a subtraction outside of it.
    pub cut: Option<CutRule>,
    /// The bsdf and emitter are for this face of primitives alone, where they win over those for the whole.
    pub face: Option<u32>,
}

/// What a leaf ends up with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// `None`: the default, Lambert of reflectance 0.5; with a medium, [`Bsdf::Inert`].
    pub bsdf: Option<u32>,
    pub emitter: Option<u32>,
    /// What fills the solid behind this wall.
    pub medium: Option<u32>,
    /// The bsdf whose index of refraction holds behind this wall, where it is not the wall's own: in a cut wall.
    pub inside: Option<u32>,
    /// Faces of the leaf that are covered otherwise, ascending; materials without faces of their own.
    pub faces: Vec<(u32, MaterialId)>,
}

impl Bsdf {
    /// Light passes through a closed wall of it, so that it matters what fills the solid.
    pub fn is_transmissive(&self) -> bool {
        if let Bsdf::Varying(varying) = self {
            return varying.parts.iter().any(|part| part.bsdf.is_transmissive());
        }
        let interface = matches!(self, Bsdf::Dielectric { .. } | Bsdf::RoughDielectric { .. } | Bsdf::Inert);
        let element = matches!(self, Bsdf::Polariser { .. } | Bsdf::Retarder { .. } | Bsdf::Depolariser { .. });
        interface || element || matches!(self, Bsdf::ThinDielectric { .. })
    }

    /// It can lie on top of a base.
    pub fn is_coat(&self) -> bool {
        matches!(self, Bsdf::Dielectric { .. } | Bsdf::RoughDielectric { .. })
    }

    /// It can lie under a coat.
    pub fn is_base(&self) -> bool {
        matches!(
            self,
            Bsdf::Lambert { .. }
                | Bsdf::OrenNayar { .. }
                | Bsdf::Mirror { .. }
                | Bsdf::Phong { .. }
                | Bsdf::Conductor { .. }
                | Bsdf::RoughConductor { .. }
        )
    }

    /// It is an interface between two indices of refraction.
    pub fn has_index(&self) -> bool {
        self.interface().is_some()
    }

    /// The interface between two indices of refraction that it is, or the first among its parts.
    pub fn interface(&self) -> Option<&Bsdf> {
        match self {
            Bsdf::Dielectric { .. } | Bsdf::RoughDielectric { .. } => Some(self),
            Bsdf::Varying(varying) => varying.parts.iter().find_map(|part| part.bsdf.interface()),
            _ => None,
        }
    }
}
