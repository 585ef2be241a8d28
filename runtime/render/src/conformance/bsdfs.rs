//! The suite for bsdfs.

use std::f64::consts::FRAC_PI_2;

use arsc_spectral::{Dye, Fluorescence, MerlBrdf, Reradiation, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;
use rand::Rng;

use super::mueller::assert_physical;
use super::{assert_directions_follow, mean, pair, random};
use crate::bsdf::{Bsdf, MicrofacetShape, Microfacets};
use crate::polarisation::{Mueller, Polarised, ReferenceFrame, Unpolarised};

/// From the zenith to almost grazing, above the surface and below.
fn directions() -> Vec<DVec3> {
    let angles = [0.0, 0.3, 0.8, 1.2, 1.5, FRAC_PI_2 - 1e-4, FRAC_PI_2 - 1e-8];
    let above = angles.iter().enumerate().map(|(i, angle)| {
        let (sin, cos) = (i as f64 * 1.3).sin_cos();
        DVec3::new(angle.sin() * cos, angle.sin() * sin, angle.cos())
    });
    above.flat_map(|w| [w, DVec3::new(w.x, w.y, -w.z)]).collect()
}

fn wavelengths() -> SampledWavelengths {
    SampledWavelengths::fixed([420.0, 530.0, 600.0, 700.0])
}

/// Everything at once.
fn assert_conforms(bsdf: &Bsdf) {
    assert_interface_conforms(bsdf, &constant(1.0));
}

/// Of an interface between vacuum above and a medium of this index below.
fn assert_interface_conforms(bsdf: &Bsdf, ior: &Spectrum) {
    // Towards grazing, densities of facets have edges that the test's quadrature does not resolve.
    let has_facets = matches!(bsdf, Bsdf::RoughConductor(_) | Bsdf::RoughDielectric(_));
    for (i, wo) in directions().into_iter().enumerate() {
        if !bsdf.is_specular() && (!has_facets || [0, 5, 8].contains(&i)) {
            let name = format!("{bsdf:?} at {wo}");
            let sample = |random: &mut _| {
                let (u, lobe) = (pair(random), random.random());
                bsdf.sample::<Unpolarised>(wo, u, lobe, &wavelengths()).map(|sample| sample.wi)
            };
            assert_directions_follow(&name, sample, |wi| hero_pdf(bsdf, wo, wi));
        }
        if !bsdf.is_specular() {
            samples_agree_with_values(bsdf, wo);
        }
        gains_no_energy(bsdf, ior, wo);
        polarises_physically(bsdf, wo);
    }
    is_reciprocal(bsdf, ior);
    survives_grazing(bsdf);
}

fn hero_pdf(bsdf: &Bsdf, wo: DVec3, wi: DVec3) -> f64 {
    f64::from(bsdf.pdf(wo, wi, &wavelengths()).hero())
}

/// The sample's weight is f cos / pdf, its pdf is that of `pdf`, as is the ratio of the pdfs at the other wavelengths.
fn samples_agree_with_values(bsdf: &Bsdf, wo: DVec3) {
    let (mut random, w) = (random(), wavelengths());
    for _ in 0..1000 {
        let Some(sample) = bsdf.sample::<Unpolarised>(wo, pair(&mut random), random.random(), &w) else { continue };
        let pdfs = bsdf.pdf(wo, sample.wi, &w);
        let pdf = f64::from(pdfs.hero());
        assert!((sample.pdf / pdf - 1.0).abs() < 1e-6, "{bsdf:?}");
        let ratios = pdfs * (1.0 / pdfs.hero()) - sample.path_pdf;
        assert!(ratios.0.abs().max_element() < 1e-5 * sample.path_pdf.max(), "{bsdf:?}: {sample:?}, {pdfs:?}");
        let expected = bsdf.eval::<Unpolarised>(wo, sample.wi, &w) * (sample.wi.z.abs() / pdf) as f32;
        let difference = (sample.weight - expected).0.abs().max_element();
        assert!(difference < 1e-5 * expected.max().max(1.0), "{bsdf:?}: {sample:?}, {expected:?}");
        assert!(!sample.specular && (sample.eta == 1.0 || sample.wi.z * wo.z < 0.0));
    }
}

/// The mean weight of 20 000 samples, radiance counted per squared index, is at most 1 at every wavelength. Wavelengths are
/// combined as in a path: weight over mean path pdf.
fn gains_no_energy(bsdf: &Bsdf, ior: &Spectrum, wo: DVec3) {
    for component in 0..4 {
        let (mut random, w) = (random(), wavelengths());
        let (mean, error) = mean((0..20_000).map(|_| {
            // Rotated, so that every wavelength is the hero equally often.
            let hero = random.random_range(0..4usize);
            let lambda = w.lambda_nm.to_array();
            let rotated = SampledWavelengths::fixed(std::array::from_fn(|i| f64::from(lambda[(i + hero) % 4])));
            bsdf.sample::<Unpolarised>(wo, pair(&mut random), random.random(), &rotated).map_or(0.0, |sample| {
                let weight = sample.weight.0.to_array()[(component + 4 - hero) % 4] / sample.path_pdf.mean();
                let index = if sample.wi.z * wo.z < 0.0 { ior.eval(f64::from(lambda[component])) } else { 1.0 };
                let relative = if wo.z > 0.0 { index } else { 1.0 / index };
                f64::from(weight) * relative * relative
            })
        }));
        assert!(mean <= 1.0 + 5.0 * error + 1e-6, "{bsdf:?} returns {mean} +- {error} of what comes from {wo}");
    }
}

/// With polarisation, samples go the same ways with the same intensity; their matrices are physical, and refer to
/// frames about the directions. So do the matrices of `eval`.
fn polarises_physically(bsdf: &Bsdf, wo: DVec3) {
    let (mut random, w) = (random(), wavelengths());
    for _ in 0..200 {
        let (u, u_lobe) = (pair(&mut random), random.random());
        let plain = bsdf.sample::<Unpolarised>(wo, u, u_lobe, &w);
        let Some(sample) = bsdf.sample::<Polarised>(wo, u, u_lobe, &w) else {
            assert!(plain.is_none());
            continue;
        };
        let plain = plain.expect("the same choice");
        assert!(plain.wi == sample.wi && plain.pdf == sample.pdf && plain.path_pdf == sample.path_pdf, "{bsdf:?}");
        assert_eq!(plain.weight, sample.weight.intensity(), "{bsdf:?}");
        let name = format!("{bsdf:?} from {wo} to {}", sample.wi);
        let value = bsdf.eval::<Polarised>(wo, sample.wi, &w);
        assert_eq!(value.intensity(), bsdf.eval::<Unpolarised>(wo, sample.wi, &w));
        for matrix in [sample.weight, value] {
            assert_physical(&name, &matrix);
            for (frame, k) in [(matrix.outgoing, wo), (matrix.incoming, -sample.wi)] {
                let free = frame == ReferenceFrame::default();
                assert!(free || (frame.x.cross(frame.y) - k).length() < 1e-9, "{name}: {frame:?} about {k}");
            }
        }
    }
}

/// f(a, b) over the squared index on the side of b is symmetric, to within rounding of what is large at grazing angles.
fn is_reciprocal(bsdf: &Bsdf, ior: &Spectrum) {
    let w = wavelengths();
    let basic = |a: DVec3, b: DVec3| {
        let index =
            w.lambda_nm.to_array().map(|lambda| if b.z < 0.0 { ior.eval(f64::from(lambda)) as f32 } else { 1.0 });
        let index = SampledSpectrum(index.into());
        bsdf.eval::<Unpolarised>(a, b, &w) * index * index
    };
    for a in directions() {
        for b in directions() {
            let (forth, back) = (basic(a, b), basic(b, a));
            let difference = (forth - back).0.abs().max_element();
            let bound = 1e-6 + 1e-5 * forth.max();
            assert!(difference < bound, "{bsdf:?}: f({a}, {b}) and f({b}, {a}) differ by {difference}");
        }
    }
}

/// Nothing but finite numbers and unit vectors, whatever the direction.
fn survives_grazing(bsdf: &Bsdf) {
    let (mut random, w) = (random(), wavelengths());
    for z in [0.0, 1e-300, 1e-18, 1e-9, -1e-9, -1e-300, 1.0, -1.0f64] {
        let wo = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
        for _ in 0..100 {
            let u = [random.random(), [0.0, 1.0 - 1e-10, random.random()][random.random_range(0..3)]];
            let Some(sample) = bsdf.sample::<Unpolarised>(wo, u, random.random(), &w) else { continue };
            assert!(sample.weight.is_valid() && sample.path_pdf.is_valid(), "{bsdf:?} at {wo}: {sample:?}");
            assert!((sample.wi.length() - 1.0).abs() < 1e-9 && sample.pdf > 0.0, "{bsdf:?} at {wo}: {sample:?}");
            assert!(bsdf.eval::<Unpolarised>(wo, sample.wi, &w).is_valid() && bsdf.pdf(wo, sample.wi, &w).is_valid());
        }
    }
}

fn constant(value: f64) -> Spectrum {
    Spectrum::Constant(value)
}

#[test]
fn lambert() {
    assert_conforms(&Bsdf::lambert(&constant(1.0)));
    assert_conforms(&Bsdf::lambert(&constant(7.0)));
}

#[test]
fn oren_nayar() {
    for sigma in [0.0, 0.2, 0.5, 1.2] {
        assert_conforms(&Bsdf::oren_nayar(&constant(1.0), sigma));
    }
}

/// What keeps its wavelength.
#[test]
fn fluorescent() {
    let dye = Dye { absorption: constant(0.5), emission: constant(1.0), quantum_yield: 1.0 };
    let reradiation = Reradiation { reflectance: constant(0.5), fluorescence: Fluorescence::Dye(dye) };
    for sigma in [0.0, 0.5] {
        assert_conforms(&Bsdf::reradiating(&reradiation, sigma));
    }
}

#[test]
fn mirror() {
    assert_conforms(&Bsdf::mirror(&constant(1.0)));
}

#[test]
fn dielectric() {
    let dispersive = Spectrum::Cauchy { a: 1.5, b_um2: 0.05, c_um4: 0.0 };
    for ior in [constant(1.0), constant(1.5), constant(0.7), dispersive] {
        assert_interface_conforms(&Bsdf::dielectric(&ior), &ior);
    }
}

#[test]
fn conductor() {
    for (eta, k) in [(0.05, 4.0), (1.5, 0.0), (2.0, 3.0), (0.0, 0.0)] {
        assert_conforms(&Bsdf::conductor(&constant(eta), &constant(k)));
    }
}

#[test]
fn thin_dielectric() {
    for ior in [1.0, 1.5, 0.7] {
        assert_conforms(&Bsdf::thin_dielectric(&constant(ior)));
    }
    assert_conforms(&Bsdf::thin_dielectric(&Spectrum::Cauchy { a: 1.5, b_um2: 0.05, c_um4: 0.0 }));
}

#[test]
fn phong() {
    // An exponent of 0 has an edge in mid-air, which the quadrature of the chi-square test does not resolve.
    for exponent in [1.0, 3.5, 20.0] {
        assert_conforms(&Bsdf::phong(&constant(1.0), exponent));
    }
}

/// Tables of known functions: of Lambert's, coloured, and of a lobe about the half vector with a term in all three angles.
#[test]
fn measured() {
    let even = Bsdf::measured(MerlBrdf::from_fn(|_| [0.3, 0.2, 0.1]).into());
    let lobe = MerlBrdf::from_fn(|[h, d, t]| {
        [0.1, 0.05, 0.02].map(|c| c + 0.3 * h.cos().powi(40) * (1.0 + 0.1 * d * (2.0 * t).cos()))
    });
    assert_conforms(&even);
    assert_conforms(&Bsdf::measured(lobe.into()));
    assert_conforms(&Bsdf::measured(MerlBrdf::from_fn(|_| [0.0; 3]).into()));
    let grey = Bsdf::measured(MerlBrdf::from_fn(|_| [0.25; 3]).into());
    let value = grey.eval::<Unpolarised>(directions()[4], directions()[6], &wavelengths());
    assert!((value.hero() - 0.25).abs() < 1e-6, "{value:?}");
}

#[test]
fn flat_elements() {
    assert_conforms(&Bsdf::polariser(&constant(0.9), 0.7));
    assert_conforms(&Bsdf::retarder(1.2, 0.3));
    assert_conforms(&Bsdf::depolariser(&constant(1.0)));
}

const SHAPES: [MicrofacetShape; 3] = [MicrofacetShape::Ggx, MicrofacetShape::Beckmann, MicrofacetShape::Blinn];

#[test]
fn rough_conductor() {
    for (shape, alpha) in SHAPES.into_iter().flat_map(|shape| [[0.3; 2], [0.4, 0.8]].map(|a| (shape, a))) {
        let facets = Microfacets::new(shape, alpha);
        assert_conforms(&Bsdf::rough_conductor(&constant(0.27), &constant(2.95), facets));
    }
}

#[test]
fn rough_dielectric() {
    let dispersive = Spectrum::Cauchy { a: 1.4, b_um2: 0.06, c_um4: 0.0 };
    for (shape, ior, alpha) in [
        (MicrofacetShape::Ggx, constant(1.5), [0.4, 0.8]),
        (MicrofacetShape::Ggx, dispersive, [0.5; 2]),
        (MicrofacetShape::Beckmann, constant(0.7), [0.5, 0.3]),
        (MicrofacetShape::Blinn, constant(1.5), [0.5; 2]),
    ] {
        assert_interface_conforms(&Bsdf::rough_dielectric(&ior, Microfacets::new(shape, alpha)), &ior);
    }
}

/// Mirror-like facets (their index is infinite) seen from the zenith and from 60 degrees: the mean weight of samples is the
/// directional albedo by quadrature of f cos, to 5 standard errors. Both lie below 1 by what Smith's model loses.
#[test]
fn directional_albedo_is_that_of_the_values() {
    let w = wavelengths();
    for (shape, alpha) in SHAPES.into_iter().flat_map(|shape| [[0.3; 2], [0.5, 0.9]].map(|a| (shape, a))) {
        let bsdf = Bsdf::rough_conductor(&constant(0.001), &constant(1000.0), Microfacets::new(shape, alpha));
        for theta in [0.0, 1.0f64] {
            let wo = DVec3::new(theta.sin(), 0.0, theta.cos());
            const N: usize = 500;
            let mut integral = 0.0;
            for i in 0..N * N {
                let [z, turn] = [i / N, i % N].map(|k| (k as f64 + 0.5) / N as f64);
                let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
                let r = (1.0 - z * z).sqrt();
                let value = f64::from(bsdf.eval::<Unpolarised>(wo, DVec3::new(r * cos, r * sin, z), &w).hero());
                integral += value * z * std::f64::consts::TAU / (N * N) as f64;
            }
            let mut random = random();
            let (albedo, error) = mean((0..100_000).map(|_| {
                let sample = bsdf.sample::<Unpolarised>(wo, pair(&mut random), random.random(), &w);
                sample.map_or(0.0, |sample| f64::from(sample.weight.hero()))
            }));
            assert!(
                (albedo - integral).abs() < 5.0 * error + 1e-3,
                "{shape:?} {alpha:?}: {albedo} +- {error}, {integral}"
            );
            assert!(albedo < 1.0 && albedo > 0.4, "{albedo}");
        }
    }
}

/// Oren and Nayar's equation 30 in its own variables, at sigma 0.5 where no scaling takes place.
#[test]
fn oren_nayar_is_the_published_function() {
    let sigma2: f64 = 0.25;
    let (a, b) = (1.0 - 0.5 * sigma2 / (sigma2 + 0.33), 0.45 * sigma2 / (sigma2 + 0.09));
    let bsdf = Bsdf::oren_nayar(&constant(0.7), 0.5);
    for (theta_o, theta_i, dphi) in [(0.2, 0.9, 0.4), (1.3, 0.5, 1.2), (0.8, 0.8, 2.5), (1.4, 1.4, 0.0f64)] {
        let (theta_o, theta_i): (f64, f64) = (theta_o, theta_i);
        let wo = DVec3::new(theta_o.sin(), 0.0, theta_o.cos());
        let wi = DVec3::new(theta_i.sin() * dphi.cos(), theta_i.sin() * dphi.sin(), theta_i.cos());
        let (alpha, beta) = (theta_o.max(theta_i), theta_o.min(theta_i));
        let exact = 0.7 / std::f64::consts::PI * (a + b * dphi.cos().max(0.0) * alpha.sin() * beta.tan());
        let got = f64::from(bsdf.eval::<Unpolarised>(wo, wi, &wavelengths()).hero());
        assert!((got / exact - 1.0).abs() < 1e-6, "{got} instead of {exact}");
    }
}

/// Snell's law and the plane of incidence, both ways.
#[test]
fn refraction_obeys_snell() {
    let bsdf = Bsdf::dielectric(&constant(1.5));
    for wo in directions() {
        let Some(sample) = bsdf.sample::<Unpolarised>(wo, [0.5; 2], 1.0, &wavelengths()) else { continue };
        if sample.wi.z * wo.z > 0.0 {
            continue; // total reflection
        }
        let eta = if wo.z > 0.0 { 1.5 } else { 1.0 / 1.5 };
        assert!((sample.wi.truncate() * eta + wo.truncate()).length() < 1e-12);
        assert_eq!(sample.eta, eta);
    }
}
