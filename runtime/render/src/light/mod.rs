//! Lights that are no geometry, and environments.
//!
//! A light sample states its direction, its density per steradian, and the radiance (for point and distant lights, whose
//! density is a Dirac distribution: the irradiance across the beam, with density 1). Directions point from the
//! illuminated point to the light.

mod alias;
mod constant;
mod distant;
mod grid;
mod point;
mod sky;

use arsc_spectral::{SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};
use glam::DVec3;

use crate::polarisation::{Polarisation, Stokes};

pub use alias::AliasTable;
pub use constant::ConstantEnvironment;
pub use distant::DistantLight;
pub use point::PointLight;
pub use sky::{SkyEnvironment, SkySettings};

/// A light without extent.
#[derive(Clone, Debug)]
pub enum Light {
    Point(PointLight),
    Distant(DistantLight),
}

impl Light {
    /// `intensity` in W sr^-1 nm^-1.
    pub fn point(position: DVec3, intensity: &Spectrum) -> Light {
        Light::Point(PointLight::new(position, intensity))
    }

    /// Light that travels along `direction` (any length but zero); `irradiance` across the beam in W m^-2 nm^-1.
    pub fn distant(direction: DVec3, irradiance: &Spectrum) -> Light {
        Light::Distant(DistantLight::new(direction, irradiance))
    }

    /// Power into a scene with a bounding sphere of this radius, W.
    pub(crate) fn power(&self, scene_radius: f64, range: &WavelengthRange) -> f64 {
        match self {
            Light::Point(light) => light.power(range),
            Light::Distant(light) => light.power(scene_radius, range),
        }
    }
}

/// Light from everywhere beyond the scene.
#[derive(Clone, Debug)]
pub enum Environment {
    Constant(ConstantEnvironment),
    Sky(Box<SkyEnvironment>),
}

/// A direction to an environment.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentSample<R = SampledSpectrum> {
    pub wi: DVec3,
    pub radiance: R,
    /// Per steradian.
    pub pdf: f64,
}

impl Environment {
    /// The same radiance from everywhere, W m^-2 sr^-1 nm^-1.
    pub fn constant(radiance: &Spectrum) -> Environment {
        Environment::Constant(ConstantEnvironment::new(radiance))
    }

    /// The sky of Hosek and Wilkie 2012 with the sun of 2013; z is up.
    pub fn hosek_wilkie(settings: &SkySettings) -> Environment {
        Environment::Sky(Box::new(SkyEnvironment::new(settings)))
    }

    /// Radiance that arrives from the direction `wi`.
    #[inline]
    pub fn radiance<P: Polarisation>(&self, wi: DVec3, wavelengths: &SampledWavelengths) -> P::Stokes {
        P::Stokes::unpolarised(match self {
            Environment::Constant(constant) => constant.radiance(wavelengths),
            Environment::Sky(sky) => sky.radiance(wi, wavelengths),
        })
    }

    /// A direction with density roughly in proportion to radiance.
    #[inline]
    pub fn sample<P: Polarisation>(
        &self,
        u: [f64; 2],
        wavelengths: &SampledWavelengths,
    ) -> Option<EnvironmentSample<P::Stokes>> {
        let EnvironmentSample { wi, radiance, pdf } = match self {
            Environment::Constant(constant) => constant.sample(u, wavelengths),
            Environment::Sky(sky) => sky.sample(u, wavelengths)?,
        };
        Some(EnvironmentSample { wi, radiance: P::Stokes::unpolarised(radiance), pdf })
    }

    /// Density per steradian with which [`Environment::sample`] gives `wi`.
    #[inline]
    pub fn pdf(&self, wi: DVec3) -> f64 {
        match self {
            Environment::Constant(_) => crate::warp::UNIFORM_SPHERE_PDF,
            Environment::Sky(sky) => sky.pdf(wi),
        }
    }

    /// Power into a scene with a bounding sphere of this radius, W.
    pub(crate) fn power(&self, scene_radius: f64, range: &WavelengthRange) -> f64 {
        let area = std::f64::consts::PI * scene_radius * scene_radius;
        match self {
            Environment::Constant(constant) => area * constant.fluence(range),
            Environment::Sky(sky) => area * sky.fluence(),
        }
    }
}
