//! A spectrum as it is written: a function of wavelength in closed form or in samples.

use std::sync::Arc;

/// A scalar function of wavelength. What it means (reflectance, radiance, index …) is its user's business.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    Constant(f64),
    /// Linear between knots, constant beyond the ends. `lambda_nm` strictly increases; both of one length >= 1.
    Tabulated {
        lambda_nm: Arc<[f64]>,
        values: Arc<[f64]>,
    },
    /// Planck's law, spectral radiance in W m^-2 sr^-1 nm^-1.
    Blackbody {
        kelvin: f64,
    },
    Gaussian {
        center_nm: f64,
        sigma_nm: f64,
        peak: f64,
    },
    /// Refractive index: n^2 = a + sum b_i L^2 / (L^2 - c_i), L in micrometres, c_i in square micrometres. `b` and
    /// `c_um2` are of one length.
    Sellmeier {
        a: f64,
        b: Arc<[f64]>,
        c_um2: Arc<[f64]>,
    },
    /// Refractive index: n = a + b / L^2 + c / L^4, L in micrometres.
    Cauchy {
        a: f64,
        b_um2: f64,
        c_um4: f64,
    },
    /// s(c0 L^2 + c1 L + c2) with s(x) = 1/2 + x / (2 sqrt(1 + x^2)), L in nanometres (Jakob and Hanika 2019).
    Sigmoid {
        coefficients: [f64; 3],
    },
    /// Coefficient of absorption of a medium of which `thickness` metres transmit as much as the spectrum says: -ln(t) / thickness, and
    /// no more than at t = 1e-12.
    Absorbance {
        transmission: Arc<Spectrum>,
        thickness: f64,
    },
    Scaled {
        factor: f64,
        spectrum: Arc<Spectrum>,
    },
    Product(Arc<Spectrum>, Arc<Spectrum>),
    Sum(Arc<Spectrum>, Arc<Spectrum>),
}
