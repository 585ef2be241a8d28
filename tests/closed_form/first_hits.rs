//! Ambient occlusion, previews and features against what is known.

use arsc_accel::{Shape, SurfaceShape};
use arsc_image::SpectralImage;
use arsc_render::{Bsdf, Camera, Environment, Material, Sampling, World, ambient_occlusion, features, preview};
use arsc_spectral::{Spectrum, d65, srgb, uplift_rgb, xyz_of_reflectance};
use glam::{DAffine3, DVec3};

use super::support::{Estimate, Stage, camera, constant, emitter, estimate, lambert, spot_camera};

fn sampling(samples: u32) -> Sampling {
    Sampling { samples, ..Sampling::default() }
}

/// Mean occlusion value: the band of D65 holds its mean over the range, which a picture of white shows.
fn openness(world: &World, camera: &Camera, distance: f64) -> Estimate {
    let white = estimate(&ambient_occlusion(&Stage::default().build(), camera, 1.0, &sampling(512), &()).to_image());
    let image = ambient_occlusion(world, camera, distance, &sampling(512), &()).to_image();
    let Estimate { mean, standard_error } = estimate(&image);
    Estimate { mean: mean / white.mean, standard_error: standard_error / white.mean }
}

fn floor(stage: &mut Stage) {
    stage.surface(SurfaceShape::Plane, DAffine3::IDENTITY, lambert(0.5));
}

/// A sphere of radius R with its centre at height h over a floor hides R^2 h / d^3 of the cosine-weighted space of a
/// point at distance d from the centre (the form factor of a sphere wholly above the horizon).
#[test]
fn a_sphere_hides_its_form_factor() {
    for (x, h) in [(0.0, 2.0), (1.5, 1.2), (3.0, 1.0)] {
        let mut stage = Stage::default();
        floor(&mut stage);
        stage.sphere(DVec3::new(0.0, 0.0, h), 0.8, lambert(0.5));
        let d = f64::hypot(x, h);
        let exact = 1.0 - 0.64 * h / (d * d * d);
        let view = spot_camera(DVec3::new(x, -0.2, 0.05), DVec3::new(x, 0.0, 0.0));
        openness(&stage.build(), &view, f64::INFINITY).assert_is(exact, 2e-3);
    }
}

/// A ceiling at height H hides what it reaches within the distance D: cosines above H / D, a share of 1 - (H / D)^2.
#[test]
fn distance_limits_occlusion() {
    let mut stage = Stage::default();
    floor(&mut stage);
    stage.surface(SurfaceShape::Plane, DAffine3::from_translation(DVec3::Z), lambert(0.5));
    let world = stage.build();
    let view = spot_camera(DVec3::new(0.0, -0.2, 0.1), DVec3::ZERO);
    openness(&world, &view, 1.25).assert_is(0.64, 2e-3);
    let free = openness(&world, &view, 0.99);
    assert!((free.mean - 1.0).abs() < 1e-5, "{free:?}");
}

fn value(image: &SpectralImage, name: &str, pixel: usize) -> f32 {
    image.channel(name).unwrap_or_else(|| panic!("no {name}"))[pixel]
}

fn with_features(world: &World, camera: &Camera, samples: u32) -> SpectralImage {
    let mut image = preview(world, camera, &sampling(samples), &()).to_image();
    image.channels = features(world, camera, &sampling(samples));
    image.verify().expect("sorted channels of the right size");
    image
}

#[test]
fn features_are_those_of_the_first_surface() {
    let mut stage = Stage::default();
    let paint = Spectrum::Sigmoid { coefficients: uplift_rgb([0.8, 0.2, 0.1]) };
    let inert = Material { bsdf: Bsdf::Inert, ..Material::default() };
    stage.sphere(DVec3::new(0.0, -2.5, 0.0), 0.4, inert);
    stage.sphere(DVec3::ZERO, 1.0, Material { bsdf: Bsdf::lambert(&paint), ..Material::default() });
    stage.sphere(DVec3::new(4.0, 0.0, 0.0), 1.0, emitter(constant(3.0)));
    stage.environments.push(Environment::constant(&constant(1.0)));
    // Pixel 4 of 9 x 1 looks at the first sphere's middle, the last but one at the lamp.
    let world = stage.build();
    let centre = with_features(&world, &spot_camera(DVec3::new(0.0, -5.0, 0.0), DVec3::ZERO), 32);
    for pixel in [0, 20, 63] {
        let of = |name| value(&centre, name, pixel);
        assert!((of("normal.Y") + 1.0).abs() < 1e-3 && of("normal.X").abs() < 1e-3);
        assert!((of("depth.Z") - 4.0).abs() < 1e-3 && (of("position.Y") + 1.0).abs() < 1e-3);
        assert_eq!((of("coverage.A"), of("material.Id"), of("part.Id")), (1.0, 2.0, 2.0));
        let xyz = xyz_of_reflectance(&paint, d65());
        let rgb = srgb::rgb_from_xyz() * DVec3::from_array(xyz);
        for (name, exact) in [("albedo.R", rgb.x), ("albedo.G", rgb.y), ("albedo.B", rgb.z)] {
            // The paint's lookup takes the nearest nanometre, and 32 samples have 128 wavelengths.
            assert!((f64::from(of(name)) - exact).abs() < 0.01, "{name}: {} instead of {exact}", of(name));
        }
    }
    let lamp = with_features(&world, &spot_camera(DVec3::new(4.0, -5.0, 0.0), DVec3::new(4.0, 0.0, 0.0)), 8);
    assert!((value(&lamp, "albedo.G", 9) - 1.0).abs() < 1e-5);
    let nothing = with_features(&world, &spot_camera(DVec3::new(0.0, -5.0, 0.0), DVec3::new(0.0, -9.0, 0.0)), 8);
    for channel in &nothing.channels {
        assert!(channel.samples.iter().all(|s| *s == 0.0), "{}", channel.name);
    }
}

#[test]
fn greys_have_grey_albedos_and_glass_is_white() {
    let glass = Material {
        bsdf: Bsdf::dielectric(&Spectrum::Cauchy { a: 1.5, b_um2: 0.01, c_um4: 0.0 }),
        ..Material::default()
    };
    for (material, exact) in [(lambert(0.4), 0.4), (glass, 1.0)] {
        let mut stage = Stage::default();
        stage.solid(Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY, material);
        let image = with_features(&stage.build(), &spot_camera(DVec3::new(0.0, -5.0, 0.0), DVec3::ZERO), 16);
        for name in ["albedo.R", "albedo.G", "albedo.B"] {
            assert!((f64::from(value(&image, name, 30)) - exact).abs() < 2e-3, "{name}: {}", value(&image, name, 30));
        }
    }
}

/// Previews show albedo times the cosine: a sphere's mean over its disk is 2/3 of its albedo.
#[test]
fn previews_are_lit_from_the_camera() {
    let mut stage = Stage::default();
    stage.sphere(DVec3::ZERO, 1.0, lambert(0.6));
    let view = camera(DVec3::new(0.0, -1000.0, 0.0), DVec3::ZERO, 2.0 * (1.2e-3f64).atan(), 64);
    let world = stage.build();
    let image = preview(&world, &view, &sampling(16), &()).to_image();
    let mean: f64 = image.xyz.iter().map(|xyz| f64::from(xyz[1])).sum::<f64>() / image.xyz.len() as f64;
    let disk = std::f64::consts::PI / (2.4f64 * 2.4);
    let exact = 0.6 * 2.0 / 3.0 * disk * arsc_image::UNIT_LUMINANCE;
    assert!((mean / exact - 1.0).abs() < 2e-3, "{mean} instead of {exact}");
}
