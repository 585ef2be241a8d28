//! Another star in the place of the sun, after the idea of Hosek and Wilkie 2013.
//!
//! Scattering in the air is linear at each wavelength: the light of a sky scales with that of its sun. Sun and star
//! count as black bodies, the sun of [`SUN_KELVIN`]; the ratio of their light outside of the air multiplies a sky that was made for the sun. What the
//! star shines with in all, over every wavelength, is stated relative to the sun; a cool star must look large for it.

use crate::sky::{SOLAR_RADIUS, SUN_KELVIN};
use crate::{DenseSpectrum, planck};

/// A sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Star {
    /// Temperature of its surface, kelvin.
    pub kelvin: f64,
    /// Irradiance outside of the air over all wavelengths, relative to the sun's.
    pub intensity: f64,
}

impl Star {
    pub const SUN: Star = Star { kelvin: SUN_KELVIN, intensity: 1.0 };

    /// Radians.
    pub fn angular_radius(&self) -> f64 {
        (SOLAR_RADIUS * self.intensity.max(0.0).sqrt() * (SUN_KELVIN / self.kelvin).powi(2)).min(1.5)
    }

    /// Radiance of the disc relative to the sun's.
    pub fn radiance_ratio(&self) -> DenseSpectrum {
        DenseSpectrum::from_fn(|lambda_nm| planck(lambda_nm, self.kelvin) / planck(lambda_nm, SUN_KELVIN))
    }

    /// Irradiance relative to the sun's, and so the radiance of the sky.
    pub fn irradiance_ratio(&self) -> DenseSpectrum {
        let size = self.intensity * (SUN_KELVIN / self.kelvin).powi(4);
        DenseSpectrum::from_fn(|lambda_nm| size * planck(lambda_nm, self.kelvin) / planck(lambda_nm, SUN_KELVIN))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_is_itself() {
        assert_eq!(Star::SUN.irradiance_ratio(), DenseSpectrum::Constant(1.0));
        assert_eq!(Star::SUN.angular_radius(), SOLAR_RADIUS);
    }

    /// Radiance times solid angle is irradiance, and a hotter star of equal power is smaller and bluer.
    #[test]
    fn discs_and_irradiances_agree() {
        let star = Star { kelvin: 9600.0, intensity: 2.0 };
        let size = (star.angular_radius() / SOLAR_RADIUS).powi(2);
        for lambda in [350.0, 550.0, 900.0] {
            let disc = size * f64::from(star.radiance_ratio().at(lambda));
            let whole = f64::from(star.irradiance_ratio().at(lambda));
            assert!((disc / whole - 1.0).abs() < 1e-6, "{disc} and {whole}");
        }
        assert!(star.angular_radius() < 0.6 * SOLAR_RADIUS);
        assert!(star.irradiance_ratio().at(400.0) > 1.5 * star.irradiance_ratio().at(700.0));
    }
}
