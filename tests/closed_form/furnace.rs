//! White furnaces: in a constant environment of radiance 1, whatever absorbs nothing vanishes.

use arsc_render::bsdf::{MicrofacetShape, Microfacets};
use arsc_render::{Bsdf, Environment, Material};
use arsc_spectral::Spectrum;
use glam::DVec3;

use super::support::{Estimate, Stage, camera, constant, estimate, lambert, render};

/// 48 x 48 pixels, `samples` paths each: a unit sphere that fills the picture from edge to edge and leaves the corners free.
fn furnace(bsdf: Bsdf, samples: u32) -> Estimate {
    let mut stage = Stage::default();
    stage.environments.push(Environment::constant(&constant(1.0)));
    stage.sphere(DVec3::ZERO, 1.0, Material { bsdf, ..Material::default() });
    let camera = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.5, 48);
    estimate(&render(&stage.build(), &camera, samples, 200))
}

/// The bound: a sphere of albedo 1 vanishes to 0.2 %. The estimate is the mean over 147 456 paths.
#[test]
fn a_white_sphere_vanishes() {
    let estimate = furnace(Bsdf::lambert(&constant(1.0)), 64);
    estimate.assert_is(1.0, 5e-4);
    assert!((estimate.mean - 1.0).abs() < 2e-3, "{estimate:?}");
}

#[test]
fn a_perfect_mirror_vanishes() {
    let estimate = furnace(Bsdf::mirror(&constant(1.0)), 4);
    assert!((estimate.mean - 1.0).abs() < 1e-6, "{estimate:?}");
}

/// Dispersive, so that both the choice of the lobe and the loss of wavelengths are part of the balance.
#[test]
fn a_glass_sphere_vanishes() {
    let estimate = furnace(Bsdf::dielectric(&Spectrum::Cauchy { a: 1.5, b_um2: 0.01, c_um4: 0.0 }), 256);
    estimate.assert_is(1.0, 5e-4);
    assert!((estimate.mean - 1.0).abs() < 2e-3, "{estimate:?}");
}

#[test]
fn a_glass_sphere_without_dispersion_vanishes() {
    furnace(Bsdf::dielectric(&constant(1.5)), 64).assert_is(1.0, 5e-4);
}

/// Rough facets lose some light among them, and gain none.
#[test]
fn a_rough_sphere_gains_nothing() {
    for sigma in [0.1, 0.3, 1.0] {
        let Estimate { mean, standard_error } = furnace(Bsdf::oren_nayar(&constant(1.0), sigma), 16);
        assert!(mean < 1.0 + 5.0 * standard_error && mean > 0.7, "sigma {sigma}: {mean}");
    }
}

fn facets(alpha: f64) -> Microfacets {
    Microfacets::new(MicrofacetShape::Ggx, [alpha; 2])
}

/// Rough glass loses what meets a second facet, and gains nothing; as it becomes smooth, it loses nothing either. The
/// dispersive case has a density of its own for every wavelength.
#[test]
fn a_rough_glass_sphere_gains_nothing() {
    let dispersive = Spectrum::Cauchy { a: 1.5, b_um2: 0.02, c_um4: 0.0 };
    for (alpha, ior, least) in [(0.02, constant(1.5), 0.985), (0.3, constant(1.5), 0.7), (0.3, dispersive, 0.7)] {
        let Estimate { mean, standard_error } = furnace(Bsdf::rough_dielectric(&ior, facets(alpha)), 64);
        assert!(mean < 1.0 + 5.0 * standard_error && mean > least, "alpha {alpha}: {mean} +- {standard_error}");
    }
}

/// Panes pass what they do not reflect.
#[test]
fn a_sphere_of_thin_glass_vanishes() {
    furnace(Bsdf::thin_dielectric(&Spectrum::Cauchy { a: 1.5, b_um2: 0.02, c_um4: 0.0 }), 64).assert_is(1.0, 5e-4);
}

/// Rough metal lit by light sampling and by scattered rays at once, against scattered rays alone: the sphere reflects a
/// bright and a dark half of the sky, once as an environment and once as an emissive shell.
#[test]
fn rough_metal_is_the_same_under_any_light() {
    let metal =
        || Material { bsdf: Bsdf::rough_conductor(&constant(0.2), &constant(3.0), facets(0.3)), ..Material::default() };
    let camera = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.3, 32);
    let mut sky = Stage::default();
    sky.environments.push(Environment::constant(&constant(1.0)));
    sky.sphere(DVec3::ZERO, 1.0, metal());
    let mut shell = Stage::default();
    shell.sphere(DVec3::ZERO, 1.0, metal());
    let light = Material {
        bsdf: Bsdf::lambert(&constant(0.0)),
        emitter: Some(arsc_render::AreaEmitter::new(&constant(1.0), true)),
        ..Material::default()
    };
    shell.sphere(DVec3::ZERO, 20.0, light);
    let [a, b] = [sky, shell].map(|stage| estimate(&render(&stage.build(), &camera, 64, 8)));
    let error = (a.standard_error.powi(2) + b.standard_error.powi(2)).sqrt();
    assert!((a.mean - b.mean).abs() < 5.0 * error && error < 2e-3, "{a:?}, {b:?}");
}

/// A closed cavity that emits 1 and reflects 0.6 everywhere: radiance 1 / (1 - 0.6), after any number of reflections.
/// 131 072 paths; 64 events leave 0.6^64 = 6e-15 out.
#[test]
fn a_cavity_fills_with_light() {
    let mut material = lambert(0.6);
    material.emitter = Some(arsc_render::AreaEmitter::new(&constant(1.0), true));
    let mut stage = Stage::default();
    stage.sphere(DVec3::ZERO, 1.0, material);
    let camera = camera(DVec3::new(0.3, 0.2, -0.1), DVec3::X, 1.0, 16);
    estimate(&render(&stage.build(), &camera, 512, 64)).assert_is(2.5, 1e-3);
}
