//! Spectra, colour matching, sampled wavelengths and sky radiance.
//!
//! Pure data and mathematics. Conventions: wavelengths in nanometres in air-free vacuum, named `lambda_nm`; spectral
//! quantities are densities per nanometre; reflectances and transmittances lie in [0, 1].

mod spectrum;

pub use spectrum::Spectrum;

/// The rendered range, nm.
pub const LAMBDA_MIN_NM: f64 = 360.0;
/// The rendered range, nm.
pub const LAMBDA_MAX_NM: f64 = 830.0;
