//! Participating media and nested dielectrics against closed forms.

use arsc_accel::{Shape, SurfaceShape};
use arsc_render::{Bsdf, Density, Environment, Light, Material, Medium, PhaseFunction};
use arsc_spectral::Spectrum;
use glam::{DAffine3, DVec3};

use super::support::{
    Stage, camera, constant, emitter, estimate, estimate_bands, facing_down, lambert, render, spot_camera, stokes,
};

fn medium(absorption: Spectrum, scattering: Spectrum, phase: PhaseFunction, density: Density) -> Medium {
    Medium::new(&absorption, &scattering, &constant(0.0), phase, density)
}

fn uniform(absorption: f64, scattering: f64) -> Medium {
    medium(constant(absorption), constant(scattering), PhaseFunction::Isotropic, Density::Uniform)
}

/// Filled with the stage's only medium, without an interface.
fn inert() -> Material {
    Material { bsdf: Bsdf::Inert, medium: Some(0), ..Material::default() }
}

fn glass(ior: f64) -> Material {
    Material { bsdf: Bsdf::dielectric(&constant(ior)), ..Material::default() }
}

fn slab(thickness: f64) -> Shape {
    Shape::Box { min: DVec3::new(-50.0, -50.0, -thickness), max: DVec3::new(50.0, 50.0, 0.0) }
}

/// Straight down through z = 0.
fn looking_down() -> arsc_render::Camera {
    spot_camera(DVec3::new(0.0, 0.0, 5.0), DVec3::new(1e-6, 0.0, 0.0))
}

/// Extinction as a function of wavelength.
fn coloured(violet: f64, red: f64) -> Spectrum {
    Spectrum::Tabulated { lambda_nm: vec![360.0, 830.0].into(), values: vec![violet, red].into() }
}

/// Light behind an absorbing slab: exp(-sigma d) in every band, without noise beyond the widths of the bands.
#[test]
fn beer_lambert() {
    let sigma = coloured(0.2, 1.4);
    let mut stage = Stage::default();
    stage.media.media = vec![medium(sigma.clone(), constant(0.0), PhaseFunction::Isotropic, Density::Uniform)];
    stage.solid(slab(1.5), DAffine3::IDENTITY, inert());
    let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, -3.0));
    stage.surface(SurfaceShape::Disk { radius: 1.0 }, place, emitter(constant(2.0)));
    let image = render(&stage.build(), &looking_down(), 512, 2);
    for group in [0..12, 12..30, 30..47] {
        let exact = group
            .clone()
            .map(|band: usize| {
                let lambda = 0.5 * (image.band_edges_nm[band] + image.band_edges_nm[band + 1]);
                2.0 * (-1.5 * sigma.eval(lambda)).exp()
            })
            .sum::<f64>()
            / group.len() as f64;
        let mean = estimate_bands(&image, group).mean;
        assert!((mean / exact - 1.0).abs() < 2e-3, "{mean} instead of {exact}");
    }
}

/// An absorbing atmosphere between a point light, a plane and the camera: each stretch takes its share.
#[test]
fn light_and_camera_inside_an_absorbing_medium() {
    let sigma = 0.3;
    let mut stage = Stage::default();
    stage.media.media = vec![uniform(sigma, 0.0)];
    stage.media.atmosphere = Some(0);
    stage.solid(Shape::HalfSpace, DAffine3::IDENTITY, lambert(0.6));
    stage.lights.push(Light::point(DVec3::new(0.0, 0.0, 2.0), &constant(7.0)));
    let mean = estimate(&render(&stage.build(), &looking_down(), 64, 2)).mean;
    let exact = 0.6 / std::f64::consts::PI * 7.0 / 4.0 * (-sigma * (2.0 + 5.0)).exp();
    assert!((mean / exact - 1.0).abs() < 1e-5, "{mean} instead of {exact}");
}

/// A glowing slab: B (1 - exp(-sigma d)), whatever the density's shape, as a whole without noise.
#[test]
fn emissive_slab() {
    for density in [Density::Uniform, Density::Exponential { ground: -1.0, height: 0.4 }] {
        let mut stage = Stage::default();
        let zero = constant(0.0);
        let glow = Medium::new(&constant(1.3), &zero, &constant(3.0), PhaseFunction::Isotropic, density);
        stage.media.media = vec![glow];
        stage.solid(slab(2.0), DAffine3::IDENTITY, inert());
        let mean = estimate(&render(&stage.build(), &looking_down(), 16, 2)).mean;
        let depth = match density {
            Density::Uniform => 2.0,
            _ => 1.0 + 0.4 * (1.0 - (-1.0f64 / 0.4).exp()),
        };
        let exact = 3.0 * (1.0 - (-1.3f64 * depth).exp());
        assert!((mean / exact - 1.0).abs() < 1e-5, "{mean} instead of {exact}");
    }
}

/// Sunlight straight down, scattered once straight up: E / (4 pi) sigma_s / (2 sigma_t) (1 - exp(-2 sigma_t d)), here with
/// extinction and albedo that depend on wavelength, so that the four wavelengths of a path differ. 2^18 paths.
#[test]
fn single_scattering() {
    let (absorption, scattering) = (coloured(0.1, 0.9), coloured(2.0, 0.2));
    let mut stage = Stage::default();
    stage.media.media =
        vec![medium(absorption.clone(), scattering.clone(), PhaseFunction::Isotropic, Density::Uniform)];
    stage.solid(slab(1.0), DAffine3::IDENTITY, inert());
    stage.lights.push(Light::distant(-DVec3::Z, &constant(10.0)));
    let image = render(&stage.build(), &looking_down(), 4096, 1);
    for group in [0..12, 12..30, 30..47] {
        let exact = group
            .clone()
            .map(|band: usize| {
                let lambda = 0.5 * (image.band_edges_nm[band] + image.band_edges_nm[band + 1]);
                let (a, s) = (absorption.eval(lambda), scattering.eval(lambda));
                10.0 / (4.0 * std::f64::consts::PI) * s / (2.0 * (a + s)) * (1.0 - (-2.0 * (a + s)).exp())
            })
            .sum::<f64>()
            / group.len() as f64;
        estimate_bands(&image, group).assert_is(exact, 4e-3);
    }
}

/// In light from everywhere, matter that absorbs nothing is invisible: radiance 1, by every density and phase function,
/// with coloured extinction. 2^15 paths each.
#[test]
fn white_furnaces() {
    let sphere = Shape::Sphere { radius: 1.0 };
    let densities = [
        Density::Uniform,
        Density::Gaussian { center: DVec3::new(0.3, 0.0, 0.0), sigma: 0.5 },
        Density::Exponential { ground: -0.5, height: 0.4 },
    ];
    let phases = [
        PhaseFunction::Isotropic,
        PhaseFunction::HenyeyGreenstein { g: 0.7 },
        PhaseFunction::Rayleigh { depolarisation: 0.1 },
    ];
    for (i, density) in densities.into_iter().enumerate() {
        for (j, phase) in phases.into_iter().enumerate() {
            let bsdf = if (i + j) % 2 == 0 { Bsdf::Inert } else { Bsdf::dielectric(&constant(1.33)) };
            let mut stage = Stage::default();
            stage.media.media = vec![medium(constant(0.0), coloured(4.0, 0.5), phase, density)];
            let material = Material { bsdf, medium: Some(0), ..Material::default() };
            stage.solid(sphere.clone(), DAffine3::IDENTITY, material);
            stage.environments.push(Environment::constant(&constant(1.0)));
            let image = render(&stage.build(), &looking_down(), 512, 2000);
            estimate(&image).assert_is(1.0, 2e-2);
        }
    }
}

/// Chandrasekhar's H function for isotropic scattering (Radiative Transfer, 1960, section 37), by iteration.
fn h_function(albedo: f64) -> impl Fn(f64) -> f64 {
    const N: usize = 100;
    let point = |i: usize| (i as f64 + 0.5) / N as f64;
    let next = move |h: &[f64; N], mu: f64| {
        let sum: f64 = (0..N).map(|i| point(i) * h[i] / (mu + point(i))).sum::<f64>() / N as f64;
        1.0 / ((1.0 - albedo).sqrt() + 0.5 * albedo * sum)
    };
    let mut h = [1.0; N];
    for _ in 0..300 {
        h = std::array::from_fn(|i| 0.5 * (h[i] + next(&h, point(i))));
    }
    move |mu| next(&h, mu)
}

/// Table XI of the book: H(1) is 2.9078 for albedo 1; and the integral of H is 2 / albedo (1 - sqrt(1 - albedo)) (section
/// 38, equation 5).
#[test]
fn h_functions_are_chandrasekhars() {
    let h = h_function(0.999_999);
    assert!((h(1.0) - 2.9078).abs() < 1e-2, "{}", h(1.0));
    let (n, h) = (20, h_function(0.8));
    let integral = (0..n).map(|i| h((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n);
    let exact = 2.0 / 0.8 * (1.0 - 0.2f64.sqrt());
    assert!((integral / exact - 1.0).abs() < 2e-3, "{integral} {exact}");
}

/// All orders of scattering: the radiance of a deep layer in sunlight, albedo / (4 pi) E mu0 / (mu + mu0) H(mu) H(mu0).
/// 2^17 paths.
#[test]
fn deep_layer() {
    let albedo = 0.8;
    let mut stage = Stage::default();
    stage.media.media = vec![uniform(1.0 - albedo, albedo)];
    stage.solid(Shape::HalfSpace, DAffine3::IDENTITY, inert());
    let mu0: f64 = 0.5;
    let sun = DVec3::new((1.0 - mu0 * mu0).sqrt(), 0.0, mu0);
    stage.lights.push(Light::distant(-sun, &constant(10.0)));
    let image = render(&stage.build(), &looking_down(), 2048, 1000);
    let h = h_function(albedo);
    let h = h(1.0) * h(mu0);
    let exact = albedo / (4.0 * std::f64::consts::PI) * 10.0 * mu0 / (1.0 + mu0) * h;
    estimate(&image).assert_is(exact, 6e-3);
}

/// A lamp is found by light sampling and by scattering: inside of a medium the two must not count twice. Isotropic single
/// scattering of a small distant sphere lamp, which is a point light of the same intensity.
#[test]
fn lamps_and_points_agree() {
    let scene = |lamp: bool| {
        let mut stage = Stage::default();
        stage.media.media = vec![uniform(0.1, 0.7)];
        stage.solid(Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY, inert());
        let (center, radius) = (DVec3::new(4.0, 0.0, 0.0), 0.5);
        if lamp {
            stage.sphere(center, radius, emitter(constant(20.0)));
        } else {
            let intensity = 20.0 * std::f64::consts::PI * radius * radius;
            stage.lights.push(Light::point(center, &constant(intensity)));
        }
        estimate(&render(&stage.build(), &looking_down(), 1024, 1))
    };
    let (lamp, point) = (scene(true), scene(false));
    // The directions of the lamp spread by an eighth: second order in cosines of path lengths.
    assert!((lamp.mean / point.mean - 1.0).abs() < 0.01 + 5.0 * lamp.standard_error / lamp.mean, "{lamp:?} {point:?}");
}

/// Glass on water, the water reaching into the glass: three interfaces of relative index 1.5, 1.33 / 1.5 and 1 / 1.33. With
/// three events only light that is refracted by each arrives. The choices are stratified: bounds without chance.
#[test]
fn nested_dielectrics() {
    let passes = |a: f64, b: f64| 1.0 - ((a - b) / (a + b)).powi(2);
    let exact = passes(1.0, 1.5) * passes(1.5, 1.33) * passes(1.33, 1.0);
    for glass_first in [true, false] {
        let mut stage = Stage::default();
        let lower = DAffine3::from_translation(DVec3::new(0.0, 0.0, -0.8));
        let solids = [(slab(1.0), DAffine3::IDENTITY, 1.5), (slab(1.0), lower, 1.33)];
        let order = if glass_first { [0, 1] } else { [1, 0] };
        for i in order {
            let (shape, place, ior) = solids[i].clone();
            stage.solid(shape, place, glass(ior));
        }
        let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, -3.0));
        stage.surface(SurfaceShape::Disk { radius: 1.0 }, place, emitter(constant(1.0)));
        let mean = estimate(&render(&stage.build(), &looking_down(), 4096, 3)).mean;
        assert!((mean - exact).abs() < 3.0 / 4096.0, "{mean} instead of {exact}");
    }
}

/// Exactly touching solids make one interface; equal ones none.
#[test]
fn touching_dielectrics() {
    let passes = |a: f64, b: f64| 1.0 - ((a - b) / (a + b)).powi(2);
    for (lower, interfaces) in [(1.33, 3), (1.5, 2)] {
        let mut stage = Stage::default();
        stage.solid(slab(1.0), DAffine3::IDENTITY, glass(1.5));
        stage.solid(slab(1.0), DAffine3::from_translation(DVec3::new(0.0, 0.0, -1.0)), glass(lower));
        let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, -3.0));
        stage.surface(SurfaceShape::Disk { radius: 1.0 }, place, emitter(constant(1.0)));
        let mean = estimate(&render(&stage.build(), &looking_down(), 4096, interfaces)).mean;
        let exact = passes(1.0, 1.5) * passes(1.5, lower) * passes(lower, 1.0);
        assert!((mean - exact).abs() < 3.0 / 4096.0, "{mean} instead of {exact}");
    }
}

/// Sunlight scattered at a right angle by Rayleigh's law is polarised by (1 - rho) / (1 + rho), across the plane of
/// scattering; by single scattering that is so in every sample.
#[test]
fn rayleigh_polarises() {
    for rho in [0.0, 0.1, 0.5] {
        let mut stage = Stage::default();
        let phase = PhaseFunction::Rayleigh { depolarisation: rho };
        stage.media.media = vec![medium(constant(0.0), constant(0.5), phase, Density::Uniform)];
        stage.solid(Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY, inert());
        stage.lights.push(Light::distant(DVec3::X, &constant(1.0)));
        // The camera's horizontal is x; the plane of scattering holds x and the line of sight.
        let camera = spot_camera(DVec3::new(0.0, -5.0, 0.0), DVec3::ZERO);
        let [s0, s1, s2, s3] = stokes(&stage.build(), &camera, 16, 1);
        let exact = (1.0 - rho) / (1.0 + rho);
        assert!((s1 / s0 + exact).abs() < 1e-3, "{} instead of {}", s1 / s0, -exact);
        assert!((s2 / s0).abs() < 1e-3 && (s3 / s0).abs() < 1e-3, "{s2} {s3}");
    }
}

/// Opaque things in a medium and behind an inert wall are lit through it: the same picture with the wall of the medium
/// far away and as an atmosphere.
#[test]
fn inert_walls_do_nothing() {
    let scene = |atmosphere: bool| {
        let mut stage = Stage::default();
        stage.media.media = vec![uniform(0.2, 0.4)];
        if atmosphere {
            stage.media.atmosphere = Some(0);
        } else {
            stage.solid(Shape::Sphere { radius: 30.0 }, DAffine3::IDENTITY, inert());
            stage.solid(Shape::Sphere { radius: 1.9 }, DAffine3::IDENTITY, inert());
        }
        stage.sphere(DVec3::ZERO, 0.5, lambert(0.8));
        stage.surface(
            SurfaceShape::Disk { radius: 1.0 },
            facing_down(DVec3::new(0.0, 0.0, 3.0)),
            emitter(constant(5.0)),
        );
        let camera = camera(DVec3::new(0.0, -4.0, 1.0), DVec3::ZERO, 0.4, 8);
        estimate(&render(&stage.build(), &camera, 2048, 8))
    };
    let (a, b) = (scene(true), scene(false));
    let error = (a.standard_error.powi(2) + b.standard_error.powi(2)).sqrt();
    assert!(error < 0.1 * a.mean, "{a:?} {b:?}");
    // The pixels differ; their means over the same film are compared by the bound of noise at 2^17 paths.
    assert!((a.mean - b.mean).abs() < 0.01 * a.mean, "{a:?} {b:?}");
}
