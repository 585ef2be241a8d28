//! Polarisation as a switch of the compiler: transport is written once, generic over [`Polarisation`].
//!
//! [`Unpolarised`] light is a [`SampledSpectrum`], and so is what scattering does to it. [`Polarised`] light is a
//! [`StokesSpectrum`], scattering a [`MuellerSpectrum`], per wavelength. Models state a depolarising value or a
//! [`DiattenuatingRetarder`] once; which of its numbers are used, and therefore computed, is the mode's affair.
//!
//! Conventions (docs/radiometry.md, "Polarisation"). Light travels along k; its frame is (x, y, k), right-handed,
//! so that somebody who looks towards the source with x to his right has y up. Fields go as exp(-i omega t), absorbing
//! media have the index eta + i k. S0 = |Ex|^2 + |Ey|^2, S1 = |Ex|^2 - |Ey|^2, S2 = 2 Re(Ex Ey*), S3 = 2 Im(Ex Ey*):
//! S1 > 0 is along x, S2 > 0 half-way from x to y, S3 > 0 turns clockwise in the eyes of that observer (right-handed).
//! At interfaces x is s, along (normal x wo), and y is p = k x s, before and after. Matrices of a path multiply from the
//! camera outwards. The angles are Stokes's and Mueller's (Goldstein 2011, chapters 5 and 6), signs those of Born and Wolf.

mod mueller;
mod stokes;

use std::ops::{AddAssign, Mul};

use arsc_spectral::SampledSpectrum;
use glam::DVec3;

use crate::frame::Frame;

pub use mueller::MuellerSpectrum;
pub use stokes::{ReferenceFrame, StokesSpectrum};

/// Whether transport keeps track of polarisation.
pub trait Polarisation: Copy + Send + Sync + 'static {
    type Stokes: Stokes;
    type Mueller: Mueller<Stokes = Self::Stokes>;
}

/// Light: radiance, or irradiance across a beam, at the wavelengths of a path.
pub trait Stokes: Copy + AddAssign + Mul<f32, Output = Self> {
    /// Light without any polarisation; fits every reference frame.
    fn unpolarised(radiance: SampledSpectrum) -> Self;

    /// Linearly polarised light that travels along `k`: `s1` is the radiance along `axis`, a unit vector across `k`, less
    /// that at right angles.
    fn linear(radiance: SampledSpectrum, s1: SampledSpectrum, axis: DVec3, k: DVec3) -> Self;

    /// The first Stokes parameter.
    fn intensity(&self) -> SampledSpectrum;

    /// The other three; `None` where polarisation is not kept.
    fn polarisation(&self) -> Option<[SampledSpectrum; 3]>;

    /// Vectors of the local frame become world vectors.
    fn to_world(self, frame: &Frame) -> Self;
}

/// What scattering, or a whole path, does to light: a Mueller matrix, or in its place the factor on intensity.
pub trait Mueller: Copy + Mul<f32, Output = Self> + Mul<SampledSpectrum, Output = Self> {
    type Stokes: Stokes;

    /// Nothing happens to light that travels along `k` and is described in a frame with this x axis.
    fn identity(x: DVec3, k: DVec3) -> Self;

    /// Whatever comes in, unpolarised light goes out: `factor` times the incoming intensity.
    fn depolariser(factor: SampledSpectrum) -> Self;

    /// Scattering from light along `-wi` to light along `wo` that treats the field along and across `axis` differently;
    /// `axis` is a unit vector across both.
    fn diattenuating_retarder(effect: &DiattenuatingRetarder, axis: DVec3, wo: DVec3, wi: DVec3) -> Self;

    /// A matrix by its elements `[row][column]`, between the reference frames with x along `axis_out` (across `wo`) and
    /// `axis_in` (across `wi`), unit vectors. Only the first element matters without polarisation.
    fn from_elements(
        elements: impl Fn(usize, usize) -> SampledSpectrum,
        axes: [DVec3; 2],
        wo: DVec3,
        wi: DVec3,
    ) -> Self;

    /// Intensity that leaves for unpolarised light of intensity 1. It bounds every element of the matrix: where it
    /// is zero, the whole matrix is.
    fn intensity(&self) -> SampledSpectrum;

    /// First `inner`, farther from the camera, then `self`.
    fn then(&self, inner: &Self) -> Self;

    /// The sum of two matrices for the same directions.
    fn plus(&self, other: &Self) -> Self;

    /// What becomes of light.
    fn apply(&self, light: &Self::Stokes) -> Self::Stokes;

    /// Vectors of the local frame become world vectors.
    fn to_world(self, frame: &Frame) -> Self;
}

/// Smooth reflection, refraction, polarisers and retarders, in terms of an axis x: the matrix
/// [[a, b, 0, 0], [b, a, 0, 0], [0, 0, c, -s], [0, 0, s, c]] with a = (|rx|^2 + |ry|^2) / 2, b = (|rx|^2 - |ry|^2) / 2,
/// c + i s = rx ry* for amplitudes rx along the axis and ry across it (Lu and Chipman 1996, up to the sign of S3).
/// Physical where a >= 0 and a^2 >= b^2 + c^2 + s^2, with equality if the amplitudes are the whole story.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiattenuatingRetarder {
    pub a: SampledSpectrum,
    pub b: SampledSpectrum,
    pub c: SampledSpectrum,
    pub s: SampledSpectrum,
}

impl DiattenuatingRetarder {
    /// The field goes on as it is, by this factor on its intensity.
    #[inline]
    pub fn neutral(factor: SampledSpectrum) -> DiattenuatingRetarder {
        DiattenuatingRetarder { a: factor, b: SampledSpectrum::ZERO, c: factor, s: SampledSpectrum::ZERO }
    }

    /// Reflection by a perfect mirror: both components keep their size, and the frame is turned over.
    #[inline]
    pub fn mirror(factor: SampledSpectrum) -> DiattenuatingRetarder {
        DiattenuatingRetarder { c: factor * -1.0, ..DiattenuatingRetarder::neutral(factor) }
    }
}

impl Mul<SampledSpectrum> for DiattenuatingRetarder {
    type Output = DiattenuatingRetarder;
    #[inline]
    fn mul(self, factor: SampledSpectrum) -> DiattenuatingRetarder {
        let DiattenuatingRetarder { a, b, c, s } = self;
        DiattenuatingRetarder { a: a * factor, b: b * factor, c: c * factor, s: s * factor }
    }
}

/// The axis s of a plane of incidence: unit, across `normal` and `wo`; across `wo` where that is undetermined.
#[inline]
pub fn s_axis(normal: DVec3, wo: DVec3) -> DVec3 {
    let across = normal.cross(wo);
    let length2 = across.length_squared();
    if length2 > 1e-30 { across / length2.sqrt() } else { Frame::new(wo).x }
}

/// Light without polarisation: intensities alone.
#[derive(Clone, Copy, Debug)]
pub struct Unpolarised;

impl Polarisation for Unpolarised {
    type Stokes = SampledSpectrum;
    type Mueller = SampledSpectrum;
}

/// Stokes vectors and Mueller matrices.
#[derive(Clone, Copy, Debug)]
pub struct Polarised;

impl Polarisation for Polarised {
    type Stokes = StokesSpectrum;
    type Mueller = MuellerSpectrum;
}

impl Stokes for SampledSpectrum {
    #[inline]
    fn unpolarised(radiance: SampledSpectrum) -> SampledSpectrum {
        radiance
    }

    #[inline]
    fn linear(radiance: SampledSpectrum, _: SampledSpectrum, _: DVec3, _: DVec3) -> SampledSpectrum {
        radiance
    }

    #[inline]
    fn intensity(&self) -> SampledSpectrum {
        *self
    }

    #[inline]
    fn polarisation(&self) -> Option<[SampledSpectrum; 3]> {
        None
    }

    #[inline]
    fn to_world(self, _: &Frame) -> SampledSpectrum {
        self
    }
}

impl Mueller for SampledSpectrum {
    type Stokes = SampledSpectrum;

    #[inline]
    fn identity(_: DVec3, _: DVec3) -> SampledSpectrum {
        SampledSpectrum::ONE
    }

    #[inline]
    fn depolariser(factor: SampledSpectrum) -> SampledSpectrum {
        factor
    }

    #[inline]
    fn diattenuating_retarder(effect: &DiattenuatingRetarder, _: DVec3, _: DVec3, _: DVec3) -> SampledSpectrum {
        effect.a
    }

    #[inline]
    fn from_elements(
        elements: impl Fn(usize, usize) -> SampledSpectrum,
        _: [DVec3; 2],
        _: DVec3,
        _: DVec3,
    ) -> SampledSpectrum {
        elements(0, 0)
    }

    #[inline]
    fn intensity(&self) -> SampledSpectrum {
        *self
    }

    #[inline]
    fn then(&self, inner: &SampledSpectrum) -> SampledSpectrum {
        *self * *inner
    }

    #[inline]
    fn plus(&self, other: &SampledSpectrum) -> SampledSpectrum {
        *self + *other
    }

    #[inline]
    fn apply(&self, light: &SampledSpectrum) -> SampledSpectrum {
        *self * *light
    }

    #[inline]
    fn to_world(self, _: &Frame) -> SampledSpectrum {
        self
    }
}
