//! PNG: 8 bit sRGB with the metadata as UTF-8 text chunks named `arsc:…`.

use crate::{DisplayImage, ImageError};

/// The bytes of a PNG file.
pub fn encode_png(image: &DisplayImage) -> Result<Vec<u8>, ImageError> {
    let expected = image.width * image.height;
    if image.rgb.len() != expected || expected == 0 {
        return Err(ImageError::Shape { what: "the image", found: image.rgb.len(), expected: expected.max(1) });
    }
    encode(image).map_err(|source| ImageError::Encode { format: "PNG", source: Box::new(source) })
}

fn encode(image: &DisplayImage) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width as u32, image.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    for (name, value) in &image.metadata {
        encoder.add_itxt_chunk(keyword(name), value.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(image.rgb.as_flattened())?;
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
            rgb: (0..6).map(|i| [i * 40, 255 - i * 40, i]).collect(),
            metadata: vec![("scene".into(), "Würfel – 立方体".into()), ("seed".into(), "7".into())],
        }
    }

    #[test]
    fn pixels_and_texts_read_back() {
        let image = image();
        let bytes = encode_png(&image).unwrap();
        assert_eq!(bytes, encode_png(&image).unwrap(), "same image, same bytes");
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!(pixels, image.rgb.as_flattened());
        let texts = &reader.info().utf8_text;
        assert_eq!(texts[0].keyword, "arsc:scene");
        assert_eq!(texts[0].get_text().unwrap(), "Würfel – 立方体");
        assert_eq!(texts[1].keyword, "arsc:seed");
        assert!(reader.info().srgb.is_some());
    }

    #[test]
    fn a_buffer_of_the_wrong_size_is_an_error() {
        let mut image = image();
        image.rgb.pop();
        assert!(matches!(encode_png(&image), Err(ImageError::Shape { found: 5, expected: 6, .. })));
    }
}
