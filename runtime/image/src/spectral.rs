//! Spectral images.

use crate::ImageError;

/// Radiance per band with CIE XYZ beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralImage {
    pub width: usize,
    pub height: usize,
    /// Band edges in nm, one more than there are bands, increasing.
    pub band_edges_nm: Vec<f64>,
    /// `[y][x][band]`, mean spectral radiance of the band, W m^-2 sr^-1 nm^-1.
    pub radiance: Vec<f32>,
    /// `[y][x][band][S1 S2 S3]`, the Stokes parameters beside the radiance S0, in its unit; x of the reference frame points
    /// to the right in the picture, y up, S3 > 0 is right-handed. `None` for unpolarised images.
    pub stokes: Option<Vec<[f32; 3]>>,
    /// `[y][x][XYZ]`, CIE 1931 2 degree, with k = 683 lm/W: Y is luminance in cd m^-2.
    pub xyz: Vec<[f32; 3]>,
    /// Further quantities of the pixels, by increasing name, each name once.
    pub channels: Vec<Channel>,
    /// Free text that travels with the picture: version, scene hash, seed, samples, command line, timings.
    pub metadata: Vec<(String, String)>,
}

/// One number per pixel beside the radiance: a feature of what is seen, or a statistic of the pixel's samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// `layer.component`, such as `normal.X` or `albedo.G`.
    pub name: String,
    /// `[y][x]`
    pub samples: Vec<f32>,
}

impl SpectralImage {
    /// The samples of a channel, `None` if the image lacks it.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|channel| channel.name == name).map(|channel| channel.samples.as_slice())
    }

    pub fn bands(&self) -> usize {
        self.band_edges_nm.len().saturating_sub(1)
    }

    /// Centre of a band, nm.
    pub fn band_center_nm(&self, band: usize) -> f64 {
        0.5 * (self.band_edges_nm[band] + self.band_edges_nm[band + 1])
    }

    /// That there is at least a pixel and a band, that edges increase, that channels are sorted, and that the buffers have
    /// the stated size.
    pub fn verify(&self) -> Result<(), ImageError> {
        let pixels = self.width.checked_mul(self.height).unwrap_or(0);
        if pixels == 0 || self.bands() == 0 {
            return Err(ImageError::Shape { what: "the image", found: 0, expected: 1 });
        }
        if !self.band_edges_nm.windows(2).all(|edge| edge[0] < edge[1]) {
            return Err(ImageError::NotSpectral("band edges do not increase".into()));
        }
        check("radiance", self.radiance.len(), pixels.saturating_mul(self.bands()))?;
        if let Some(stokes) = &self.stokes {
            check("stokes", stokes.len(), self.radiance.len())?;
        }
        for channel in &self.channels {
            check("channel", channel.samples.len(), pixels)?;
        }
        if !self.channels.windows(2).all(|pair| pair[0].name < pair[1].name) {
            return Err(ImageError::NotSpectral("the channels are not sorted by distinct names".into()));
        }
        check("xyz", self.xyz.len(), pixels)
    }
}

fn check(what: &'static str, found: usize, expected: usize) -> Result<(), ImageError> {
    if found == expected { Ok(()) } else { Err(ImageError::Shape { what, found, expected }) }
}
