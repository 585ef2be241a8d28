//! TIFF: 8 or 16 bit RGB with an ICC profile, deflated with horizontal prediction; the metadata is the description.

use std::io::Cursor;

use tiff::encoder::colortype::{RGB8, RGB16};
use tiff::encoder::{Compression, DeflateLevel, Predictor, TiffEncoder};
use tiff::tags::Tag;

use crate::{Depth, DisplayImage, ImageError, profile};

/// The bytes of a TIFF file.
pub fn encode_tiff(image: &DisplayImage, depth: Depth) -> Result<Vec<u8>, ImageError> {
    image.verify()?;
    encode(image, depth).map_err(|source| ImageError::Encode { format: "TIFF", source: Box::new(source) })
}

fn encode(image: &DisplayImage, depth: Depth) -> tiff::TiffResult<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes)?
        .with_compression(Compression::Deflate(DeflateLevel::Balanced))
        .with_predictor(Predictor::Horizontal);
    let (width, height) = (image.width as u32, image.height as u32);
    let profile = profile::encode(image.space);
    let description = description(&image.metadata);
    macro_rules! write {
        ($kind:ty, $samples:expr) => {{
            let mut picture = encoder.new_image::<$kind>(width, height)?;
            picture.encoder().write_tag(Tag::IccProfile, profile.as_slice())?;
            picture.encoder().write_tag(Tag::Software, "arsc")?;
            if !description.is_empty() {
                picture.encoder().write_tag(Tag::ImageDescription, description.as_str())?;
            }
            picture.write_data(&$samples)?;
        }};
    }
    match depth {
        Depth::Eight => write!(RGB8, image.bytes()),
        Depth::Sixteen => write!(RGB16, image.words()),
    }
    Ok(bytes.into_inner())
}

/// `name: value`, a line each, in ASCII as the format wants it.
fn description(metadata: &[(String, String)]) -> String {
    let line = |(name, value): &(String, String)| format!("{name}: {value}").replace(['\n', '\r', '\0'], " ");
    let text = metadata.iter().map(line).collect::<Vec<_>>().join("\n");
    text.chars().map(|c| if c.is_ascii() { c } else { '?' }).collect()
}
