//! Participating media: what fills solids and the space around them.

use arsc_geometry::DVec3;
use arsc_spectral::{Dye, Spectrum};

/// A medium at density 1, and how dense it is where.
///
/// Per metre: absorption and scattering coefficients. `emission` is the radiance, W m^-2 sr^-1 nm^-1, that an absorbing
/// layer of great depth glows with: the medium adds absorption times emission per metre.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    pub absorption: Spectrum,
    pub scattering: Spectrum,
    pub emission: Spectrum,
    /// Their absorption, per metre, comes on top; what they emit goes into all directions alike.
    pub dyes: Vec<Dye>,
    pub phase: PhaseFunction,
    pub density: Density,
}

/// Into which directions a medium scatters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PhaseFunction {
    Isotropic,
    /// Mean cosine `g`, in (-1, 1); positive scatters forwards.
    HenyeyGreenstein {
        g: f64,
    },
    /// By particles much smaller than the wavelength; `depolarisation` is the ratio of the two linear polarisations of
    /// light scattered at a right angle from natural light, in [0, 1/2].
    Rayleigh {
        depolarisation: f64,
    },
}

/// A factor on the coefficients, at least 0; positions are those of the scene, whatever the medium is attached to.
#[derive(Clone, Debug, PartialEq)]
pub enum Density {
    Uniform,
    /// `exp(-|p - center|^2 / (2 sigma^2))`.
    Gaussian {
        center: DVec3,
        sigma: f64,
    },
    /// 1 up to the level `ground`, above it `exp(-(z - ground) / height)`.
    Exponential {
        ground: f64,
        height: f64,
    },
}
