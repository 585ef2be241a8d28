//! Sums and means of pictures.

use arsc_image::Picture;

use crate::ImagingError;

/// Radiances and colours of two pictures of one size and the same bands, added; further channels are those of `a`.
pub fn add(a: &Picture, b: &Picture) -> Result<Picture, ImagingError> {
    sum(&[(a, 1.0), (b, 1.0)])
}

/// The mean of renders of one scene, each weighted by its samples per pixel. With equal weights where none is known, or with
/// those given. Further channels are averaged alike; the metadata are those of the first, with the sum of the samples.
pub fn merge(pictures: &[Picture], weights: Option<&[f64]>) -> Result<Picture, ImagingError> {
    let refuse = |what: &str| Err(ImagingError::Arguments(what.into()));
    let samples: Option<Vec<f64>> = pictures.iter().map(samples).collect();
    let weights = match weights {
        Some(weights) if weights.len() != pictures.len() => return refuse("there must be one weight for each picture"),
        Some(weights) => weights.to_vec(),
        None => samples.clone().unwrap_or_else(|| vec![1.0; pictures.len()]),
    };
    let total: f64 = weights.iter().sum();
    if !weights.iter().all(|w| w.is_finite() && *w >= 0.0) || total <= 0.0 || !total.is_finite() {
        return refuse("weights must be finite, at least 0, and not all 0");
    }
    let parts: Vec<_> = pictures.iter().zip(&weights).map(|(picture, weight)| (picture, weight / total)).collect();
    let mut merged = sum(&parts)?;
    merge_channels(&mut merged, &parts)?;
    if let Some(samples) = samples {
        let metadata = merged.metadata_mut();
        metadata.retain(|(name, _)| !["samples", "seed", "renderSeconds", "buildSeconds"].contains(&name.as_str()));
        metadata.push(("samples".into(), samples.iter().sum::<f64>().to_string()));
    }
    Ok(merged)
}

/// Samples per pixel as a render notes them; of a range, the fewest.
fn samples(picture: &Picture) -> Option<f64> {
    picture.noted("samples")?.split_whitespace().next()?.parse().ok().filter(|n: &f64| n.is_finite() && *n >= 0.0)
}

/// In the order of the pictures, in double precision.
fn sum(parts: &[(&Picture, f64)]) -> Result<Picture, ImagingError> {
    let Some(((first, _), rest)) = parts.split_first() else {
        return Err(ImagingError::Arguments("there is no picture to add".into()));
    };
    for (other, _) in rest {
        check_alike(first, other)?;
    }
    let mut result = (*first).clone();
    let xyz: Vec<_> = parts.iter().map(|(picture, weight)| (picture.xyz().as_flattened(), *weight)).collect();
    let xyz = weighted(&xyz).as_chunks().0.to_vec();
    match &mut result {
        Picture::Colour(image) => image.xyz = xyz,
        Picture::Spectral(image) => {
            image.xyz = xyz;
            let spectra: Vec<_> = parts.iter().filter_map(|(p, w)| Some((spectrum(p)?, *w))).collect();
            let radiance: Vec<_> = spectra.iter().map(|(image, w)| (image.radiance.as_slice(), *w)).collect();
            image.radiance = weighted(&radiance);
            let stokes: Vec<_> =
                spectra.iter().filter_map(|(image, w)| Some((image.stokes.as_ref()?.as_flattened(), *w))).collect();
            if let Some(sum) = &mut image.stokes {
                *sum = weighted(&stokes).as_chunks().0.to_vec();
            }
        }
    }
    Ok(result)
}

fn spectrum(picture: &Picture) -> Option<&arsc_image::SpectralImage> {
    match picture {
        Picture::Spectral(image) => Some(image),
        Picture::Colour(_) => None,
    }
}

fn weighted(parts: &[(&[f32], f64)]) -> Vec<f32> {
    let length = parts.first().map_or(0, |(values, _)| values.len());
    let at = |i: usize| parts.iter().map(|(values, weight)| f64::from(values[i]) * weight).sum::<f64>() as f32;
    (0..length).map(at).collect()
}

fn merge_channels(merged: &mut Picture, parts: &[(&Picture, f64)]) -> Result<(), ImagingError> {
    let channels = match merged {
        Picture::Colour(image) => &mut image.channels,
        Picture::Spectral(image) => &mut image.channels,
    };
    for (i, channel) in channels.iter_mut().enumerate() {
        let same: Option<Vec<_>> = parts
            .iter()
            .map(|(picture, weight)| {
                let other = picture.channels().get(i).filter(|other| other.name == channel.name)?;
                Some((other.samples.as_slice(), *weight))
            })
            .collect();
        channel.samples = weighted(&same.ok_or(ImagingError::Channels)?);
    }
    Ok(())
}

/// That two pictures have one size, the same bands, and are both polarised or not.
pub(crate) fn check_alike(a: &Picture, b: &Picture) -> Result<(), ImagingError> {
    let size = |picture: &Picture| [picture.width(), picture.height()];
    if size(a) != size(b) {
        return Err(ImagingError::Sizes(size(a), size(b)));
    }
    match (a, b) {
        (Picture::Colour(_), Picture::Colour(_)) => Ok(()),
        (Picture::Spectral(a), Picture::Spectral(b))
            if a.band_edges_nm == b.band_edges_nm && a.stokes.is_some() == b.stokes.is_some() =>
        {
            Ok(())
        }
        _ => Err(ImagingError::Bands),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arsc_image::{Channel, ColourImage, SpectralImage};

    fn picture(radiance: f32, samples: &str) -> Picture {
        Picture::Spectral(SpectralImage {
            width: 2,
            height: 1,
            band_edges_nm: vec![400.0, 700.0],
            radiance: vec![radiance; 2],
            stokes: Some(vec![[radiance, 0.0, -radiance]; 2]),
            xyz: vec![[radiance; 3]; 2],
            channels: vec![Channel { name: "a.X".into(), samples: vec![radiance; 2] }],
            metadata: vec![("samples".into(), samples.into()), ("seed".into(), "1".into())],
        })
    }

    #[test]
    fn renders_are_merged_by_their_samples() {
        let merged = merge(&[picture(1.0, "16"), picture(5.0, "48")], None).unwrap();
        let Picture::Spectral(image) = &merged else { panic!() };
        assert_eq!((image.radiance[0], image.xyz[1], image.channels[0].samples[0]), (4.0, [4.0; 3], 4.0));
        assert_eq!(image.stokes.as_ref().unwrap()[0], [4.0, 0.0, -4.0]);
        assert_eq!((merged.noted("samples"), merged.noted("seed")), (Some("64"), None));
        let Picture::Spectral(equal) = merge(&[picture(1.0, "?"), picture(5.0, "48")], None).unwrap() else { panic!() };
        assert_eq!(equal.radiance[0], 3.0);
        let given = merge(&[picture(1.0, "16"), picture(5.0, "48")], Some(&[1.0, 0.0])).unwrap();
        assert_eq!(given.xyz()[0], [1.0; 3]);
    }

    #[test]
    fn sums_add() {
        let Picture::Spectral(image) = add(&picture(1.0, "1"), &picture(2.0, "1")).unwrap() else { panic!() };
        assert_eq!((image.radiance[0], image.xyz[0], image.stokes.unwrap()[1]), (3.0, [3.0; 3], [3.0, 0.0, -3.0]));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let colour = Picture::Colour(ColourImage {
            width: 2,
            height: 1,
            xyz: vec![[0.0; 3]; 2],
            channels: vec![],
            metadata: vec![],
        });
        assert!(matches!(add(&picture(1.0, "1"), &colour), Err(ImagingError::Bands)));
        let small = crate::reshape::crop(&colour, [0, 0, 1, 1]).unwrap();
        assert!(matches!(add(&colour, &small), Err(ImagingError::Sizes([2, 1], [1, 1]))));
        assert!(merge(&[], None).is_err());
        for weights in [&[1.0][..], &[0.0, 0.0], &[-1.0, 2.0], &[f64::NAN, 1.0]] {
            assert!(merge(&[colour.clone(), colour.clone()], Some(weights)).is_err());
        }
    }
}
