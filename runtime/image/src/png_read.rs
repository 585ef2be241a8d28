//! Reading PNG files: grey or colour, any depth; an alpha channel is left out.

use std::io::Cursor;

use crate::{ColourImage, ImageError, claims};

/// Colours from the bytes of a PNG file: by its ICC profile, else as sRGB.
pub fn decode_png(bytes: &[u8]) -> Result<ColourImage, ImageError> {
    let failed = |source: png::DecodingError| ImageError::Decode { format: "PNG", source: Box::new(source) };
    let limits = png::Limits { bytes: claims::most_bytes(bytes) };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(failed)?;
    let (width, height) = (reader.info().width, reader.info().height);
    claims::check("PNG", bytes, u64::from(width) * u64::from(height))?;
    let size = reader.output_buffer_size().ok_or_else(|| claims::refusal("PNG"))?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(failed)?;
    let wide = frame.bit_depth == png::BitDepth::Sixteen;
    let texts = reader.info().utf8_text.iter();
    let metadata = texts
        .filter_map(|text| Some((text.keyword.strip_prefix("arsc:")?.to_owned(), text.get_text().ok()?)))
        .collect();
    let channels = frame.color_type.samples();
    let bytes_per_sample = if wide { 2 } else { 1 };
    let value = |pixel: &[u8], channel: usize| {
        if wide {
            f64::from(u16::from_be_bytes([pixel[2 * channel], pixel[2 * channel + 1]])) / 65_535.0
        } else {
            f64::from(pixel[channel]) / 255.0
        }
    };
    let colour = |pixel: &[u8]| {
        if channels < 3 { [value(pixel, 0); 3] } else { std::array::from_fn(|channel| value(pixel, channel)) }
    };
    let rgb = samples[..frame.buffer_size()].chunks_exact(channels * bytes_per_sample).map(colour);
    // A profile of a grey picture has no matrix; its curve is close to that of sRGB.
    let profile = reader.info().icc_profile.as_deref().filter(|_| channels >= 3);
    ColourImage::from_coded([width as usize, height as usize], rgb, profile, metadata)
}
