//! Image types and files.
//!
//! A [`SpectralImage`] is what a render gives, a [`ColourImage`] what a picture without spectra holds, a [`Picture`] either
//! of them; a [`DisplayImage`] is what a screen shows (`arsc-imaging` leads there). Codecs work on bytes in memory; the
//! only function that leaves something on the disk is [`write_whole`]: a file is written whole or not at all. Readers
//! believe no size that the bytes could not hold.
//!
//! Conventions: rows from the top, pixels from the left; wavelengths in nm; XYZ of the CIE 1931 2 degree observer.
//! Linear sRGB is relative to [`UNIT_LUMINANCE`].
//! Equal images with equal metadata give equal bytes: no clock, no hash order, no thread count enters a file.

mod art_raw;
mod claims;
mod colour;
mod csv;
mod display;
mod error;
mod exr_header;
mod exr_read;
mod exr_write;
mod jpeg_read;
mod picture;
mod png_read;
mod png_write;
mod profile;
mod radiance_hdr;
mod spectral;
mod tiff_read;
mod tiff_write;
mod whole_file;

pub use colour::ColourImage;
pub use csv::{decode_csv, encode_csv};
pub use display::{Depth, DisplayImage};
pub use error::ImageError;
pub use exr_read::{decode_exr, decode_exr_picture};
pub use exr_write::{encode_colour_exr, encode_display_exr, encode_exr};
pub use jpeg_read::decode_jpeg;
pub use picture::Picture;
pub use png_read::decode_png;
pub use png_write::encode_png;
pub use spectral::{Channel, SpectralImage, band_weights, xyz_of_bands};
pub use tiff_read::decode_tiff;
pub use tiff_write::encode_tiff;
pub use whole_file::{check_writable, write_whole};

/// Luminance, cd m^-2, of the relative luminance 1: that of the equal-energy radiance 1 W m^-2 sr^-1 nm^-1.
pub const UNIT_LUMINANCE: f64 = arsc_spectral::LUMINOUS_EFFICACY * arsc_spectral::Y_INTEGRAL_NM;
