//! Fluorescent surfaces and media against closed forms.
//!
//! Two kinds: integrals of a known bispectral density over a narrow lamp, and *photon furnaces*. In light from everywhere
//! of the spectrum L, matter that absorbs the same share A at every wavelength and emits all photons again with the
//! spectrum L changes nothing: at lambda it takes A L(lambda) and gives the integral of A mu L(mu) dmu times L(lambda) over
//! the integral of L(lambda') lambda' dlambda', which is the same. So it vanishes, however often light is scattered.

use std::f64::consts::PI;

use arsc_accel::Shape;
use arsc_image::SpectralImage;
use arsc_render::{AreaEmitter, Bsdf, Density, Environment, Light, Material, Medium, PathTraceSettings, PhaseFunction};
use arsc_spectral::{Dye, Fluorescence, Observer, Reradiation, Spectrum, WavelengthRange};
use glam::{DAffine3, DVec3};

use super::support::{
    Stage, band_means, camera, constant, estimate, estimate_bands, render, settings, spot_camera, stokes,
};

fn bell(center_nm: f64, sigma_nm: f64, peak: f64) -> Spectrum {
    Spectrum::Gaussian { center_nm, sigma_nm, peak }
}

/// Absorbs blue, emits green.
fn green_dye(absorption: f64, quantum_yield: f64) -> Dye {
    Dye { absorption: bell(450.0, 25.0, absorption), emission: bell(550.0, 30.0, 1.0), quantum_yield }
}

fn painted(reradiation: &Reradiation, sigma: f64) -> Material {
    Material { bsdf: Bsdf::reradiating(reradiation, sigma), ..Material::default() }
}

fn with_dye(reflectance: Spectrum, dye: Dye) -> Reradiation {
    Reradiation { reflectance, fluorescence: Fluorescence::Dye(dye) }
}

fn looking_down() -> arsc_render::Camera {
    spot_camera(DVec3::new(0.0, 0.0, 5.0), DVec3::new(1e-6, 0.0, 0.0))
}

/// The integral of b(mu, lambda) f(mu) dmu over the visible range, in steps of 1 nm.
fn reradiated(dye: &Dye, lambda_nm: f64, f: impl Fn(f64) -> f64) -> f64 {
    // The density is a product of functions of mu and lambda.
    let at = Fluorescence::Dye(dye.clone()).density(450.0, lambda_nm) / (450.0 * dye.absorption.eval(450.0));
    (360..830).map(|mu| f64::from(mu) + 0.5).map(|mu| at * mu * dye.absorption.eval(mu) * f(mu)).sum()
}

/// Mean of a function of wavelength over some bands of a picture.
fn over_bands(image: &SpectralImage, bands: std::ops::Range<usize>, f: impl Fn(f64) -> f64) -> f64 {
    let n = 10 * bands.len();
    let (first, last) = (image.band_edges_nm[bands.start], image.band_edges_nm[bands.end]);
    (0..n).map(|i| f(first + (i as f64 + 0.5) * (last - first) / n as f64)).sum::<f64>() / n as f64
}

/// The lamp's bands, and those of the emission.
const LAMP: std::ops::Range<usize> = 6..13;
const GREEN: std::ops::Range<usize> = 14..26;

/// A narrow lamp straight above a plane: radiance (reflectance E(lambda) + integral of b E) / pi, in the bands of the lamp and in
/// those of the emission; without and with polarisation. 2^19 paths.
#[test]
fn a_narrow_lamp_on_paint() {
    let (lamp, dye) = (bell(450.0, 8.0, 3.0), green_dye(0.6, 0.8));
    let paint = with_dye(constant(0.3), dye.clone());
    let mut stage = Stage::default();
    stage.solid(Shape::HalfSpace, DAffine3::IDENTITY, painted(&paint, 0.0));
    stage.lights.push(Light::distant(-DVec3::Z, &lamp));
    let world = stage.build();
    let image = render(&world, &looking_down(), 8192, 1);
    let exact = |nm: f64| (0.3 * lamp.eval(nm) + reradiated(&dye, nm, |mu| lamp.eval(mu))) / PI;
    estimate_bands(&image, GREEN).assert_is(over_bands(&image, GREEN, exact), 8e-3);
    estimate_bands(&image, LAMP).assert_is(over_bands(&image, LAMP, exact), 8e-3);
    let [s0, s1, s2, s3] = stokes(&world, &looking_down(), 8192, 1);
    assert!((s0 / estimate(&image).mean - 1.0).abs() < 1e-5, "fluorescence is depolarised");
    assert!([s1, s2, s3].iter().all(|s| s.abs() < 1e-9), "{s1} {s2} {s3}");
}

/// Photons that leave by fluorescence over photons that were absorbed are the quantum yield.
#[test]
fn photons_are_counted() {
    for quantum_yield in [1.0, 0.4] {
        let (lamp, dye) = (bell(450.0, 4.0, 3.0), green_dye(0.6, quantum_yield));
        let mut stage = Stage::default();
        stage.solid(Shape::HalfSpace, DAffine3::IDENTITY, painted(&with_dye(constant(0.0), dye.clone()), 0.0));
        stage.lights.push(Light::distant(-DVec3::Z, &lamp));
        let image = render(&stage.build(), &looking_down(), 2048, 1);
        let means = band_means(&image);
        let middle = |band: usize| 0.5 * (image.band_edges_nm[band] + image.band_edges_nm[band + 1]);
        let out: f64 = (0..47).map(|band| PI * means[band] * 10.0 * middle(band)).sum();
        let absorbed: f64 = (360..830).map(f64::from).map(|nm| lamp.eval(nm) * dye.absorption.eval(nm) * nm).sum();
        assert!((out / absorbed - quantum_yield).abs() < 0.01 * quantum_yield, "{}", out / absorbed);
    }
}

/// Inside a sphere whose wall emits blue, reflects r and fluoresces: L = E + r L + B L, so that L(mu) = E(mu) / (1 - r(mu))
/// where nothing is re-radiated to, and (E + integral of b L) / (1 - r) elsewhere. Paths see the wall by light sampling and by
/// scattered rays.
#[test]
fn an_integrating_sphere_with_fluorescent_paint() {
    let (glow, dye) = (bell(440.0, 10.0, 1.0), green_dye(0.5, 0.9));
    let reflectance = 0.4;
    for sigma in [0.0, 1e-9] {
        // The second one goes through the rough model.
        let mut stage = Stage::default();
        let wall = Material {
            emitter: Some(AreaEmitter::new(&glow, true)),
            ..painted(&with_dye(constant(reflectance), dye.clone()), sigma)
        };
        stage.sphere(DVec3::ZERO, 1.0, wall);
        let view = camera(DVec3::new(0.1, 0.2, 0.0), DVec3::new(1.0, 0.0, 0.3), 1.0, 16);
        let image = render(&stage.build(), &view, 256, 400);
        let blue = |mu: f64| glow.eval(mu) / (1.0 - reflectance);
        // Green light excites a little as well: two more rounds leave less than 1e-4.
        let first = |nm: f64| (glow.eval(nm) + reradiated(&dye, nm, blue)) / (1.0 - reflectance);
        let table: Vec<f64> = (360..=830).map(|nm| first(f64::from(nm))).collect();
        let at = |table: &[f64], nm: f64| {
            let i = ((nm - 360.0) as usize).min(469);
            table[i] + (table[i + 1] - table[i]) * (nm - 360.0 - i as f64)
        };
        let next = |table: &[f64]| -> Vec<f64> {
            let excited = |nm: f64| (glow.eval(nm) + reradiated(&dye, nm, |mu| at(table, mu))) / (1.0 - reflectance);
            (360..=830).map(|nm| excited(f64::from(nm))).collect()
        };
        let exact = next(&next(&table));
        for bands in [GREEN, LAMP] {
            let mean = over_bands(&image, bands.clone(), |nm| at(&exact, nm));
            estimate_bands(&image, bands).assert_is(mean, 1.2e-2);
        }
    }
}

/// The spectrum of the photon furnaces, dark at the ends of the range.
fn furnace_light() -> Spectrum {
    bell(570.0, 55.0, 1.0)
}

/// Mean over all bands of the furnace's light.
fn furnace_mean() -> f64 {
    (3600..8300).map(|i| furnace_light().eval(f64::from(i) * 0.1 + 0.05)).sum::<f64>() / 4700.0
}

/// Paint that reflects a quarter and re-radiates the rest.
#[test]
fn a_photon_furnace_of_paint() {
    let dye = Dye { absorption: constant(0.75), emission: furnace_light(), quantum_yield: 1.0 };
    let mut stage = Stage::default();
    stage.environments.push(Environment::constant(&furnace_light()));
    stage.sphere(DVec3::ZERO, 1.0, painted(&with_dye(constant(0.25), dye), 0.0));
    let view = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.5, 32);
    estimate(&render(&stage.build(), &view, 256, 100)).assert_is(furnace_mean(), 4e-3);
}

/// Dyes in a sphere: with and without an interface and scattering, by every density.
#[test]
fn photon_furnaces_of_media() {
    let densities = [
        Density::Uniform,
        Density::Gaussian { center: DVec3::new(0.3, 0.0, 0.0), sigma: 0.5 },
        Density::Exponential { ground: -0.5, height: 0.4 },
    ];
    for (i, density) in densities.into_iter().enumerate() {
        for scattering in [0.0, 1.5] {
            let dye = Dye { absorption: constant(0.6), emission: furnace_light(), quantum_yield: 1.0 };
            let phase = PhaseFunction::HenyeyGreenstein { g: 0.5 };
            let medium = Medium::new(&constant(0.0), &constant(scattering), &constant(0.0), phase, density);
            let glass = Bsdf::dielectric(&Spectrum::Cauchy { a: 1.3, b_um2: 0.01, c_um4: 0.0 });
            let bsdf = if i == 1 { glass } else { Bsdf::Inert };
            let mut stage = Stage::default();
            stage.media.media = vec![medium.with_dyes(&[dye])];
            stage.sphere(DVec3::ZERO, 1.0, Material { bsdf, medium: Some(0), ..Material::default() });
            stage.environments.push(Environment::constant(&furnace_light()));
            let view = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.5, 16);
            estimate(&render(&stage.build(), &view, 1024, 300)).assert_is(furnace_mean(), 3e-2);
        }
    }
}

/// Sunlight of one colour straight down into a layer with dye: at emission wavelengths, where the layer absorbs a(lambda),
/// radiance upwards is the integral over mu of b(mu, lambda) E(mu) / (4 pi) (1 - exp(-s d)) / s, s being the dye's absorption at mu, that at
/// lambda, and twice a.
#[test]
fn a_layer_with_dye() {
    let (sun, dye, depth) = (bell(440.0, 8.0, 5.0), green_dye(2.0, 0.7), 1.5);
    let absorption = 0.3;
    let phase = PhaseFunction::Isotropic;
    let medium = Medium::new(&constant(absorption), &constant(0.0), &constant(0.0), phase, Density::Uniform);
    let mut stage = Stage::default();
    stage.media.media = vec![medium.with_dyes(std::slice::from_ref(&dye))];
    let slab = Shape::Box { min: DVec3::new(-50.0, -50.0, -depth), max: DVec3::new(50.0, 50.0, 0.0) };
    let inert = Material { bsdf: Bsdf::Inert, medium: Some(0), ..Material::default() };
    stage.solid(slab, DAffine3::IDENTITY, inert);
    stage.lights.push(Light::distant(-DVec3::Z, &sun));
    let image = render(&stage.build(), &looking_down(), 16384, 1);
    let exact = |nm: f64| {
        reradiated(&dye, nm, |mu| {
            let s = dye.absorption.eval(mu) + dye.absorption.eval(nm) + 2.0 * absorption;
            sun.eval(mu) / (4.0 * PI) * (1.0 - (-s * depth).exp()) / s
        })
    };
    estimate_bands(&image, GREEN).assert_is(over_bands(&image, GREEN, exact), 3e-2);
}

/// Ultraviolet light excites where it is rendered, and else does not exist.
#[test]
fn ultraviolet_excites_if_it_is_rendered() {
    let dye = Dye { absorption: bell(335.0, 10.0, 0.9), emission: bell(440.0, 20.0, 1.0), quantum_yield: 0.9 };
    let paint = with_dye(constant(0.0), dye.clone());
    let lamp = bell(335.0, 6.0, 1.0);
    let mut stage = Stage::default();
    stage.solid(Shape::HalfSpace, DAffine3::IDENTITY, painted(&paint, 0.0));
    stage.lights.push(Light::distant(-DVec3::Z, &lamp));
    let world = stage.build();
    let image_of = |min: f64| {
        let wavelengths = WavelengthRange::new(min, 830.0).unwrap();
        let bands = arsc_render::Bands::over(&WavelengthRange::VISIBLE, 10.0, Observer::Cie1931);
        let chosen = PathTraceSettings { wavelengths, bands, ..settings(1024, 1) };
        arsc_render::path_trace(&world, &looking_down(), &chosen, &()).to_image()
    };
    let blue = 4..12;
    let density = |nm: f64| Fluorescence::Dye(dye.clone()).density(335.0, nm) / (335.0 * 0.9);
    let excited: f64 = (300..400).map(f64::from).map(|mu| mu * dye.absorption.eval(mu) * lamp.eval(mu)).sum();
    let image = image_of(300.0);
    estimate_bands(&image, blue.clone()).assert_is(over_bands(&image, blue, |nm| density(nm) * excited / PI), 1e-2);
    assert!(estimate(&image_of(380.0)).mean < 1e-9);
}
