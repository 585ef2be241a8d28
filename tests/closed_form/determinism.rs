//! The film is a function of scene, camera, samples and seed alone.

use std::sync::atomic::{AtomicU64, Ordering};

use arsc_render::{
    Bsdf, Camera, Environment, Film, FilterShape, Material, PathTraceSettings, Progress, ReconstructionFilter,
    Sampling, World, path_trace,
};
use arsc_spectral::Spectrum;
use glam::DVec3;

use super::support::{Stage, constant, emitter, lambert};

fn scene() -> (World, Camera) {
    let mut stage = Stage::default();
    stage.environments.push(Environment::constant(&constant(0.2)));
    stage.sphere(DVec3::new(0.0, 0.0, -10.0), 9.0, lambert(0.5));
    let glass = Bsdf::dielectric(&Spectrum::Cauchy { a: 1.5, b_um2: 0.01, c_um4: 0.0 });
    stage.sphere(DVec3::ZERO, 0.9, Material { bsdf: glass, ..Material::default() });
    stage.sphere(DVec3::new(2.0, 0.0, 1.0), 0.3, emitter(Spectrum::Blackbody { kelvin: 3000.0 }));
    let filter = ReconstructionFilter::new(FilterShape::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 });
    let camera = Camera::perspective(DVec3::new(0.0, -5.0, 1.0), DVec3::ZERO, DVec3::Z, 0.7, [50, 37], filter);
    (stage.build(), camera)
}

fn settings(samples: u32) -> PathTraceSettings {
    let sampling = Sampling { samples, seed: 7, ..Sampling::default() };
    PathTraceSettings { sampling, max_depth: 8, ..PathTraceSettings::default() }
}

fn on_threads(threads: usize, samples: u32, progress: &dyn Progress) -> Film {
    let (world, camera) = scene();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| path_trace(&world, &camera, &settings(samples), progress))
}

#[test]
fn any_number_of_threads_gives_the_same_film() {
    let one = on_threads(1, 9, &());
    assert_eq!(one, on_threads(3, 9, &()));
    assert_eq!(one.paths(), 50 * 37 * 9);
    assert_eq!(one.rejected(), 0);
}

#[test]
fn another_seed_gives_another_film() {
    let (world, camera) = scene();
    let mut other = settings(2);
    other.sampling.seed = 8;
    assert_ne!(path_trace(&world, &camera, &settings(2), &()), path_trace(&world, &camera, &other, &()));
}

#[test]
fn a_crop_has_the_pixels_of_the_whole() {
    let (world, camera) = scene();
    let crop = Some([7, 5, 33, 31]);
    let whole = path_trace(&world, &camera, &settings(3), &()).to_image();
    let mut cropped = settings(3);
    cropped.sampling.crop = crop;
    let part = path_trace(&world, &camera, &cropped, &()).to_image();
    for (i, (a, b)) in whole.xyz.iter().zip(&part.xyz).enumerate() {
        let inside = (7..33).contains(&(i % 50)) && (5..31).contains(&(i / 50));
        assert_eq!(*b, if inside { *a } else { [0.0; 3] }, "pixel {i}");
    }
}

/// Cancels after a number of tiles.
struct StopAfter {
    tiles: u64,
    done: AtomicU64,
    paths: AtomicU64,
}

impl Progress for StopAfter {
    fn advance(&self, paths: u64) {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.paths.fetch_add(paths, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.done.load(Ordering::Relaxed) >= self.tiles
    }
}

/// 12 tiles a pass of 1, 1, 2, 4, 8 … samples: 40 tiles end within the fourth pass.
#[test]
fn a_cancelled_render_has_similar_counts_everywhere() {
    let stop = StopAfter { tiles: 40, done: AtomicU64::new(0), paths: AtomicU64::new(0) };
    let film = on_threads(1, 1000, &stop);
    assert_eq!(film.samples_per_pixel(), (4, 8));
    assert_eq!(film.paths(), stop.paths.into_inner());
    let stop = StopAfter { tiles: 0, done: AtomicU64::new(0), paths: AtomicU64::new(0) };
    assert_eq!(on_threads(2, 1000, &stop).paths(), 0);
}
