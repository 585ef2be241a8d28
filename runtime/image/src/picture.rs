//! A picture of whatever kind, told apart by its first bytes.

use crate::{
    ColourImage, ImageError, SpectralImage, art_raw, decode_csv, decode_exr_picture, decode_png, decode_tiff,
    encode_colour_exr, encode_exr,
};

#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    Spectral(SpectralImage),
    Colour(ColourImage),
}

impl Picture {
    /// Reads OpenEXR, PNG, TIFF, ARTRAW or CSV, whatever the file is called.
    pub fn decode(bytes: &[u8]) -> Result<Picture, ImageError> {
        match bytes {
            [0x76, 0x2F, 0x31, 0x01, ..] => decode_exr_picture(bytes),
            [0x89, b'P', b'N', b'G', ..] => decode_png(bytes).map(Picture::Colour),
            [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => decode_tiff(bytes).map(Picture::Colour),
            _ if art_raw::is_one(bytes) => art_raw::decode(bytes),
            [b'x', b',', b'y', ..] => {
                let text = std::str::from_utf8(bytes)
                    .map_err(|source| ImageError::Decode { format: "CSV", source: Box::new(source) })?;
                decode_csv(text).map(Picture::Spectral)
            }
            _ => Err(ImageError::Unknown),
        }
    }

    /// An OpenEXR file of everything that the picture holds.
    pub fn encode_exr(&self) -> Result<Vec<u8>, ImageError> {
        match self {
            Picture::Spectral(image) => encode_exr(image),
            Picture::Colour(image) => encode_colour_exr(image),
        }
    }

    pub fn width(&self) -> usize {
        match self {
            Picture::Spectral(image) => image.width,
            Picture::Colour(image) => image.width,
        }
    }

    pub fn height(&self) -> usize {
        match self {
            Picture::Spectral(image) => image.height,
            Picture::Colour(image) => image.height,
        }
    }

    /// `[y][x][XYZ]`, Y in cd m^-2.
    pub fn xyz(&self) -> &[[f32; 3]] {
        match self {
            Picture::Spectral(image) => &image.xyz,
            Picture::Colour(image) => &image.xyz,
        }
    }

    pub fn channels(&self) -> &[crate::Channel] {
        match self {
            Picture::Spectral(image) => &image.channels,
            Picture::Colour(image) => &image.channels,
        }
    }

    pub fn metadata(&self) -> &[(String, String)] {
        match self {
            Picture::Spectral(image) => &image.metadata,
            Picture::Colour(image) => &image.metadata,
        }
    }

    pub fn metadata_mut(&mut self) -> &mut Vec<(String, String)> {
        match self {
            Picture::Spectral(image) => &mut image.metadata,
            Picture::Colour(image) => &mut image.metadata,
        }
    }

    /// The value of a name in the metadata.
    pub fn noted(&self, name: &str) -> Option<&str> {
        self.metadata().iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }
}
