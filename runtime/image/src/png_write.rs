//! PNG: 8 or 16 bit, with the metadata as UTF-8 text chunks named `arsc:…`.
//!
//! sRGB is said by its chunk, other spaces by an ICC profile.

use std::borrow::Cow;

use arsc_spectral::colour_space::ColourSpace;

use crate::{Depth, DisplayImage, ImageError, profile};

/// The bytes of a PNG file.
pub fn encode_png(image: &DisplayImage, depth: Depth) -> Result<Vec<u8>, ImageError> {
    image.verify()?;
    encode(image, depth).map_err(|source| ImageError::Encode { format: "PNG", source: Box::new(source) })
}

fn encode(image: &DisplayImage, depth: Depth) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut info = png::Info::with_size(image.width as u32, image.height as u32);
    info.color_type = png::ColorType::Rgb;
    info.bit_depth = if depth == Depth::Eight { png::BitDepth::Eight } else { png::BitDepth::Sixteen };
    if image.space != ColourSpace::Srgb {
        info.icc_profile = Some(Cow::Owned(profile::encode(image.space)));
    }
    let mut encoder = png::Encoder::with_info(&mut bytes, info)?;
    if image.space == ColourSpace::Srgb {
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    }
    for (name, value) in &image.metadata {
        encoder.add_itxt_chunk(keyword(name), value.clone())?;
    }
    let mut writer = encoder.write_header()?;
    match depth {
        Depth::Eight => writer.write_image_data(&image.bytes())?,
        Depth::Sixteen => {
            let words: Vec<u8> = image.words().into_iter().flat_map(u16::to_be_bytes).collect();
            writer.write_image_data(&words)?;
        }
    }
    writer.finish()?;
    Ok(bytes)
}

/// A PNG keyword is 1 to 79 bytes of Latin-1.
fn keyword(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).take(70).collect();
    format!("arsc:{plain}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image() -> DisplayImage {
        DisplayImage {
            width: 3,
            height: 2,
            space: ColourSpace::Srgb,
            rgb: (0..6).map(|i| [i as f32 * 0.15, 1.0 - i as f32 * 0.15, i as f32 / 255.0]).collect(),
            metadata: vec![("scene".into(), "Würfel – 立方体".into()), ("seed".into(), "7".into())],
        }
    }

    #[test]
    fn pixels_and_texts_read_back() {
        let image = image();
        let bytes = encode_png(&image, Depth::Eight).unwrap();
        assert_eq!(bytes, encode_png(&image, Depth::Eight).unwrap(), "same image, same bytes");
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!(pixels, image.bytes());
        let texts = &reader.info().utf8_text;
        assert_eq!(texts[0].keyword, "arsc:scene");
        assert_eq!(texts[0].get_text().unwrap(), "Würfel – 立方体");
        assert_eq!(texts[1].keyword, "arsc:seed");
        assert!(reader.info().srgb.is_some() && reader.info().icc_profile.is_none());
    }

    #[test]
    fn other_spaces_carry_their_profile() {
        let image = DisplayImage { space: ColourSpace::Rec2020, ..image() };
        let bytes = encode_png(&image, Depth::Sixteen).unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        assert_eq!(reader.info().icc_profile.as_deref(), Some(&*profile::encode(ColourSpace::Rec2020)));
        assert!(reader.info().srgb.is_none() && reader.info().bit_depth == png::BitDepth::Sixteen);
    }

    #[test]
    fn a_buffer_of_the_wrong_size_is_an_error() {
        let mut image = image();
        image.rgb.pop();
        assert!(matches!(encode_png(&image, Depth::Eight), Err(ImageError::Shape { found: 5, expected: 6, .. })));
    }
}
