//! Lights that are no geometry, and environments.

use arsc_geometry::DVec3;
use arsc_spectral::Spectrum;

#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// At the origin of its frame. Radiant intensity in W sr^-1 nm^-1.
    Point { intensity: Spectrum },
    /// From infinitely far, travelling along `direction` (unit). Irradiance across the beam in W m^-2 nm^-1.
    Distant { irradiance: Spectrum, direction: DVec3 },
}

#[derive(Clone, Debug, PartialEq)]
pub enum Environment {
    /// W m^-2 sr^-1 nm^-1 from everywhere.
    Constant { radiance: Spectrum },
    /// What fills all space that no solid fills: an entry of [`crate::Ir::media`]. The first one counts.
    Medium { medium: u32 },
    /// Hosek and Wilkie 2012, with the solar disc of 2013 unless `solar_disc` is off; z is up.
    HosekWilkie { turbidity: f64, ground_albedo: f64, sun: DVec3, solar_disc: bool, scale: f64 },
}
