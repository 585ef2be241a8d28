//! Bsdfs, lights, cameras, samplers, film and integrators.
//!
//! An integrator sees a [`World`] and a camera, and gives a film: sums and weights per pixel and band, mergeable.
//! Every random number is a function of (seed, pixel, sample, dimension): same seed, same bytes, whatever the threads.

// (outline: the types Bsdf, AreaEmitter, Light, Environment and the function path_trace follow)
use arsc_accel::SceneGeometry as Scene;
pub enum Bsdf {}
pub enum AreaEmitter {}
pub enum Light {}
pub enum Environment {}

/// Scattering and emission of one material; indexed by [`arsc_accel::MaterialIndex`].
pub struct Material {
    pub bsdf: Bsdf,
    pub emitter: Option<AreaEmitter>,
}

/// Everything that light meets.
pub struct World {
    pub geometry: Scene,
    pub materials: Vec<Material>,
    /// Point and distant lights; emissive geometry and environments are found by `World::new`.
    pub lights: Vec<Light>,
    pub environments: Vec<Environment>,
}

/// What `path_trace` is asked for.
#[derive(Clone, Debug)]
pub struct PathTraceSettings {
    pub samples: u32,
    pub max_depth: u32,
    pub seed: u64,
    /// Pixels x0, y0, x1, y1 (end exclusive) of the full image; the rest stays empty.
    pub crop: Option<[u32; 4]>,
}

/// How a render reports and is stopped. Called from worker threads.
pub trait Progress: Sync {
    /// So many camera paths more are done.
    fn advance(&self, paths: u64);
    /// Asked between tiles and passes; when true the render ends early with what it has.
    fn cancelled(&self) -> bool;
}
