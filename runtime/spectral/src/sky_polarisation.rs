//! The polarisation of a clear sky, by light that is scattered once.
//!
//! Molecules polarise as Rayleigh's dipoles do, with the depolarisation of air; haze scatters forwards and does not polarise
//! (Henyey and Greenstein's function). How much there is of it follows from the turbidity, which is the optical depth of air with haze over that of
//! air alone at 550 nm, and from the powers of wavelength that both go with. Wilkie, Ulbricht, Tobler, Zotti and Purgathofer 2004, "An analytical model for skylight
//! polarisation", have the pattern from the same idea; here its height follows from the haze instead of a fit. Light that is scattered
//! more often is left out: near the sun and opposite to it the true sky has neutral points, where this one has its zeros at the sun and the antisolar point.

use crate::{DenseSpectrum, SampledSpectrum, SampledWavelengths};

/// Depolarisation of air at 550 nm (Bates 1984).
const DEPOLARISATION: f64 = 0.0279;

/// Mean cosine of scattering by haze.
const HAZE_G: f64 = 0.75;

/// Optical depths go with wavelength to the powers of -4.08 and -1.3.
const POWER: f64 = 4.08 - 1.3;

/// Degrees of polarisation for a turbidity.
#[derive(Clone, Debug)]
pub struct SkyPolarisation {
    /// Scattering by haze over that by air.
    haze: DenseSpectrum,
}

impl SkyPolarisation {
    pub fn new(turbidity: f64) -> SkyPolarisation {
        let haze = (turbidity - 1.0).max(0.0);
        SkyPolarisation { haze: DenseSpectrum::from_fn(|lambda_nm| haze * (lambda_nm / 550.0).powf(POWER)) }
    }

    /// Share of skylight that is linearly polarised, across the plane of the sun and the line of sight. `cos_gamma` is the cosine
    /// of the angle between these.
    #[inline]
    pub fn degree(&self, cos_gamma: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let delta = (1.0 - DEPOLARISATION) / (1.0 + 0.5 * DEPOLARISATION);
        let cos2 = (cos_gamma * cos_gamma).min(1.0);
        let air = delta * 0.75 * (1.0 + cos2) + (1.0 - delta);
        let spread = 1.0 + HAZE_G * HAZE_G - 2.0 * HAZE_G * cos_gamma;
        let haze = ((1.0 - HAZE_G * HAZE_G) / (spread * spread.sqrt())) as f32;
        let polarised = (0.75 * delta * (1.0 - cos2)) as f32;
        self.haze.sample(wavelengths).map(|share| polarised / (air as f32 + share * haze))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degree(turbidity: f64, cos_gamma: f64) -> f32 {
        SkyPolarisation::new(turbidity).degree(cos_gamma, &SampledWavelengths::fixed([550.0; 4])).hero()
    }

    /// Air alone at a right angle: (1 - rho) / (1 + rho). Haze lowers it, and towards the sun there is none.
    #[test]
    fn degrees_are_those_of_single_scattering() {
        let rho = DEPOLARISATION as f32;
        assert!((degree(1.0, 0.0) - (1.0 - rho) / (1.0 + rho)).abs() < 1e-6);
        assert!(degree(3.0, 0.0) < 0.8 && degree(3.0, 0.0) > 0.4);
        assert_eq!([degree(2.0, 1.0), degree(2.0, -1.0)], [0.0, 0.0]);
        assert!(degree(2.0, 0.5) < degree(2.0, -0.5), "haze scatters forwards");
    }
}
