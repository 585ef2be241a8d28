//! The suite for phase functions.

use glam::DVec3;

use super::{assert_directions_follow, mean, pair, random};
use crate::phase::PhaseFunction;
use crate::polarisation::{MuellerSpectrum, Polarised};

fn directions() -> [DVec3; 4] {
    [DVec3::Z, -DVec3::Z, DVec3::new(0.6, -0.8, 0.0), DVec3::new(0.3, 0.5, -0.7).normalize()]
}

fn assert_conforms(phase: PhaseFunction) {
    for wo in directions() {
        let name = format!("{phase:?} at {wo}");
        assert_directions_follow(&name, |random| Some(phase.sample(wo, pair(random))), |wi| phase.pdf(wo, wi));
        is_reciprocal_and_physical(phase, wo);
    }
}

/// The matrix has 1 in its corner, and turns no light into more than wholly polarised light.
fn is_reciprocal_and_physical(phase: PhaseFunction, wo: DVec3) {
    let mut random = random();
    for _ in 0..1000 {
        let wi = phase.sample(wo, pair(&mut random));
        assert!((wi.length() - 1.0).abs() < 1e-9);
        assert!((phase.pdf(wo, wi) / phase.pdf(wi, wo) - 1.0).abs() < 1e-9, "{phase:?}");
        let MuellerSpectrum { m, .. } = phase.weight::<Polarised>(wo, wi);
        assert_eq!(m[0][0].hero(), 1.0);
        for s in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, -0.8]] {
            let out: Vec<f32> =
                m.iter().map(|r| r[0].hero() + (0..3).map(|i| r[i + 1].hero() * s[i]).sum::<f32>()).collect();
            let polarised = (out[1] * out[1] + out[2] * out[2] + out[3] * out[3]).sqrt();
            assert!(polarised <= out[0] + 1e-5, "{phase:?}: {s:?} becomes {out:?}");
        }
    }
}

#[test]
fn phase_functions() {
    assert_conforms(PhaseFunction::Isotropic);
    // Beyond, the suite's midpoint rule is too coarse for the peak.
    for g in [-0.6, -0.3, 1e-5, 0.4, 0.6] {
        assert_conforms(PhaseFunction::HenyeyGreenstein { g });
    }
    for depolarisation in [0.0, 0.03, 0.5] {
        assert_conforms(PhaseFunction::Rayleigh { depolarisation });
    }
}

/// g is the mean cosine. 20 000 samples, five standard errors.
#[test]
fn henyey_greenstein_has_its_mean_cosine() {
    for g in [-0.6, 1e-7, 0.2, 0.9] {
        let (mut random, wo) = (random(), DVec3::new(0.0, 0.6, 0.8));
        let phase = PhaseFunction::HenyeyGreenstein { g };
        let (mean, error) = mean((0..20_000).map(|_| -wo.dot(phase.sample(wo, pair(&mut random)))));
        assert!((mean - g).abs() < 5.0 * error, "{mean} +- {error} instead of {g}");
    }
}
