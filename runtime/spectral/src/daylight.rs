//! Daylight of any correlated colour temperature (CIE 15:2018, section 4.1.2).
//!
//! S0 + M1 S1 + M2 S2, with the weights of the locus of daylight, from 300 to 830 nm (`stdlib/data/daylight.csv`).
//! The CIE's D65 has the temperature 6504 K, as all its D illuminants are a factor 1.4388 / 1.4380 above their name.

use std::sync::{Arc, LazyLock};

use crate::observer::numeric_rows;
use crate::{Spectrum, xyz_of_radiance};

/// The range of the formula, kelvin.
pub const DAYLIGHT_KELVIN: [f64; 2] = [4000.0, 25000.0];

static COMPONENTS: LazyLock<Vec<[f64; 4]>> =
    LazyLock::new(|| numeric_rows(include_str!("../../../stdlib/data/daylight.csv")));

/// Chromaticity x, y of daylight; the temperature is limited to [`DAYLIGHT_KELVIN`].
pub fn daylight_chromaticity(kelvin: f64) -> [f64; 2] {
    let t = kelvin.clamp(DAYLIGHT_KELVIN[0], DAYLIGHT_KELVIN[1]);
    let [a, b, c, d] =
        if t <= 7000.0 { [-4.6070, 2.9678, 0.09911, 0.244063] } else { [-2.0064, 1.9018, 0.24748, 0.23704] };
    let x = a * 1e9 / (t * t * t) + b * 1e6 / (t * t) + c * 1e3 / t + d;
    [x, (-3.0 * x + 2.870) * x - 0.275]
}

/// The components S0, S1, S2.
pub(crate) fn components() -> [Spectrum; 3] {
    let lambda_nm: Arc<[f64]> = COMPONENTS.iter().map(|row| row[0]).collect();
    std::array::from_fn(|i| Spectrum::Tabulated {
        lambda_nm: lambda_nm.clone(),
        values: COMPONENTS.iter().map(|row| row[i + 1]).collect(),
    })
}

/// Relative spectrum, scaled to the luminance of the constant spectrum 1. It ends within 5 nm of 300 and 830 nm.
pub fn daylight(kelvin: f64) -> Spectrum {
    let [x, y] = daylight_chromaticity(kelvin);
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    let relative = |row: &[f64; 4]| (row[1] + m1 * row[2] + m2 * row[3]).max(0.0);
    let lambda_nm: Arc<[f64]> = COMPONENTS.iter().map(|row| row[0]).collect();
    let values: Arc<[f64]> = COMPONENTS.iter().map(relative).collect();
    normalised(Spectrum::Tabulated { lambda_nm, values })
}

/// A spectrum scaled to the luminance of the constant spectrum 1; one without luminance stays.
pub fn normalised(spectrum: Spectrum) -> Spectrum {
    let (own, unit) = (xyz_of_radiance(&spectrum)[1], xyz_of_radiance(&Spectrum::Constant(1.0))[1]);
    let factor = unit / own;
    match spectrum {
        _ if !(factor > 0.0 && factor.is_finite()) => spectrum,
        Spectrum::Tabulated { lambda_nm, values } => {
            Spectrum::Tabulated { lambda_nm, values: values.iter().map(|value| value * factor).collect() }
        }
        other => Spectrum::Scaled { factor, spectrum: Arc::new(other) },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{chromaticity, d65};

    /// The spectrum has the chromaticity that it is made for, over the whole locus.
    #[test]
    fn spectra_lie_on_the_locus_of_daylight() {
        for kelvin in [4000.0, 5003.0, 6504.0, 7000.0, 7504.0, 12000.0, 25000.0] {
            let (want, got) = (daylight_chromaticity(kelvin), chromaticity(xyz_of_radiance(&daylight(kelvin))));
            let off = (want[0] - got[0]).abs().max((want[1] - got[1]).abs());
            assert!(off < 3e-4, "{kelvin} K: {got:?} instead of {want:?}");
        }
        assert!(daylight_chromaticity(7000.0)[0] - daylight_chromaticity(7000.1)[0] < 1e-4);
    }

    /// Against the CIE's own table of D65, which rounds the weights to three decimals.
    #[test]
    fn d65_is_daylight_of_6504_kelvin() {
        let computed = daylight(6504.0);
        for lambda in (300..=830).step_by(5).map(f64::from) {
            let (a, b) = (computed.eval(lambda), d65().eval(lambda));
            assert!((a - b).abs() < 1e-3, "{lambda} nm: {a} and {b}");
        }
        assert!((xyz_of_radiance(&computed)[1] / xyz_of_radiance(&Spectrum::Constant(1.0))[1] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_has_no_luminance_stays() {
        assert_eq!(normalised(Spectrum::Constant(0.0)), Spectrum::Constant(0.0));
        let incandescent = normalised(Spectrum::Blackbody { kelvin: 2856.0 });
        assert!((xyz_of_radiance(&incandescent)[1] / 683.0 / crate::Y_INTEGRAL_NM - 1.0).abs() < 1e-5);
    }
}
