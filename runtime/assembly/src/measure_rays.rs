//! Rays alone, on one thread: what `arsc bench --rays` times and what `tests/bench/csg` compares with other programs.
//!
//! One primary ray through the centre of every pixel, in blocks as renderers go through a picture; from every hit whose
//! surface faces the script's first point light one shadow ray to it. Nothing is shaded. The clock is the caller's and
//! should be the processor time of the calling thread.

use arsc_accel::{BuildStats, Scene};
use arsc_ir::Ir;
use arsc_render::Camera;
use glam::{DVec2, DVec3};

use crate::stage::Stage;
use crate::{AssemblyError, Host, Settings, lights};

/// Side of a block of pixels.
const BLOCK: u32 = 32;

/// Primary rays whose tests are counted, at most.
const COUNTED: usize = 20_000;

/// What the primary ray of a pixel met, and its shadow ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    Nothing,
    /// A surface that the light does not reach.
    Dark,
    Lit,
}

/// What was measured.
#[derive(Clone, Debug)]
pub struct RayMeasurement {
    pub scene: BuildStats,
    pub resolution: [u32; 2],
    /// By rows from the top.
    pub sights: Vec<Sight>,
    pub shadow_rays: u64,
    /// Mean over primary rays of the leaves and surfaces that were tested.
    pub tests_per_ray: f64,
    /// Of each repetition, by the caller's clock.
    pub seconds: Vec<f64>,
}

impl RayMeasurement {
    pub fn hits(&self) -> u64 {
        self.sights.iter().filter(|&&sight| sight != Sight::Nothing).count() as u64
    }

    pub fn lit(&self) -> u64 {
        self.sights.iter().filter(|&&sight| sight == Sight::Lit).count() as u64
    }

    pub fn rays(&self) -> u64 {
        self.sights.len() as u64 + self.shadow_rays
    }

    /// Seconds of the fastest repetition.
    pub fn best_seconds(&self) -> f64 {
        self.seconds.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// Traces the picture `repeat` times (at least once) on this thread.
pub fn measure_rays(
    ir: &Ir,
    settings: &Settings,
    host: &dyn Host,
    repeat: u32,
    clock: &dyn Fn() -> f64,
) -> Result<RayMeasurement, AssemblyError> {
    let light = lights::first_point(ir)?
        .ok_or_else(|| AssemblyError::Settings("rays are measured in scenes with a point light".into()))?;
    let stage = Stage::new(ir, settings, host)?;
    let strategy = settings.strategy.unwrap_or_default();
    let world = stage.world(strategy)?;
    let scene = &world.geometry;
    let (camera, crop) = stage.camera(strategy)?;
    let pixels = settings.pixels(camera.resolution(), crop)? as usize;
    let mut measured = RayMeasurement {
        scene: *scene.stats(),
        resolution: camera.resolution(),
        sights: vec![Sight::Nothing; pixels],
        shadow_rays: 0,
        tests_per_ray: tests_per_ray(scene, &camera),
        seconds: Vec::new(),
    };
    for _ in 0..repeat.max(1) {
        let start = clock();
        measured.shadow_rays = trace(scene, &camera, light, &mut measured.sights);
        measured.seconds.push(clock() - start);
    }
    Ok(measured)
}

/// Fills the picture; gives the number of shadow rays.
fn trace(scene: &Scene, camera: &Camera, light: DVec3, sights: &mut [Sight]) -> u64 {
    let [width, height] = camera.resolution();
    let mut shadow_rays = 0;
    for top in (0..height).step_by(BLOCK as usize) {
        for left in (0..width).step_by(BLOCK as usize) {
            for y in top..height.min(top + BLOCK) {
                for x in left..width.min(left + BLOCK) {
                    let mut sight = Sight::Nothing;
                    if let Some(ray) = camera.ray(center(x, y))
                        && let Some(hit) = scene.intersect(&ray)
                    {
                        sight = Sight::Dark;
                        let to_light = light - hit.p;
                        // The side that the ray came from is the one that is seen.
                        let faces = to_light.dot(hit.ng) * -ray.dir.dot(hit.ng) > 0.0;
                        if let Some(shadow) = hit.spawn_to(light).filter(|_| faces) {
                            shadow_rays += 1;
                            if !scene.occluded(&shadow) {
                                sight = Sight::Lit;
                            }
                        }
                    }
                    sights[(y * width + x) as usize] = sight;
                }
            }
        }
    }
    shadow_rays
}

fn center(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// Leaves and surfaces that a camera ray is tested against: the mean over pixels spread evenly.
pub fn tests_per_ray(scene: &Scene, camera: &Camera) -> f64 {
    let [width, height] = camera.resolution();
    let pixels = (width * height) as usize;
    let step = pixels.div_ceil(COUNTED).max(1);
    let ray = |i: usize| camera.ray(center(i as u32 % width, i as u32 / width));
    let total: u64 = (0..pixels).step_by(step).filter_map(ray).map(|ray| u64::from(scene.count_tests(&ray))).sum();
    total as f64 / pixels.div_ceil(step) as f64
}
