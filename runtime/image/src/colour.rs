//! Images of colours, without a spectrum.

use glam::{DMat3, DVec3};

use arsc_spectral::srgb;

use crate::profile::Profile;
use crate::{Channel, ImageError, UNIT_LUMINANCE};

/// CIE XYZ per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourImage {
    pub width: usize,
    pub height: usize,
    /// `[y][x][XYZ]`, Y in cd m^-2; the white of a display picture has [`UNIT_LUMINANCE`].
    pub xyz: Vec<[f32; 3]>,
    /// Further quantities of the pixels, by increasing name, each name once.
    pub channels: Vec<Channel>,
    pub metadata: Vec<(String, String)>,
}

impl ColourImage {
    /// That there is at least a pixel, that channels are sorted, and that the buffers have the stated size.
    pub fn verify(&self) -> Result<(), ImageError> {
        let pixels = self.width.checked_mul(self.height).unwrap_or(0);
        if pixels == 0 || self.xyz.len() != pixels {
            return Err(ImageError::Shape { what: "the image", found: self.xyz.len(), expected: pixels.max(1) });
        }
        if let Some(channel) = self.channels.iter().find(|channel| channel.samples.len() != pixels) {
            return Err(ImageError::Shape { what: "channel", found: channel.samples.len(), expected: pixels });
        }
        if !self.channels.windows(2).all(|pair| pair[0].name < pair[1].name) {
            return Err(ImageError::Malformed("the channels are not sorted by distinct names".into()));
        }
        Ok(())
    }

    /// From components that a file holds: coded as the ICC profile says, as sRGB without one.
    pub(crate) fn from_coded(
        [width, height]: [usize; 2],
        rgb: impl Iterator<Item = [f64; 3]>,
        profile: Option<&[u8]>,
        metadata: Vec<(String, String)>,
    ) -> Result<ColourImage, ImageError> {
        let xyz = match profile {
            Some(bytes) => {
                let profile = Profile::read(bytes).ok_or_else(|| {
                    ImageError::Malformed("its colour profile is not one of matrix and curves".into())
                })?;
                rgb.map(|c| absolute(profile.xyz(c))).collect()
            }
            None => {
                let xyz_from_rgb = srgb::xyz_from_rgb();
                rgb.map(|c| absolute(xyz_from_rgb * DVec3::from_array(c.map(srgb::decode)))).collect()
            }
        };
        let image = ColourImage { width, height, xyz, channels: Vec::new(), metadata };
        image.verify()?;
        Ok(image)
    }

    /// From linear components; `xyz_from_rgb` is absolute.
    pub(crate) fn from_linear(
        [width, height]: [usize; 2],
        rgb: impl Iterator<Item = [f64; 3]>,
        xyz_from_rgb: DMat3,
    ) -> Result<ColourImage, ImageError> {
        let xyz = rgb.map(|c| (xyz_from_rgb * DVec3::from_array(c)).as_vec3().to_array()).collect();
        let image = ColourImage { width, height, xyz, channels: Vec::new(), metadata: Vec::new() };
        image.verify()?;
        Ok(image)
    }
}

fn absolute(xyz: DVec3) -> [f32; 3] {
    (xyz * UNIT_LUMINANCE).as_vec3().to_array()
}
