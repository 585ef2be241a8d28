//! Spectra for colours without bound: emission, and reflection in highlights.
//!
//! A colour is white, plus one of cyan, magenta, yellow, plus one of red, green, blue, none of them negative (the decomposition
//! of Smits 1999, "An RGB-to-spectrum conversion for reflectances"). The seven spectra are the smooth ones that
//! [`crate::uplift_rgb`] finds. The result is linear along every ray of brightness, continuous, never negative, flat for greys, and has
//! the colour that it is made for, within 1/2000 of its largest component. Negative components count as zero.

use std::sync::LazyLock;

use crate::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum, d65, normalised, uplift_rgb};

/// The spectra of the seven colours, times that of the light in which they are seen.
#[derive(Clone, Debug)]
pub struct ColourBasis {
    white: DenseSpectrum,
    /// White less red, less green, less blue.
    secondaries: [DenseSpectrum; 3],
    primaries: [DenseSpectrum; 3],
}

static REFLECTANCE: LazyLock<ColourBasis> = LazyLock::new(|| ColourBasis::new(&Spectrum::Constant(1.0)));

static EMISSION: LazyLock<ColourBasis> = LazyLock::new(|| ColourBasis::new(&normalised(d65().clone())));

impl ColourBasis {
    fn new(light: &Spectrum) -> ColourBasis {
        let of = |rgb: [f64; 3]| {
            let colour = Spectrum::Sigmoid { coefficients: uplift_rgb(rgb) };
            DenseSpectrum::from_fn(|lambda_nm| colour.eval(lambda_nm) * light.eval(lambda_nm))
        };
        let one = |i: usize, inside: f64| of(std::array::from_fn(|c| if c == i { inside } else { 1.0 - inside }));
        ColourBasis {
            white: DenseSpectrum::new(light),
            secondaries: std::array::from_fn(|i| one(i, 0.0)),
            primaries: std::array::from_fn(|i| one(i, 1.0)),
        }
    }

    /// For what reflects: linear sRGB under D65.
    pub fn reflectance() -> &'static ColourBasis {
        &REFLECTANCE
    }

    /// For what emits: white is D65, and (1, 1, 1) has the luminance of the constant radiance 1 W m^-2 sr^-1 nm^-1.
    pub fn emission() -> &'static ColourBasis {
        &EMISSION
    }

    #[inline]
    pub fn sample(&self, rgb: [f32; 3], wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let [r, g, b] = rgb.map(|c| c.max(0.0));
        // Largest and smallest component; what is between them lies in the secondary colour without the smallest.
        let (low, high) = match (r <= g, g <= b, r <= b) {
            (true, true, _) => (0, 2),
            (true, false, true) => (0, 1),
            (true, false, false) => (2, 1),
            (false, true, true) => (1, 2),
            (false, true, false) => (1, 0),
            (false, false, _) => (2, 0),
        };
        let c = [r, g, b];
        let middle = c[3 - low - high];
        let mut sum = self.white.sample(wavelengths) * c[low];
        if c[high] > c[low] {
            sum += self.secondaries[low].sample(wavelengths) * (middle - c[low]);
            sum += self.primaries[high].sample(wavelengths) * (c[high] - middle);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::srgb;
    use glam::DVec3;

    /// Colour of the emission, by the observer every nanometre.
    fn seen(rgb: [f32; 3]) -> [f64; 3] {
        let basis = ColourBasis::emission();
        let at = |lambda: f64| f64::from(basis.sample(rgb, &SampledWavelengths::fixed([lambda; 4])).hero());
        let lambda_nm: Vec<f64> = (360..=830).map(f64::from).collect();
        let values: Vec<f64> = lambda_nm.iter().map(|l| at(*l)).collect();
        let spectrum = Spectrum::Tabulated { lambda_nm: lambda_nm.into(), values: values.into() };
        let xyz = DVec3::from_array(crate::xyz_of_radiance(&spectrum));
        let unit = crate::xyz_of_radiance(&Spectrum::Constant(1.0))[1];
        (srgb::rgb_from_xyz() * xyz / unit).to_array()
    }

    #[test]
    fn colours_come_back_at_any_brightness() {
        for rgb in
            [[1.0, 1.0, 1.0], [0.2, 0.5, 0.9], [30.0, 2.0, 7.0], [0.0, 1.0, 0.4], [900.0, 900.0, 1.0], [5.0, 6.0, 0.0]]
        {
            let (back, most) = (seen(rgb), f64::from(rgb[0].max(rgb[1]).max(rgb[2])));
            for c in 0..3 {
                assert!((back[c] - f64::from(rgb[c])).abs() < 2e-3 * most, "{rgb:?} comes back as {back:?}");
            }
        }
    }

    #[test]
    fn greys_are_flat_and_negative_components_dark() {
        let w = SampledWavelengths::fixed([400.0, 500.0, 600.0, 700.0]);
        let grey = ColourBasis::reflectance().sample([0.7; 3], &w);
        assert_eq!(grey, SampledSpectrum::splat(0.7));
        assert_eq!(ColourBasis::reflectance().sample([-1.0; 3], &w), SampledSpectrum::ZERO);
        let (mixed, cut) = ([0.3, -0.5, 0.9], [0.3, 0.0, 0.9]);
        assert_eq!(ColourBasis::emission().sample(mixed, &w), ColourBasis::emission().sample(cut, &w));
    }
}
