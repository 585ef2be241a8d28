//! Cropping and shrinking pictures with everything that they hold.

use arsc_image::{Channel, ColourImage, Picture, SpectralImage};

use crate::ImagingError;

/// Applies `map`, which turns `[pixel][n]` values into those of the new size, to every buffer of a picture.
fn each_buffer(picture: &Picture, size: [usize; 2], map: impl Fn(&[f32], usize) -> Vec<f32>) -> Picture {
    let [width, height] = size;
    let triples = |values: &[[f32; 3]], per_pixel: usize| -> Vec<[f32; 3]> {
        map(values.as_flattened(), 3 * per_pixel).as_chunks().0.to_vec()
    };
    let channel = |c: &Channel| Channel { name: c.name.clone(), samples: map(&c.samples, 1) };
    let channels = |channels: &[Channel]| channels.iter().map(channel).collect();
    match picture {
        Picture::Colour(image) => Picture::Colour(ColourImage {
            width,
            height,
            xyz: triples(&image.xyz, 1),
            channels: channels(&image.channels),
            metadata: image.metadata.clone(),
        }),
        Picture::Spectral(image) => Picture::Spectral(SpectralImage {
            width,
            height,
            band_edges_nm: image.band_edges_nm.clone(),
            radiance: map(&image.radiance, image.bands()),
            stokes: image.stokes.as_ref().map(|stokes| triples(stokes, image.bands())),
            xyz: triples(&image.xyz, 1),
            channels: channels(&image.channels),
            metadata: image.metadata.clone(),
        }),
    }
}

/// The pixels from x0, y0 to x1, y1, the end excluded.
pub fn crop(picture: &Picture, [x0, y0, x1, y1]: [u32; 4]) -> Result<Picture, ImagingError> {
    let (width, height) = (picture.width(), picture.height());
    let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(|n| n as usize);
    if x0 >= x1 || y0 >= y1 || x1 > width || y1 > height {
        let what = format!("the crop {x0},{y0},{x1},{y1} does not lie in the picture of {width}x{height} pixels");
        return Err(ImagingError::Arguments(what));
    }
    Ok(each_buffer(picture, [x1 - x0, y1 - y0], |values, n| {
        (y0..y1).flat_map(|y| &values[(y * width + x0) * n..(y * width + x1) * n]).copied().collect()
    }))
}

/// Means of squares of `factor` times `factor` pixels; at the right and lower edge of what is left of them.
pub fn downscale(picture: &Picture, factor: u32) -> Result<Picture, ImagingError> {
    let factor = factor as usize;
    if factor == 0 {
        return Err(ImagingError::Arguments("a picture cannot be scaled down by 0".into()));
    }
    let (width, height) = (picture.width(), picture.height());
    let size = [width.div_ceil(factor), height.div_ceil(factor)];
    Ok(each_buffer(picture, size, |values, n| {
        let mut means = Vec::with_capacity(size[0] * size[1] * n);
        for (y, x) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (y, x))) {
            let rows = y * factor..((y + 1) * factor).min(height);
            let columns = x * factor..((x + 1) * factor).min(width);
            let count = (rows.len() * columns.len()) as f64;
            for i in 0..n {
                let places = rows.clone().flat_map(|row| columns.clone().map(move |column| row * width + column));
                let sum: f64 = places.map(|pixel| f64::from(values[pixel * n + i])).sum();
                means.push((sum / count) as f32);
            }
        }
        means
    }))
}

/// Every radiance and colour times a factor; further channels stay.
pub fn scaled(picture: &Picture, factor: f64) -> Result<Picture, ImagingError> {
    if !factor.is_finite() || factor < 0.0 {
        return Err(ImagingError::Arguments(format!("a picture cannot be multiplied by {factor}")));
    }
    let times = |values: &mut [f32]| values.iter_mut().for_each(|v| *v = (f64::from(*v) * factor) as f32);
    let mut picture = picture.clone();
    match &mut picture {
        Picture::Colour(image) => times(image.xyz.as_flattened_mut()),
        Picture::Spectral(image) => {
            times(&mut image.radiance);
            times(image.xyz.as_flattened_mut());
            image.stokes.iter_mut().for_each(|stokes| times(stokes.as_flattened_mut()));
        }
    }
    Ok(picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        let (width, height, bands) = (5, 3, 2);
        let stokes = (0..width * height * bands).map(|i| [i as f32, 1.0, -1.0]).collect();
        Picture::Spectral(SpectralImage {
            width,
            height,
            band_edges_nm: vec![400.0, 500.0, 700.0],
            radiance: (0..width * height * bands).map(|i| i as f32).collect(),
            stokes: Some(stokes),
            xyz: (0..width * height).map(|i| [i as f32, 1.0, 2.0]).collect(),
            channels: vec![Channel { name: "depth.Z".into(), samples: (0..15).map(|i| i as f32).collect() }],
            metadata: vec![],
        })
    }

    #[test]
    fn a_crop_takes_everything_along() {
        let Picture::Spectral(image) = crop(&picture(), [1, 1, 3, 3]).unwrap() else { panic!() };
        image.verify().unwrap();
        assert_eq!((image.width, image.height), (2, 2));
        assert_eq!(image.channels[0].samples, [6.0, 7.0, 11.0, 12.0]);
        assert_eq!(image.radiance, [12.0, 13.0, 14.0, 15.0, 22.0, 23.0, 24.0, 25.0]);
        assert_eq!(image.stokes.unwrap()[5], [23.0, 1.0, -1.0]);
        for outside in [[0, 0, 6, 1], [0, 0, 0, 1], [3, 0, 2, 1], [0, 0, 1, 4]] {
            assert!(crop(&picture(), outside).is_err());
        }
    }

    #[test]
    fn shrinking_keeps_means() {
        let Picture::Spectral(image) = downscale(&picture(), 2).unwrap() else { panic!() };
        image.verify().unwrap();
        assert_eq!((image.width, image.height), (3, 2));
        assert_eq!(image.channels[0].samples, [3.0, 5.0, 6.5, 10.5, 12.5, 14.0]);
        assert_eq!(downscale(&picture(), 1).unwrap(), picture());
        assert!(downscale(&picture(), 0).is_err());
        assert_eq!(downscale(&picture(), u32::MAX).unwrap().width(), 1);
    }

    #[test]
    fn scaling_reaches_every_radiance() {
        let Picture::Spectral(image) = scaled(&picture(), 2.0).unwrap() else { panic!() };
        assert_eq!(
            (image.radiance[3], image.stokes.unwrap()[3], image.xyz[2]),
            (6.0, [6.0, 2.0, -2.0], [4.0, 2.0, 4.0])
        );
        assert_eq!(image.channels[0].samples[2], 2.0);
        assert!(scaled(&picture(), f64::NAN).is_err());
    }
}
