//! The actions that render: path tracing, ambient occlusion, previews.

use std::sync::Arc;

use arsc_ir::PathTrace;
use arsc_render::{
    Bands, Camera, Film, PathTraceSettings, Progress, SampleSequence, Sampling, World, ambient_occlusion, features,
    path_trace, preview,
};
use arsc_spectral::WavelengthRange;

use crate::sequence::{Item, Machine};
use crate::{AssemblyError, measure_rays};

/// One render.
#[derive(Clone, Debug)]
pub struct RenderReport {
    pub strategy: arsc_accel::Strategy,
    /// Building the scene for tracing.
    pub build_seconds: f64,
    /// What was built.
    pub scene: arsc_accel::BuildStats,
    /// Mean over camera rays, if it was asked for.
    pub tests_per_ray: Option<f64>,
    pub seconds: f64,
    pub camera_paths: u64,
    /// Samples per pixel, fewest and most.
    pub samples: (u32, u32),
    /// Relative noise of the picture, where there are samples enough to tell.
    pub noise: Option<f64>,
    /// Samples that were not finite or negative and were left out.
    pub rejected: u64,
}

/// Samples per pixel where a noise threshold or a time limit was asked for in place of a number.
const MOST_SAMPLES: u32 = 1 << 16;

/// Samples per pixel of the features beside a path traced picture, at most.
const FEATURE_SAMPLES: u32 = 16;

/// What is rendered, whatever the way of doing it.
struct Job<'a> {
    action: &'static str,
    /// What the script asks for.
    sampling: &'a arsc_ir::Sampling,
    bands: Bands,
    polarised: bool,
    wavelengths: WavelengthRange,
    features: bool,
    /// What the picture tells about it besides.
    metadata: Vec<(String, String)>,
}

type Trace<'a> = &'a (dyn Fn(&World, &Camera, &Sampling, &dyn Progress) -> Film + Sync);

impl Machine<'_> {
    /// Renders as the script asks, but for what the run asks otherwise; false when there is nothing to go on with.
    pub fn path_trace(&mut self, trace: &PathTrace) -> Result<bool, AssemblyError> {
        let bands = Bands::over(&trace.wavelengths, trace.band_nm, trace.observer);
        let max_depth = self.settings.max_depth.unwrap_or(trace.max_depth);
        let (first, last) = (trace.wavelengths.min_nm(), trace.wavelengths.max_nm());
        let job = Job {
            action: "path_trace",
            sampling: &trace.sampling,
            bands,
            polarised: trace.polarised,
            wavelengths: trace.wavelengths,
            features: trace.features,
            metadata: [
                ("maxDepth", max_depth.to_string()),
                ("wavelengths", format!("{first}nm to {last}nm")),
                ("observer", bands.observer.name().to_owned()),
            ]
            .map(|(name, value)| (name.to_owned(), value))
            .into(),
        };
        let (wavelengths, polarised) = (trace.wavelengths, trace.polarised);
        self.render(&job, &|world, camera, sampling, progress| {
            let settings = PathTraceSettings { sampling: *sampling, max_depth, wavelengths, bands, polarised };
            path_trace(world, camera, &settings, progress)
        })
    }

    pub fn ambient_occlusion(&mut self, distance: f64, sampling: &arsc_ir::Sampling) -> Result<bool, AssemblyError> {
        let job = Job {
            metadata: vec![("distance".to_owned(), distance.to_string())],
            ..Job::without_colour("ambient_occlusion", sampling)
        };
        self.render(&job, &|world, camera, sampling, progress| {
            ambient_occlusion(world, camera, distance, sampling, progress)
        })
    }

    pub fn preview(&mut self, sampling: &arsc_ir::Sampling, features: bool) -> Result<bool, AssemblyError> {
        let action = if features { "render_features" } else { "preview" };
        self.render(&Job { features, ..Job::without_colour(action, sampling) }, &preview)
    }

    fn render(&mut self, job: &Job, trace: Trace) -> Result<bool, AssemblyError> {
        let strategy = self.scene(job.action)?;
        let (camera, crop) = self.stage.camera(strategy)?;
        let sampling = self.sampling(job.sampling, crop);
        self.settings.check_film(camera.resolution(), crop, &job.bands, job.polarised)?;
        let world = self.stage.world_for(strategy, &job.wavelengths)?;
        let paths = u64::from(sampling.samples) * self.settings.pixels(camera.resolution(), crop)?;
        let time_limit = self.settings.time_limit.or(job.sampling.time_limit);
        let progress = self.host.begin(paths, time_limit);
        let start = self.host.seconds();
        let film = self.stage.pool.install(|| trace(&world, &camera, &sampling, &*progress));
        let seconds = self.host.seconds() - start;
        let cancelled = progress.cancelled();
        self.outcome.interrupted |= cancelled;
        drop(progress);
        let count = || measure_rays::tests_per_ray(&world.geometry, &camera);
        let report = RenderReport {
            strategy,
            tests_per_ray: self.settings.statistics.then(count),
            build_seconds: self.stage.build_seconds(),
            scene: *world.geometry.stats(),
            seconds,
            camera_paths: film.paths(),
            samples: film.samples_per_pixel(),
            noise: film.noise(),
            rejected: film.rejected(),
        };
        let mut image = film.to_image();
        drop(film);
        if job.features && report.samples.1 > 0 {
            let sampling = Sampling { samples: sampling.samples.min(FEATURE_SAMPLES), ..sampling };
            image.channels.extend(self.stage.pool.install(|| features(&world, &camera, &sampling)));
            image.channels.sort_by(|a, b| a.name.cmp(&b.name));
        }
        image.metadata = self.metadata(job, &sampling, &report, time_limit, cancelled);
        let is_empty = report.samples.1 == 0;
        self.outcome.renders.push(report);
        self.stack.push(Item::Spectral(Arc::new(image)));
        Ok(!is_empty)
    }

    /// What the script asks for, but for what the run asks otherwise.
    fn sampling(&self, script: &arsc_ir::Sampling, crop: Option<[u32; 4]>) -> Sampling {
        let open_ended = self.settings.noise.is_some() || self.settings.time_limit.is_some();
        let usual = if open_ended { script.samples.max(MOST_SAMPLES) } else { script.samples };
        Sampling {
            samples: self.settings.samples.unwrap_or(usual),
            seed: self.settings.seed.unwrap_or(script.seed),
            sequence: match script.sampler {
                arsc_ir::Sampler::Sobol => SampleSequence::Sobol,
                arsc_ir::Sampler::Halton => SampleSequence::Halton,
                arsc_ir::Sampler::Independent => SampleSequence::Independent,
            },
            crop,
            noise: self.settings.noise.or(script.noise),
        }
    }

    fn metadata(
        &self,
        job: &Job,
        sampling: &Sampling,
        report: &RenderReport,
        time_limit: Option<f64>,
        cancelled: bool,
    ) -> Vec<(String, String)> {
        let (fewest, most) = report.samples;
        let samples = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
        let mut metadata = self.settings.metadata.clone();
        let mut add = |name: &str, value: String| metadata.push((name.to_owned(), value));
        add("action", job.action.to_owned());
        add("seed", sampling.seed.to_string());
        add("samples", samples);
        add("sampler", job.sampling.sampler.name().to_owned());
        add("csg", report.strategy.name().to_owned());
        if let Some(noise) = report.noise {
            add("noise", format!("{noise:.3e}"));
        }
        if let Some(threshold) = sampling.noise {
            add("noiseThreshold", threshold.to_string());
        }
        if let Some(seconds) = time_limit {
            add("timeLimit", format!("{seconds} s"));
        }
        if let Some([x0, y0, x1, y1]) = sampling.crop {
            add("crop", format!("{x0},{y0},{x1},{y1}"));
        }
        if cancelled {
            add("interrupted", format!("after {most} of {} samples", sampling.samples));
        }
        if self.settings.timings {
            add("buildSeconds", format!("{:.3}", report.build_seconds));
            add("renderSeconds", format!("{:.3}", report.seconds));
        }
        metadata.extend(job.metadata.iter().cloned());
        metadata
    }
}

impl<'a> Job<'a> {
    /// A picture of one band.
    fn without_colour(action: &'static str, sampling: &'a arsc_ir::Sampling) -> Job<'a> {
        let wavelengths = WavelengthRange::VISIBLE;
        let bands = Bands::over(&wavelengths, wavelengths.width_nm(), arsc_spectral::Observer::Cie1931);
        Job { action, sampling, bands, polarised: false, wavelengths, features: false, metadata: Vec::new() }
    }
}
