//! The suite for coats over bases, whose values are random: what holds of other bsdfs holds of their means.

use arsc_spectral::{SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;
use rand::Rng;

use super::mueller::assert_physical;
use super::{assert_directions_follow, mean, pair, random};
use crate::bsdf::{Bsdf, MicrofacetShape, Microfacets};
use crate::fresnel::Interface;
use crate::polarisation::{Polarised, Unpolarised};

fn wavelengths() -> SampledWavelengths {
    SampledWavelengths::fixed([420.0, 530.0, 600.0, 700.0])
}

fn constant(value: f64) -> Spectrum {
    Spectrum::Constant(value)
}

fn facets(alpha: f64) -> Microfacets {
    Microfacets::new(MicrofacetShape::Ggx, [alpha; 2])
}

fn glass(alpha: f64) -> Bsdf {
    if alpha == 0.0 { Bsdf::dielectric(&constant(1.5)) } else { Bsdf::rough_dielectric(&constant(1.5), facets(alpha)) }
}

fn over(coat: &Bsdf, base: &Bsdf, depth: f64) -> Bsdf {
    Bsdf::layered(coat, base, &constant(depth)).expect("a coat over a base")
}

fn bases() -> [Bsdf; 4] {
    [
        Bsdf::lambert(&constant(1.0)),
        Bsdf::oren_nayar(&constant(1.0), 0.3),
        Bsdf::rough_conductor(&constant(0.2), &constant(3.0), facets(0.3)),
        Bsdf::phong(&constant(1.0), 10.0),
    ]
}

fn at(theta: f64, turn: f64) -> DVec3 {
    DVec3::new(theta.sin() * turn.cos(), theta.sin() * turn.sin(), theta.cos())
}

/// Mean of f over thousands of turns of both directions about the normal: an isotropic bsdf is the same, its random numbers are not.
fn mean_value(bsdf: &Bsdf, theta_o: f64, theta_i: f64, between: f64) -> (f64, f64) {
    let values = (0..8000).map(|i| {
        let turn = f64::from(i) * 0.01;
        f64::from(bsdf.eval::<Unpolarised>(at(theta_o, turn), at(theta_i, turn + between), &wavelengths()).hero())
    });
    mean(values)
}

/// Directional albedo: mean weight of samples.
fn albedo(bsdf: &Bsdf, wo: DVec3) -> (f64, f64) {
    let (mut random, w) = (random(), wavelengths());
    mean((0..100_000).map(|_| {
        let sample = bsdf.sample::<Unpolarised>(wo, pair(&mut random), random.random(), &w);
        sample.map_or(0.0, |sample| f64::from(sample.weight.hero()))
    }))
}

fn assert_same(name: &str, (a, a_error): (f64, f64), (b, b_error): (f64, f64), slack: f64) {
    let error = 5.0 * a_error.hypot(b_error) + slack;
    assert!((a - b).abs() < error && error < 0.1 * b.max(0.05), "{name}: {a} and {b}, within {error}");
}

/// Samples that are not specular follow the density, as far as it goes; weights are f cos over it.
#[test]
fn samples_agree_with_densities_and_values() {
    let w = wavelengths();
    for (alpha, base) in [0.0, 0.4].into_iter().flat_map(|alpha| bases().map(|base| (alpha, base))) {
        let bsdf = over(&glass(alpha), &base, 0.1);
        for wo in [at(0.3, 1.0), -at(0.9, 2.0)] {
            let pdf = |wi: DVec3| f64::from(bsdf.pdf(wo, wi, &w).hero());
            let sample = |random: &mut _| {
                let (u, lobe) = (pair(random), random.random());
                let sample = bsdf.sample::<Unpolarised>(wo, u, lobe, &w)?;
                (!sample.specular).then_some(sample.wi)
            };
            assert_directions_follow(&format!("{bsdf:?}"), sample, pdf);
            let mut random = random();
            for _ in 0..200 {
                let (u, lobe) = (pair(&mut random), random.random());
                let Some(sample) = bsdf.sample::<Unpolarised>(wo, u, lobe, &w) else { continue };
                let polarised = bsdf.sample::<Polarised>(wo, u, lobe, &w).expect("the same choice");
                assert_eq!((sample.wi, sample.pdf), (polarised.wi, polarised.pdf));
                assert_physical("layered", &polarised.weight);
                if !sample.specular {
                    assert!((sample.pdf / pdf(sample.wi) - 1.0).abs() < 1e-6);
                    let expected =
                        bsdf.eval::<Unpolarised>(wo, sample.wi, &w) * (sample.wi.z.abs() / sample.pdf) as f32;
                    assert!((sample.weight - expected).0.abs().max_element() < 1e-5 * expected.max().max(1.0));
                }
            }
        }
    }
}

/// In the mean f(a, b) = f(b, a).
#[test]
fn values_are_reciprocal_in_the_mean() {
    for (alpha, base) in [0.0, 0.4].into_iter().flat_map(|alpha| bases().map(|base| (alpha, base))) {
        let bsdf = over(&glass(alpha), &base, 0.2);
        for (a, b, between) in [(0.2, 1.0, 2.5), (0.7, 1.3, 0.4)] {
            let name = format!("{alpha} over {base:?}");
            assert_same(&name, mean_value(&bsdf, a, b, between), mean_value(&bsdf, b, a, -between), 1e-6);
        }
    }
}

/// White under clear glass in a white furnace: all comes back. Rough coats lose what meets two facets, and no more than on
/// both of their own sides.
#[test]
fn white_furnaces() {
    let white = Bsdf::lambert(&constant(1.0));
    for theta in [0.1, 0.8, 1.4] {
        let wo = at(theta, 0.7);
        assert_same("closed form", albedo(&over(&glass(0.0), &white, 0.0), wo), (1.0, 0.0), 1e-3);
        let walk = over(&glass(0.0), &Bsdf::oren_nayar(&constant(1.0), 0.0), 0.0);
        assert_same("walk", albedo(&walk, wo), (1.0, 0.0), 1e-3);
        let (rough, error) = albedo(&over(&glass(0.3), &white, 0.0), wo);
        assert!(rough < 1.0 + 5.0 * error && rough > 0.6, "{rough} +- {error}");
        let smoothed = albedo(&over(&glass(0.003), &white, 0.0), wo);
        assert_same("nearly smooth", smoothed, (1.0, 0.0), 1e-2);
    }
}

/// Lambert under clear and tinted glass: T T' rho / (pi n^2 (1 - rho F)), with F by quadrature of its own, against the closed form
/// and against the walk.
#[test]
fn coated_lambert_is_the_known_integral() {
    let (n, rho) = (1.5f64, 0.6);
    for depth in [0.0, 0.35] {
        let steps = 200_000;
        let back: f64 = (0..steps)
            .map(|i| {
                let mu = (f64::from(i) + 0.5) / f64::from(steps);
                2.0 * mu * Interface::new(mu, 1.0 / n).reflectance() * (-2.0 * depth / mu).exp() / f64::from(steps)
            })
            .sum();
        let (closed, walk) = (Bsdf::lambert(&constant(rho)), Bsdf::oren_nayar(&constant(rho), 0.0));
        for (a, b) in [(0.2f64, 1.0f64), (0.7, 1.3)] {
            let [enter, leave] = [a, b].map(|theta| Interface::new(theta.cos(), n));
            let transmitted = (1.0 - enter.reflectance()) * (1.0 - leave.reflectance());
            let film = (-depth / enter.cos_t - depth / leave.cos_t).exp();
            let exact = transmitted * film * rho / (std::f64::consts::PI * n * n * (1.0 - rho * back));
            let value = mean_value(&over(&glass(0.0), &closed, depth), a, b, 1.0);
            assert!((value.0 / exact - 1.0).abs() < 1e-4, "{} instead of {exact}", value.0);
            assert_same("walk", mean_value(&over(&glass(0.0), &walk, depth), a, b, 1.0), (exact, 0.0), 0.0);
            assert_same("rough", mean_value(&over(&glass(0.002), &walk, depth), a, b, 1.0), (exact, 0.0), 5e-3 * exact);
        }
    }
}

/// A mirror behind a film of nearly no index is Beer's law; behind glass the series of all reflections, s and p apart; and
/// rough metal that is nearly smooth has the albedo of smooth metal.
#[test]
fn mirrors_behind_films() {
    let (w, theta) = (wavelengths(), 0.9f64);
    let wo = at(theta, 0.3);
    let weight = |bsdf: &Bsdf| bsdf.sample::<Unpolarised>(wo, [0.5; 2], 0.5, &w).expect("a reflection").weight.hero();
    let mirror = Bsdf::mirror(&constant(0.9));
    let air = Bsdf::layered(&Bsdf::dielectric(&constant(1.0)), &mirror, &constant(0.4)).expect("a film");
    let beer = 0.9 * (-0.8 / theta.cos()).exp();
    assert!((f64::from(weight(&air)) - beer).abs() < 1e-6);
    let outside = Interface::new(theta.cos(), 1.5);
    let twice = 0.9 * (-0.8 / outside.cos_t).exp();
    let both = [outside.rs, outside.rp].map(|r| {
        let mut sum = r;
        let mut light = (1.0 - r) * twice;
        for _ in 0..100 {
            sum += light * (1.0 - r);
            light *= r * twice;
        }
        sum
    });
    let coated = over(&glass(0.0), &mirror, 0.4);
    assert!(coated.is_specular());
    assert!((f64::from(weight(&coated)) - 0.5 * (both[0] + both[1])).abs() < 1e-6);
    let polarised = coated.sample::<Polarised>(wo, [0.5; 2], 0.5, &w).expect("a reflection").weight;
    assert!((f64::from(polarised.m[1][0].hero()) - 0.5 * (both[0] - both[1])).abs() < 1e-6);
    assert_physical("coated mirror", &polarised);
    // Gold-like metal: the index counts against the film's.
    let (eta, k) = (constant(0.3), constant(2.9));
    let smooth = over(&glass(0.0), &Bsdf::conductor(&eta, &k), 0.1);
    let rough = over(&glass(0.0), &Bsdf::rough_conductor(&eta, &k, facets(0.01)), 0.1);
    let lost = f64::from(SampledSpectrum::splat(weight(&smooth)).hero());
    assert_same("nearly smooth metal", albedo(&rough, wo), (lost, 0.0), 5e-3);
    assert_same("both rough", albedo(&over(&glass(0.01), &Bsdf::conductor(&eta, &k), 0.1), wo), (lost, 0.0), 2e-2);
}

/// Parts that are no coat or no base; directions that graze.
#[test]
fn other_parts_are_refused_and_grazing_light_survives() {
    let (white, clear) = (Bsdf::lambert(&constant(1.0)), glass(0.0));
    assert!(Bsdf::layered(&white, &white, &constant(0.0)).is_none());
    assert!(Bsdf::layered(&clear, &clear, &constant(0.0)).is_none());
    assert!(Bsdf::layered(&clear, &over(&clear, &white, 0.0), &constant(0.0)).is_none());
    let (mut random, w) = (random(), wavelengths());
    for (alpha, base) in [0.0, 0.4].into_iter().flat_map(|alpha| bases().map(|base| (alpha, base))) {
        let bsdf = over(&glass(alpha), &base, 3.0);
        for z in [0.0, 1e-300, 1e-9, -1e-9, 1.0, -1.0f64] {
            let wo = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
            for _ in 0..100 {
                let Some(sample) = bsdf.sample::<Unpolarised>(wo, pair(&mut random), random.random(), &w) else {
                    continue;
                };
                assert!(sample.weight.is_valid() && (sample.wi.length() - 1.0).abs() < 1e-9, "{sample:?} from {wo}");
                assert!(bsdf.pdf(wo, sample.wi, &w).is_valid());
            }
        }
    }
}
