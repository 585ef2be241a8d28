//! Irradiance from lights of simple shape, seen as the radiance rho E / pi of a Lambertian floor.

use std::f64::consts::PI;

use arsc_accel::{Shape, SurfaceShape};
use arsc_render::{Light, Material};
use glam::{DAffine3, DVec2, DVec3};

use super::support::{Estimate, Stage, camera, constant, emitter, estimate, facing_down, lambert, render, spot_camera};

const RHO: f64 = 0.8;
const RADIANCE: f64 = 3.0;

/// 65 536 paths to the origin of a floor z = 0, with direct light alone.
fn floor(mut stage: Stage) -> Estimate {
    stage.surface(SurfaceShape::Plane, DAffine3::IDENTITY, lambert(RHO));
    estimate(&render(&stage.build(), &spot_camera(DVec3::new(1.0, -4.0, 0.7), DVec3::ZERO), 1024, 1))
}

/// E = pi L r^2 / d^2 cos, for a sphere that the horizon does not cut.
#[test]
fn sphere() {
    for center in [DVec3::new(0.0, 0.0, 2.0), DVec3::new(2.0, 1.0, 1.5)] {
        let mut stage = Stage::default();
        stage.sphere(center, 0.5, emitter(constant(RADIANCE)));
        let distance2 = center.length_squared();
        let irradiance = PI * RADIANCE * 0.25 / distance2 * center.z / distance2.sqrt();
        floor(stage).assert_is(RHO * irradiance / PI, 3e-3);
    }
}

/// E = pi L r^2 / (r^2 + h^2) below the centre of a parallel disk.
#[test]
fn disk() {
    let (r, h) = (0.7, 1.2);
    let mut stage = Stage::default();
    let place = facing_down(DVec3::new(0.0, 0.0, h));
    stage.surface(SurfaceShape::Disk { radius: r }, place, emitter(constant(RADIANCE)));
    floor(stage).assert_is(RHO * RADIANCE * r * r / (r * r + h * h), 2e-3);
}

/// The disk again, as the one lit face of a dark can, and as the one face of a lamp that is not dark; and with its
/// opposite lit more brightly, which the floor does not see.
#[test]
fn one_face_of_a_can() {
    let (r, h) = (0.7, 1.2);
    let lamp = |radiance: f64| emitter(constant(radiance));
    let can = Shape::Cylinder { radius: r, height: 2.0 };
    let place = facing_down(DVec3::new(0.0, 0.0, h + 2.0));
    for (whole, others) in [
        (lambert(0.0), vec![(2, lamp(RADIANCE))]),
        (lamp(RADIANCE), vec![(0, lambert(0.0)), (1, lambert(0.0))]),
        (lambert(0.0), vec![(1, lamp(5.0 * RADIANCE)), (2, lamp(RADIANCE))]),
    ] {
        let mut stage = Stage::default();
        stage.faces(can.clone(), place, whole, others);
        floor(stage).assert_is(RHO * RADIANCE * r * r / (r * r + h * h), 4e-3);
    }
}

/// Configuration factor of a parallel rectangle, one corner of which is above the point (Howell, B-3).
fn corner_factor(a: f64, b: f64, h: f64) -> f64 {
    let (ra, rb) = ((a * a + h * h).sqrt(), (b * b + h * h).sqrt());
    (a / ra * (b / ra).atan() + b / rb * (a / rb).atan()) / (2.0 * PI)
}

#[test]
fn rectangle_and_quad() {
    let (a, b, h) = (1.0, 0.4, 0.8);
    let exact = RHO * RADIANCE * 4.0 * corner_factor(a, b, h);
    let mut stage = Stage::default();
    let shape = SurfaceShape::Rectangle { size: DVec2::new(2.0 * a, 2.0 * b) };
    stage.surface(shape, facing_down(DVec3::new(0.0, 0.0, h)), emitter(constant(RADIANCE)));
    floor(stage).assert_is(exact, 2e-3);

    let mut stage = Stage::default();
    let corner = |x: f64, y: f64| DVec3::new(x, y, h);
    let quad = SurfaceShape::Quad([corner(-a, -b), corner(-a, b), corner(a, b), corner(a, -b)]);
    stage.surface(quad, DAffine3::IDENTITY, emitter(constant(RADIANCE)));
    floor(stage).assert_is(exact, 2e-3);
}

/// A sphere above the floor, cut by a box at the height of its centre so that `upper` or lower half remains.
fn half_sphere(upper: bool, height: f64, radius: f64, sphere: Material, cut: Material) -> Stage {
    let (z0, z1) = if upper { (-2.0, 0.0) } else { (0.0, 2.0) };
    let cut_shape = Shape::Box { min: DVec3::new(-2.0, -2.0, z0), max: DVec3::new(2.0, 2.0, z1) };
    let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, height));
    let mut stage = Stage::default();
    stage.difference([(Shape::Sphere { radius }, place, sphere), (cut_shape, place, cut)]);
    stage
}

/// Half of the points that light sampling proposes have been cut away: what remains looks like the whole from below.
#[test]
fn the_lower_half_of_a_sphere() {
    let stage = half_sphere(false, 2.0, 0.5, emitter(constant(RADIANCE)), lambert(0.0));
    floor(stage).assert_is(RHO * RADIANCE * 0.25 / 4.0, 5e-3);
}

/// The wall that the cut leaves is a disk and shows the material of the box. Most of the box is no wall at all.
#[test]
fn a_glowing_cut() {
    let stage = half_sphere(true, 1.2, 0.7, lambert(0.0), emitter(constant(RADIANCE)));
    floor(stage).assert_is(RHO * RADIANCE * 0.49 / (0.49 + 1.44), 5e-3);
}

/// An unbounded light is found by scattered rays alone: E = pi L, without noise.
#[test]
fn an_infinite_ceiling() {
    let mut stage = Stage::default();
    stage.surface(SurfaceShape::Plane, facing_down(DVec3::Z), emitter(constant(RADIANCE)));
    let mean = floor(stage).mean;
    assert!((mean / (RHO * RADIANCE) - 1.0).abs() < 1e-6, "{mean}");
}

/// The back of a one-sided light is dark.
#[test]
fn the_back_of_a_light() {
    let mut stage = Stage::default();
    let place = DAffine3::from_translation(DVec3::Z);
    stage.surface(SurfaceShape::Disk { radius: 0.7 }, place, emitter(constant(RADIANCE)));
    assert_eq!(floor(stage).mean, 0.0);
}

/// E = I cos / d^2, without noise.
#[test]
fn point_light() {
    let position = DVec3::new(1.0, 2.0, 2.0);
    let mut stage = Stage::default();
    stage.lights.push(Light::point(position, &constant(5.0)));
    let estimate = floor(stage);
    let exact = RHO / PI * 5.0 / 9.0 * (2.0 / 3.0);
    // The pixels see points some 1e-4 apart, which moves the light by as much.
    assert!((estimate.mean / exact - 1.0).abs() < 2e-5, "{estimate:?} instead of {exact}");
}

/// E = E0 cos, without noise.
#[test]
fn distant_light() {
    let mut stage = Stage::default();
    stage.lights.push(Light::distant(DVec3::new(0.6, 0.0, -0.8), &constant(2.0)));
    let estimate = floor(stage);
    let exact = RHO / PI * 2.0 * 0.8;
    assert!((estimate.mean / exact - 1.0).abs() < 1e-6, "{estimate:?} instead of {exact}");
}

/// Lights are told apart: several together give the sum of each alone.
#[test]
fn several_lights_add() {
    let mut stage = Stage::default();
    stage.lights.push(Light::distant(DVec3::NEG_Z, &constant(2.0)));
    stage.lights.push(Light::point(DVec3::new(0.0, 0.0, 3.0), &constant(0.9)));
    stage.sphere(DVec3::new(2.0, 1.0, 1.5), 0.5, emitter(constant(RADIANCE)));
    let distance2 = 7.25f64;
    let sphere = PI * RADIANCE * 0.25 * 1.5 / distance2.powf(1.5);
    floor(stage).assert_is(RHO / PI * (2.0 + 0.1 + sphere), 5e-3);
}

/// Form factor of two parallel unit squares one unit apart, 0.199825: the camera between them sees exactly the lower one,
/// whose white surface returns the fraction of the upper one's radiance that reaches it on average. 262 144 paths; pixels
/// differ, which the standard error takes for noise.
#[test]
fn parallel_squares() {
    let square = SurfaceShape::Rectangle { size: DVec2::ONE };
    let mut stage = Stage::default();
    stage.surface(square.clone(), DAffine3::IDENTITY, lambert(1.0));
    stage.surface(square, facing_down(DVec3::Z), emitter(constant(1.0)));
    let camera = camera(DVec3::new(0.0, 0.0, 0.5), DVec3::ZERO, PI / 2.0, 32);
    let estimate = estimate(&render(&stage.build(), &camera, 256, 1));
    assert!((estimate.mean / 0.199_825 - 1.0).abs() < 2e-3, "{estimate:?}");
}
