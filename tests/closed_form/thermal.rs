//! Emission seen directly.

use arsc_render::bsdf::{MicrofacetShape, Microfacets};
use arsc_render::{AreaEmitter, Bands, Bsdf, Environment, Material, PathTraceSettings, path_trace};
use arsc_spectral::{Observer, Spectrum, WavelengthRange, planck};
use glam::DVec3;

use super::support::{Stage, band_means, camera, constant, emitter, render, settings, stokes};

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

/// The same over other ranges and bands, the near ultraviolet and infrared included; and through strongly dispersive glass
/// inside a white furnace, where all wavelengths but the hero are dropped on the way, every band keeps its radiance. Bands of
/// the glowing sphere as above. In the furnace the light is the same in all directions: a path gives it in each wavelength
/// that it kept, times four after dispersion, so that a band's some 500 samples of mean 1 have a standard deviation below
/// sqrt(3), their ratio of sums below 0.08; 5 standard errors of the mean of 47 bands stay below 0.06 (false alarm 6e-7).
#[test]
fn any_range_of_wavelengths_is_rendered_without_bias() {
    let view = camera(DVec3::new(0.0, -2.0, 0.0), DVec3::ZERO, 0.1, 16);
    for (min, max, band_nm, observer) in [
        (300.0, 830.0, 10.0, Observer::Cie1931),
        (380.0, 700.0, 40.0, Observer::Cie2015Deg10),
        (850.0, 1100.0, 25.0, Observer::Cie1931),
    ] {
        let wavelengths = WavelengthRange::new(min, max).unwrap();
        let bands = Bands::over(&wavelengths, band_nm, observer);
        let chosen = PathTraceSettings { wavelengths, bands, ..settings(256, 0) };
        let mut stage = Stage::default();
        stage.sphere(DVec3::ZERO, 1.0, emitter(Spectrum::Blackbody { kelvin: 4000.0 }));
        let mut world = stage.build();
        world.weigh_lights(&wavelengths);
        let image = path_trace(&world, &view, &chosen, &()).to_image();
        assert_eq!((image.band_edges_nm[0], *image.band_edges_nm.last().unwrap()), (min, max));
        for (mean, edges) in band_means(&image).iter().zip(image.band_edges_nm.windows(2)) {
            let exact = band_planck(edges, 4000.0);
            assert!((mean / exact - 1.0).abs() < 3e-3, "{edges:?} nm: {mean} instead of {exact}");
        }

        let mut stage = Stage::default();
        let glass = Bsdf::dielectric(&Spectrum::Cauchy { a: 1.5, b_um2: 0.02, c_um4: 0.0 });
        stage.sphere(DVec3::ZERO, 1.0, Material { bsdf: glass, ..Material::default() });
        stage.environments.push(Environment::constant(&constant(1.0)));
        let chosen = PathTraceSettings { max_depth: 100, ..chosen };
        let image = path_trace(&stage.build(), &view, &chosen, &()).to_image();
        let means = band_means(&image);
        let mean = means.iter().sum::<f64>() / means.len() as f64;
        assert!((mean - 1.0).abs() < 0.02, "{min} to {max} nm: {mean}");
        assert!(means.iter().all(|band| (band - 1.0).abs() < 0.06), "{min} to {max} nm: {means:?}");
    }
}

/// Kirchhoff's law: what glows vanishes in surroundings of its own temperature, and looks unpolarised, though both what it
/// emits and what it reflects are polarised. Metal, smooth and rough (whose table is good to 3e-3), and paint.
#[test]
fn what_glows_vanishes_in_equilibrium() {
    let facets = Microfacets::new(MicrofacetShape::Ggx, [0.3; 2]);
    for (bsdf, bound) in [
        (Bsdf::conductor(&constant(2.0), &constant(3.0)), 1e-5),
        (Bsdf::rough_conductor(&constant(2.0), &constant(3.0), facets), 3e-3),
        (Bsdf::lambert(&constant(0.6)), 1e-3),
    ] {
        let mut stage = Stage::default();
        stage.environments.push(Environment::constant(&constant(1.0)));
        let emitter = Some(AreaEmitter::thermal(&constant(1.0), false, &bsdf));
        stage.sphere(DVec3::ZERO, 1.0, Material { bsdf, emitter, ..Material::default() });
        let camera = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.45, 32);
        let [s0, s1, s2, s3] = stokes(&stage.build(), &camera, 64, 50);
        assert!((s0 - 1.0).abs() < bound, "{s0}");
        assert!([s1, s2, s3].iter().all(|s| s.abs() < bound), "{s1}, {s2}, {s3}");
    }
}
