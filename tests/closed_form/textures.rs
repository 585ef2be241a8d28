//! What varies over a surface, against means that are known.

use std::sync::Arc;

use arsc_accel::{Shape, SurfaceShape};
use arsc_render::bsdf::{MicrofacetShape, Microfacets};
use arsc_render::{
    Bsdf, ColorTexture, Environment, Light, Material, Parameter, SpectrumTerm, VaryingBsdf, VaryingPart,
};
use arsc_spectral::{Channels, DenseSpectrum, Raster, Spectrum};
use arsc_texture::{Binary, Expression, ExpressionGraph, ImageMap, Input, Noise, Step, Unary};
use glam::{DAffine3, DVec2, DVec3};

use super::support::{Estimate, Stage, camera, constant, estimate, render, spot_camera};

fn varying(parts: Vec<VaryingPart>, texture_from_object: DAffine3) -> Material {
    let varying = VaryingBsdf::new(parts, texture_from_object).expect("parts");
    Material { bsdf: varying.representative().clone(), varying: Some(Box::new(varying)), ..Material::default() }
}

fn part(weight: f64, bsdf: Bsdf) -> VaryingPart {
    VaryingPart { weight: Expression::constant(weight), bsdf, parameters: Vec::new() }
}

fn grey_of(weight: Expression) -> Parameter {
    let spectrum = DenseSpectrum::new(&constant(1.0));
    Parameter::Reflectance(vec![SpectrumTerm { weight, spectrum, color: None }])
}

fn coloured(reflectance: Expression) -> Material {
    let bsdf = Bsdf::lambert(&constant(0.5));
    let parameters = vec![grey_of(reflectance)];
    varying(vec![VaryingPart { weight: Expression::constant(1.0), bsdf, parameters }], DAffine3::IDENTITY)
}

/// floor(x) + floor(y) modulo 2.
fn checker() -> Expression {
    let mut g = ExpressionGraph::default();
    let [x, y] = [Input::WorldX, Input::WorldY].map(|input| {
        let input = g.add(Step::Input(input));
        g.unary(Unary::Floor, input)
    });
    let (sum, two) = (g.binary(Binary::Add, x, y), g.constant(2.0));
    let checker = g.binary(Binary::Modulo, sum, two);
    g.expression(checker)
}

fn input(input: Input) -> Expression {
    Expression::new(vec![Step::Input(input)]).expect("one step")
}

/// In a furnace of radiance 1 a diffuse floor shows its reflectance: one half in pixels of two by two squares.
#[test]
fn a_checkered_floor_shows_its_mean() {
    let mut stage = Stage::default();
    stage.environments.push(Environment::constant(&constant(1.0)));
    let floor = SurfaceShape::Rectangle { size: DVec2::splat(40.0) };
    stage.surface(floor, DAffine3::IDENTITY, coloured(checker()));
    let fov = 2.0 * (16.0f64 / 20.0).atan();
    let camera = camera(DVec3::new(0.0, 0.0, 20.0), DVec3::ZERO, fov, 16);
    estimate(&render(&stage.build(), &camera, 1024, 1)).assert_is(0.5, 5e-3);
}

/// The texture's space is found at the hit, under transforms of the leaf and of the texture.
#[test]
fn places_are_found_in_the_space_of_the_texture() {
    for (shift, wanted) in [(0.0, 0.25), (0.25, 0.5)] {
        let mut stage = Stage::default();
        stage.environments.push(Environment::constant(&constant(1.0)));
        let material = {
            let bsdf = Bsdf::lambert(&constant(0.5));
            let parameters = vec![grey_of(input(Input::X))];
            let part = VaryingPart { weight: Expression::constant(1.0), bsdf, parameters };
            varying(vec![part], DAffine3::from_translation(DVec3::X * shift))
        };
        let place = DAffine3::from_translation(DVec3::new(3.0, 0.0, 0.0)) * DAffine3::from_scale(DVec3::splat(2.0));
        stage.solid(Shape::Box { min: -DVec3::ONE, max: DVec3::ONE }, place, material);
        // World x = 3.5 is 0.25 of the box.
        let camera = spot_camera(DVec3::new(3.5, 0.0, 9.0), DVec3::new(3.5, 0.0, 2.0));
        estimate(&render(&stage.build(), &camera, 1024, 1)).assert_is(wanted, 5e-3);
    }
}

/// A quarter mirror, three quarters paint of reflectance 0.6, in a furnace: 0.25 + 0.45. Light sampling sees the paint alone.
#[test]
fn a_mixture_shows_the_sum_of_its_parts() {
    let parts = || vec![part(1.0, Bsdf::mirror(&constant(1.0))), part(3.0, Bsdf::lambert(&constant(0.6)))];
    let furnace = |material: Material, samples| {
        let mut stage = Stage::default();
        stage.environments.push(Environment::constant(&constant(1.0)));
        stage.sphere(DVec3::ZERO, 1.0, material);
        let camera = spot_camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO);
        estimate(&render(&stage.build(), &camera, samples, 8))
    };
    furnace(varying(parts(), DAffine3::IDENTITY), 4096).assert_is(0.7, 5e-3);
}

/// White paint, a mirror, rough glass without loss: a sphere of their mixture vanishes in a furnace as they do.
#[test]
fn a_mixture_of_lossless_parts_vanishes() {
    let facets = Microfacets::new(MicrofacetShape::Ggx, [0.01; 2]);
    let parts = vec![
        part(1.0, Bsdf::lambert(&constant(1.0))),
        part(2.0, Bsdf::mirror(&constant(1.0))),
        part(3.0, Bsdf::rough_dielectric(&constant(1.5), facets)),
        part(1.0, Bsdf::Inert),
    ];
    let mut stage = Stage::default();
    stage.environments.push(Environment::constant(&constant(1.0)));
    stage.sphere(DVec3::ZERO, 1.0, varying(parts, DAffine3::IDENTITY));
    let camera = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.5, 32);
    estimate(&render(&stage.build(), &camera, 64, 200)).assert_is(1.0, 3e-3);
}

/// Parameters that vary but happen to be constant give the picture of the plain bsdf, path by path.
#[test]
fn constant_parameters_give_the_plain_picture() {
    let grey = constant(0.4);
    let shapes = [MicrofacetShape::Ggx, MicrofacetShape::Beckmann];
    let rough =
        |shape, alpha: f64| Bsdf::rough_conductor(&constant(0.3), &constant(3.0), Microfacets::new(shape, [alpha; 2]));
    let of = |value: f64| Expression::constant(value);
    let reflectance = || grey_of(of(0.4));
    let other = constant(0.9);
    let mut cases = vec![
        (Bsdf::lambert(&grey), Bsdf::lambert(&other), vec![reflectance()]),
        (Bsdf::oren_nayar(&grey, 0.3), Bsdf::oren_nayar(&other, 0.0), vec![reflectance(), Parameter::Sigma(of(0.3))]),
        (Bsdf::phong(&grey, 20.0), Bsdf::phong(&other, 3.0), vec![reflectance(), Parameter::Exponent(of(20.0))]),
    ];
    for shape in shapes {
        cases.push((rough(shape, 0.2), rough(shape, 0.7), vec![Parameter::Roughness([of(0.2), of(0.2)])]));
    }
    for (plain, base, parameters) in cases {
        let picture = |material: Material| -> Estimate {
            let mut stage = Stage::default();
            stage.environments.push(Environment::constant(&Spectrum::Blackbody { kelvin: 5000.0 }));
            stage.sphere(DVec3::ZERO, 1.0, material);
            let camera = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.5, 8);
            estimate(&render(&stage.build(), &camera, 8, 4))
        };
        let part = VaryingPart { weight: Expression::constant(1.0), bsdf: base, parameters };
        let varied = picture(varying(vec![part], DAffine3::IDENTITY));
        let wanted = picture(Material { bsdf: plain.clone(), ..Material::default() });
        let error = (varied.mean - wanted.mean).abs();
        assert!(error < 1e-5 * wanted.mean, "{plain:?}: {varied:?} is not {wanted:?}");
    }
}

/// A floor of reflectance 1/2 under light from a direction, of irradiance 1 across the beam, looked at from above.
fn lit_floor(place: DAffine3, parameter: Parameter, light: DVec3) -> Estimate {
    let mut stage = Stage::default();
    stage.lights.push(Light::distant(-light, &constant(1.0)));
    let bsdf = Bsdf::lambert(&constant(0.5));
    let part = VaryingPart { weight: Expression::constant(1.0), bsdf, parameters: vec![parameter] };
    let floor = SurfaceShape::Rectangle { size: DVec2::splat(4.0) };
    stage.surface(floor, place, varying(vec![part], DAffine3::IDENTITY));
    let eye = DVec3::new(0.3, 0.2, 5.0);
    estimate(&render(&stage.build(), &spot_camera(eye, DVec3::new(0.3, 0.2, 0.0)), 1, 1))
}

/// Height a x: the normal leans by atan a, whatever the size of the object and however the height is written. The slope of
/// u over the floor is 1 / 4 in its space.
#[test]
fn raised_and_mapped_floors_are_lit_by_their_slope() {
    let a = 0.75;
    let slope = |input: Input, factor: f64| {
        let steps = vec![Step::Input(input), Step::Constant(factor), Step::Binary(Binary::Multiply, 0, 1)];
        Expression::new(steps).expect("sound steps")
    };
    let normal = [-a, 0.0, 1.0].map(Expression::constant);
    let light = DVec3::new(0.48, 0.6, 0.64);
    let wanted = 0.5 / std::f64::consts::PI * light.dot(DVec3::new(-a, 0.0, 1.0).normalize());
    for scale in [1.0, 3.0] {
        let place = DAffine3::from_scale(DVec3::splat(scale));
        let reliefs = [
            Parameter::Height(slope(Input::X, a)),
            Parameter::Height(slope(Input::U, 4.0 * a)),
            Parameter::Height(slope(Input::WorldX, a / scale)),
            Parameter::Normal(normal.clone()),
        ];
        for relief in reliefs {
            let found = lit_floor(place, relief.clone(), light).mean;
            assert!((found - wanted).abs() < 1e-5, "{relief:?} at scale {scale}: {found} is not {wanted}");
        }
    }
}

/// White walls in a furnace gain nothing by their bumps and lose little.
#[test]
fn bumps_gain_no_energy() {
    let noise = Expression::new(vec![
        Step::Input(Input::X),
        Step::Input(Input::Y),
        Step::Input(Input::Z),
        Step::Constant(5.0),
        Step::Binary(Binary::Multiply, 0, 3),
        Step::Binary(Binary::Multiply, 1, 3),
        Step::Binary(Binary::Multiply, 2, 3),
        Step::Noise(Noise::Perlin { seed: 0 }, [4, 5, 6]),
        Step::Constant(0.1),
        Step::Binary(Binary::Multiply, 7, 8),
    ]);
    let parameters = vec![Parameter::Height(noise.expect("sound steps"))];
    let part = VaryingPart { weight: Expression::constant(1.0), bsdf: Bsdf::lambert(&constant(1.0)), parameters };
    let mut stage = Stage::default();
    stage.environments.push(Environment::constant(&constant(1.0)));
    stage.sphere(DVec3::ZERO, 1.0, varying(vec![part], DAffine3::IDENTITY));
    let camera = camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.4, 32);
    let Estimate { mean, standard_error } = estimate(&render(&stage.build(), &camera, 32, 50));
    assert!(mean < 1.0 + 5.0 * standard_error && mean > 0.9, "{mean}");
}

/// Four pixels on a rectangle in a furnace: each corner shows its own, and the middle their mean.
#[test]
fn pictures_lie_as_they_are_seen() {
    let values = [0.1, 0.2, 0.3, 0.4].into_iter().flat_map(|grey| [grey; 3]).collect();
    let raster = Arc::new(Raster::new(2, 2, Channels::Rgb, values).expect("four pixels"));
    let image = Arc::new(ImageMap::new("four.png".into(), raster, false, true, false));
    let floor = || {
        let uv = [input(Input::U), input(Input::V)];
        let (weight, spectrum) = (Expression::constant(1.0), DenseSpectrum::new(&constant(1.0)));
        let term = SpectrumTerm { weight, spectrum, color: Some(ColorTexture::Image { image: image.clone(), uv }) };
        let bsdf = Bsdf::lambert(&constant(0.5));
        let parameters = vec![Parameter::Reflectance(vec![term])];
        varying(vec![VaryingPart { weight: Expression::constant(1.0), bsdf, parameters }], DAffine3::IDENTITY)
    };
    for (x, y, wanted) in [(-0.9, 0.9, 0.1), (0.9, 0.9, 0.2), (-0.9, -0.9, 0.3), (0.9, -0.9, 0.4), (0.0, 0.0, 0.25)] {
        let mut stage = Stage::default();
        stage.environments.push(Environment::constant(&constant(1.0)));
        stage.surface(SurfaceShape::Rectangle { size: DVec2::splat(2.0) }, DAffine3::IDENTITY, floor());
        let camera = spot_camera(DVec3::new(x, y, 5.0), DVec3::new(x, y, 0.0));
        estimate(&render(&stage.build(), &camera, 1024, 1)).assert_is(wanted, 5e-3);
    }
}
