//! Evaluation of spectra.

use crate::{Spectrum, planck};

impl Spectrum {
    /// The value at a vacuum wavelength. Finite for finite parameters, except at a pole of a Sellmeier formula.
    pub fn eval(&self, lambda_nm: f64) -> f64 {
        match self {
            Spectrum::Constant(value) => *value,
            Spectrum::Tabulated { lambda_nm: knots, values } => interpolate(knots, values, lambda_nm),
            Spectrum::Blackbody { kelvin } => planck(lambda_nm, *kelvin),
            Spectrum::Gaussian { center_nm, sigma_nm, peak } => {
                let z = (lambda_nm - center_nm) / sigma_nm;
                peak * (-0.5 * z * z).exp()
            }
            Spectrum::Sellmeier { a, b, c_um2 } => {
                let l2 = square(lambda_nm * 1e-3);
                let sum: f64 = b.iter().zip(c_um2.iter()).map(|(b, c)| b * l2 / (l2 - c)).sum();
                (a + sum).max(0.0).sqrt()
            }
            Spectrum::Cauchy { a, b_um2, c_um4 } => {
                let l2 = square(lambda_nm * 1e-3);
                a + b_um2 / l2 + c_um4 / (l2 * l2)
            }
            Spectrum::Sigmoid { coefficients: [c0, c1, c2] } => sigmoid((c0 * lambda_nm + c1) * lambda_nm + c2),
            Spectrum::Absorbance { transmission, thickness } => {
                -transmission.eval(lambda_nm).clamp(1e-12, 1.0).ln() / thickness
            }
            Spectrum::Scaled { factor, spectrum } => factor * spectrum.eval(lambda_nm),
            Spectrum::Product(a, b) => a.eval(lambda_nm) * b.eval(lambda_nm),
            Spectrum::Sum(a, b) => a.eval(lambda_nm) + b.eval(lambda_nm),
        }
    }
}

/// 1/2 + x / (2 sqrt(1 + x^2)), from 0 at minus infinity to 1 at infinity.
pub(crate) fn sigmoid(x: f64) -> f64 {
    if x.is_infinite() {
        return if x > 0.0 { 1.0 } else { 0.0 };
    }
    0.5 + x / (2.0 * (1.0 + x * x).sqrt())
}

fn square(x: f64) -> f64 {
    x * x
}

/// Linear between knots, constant beyond the ends.
fn interpolate(knots: &[f64], values: &[f64], x: f64) -> f64 {
    let above = knots.partition_point(|&knot| knot <= x);
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else {
        return 0.0;
    };
    if above == 0 {
        return first;
    }
    if above >= knots.len() {
        return last;
    }
    let t = (x - knots[above - 1]) / (knots[above] - knots[above - 1]);
    values[above - 1] + t * (values[above] - values[above - 1])
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    fn table() -> Spectrum {
        Spectrum::Tabulated { lambda_nm: Arc::from([400.0, 500.0, 700.0]), values: Arc::from([1.0, 3.0, -1.0]) }
    }

    #[test]
    fn tables_are_linear_between_knots_and_constant_beyond() {
        for (lambda, value) in [(300.0, 1.0), (400.0, 1.0), (450.0, 2.0), (500.0, 3.0), (600.0, 1.0), (900.0, -1.0)] {
            assert_eq!(table().eval(lambda), value, "at {lambda} nm");
        }
    }

    /// Fused silica (Malitson 1965) at the sodium D line: n = 1.45846 (in his paper 1.458404 at 589.3 nm).
    #[test]
    fn sellmeier_gives_the_index_of_fused_silica() {
        let silica = Spectrum::Sellmeier {
            a: 1.0,
            b: Arc::from([0.6961663, 0.4079426, 0.8974794]),
            c_um2: Arc::from([0.0684043f64.powi(2), 0.1162414f64.powi(2), 9.896161f64.powi(2)]),
        };
        assert!((silica.eval(589.3) - 1.458404).abs() < 2e-6);
    }

    /// BK7 by a two-term Cauchy formula: n(587.6 nm) = 1.5046 + 0.00420 / 0.5876^2.
    #[test]
    fn cauchy_uses_micrometres() {
        let glass = Spectrum::Cauchy { a: 1.5046, b_um2: 0.0042, c_um4: 0.0 };
        assert!((glass.eval(587.6) - 1.516_764).abs() < 1e-5);
    }

    #[test]
    fn combinations_combine() {
        let two = Arc::new(Spectrum::Constant(2.0));
        let table = Arc::new(table());
        assert_eq!(Spectrum::Product(two.clone(), table.clone()).eval(450.0), 4.0);
        assert_eq!(Spectrum::Sum(two, table.clone()).eval(450.0), 4.0);
        assert_eq!(Spectrum::Scaled { factor: -3.0, spectrum: table }.eval(450.0), -6.0);
    }

    #[test]
    fn absorbance_undoes_transmission() {
        let transmission = Arc::new(Spectrum::Gaussian { center_nm: 550.0, sigma_nm: 20.0, peak: 0.5 });
        let extinction = Spectrum::Absorbance { transmission, thickness: 0.25 };
        assert!(((-extinction.eval(550.0) * 0.25).exp() - 0.5).abs() < 1e-15);
        assert!((extinction.eval(2000.0) - 12.0 * 10f64.ln() / 0.25).abs() < 1e-9);
    }

    #[test]
    fn gaussian_has_its_peak_and_width() {
        let line = Spectrum::Gaussian { center_nm: 550.0, sigma_nm: 20.0, peak: 4.0 };
        assert_eq!(line.eval(550.0), 4.0);
        assert!((line.eval(570.0) / 4.0 - (-0.5f64).exp()).abs() < 1e-15);
    }

    #[test]
    fn sigmoid_stays_in_the_unit_interval() {
        for x in [f64::NEG_INFINITY, -1e200, -3.0, 0.0, 3.0, 1e200, f64::INFINITY] {
            assert!((0.0..=1.0).contains(&sigmoid(x)), "at {x}");
        }
    }
}
