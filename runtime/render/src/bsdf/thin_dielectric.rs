//! A thin pane of clear glass: both of its interfaces at once, light goes straight through.
//!
//! Between the two interfaces light is reflected to and fro without interference: for each of s and p the pane reflects
//! R + T R T + T R^3 T + … = 2 R / (1 + R). Products of amplitudes add up the same way. No wavelength is lost to
//! dispersion, as nothing is bent.

use arsc_spectral::{DenseSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::{BsdfSample, index_of_glass};
use crate::fresnel::{self, Interface};
use crate::polarisation::{Mueller, Polarisation, s_axis};

#[derive(Clone, Debug)]
pub struct ThinDielectric {
    ior: DenseSpectrum,
}

/// Elements a, b, c, s of the pane's reflection and transmission.
fn pane(cos: f64, index: f64) -> [[f64; 4]; 2] {
    let interface = Interface::new(cos, index);
    let (rs, rp) = (2.0 * interface.rs / (1.0 + interface.rs), 2.0 * interface.rp / (1.0 + interface.rp));
    let reflection = interface.reflection();
    let [_, _, c, s] = reflection;
    if s != 0.0 || interface.cos_t == 0.0 {
        return [reflection, [0.0; 4]]; // total
    }
    let through = (1.0 - interface.rs) * (1.0 - interface.rp) / (1.0 - c * c);
    let reflected = [0.5 * (rs + rp), 0.5 * (rs - rp), c + c * through, 0.0];
    [reflected, [1.0 - 0.5 * (rs + rp), 0.5 * (rp - rs), through, 0.0]]
}

impl ThinDielectric {
    pub(super) fn new(ior: &Spectrum) -> ThinDielectric {
        ThinDielectric { ior: index_of_glass(ior) }
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u_lobe: f64,
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        if wo.z == 0.0 {
            return None;
        }
        let cos = wo.z.abs().min(1.0);
        let index = self.ior.sample(wavelengths).0.to_array();
        let reflectance = pane(cos, f64::from(index[0]))[0][0];
        let lobe = usize::from(u_lobe >= reflectance);
        let probability = if lobe == 0 { reflectance } else { 1.0 - reflectance };
        let effect = fresnel::gather(|lane| pane(cos, f64::from(index[lane]))[lobe], 1.0 / probability);
        let sample = if lobe == 0 {
            BsdfSample::specular_reflection(wo, &effect)
        } else {
            let weight = P::Mueller::diattenuating_retarder(&effect, s_axis(DVec3::Z, wo), wo, -wo);
            BsdfSample::straight(wo, weight)
        };
        Some(BsdfSample { path_pdf: effect.a, ..sample })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The series written out, for s and p, and for the products of amplitudes.
    #[test]
    fn panes_are_sums_of_reflections() {
        for cos in [0.1, 0.5, 0.9] {
            let one = Interface::new(cos, 1.5);
            let [r, t] = [one.reflection(), one.refraction()];
            let (mut reflected, mut transmitted) = (r, [0.0; 4]);
            // Blocks with s = 0 commute: products within (a + b, a - b) and within c.
            let times = |x: [f64; 4], y: [f64; 4]| {
                let [p, q] = [(x[0] + x[1]) * (y[0] + y[1]), (x[0] - x[1]) * (y[0] - y[1])];
                [0.5 * (p + q), 0.5 * (p - q), x[2] * y[2], 0.0]
            };
            let mut inside = times(t, t);
            for _ in 0..200 {
                (0..4).for_each(|i| transmitted[i] += inside[i]);
                inside = times(inside, r);
                (0..4).for_each(|i| reflected[i] += inside[i]);
                inside = times(inside, r);
            }
            let [found_r, found_t] = pane(cos, 1.5);
            for i in 0..4 {
                assert!((found_r[i] - reflected[i]).abs() < 1e-12, "{cos}: {found_r:?}, {reflected:?}");
                assert!((found_t[i] - transmitted[i]).abs() < 1e-12, "{cos}: {found_t:?}, {transmitted:?}");
            }
        }
    }
}
