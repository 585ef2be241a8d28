//! How fast a whole scene is: building, nearest hits of camera rays, and path tracing.

use arsc_accel::BuildStats;
use arsc_ir::{Action, Ir};
use arsc_render::{Camera, PathTraceSettings, Sampling, World, path_trace};
use glam::DVec2;
use rayon::prelude::*;

use crate::stage::Stage;
use crate::{AssemblyError, Host, Settings, sequence};

/// What was measured; rates are over all threads together.
#[derive(Clone, Debug)]
pub struct Measurement {
    pub scene: BuildStats,
    /// From the IR to a scene that can be traced, light sources and tables included.
    pub build_seconds: f64,
    /// Nearest hits of rays through the centres of all pixels.
    pub camera_rays_per_second: f64,
    /// Share of those rays that hit something.
    pub hit_share: f64,
    /// Whole paths, at the depth of the script.
    pub samples_per_second: f64,
    pub threads: usize,
}

/// Measures for about `seconds` of rays and as much of paths.
pub fn measure(ir: &Ir, settings: &Settings, host: &dyn Host, seconds: f64) -> Result<Measurement, AssemblyError> {
    let stage = Stage::new(ir, settings, host)?;
    let strategy = settings.strategy.unwrap_or_default();
    let world = stage.world(strategy)?;
    let (camera, crop) = stage.camera(strategy)?;
    let pixels = settings.pixels(camera.resolution(), crop)? as f64;
    let mut hits = 0;
    let rays = repeat(host, seconds, |_| hits = stage.pool.install(|| trace_pixels(&world, &camera)));
    let sampling = |seed| Sampling { samples: SAMPLES, seed, ..Sampling::default() };
    let mut base = PathTraceSettings::default();
    let first = sequence::actions(ir, "").into_iter().find(|action| matches!(action, Action::PathTrace(_)));
    if let Some(Action::PathTrace(trace)) = first {
        (base.max_depth, base.polarised) = (trace.max_depth, trace.polarised);
    }
    base.max_depth = settings.max_depth.unwrap_or(base.max_depth);
    let paths = repeat(host, seconds, |round| {
        stage.pool.install(|| {
            path_trace(&world, &camera, &PathTraceSettings { sampling: sampling(round), ..base.clone() }, &())
        });
    });
    Ok(Measurement {
        scene: *world.geometry.stats(),
        build_seconds: stage.build_seconds(),
        camera_rays_per_second: rays * pixels,
        hit_share: hits as f64 / pixels,
        samples_per_second: paths * pixels * f64::from(SAMPLES),
        threads: stage.pool.current_num_threads(),
    })
}

/// Rounds per second of `work`, which is told the number of the round. The first round warms up and does not count.
fn repeat(host: &dyn Host, seconds: f64, mut work: impl FnMut(u64)) -> f64 {
    work(0);
    let start = host.seconds();
    let mut rounds = 0;
    loop {
        rounds += 1;
        work(rounds);
        let elapsed = host.seconds() - start;
        if elapsed >= seconds || rounds == MOST_ROUNDS {
            return rounds as f64 / elapsed;
        }
    }
}

/// Paths per pixel and round.
const SAMPLES: u32 = 4;

/// Ends a measurement whose clock stands still.
const MOST_ROUNDS: u64 = 1_000_000;

fn trace_pixels(world: &World, camera: &Camera) -> usize {
    let [width, height] = camera.resolution();
    let row = |y: u32| {
        let hits = |x: &u32| {
            let center = DVec2::new(f64::from(*x) + 0.5, f64::from(y) + 0.5);
            camera.ray(center).is_some_and(|ray| world.geometry.intersect(&ray).is_some())
        };
        (0..width).filter(hits).count()
    };
    (0..height).into_par_iter().map(row).sum()
}
