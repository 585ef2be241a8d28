//! The sky and sun of Hosek and Wilkie, z up.
//!
//! Two lobes, sampled as a mixture: the dome by a table of its radiance over equal cells of (azimuth, cos theta), which are
//! equal solid angles; the solar disc by a uniform cone. Below the horizon there is nothing. The sun's lobe gets
//! its share of the irradiance, but no more than [`SUN_SHARE`]: it has next to no variance of its own.

use std::f64::consts::{FRAC_PI_2, TAU};

use arsc_spectral::sky::{self, HosekWilkieSky};
use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, SkyLanes, WavelengthRange};
use glam::DVec3;

use super::EnvironmentSample;
use super::grid::GridDistribution;
use crate::frame::Frame;
use crate::warp;

const COLUMNS: usize = 128;
const ROWS: usize = 64;

/// Positions per cell and axis at which the table looks.
const PROBES: usize = 2;

const SUN_SHARE: f64 = 0.5;

/// What a sky is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkySettings {
    /// 1 (clear) to 10 (hazy); clamped.
    pub turbidity: f64,
    /// 0 to 1; clamped.
    pub ground_albedo: f64,
    /// Towards the sun, any length but zero. A sun below the horizon lights the sky as if it stood on it.
    pub sun: DVec3,
    pub solar_disc: bool,
    /// Factor on all radiances.
    pub scale: f64,
}

#[derive(Clone, Debug)]
pub struct SkyEnvironment {
    model: HosekWilkieSky,
    lanes: SkyLanes,
    dome: GridDistribution,
    /// About the direction to the sun.
    sun: Frame,
    scale: f64,
    cos_radius: f64,
    /// Probability of the sun's lobe; zero without a disc.
    sun_probability: f64,
    fluence: f64,
}

impl SkyEnvironment {
    pub(super) fn new(settings: &SkySettings) -> SkyEnvironment {
        let sun = settings.sun.normalize_or(DVec3::Z);
        let elevation = FRAC_PI_2 - sun.z.clamp(-1.0, 1.0).acos();
        let model = HosekWilkieSky::new(settings.turbidity, settings.ground_albedo, elevation.max(0.0));
        let scale = if settings.scale.is_finite() { settings.scale.max(0.0) } else { 0.0 };
        let weights = dome_weights(&model, sun);
        let sky_fluence = TAU * weights.iter().sum::<f64>() / weights.len() as f64;
        let sun_fluence = if settings.solar_disc { sun_fluence(&model, sun) } else { 0.0 };
        let share = if sun_fluence > 0.0 { sun_fluence / (sun_fluence + sky_fluence) } else { 0.0 };
        SkyEnvironment {
            lanes: SkyLanes::new(&model),
            dome: GridDistribution::new(COLUMNS, &weights),
            model,
            sun: Frame::new(sun),
            scale,
            cos_radius: sky::SOLAR_RADIUS.cos(),
            sun_probability: share.min(SUN_SHARE),
            fluence: scale * (sky_fluence + sun_fluence),
        }
    }

    #[inline]
    pub(super) fn radiance(&self, wi: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let gamma = angle_between(wi, self.sun.z);
        let mut radiance = self.lanes.sample(wi.z, gamma, wavelengths);
        if self.sun_probability > 0.0 && gamma <= sky::SOLAR_RADIUS {
            let bands = self.model.solar_bands(wi.z, gamma);
            let lambda = SampledSpectrum(wavelengths.lambda_nm);
            radiance += lambda.map(|lambda| sky::interpolate(&bands, f64::from(lambda)) as f32);
        }
        radiance * self.scale as f32
    }

    #[inline]
    pub(super) fn sample(&self, u: [f64; 2], wavelengths: &SampledWavelengths) -> Option<EnvironmentSample> {
        let p = self.sun_probability;
        let wi = if u[0] < p {
            self.sun.to_world(warp::uniform_cone([u[0] / p, u[1]], self.cos_radius))
        } else {
            let ([x, z], _) = self.dome.sample([(u[0] - p) / (1.0 - p), u[1]]);
            let (sin, cos) = (TAU * x).sin_cos();
            let r = (1.0 - z * z).max(0.0).sqrt();
            DVec3::new(r * cos, r * sin, z)
        };
        let pdf = self.pdf(wi);
        (pdf > 0.0).then(|| EnvironmentSample { wi, radiance: self.radiance(wi, wavelengths), pdf })
    }

    #[inline]
    pub(super) fn pdf(&self, wi: DVec3) -> f64 {
        let mut pdf = 0.0;
        if wi.z >= 0.0 {
            let turn = wi.y.atan2(wi.x) / TAU;
            let dome = self.dome.density([turn - turn.floor(), wi.z]) / TAU;
            pdf += (1.0 - self.sun_probability) * dome;
        }
        if self.sun_probability > 0.0 && wi.dot(self.sun.z) >= self.cos_radius {
            pdf += self.sun_probability / (TAU * (1.0 - self.cos_radius));
        }
        pdf
    }

    /// Radiance integrated over the sphere and the rendered range, W m^-2.
    pub(super) fn fluence(&self) -> f64 {
        self.fluence
    }
}

/// The angle between unit vectors, exact for small ones too.
#[inline]
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    let dot = a.dot(b);
    if dot > 0.99 { 2.0 * (0.5 * (a - b).length()).min(1.0).asin() } else { dot.max(-1.0).acos() }
}

/// Sum over the visible range (what is rendered beyond changes little in what to choose) of a spectrum given at the wavelengths of the model, times nm.
fn integral(bands: &[f64; sky::BANDS]) -> f64 {
    DenseSpectrum::from_fn(|lambda_nm| sky::interpolate(bands, lambda_nm)).integral(&WavelengthRange::VISIBLE)
}

/// Mean radiance of each cell, W m^-2 sr^-1, and at least a hundredth of the dome's mean.
fn dome_weights(model: &HosekWilkieSky, sun: DVec3) -> Vec<f64> {
    let cell = |row: usize, column: usize| {
        let mut sum = 0.0;
        for probe in 0..PROBES * PROBES {
            let at = |cell: usize, i: usize| cell as f64 + (i as f64 + 0.5) / PROBES as f64;
            let z = at(row, probe / PROBES) / ROWS as f64;
            let (sin, cos) = (TAU * at(column, probe % PROBES) / COLUMNS as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let gamma = angle_between(DVec3::new(r * cos, r * sin, z), sun);
            // 360 … 720 nm by the trapezoidal rule; what lies beyond changes little in where to look.
            let bands = model.sky_bands(z, gamma);
            sum += 40.0 * (bands[1..].iter().sum::<f64>() - 0.5 * (bands[1] + bands[sky::BANDS - 1]));
        }
        sum / (PROBES * PROBES) as f64
    };
    let weights: Vec<f64> = (0..ROWS * COLUMNS).map(|i| cell(i / COLUMNS, i % COLUMNS)).collect();
    let floor = 0.01 * weights.iter().sum::<f64>() / weights.len() as f64;
    weights.into_iter().map(|w| w.max(floor)).collect()
}

/// Irradiance across the beam of the visible part of the disc, W m^-2.
fn sun_fluence(model: &HosekWilkieSky, sun: DVec3) -> f64 {
    const POINTS: usize = 8;
    let (frame, cos_radius) = (Frame::new(sun), sky::SOLAR_RADIUS.cos());
    let mut sum = 0.0;
    for i in 0..POINTS * POINTS {
        let u = [i % POINTS, i / POINTS].map(|k| (k as f64 + 0.5) / POINTS as f64);
        let wi = frame.to_world(warp::uniform_cone(u, cos_radius));
        sum += integral(&model.solar_bands(wi.z, angle_between(wi, sun)));
    }
    sum / (POINTS * POINTS) as f64 * TAU * (1.0 - cos_radius)
}
