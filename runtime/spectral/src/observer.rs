//! The CIE 1931 2 degree standard observer.
//!
//! Colour matching functions from 360 to 830 nm in steps of 1 nm. Tristimulus values of a radiance are integrals
//! with k = 683 lm/W, so Y is luminance in cd m^-2; sums at 1 nm replace integrals (CIE 15:2018, section 7.1).
//! The table is `stdlib/data/cie1931.csv`.

use std::sync::LazyLock;

use crate::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, Spectrum};

/// Maximum luminous efficacy, lm/W.
pub const LUMINOUS_EFFICACY: f64 = 683.0;

/// Integral of the matching function y over the rendered range, nm.
pub const Y_INTEGRAL_NM: f64 = 106.856_9;

/// Number of 1 nm knots from 360 to 830 nm, both included.
pub(crate) const KNOTS: usize = (LAMBDA_MAX_NM - LAMBDA_MIN_NM) as usize + 1;

static MATCHING_FUNCTIONS: LazyLock<Vec<[f64; 3]>> = LazyLock::new(|| {
    let rows = numeric_rows::<4>(include_str!("../../../stdlib/data/cie1931.csv"));
    assert_eq!(rows.len(), KNOTS, "the embedded table of matching functions is incomplete");
    rows.into_iter().map(|[_, x, y, z]| [x, y, z]).collect()
});

/// x, y, z at 360, 361, … 830 nm.
pub fn matching_functions() -> &'static [[f64; 3]] {
    &MATCHING_FUNCTIONS
}

/// x, y, z at a wavelength, linear between the knots; zero outside of 360–830 nm.
pub fn matching_at(lambda_nm: f64) -> [f64; 3] {
    let table = matching_functions();
    let at = lambda_nm - LAMBDA_MIN_NM;
    if !(at >= 0.0 && at <= (KNOTS - 1) as f64) {
        return [0.0; 3];
    }
    let i = (at as usize).min(KNOTS - 2);
    let t = at - i as f64;
    std::array::from_fn(|c| table[i][c] + t * (table[i + 1][c] - table[i][c]))
}

/// Tristimulus values of a spectral radiance in W m^-2 sr^-1 nm^-1.
pub fn xyz_of_radiance(radiance: &Spectrum) -> [f64; 3] {
    integrate(|lambda| radiance.eval(lambda)).map(|c| c * LUMINOUS_EFFICACY)
}

/// Tristimulus values of a reflectance under an illuminant of any scale; Y of the perfect diffuser is 1.
pub fn xyz_of_reflectance(reflectance: &Spectrum, illuminant: &Spectrum) -> [f64; 3] {
    let white = integrate(|lambda| illuminant.eval(lambda))[1];
    integrate(|lambda| reflectance.eval(lambda) * illuminant.eval(lambda)).map(|c| c / white)
}

/// Chromaticity x, y; the white point of the equal-energy spectrum when there is no light.
pub fn chromaticity(xyz: [f64; 3]) -> [f64; 2] {
    let sum: f64 = xyz.iter().sum();
    if sum > 0.0 { [xyz[0] / sum, xyz[1] / sum] } else { [1.0 / 3.0; 2] }
}

fn integrate(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (i, row) in matching_functions().iter().enumerate() {
        let value = spectrum(LAMBDA_MIN_NM + i as f64);
        for (total, matching) in sum.iter_mut().zip(row) {
            *total += value * matching;
        }
    }
    sum
}

/// The CIE illuminant D65, scaled to the luminance of the constant spectrum 1 (`stdlib/data/d65.csv`).
pub fn d65() -> &'static Spectrum {
    static D65: LazyLock<Spectrum> = LazyLock::new(|| {
        let rows = numeric_rows::<2>(include_str!("../../../stdlib/data/d65.csv"));
        Spectrum::Tabulated {
            lambda_nm: rows.iter().map(|row| row[0]).collect(),
            values: rows.iter().map(|row| row[1]).collect(),
        }
    });
    &D65
}

/// Rows of exactly `N` numbers; comments and the header line have none and fall out.
fn numeric_rows<const N: usize>(text: &str) -> Vec<[f64; N]> {
    let row = |line: &str| {
        let numbers: Option<Vec<f64>> = line.split(',').map(|cell| cell.trim().parse().ok()).collect();
        numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok())
    };
    text.lines().filter_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_integrates_to_the_published_sum() {
        let sum: f64 = matching_functions().iter().map(|row| row[1]).sum();
        assert!((sum - Y_INTEGRAL_NM).abs() < 2e-4, "{sum}");
    }

    /// CIE 15: D65 has x = 0.31272, y = 0.32903 for the 2 degree observer.
    #[test]
    fn d65_has_its_white_point() {
        let [x, y] = chromaticity(xyz_of_radiance(d65()));
        assert!((x - 0.31272).abs() < 3e-5 && (y - 0.32903).abs() < 3e-5, "x = {x}, y = {y}");
    }

    #[test]
    fn one_watt_at_555_nm_gives_about_683_lumens() {
        let [_, y, _] = matching_at(555.0);
        assert_eq!(y, 1.0);
        let narrow =
            Spectrum::Gaussian { center_nm: 555.0, sigma_nm: 1.0, peak: 1.0 / (2.0 * std::f64::consts::PI).sqrt() };
        assert!((xyz_of_radiance(&narrow)[1] / 683.0 - 1.0).abs() < 2e-3);
    }

    #[test]
    fn matching_is_linear_between_knots_and_zero_outside() {
        let table = matching_functions();
        assert_eq!(matching_at(830.0), table[470]);
        assert!((matching_at(500.25)[1] - (0.75 * table[140][1] + 0.25 * table[141][1])).abs() < 1e-15);
        assert_eq!(matching_at(359.9), [0.0; 3]);
        assert_eq!(matching_at(830.1), [0.0; 3]);
        assert_eq!(matching_at(f64::NAN), [0.0; 3]);
    }
}
