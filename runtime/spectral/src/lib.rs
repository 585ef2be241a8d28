//! Spectra, colour matching, sampled wavelengths and sky radiance.
//!
//! Pure data and mathematics. Conventions: wavelengths in vacuum, in nanometres, named `lambda_nm`; spectral
//! quantities are densities per nanometre; reflectances and transmittances lie in [0, 1].
//! [`Spectrum`] is what a scene says; [`DenseSpectrum`] is the table that a renderer reads; [`SampledSpectrum`] is
//! what one path carries at the four wavelengths of its [`SampledWavelengths`].

mod dense;
mod eval;
mod observer;
mod planck;
mod sampled;
pub mod sky;
mod sky_lanes;
mod spectrum;
pub mod srgb;
mod uplift;
mod wavelengths;

pub use dense::DenseSpectrum;
pub use observer::{
    LUMINOUS_EFFICACY, Y_INTEGRAL_NM, chromaticity, d65, matching_at, matching_functions, xyz_of_radiance,
    xyz_of_reflectance,
};
pub use planck::planck;
pub use sampled::SampledSpectrum;
pub use sky_lanes::SkyLanes;
pub use spectrum::Spectrum;
pub use uplift::uplift_rgb;
pub use wavelengths::SampledWavelengths;

/// The rendered range, nm.
pub const LAMBDA_MIN_NM: f64 = 360.0;
/// The rendered range, nm.
pub const LAMBDA_MAX_NM: f64 = 830.0;
