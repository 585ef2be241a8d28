//! The suite for environments and area lights.

use std::f64::consts::TAU;

use arsc_spectral::{SampledWavelengths, Spectrum};
use glam::DVec3;

use super::{SAMPLES, assert_directions_follow, mean, pair, random};
use crate::light::{Environment, SkySettings};
use crate::polarisation::Unpolarised;

fn wavelengths() -> SampledWavelengths {
    SampledWavelengths::fixed([420.0, 530.0, 600.0, 780.0])
}

/// Directions follow the pdf; radiance over pdf averages to the integral of radiance over the sphere by the
/// midpoint rule.
fn assert_conforms(environment: &Environment) {
    let w = wavelengths();
    let sample = |random: &mut _| environment.sample::<Unpolarised>(pair(random), &w).map(|sample| sample.wi);
    assert_directions_follow("environment", sample, |wi| environment.pdf(wi));
    samples_agree_with_values(environment);
    let n = 1000;
    let mut integral = 0.0;
    for i in 0..2 * n * n {
        let (z, turn) = ((i / n) as f64 + 0.5, (i % n) as f64 + 0.5);
        let z = z / n as f64 - 1.0;
        let (sin, cos) = (TAU * turn / n as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        let radiance = environment.radiance::<Unpolarised>(DVec3::new(r * cos, r * sin, z), &w);
        integral += f64::from(radiance.0.y) * TAU / (n * n) as f64;
    }
    estimates(environment, integral);
}

fn samples_agree_with_values(environment: &Environment) {
    let (mut random, w) = (random(), wavelengths());
    for _ in 0..1000 {
        let Some(sample) = environment.sample::<Unpolarised>(pair(&mut random), &w) else { continue };
        assert!((sample.wi.length() - 1.0).abs() < 1e-12);
        assert_eq!(sample.radiance, environment.radiance::<Unpolarised>(sample.wi, &w));
        assert_eq!(sample.pdf, environment.pdf(sample.wi));
        assert!(sample.radiance.is_valid() && sample.pdf > 0.0);
    }
}

fn estimates(environment: &Environment, integral: f64) {
    let (mut random, w) = (random(), wavelengths());
    let values = (0..SAMPLES).map(|_| {
        let sample = environment.sample::<Unpolarised>(pair(&mut random), &w);
        sample.map_or(0.0, |sample| f64::from(sample.radiance.0.y) / sample.pdf)
    });
    let (mean, error) = mean(values);
    assert!(error < 5e-3 * mean, "no power: {mean} +- {error}");
    assert!((mean - integral).abs() < 5.0 * error + 1e-4 * integral, "{mean} +- {error} instead of {integral}");
}

fn sky(elevation: f64, azimuth: f64, solar_disc: bool) -> Environment {
    let sun = DVec3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin());
    Environment::hosek_wilkie(&SkySettings { turbidity: 3.0, ground_albedo: 0.3, sun, solar_disc, scale: 1.0 })
}

#[test]
fn constant() {
    assert_conforms(&Environment::constant(&Spectrum::Constant(2.5)));
}

#[test]
fn sky_without_disc() {
    for (elevation, azimuth) in [(0.8, 1.0), (0.02, 4.0), (1.57, 0.0), (-0.5, 2.0)] {
        assert_conforms(&sky(elevation, azimuth, false));
    }
}

/// The disc is too small for the grids above: its integral is taken over its own cone.
#[test]
fn sky_with_disc() {
    let (elevation, azimuth) = (0.8, 1.0);
    let (with, without) = (sky(elevation, azimuth, true), sky(elevation, azimuth, false));
    samples_agree_with_values(&with);
    let w = wavelengths();
    let integrate = |environment: &Environment, frame: crate::Frame, cos_max: f64, n: usize| {
        let mut sum = 0.0;
        for i in 0..n * n {
            let u = [i % n, i / n].map(|k| (k as f64 + 0.5) / n as f64);
            let wi = frame.to_world(crate::warp::uniform_cone(u, cos_max));
            sum += f64::from(environment.radiance::<Unpolarised>(wi, &w).0.y);
        }
        sum * TAU * (1.0 - cos_max) / (n * n) as f64
    };
    let sun = DVec3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin());
    let cone = (arsc_spectral::sky::SOLAR_RADIUS * 1.000_001).cos();
    let about_sun = crate::Frame::new(sun);
    let disc = integrate(&with, about_sun, cone, 300) - integrate(&without, about_sun, cone, 300);
    let dome = integrate(&without, crate::Frame::new(DVec3::Z), 0.0, 1000);
    assert!(disc > dome, "a high sun outshines the sky: {disc}, {dome}");
    estimates(&with, disc + dome);
}

#[test]
fn a_sun_below_the_horizon_has_no_disc() {
    let night = sky(-0.1, 0.0, true);
    let sun = DVec3::new((-0.1f64).cos(), 0.0, (-0.1f64).sin());
    assert_eq!(night.radiance::<Unpolarised>(sun, &wavelengths()).max(), 0.0);
    samples_agree_with_values(&night);
}

#[test]
fn a_black_or_broken_sky_is_black() {
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let settings = SkySettings { turbidity: 2.0, ground_albedo: 0.0, sun: DVec3::ZERO, solar_disc: true, scale };
        assert_eq!(Environment::hosek_wilkie(&settings).radiance::<Unpolarised>(DVec3::Z, &wavelengths()).max(), 0.0);
    }
}
