//! Spectra, colour matching, sampled wavelengths and sky radiance.
//!
//! Pure data and mathematics. Conventions: wavelengths in vacuum, in nanometres, named `lambda_nm`; spectral
//! quantities are densities per nanometre; reflectances and transmittances lie in [0, 1].
//! [`Spectrum`] is what a scene says; [`DenseSpectrum`] is the table that a renderer reads; [`SampledSpectrum`] is
//! what one path carries at the four wavelengths of its [`SampledWavelengths`], drawn from a [`WavelengthDistribution`] over the [`WavelengthRange`] of the render.

pub mod adaptation;
pub mod colour;
mod colour_basis;
pub mod colour_space;
mod daylight;
mod dense;
pub mod dispersion;
mod eval;
pub mod illuminant;
mod merl;
mod observer;
mod photometric_web;
pub mod pictures;
mod planck;
mod preetham;
mod range;
mod raster;
mod reradiation;
mod reradiation_table;
mod sampled;
pub mod sky;
mod sky_lanes;
mod sky_polarisation;
mod spectrum;
pub mod srgb;
mod star;
pub mod tone;
mod uplift;
mod wavelengths;

pub use colour_basis::ColourBasis;
pub use daylight::{DAYLIGHT_KELVIN, daylight, daylight_chromaticity, normalised};
pub use dense::DenseSpectrum;
pub use merl::{MerlBrdf, MerlError};
pub use observer::{
    LUMINOUS_EFFICACY, Observer, Y_INTEGRAL_NM, chromaticity, d65, xyz_of_radiance, xyz_of_reflectance,
};
pub use photometric_web::{PhotometricWeb, WebError};
pub use planck::planck;
pub use preetham::PreethamSky;
pub use range::{KNOTS, TABLE_MAX_NM, TABLE_MIN_NM, WavelengthRange};
pub use raster::{Channels, Raster};
pub use reradiation::{DonaldsonMatrix, Dye, Fluorescence, Reradiation};
pub use reradiation_table::ReradiationTable;
pub use sampled::SampledSpectrum;
pub use sky_lanes::SkyLanes;
pub use sky_polarisation::SkyPolarisation;
pub use spectrum::Spectrum;
pub use star::Star;
pub use uplift::{uplift_rgb, uplift_xyz};
pub use wavelengths::{SampledWavelengths, WavelengthDistribution};
