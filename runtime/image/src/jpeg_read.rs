//! Reading JPEG files: grey or colour, eight bits.

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::{ColourImage, ImageError, claims};

/// Colours from the bytes of a JPEG file: by its ICC profile, else as sRGB.
pub fn decode_jpeg(bytes: &[u8]) -> Result<ColourImage, ImageError> {
    let failed = |source| ImageError::Decode { format: "JPEG", source: Box::new(source) };
    let options = DecoderOptions::default().set_strict_mode(true).jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(failed)?;
    let size = decoder.info().map_or([0; 2], |info| [usize::from(info.width), usize::from(info.height)]);
    claims::check("JPEG", bytes, size[0] as u64 * size[1] as u64)?;
    let samples = decoder.decode().map_err(failed)?;
    let profile = decoder.icc_profile();
    let rgb = samples.chunks_exact(3).map(|pixel| std::array::from_fn(|channel| f64::from(pixel[channel]) / 255.0));
    ColourImage::from_coded(size, rgb, profile.as_deref(), Vec::new())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Baseline, 8 by 8, one block of one colour: luma 128 + 16, nothing in colour; hand-made with the shortest tables.
    fn grey() -> Vec<u8> {
        let mut bytes = vec![0xFF, 0xD8, 0xFF, 0xDB, 0, 67, 0];
        bytes.extend([1; 64]);
        bytes.extend([0xFF, 0xC0, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0]);
        // One code of one bit each: a difference of 8 bits; end of the block.
        for (class, symbol) in [(0x00, 8), (0x10, 0)] {
            bytes.extend([0xFF, 0xC4, 0, 20, class, 1]);
            bytes.extend([0; 15]);
            bytes.push(symbol);
        }
        bytes.extend([0xFF, 0xDA, 0, 8, 1, 1, 0, 0, 63, 0]);
        // 0, then 128 in eight bits, then 0, then ones: 128 / 8 = 16 above the middle.
        bytes.extend([0b0100_0000, 0b0011_1111, 0xFF, 0xD9]);
        bytes
    }

    #[test]
    fn a_block_of_one_grey_is_read() {
        let image = decode_jpeg(&grey()).unwrap();
        assert_eq!((image.width, image.height), (8, 8));
        let wanted = arsc_spectral::srgb::decode(144.0 / 255.0) * crate::UNIT_LUMINANCE;
        assert!(image.xyz.iter().all(|xyz| (f64::from(xyz[1]) / wanted - 1.0).abs() < 1e-5), "{:?}", image.xyz[0]);
    }

    #[test]
    fn garbage_and_cut_files_are_errors() {
        let bytes = grey();
        assert!(decode_jpeg(b"\xFF\xD8\xFF no image").is_err());
        for cut in [2, 30, 80, 110] {
            assert!(decode_jpeg(&bytes[..cut]).is_err(), "cut at {cut}");
        }
        let mut large = bytes.clone();
        let size = large.windows(2).position(|w| w == [0xFF, 0xC0]).unwrap() + 5;
        large[size..size + 4].copy_from_slice(&[0xFF; 4]);
        assert!(decode_jpeg(&large).is_err());
    }
}
