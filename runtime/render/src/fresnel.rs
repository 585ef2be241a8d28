//! Reflectance of smooth interfaces for unpolarised light.
//!
//! Fresnel's equations; for conductors with complex index eta + i k, k >= 0 (Born and Wolf, section 14.2). Light comes
//! from vacuum or from a transparent medium with real index.

use arsc_spectral::SampledSpectrum;

/// Dielectric: `cos_i` in [0, 1], `eta` the index beyond the interface over the index before it. Gives the
/// reflectance and the cosine of the refracted ray (zero for total reflection, where the reflectance is 1).
#[inline]
pub fn dielectric(cos_i: f64, eta: f64) -> (f64, f64) {
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if sin2_t >= 1.0 {
        return (1.0, 0.0);
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    (0.5 * (parallel * parallel + perpendicular * perpendicular), cos_t)
}

/// Conductor against vacuum: `cos_i` in [0, 1], index `eta` + i `k`.
#[inline]
pub fn conductor(cos_i: f32, eta: SampledSpectrum, k: SampledSpectrum) -> SampledSpectrum {
    let cos2 = cos_i * cos_i;
    let sin2 = 1.0 - cos2;
    let splat = SampledSpectrum::splat;
    let (eta2, k2) = (eta * eta, k * k);
    let t0 = eta2 - k2 - splat(sin2);
    let a2_plus_b2 = (t0 * t0 + eta2 * k2 * 4.0).sqrt();
    let t1 = a2_plus_b2 + splat(cos2);
    let a = ((a2_plus_b2 + t0) * 0.5).map(|x| x.max(0.0)).sqrt();
    let t2 = a * (2.0 * cos_i);
    let perpendicular = (t1 - t2) / (t1 + t2);
    let t3 = a2_plus_b2 * cos2 + splat(sin2 * sin2);
    let t4 = t2 * sin2;
    let parallel = perpendicular * ((t3 - t4) / (t3 + t4));
    ((perpendicular + parallel) * 0.5).map(|r| r.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_reflects_four_percent_at_normal_incidence() {
        let (r, cos_t) = dielectric(1.0, 1.5);
        assert!((r - 0.04).abs() < 1e-15 && cos_t == 1.0);
        assert!((dielectric(1.0, 1.0 / 1.5).0 - r).abs() < 1e-15);
    }

    /// At Brewster's angle the parallel component vanishes: R = ((eta^2 - 1) / (eta^2 + 1))^2 / 2.
    #[test]
    fn brewsters_angle() {
        let eta = 1.5f64;
        let cos = (1.0 / (1.0 + eta * eta)).sqrt();
        let expected = 0.5 * ((eta * eta - 1.0) / (eta * eta + 1.0)).powi(2);
        assert!((dielectric(cos, eta).0 - expected).abs() < 1e-15);
    }

    /// Both ways through an interface the reflectance is the same at corresponding angles; beyond the critical angle it
    /// is 1, at grazing incidence as well.
    #[test]
    fn reflectance_is_reciprocal_and_total() {
        for i in 1..100 {
            let cos_i = f64::from(i) / 100.0;
            let (r, cos_t) = dielectric(cos_i, 1.5);
            assert!((dielectric(cos_t, 1.0 / 1.5).0 - r).abs() < 1e-12);
        }
        assert_eq!(dielectric(0.74, 1.0 / 1.5), (1.0, 0.0));
        assert!((dielectric(0.0, 1.5).0 - 1.0).abs() < 1e-15);
        assert!(dielectric(0.3, 1.0).0 < 1e-30);
    }

    #[test]
    fn a_conductor_without_absorption_is_a_dielectric() {
        for i in 0..=20 {
            let cos = i as f32 / 20.0;
            let metal = conductor(cos, SampledSpectrum::splat(1.5), SampledSpectrum::ZERO).hero();
            assert!((f64::from(metal) - dielectric(f64::from(cos), 1.5).0).abs() < 1e-6, "{cos}: {metal}");
        }
    }

    /// Normal incidence: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2). Gold at 589.3 nm (Johnson and Christy).
    #[test]
    fn gold_at_normal_incidence() {
        let (eta, k) = (0.2734f32, 2.948f32);
        let expected = ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
        let r = conductor(1.0, SampledSpectrum::splat(eta), SampledSpectrum::splat(k)).hero();
        assert!((r - expected).abs() < 1e-6, "{r} instead of {expected}");
        assert!((conductor(0.0, SampledSpectrum::splat(eta), SampledSpectrum::splat(k)).hero() - 1.0).abs() < 1e-6);
    }
}
