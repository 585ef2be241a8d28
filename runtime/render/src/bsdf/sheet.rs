//! Flat optical elements: light goes straight through, and only its polarisation and power change.
//!
//! The axis lies in the surface; for light that comes aslant it is projected along the light's own direction.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::BsdfSample;
use crate::polarisation::{DiattenuatingRetarder, Mueller, Polarisation, s_axis};

#[derive(Clone, Debug)]
enum Effect {
    /// Only the component along the axis passes.
    Polariser,
    /// The component across the axis is delayed by a phase: its cosine and sine.
    Retarder([f32; 2]),
    Depolariser,
}

#[derive(Clone, Debug)]
pub struct Sheet {
    effect: Effect,
    transmittance: DenseSpectrum,
    /// In the surface, unit.
    axis: DVec3,
}

impl Sheet {
    fn new(effect: Effect, transmittance: &Spectrum, angle: f64) -> Sheet {
        let (sin, cos) = angle.sin_cos();
        let transmittance = DenseSpectrum::new(transmittance).clamped(0.0, 1.0);
        Sheet { effect, transmittance, axis: DVec3::new(cos, sin, 0.0) }
    }

    /// `transmittance` of light along the axis, which stands at `angle` from the direction of growing u.
    pub(super) fn polariser(transmittance: &Spectrum, angle: f64) -> Sheet {
        Sheet::new(Effect::Polariser, transmittance, angle)
    }

    /// Light across the fast axis is delayed by `retardance`, radians of its own wave.
    pub(super) fn retarder(retardance: f64, angle: f64) -> Sheet {
        let phase = [retardance.cos() as f32, retardance.sin() as f32];
        Sheet::new(Effect::Retarder(phase), &Spectrum::Constant(1.0), angle)
    }

    pub(super) fn depolariser(transmittance: &Spectrum) -> Sheet {
        Sheet::new(Effect::Depolariser, transmittance, 0.0)
    }

    /// The direction of x in the surface matters.
    pub(super) fn has_axis(&self) -> bool {
        !matches!(self.effect, Effect::Depolariser)
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(&self, wo: DVec3, wavelengths: &SampledWavelengths) -> Option<BsdfSample<P>> {
        let (zero, factor) = (SampledSpectrum::ZERO, self.transmittance.sample(wavelengths));
        let across = self.axis - wo * self.axis.dot(wo);
        let axis = across.try_normalize().unwrap_or_else(|| s_axis(wo, wo));
        let through = |effect| P::Mueller::diattenuating_retarder(&effect, axis, wo, -wo);
        let weight = match self.effect {
            Effect::Depolariser => P::Mueller::depolariser(factor),
            Effect::Polariser => {
                let half = factor * 0.5;
                through(DiattenuatingRetarder { a: half, b: half, c: zero, s: zero })
            }
            // The delayed component has the phase exp(+i retardance), and c + i s its conjugate.
            Effect::Retarder([cos, sin]) => {
                through(DiattenuatingRetarder { a: factor, b: zero, c: factor * cos, s: factor * -sin })
            }
        };
        (wo.z != 0.0).then(|| BsdfSample::straight(wo, weight))
    }
}
