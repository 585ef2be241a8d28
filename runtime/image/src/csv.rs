//! Spectral pictures as comma-separated text.
//!
//! The first line names the columns: `x,y` and the centre of each band in nm, such as `x,y,365,375`; every further line is a
//! pixel, rows from the top. Values are radiances, W m^-2 sr^-1 nm^-1, with as many digits as tell them apart.
//! Polarisation, XYZ and further channels are not in it: XYZ is computed from the bands when it is read.

use std::fmt::Write;

use crate::{ImageError, SpectralImage, spectral};

/// The text of a spectral picture.
pub fn encode_csv(image: &SpectralImage) -> Result<String, ImageError> {
    image.verify()?;
    let mut text = String::from("x,y");
    for band in 0..image.bands() {
        let _ = write!(text, ",{}", image.band_center_nm(band));
    }
    text.push('\n');
    for (pixel, radiance) in image.radiance.chunks_exact(image.bands()).enumerate() {
        let _ = write!(text, "{},{}", pixel % image.width, pixel / image.width);
        for value in radiance {
            let _ = write!(text, ",{value}");
        }
        text.push('\n');
    }
    Ok(text)
}

/// A spectral picture from text as [`encode_csv`] writes it: pixels in any order, each once.
pub fn decode_csv(text: &str) -> Result<SpectralImage, ImageError> {
    let malformed = |line: usize, what: &str| ImageError::Malformed(format!("line {line}: {what}"));
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let header = lines.next().map_or("", |(_, line)| line);
    let centers = header
        .strip_prefix("x,y,")
        .and_then(|rest| rest.split(',').map(|n| n.trim().parse::<f64>().ok()).collect::<Option<Vec<f64>>>())
        .filter(|centers| centers.iter().all(|c| c.is_finite() && *c > 0.0))
        .ok_or_else(|| malformed(1, "expected x,y and the wavelengths of the bands in nm"))?;
    if !centers.windows(2).all(|pair| pair[0] < pair[1]) {
        return Err(malformed(1, "the wavelengths must increase"));
    }
    let mut pixels = Vec::new();
    for (number, line) in lines {
        let mut cells = line.split(',').map(str::trim);
        let mut place = || cells.next()?.parse::<u32>().ok();
        let place = place().zip(place()).ok_or_else(|| malformed(number + 1, "expected the pixel's x,y"))?;
        let values: Option<Vec<f32>> = cells.map(|cell| cell.parse().ok()).collect();
        match values {
            Some(values) if values.len() == centers.len() => pixels.push((place.1, place.0, values)),
            _ => return Err(malformed(number + 1, &format!("expected {} numbers behind x,y", centers.len()))),
        }
    }
    pixels.sort_by_key(|(y, x, _)| (*y, *x));
    let width = pixels.last().map_or(0, |(_, x, _)| *x as usize + 1);
    let in_place =
        |(i, (y, x, _)): (usize, &(u32, u32, Vec<f32>))| *x as usize == i % width && *y as usize == i / width;
    if width == 0 || !pixels.len().is_multiple_of(width) || !pixels.iter().enumerate().all(in_place) {
        return Err(ImageError::Malformed("the pixels do not fill a rectangle, each once".into()));
    }
    let height = pixels.len() / width;
    let radiance: Vec<f32> = pixels.into_iter().flat_map(|(_, _, values)| values).collect();
    spectral::from_bands([width, height], spectral::midpoints(&centers), radiance, None)
}
