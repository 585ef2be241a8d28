//! Image types and files.
//!
//! A [`SpectralImage`] is what a render gives; a [`DisplayImage`] is what a screen shows; [`tone_map`] leads from the
//! first to the second. Codecs work on bytes in memory ([`encode_exr`], [`decode_exr`], [`encode_png`]); the only
//! function that leaves something on the disk is [`write_whole`]: a file is written whole or not at all.
//!
//! Conventions: rows from the top, pixels from the left; wavelengths in nm; XYZ of the CIE 1931 2 degree observer.
//! Linear sRGB is relative to [`UNIT_LUMINANCE`].
//! Equal images with equal metadata give equal bytes: no clock, no hash order, no thread count enters a file.

mod display;
mod error;
mod exr_header;
mod exr_read;
mod exr_write;
mod png_write;
mod spectral;
mod tone_map;
mod whole_file;

pub use display::DisplayImage;
pub use error::ImageError;
pub use exr_read::decode_exr;
pub use exr_write::encode_exr;
pub use png_write::encode_png;
pub use spectral::{Channel, SpectralImage};
pub use tone_map::{Exposure, tone_map};
pub use whole_file::{check_writable, write_whole};

/// Luminance, cd m^-2, of the relative luminance 1: that of the equal-energy radiance 1 W m^-2 sr^-1 nm^-1.
pub const UNIT_LUMINANCE: f64 = arsc_spectral::LUMINOUS_EFFICACY * arsc_spectral::Y_INTEGRAL_NM;
