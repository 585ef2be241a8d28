//! Lights that are no geometry, and environments.

use std::sync::Arc;

use arsc_geometry::DVec3;
use arsc_spectral::{PhotometricWeb, Raster, Spectrum};

#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// At the origin of its frame. Radiant intensity in W sr^-1 nm^-1.
    Point { intensity: Spectrum },
    /// At the origin of its frame, about its +z: `intensity` (W sr^-1 nm^-1) times the cosine to the power of `exponent`, and
    /// nothing beyond `angle`, radians, at most a right angle.
    Spot { intensity: Spectrum, exponent: f64, angle: f64 },
    /// At the origin of its frame, its nadir along -z: candela by direction, in the colour of a spectrum of any scale.
    Photometric { web: Arc<PhotometricWeb>, spectrum: Spectrum },
    /// From infinitely far, travelling along `direction` (unit). Irradiance across the beam in W m^-2 nm^-1.
    Distant { irradiance: Spectrum, direction: DVec3 },
}

impl Light {
    /// It shines from the origin of its frame.
    pub fn is_point(&self) -> bool {
        !matches!(self, Light::Distant { .. })
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Environment {
    /// W m^-2 sr^-1 nm^-1 from everywhere.
    Constant {
        radiance: Spectrum,
    },
    /// What fills all space that no solid fills: an entry of [`crate::Ir::media`]. The first one counts.
    Medium {
        medium: u32,
    },
    Sky(Sky),
    /// A picture in latitude and longitude, its top about +z; the path is relative to the root script's folder.
    Image {
        path: Arc<str>,
        image: Arc<Raster>,
        scale: f64,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SkyModel {
    /// Hosek and Wilkie 2012, with the solar disc of 2013.
    HosekWilkie,
    /// Preetham, Shirley and Smits 1999.
    Preetham,
}

impl SkyModel {
    pub const ALL: [SkyModel; 2] = [SkyModel::HosekWilkie, SkyModel::Preetham];

    pub const fn name(self) -> &'static str {
        match self {
            SkyModel::HosekWilkie => "hosek_wilkie",
            SkyModel::Preetham => "preetham",
        }
    }
}

/// A clear sky with its sun; z is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    pub model: SkyModel,
    /// 1 to 10.
    pub turbidity: f64,
    pub ground_albedo: f64,
    /// Towards the sun, unit.
    pub sun: DVec3,
    pub solar_disc: bool,
    pub scale: f64,
    /// Kelvin of the star in the sun's place; `None` for the sun.
    pub star_temperature: Option<f64>,
    /// Irradiance of the star beyond the air, relative to the sun's.
    pub star_intensity: f64,
    pub polarised: bool,
}
