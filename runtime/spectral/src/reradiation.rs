//! Re-radiation: light that is absorbed at one wavelength and leaves at others.
//!
//! Excitation wavelengths are called `mu_nm`, emission wavelengths `lambda_nm`. The bispectral density b(mu, lambda), per
//! nanometre, says how much spectral power at lambda becomes of spectral power that arrives at mu: of an irradiance E a
//! surface makes the radiant exitance `reflectance`(lambda) E(lambda) + integral of b(mu, lambda) E(mu) dmu. For dyes in a
//! medium b is per metre as well.
//!
//! Yields count photons: a photon of lambda has mu / lambda of the energy of one of mu.
//! Donaldson 1954, "Spectrophotometry of fluorescent pigments"; Hullin et al. 2010, "Acquisition and analysis of
//! bispectral bidirectional reflectance and reradiation distribution functions".

use std::sync::Arc;

use crate::range::knot_nm;
use crate::{KNOTS, Spectrum};

/// A fluorescent substance. What it emits does not depend on what excited it (Kasha's rule).
#[derive(Clone, Debug, PartialEq)]
pub struct Dye {
    /// Share of the light that it takes up; in a medium per metre.
    pub absorption: Spectrum,
    /// Emitted power per nanometre, in any unit.
    pub emission: Spectrum,
    /// Photons emitted per photon absorbed, within [0, 1].
    pub quantum_yield: f64,
}

/// A measured matrix on regular grids, off its diagonal.
#[derive(Clone, Debug, PartialEq)]
pub struct DonaldsonMatrix {
    /// First excitation wavelength and the step to the next ones, nm.
    pub excitation_nm: [f64; 2],
    /// First emission wavelength and the step to the next ones, nm.
    pub emission_nm: [f64; 2],
    /// Emission wavelengths.
    pub columns: usize,
    /// A row for each excitation wavelength: spectral power at the emission wavelengths over the spectral power in the
    /// band, one step wide, about the excitation wavelength. Bilinear between entries, zero one step beyond them.
    pub entries: Arc<[f64]>,
}

/// How light changes its wavelength.
#[derive(Clone, Debug, PartialEq)]
pub enum Fluorescence {
    Dye(Dye),
    Matrix(DonaldsonMatrix),
}

/// Everything that a diffuse surface gives back.
#[derive(Clone, Debug, PartialEq)]
pub struct Reradiation {
    /// Of light that keeps its wavelength.
    pub reflectance: Spectrum,
    pub fluorescence: Fluorescence,
}

/// Wavelengths of the renderer's tables, every nanometre.
fn knots() -> impl Iterator<Item = f64> {
    (0..KNOTS).map(knot_nm)
}

/// A value that counts: finite and not negative.
pub(crate) fn counted(value: f64) -> f64 {
    if value.is_finite() { value.max(0.0) } else { 0.0 }
}

impl Dye {
    /// Of emission power f the factor that makes photons of it: 1 over the integral of f(lambda) lambda. Zero for a dye
    /// that emits nothing.
    pub(crate) fn photon_norm(&self) -> f64 {
        let integral: f64 = knots().map(|lambda_nm| counted(self.emission.eval(lambda_nm)) * lambda_nm).sum();
        if integral > 0.0 { 1.0 / integral } else { 0.0 }
    }

    /// Mean energies of the photons of white absorbed light and of emitted light, in units of hc / nm; `None` where there
    /// is no light.
    pub fn mean_photon_energies(&self) -> Option<[f64; 2]> {
        let mean = |photons: &dyn Fn(f64) -> f64| {
            let (sum, energy) = knots().fold((0.0, 0.0), |(sum, energy), nm| {
                let n = photons(nm);
                (sum + n, energy + n / nm)
            });
            (sum > 0.0).then(|| energy / sum)
        };
        let absorbed = mean(&|nm| counted(self.absorption.eval(nm)) * nm)?;
        Some([absorbed, mean(&|nm| counted(self.emission.eval(nm)) * nm)?])
    }
}

impl DonaldsonMatrix {
    pub fn rows(&self) -> usize {
        self.entries.len().checked_div(self.columns).unwrap_or(0)
    }

    pub fn excitation(&self, row: usize) -> f64 {
        self.excitation_nm[0] + self.excitation_nm[1] * row as f64
    }

    pub fn emission(&self, column: usize) -> f64 {
        self.emission_nm[0] + self.emission_nm[1] * column as f64
    }

    fn density(&self, mu_nm: f64, lambda_nm: f64) -> f64 {
        let (row, up) = cell(self.excitation_nm, mu_nm);
        let (column, right) = cell(self.emission_nm, lambda_nm);
        let entry = |row: i64, column: i64| {
            let inside = row >= 0 && column >= 0 && (row as usize) < self.rows() && (column as usize) < self.columns;
            if inside { counted(self.entries[row as usize * self.columns + column as usize]) } else { 0.0 }
        };
        let across = |row| entry(row, column) * (1.0 - right) + entry(row, column + 1) * right;
        (across(row) * (1.0 - up) + across(row + 1) * up) / self.excitation_nm[1]
    }

    /// Photons emitted per photon of an excitation wavelength.
    fn photon_yield(&self, row: usize) -> f64 {
        let of = |column: usize| counted(self.entries[row * self.columns + column]) * self.emission(column);
        let sum: f64 = (0..self.columns).map(of).sum();
        sum * self.emission_nm[1] / (self.excitation_nm[1] * self.excitation(row))
    }
}

/// Index of the sample below, and the way to the next one.
fn cell([start, step]: [f64; 2], nm: f64) -> (i64, f64) {
    let at = (nm - start) / step;
    (at.floor() as i64, at - at.floor())
}

impl Fluorescence {
    /// The bispectral density b(mu, lambda), nm^-1.
    pub fn density(&self, mu_nm: f64, lambda_nm: f64) -> f64 {
        match self {
            Fluorescence::Dye(dye) => {
                let absorbed = dye.quantum_yield * counted(dye.absorption.eval(mu_nm)) * mu_nm;
                absorbed * counted(dye.emission.eval(lambda_nm)) * dye.photon_norm()
            }
            Fluorescence::Matrix(matrix) => matrix.density(mu_nm, lambda_nm),
        }
    }
}

impl Reradiation {
    /// The share of photons that leave, or stay in the dye, where it is largest, and that wavelength in nanometres. More
    /// than one would be made of nothing.
    pub fn largest_share(&self) -> (f64, f64) {
        let reflected = |nm: f64| counted(self.reflectance.eval(nm));
        let larger = |a: (f64, f64), b: (f64, f64)| if b.0 > a.0 { b } else { a };
        let none = (0.0, 0.0);
        match &self.fluorescence {
            Fluorescence::Dye(dye) => {
                knots().map(|nm| (reflected(nm) + counted(dye.absorption.eval(nm)), nm)).fold(none, larger)
            }
            Fluorescence::Matrix(matrix) => (0..matrix.rows())
                .map(|row| (reflected(matrix.excitation(row)) + matrix.photon_yield(row), matrix.excitation(row)))
                .fold(none, larger),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bell(center_nm: f64, sigma_nm: f64, peak: f64) -> Spectrum {
        Spectrum::Gaussian { center_nm, sigma_nm, peak }
    }

    /// Photons out over photons in are the share absorbed times the yield, at every excitation wavelength.
    #[test]
    fn dyes_count_photons() {
        let dye = Dye { absorption: bell(450.0, 20.0, 0.8), emission: bell(550.0, 30.0, 17.0), quantum_yield: 0.6 };
        let fluorescence = Fluorescence::Dye(dye);
        for mu in [400.0, 450.0, 470.5] {
            // Photons per unit of power go as the wavelength.
            let out: f64 = (300..=900).map(|l| fluorescence.density(mu, f64::from(l)) * f64::from(l)).sum();
            let expected = 0.6 * bell(450.0, 20.0, 0.8).eval(mu);
            assert!((out / mu / expected - 1.0).abs() < 1e-9, "{mu}: {} not {expected}", out / mu);
        }
    }

    #[test]
    fn stokes_shifts_lose_energy() {
        let dye = |a, e| Dye { absorption: bell(a, 20.0, 0.8), emission: bell(e, 20.0, 1.0), quantum_yield: 1.0 };
        let [absorbed, emitted] = dye(450.0, 550.0).mean_photon_energies().unwrap();
        assert!((absorbed * 450.0 - 1.0).abs() < 5e-3 && (emitted * 550.0 - 1.0).abs() < 5e-3);
        let [absorbed, emitted] = dye(550.0, 450.0).mean_photon_energies().unwrap();
        assert!(emitted > absorbed);
    }

    fn matrix() -> DonaldsonMatrix {
        let entries = [0.0, 0.1, 0.3, 0.2, 0.0, 0.4];
        DonaldsonMatrix {
            excitation_nm: [400.0, 20.0],
            emission_nm: [400.0, 20.0],
            columns: 3,
            entries: entries.into(),
        }
    }

    /// Integrals over either wavelength are the sums of the matrix.
    #[test]
    fn matrices_keep_their_sums() {
        let fluorescence = Fluorescence::Matrix(matrix());
        let over_mu: f64 = (370..=450).map(|mu| fluorescence.density(f64::from(mu), 440.0)).sum();
        assert!((over_mu - 0.7).abs() < 1e-12, "{over_mu}");
        let over_lambda: f64 = (370..=470).map(|l| fluorescence.density(420.0, f64::from(l))).sum();
        assert!((over_lambda - 0.6 * 20.0 / 20.0).abs() < 1e-12, "{over_lambda}");
        assert_eq!(fluorescence.density(375.0, 440.0), 0.0);
    }

    #[test]
    fn too_many_photons_are_found() {
        let reflectance = Spectrum::Constant(0.5);
        let dye = Dye { absorption: bell(450.0, 20.0, 0.8), emission: bell(550.0, 30.0, 1.0), quantum_yield: 0.1 };
        let share =
            Reradiation { reflectance: reflectance.clone(), fluorescence: Fluorescence::Dye(dye) }.largest_share();
        assert!((share.0 - 1.3).abs() < 1e-12 && share.1 == 450.0, "{share:?}");
        let share = Reradiation { reflectance, fluorescence: Fluorescence::Matrix(matrix()) }.largest_share();
        let expected = 0.5 + (0.2 * 400.0 + 0.4 * 440.0) / 420.0;
        assert!((share.0 - expected).abs() < 1e-12 && share.1 == 420.0, "{share:?}");
    }
}
