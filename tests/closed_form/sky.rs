//! A floor under the sky.

use std::f64::consts::{PI, TAU};

use arsc_accel::SurfaceShape;
use arsc_render::polarisation::Unpolarised;
use arsc_render::{Environment, Frame, SkySettings, warp};
use arsc_spectral::{SampledWavelengths, sky::SOLAR_RADIUS};
use glam::{DAffine3, DVec3};

use super::support::{Stage, estimate, lambert, render, spot_camera};

const SUN: DVec3 = DVec3::new(0.3, 0.5, 0.6);

fn sky(solar_disc: bool) -> Environment {
    let settings = SkySettings { ground_albedo: 0.3, sun: SUN, solar_disc, ..SkySettings::default() };
    Environment::sky(&settings)
}

/// Irradiance on the floor from directions given by a map of the unit square with constant density, mean of 360 to 830 nm
/// by the midpoints of 24 bands.
fn irradiance(environment: &Environment, n: usize, pdf: f64, direction: impl Fn([f64; 2]) -> DVec3) -> f64 {
    let middle = |band: usize| 360.0 + 470.0 * (band as f64 + 0.5) / 24.0;
    let bands: Vec<SampledWavelengths> =
        (0..6).map(|i| SampledWavelengths::fixed(std::array::from_fn(|k| middle(4 * i + k)))).collect();
    let mut sum = 0.0;
    for i in 0..n * n {
        let wi = direction([i % n, i / n].map(|k| (k as f64 + 0.5) / n as f64));
        let radiance: f64 = bands.iter().map(|w| f64::from(environment.radiance::<Unpolarised>(wi, w).mean())).sum();
        sum += wi.z * radiance / bands.len() as f64;
    }
    sum / (n * n) as f64 / pdf
}

/// Sky and sun against quadrature over the dome and over the disc; 65 536 paths. Quadratures change by 2e-5 when refined twofold.
#[test]
fn irradiance_of_sky_and_sun() {
    let dome = irradiance(&sky(false), 400, 1.0 / TAU, |u| warp::uniform_cone(u, 0.0));
    let (about_sun, cos_radius) = (Frame::new(SUN.normalize()), (SOLAR_RADIUS * 1.01).cos());
    let cone_pdf = 1.0 / (TAU * (1.0 - cos_radius));
    let cone = |u| about_sun.to_world(warp::uniform_cone(u, cos_radius));
    let disc = irradiance(&sky(true), 200, cone_pdf, cone) - irradiance(&sky(false), 200, cone_pdf, cone);
    for (solar_disc, exact) in [(false, dome), (true, dome + disc)] {
        let mut stage = Stage::default();
        stage.environments.push(sky(solar_disc));
        stage.surface(SurfaceShape::Plane, DAffine3::IDENTITY, lambert(0.8));
        let camera = spot_camera(DVec3::new(1.0, -4.0, 0.7), DVec3::ZERO);
        estimate(&render(&stage.build(), &camera, 1024, 1)).assert_is(0.8 * exact / PI, 1e-3);
    }
}
