//! Images for a screen.

use arsc_spectral::colour_space::ColourSpace;

use crate::ImageError;

/// Components coded for a display.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayImage {
    pub width: usize,
    pub height: usize,
    pub space: ColourSpace,
    /// `[y][x][RGB]`, coded by the space's transfer function, in [0, 1]; files quantise them.
    pub rgb: Vec<[f32; 3]>,
    /// Free text that travels with the picture.
    pub metadata: Vec<(String, String)>,
}

/// Bits of a component in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Depth {
    #[default]
    Eight,
    Sixteen,
}

impl Depth {
    pub const fn bits(self) -> u32 {
        match self {
            Depth::Eight => 8,
            Depth::Sixteen => 16,
        }
    }
}

impl DisplayImage {
    /// That there is at least a pixel and that the buffer has the stated size.
    pub fn verify(&self) -> Result<(), ImageError> {
        let expected = self.width.checked_mul(self.height).unwrap_or(0);
        if self.rgb.len() != expected || expected == 0 {
            return Err(ImageError::Shape { what: "the image", found: self.rgb.len(), expected: expected.max(1) });
        }
        Ok(())
    }

    /// The components in 8 bit.
    pub fn bytes(&self) -> Vec<u8> {
        self.rgb.as_flattened().iter().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8).collect()
    }

    /// The components in 16 bit.
    pub fn words(&self) -> Vec<u16> {
        self.rgb.as_flattened().iter().map(|c| (c.clamp(0.0, 1.0) * 65_535.0).round() as u16).collect()
    }
}
