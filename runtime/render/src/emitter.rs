//! Emission of surfaces.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};
use glam::DVec3;

use crate::polarisation::{Polarisation, Stokes};

/// Lambertian emission: the same radiance in all directions of the side of the geometric normal, or of both.
#[derive(Clone, Debug)]
pub struct AreaEmitter {
    radiance: DenseSpectrum,
    two_sided: bool,
}

impl AreaEmitter {
    /// `radiance` in W m^-2 sr^-1 nm^-1, negative values count as zero. `two_sided` is for open surfaces: a solid
    /// emits outwards.
    pub fn new(radiance: &Spectrum, two_sided: bool) -> AreaEmitter {
        AreaEmitter { radiance: DenseSpectrum::new(radiance).clamped(0.0, f32::MAX), two_sided }
    }

    /// Radiance towards the direction `wo` from a surface with the geometric normal `ng`.
    #[inline]
    pub fn radiance<P: Polarisation>(&self, wo: DVec3, ng: DVec3, wavelengths: &SampledWavelengths) -> P::Stokes {
        let cos = wo.dot(ng);
        P::Stokes::unpolarised(if cos > 0.0 || (self.two_sided && cos < 0.0) {
            self.radiance.sample(wavelengths)
        } else {
            SampledSpectrum::ZERO
        })
    }

    pub fn two_sided(&self) -> bool {
        self.two_sided
    }

    /// Power per area over a range of wavelengths, W m^-2.
    pub fn exitance(&self, range: &WavelengthRange) -> f64 {
        let sides = if self.two_sided { 2.0 } else { 1.0 };
        std::f64::consts::PI * sides * self.radiance.integral(range)
    }
}
