//! White furnaces: in a constant environment of radiance 1, whatever absorbs nothing vanishes.

use arsc_render::{Bsdf, Environment, Material};
use arsc_spectral::Spectrum;
use glam::DVec3;

use super::support::{camera, mean, render, sphere, world};

fn furnace(bsdf: Bsdf, samples: u32) -> f64 {
    let material = Material { bsdf, emitter: None };
    let environment = Environment::constant(&Spectrum::Constant(1.0));
    let world = world(&[sphere(DVec3::ZERO, 1.0)], vec![material], vec![], vec![environment]);
    // The sphere fills the picture from edge to edge and leaves the corners free.
    let film = render(&world, &camera(DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 0.5, 48), samples, 200);
    assert_eq!(film.rejected(), 0);
    mean(&film.to_image())
}

#[test]
fn lambert() {
    let m = furnace(Bsdf::lambert(&Spectrum::Constant(1.0)), 64);
    assert!((m - 1.0).abs() < 2e-3, "{m}");
}
#[test]
fn glass() {
    let m = furnace(Bsdf::dielectric(&Spectrum::Cauchy { a: 1.5, b_um2: 0.01, c_um4: 0.0 }), 64);
    assert!((m - 1.0).abs() < 2e-3, "{m}");
}
