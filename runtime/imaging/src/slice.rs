//! One wavelength of a spectral picture, as grey.

use arsc_image::{ColourImage, Picture, SpectralImage, UNIT_LUMINANCE};
use arsc_spectral::colour_space::{D65_WHITE, xyz_of_chromaticity};

use crate::ImagingError;

/// Radiances at a wavelength, W m^-2 sr^-1 nm^-1: linear between the centres of bands, constant beyond the first and the last.
pub fn radiance_at(image: &SpectralImage, lambda_nm: f64) -> Result<Vec<f32>, ImagingError> {
    let ((low, high), t) = neighbours(image, lambda_nm)?;
    let at = |bands: &[f32]| bands[low] + t * (bands[high] - bands[low]);
    Ok(image.radiance.chunks_exact(image.bands()).map(at).collect())
}

/// The picture at a wavelength in the grey of D65: the radiance 1 is as bright as display white.
pub fn slice(picture: &Picture, lambda_nm: f64) -> Result<Picture, ImagingError> {
    let Picture::Spectral(image) = picture else { return Err(ImagingError::NoSpectrum) };
    slice_of(image, lambda_nm).map(Picture::Colour)
}

/// The same of a spectral image.
pub fn slice_of(image: &SpectralImage, lambda_nm: f64) -> Result<ColourImage, ImagingError> {
    let white = (xyz_of_chromaticity(D65_WHITE) * UNIT_LUMINANCE).as_vec3();
    let mut metadata = image.metadata.clone();
    metadata.push(("slice".into(), format!("{lambda_nm}nm")));
    Ok(ColourImage {
        width: image.width,
        height: image.height,
        xyz: radiance_at(image, lambda_nm)?.into_iter().map(|value| (white * value).to_array()).collect(),
        channels: Vec::new(),
        metadata,
    })
}

/// The bands on either side of a wavelength and how far it lies from the first.
pub(crate) fn neighbours(image: &SpectralImage, wanted: f64) -> Result<((usize, usize), f32), ImagingError> {
    let bands = image.bands();
    let (first, last) = (image.band_edges_nm[0], image.band_edges_nm[bands]);
    if !(first..=last).contains(&wanted) {
        return Err(ImagingError::Wavelength { wanted, first, last });
    }
    let high = (0..bands).find(|&band| image.band_center_nm(band) >= wanted).unwrap_or(bands - 1);
    let low = high.saturating_sub(1);
    let (from, to) = (image.band_center_nm(low), image.band_center_nm(high));
    let t = if to > from { ((wanted - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
    Ok(((low, high), t as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radiance_is_linear_between_centres() {
        let image = SpectralImage {
            width: 1,
            height: 1,
            band_edges_nm: vec![400.0, 500.0, 600.0, 800.0],
            radiance: vec![1.0, 3.0, 9.0],
            stokes: None,
            xyz: vec![[0.0; 3]],
            channels: vec![],
            metadata: vec![],
        };
        for (lambda, value) in [(400.0, 1.0), (450.0, 1.0), (500.0, 2.0), (550.0, 3.0), (625.0, 6.0), (790.0, 9.0)] {
            assert_eq!(radiance_at(&image, lambda).unwrap(), [value], "{lambda} nm");
        }
        for outside in [399.0, 801.0, f64::NAN] {
            assert!(matches!(radiance_at(&image, outside), Err(ImagingError::Wavelength { .. })));
        }
        let grey = slice(&Picture::Spectral(image), 550.0).unwrap();
        assert!((f64::from(grey.xyz()[0][1]) / UNIT_LUMINANCE - 3.0).abs() < 1e-6);
    }
}
