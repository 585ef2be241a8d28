//! Emission seen directly.

use arsc_render::Environment;
use arsc_spectral::{Spectrum, planck};
use glam::DVec3;

use super::support::{Stage, band_means, camera, emitter, render};

/// Mean of Planck's law over a band.
fn band_planck(edges: &[f64], kelvin: f64) -> f64 {
    let n = 64;
    let lambda = |i: usize| edges[0] + (edges[1] - edges[0]) * (i as f64 + 0.5) / n as f64;
    (0..n).map(|i| planck(lambda(i), kelvin)).sum::<f64>() / n as f64
}

/// A glowing sphere fills the picture: every band has Planck's radiance, hence the ratios at two wavelengths and at two
/// temperatures. 65 536 paths put some 1000 wavelengths or more into a band; across it the radiance of 2000 K near
/// 360 nm changes by 60 %, uniformly: the standard error of the mean is 0.6 / sqrt(12 * 1000) = 0.55 % without
/// stratification, with it far less. The bound of 0.3 % is kept with room.
#[test]
fn planck_radiance_in_every_band() {
    for kelvin in [2000.0, 3200.0, 6500.0] {
        let mut stage = Stage::default();
        stage.sphere(DVec3::ZERO, 1.0, emitter(Spectrum::Blackbody { kelvin }));
        let image = render(&stage.build(), &camera(DVec3::new(0.0, -2.0, 0.0), DVec3::ZERO, 0.1, 16), 256, 0);
        for (mean, edges) in band_means(&image).iter().zip(image.band_edges_nm.windows(2)) {
            let exact = band_planck(edges, kelvin);
            assert!((mean / exact - 1.0).abs() < 3e-3, "{kelvin} K, {edges:?} nm: {mean} instead of {exact}");
        }
    }
}

/// An environment of CIE D65 photographs as x = 0.3127, y = 0.3290 and with its luminance, 683 times 106.857 cd m^-2.
/// 65 536 paths; stratified wavelengths leave errors below the bound of 1e-3.
#[test]
fn d65_has_its_white_point_in_the_picture() {
    let mut stage = Stage::default();
    stage.environments.push(Environment::constant(arsc_spectral::d65()));
    let image = render(&stage.build(), &camera(DVec3::ZERO, DVec3::Y, 0.5, 16), 256, 0);
    let mut sum = [0.0; 3];
    for xyz in &image.xyz {
        (0..3).for_each(|c| sum[c] += f64::from(xyz[c]) / image.xyz.len() as f64);
    }
    let [x, y] = arsc_spectral::chromaticity(sum);
    assert!((x - 0.3127).abs() < 1e-3 && (y - 0.3290).abs() < 1e-3, "x = {x}, y = {y}");
    assert!((sum[1] / (683.0 * 106.857) - 1.0).abs() < 1e-3, "Y = {}", sum[1]);
}
