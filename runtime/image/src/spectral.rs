//! Spectral images.

/// Radiance per band with CIE XYZ beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralImage {
    pub width: usize,
    pub height: usize,
    /// Band edges in nm, one more than there are bands, increasing.
    pub band_edges_nm: Vec<f64>,
    /// `[y][x][band]`, mean spectral radiance of the band, W m^-2 sr^-1 nm^-1.
    pub radiance: Vec<f32>,
    /// `[y][x][XYZ]`, CIE 1931 2 degree, with k = 683 lm/W: Y is luminance in cd m^-2.
    pub xyz: Vec<[f32; 3]>,
    /// Free text that travels with the picture: version, scene hash, seed, samples, command line, timings.
    pub metadata: Vec<(String, String)>,
}
