//! Re-radiation tabulated for the inner loop: sampling of excitation wavelengths.
//!
//! A path from the camera knows the wavelengths at which light leaves and asks for those at which it came. All four are
//! shifted together: each is drawn from the density in proportion to b(mu, lambda) over the rendered range, at its own
//! emission wavelength, from numbers u, u + 1/4, u + 1/2, u + 3/4 (modulo 1). Which one is the hero does not matter to
//! that, so that spectral multiple importance sampling goes on as if nothing had happened, and the weight of a shift is
//! the *strength* of each wavelength: the integral of b over the excitation. Wavelength shifts within hero-wavelength
//! sampling are the idea of Mojzik, Fichet and Wilkie 2018, "Handling fluorescence in a uni-directional spectral path
//! tracer".
//!
//! b is linear in emission between knots of 1 nm (the nearest knot counts) and constant in excitation between them.
//! Single precision.

use glam::Vec4;

use crate::range::{KNOTS, knot_nm};
use crate::reradiation::counted;
use crate::{Fluorescence, SampledSpectrum, SampledWavelengths, WavelengthRange};

/// Tabulated fluorescence, of one substance or several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReradiationTable {
    terms: Box<[Term]>,
}

#[derive(Clone, Debug, PartialEq)]
struct Term {
    /// The integral of b over all excitation wavelengths, at each emission knot.
    strength: Box<[f32; KNOTS]>,
    /// Distribution functions over the excitation: from 0 at the knot `first` to 1, `cells` nanometres further.
    first: usize,
    cells: usize,
    distributions: Box<[f32]>,
    /// Which of them belongs to an emission knot; all have the first one if there is one only.
    row: Option<Box<[u16; KNOTS]>>,
}

impl ReradiationTable {
    pub fn new(parts: &[Fluorescence]) -> ReradiationTable {
        ReradiationTable { terms: parts.iter().filter_map(Term::new).collect() }
    }

    /// Nothing ever changes its wavelength.
    pub fn is_empty(&self) -> bool {
        self.terms.is_empty()
    }

    /// Spectral power at the given emission wavelengths per constant spectral power at all excitation wavelengths of the
    /// range.
    #[inline]
    pub fn strength(&self, wavelengths: &SampledWavelengths, range: &WavelengthRange) -> SampledSpectrum {
        let of = |knot: u32| self.terms.iter().map(|term| term.within(knot as usize, range).0).sum();
        SampledSpectrum(Vec4::from_array(wavelengths.knots.map(of)))
    }

    /// Excitation wavelengths for the given emission wavelengths, `u` in [0, 1). Each has the density b over
    /// [`ReradiationTable::strength`]; where that is zero, it stays.
    pub fn shift(&self, wavelengths: &SampledWavelengths, range: &WavelengthRange, u: f64) -> SampledWavelengths {
        let mut lambda_nm = wavelengths.lambda_nm.to_array();
        for (i, lambda) in lambda_nm.iter_mut().enumerate() {
            let turned = u + 0.25 * i as f64;
            let knot = wavelengths.knots[i] as usize;
            *lambda = self.excitation(knot, range, (turned - turned.floor()) as f32).unwrap_or(*lambda);
        }
        wavelengths.shifted(lambda_nm.into())
    }

    fn excitation(&self, knot: usize, range: &WavelengthRange, u: f32) -> Option<f32> {
        let total: f32 = self.terms.iter().map(|term| term.within(knot, range).0).sum();
        let mut rest = u * total;
        let mut last = None;
        for term in &self.terms {
            let (strength, [low, high]) = term.within(knot, range);
            if strength > 0.0 {
                let share = (rest / strength).min(1.0);
                last = Some(
                    term.quantile(knot, low + share * (high - low)).clamp(range.min_nm() as f32, range.max_nm() as f32),
                );
                if rest < strength {
                    return last;
                }
            }
            rest -= strength;
        }
        last
    }

    /// The largest strength at any emission wavelength, the whole excitation counted.
    pub fn largest_strength(&self) -> f32 {
        let at = |knot: usize| self.terms.iter().map(|term| term.strength[knot]).sum::<f32>();
        (0..KNOTS).map(at).fold(0.0, f32::max)
    }
}

impl Term {
    /// `None` for what emits nothing.
    fn new(fluorescence: &Fluorescence) -> Option<Term> {
        match fluorescence {
            Fluorescence::Dye(dye) => {
                let norm = dye.photon_norm();
                let absorbed = |mu: f64| dye.quantum_yield.clamp(0.0, 1.0) * counted(dye.absorption.eval(mu)) * mu;
                let (distribution, total) = distribution(0, KNOTS - 1, absorbed);
                let mut strength = Box::new([0.0; KNOTS]);
                for (knot, value) in strength.iter_mut().enumerate() {
                    *value = (total * norm * counted(dye.emission.eval(knot_nm(knot)))) as f32;
                }
                let distributions = distribution.into();
                (total * norm > 0.0).then_some(Term { strength, first: 0, cells: KNOTS - 1, distributions, row: None })
            }
            Fluorescence::Matrix(matrix) => {
                let knot = |nm: f64| (nm - knot_nm(0)).clamp(0.0, (KNOTS - 1) as f64);
                let (rows, step) = (matrix.rows(), matrix.excitation_nm[1]);
                let first = knot(matrix.excitation(0) - step).floor() as usize;
                let cells = knot(matrix.excitation(rows)).ceil() as usize - first;
                let mut strength = Box::new([0.0; KNOTS]);
                let mut row = Box::new([0; KNOTS]);
                let mut distributions = Vec::new();
                for k in 0..KNOTS {
                    let density = |mu| fluorescence.density(mu, knot_nm(k));
                    let (distribution, total) = distribution(first, cells, density);
                    if total > 0.0 {
                        strength[k] = total as f32;
                        row[k] = (distributions.len() / (cells + 1)) as u16;
                        distributions.extend(distribution);
                    }
                }
                let distributions: Box<[f32]> = distributions.into();
                (!distributions.is_empty()).then_some(Term { strength, first, cells, distributions, row: Some(row) })
            }
        }
    }

    #[inline]
    fn distribution(&self, knot: usize) -> &[f32] {
        let row = self.row.as_ref().map_or(0, |row| usize::from(row[knot]));
        &self.distributions[row * (self.cells + 1)..][..self.cells + 1]
    }

    /// Strength of the excitation within a range, and the shares of the whole at its ends.
    #[inline]
    fn within(&self, knot: usize, range: &WavelengthRange) -> (f32, [f32; 2]) {
        let strength = self.strength[knot];
        if strength == 0.0 {
            return (0.0, [0.0, 1.0]);
        }
        let distribution = self.distribution(knot);
        let share = |nm: f64| {
            let at = ((nm - knot_nm(self.first)) as f32).clamp(0.0, self.cells as f32);
            let cell = (at as usize).min(self.cells - 1);
            distribution[cell] + (distribution[cell + 1] - distribution[cell]) * (at - cell as f32)
        };
        let ends = [share(range.min_nm()), share(range.max_nm())];
        (strength * (ends[1] - ends[0]), ends)
    }

    /// The wavelength below which this share of the excitation lies.
    fn quantile(&self, knot: usize, share: f32) -> f32 {
        let distribution = self.distribution(knot);
        let above = distribution.partition_point(|below| *below <= share).clamp(1, self.cells);
        let (low, high) = (distribution[above - 1], distribution[above]);
        let part = if high > low { ((share - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
        knot_nm(self.first) as f32 + (above - 1) as f32 + part
    }
}

/// The distribution function of a density at the ends of `cells` cells of 1 nm from a knot on, and its integral.
fn distribution(first: usize, cells: usize, density: impl Fn(f64) -> f64) -> (Vec<f32>, f64) {
    let mut sum = 0.0;
    let mut below = density(knot_nm(first));
    let sums: Vec<f64> = (1..=cells)
        .map(|i| {
            let above = density(knot_nm(first + i));
            sum += 0.5 * (below + above);
            below = above;
            sum
        })
        .collect();
    let shares = sums.iter().map(|part| if sum > 0.0 { (part / sum) as f32 } else { 0.0 });
    (std::iter::once(0.0).chain(shares).collect(), sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DonaldsonMatrix, Dye, Spectrum};

    fn bell(center_nm: f64, sigma_nm: f64, peak: f64) -> Spectrum {
        Spectrum::Gaussian { center_nm, sigma_nm, peak }
    }

    fn dye(absorption: f64, emission: f64) -> Fluorescence {
        Fluorescence::Dye(Dye {
            absorption: bell(absorption, 25.0, 0.8),
            emission: bell(emission, 30.0, 1.0),
            quantum_yield: 0.7,
        })
    }

    fn matrix() -> Fluorescence {
        let entries = (0..12 * 20).map(|i| f64::from((i * 37) % 11) * 0.005).collect();
        Fluorescence::Matrix(DonaldsonMatrix {
            excitation_nm: [380.0, 10.0],
            emission_nm: [430.0, 10.0],
            columns: 20,
            entries,
        })
    }

    /// Means over u of functions of the excitation wavelength against sums of the density: for each of four emission
    /// wavelengths, two dyes together, a matrix, and a range that cuts them.
    #[test]
    fn shifts_follow_the_density() {
        for parts in [vec![dye(430.0, 520.0)], vec![dye(430.0, 520.0), dye(520.0, 600.0)], vec![matrix()]] {
            let table = ReradiationTable::new(&parts);
            for (min, max) in [(360.0, 830.0), (300.0, 830.0), (410.0, 700.0)] {
                let range = WavelengthRange::new(min, max).unwrap();
                let w = SampledWavelengths::fixed([500.0, 521.0, 555.0, 610.0]);
                let strength = table.strength(&w, &range);
                let mut means = [[0.0f64; 2]; 4];
                const N: usize = 20_000;
                for i in 0..N {
                    let shifted = table.shift(&w, &range, (i as f64 + 0.5) / N as f64);
                    for (c, mu) in shifted.lambda_nm.to_array().into_iter().enumerate() {
                        assert!((min as f32..=max as f32).contains(&mu));
                        means[c][0] += f64::from(mu) / N as f64;
                        means[c][1] += f64::from(mu - 450.0).powi(2) / N as f64;
                    }
                }
                for (c, [mean, square]) in means.into_iter().enumerate() {
                    let lambda = f64::from(w.lambda_nm[c]);
                    let (mut sums, mut mu) = ([0.0; 3], min + 0.25);
                    while mu < max {
                        let b: f64 = parts.iter().map(|part| part.density(mu, lambda)).sum::<f64>() * 0.5;
                        sums = [sums[0] + b, sums[1] + b * mu, sums[2] + b * (mu - 450.0) * (mu - 450.0)];
                        mu += 0.5;
                    }
                    assert!((f64::from(strength.0[c]) / sums[0] - 1.0).abs() < 2e-3, "{c}: {strength:?}, {sums:?}");
                    assert!((mean - sums[1] / sums[0]).abs() < 0.1, "{c}: {mean} of {sums:?}");
                    assert!((square / (sums[2] / sums[0]) - 1.0).abs() < 0.01, "{c}");
                }
            }
        }
    }

    /// No emission at a wavelength: it has no strength and stays.
    #[test]
    fn what_emits_nothing_stays() {
        let dark = Dye { absorption: bell(430.0, 20.0, 0.5), emission: Spectrum::Constant(0.0), quantum_yield: 1.0 };
        assert!(ReradiationTable::new(&[Fluorescence::Dye(dark)]).is_empty());
        let table = ReradiationTable::new(&[matrix()]);
        let w = SampledWavelengths::fixed([300.0, 350.0, 900.0, 500.0]);
        let (range, strength) = (WavelengthRange::VISIBLE, table.strength(&w, &WavelengthRange::VISIBLE));
        assert_eq!(strength.0.truncate(), glam::Vec3::ZERO);
        let shifted = table.shift(&w, &range, 0.3);
        assert_eq!(shifted.lambda_nm.truncate(), w.lambda_nm.truncate());
        assert!(strength.0.w > 0.0 && shifted.lambda_nm.w != w.lambda_nm.w);
    }
}
