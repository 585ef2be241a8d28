//! The suite for environments and area lights.

use std::f64::consts::TAU;

use arsc_spectral::{Channels, PhotometricWeb, Raster, SampledWavelengths, Spectrum, Star, WavelengthRange};
use glam::{DMat3, DVec3};

use super::{SAMPLES, assert_directions_follow, mean, pair, random};
use crate::light::{Environment, Light, SkyModel, SkySettings};
use crate::polarisation::{Polarised, ReferenceFrame, Stokes, Unpolarised};

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
    let sun = towards(elevation, azimuth);
    Environment::sky(&SkySettings { ground_albedo: 0.3, sun, solar_disc, ..SkySettings::default() })
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

/// A sky whose disc is too small for the grids above: its integral is taken over its own cone.
fn disc_conforms(settings: &SkySettings) {
    let with = Environment::sky(settings);
    let without = Environment::sky(&SkySettings { solar_disc: false, ..*settings });
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
    let cone = (settings.star.angular_radius() * 1.000_001).cos();
    let about_sun = crate::Frame::new(settings.sun.normalize());
    let disc = integrate(&with, about_sun, cone, 300) - integrate(&without, about_sun, cone, 300);
    let dome = integrate(&without, crate::Frame::new(DVec3::Z), 0.0, 1000);
    assert!(disc > dome, "a high sun outshines the sky: {disc}, {dome}");
    estimates(&with, disc + dome);
}

fn towards(elevation: f64, azimuth: f64) -> DVec3 {
    DVec3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin())
}

#[test]
fn skies_with_discs() {
    let sun = towards(0.8, 1.0);
    disc_conforms(&SkySettings { ground_albedo: 0.3, sun, ..SkySettings::default() });
    disc_conforms(&SkySettings { model: SkyModel::Preetham, turbidity: 2.0, sun, ..SkySettings::default() });
    for star in [Star { kelvin: 3000.0, intensity: 7.3 }, Star { kelvin: 9600.0, intensity: 1.0 }] {
        for model in [SkyModel::HosekWilkie, SkyModel::Preetham] {
            disc_conforms(&SkySettings { model, sun, star, scale: 0.1, ..SkySettings::default() });
        }
    }
}

#[test]
fn preetham_without_disc() {
    for (elevation, azimuth) in [(0.8, 1.0), (0.05, 4.0), (1.57, 0.0)] {
        let (model, sun) = (SkyModel::Preetham, towards(elevation, azimuth));
        assert_conforms(&Environment::sky(&SkySettings { model, sun, solar_disc: false, ..SkySettings::default() }));
    }
}

/// Skylight at right angles to the sun is polarised across the plane of the sun; its intensity is that of the plain sky.
#[test]
fn a_polarised_sky_has_the_pattern_of_single_scattering() {
    let settings = SkySettings { turbidity: 2.0, sun: DVec3::X, polarised: true, ..SkySettings::default() };
    let (sky, plain) = (Environment::sky(&settings), Environment::sky(&SkySettings { polarised: false, ..settings }));
    let w = wavelengths();
    let light = sky.radiance::<Polarised>(DVec3::Z, &w);
    assert_eq!(light.intensity(), plain.radiance::<Unpolarised>(DVec3::Z, &w));
    // Seen from below with y to the right.
    let seen = light.in_frame(ReferenceFrame::new(DVec3::Y, -DVec3::Z));
    let degree = seen.s[1].hero() / seen.s[0].hero();
    assert!((0.5..0.95).contains(&degree), "{degree}");
    assert!(seen.s[2].hero().abs() < 1e-6 * seen.s[0].hero() && seen.s[3].hero() == 0.0);
}

/// Directions to the four sides, then what a picture of two by one pixels shows there.
#[test]
fn pictures_are_the_right_way_round() {
    let values = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    let raster = Raster::new(4, 2, Channels::Spectral(vec![500.0]), values).expect("a picture");
    let environment = |map| Environment::image(raster.clone().into(), map, 2.0);
    let w = SampledWavelengths::fixed([500.0; 4]);
    let radiance = |map, turn: f64, height: f64| {
        let wi = DVec3::new(turn.cos(), turn.sin(), height).normalize();
        environment(map).radiance::<Unpolarised>(wi, &w).hero()
    };
    // Centres of columns are at 135, 45, -45, -135 degrees about z; up and down is beyond the centre of the rows.
    for (column, degrees) in [135.0, 45.0, -45.0, -135.0f64].into_iter().enumerate() {
        let turn = degrees.to_radians();
        assert!((radiance(DMat3::IDENTITY, turn, 1.1) - 2.0 * (column as f32 + 1.0)).abs() < 1e-5);
        assert!((radiance(DMat3::IDENTITY, turn, -1.1) - 2.0 * (column as f32 + 5.0)).abs() < 1e-5);
        // Half-way between the rows; and turned by a quarter.
        assert!((radiance(DMat3::IDENTITY, turn, 0.0) - 2.0 * (column as f32 + 3.0)).abs() < 1e-5);
        let quarter = DMat3::from_rotation_z(TAU / 4.0);
        assert!((radiance(quarter, turn + TAU / 4.0, 1.1) - 2.0 * (column as f32 + 1.0)).abs() < 1e-5);
    }
    assert!((radiance(DMat3::IDENTITY, 0.0, 1.1) - 5.0).abs() < 1e-5, "the middle of the picture is at +x");
}

/// A pattern with a bright spot, a black half and colours, upright and turned; its spectral twin; and the extremes of size.
#[test]
fn image_environments() {
    let pattern = |columns: usize, rows: usize, channels: usize| -> Vec<f32> {
        let value = |i: usize| {
            let (column, row, c) = (i / channels % columns, i / channels / columns, i % channels);
            let spot = if (column, row) == (columns / 3, rows / 4) { 3.0 } else { 0.0 };
            if column > columns / 2 { 0.0 } else { 0.3 + 0.1 * c as f32 + 0.2 * (row % 3) as f32 + spot }
        };
        (0..columns * rows * channels).map(value).collect()
    };
    let bands = vec![400.0, 500.0, 600.0, 700.0];
    for (columns, rows) in [(32, 16), (7, 5), (1, 1), (3, 1)] {
        let rgb = Raster::new(columns, rows, Channels::Rgb, pattern(columns, rows, 3)).expect("a picture");
        let spectral = Raster::new(columns, rows, Channels::Spectral(bands.clone()), pattern(columns, rows, 4));
        let turn = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.0);
        assert_conforms(&Environment::image(rgb.into(), turn, 1.5));
        assert_conforms(&Environment::image(spectral.expect("a picture").into(), DMat3::IDENTITY, 1.0));
    }
    let black = Raster::new(4, 2, Channels::Rgb, vec![0.0; 24]).expect("a picture");
    samples_agree_with_values(&Environment::image(black.into(), DMat3::IDENTITY, 1.0));
}

/// The integral of a bilinear picture in closed form: rows have means over the turn that are linear in the angle between their
/// centres, and constant to the poles.
#[test]
fn the_integral_of_a_picture_is_exact() {
    let (columns, rows) = (8, 4);
    let values: Vec<f32> = (0..columns * rows).map(|i| (i * i % 13) as f32).collect();
    let mean = |row: usize| f64::from(values[row * columns..(row + 1) * columns].iter().sum::<f32>()) / columns as f64;
    let step = std::f64::consts::PI / rows as f64;
    let mut exact = (mean(0) + mean(rows - 1)) * (1.0 - (0.5 * step).cos());
    for row in 0..rows - 1 {
        let (a, b) = (step * (row as f64 + 0.5), step * (row as f64 + 1.5));
        let slope = (mean(row + 1) - mean(row)) / step;
        exact += mean(row) * a.cos() - mean(row + 1) * b.cos() + slope * (b.sin() - a.sin());
    }
    let raster = Raster::new(
        columns,
        rows,
        Channels::Spectral(vec![530.0, 540.0]),
        values.iter().flat_map(|v| [*v; 2]).collect(),
    );
    estimates(&Environment::image(raster.expect("a picture").into(), DMat3::from_rotation_y(0.3), 1.0), TAU * exact);
}

/// A closed sphere about a light receives its power: the mean irradiance over directions times the sphere's area.
#[test]
fn spots_and_lamps_have_the_power_of_their_closed_forms() {
    let flat = Spectrum::Constant(2.0);
    let visible = WavelengthRange::VISIBLE;
    let web = PhotometricWeb::new(
        vec![0.0, 45.0, 90.0],
        vec![0.0, 90.0, 360.0],
        vec![10.0, 8.0, 1.0, 10.0, 4.0, 0.0, 10.0, 8.0, 1.0],
    );
    let web = std::sync::Arc::new(web.expect("a table"));
    let turn = DMat3::from_rotation_x(2.0);
    let position = DVec3::new(1.0, -2.0, 0.5);
    let w = SampledWavelengths::fixed([555.0; 4]);
    let radiant = |light: &Light| light.power(1.0, &visible) / visible.width_nm();
    for (light, name) in [
        (Light::spot(position, DVec3::new(1.0, 2.0, -1.0), &flat, 0.0, 0.5), "spot"),
        (Light::spot(position, DVec3::X, &flat, 6.5, 1.2), "cosine"),
        (Light::photometric(position, turn, web.clone(), &flat), "lamp"),
    ] {
        let mut random = random();
        let radius = 3.0;
        let (mean, error) = mean((0..SAMPLES).map(|_| {
            let p = position + crate::warp::uniform_sphere(pair(&mut random)) * radius;
            f64::from(light.incident(p, &w).1.hero()) * 2.0 * TAU * radius * radius
        }));
        assert!((mean - radiant(&light)).abs() < 5.0 * error, "{name}: {mean} +- {error}, {}", radiant(&light));
    }
    // 2 pi I (1 - cos 30 degrees), and lumens as the file's whatever the scale of the spectrum.
    let spot = Light::spot(position, DVec3::X, &flat, 0.0, TAU / 12.0);
    assert!((radiant(&spot) - 2.0 * TAU * (1.0 - (TAU / 12.0).cos())).abs() < 1e-9);
    let lumens = |spectrum: &Spectrum| {
        let (_, irradiance) = Light::photometric(position, DMat3::IDENTITY, web.clone(), spectrum)
            .incident(position - DVec3::Z * 2.0, &w);
        f64::from(irradiance.hero()) * 4.0 * arsc_spectral::xyz_of_radiance(spectrum)[1] / spectrum.eval(555.0)
    };
    for spectrum in [flat.clone(), Spectrum::Blackbody { kelvin: 2856.0 }, Spectrum::Constant(1e-9)] {
        assert!((lumens(&spectrum) - 10.0).abs() < 1e-4, "{} cd straight down", lumens(&spectrum));
    }
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
        let settings = SkySettings { turbidity: 2.0, sun: DVec3::ZERO, scale, ..SkySettings::default() };
        assert_eq!(Environment::sky(&settings).radiance::<Unpolarised>(DVec3::Z, &wavelengths()).max(), 0.0);
    }
}
