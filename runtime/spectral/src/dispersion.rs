//! Dispersion formulas as the refractiveindex.info database numbers them.
//!
//! Source: the database's documentation "Dispersion formulas". L is the wavelength in micrometres, c the coefficients
//! in the order of the file, those that are not there being zero; powers are written with ^.
//!
//! 1. Sellmeier: n^2 - 1 = c1 + sum c_i L^2 / (L^2 - c_{i+1}^2)
//! 2. Sellmeier-2: n^2 - 1 = c1 + sum c_i L^2 / (L^2 - c_{i+1})
//! 3. Polynomial: n^2 = c1 + sum c_i L^c_{i+1}
//! 4. RefractiveIndex.INFO: n^2 = c1 + c2 L^c3 / (L^2 - c4^c5) + c6 L^c7 / (L^2 - c8^c9) + sum c_i L^c_{i+1}
//! 5. Cauchy: n = c1 + sum c_i L^c_{i+1}
//! 6. Gases: n - 1 = c1 + sum c_i / (c_{i+1} - L^-2)
//! 7. Herzberger: n = c1 + c2 / (L^2 - 0.028) + c3 / (L^2 - 0.028)^2 + c4 L^2 + c5 L^4 + c6 L^6
//! 8. Retro: (n^2 - 1) / (n^2 + 2) = c1 + c2 L^2 / (L^2 - c3) + c4 L^2
//! 9. Exotic: n^2 = c1 + c2 / (L^2 - c3) + c4 (L - c5) / ((L - c5)^2 + c6)

use std::sync::Arc;

use crate::{Spectrum, TABLE_MAX_NM, TABLE_MIN_NM};

/// The numbers of the formulas, first and last.
pub const FORMULAS: [u32; 2] = [1, 9];

/// The refractive index at a wavelength; 0 where the formula has no real value. `None` for an unknown formula.
pub fn index(formula: u32, c: &[f64], lambda_nm: f64) -> Option<f64> {
    let l = lambda_nm * 1e-3;
    let l2 = l * l;
    let at = |i: usize| c.get(i - 1).copied().unwrap_or(0.0);
    let pairs =
        |first: usize| c.get(first - 1..).unwrap_or(&[]).chunks(2).map(|pair| (pair[0], *pair.get(1).unwrap_or(&0.0)));
    let root = |square: f64| square.max(0.0).sqrt();
    Some(match formula {
        1 => root(1.0 + at(1) + pairs(2).map(|(b, c)| b * l2 / (l2 - c * c)).sum::<f64>()),
        2 => root(1.0 + at(1) + pairs(2).map(|(b, c)| b * l2 / (l2 - c)).sum::<f64>()),
        3 => root(at(1) + pairs(2).map(|(b, power)| b * l.powf(power)).sum::<f64>()),
        4 => {
            let term = |i: usize| match at(i) {
                0.0 => 0.0,
                b => b * l.powf(at(i + 1)) / (l2 - at(i + 2).powf(at(i + 3))),
            };
            root(at(1) + term(2) + term(6) + pairs(10).map(|(b, power)| b * l.powf(power)).sum::<f64>())
        }
        5 => at(1) + pairs(2).map(|(b, power)| b * l.powf(power)).sum::<f64>(),
        6 => 1.0 + at(1) + pairs(2).map(|(b, c)| b / (c - 1.0 / l2)).sum::<f64>(),
        7 => {
            let x = 1.0 / (l2 - 0.028);
            at(1) + (at(2) + at(3) * x) * x + ((at(6) * l2 + at(5)) * l2 + at(4)) * l2
        }
        8 => {
            let ratio = at(1) + at(2) * l2 / (l2 - at(3)) + at(4) * l2;
            root((1.0 + 2.0 * ratio) / (1.0 - ratio))
        }
        9 => {
            let off = l - at(5);
            root(at(1) + at(2) / (l2 - at(3)) + at(4) * off / (off * off + at(6)))
        }
        _ => return None,
    })
}

/// A formula as a spectrum: formulas 1 and 2 as they are, the others in samples of 1 nm over the part of the validity
/// range that the renderer's tables cover. `None` for an unknown formula, and where the formula is not finite or the
/// range lies elsewhere.
pub fn spectrum(formula: u32, c: &[f64], range_nm: [f64; 2]) -> Option<Spectrum> {
    if let 1 | 2 = formula {
        let pairs = || c.get(1..).unwrap_or(&[]).chunks(2);
        let resonance = |pair: &[f64]| pair.get(1).copied().unwrap_or(0.0);
        let square = |x: f64| if formula == 1 { x * x } else { x };
        return Some(Spectrum::Sellmeier {
            a: 1.0 + c.first().copied().unwrap_or(0.0),
            b: pairs().map(|pair| pair[0]).collect(),
            c_um2: pairs().map(|pair| square(resonance(pair))).collect(),
        });
    }
    let (first, last) = (range_nm[0].max(TABLE_MIN_NM).ceil(), range_nm[1].min(TABLE_MAX_NM).floor());
    if first.is_nan() || last.is_nan() || first > last {
        return None;
    }
    let lambda_nm: Arc<[f64]> = (0..=(last - first) as usize).map(|i| first + i as f64).collect();
    let values: Option<Arc<[f64]>> =
        lambda_nm.iter().map(|nm| index(formula, c, *nm).filter(|n| n.is_finite())).collect();
    Some(Spectrum::Tabulated { lambda_nm, values: values? })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries of the database, one for each formula, with the index that it states or that the source publishes.
    #[test]
    fn formulas_give_published_indices() {
        let cases: [(u32, &[f64], f64, f64, f64); 8] = [
            // Fused silica, Malitson 1965, at the sodium D line.
            (1, &[0.0, 0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161], 589.3, 1.458_404, 2e-6),
            // Schott N-BK7, nd.
            (
                2,
                &[0.0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653],
                587.56,
                1.5168,
                5e-6,
            ),
            // A polynomial that is the square of 1.5 + 0.004 / L^2.
            (3, &[2.25, 0.012, -2.0, 1.6e-5, -4.0], 500.0, 1.516, 1e-12),
            // The ordinary index of beta barium borate in its usual form: 2.7359 + 0.01878 / (L^2 - 0.01822) - 0.01354 L^2.
            (4, &[2.7359, 0.01878, 0.0, 0.01822, 1.0, 0.0, 0.0, 0.0, 1.0, -0.01354, 2.0], 1064.2, 1.6545, 2e-3),
            (5, &[1.5046, 0.0042, -2.0], 587.6, 1.516_764, 1e-5),
            // Air at 15 degrees, Ciddor 1996.
            (6, &[0.0, 0.05792105, 238.0185, 0.00167917, 57.362], 589.3, 1.000_276_5, 1e-6),
            (7, &[1.5, 0.0, 0.0, 0.01, 0.001, 0.0001], 1000.0, 1.5111, 1e-12),
            (8, &[0.25], 500.0, std::f64::consts::SQRT_2, 1e-12),
        ];
        for (formula, c, nm, published, tolerance) in cases {
            let n = index(formula, c, nm).unwrap();
            assert!((n - published).abs() < tolerance, "formula {formula}: {n} instead of {published}");
        }
        // Urea, ordinary ray, Rosker 1985: 2.1823 + 0.0125 / (L^2 - 0.0300).
        assert!((index(9, &[2.1823, 0.0125, 0.03], 1064.0).unwrap() - 1.4811).abs() < 1e-3);
        assert_eq!(index(10, &[1.0], 500.0), None);
    }

    #[test]
    fn spectra_agree_with_their_formulas() {
        let c = [0.0, 1.0, 0.1, 0.5, 0.02];
        for formula in 1..=9 {
            let spectrum = spectrum(formula, &c, [450.0, 650.0]).unwrap();
            for nm in [450.0, 523.0, 650.0] {
                assert!((spectrum.eval(nm) - index(formula, &c, nm).unwrap()).abs() < 1e-12, "formula {formula}, {nm}");
            }
        }
        assert_eq!(spectrum(5, &c, [1200.0, 1300.0]), None);
        assert_eq!(spectrum(11, &c, [450.0, 650.0]), None);
        assert!(matches!(spectrum(2, &[], [0.0, 1.0]), Some(Spectrum::Sellmeier { a: 1.0, .. })));
    }
}
