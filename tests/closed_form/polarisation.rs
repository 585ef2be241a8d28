//! Polarised light in pictures. Stokes parameters as the camera sees them: S1 > 0 is level, S2 > 0 rises to the right.

use arsc_accel::{Shape, SurfaceShape};
use arsc_render::fresnel::Interface;
use arsc_render::{Bsdf, Camera, Environment, FilterShape, Material, ReconstructionFilter};
use glam::{DAffine3, DQuat, DVec2, DVec3};

use super::support::{Stage, camera, constant, emitter, estimate, lambert, render, spot_camera, stokes};

fn smooth(bsdf: Bsdf) -> Material {
    Material { bsdf, ..Material::default() }
}

/// A glass floor under an angle, which mirrors a disk of radiance 1; `roll` turns camera and floor about the view axis.
fn floor(bsdf: Bsdf, angle: f64, roll: f64, samples: u32) -> [f64; 4] {
    let mut stage = Stage::default();
    let towards = DVec3::new(angle.sin(), 0.0, angle.cos());
    let eye = DVec3::new(-towards.x, 0.0, towards.z);
    let turn = DAffine3::from_axis_angle(eye, roll);
    stage.solid(Shape::HalfSpace, turn, smooth(bsdf));
    let place = DAffine3::from_rotation_translation(DQuat::from_rotation_arc(DVec3::Z, -towards), towards * 3.0);
    stage.surface(SurfaceShape::Disk { radius: 0.05 }, turn * place, emitter(constant(1.0)));
    stokes(&stage.build(), &spot_camera(eye, DVec3::ZERO), samples, 4)
}

fn close(found: [f64; 4], exact: [f64; 4], bound: f64) {
    for (f, e) in found.iter().zip(exact) {
        assert!((f - e).abs() < bound, "{found:?} instead of {exact:?}");
    }
}

/// Fresnel over the angle, for s and p: unpolarised light is reflected as S0 = (R_s + R_p) / 2 and S1 = (R_s - R_p) / 2,
/// level because s is. At Brewster's angle nothing but s is left. Bound as in `specular::glass`.
#[test]
fn glass_polarises_by_reflection() {
    let brewster = 1.5f64.atan();
    for angle in [0.1, 0.6, brewster, 1.2, 1.5] {
        let Interface { rs, rp, .. } = Interface::new(angle.cos(), 1.5);
        let exact = [0.5 * (rs + rp), 0.5 * (rs - rp), 0.0, 0.0];
        close(floor(Bsdf::dielectric(&constant(1.5)), angle, 0.0, 4096), exact, 1.0 / 4096.0);
        if angle == brewster {
            assert!(rp < 1e-20 && (exact[0] - exact[1]).abs() < 1e-12);
        }
    }
}

/// The floor turned by 45 and by 30 degrees about the view, counter-clockwise for the camera as the axis points at it: so that
/// what was level rises to the right.
#[test]
fn the_direction_of_polarisation_follows_the_scene() {
    let Interface { rs, rp, .. } = Interface::new(0.5, 1.5);
    let (mean, half) = (0.5 * (rs + rp), 0.5 * (rs - rp));
    for roll in [45f64, 30.0, -45.0] {
        let (sin, cos) = (2.0 * roll.to_radians()).sin_cos();
        let exact = [mean, half * cos, half * sin, 0.0];
        close(floor(Bsdf::dielectric(&constant(1.5)), 0.5f64.acos(), roll.to_radians(), 4096), exact, 1.0 / 4096.0);
    }
}

/// Without noise: metal reflects every path.
#[test]
fn metal_polarises_by_reflection() {
    for cos in [0.9f64, 0.5, 0.2] {
        // Complex amplitudes written out for (0.27 + 2.95 i)^2 = -8.6296 + 1.593 i.
        let (re, im) = (0.27f64 * 0.27 - 2.95 * 2.95, 2.0 * 0.27 * 2.95);
        let (t_re, t_im) = (re - (1.0 - cos * cos), im);
        let r = t_re.hypot(t_im);
        let (a, b) = ((0.5 * (r + t_re)).sqrt(), (0.5 * (r - t_re)).sqrt());
        let rs = ((cos - a).powi(2) + b * b) / ((cos + a).powi(2) + b * b);
        let rp = ((re * cos - a).powi(2) + (im * cos - b).powi(2)) / ((re * cos + a).powi(2) + (im * cos + b).powi(2));
        let found = floor(Bsdf::conductor(&constant(0.27), &constant(2.95)), cos.acos(), 0.0, 4);
        close(found, [0.5 * (rs + rp), 0.5 * (rs - rp), 0.0, 0.0], 1e-6);
    }
}

/// A white furnace has no polarisation to give: radiance 1 and nothing else, whatever absorbs nothing. Glass and a perfect
/// mirror; every path through glass is polarised, and only their sum is not.
#[test]
fn a_polarised_furnace_is_white() {
    for (bsdf, samples, bound) in
        [(Bsdf::mirror(&constant(1.0)), 4, 1e-6), (Bsdf::dielectric(&constant(1.5)), 256, 2e-3)]
    {
        let mut stage = Stage::default();
        stage.environments.push(Environment::constant(&constant(1.0)));
        stage.sphere(DVec3::ZERO, 1.0, smooth(bsdf));
        let camera = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.3, 48);
        close(stokes(&stage.build(), &camera, samples, 200), [1.0, 0.0, 0.0, 0.0], bound);
    }
}

/// Two glass plates one after the other, under Brewster's angle, their planes of incidence at right angles: s of the first
/// is p of the second, nothing arrives. Without polarisation a false R^2 does.
#[test]
fn crossed_brewster_reflections_are_dark() {
    let angle = 1.5f64.atan();
    let (r, view) = (2.0 * angle, DVec3::Y);
    // Along y, deflected by pi - 2 angle within (y, z), then out of that plane.
    let turn = std::f64::consts::PI - r;
    let second = DVec3::new(0.0, turn.cos(), turn.sin());
    let across = DVec3::X;
    let third = second * turn.cos() + across * turn.sin();
    let mut stage = Stage::default();
    let plate = |stage: &mut Stage, at: DVec3, from: DVec3, to: DVec3| {
        let normal = (to - from).normalize();
        let place = DAffine3::from_rotation_translation(DQuat::from_rotation_arc(DVec3::Z, normal), at);
        stage.solid(Shape::HalfSpace, place, smooth(Bsdf::dielectric(&constant(1.5))));
    };
    plate(&mut stage, DVec3::ZERO, view, second);
    // Finite, so that the second plate does not swallow the first.
    let normal = (third - second).normalize();
    let place = DAffine3::from_rotation_translation(DQuat::from_rotation_arc(DVec3::Z, normal), second);
    stage.surface(SurfaceShape::Disk { radius: 0.2 }, place, smooth(Bsdf::dielectric(&constant(1.5))));
    let light = second + third * 2.0;
    let place = DAffine3::from_rotation_translation(DQuat::from_rotation_arc(DVec3::Z, -third), light);
    stage.surface(SurfaceShape::Disk { radius: 0.1 }, place, emitter(constant(1.0)));
    let world = stage.build();
    let camera = spot_camera(-view, DVec3::ZERO);
    let polarised = stokes(&world, &camera, 4096, 8);
    assert!(polarised[0] < 1e-6, "{polarised:?}");
    let reflectance = Interface::new(angle.cos(), 1.5).reflectance();
    let unpolarised = estimate(&render(&world, &camera, 4096, 8));
    assert!((unpolarised.mean / (reflectance * reflectance) - 1.0).abs() < 0.2, "{unpolarised:?}");
}

/// Where the sky is that [`ball_under_half_a_sky`] sees, within a right angle: from level ahead, upwards.
const SKY: f64 = 1.3;

/// A ray that meets a glass ball below its middle, level: radiance by angle of incidence, s and p apart and with their
/// mean taken at every meeting. The outer reflection is dark, and what leaves at the first chance is bright.
fn ball_under_half_a_sky(angle: f64) -> [f64; 2] {
    let Interface { rs, rp, cos_t, .. } = Interface::new(angle.cos(), 1.5);
    let inner = cos_t.acos();
    // The ray is turned upwards, by so much after k reflections within.
    let turned = |k: f64| 2.0 * (angle - inner) + k * (std::f64::consts::PI - 2.0 * inner);
    let lit = |angle: f64| if (angle - SKY).cos() > 0.0 { 1.0 } else { 0.0 };
    let radiance = |r: f64| {
        let within: f64 = (0..60).map(|k| (1.0 - r).powi(2) * r.powi(k) * lit(turned(f64::from(k)))).sum();
        // The outer reflection goes down.
        within + r * lit(-(std::f64::consts::PI - 2.0 * angle))
    };
    [0.5 * (radiance(rs) + radiance(rp)), radiance(0.5 * (rs + rp))]
}

/// Light of an unpolarised sky is polarised by the first surface of the glass and meets the second as such: without
/// polarisation its radiance is wrong by 0.024 of 0.430 at 80 degrees. Of 2^18 paths with values of at most 1 the
/// standard error is below 1e-3; four of them.
#[test]
fn glass_in_an_unpolarised_sky_needs_polarisation() {
    for angle in [80f64, 75.0] {
        let angle = angle.to_radians();
        let mut stage = Stage::default();
        stage.environments.push(Environment::constant(&constant(1.0)));
        stage.sphere(DVec3::ZERO, 1.0, smooth(Bsdf::dielectric(&constant(1.5))));
        let sky = DVec3::new(0.0, SKY.cos(), SKY.sin());
        let below = DAffine3::from_rotation_translation(DQuat::from_rotation_arc(DVec3::Z, sky), sky * -1e4);
        stage.solid(Shape::HalfSpace, below, lambert(0.0));
        let world = stage.build();
        let height = -angle.sin();
        let camera = spot_camera(DVec3::new(0.0, -3.0, height), DVec3::new(0.0, 0.0, height));
        let [exact, averaged] = ball_under_half_a_sky(angle);
        let polarised = stokes(&world, &camera, 4096, 60)[0];
        assert!((polarised - exact).abs() < 4e-3, "{polarised} instead of {exact}");
        let unpolarised = estimate(&render(&world, &camera, 4096, 60)).mean;
        assert!((unpolarised - averaged).abs() < 4e-3, "{unpolarised} instead of {averaged}");
        assert!(exact - averaged > 0.02, "{exact} and {averaged}");
    }
}

/// Looks down at sheets one below the other, x to the right, with a light of radiance 1 under them,
/// out of the way of reflections.
fn sheets(bsdfs: &[Bsdf], tilt: f64, samples: u32) -> [f64; 4] {
    let mut stage = Stage::default();
    let size = DVec2::splat(200.0);
    let tilted = DAffine3::from_rotation_x(tilt);
    for (i, bsdf) in bsdfs.iter().enumerate() {
        let place = tilted * DAffine3::from_translation(DVec3::new(0.0, 0.0, -0.01 * i as f64));
        stage.surface(SurfaceShape::Rectangle { size }, place, smooth(bsdf.clone()));
    }
    let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, -300.0));
    stage.surface(SurfaceShape::Rectangle { size: DVec2::splat(20.0) }, place, emitter(constant(1.0)));
    let filter = ReconstructionFilter::new(FilterShape::Box { radius: 0.5 });
    let camera = Camera::perspective(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO, DVec3::Y, 1e-4, [8, 8], filter);
    stokes(&stage.build(), &camera, samples, 64)
}

/// Malus, as the camera sees it: what passes two polarisers is polarised along the upper one. Without noise.
#[test]
fn two_polarisers_obey_malus() {
    let polariser = |degrees: f64| Bsdf::polariser(&constant(1.0), degrees.to_radians());
    for (upper, lower) in [(0.0, 0.0), (20.0, 0.0), (-30.0, 15.0), (90.0, 45.0), (100.0, 10.0)] {
        let passed = 0.5 * f64::cos(f64::to_radians(upper - lower)).powi(2);
        let (sin, cos) = (2.0 * f64::to_radians(upper)).sin_cos();
        close(sheets(&[polariser(upper), polariser(lower)], 0.0, 4), [passed, passed * cos, passed * sin, 0.0], 1e-6);
    }
}

/// A quarter-wave plate over a polariser at +45 degrees from its fast axis: circular light. The field along y, which lags,
/// trails the one along x, so that the field turns from x to y: counter-clockwise, left-handed. Half a wave mirrors the plane
/// of polarisation in the fast axis; a depolariser undoes it all.
#[test]
fn wave_plates_delay() {
    let polariser = |degrees: f64| Bsdf::polariser(&constant(1.0), degrees.to_radians());
    let plate = |degrees: f64, angle: f64| Bsdf::retarder(degrees.to_radians(), angle.to_radians());
    close(sheets(&[plate(90.0, 0.0), polariser(45.0)], 0.0, 4), [0.5, 0.0, 0.0, -0.5], 1e-6);
    close(sheets(&[plate(90.0, 0.0), polariser(-45.0)], 0.0, 4), [0.5, 0.0, 0.0, 0.5], 1e-6);
    let (sin, cos) = 100f64.to_radians().sin_cos();
    close(sheets(&[plate(180.0, 30.0), polariser(10.0)], 0.0, 4), [0.5, 0.5 * cos, 0.5 * sin, 0.0], 1e-6);
    close(sheets(&[Bsdf::depolariser(&constant(0.8)), polariser(10.0)], 0.0, 4), [0.4, 0.0, 0.0, 0.0], 1e-6);
}

/// A pile of m panes under Brewster's angle, with all reflections between them: p passes whole, and of s the share
/// (1 - r) / (1 + (2 m - 1) r) for the reflectance r of one interface (Stokes 1862). Tilted about x, s is level. 65 536
/// paths of 64 pixels: the bound is four standard errors of a mean of choices, with weights up to 2.
#[test]
fn a_pile_of_plates_polarises() {
    let angle = 1.5f64.atan();
    let Interface { rs, .. } = Interface::new(angle.cos(), 1.5);
    for m in [1, 4] {
        let pile = vec![Bsdf::thin_dielectric(&constant(1.5)); m];
        let ts = (1.0 - rs) / (1.0 + (2.0 * m as f64 - 1.0) * rs);
        close(sheets(&pile, angle, 1024), [0.5 * (ts + 1.0), 0.5 * (ts - 1.0), 0.0, 0.0], 8e-3);
    }
}
