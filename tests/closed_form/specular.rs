//! Mirrors, glass and metal, seen to reflect a large light.

use arsc_accel::{Shape, SurfaceShape};
use arsc_render::{Bsdf, Material, fresnel};
use arsc_spectral::{SampledSpectrum, Spectrum};
use glam::{DAffine3, DQuat, DVec3};

use super::support::{Estimate, Stage, constant, emitter, estimate, estimate_bands, render, spot_camera};

/// Looks at the ground z <= 0 under an angle; the mirrored direction meets a disk of radiance 1 that faces it.
fn reflection(bsdf: Bsdf, angle: f64, samples: u32) -> arsc_image::SpectralImage {
    let mut stage = Stage::default();
    stage.solid(Shape::HalfSpace, DAffine3::IDENTITY, Material { bsdf, ..Material::default() });
    let towards = DVec3::new(angle.sin(), 0.0, angle.cos());
    let place = DAffine3::from_rotation_translation(DQuat::from_rotation_arc(DVec3::Z, -towards), towards * 3.0);
    stage.surface(SurfaceShape::Disk { radius: 0.05 }, place, emitter(constant(1.0)));
    let eye = DVec3::new(-towards.x, 0.0, towards.z);
    render(&stage.build(), &spot_camera(eye, DVec3::ZERO), samples, 4)
}

const ANGLES: [f64; 6] = [0.2, 0.6, 0.9826, 1.2, 1.4, 1.55];

#[test]
fn mirror() {
    for angle in ANGLES {
        let Estimate { mean, .. } = estimate(&reflection(Bsdf::mirror(&constant(0.7)), angle, 4));
        assert!((mean - 0.7).abs() < 1e-6, "{mean} at {angle}");
    }
}

/// Reflectance of glass from both of Fresnel's equations. 0.9826 is near Brewster's angle. The number of reflected paths
/// among a pixel's N = 2^12 is N R to within one, because the choice is stratified: the bound is 1 / N, without
/// chance. (Independent choices would give a standard error of 2 sqrt(R) 1e-3 on the mean of all 64 pixels.)
#[test]
fn glass() {
    for angle in ANGLES {
        let n: f64 = 1.5;
        let cos_t = (1.0 - (angle.sin() / n).powi(2)).sqrt();
        let s = (angle.cos() - n * cos_t) / (angle.cos() + n * cos_t);
        let p = (n * angle.cos() - cos_t) / (n * angle.cos() + cos_t);
        let exact = 0.5 * (s * s + p * p);
        let Estimate { mean, .. } = estimate(&reflection(Bsdf::dielectric(&constant(n)), angle, 4096));
        assert!((mean - exact).abs() < 1.0 / 4096.0, "{mean} instead of {exact} at {angle}");
    }
}

/// With dispersion every band has the reflectance of its own index, here from 0.068 in the violet to 0.046 in the red.
/// Means over groups of bands; 65 536 paths.
#[test]
fn dispersive_glass() {
    let ior = Spectrum::Cauchy { a: 1.5, b_um2: 0.03, c_um4: 0.0 };
    let angle: f64 = 0.6;
    let image = reflection(Bsdf::dielectric(&ior), angle, 2048);
    for group in [0..8, 8..20, 20..47] {
        let lambda = |band: usize| 0.5 * (image.band_edges_nm[band] + image.band_edges_nm[band + 1]);
        let reflectance = |band: usize| fresnel::dielectric(angle.cos(), ior.eval(lambda(band))).0;
        let exact = group.clone().map(reflectance).sum::<f64>() / group.len() as f64;
        estimate_bands(&image, group).assert_is(exact, 2e-2);
    }
}

/// Without noise: metal reflects every path.
#[test]
fn metal() {
    let (eta, k) = (0.27, 2.95);
    for angle in ANGLES {
        let splat = SampledSpectrum::splat;
        let exact = f64::from(fresnel::conductor(angle.cos() as f32, splat(eta), splat(k)).hero());
        let bsdf = Bsdf::conductor(&constant(f64::from(eta)), &constant(f64::from(k)));
        let Estimate { mean, .. } = estimate(&reflection(bsdf, angle, 4));
        assert!((mean - exact).abs() < 1e-6, "{mean} instead of {exact} at {angle}");
    }
}

/// A light inside a block of glass looks dimmer by its two losses at the surface: (1 - R) on the way out, and radiance
/// shrinks by the squared index. The number of refracted paths is stratified as above.
#[test]
fn refraction_changes_radiance_by_the_squared_index() {
    let n: f64 = 1.5;
    let mut stage = Stage::default();
    let glass = Material { bsdf: Bsdf::dielectric(&constant(n)), ..Material::default() };
    stage.solid(Shape::HalfSpace, DAffine3::IDENTITY, glass);
    let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, -1.0));
    stage.surface(SurfaceShape::Disk { radius: 1.0 }, place, emitter(constant(1.0)));
    let camera = spot_camera(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO);
    let Estimate { mean, .. } = estimate(&render(&stage.build(), &camera, 4096, 4));
    assert!((mean - 0.96 / (n * n)).abs() < 1.0 / 4096.0, "{mean}");
}
