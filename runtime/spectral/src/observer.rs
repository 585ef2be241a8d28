//! Standard observers.
//!
//! Colour matching functions in steps of 1 nm from 360 to 830 nm (those of 2015 from 390 nm); zero elsewhere. Tristimulus
//! values of a radiance are integrals with k = 683 lm/W, so Y is luminance in cd m^-2; sums at 1 nm replace integrals
//! (CIE 15:2018, section 7.1). The functions of 2015 are the cone-fundamental-based ones of CIE 170-2.
//! The tables are `stdlib/data/cie*.csv`.

use std::sync::LazyLock;

use crate::range::{KNOTS, knot_nm, nearest_knot};
use crate::{Spectrum, TABLE_MIN_NM};

/// Maximum luminous efficacy, lm/W.
pub const LUMINOUS_EFFICACY: f64 = 683.0;

/// Integral of the matching function y of the CIE 1931 observer, nm.
pub const Y_INTEGRAL_NM: f64 = 106.856_9;

/// Whose eye gives X, Y and Z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Observer {
    /// CIE 1931, 2 degrees: what colours on screens and in print refer to.
    #[default]
    Cie1931,
    /// CIE 1964, 10 degrees.
    Cie1964,
    /// CIE 2015 (from the cone fundamentals of 2006), 2 degrees.
    Cie2015Deg2,
    /// CIE 2015 (from the cone fundamentals of 2006), 10 degrees.
    Cie2015Deg10,
}

type Table = Box<[[f64; 3]; KNOTS]>;

fn table(text: &str) -> Table {
    let mut table = Box::new([[0.0; 3]; KNOTS]);
    for [lambda_nm, x, y, z] in numeric_rows::<4>(text) {
        table[nearest_knot(lambda_nm as f32) as usize] = [x, y, z];
    }
    table
}

static CIE_1931: LazyLock<Table> = LazyLock::new(|| table(include_str!("../../../stdlib/data/cie1931.csv")));
static CIE_1964: LazyLock<Table> = LazyLock::new(|| table(include_str!("../../../stdlib/data/cie1964.csv")));
static CIE_2015_2: LazyLock<Table> = LazyLock::new(|| table(include_str!("../../../stdlib/data/cie2015_2.csv")));
static CIE_2015_10: LazyLock<Table> = LazyLock::new(|| table(include_str!("../../../stdlib/data/cie2015_10.csv")));

impl Observer {
    pub const ALL: [Observer; 4] =
        [Observer::Cie1931, Observer::Cie1964, Observer::Cie2015Deg2, Observer::Cie2015Deg10];

    /// As it is written in scripts and files.
    pub const fn name(self) -> &'static str {
        match self {
            Observer::Cie1931 => "cie1931",
            Observer::Cie1964 => "cie1964",
            Observer::Cie2015Deg2 => "cie2015_2",
            Observer::Cie2015Deg10 => "cie2015_10",
        }
    }

    /// x, y, z at the knots of the renderer's tables.
    pub fn matching_functions(self) -> &'static [[f64; 3]; KNOTS] {
        match self {
            Observer::Cie1931 => &CIE_1931,
            Observer::Cie1964 => &CIE_1964,
            Observer::Cie2015Deg2 => &CIE_2015_2,
            Observer::Cie2015Deg10 => &CIE_2015_10,
        }
    }

    /// x, y, z at a wavelength, linear between the knots; zero where they are not defined.
    pub fn matching_at(self, lambda_nm: f64) -> [f64; 3] {
        let table = self.matching_functions();
        let at = lambda_nm - TABLE_MIN_NM;
        if !(at >= 0.0 && at < (KNOTS - 1) as f64) {
            return [0.0; 3];
        }
        let (i, t) = (at as usize, at.fract());
        // The first and the last defined knot end the functions abruptly.
        let (low, high) = (table[i], if t > 0.0 { table[i + 1] } else { table[i] });
        if low == [0.0; 3] || high == [0.0; 3] {
            return [0.0; 3];
        }
        std::array::from_fn(|c| low[c] + t * (high[c] - low[c]))
    }

    /// Tristimulus values of a spectral radiance in W m^-2 sr^-1 nm^-1.
    pub fn xyz_of_radiance(self, radiance: &Spectrum) -> [f64; 3] {
        self.integrate(|lambda| radiance.eval(lambda)).map(|c| c * LUMINOUS_EFFICACY)
    }

    /// Tristimulus values of a reflectance under an illuminant of any scale; Y of the perfect diffuser is 1.
    pub fn xyz_of_reflectance(self, reflectance: &Spectrum, illuminant: &Spectrum) -> [f64; 3] {
        let white = self.integrate(|lambda| illuminant.eval(lambda))[1];
        self.integrate(|lambda| reflectance.eval(lambda) * illuminant.eval(lambda)).map(|c| c / white)
    }

    fn integrate(self, spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (i, row) in self.matching_functions().iter().enumerate().filter(|(_, row)| **row != [0.0; 3]) {
            let value = spectrum(knot_nm(i));
            for (total, matching) in sum.iter_mut().zip(row) {
                *total += value * matching;
            }
        }
        sum
    }
}

/// Of the CIE 1931 observer: [`Observer::xyz_of_radiance`].
pub fn xyz_of_radiance(radiance: &Spectrum) -> [f64; 3] {
    Observer::Cie1931.xyz_of_radiance(radiance)
}

/// Of the CIE 1931 observer: [`Observer::xyz_of_reflectance`].
pub fn xyz_of_reflectance(reflectance: &Spectrum, illuminant: &Spectrum) -> [f64; 3] {
    Observer::Cie1931.xyz_of_reflectance(reflectance, illuminant)
}

/// Chromaticity x, y; the white point of the equal-energy spectrum when there is no light.
pub fn chromaticity(xyz: [f64; 3]) -> [f64; 2] {
    let sum: f64 = xyz.iter().sum();
    if sum > 0.0 { [xyz[0] / sum, xyz[1] / sum] } else { [1.0 / 3.0; 2] }
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
pub(crate) fn numeric_rows<const N: usize>(text: &str) -> Vec<[f64; N]> {
    let row = |line: &str| {
        let numbers: Option<Vec<f64>> = line.split(',').map(|cell| cell.trim().parse().ok()).collect();
        numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok())
    };
    text.lines().filter_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of the matching functions at 1 nm as published (CIE 15:2018, tables 1 and 2); of those of 2015, sums that
    /// agree with each other: the equal-energy spectrum is white.
    #[test]
    fn sums_are_the_published_ones() {
        let sums =
            |observer: Observer| observer.xyz_of_radiance(&Spectrum::Constant(1.0)).map(|c| c / LUMINOUS_EFFICACY);
        for (observer, published) in [
            (Observer::Cie1931, [106.865469, Y_INTEGRAL_NM, 106.892251]),
            (Observer::Cie1964, [116.648519, 116.661877, 116.673980]),
        ] {
            let sums = sums(observer);
            assert!((0..3).all(|c| (sums[c] - published[c]).abs() < 2e-4), "{observer:?}: {sums:?}");
        }
        for observer in [Observer::Cie2015Deg2, Observer::Cie2015Deg10] {
            let [x, y, z] = sums(observer);
            assert!((x / y - 1.0).abs() < 2e-5 && (z / y - 1.0).abs() < 2e-5, "{observer:?}: {x} {y} {z}");
        }
    }

    /// CIE 15: D65 has x = 0.31272, y = 0.32903 for the 2 degree observer, 0.31382 and 0.33100 for 10 degrees.
    #[test]
    fn d65_has_its_white_point() {
        for (observer, white) in [(Observer::Cie1931, [0.31272, 0.32903]), (Observer::Cie1964, [0.31382, 0.33100])] {
            let [x, y] = chromaticity(observer.xyz_of_radiance(d65()));
            assert!((x - white[0]).abs() < 3e-5 && (y - white[1]).abs() < 3e-5, "{observer:?}: x = {x}, y = {y}");
        }
    }

    #[test]
    fn one_watt_at_555_nm_gives_about_683_lumens() {
        let [_, y, _] = Observer::Cie1931.matching_at(555.0);
        assert_eq!(y, 1.0);
        let narrow =
            Spectrum::Gaussian { center_nm: 555.0, sigma_nm: 1.0, peak: 1.0 / (2.0 * std::f64::consts::PI).sqrt() };
        assert!((xyz_of_radiance(&narrow)[1] / 683.0 - 1.0).abs() < 2e-3);
    }

    #[test]
    fn matching_is_linear_between_knots_and_zero_outside() {
        let observer = Observer::Cie1931;
        let table = observer.matching_functions();
        assert_eq!(observer.matching_at(830.0), table[630]);
        assert_eq!(observer.matching_at(360.0), table[160]);
        let y = observer.matching_at(500.25)[1];
        assert!((y - (0.75 * table[300][1] + 0.25 * table[301][1])).abs() < 1e-15);
        for nm in [0.0, 359.9, 830.1, 1100.0, f64::NAN] {
            assert_eq!(observer.matching_at(nm), [0.0; 3], "{nm}");
        }
    }
}
