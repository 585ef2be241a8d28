//! What share of light a surface absorbs, by direction: by Kirchhoff's law also its emissivity.
//!
//! Emission in thermal equilibrium makes good what is not scattered: with M the sum of the Mueller matrices of all that a
//! bsdf scatters to `wo`, unpolarised surroundings of the same temperature are made whole by (1, 0, 0, 0) - M (1, 0, 0, 0).
//! Smooth metals have it in closed form. Other opaque surfaces are tabulated over the cosine and the wavelength, linear
//! between entries; anisotropic ones by their mean over the azimuth. What lets light through absorbs nothing.

use arsc_spectral::{SampledSpectrum, SampledWavelengths, TABLE_MAX_NM, TABLE_MIN_NM};
use glam::{DVec3, Vec4};

use crate::bsdf::{Bsdf, Conductor};
use crate::polarisation::{Mueller, Polarised, ReferenceFrame, Stokes, StokesSpectrum, s_axis};

/// Entries over the cosine from 0 to 1, and over wavelengths.
const ANGLES: usize = 33;
const LAMBDAS: usize = 96;
const STEP_NM: f64 = (TABLE_MAX_NM - TABLE_MIN_NM) / (LAMBDAS - 1) as f64;

/// Samples of the bsdf per entry, along each axis of the unit square.
const GRID: usize = 16;

/// Its multiples are evenly spread over the unit interval.
const INVERSE_GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;

#[derive(Clone, Debug)]
pub enum Absorptance {
    None,
    Conductor(Conductor),
    /// `[angle][lambda]`: mean and s-polarised excess of what is absorbed.
    Table(Box<[[[f32; 2]; LAMBDAS]; ANGLES]>),
}

impl Absorptance {
    pub fn new(bsdf: &Bsdf) -> Absorptance {
        match bsdf {
            Bsdf::Conductor(conductor) => Absorptance::Conductor(conductor.clone()),
            Bsdf::Lambert(_)
            | Bsdf::OrenNayar(_)
            | Bsdf::Mirror(_)
            | Bsdf::Phong(_)
            | Bsdf::RoughConductor(_)
            | Bsdf::Layered(_)
            | Bsdf::Measured(_)
            | Bsdf::Fluorescent(_) => Absorptance::Table(tabulate(bsdf)),
            _ => Absorptance::None,
        }
    }

    /// Mean over polarisations, and half of the difference between s and p, towards a direction with this cosine.
    #[inline]
    pub fn at(&self, cos: f64, wavelengths: &SampledWavelengths) -> [SampledSpectrum; 2] {
        match self {
            Absorptance::None => [SampledSpectrum::ZERO; 2],
            Absorptance::Conductor(conductor) => {
                let effect = conductor.reflection(cos, wavelengths);
                [SampledSpectrum::ONE - effect.a, effect.b * -1.0]
            }
            Absorptance::Table(table) => {
                let at = cos.clamp(0.0, 1.0) as f32 * (ANGLES - 1) as f32;
                let row = (at as usize).min(ANGLES - 2);
                let part = at - row as f32;
                let entry = |lambda_nm: f32, i: usize| {
                    let x = ((lambda_nm - TABLE_MIN_NM as f32) / STEP_NM as f32).clamp(0.0, (LAMBDAS - 1) as f32);
                    let column = (x as usize).min(LAMBDAS - 2);
                    let across = |row: usize| {
                        let (low, high) = (table[row][column][i], table[row][column + 1][i]);
                        low + (high - low) * (x - column as f32)
                    };
                    across(row) * (1.0 - part) + across(row + 1) * part
                };
                let lambda = SampledSpectrum(wavelengths.lambda_nm);
                [lambda.map(|lambda| entry(lambda, 0)), lambda.map(|lambda| entry(lambda, 1))]
            }
        }
    }
}

fn tabulate(bsdf: &Bsdf) -> Box<[[[f32; 2]; LAMBDAS]; ANGLES]> {
    let mut table = Box::new([[[0.0; 2]; LAMBDAS]; ANGLES]);
    for (row, entries) in table.iter_mut().enumerate() {
        // The first row stands for light that grazes.
        let cos = (row as f64 / (ANGLES - 1) as f64).max(1e-3);
        let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        for first in (0..LAMBDAS).step_by(4) {
            let lambda = |i: usize| TABLE_MIN_NM + STEP_NM * (first + i) as f64;
            let wavelengths = SampledWavelengths::fixed([lambda(0), lambda(1), lambda(2), lambda(3)]);
            let [mean, excess] = scattered(bsdf, wo, &wavelengths).map(|s| s.0.to_array());
            for i in 0..4 {
                entries[first + i] = [(1.0 - mean[i]).clamp(0.0, 1.0), -excess[i]];
            }
        }
    }
    table
}

/// S0 and S1 towards `wo` in surroundings of radiance 1, averaged over the azimuth where it matters; s is the x axis.
fn scattered(bsdf: &Bsdf, wo: DVec3, wavelengths: &SampledWavelengths) -> [SampledSpectrum; 2] {
    let turns = if bsdf.needs_tangent() { 8 } else { 1 };
    let mut sum = [Vec4::ZERO; 2];
    for turn in 0..turns {
        let (sin, cos) = (std::f64::consts::PI * f64::from(turn) / f64::from(turns)).sin_cos();
        let wo = DVec3::new(wo.x * cos, wo.x * sin, wo.z);
        let frame = ReferenceFrame::new(s_axis(DVec3::Z, wo), wo);
        for i in 0..GRID * GRID {
            let u = [i % GRID, i / GRID].map(|k| (k as f64 + 0.5) / GRID as f64);
            // The choice of a lobe, if there is one, is stratified as well.
            let u_lobe = ((i as f64 + 0.5) * INVERSE_GOLDEN_RATIO).fract();
            let Some(sample) = bsdf.sample::<Polarised>(wo, u, u_lobe, wavelengths) else { continue };
            let light = sample.weight.apply(&StokesSpectrum::unpolarised(SampledSpectrum::ONE)).in_frame(frame);
            sum = [sum[0] + light.s[0].0, sum[1] + light.s[1].0];
        }
    }
    sum.map(|s| SampledSpectrum(s / (turns as f32 * (GRID * GRID) as f32)))
}
