//! A picture of whatever kind, told apart by its first bytes.

use arsc_spectral::{Channels, Raster, srgb};
use glam::DVec3;

use crate::{
    ColourImage, ImageError, SpectralImage, UNIT_LUMINANCE, art_raw, decode_csv, decode_exr_picture, decode_jpeg,
    decode_png, decode_tiff, encode_colour_exr, encode_exr, radiance_hdr,
};

#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    Spectral(SpectralImage),
    Colour(ColourImage),
}

impl Picture {
    /// Reads OpenEXR, PNG, JPEG, TIFF, Radiance HDR, ARTRAW or CSV, whatever the file is called.
    pub fn decode(bytes: &[u8]) -> Result<Picture, ImageError> {
        match bytes {
            [0x76, 0x2F, 0x31, 0x01, ..] => decode_exr_picture(bytes),
            [0xFF, 0xD8, 0xFF, ..] => decode_jpeg(bytes).map(Picture::Colour),
            [0x89, b'P', b'N', b'G', ..] => decode_png(bytes).map(Picture::Colour),
            [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => decode_tiff(bytes).map(Picture::Colour),
            [b'#', b'?', ..] => radiance_hdr::decode(bytes).map(Picture::Colour),
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

    /// The pixels as data: spectra at the centres of their bands, or linear sRGB relative to [`UNIT_LUMINANCE`]. Stokes parameters
    /// and further channels stay behind.
    pub fn to_raster(&self) -> Result<Raster, ImageError> {
        let (channels, values) = match self {
            Picture::Spectral(image) => {
                let centers = (0..image.bands()).map(|band| image.band_center_nm(band)).collect();
                (Channels::Spectral(centers), image.radiance.clone())
            }
            Picture::Colour(image) => {
                let rgb_from_xyz = srgb::rgb_from_xyz() * (1.0 / UNIT_LUMINANCE);
                let rgb = |xyz: &[f32; 3]| (rgb_from_xyz * DVec3::from_array(xyz.map(f64::from))).as_vec3().to_array();
                (Channels::Rgb, image.xyz.iter().flat_map(rgb).collect())
            }
        };
        Raster::new(self.width(), self.height(), channels, values)
            .ok_or_else(|| ImageError::Malformed("it has no pixels, or bands out of order".into()))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_become_linear_srgb() {
        let mut bytes = b"#?RADIANCE\n\n-Y 1 +X 2\n".to_vec();
        bytes.extend([128, 64, 0, 129, 0, 0, 0, 0]);
        let raster = Picture::decode(&bytes).and_then(|picture| picture.to_raster()).unwrap();
        let expected = [128.5 / 128.0, 64.5 / 128.0, 0.5 / 128.0];
        for (got, expected) in raster.pixel(0, 0).iter().zip(expected) {
            assert!((got - expected).abs() < 1e-5, "{got} instead of {expected}");
        }
        assert!(raster.pixel(1, 0).iter().all(|c| *c == 0.0));
    }

    #[test]
    fn spectra_keep_their_wavelengths() {
        let image = SpectralImage {
            width: 2,
            height: 1,
            band_edges_nm: vec![395.0, 405.0, 415.0],
            radiance: vec![1.0, 2.0, 3.0, 4.0],
            stokes: None,
            xyz: vec![[0.0; 3]; 2],
            channels: vec![],
            metadata: vec![],
        };
        let raster = Picture::Spectral(image).to_raster().unwrap();
        assert_eq!(raster.channels(), &Channels::Spectral(vec![400.0, 410.0]));
        assert_eq!((raster.pixel(0, 0), raster.pixel(1, 0)), (&[1.0, 2.0][..], &[3.0, 4.0][..]));
    }
}
