//! The sky of [`crate::sky`] for the inner loop: all wavelengths of the data side by side, in single precision.
//!
//! Loops run over a fixed number of lanes without branches, so that the compiler turns them into vector code; the
//! exponential is a polynomial (relative error below 3e-7 over its range).

use crate::sky::{BANDS, FIRST_NM, HosekWilkieSky, OZONE_EDGE_NM, PARAMETERS, STEP_NM};
use crate::{SampledSpectrum, SampledWavelengths};

/// [`BANDS`] rounded up to whole vectors; the lanes beyond hold zero.
const LANES: usize = 12;
const LAST: usize = BANDS - 1;

/// A sky ready for many evaluations.
#[derive(Clone, Debug)]
pub struct SkyLanes {
    parameters: [[f32; LANES]; PARAMETERS],
    radiance: [f32; LANES],
}

impl SkyLanes {
    pub fn new(sky: &HosekWilkieSky) -> SkyLanes {
        let mut lanes = SkyLanes { parameters: [[0.0; LANES]; PARAMETERS], radiance: [0.0; LANES] };
        for band in 0..BANDS {
            lanes.radiance[band] = sky.radiance[band] as f32;
            for (lane, parameter) in lanes.parameters.iter_mut().zip(&sky.parameters[band]) {
                lane[band] = *parameter as f32;
            }
        }
        lanes
    }

    /// Sky radiance without the disc at 320, 360 … 720 nm; as [`HosekWilkieSky::sky_bands`].
    #[inline]
    pub fn bands(&self, cos_theta: f64, gamma: f64) -> [f32; LANES] {
        if cos_theta < 0.0 {
            return [0.0; LANES];
        }
        let (cos_theta, cos_gamma, gamma) = (cos_theta as f32, gamma.cos() as f32, gamma as f32);
        let (root, above) = (cos_theta.sqrt(), 1.0 / (cos_theta + 0.01));
        let cos2 = cos_gamma * cos_gamma;
        let [a, b, c, d, e, f, g, i, h] = &self.parameters;
        let mut out = [0.0; LANES];
        for k in 0..LANES {
            let horizon = 1.0 + a[k] * exp(b[k] * above);
            let spread = 1.0 + h[k] * h[k] - 2.0 * h[k] * cos_gamma;
            let mie = (1.0 + cos2) / (spread * spread.sqrt());
            let glow = c[k] + d[k] * exp(e[k] * gamma) + f[k] * cos2 + g[k] * mie + i[k] * root;
            out[k] = (horizon * glow * self.radiance[k]).max(0.0);
        }
        out
    }

    /// Sky radiance without the disc at the sampled wavelengths.
    #[inline]
    pub fn sample(&self, cos_theta: f64, gamma: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        if cos_theta < 0.0 {
            return SampledSpectrum::ZERO;
        }
        let bands = self.bands(cos_theta, gamma);
        SampledSpectrum(wavelengths.lambda_nm).map(|lambda_nm| interpolate(&bands, lambda_nm))
    }
}

/// As [`crate::sky::interpolate`].
#[inline]
fn interpolate(bands: &[f32; LANES], lambda_nm: f32) -> f32 {
    let x = (lambda_nm - FIRST_NM as f32) * (1.0 / STEP_NM as f32);
    if x >= LAST as f32 {
        return beyond(bands[LAST - 1], bands[LAST], lambda_nm);
    }
    if x < 0.0 {
        const FADE: f32 = (STEP_NM / (FIRST_NM - OZONE_EDGE_NM)) as f32;
        return bands[0] * (1.0 + x * FADE).max(0.0);
    }
    let i = x as usize;
    bands[i] + (bands[i + 1] - bands[i]) * (x - i as f32)
}

/// The power law through the last two wavelengths.
fn beyond(before: f32, end: f32, lambda_nm: f32) -> f32 {
    const END_NM: f32 = (FIRST_NM + STEP_NM * LAST as f64) as f32;
    if before <= 0.0 || end <= 0.0 {
        return end;
    }
    let exponent = (end / before).ln() / (END_NM / (END_NM - STEP_NM as f32)).ln();
    end * (lambda_nm / END_NM).powf(exponent)
}

/// e^x for x in [-87, 87], clamped to it: 2^n times a polynomial of the remainder (the first terms of its series).
#[inline]
fn exp(x: f32) -> f32 {
    // Adding this rounds to the nearest integer and leaves it in the low bits.
    const ROUND: f32 = 12_582_912.0;
    const LN2_HIGH: f32 = 0.693_359_4;
    const LN2_LOW: f32 = -2.121_944_4e-4;
    let x = x.clamp(-87.0, 87.0);
    let shifted = x * std::f32::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = x - n * LN2_HIGH - n * LN2_LOW;
    let tail = 1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0 + r * (1.0 / 5040.0)));
    let series = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * tail)));
    let power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(1.0f32.to_bits()));
    series * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_is_accurate() {
        for i in -8600..8600 {
            let x = i as f32 * 0.01;
            let exact = f64::from(x).exp();
            assert!((f64::from(exp(x)) / exact - 1.0).abs() < 3e-7, "{x}: {}", exp(x));
        }
        assert!(exp(-1e30) > 0.0 && exp(1e30).is_finite());
    }

    /// Against the double-precision model, relative to the larger of the value and a hundredth of the zenith's.
    #[test]
    fn lanes_agree_with_the_model() {
        for (turbidity, elevation) in [(1.0, 0.0), (3.0, 0.7), (6.5, 1.2), (10.0, 0.1)] {
            let sky = HosekWilkieSky::new(turbidity, 0.4, elevation);
            let lanes = SkyLanes::new(&sky);
            for i in 0..=40 {
                for gamma in [0.0, 0.01, 0.2, 0.9, 2.0, 3.1] {
                    let cos_theta = i as f64 / 40.0;
                    let wavelengths = SampledWavelengths::fixed([310.0, 487.5, 719.0, 800.0]);
                    let sampled = lanes.sample(cos_theta, gamma, &wavelengths).0.to_array();
                    for (lambda, got) in [310.0, 487.5, 719.0, 800.0].into_iter().zip(sampled) {
                        let exact = sky.sky_radiance(cos_theta, gamma, lambda);
                        let scale = exact.max(0.01 * sky.sky_radiance(1.0, 1.0, lambda));
                        assert!((f64::from(got) - exact).abs() < 2e-5 * scale, "{got} instead of {exact} at {lambda}");
                    }
                }
            }
        }
        assert!(SkyLanes::new(&HosekWilkieSky::new(2.0, 0.0, 0.5)).bands(-0.1, 1.0).iter().all(|r| *r == 0.0));
    }
}
