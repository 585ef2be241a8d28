//! Primary and shadow rays through CSG scenes under every strategy, one thread.
//!
//! `cargo bench -p arsc-accel --bench rays [-- NAME… --csg=local,tree…]` prints million rays per CPU-second of the tracing
//! thread, then how much faster the first strategy is: the geometric mean and the least of all scenes. Slow strategies
//! get fewer rays. On a machine that is shared compare within one run only; `tests/bench/csg` compares whole programs.

mod scenes;

use std::f64::consts::FRAC_PI_2;
use std::time::Instant;

use arsc_accel::{BuildOptions, Ray, Scene, SceneGeometry, Strategy};
use glam::DVec3;

/// Side of a block of pixels, and how many are side by side.
const BLOCK: usize = 32;
const BLOCKS: usize = 20;
const WIDTH: usize = BLOCK * BLOCKS;
/// Seconds of CPU per measurement, about.
const BUDGET: f64 = 1.0;

/// CPU seconds of this thread, where the system tells.
fn cpu_seconds(since: Instant) -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = stat.and_then(|text| text.split(' ').next().and_then(|word| word.parse::<f64>().ok()));
    nanoseconds.map_or(since.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// Pixels by blocks, as renderers go through a picture.
fn pixel(i: usize) -> (f64, f64) {
    let (block, within) = (i / (BLOCK * BLOCK) % (BLOCKS * BLOCKS), i % (BLOCK * BLOCK));
    let (x, y) = (block % BLOCKS * BLOCK + within % BLOCK, block / BLOCKS * BLOCK + within / BLOCK);
    (x as f64 + 0.5, y as f64 + 0.5)
}

/// Million rays per CPU-second and mean tests per primary ray.
fn measure(scene: &Scene, eye: DVec3, target: DVec3) -> (f64, f64) {
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let up = right.cross(forward);
    let light = eye + (right + up * 2.0) * (target - eye).length();
    let spread = (FRAC_PI_2 / 2.4).tan();
    let clock = Instant::now();
    let start = cpu_seconds(clock);
    let (mut rays, mut hits, mut tests, mut i) = (0u64, 0u64, 0u64, 0);
    let mut lit = 0u64;
    while i < 4 * WIDTH * WIDTH && (i % 256 != 0 || cpu_seconds(clock) - start < BUDGET) {
        let (x, y) = pixel(i);
        let (x, y) = ((x / WIDTH as f64 - 0.5) * spread, (0.5 - y / WIDTH as f64) * spread);
        let ray = Ray::new(eye, (forward + right * x + up * y).normalize());
        rays += 1;
        if let Some(hit) = scene.intersect(&ray) {
            hits += 1;
            if let Some(shadow) = hit.spawn_to(light) {
                rays += 1;
                lit += u64::from(!scene.occluded(&shadow));
            }
        }
        i += 1;
    }
    let seconds = cpu_seconds(clock) - start;
    let n = i.min(2000);
    for i in 0..n {
        let (x, y) = pixel(i);
        let (x, y) = ((x / WIDTH as f64 - 0.5) * spread, (0.5 - y / WIDTH as f64) * spread);
        tests += u64::from(scene.count_tests(&Ray::new(eye, (forward + right * x + up * y).normalize())));
    }
    assert!(hits > 0 && lit > 0, "the camera sees nothing");
    (rays as f64 / seconds * 1e-6, tests as f64 / n as f64)
}

/// Strategies and words that names of scenes must contain, from the command line.
fn wanted() -> (Vec<Strategy>, Vec<String>) {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let listed = args.iter().find_map(|arg| arg.strip_prefix("--csg="));
    let named = |name: &str| {
        let found = Strategy::ALL.into_iter().find(|strategy| strategy.name() == name);
        found.unwrap_or_else(|| panic!("no such strategy: {name}"))
    };
    let strategies = listed.map_or(Strategy::ALL.to_vec(), |list| list.split(',').map(named).collect());
    (strategies, args.into_iter().filter(|arg| !arg.starts_with('-')).collect())
}

fn main() {
    let (strategies, words) = wanted();
    print!("{:<14}{:>9}{:>9}{:>9}{:>9}{:>9}", "scene", "leaves", "cells", "kB", "build s", "tests");
    strategies.iter().for_each(|strategy| print!("{:>12}", strategy.name()));
    println!();
    // By strategy, how much faster the first is, in each scene.
    let mut ratios = vec![vec![]; strategies.len()];
    for view in scenes::all() {
        if !words.is_empty() && !words.iter().any(|word| view.name.contains(word.as_str())) {
            continue;
        }
        let mut first = None;
        for (ratios, &strategy) in ratios.iter_mut().zip(&strategies) {
            let geometry = SceneGeometry { solids: (view.make)(), ..SceneGeometry::default() };
            let scene = Scene::build(geometry, BuildOptions::from(strategy)).expect("the scene can be built");
            let (rate, tests) = measure(&scene, view.eye, view.target);
            let stats = scene.stats();
            if first.is_none() {
                let seconds = stats.build_time.as_secs_f64();
                print!("{:<14}{:>9}{:>9}", view.name, stats.primitives, stats.cells);
                print!("{:>9}{seconds:>9.3}{tests:>9.2}", stats.bytes / 1000);
            }
            print!("{rate:>12.3}");
            ratios.push((*first.get_or_insert(rate) / rate, view.name));
        }
        println!();
    }
    for (ratios, strategy) in ratios.iter().zip(&strategies).skip(1) {
        let mean = ratios.iter().map(|(ratio, _)| ratio.ln()).sum::<f64>() / ratios.len() as f64;
        let least = ratios.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let (least, scene) = least.copied().unwrap_or((1.0, "none"));
        let (ours, theirs) = (strategies[0].name(), strategy.name());
        println!("{ours} / {theirs}: {:.2} (geometric mean), {least:.2} at least ({scene})", mean.exp());
    }
}
