//! Lamps with a measured distribution: candela by direction from their maker, colour from a spectrum.
//!
//! Spectral intensity is candela times S / (683 lm/W times the integral of S V), with V of the CIE 1931 observer: the
//! luminous flux is the file's whatever the spectrum's scale. Frame: nadir of the file is -z, horizontal angle 0 is +x,
//! 90 degrees +y.

use std::sync::Arc;

use arsc_spectral::{
    DenseSpectrum, PhotometricWeb, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange, xyz_of_radiance,
};
use glam::{DMat3, DVec3};

#[derive(Clone, Debug)]
pub struct PhotometricLight {
    pub position: DVec3,
    /// Orthonormal; may be left-handed.
    local_from_world: DMat3,
    web: Arc<PhotometricWeb>,
    /// W nm^-1 sr^-1 for a candela.
    per_candela: DenseSpectrum,
}

impl PhotometricLight {
    /// `world_from_local` is orthonormal. Dark if the spectrum has no luminance.
    pub(super) fn new(
        position: DVec3,
        world_from_local: DMat3,
        web: Arc<PhotometricWeb>,
        spectrum: &Spectrum,
    ) -> PhotometricLight {
        let luminance = xyz_of_radiance(spectrum)[1];
        let factor = if luminance > 0.0 { 1.0 / luminance } else { 0.0 };
        let per_candela = DenseSpectrum::from_fn(|lambda_nm| spectrum.eval(lambda_nm) * factor).clamped(0.0, f32::MAX);
        PhotometricLight { position, local_from_world: world_from_local.transpose(), web, per_candela }
    }

    /// Irradiance across the beam at a point.
    #[inline]
    pub fn irradiance(&self, p: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let from = p - self.position;
        let distance2 = from.length_squared();
        let w = self.local_from_world * (from / distance2.sqrt());
        if !w.is_finite() {
            return SampledSpectrum::ZERO;
        }
        let candela = self.web.intensity(-w.z, w.y.atan2(w.x));
        self.per_candela.sample(wavelengths) * (candela / distance2) as f32
    }

    pub(super) fn power(&self, range: &WavelengthRange) -> f64 {
        self.web.lumens() * self.per_candela.integral(range)
    }
}
