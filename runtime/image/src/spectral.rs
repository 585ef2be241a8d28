//! Spectral images.

use arsc_spectral::{LUMINOUS_EFFICACY, Observer};

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

/// An unpolarised or polarised image whose XYZ follows from its bands.
pub(crate) fn from_bands(
    [width, height]: [usize; 2],
    band_edges_nm: Vec<f64>,
    radiance: Vec<f32>,
    stokes: Option<Vec<[f32; 3]>>,
) -> Result<SpectralImage, ImageError> {
    let xyz = xyz_of_bands(&radiance, &band_edges_nm, Observer::Cie1931);
    let (channels, metadata) = (Vec::new(), Vec::new());
    let image = SpectralImage { width, height, band_edges_nm, radiance, stokes, xyz, channels, metadata };
    image.verify()?;
    Ok(image)
}

/// `[pixel][XYZ]` of `[pixel][band]` radiances, Y in cd m^-2; each band counts as constant.
pub fn xyz_of_bands(radiance: &[f32], band_edges_nm: &[f64], observer: Observer) -> Vec<[f32; 3]> {
    let weights = band_weights(band_edges_nm, observer);
    let pixel = |bands: &[f32]| {
        let mut xyz = [0.0; 3];
        for (value, weight) in bands.iter().zip(&weights) {
            for c in 0..3 {
                xyz[c] += f64::from(*value) * weight[c];
            }
        }
        xyz.map(|c| c as f32)
    };
    radiance.chunks_exact(weights.len().max(1)).map(pixel).collect()
}

/// What the radiance 1 of each band gives in X, Y and Z: integrals of the matching functions, in steps of at most 1 nm.
pub fn band_weights(band_edges_nm: &[f64], observer: Observer) -> Vec<[f64; 3]> {
    // Steps for bands so wide that they would not end; the functions are zero beyond a kilometre's fraction anyway.
    const MOST_STEPS: f64 = 1e4;
    let weight = |edge: &[f64]| {
        let steps = (edge[1] - edge[0]).ceil().clamp(1.0, MOST_STEPS);
        let width = (edge[1] - edge[0]) / steps;
        let mut sum = [0.0; 3];
        for i in 0..steps as u32 {
            let matching = observer.matching_at(edge[0] + (f64::from(i) + 0.5) * width);
            for c in 0..3 {
                sum[c] += matching[c] * width * LUMINOUS_EFFICACY;
            }
        }
        sum
    };
    band_edges_nm.windows(2).map(weight).collect()
}

/// Edges half-way between neighbouring centres; the outermost bands are symmetric about theirs.
pub(crate) fn midpoints(centers: &[f64]) -> Vec<f64> {
    let (first, last) = (centers[0], centers[centers.len() - 1]);
    let half = |pair: Option<(f64, f64)>| pair.map_or(0.5, |(a, b)| 0.5 * (b - a));
    let at = |i: usize| Some((*centers.get(i)?, *centers.get(i + 1)?));
    std::iter::once(first - half(at(0)))
        .chain(centers.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])))
        .chain(std::iter::once(last + half(centers.len().checked_sub(2).and_then(at))))
        .collect()
}

fn check(what: &'static str, found: usize, expected: usize) -> Result<(), ImageError> {
    if found == expected { Ok(()) } else { Err(ImageError::Shape { what, found, expected }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_default_to_midpoints() {
        assert_eq!(midpoints(&[400.0, 410.0, 430.0]), vec![395.0, 405.0, 420.0, 440.0]);
        assert_eq!(midpoints(&[500.0]), vec![499.5, 500.5]);
    }

    /// The equal-energy radiance 1 has the luminance that the unit is named after.
    #[test]
    fn bands_integrate_to_the_unit() {
        let edges: Vec<f64> = (0..=47).map(|i| 360.0 + 10.0 * f64::from(i)).collect();
        let [x, y, z] = xyz_of_bands(&[1.0; 47], &edges, Observer::Cie1931)[0].map(f64::from);
        for value in [x, y, z] {
            assert!((value / crate::UNIT_LUMINANCE - 1.0).abs() < 1e-3, "{x} {y} {z}");
        }
    }
}
