//! Skies with their suns, z up: Hosek and Wilkie's, Preetham's.
//!
//! Two lobes, sampled as a mixture: the dome by a table of its radiance over equal cells of (azimuth, cos theta), which are
//! equal solid angles; the solar disc by a uniform cone. Below the horizon there is nothing. The sun's lobe gets
//! its share of the irradiance, but no more than [`SUN_SHARE`]: it has next to no variance of its own.
//! Another star scales both by what it shines with beyond the air ([`Star`]). Where polarisation is asked for, the dome has the pattern
//! of [`SkyPolarisation`]; the disc is unpolarised.

use std::f64::consts::{FRAC_PI_2, TAU};

use arsc_spectral::sky::{self, HosekWilkieSky};
use arsc_spectral::{
    DenseSpectrum, PreethamSky, SampledSpectrum, SampledWavelengths, SkyLanes, SkyPolarisation, Star, WavelengthRange,
};
use glam::DVec3;

use super::EnvironmentSample;
use super::grid::GridDistribution;
use crate::frame::Frame;
use crate::polarisation::{Polarisation, Stokes};
use crate::warp;

const COLUMNS: usize = 128;
const ROWS: usize = 64;

/// Positions per cell and axis at which the table looks.
const PROBES: usize = 2;

const SUN_SHARE: f64 = 0.5;

/// Wavelengths at which the table looks, nm.
const PROBE_NM: [f64; 4] = [420.0, 500.0, 580.0, 660.0];

/// Whose sky it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SkyModel {
    #[default]
    HosekWilkie,
    /// It takes no ground into account.
    Preetham,
}

/// What a sky is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkySettings {
    pub model: SkyModel,
    /// 1 (clear) to 10 (hazy); clamped.
    pub turbidity: f64,
    /// 0 to 1; clamped.
    pub ground_albedo: f64,
    /// Towards the sun, any length but zero. A sun below the horizon lights the sky as if it stood on it.
    pub sun: DVec3,
    pub solar_disc: bool,
    /// Factor on all radiances.
    pub scale: f64,
    pub star: Star,
    /// Skylight is polarised in polarised renders.
    pub polarised: bool,
}

/// A clear sky over dark ground, without a factor.
impl Default for SkySettings {
    fn default() -> SkySettings {
        SkySettings {
            model: SkyModel::HosekWilkie,
            turbidity: 3.0,
            ground_albedo: 0.0,
            sun: DVec3::Z,
            solar_disc: true,
            scale: 1.0,
            star: Star::SUN,
            polarised: false,
        }
    }
}

#[derive(Clone, Debug)]
enum Dome {
    HosekWilkie {
        model: Box<HosekWilkieSky>,
        lanes: Box<SkyLanes>,
    },
    /// With the radiance of the disc.
    Preetham {
        sky: PreethamSky,
        disc: DenseSpectrum,
    },
}

impl Dome {
    fn new(settings: &SkySettings, elevation: f64) -> Dome {
        match settings.model {
            SkyModel::HosekWilkie => {
                let model = HosekWilkieSky::new(settings.turbidity, settings.ground_albedo, elevation);
                Dome::HosekWilkie { lanes: Box::new(SkyLanes::new(&model)), model: Box::new(model) }
            }
            SkyModel::Preetham => {
                let sky = PreethamSky::new(settings.turbidity, elevation);
                let disc = DenseSpectrum::from_fn(|lambda_nm| sky.solar_radiance(lambda_nm));
                Dome::Preetham { sky, disc }
            }
        }
    }

    /// Under the sun, without its disc.
    #[inline]
    fn radiance(&self, cos_theta: f64, gamma: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Dome::HosekWilkie { lanes, .. } => lanes.sample(cos_theta, gamma, wavelengths),
            Dome::Preetham { sky, .. } => sky.sample(cos_theta, gamma, wavelengths),
        }
    }

    /// Of the sun's disc; `gamma` is at most the sun's radius.
    #[inline]
    fn disc(&self, cos_theta: f64, gamma: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Dome::HosekWilkie { model, .. } => {
                let bands = model.solar_bands(cos_theta, gamma);
                let lambda = SampledSpectrum(wavelengths.lambda_nm);
                lambda.map(|lambda| sky::interpolate(&bands, f64::from(lambda)) as f32)
            }
            Dome::Preetham { .. } if cos_theta < 0.0 => SampledSpectrum::ZERO,
            Dome::Preetham { disc, .. } => disc.sample(wavelengths),
        }
    }
}

/// Another star than the sun: factors on the radiance of dome and disc.
#[derive(Clone, Debug)]
struct StarLight {
    dome: DenseSpectrum,
    disc: DenseSpectrum,
}

#[derive(Clone, Debug)]
pub struct SkyEnvironment {
    model: Dome,
    dome: GridDistribution,
    /// About the direction to the sun.
    sun: Frame,
    scale: f64,
    star: Option<StarLight>,
    polarisation: Option<SkyPolarisation>,
    /// Of the disc.
    radius: f64,
    cos_radius: f64,
    /// Probability of the sun's lobe; zero without a disc.
    sun_probability: f64,
    fluence: f64,
}

impl SkyEnvironment {
    pub(super) fn new(settings: &SkySettings) -> SkyEnvironment {
        let sun = settings.sun.normalize_or(DVec3::Z);
        let elevation = FRAC_PI_2 - sun.z.clamp(-1.0, 1.0).acos();
        let scale = if settings.scale.is_finite() { settings.scale.max(0.0) } else { 0.0 };
        let star = (settings.star != Star::SUN)
            .then(|| StarLight { dome: settings.star.irradiance_ratio(), disc: settings.star.radiance_ratio() });
        let radius = settings.star.angular_radius();
        let mut sky = SkyEnvironment {
            model: Dome::new(settings, elevation.max(0.0)),
            dome: GridDistribution::new(COLUMNS, &[1.0; COLUMNS]),
            sun: Frame::new(sun),
            scale,
            star,
            polarisation: settings.polarised.then(|| SkyPolarisation::new(settings.turbidity)),
            radius,
            cos_radius: radius.cos(),
            sun_probability: 0.0,
            fluence: 0.0,
        };
        let weights = sky.dome_weights();
        let sky_fluence = TAU * weights.iter().sum::<f64>() / weights.len() as f64;
        let sun_fluence = if settings.solar_disc { sky.sun_fluence() } else { 0.0 };
        let share = if sun_fluence > 0.0 { sun_fluence / (sun_fluence + sky_fluence) } else { 0.0 };
        sky.dome = GridDistribution::new(COLUMNS, &weights);
        sky.sun_probability = share.min(SUN_SHARE);
        sky.fluence = scale * (sky_fluence + sun_fluence);
        sky
    }

    /// Of the dome alone, before the factor on all.
    #[inline]
    fn dome_radiance(&self, wi: DVec3, gamma: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let radiance = self.model.radiance(wi.z, gamma, wavelengths);
        self.star.as_ref().map_or(radiance, |star| radiance * star.dome.sample(wavelengths))
    }

    /// Of the disc alone, before the factor on all; `gamma` is at most its radius.
    #[inline]
    fn disc_radiance(&self, wi: DVec3, gamma: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let Some(star) = &self.star else { return self.model.disc(wi.z, gamma, wavelengths) };
        // The limb of any star darkens as the sun's.
        let gamma = gamma / self.radius * sky::SOLAR_RADIUS;
        self.model.disc(wi.z, gamma.min(sky::SOLAR_RADIUS), wavelengths) * star.disc.sample(wavelengths)
    }

    #[inline]
    pub(super) fn radiance<P: Polarisation>(&self, wi: DVec3, wavelengths: &SampledWavelengths) -> P::Stokes {
        let gamma = angle_between(wi, self.sun.z);
        let dome = self.dome_radiance(wi, gamma, wavelengths) * self.scale as f32;
        let mut all = dome;
        if self.sun_probability > 0.0 && gamma <= self.radius {
            all += self.disc_radiance(wi, gamma, wavelengths) * self.scale as f32;
        }
        let Some(pattern) = &self.polarisation else { return P::Stokes::unpolarised(all) };
        let across = wi.cross(self.sun.z);
        let length = across.length();
        if length < 1e-12 {
            return P::Stokes::unpolarised(all);
        }
        P::Stokes::linear(all, dome * pattern.degree(wi.dot(self.sun.z), wavelengths), across / length, -wi)
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        u: [f64; 2],
        wavelengths: &SampledWavelengths,
    ) -> Option<EnvironmentSample<P::Stokes>> {
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
        (pdf > 0.0).then(|| EnvironmentSample { wi, radiance: self.radiance::<P>(wi, wavelengths), pdf })
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

    /// Radiance integrated over the sphere and the visible range, W m^-2: what is rendered beyond changes little in what to choose.
    pub(super) fn fluence(&self) -> f64 {
        self.fluence
    }

    /// Mean radiance of each cell times the width of the visible range, W m^-2 sr^-1, and at least a hundredth of the dome's mean.
    fn dome_weights(&self) -> Vec<f64> {
        let wavelengths = SampledWavelengths::fixed(PROBE_NM);
        let cell = |row: usize, column: usize| {
            let mut sum = 0.0;
            for probe in 0..PROBES * PROBES {
                let at = |cell: usize, i: usize| cell as f64 + (i as f64 + 0.5) / PROBES as f64;
                let z = at(row, probe / PROBES) / ROWS as f64;
                let (sin, cos) = (TAU * at(column, probe % PROBES) / COLUMNS as f64).sin_cos();
                let r = (1.0 - z * z).sqrt();
                let wi = DVec3::new(r * cos, r * sin, z);
                sum += f64::from(self.dome_radiance(wi, angle_between(wi, self.sun.z), &wavelengths).mean());
            }
            sum / (PROBES * PROBES) as f64 * WavelengthRange::VISIBLE.width_nm()
        };
        let weights: Vec<f64> = (0..ROWS * COLUMNS).map(|i| cell(i / COLUMNS, i % COLUMNS)).collect();
        let floor = 0.01 * weights.iter().sum::<f64>() / weights.len() as f64;
        weights.into_iter().map(|w| w.max(floor)).collect()
    }

    /// Irradiance across the beam of the visible part of the disc, W m^-2, in the same manner.
    fn sun_fluence(&self) -> f64 {
        const POINTS: usize = 8;
        let wavelengths = SampledWavelengths::fixed(PROBE_NM);
        let mut sum = 0.0;
        for i in 0..POINTS * POINTS {
            let u = [i % POINTS, i / POINTS].map(|k| (k as f64 + 0.5) / POINTS as f64);
            let wi = self.sun.to_world(warp::uniform_cone(u, self.cos_radius));
            let gamma = angle_between(wi, self.sun.z).min(self.radius);
            sum += f64::from(self.disc_radiance(wi, gamma, &wavelengths).mean());
        }
        let mean = sum / (POINTS * POINTS) as f64 * WavelengthRange::VISIBLE.width_nm();
        mean * TAU * (1.0 - self.cos_radius)
    }
}

/// The angle between unit vectors, exact for small ones too.
#[inline]
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    let dot = a.dot(b);
    if dot > 0.99 { 2.0 * (0.5 * (a - b).length()).min(1.0).asin() } else { dot.max(-1.0).acos() }
}
