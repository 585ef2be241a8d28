//! Diffuse reflection that changes the wavelength of light: Lambert's or Oren and Nayar's distribution of directions,
//! for the light that keeps its wavelength and for what is emitted in place of absorbed light. Both are depolarised.
//!
//! What this file evaluates and samples as a bsdf is the former alone. An integrator first decides which of the two a
//! path meets ([`Fluorescent::choose`]); then it goes on with the bsdf and the wavelengths of that one.

use arsc_spectral::{
    DenseSpectrum, Reradiation, ReradiationTable, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange,
};

use super::Bsdf;

#[derive(Clone, Debug)]
pub struct Fluorescent {
    reradiation: ReradiationTable,
    reflectance: DenseSpectrum,
    /// For light that keeps its wavelength.
    elastic: Bsdf,
    /// The directions of re-radiated light: reflectance 1.
    white: Bsdf,
}

/// Which of the two kinds of light a path from the camera follows.
pub struct FluorescentEvent<'a> {
    pub bsdf: &'a Bsdf,
    /// Those of the light that arrives, if they have changed.
    pub shifted: Option<SampledWavelengths>,
    /// Factor on the throughput, at the hero's probability of the choice.
    pub weight: SampledSpectrum,
    /// Probability of the choice at each wavelength over that at the hero.
    pub path_pdf: SampledSpectrum,
}

impl Fluorescent {
    /// `sigma` is the standard deviation of the facet slope angle in radians; 0 is Lambert's law.
    pub(super) fn new(reradiation: &Reradiation, sigma: f64) -> Fluorescent {
        let diffuse = |reflectance: &Spectrum| match sigma {
            0.0 => Bsdf::lambert(reflectance),
            _ => Bsdf::oren_nayar(reflectance, sigma),
        };
        Fluorescent {
            reradiation: ReradiationTable::new(std::slice::from_ref(&reradiation.fluorescence)),
            reflectance: DenseSpectrum::new(&reradiation.reflectance).clamped(0.0, 1.0),
            elastic: diffuse(&reradiation.reflectance),
            white: diffuse(&Spectrum::Constant(1.0)),
        }
    }

    /// The part that keeps wavelengths.
    #[inline]
    pub(super) fn elastic(&self) -> &Bsdf {
        &self.elastic
    }

    /// Chooses between reflection and re-radiation in proportion to what comes of white light at the hero's wavelength;
    /// `u_choice` and `u_shift` in [0, 1).
    pub fn choose(
        &self,
        wavelengths: &SampledWavelengths,
        range: &WavelengthRange,
        u_choice: f64,
        u_shift: f64,
    ) -> FluorescentEvent<'_> {
        let strength = self.reradiation.strength(wavelengths, range);
        let reflectance = self.reflectance.sample(wavelengths);
        let total = (strength + reflectance).map(|total| if total > 0.0 { total } else { 1.0 });
        let probability = strength / total;
        let chosen = |probability: SampledSpectrum| probability * (1.0 / probability.hero());
        if u_choice < f64::from(probability.hero()) {
            FluorescentEvent {
                bsdf: &self.white,
                shifted: Some(self.reradiation.shift(wavelengths, range, u_shift)),
                weight: strength * (1.0 / probability.hero()),
                path_pdf: chosen(probability),
            }
        } else {
            let rest = SampledSpectrum::ONE - probability;
            let weight = SampledSpectrum::splat(1.0 / rest.hero());
            FluorescentEvent { bsdf: &self.elastic, shifted: None, weight, path_pdf: chosen(rest) }
        }
    }
}
