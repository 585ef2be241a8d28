//! Reading TIFF files: grey or RGB of 8 or 16 bit, coded as the ICC profile says or as sRGB, and floats as linear sRGB.

use std::io::Cursor;

use arsc_spectral::srgb;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use crate::{ColourImage, ImageError, UNIT_LUMINANCE, claims};

/// Largest profile or text of a tag.
const LARGEST_TAG: usize = 16 << 20;

/// Colours from the bytes of a TIFF file; an alpha channel is left out.
pub fn decode_tiff(bytes: &[u8]) -> Result<ColourImage, ImageError> {
    let failed = |source: tiff::TiffError| ImageError::Decode { format: "TIFF", source: Box::new(source) };
    let mut limits = Limits::default();
    limits.decoding_buffer_size = claims::most_bytes(bytes);
    limits.intermediate_buffer_size = claims::most_bytes(bytes);
    limits.ifd_value_size = LARGEST_TAG;
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(failed)?.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(failed)?;
    claims::check("TIFF", bytes, u64::from(width) * u64::from(height))?;
    let channels = match decoder.colortype().map_err(failed)? {
        ColorType::Gray(_) => 1,
        ColorType::GrayA(_) => 2,
        ColorType::RGB(_) => 3,
        ColorType::RGBA(_) => 4,
        other => return Err(ImageError::Malformed(format!("TIFF pictures with {other:?} are not read"))),
    };
    let profile = decoder.get_tag_u8_vec(Tag::IccProfile).ok().filter(|_| channels >= 3);
    let size = [width as usize, height as usize];
    let of = |samples: Vec<f64>| -> Vec<[f64; 3]> {
        let colour = |p: &[f64]| if channels < 3 { [p[0]; 3] } else { [p[0], p[1], p[2]] };
        samples.chunks_exact(channels).map(colour).collect()
    };
    let coded = |rgb: Vec<[f64; 3]>| ColourImage::from_coded(size, rgb.into_iter(), profile.as_deref(), Vec::new());
    let linear =
        |rgb: Vec<[f64; 3]>| ColourImage::from_linear(size, rgb.into_iter(), srgb::xyz_from_rgb() * UNIT_LUMINANCE);
    match decoder.read_image().map_err(failed)? {
        DecodingResult::U8(samples) => coded(of(samples.iter().map(|s| f64::from(*s) / 255.0).collect())),
        DecodingResult::U16(samples) => coded(of(samples.iter().map(|s| f64::from(*s) / 65_535.0).collect())),
        DecodingResult::F32(samples) => linear(of(samples.iter().map(|s| f64::from(*s)).collect())),
        DecodingResult::F64(samples) => linear(of(samples)),
        _ => Err(ImageError::Malformed("TIFF pictures are read with 8 or 16 bit or floats".into())),
    }
}
