//! Image types and files.
//!
//! A [`SpectralImage`] is what a render gives; a [`DisplayImage`] is what a screen shows; [`tone_map`] leads from the
//! first to the second. Codecs work on bytes in memory ([`encode_exr`], [`decode_exr`], [`encode_png`]); the only
//! function that touches the disk is [`write_whole`], and with it a file is written whole or not at all.
//!
//! Conventions: rows from the top, pixels from the left; wavelengths in nm; XYZ of the CIE 1931 2 degree observer.
//! Equal images with equal metadata give equal bytes: no clock, no hash order, no thread count enters a file.

mod display;
mod error;
mod exr_header;
mod exr_read;
mod exr_write;
mod png_write;
mod spectral;
mod srgb;
mod tone_map;
mod whole_file;

pub use display::DisplayImage;
pub use error::ImageError;
pub use exr_read::decode_exr;
pub use exr_write::encode_exr;
pub use png_write::encode_png;
pub use spectral::SpectralImage;
pub use srgb::{UNIT_LUMINANCE, linear_srgb_from_xyz, srgb_encode};
pub use tone_map::{Exposure, tone_map};
pub use whole_file::write_whole;
