//! Lights that are no geometry, and environments.
//!
//! A light sample states its direction, its density per steradian, and the radiance (for point and distant lights, whose
//! density is a Dirac distribution: the irradiance across the beam, with density 1). Directions point from the
//! illuminated point to the light.

mod alias;
mod constant;
mod distant;
mod grid;
mod image;
mod photometric;
mod point;
mod sky;
mod spot;

use std::sync::Arc;

use arsc_spectral::{PhotometricWeb, Raster, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};
use glam::{DMat3, DVec3};

use crate::polarisation::{Polarisation, Stokes};

pub use alias::AliasTable;
pub use constant::ConstantEnvironment;
pub use distant::DistantLight;
pub use image::ImageEnvironment;
pub use photometric::PhotometricLight;
pub use point::PointLight;
pub use sky::{SkyEnvironment, SkyModel, SkySettings};
pub use spot::SpotLight;

/// A light without extent.
#[derive(Clone, Debug)]
pub enum Light {
    Point(PointLight),
    Spot(SpotLight),
    Photometric(Box<PhotometricLight>),
    Distant(DistantLight),
}

/// Where the light of a light without extent comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Origin {
    Point(DVec3),
    /// Infinitely far; unit, towards the light.
    Direction(DVec3),
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

    /// A point that shines about `axis` (any length but zero): `intensity` along it, W sr^-1 nm^-1, falls as the cosine to the power of
    /// `exponent` and ends at `angle`, radians, at most a right angle.
    pub fn spot(position: DVec3, axis: DVec3, intensity: &Spectrum, exponent: f64, angle: f64) -> Light {
        Light::Spot(SpotLight::new(position, axis, intensity, exponent, angle))
    }

    /// A lamp of measured candela, in the colour of a spectrum of any scale; `world_from_local` is orthonormal.
    pub fn photometric(
        position: DVec3,
        world_from_local: DMat3,
        web: Arc<PhotometricWeb>,
        spectrum: &Spectrum,
    ) -> Light {
        Light::Photometric(Box::new(PhotometricLight::new(position, world_from_local, web, spectrum)))
    }

    /// Where light reaches a point from, and the irradiance across the beam there.
    #[inline]
    pub fn incident(&self, p: DVec3, wavelengths: &SampledWavelengths) -> (Origin, SampledSpectrum) {
        match self {
            Light::Point(light) => {
                let distance2 = (light.position - p).length_squared();
                (Origin::Point(light.position), light.irradiance(distance2, wavelengths))
            }
            Light::Spot(light) => (Origin::Point(light.position), light.irradiance(p, wavelengths)),
            Light::Photometric(light) => (Origin::Point(light.position), light.irradiance(p, wavelengths)),
            Light::Distant(light) => (Origin::Direction(light.wi), light.irradiance(wavelengths)),
        }
    }

    /// Power into a scene with a bounding sphere of this radius, W.
    pub(crate) fn power(&self, scene_radius: f64, range: &WavelengthRange) -> f64 {
        match self {
            Light::Point(light) => light.power(range),
            Light::Spot(light) => light.power(range),
            Light::Photometric(light) => light.power(range),
            Light::Distant(light) => light.power(scene_radius, range),
        }
    }
}

/// Light from everywhere beyond the scene.
#[derive(Clone, Debug)]
pub enum Environment {
    Constant(ConstantEnvironment),
    Sky(Box<SkyEnvironment>),
    Image(Box<ImageEnvironment>),
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

    /// A clear sky with its sun; z is up.
    pub fn sky(settings: &SkySettings) -> Environment {
        Environment::Sky(Box::new(SkyEnvironment::new(settings)))
    }

    /// A picture in latitude and longitude; `world_from_local` is orthonormal, `scale` a factor on its radiance.
    pub fn image(image: Arc<Raster>, world_from_local: DMat3, scale: f64) -> Environment {
        Environment::Image(Box::new(ImageEnvironment::new(image, world_from_local, scale)))
    }

    /// Radiance that arrives from the direction `wi`.
    #[inline]
    pub fn radiance<P: Polarisation>(&self, wi: DVec3, wavelengths: &SampledWavelengths) -> P::Stokes {
        P::Stokes::unpolarised(match self {
            Environment::Constant(constant) => constant.radiance(wavelengths),
            Environment::Sky(sky) => return sky.radiance::<P>(wi, wavelengths),
            Environment::Image(image) => image.radiance(wi, wavelengths),
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
            Environment::Sky(sky) => return sky.sample::<P>(u, wavelengths),
            Environment::Image(image) => image.sample(u, wavelengths)?,
        };
        Some(EnvironmentSample { wi, radiance: P::Stokes::unpolarised(radiance), pdf })
    }

    /// Density per steradian with which [`Environment::sample`] gives `wi`.
    #[inline]
    pub fn pdf(&self, wi: DVec3) -> f64 {
        match self {
            Environment::Constant(_) => crate::warp::UNIFORM_SPHERE_PDF,
            Environment::Sky(sky) => sky.pdf(wi),
            Environment::Image(image) => image.pdf(wi),
        }
    }

    /// Power into a scene with a bounding sphere of this radius, W.
    pub(crate) fn power(&self, scene_radius: f64, range: &WavelengthRange) -> f64 {
        let area = std::f64::consts::PI * scene_radius * scene_radius;
        match self {
            Environment::Constant(constant) => area * constant.fluence(range),
            Environment::Sky(sky) => area * sky.fluence(),
            Environment::Image(image) => area * image.fluence() * range.width_nm(),
        }
    }
}
