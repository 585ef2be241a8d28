//! Denoising of everything that a picture holds by a filter of three channels.
//!
//! The filter is a parameter: it sees light that is never negative. X, Y and Z go through it together; bands go in
//! threes from the short, the middle and the long third of the spectrum, so that the three differ as the primaries do that
//! such filters were trained on. Polarised light is split into what ideal analysers pass, (S0 + Si) / 2 and (S0 - Si) / 2,
//! which is never negative either; their difference is Si. Pixels that are not finite enter as black.

use arsc_image::{Picture, SpectralImage};

type Triple = [f32; 3];

/// The picture with every buffer filtered. Further channels stay.
pub fn denoised<E>(
    picture: &Picture,
    mut filter: impl FnMut(&[Triple]) -> Result<Vec<Triple>, E>,
) -> Result<Picture, E> {
    let mut clean = |pixels: Vec<Triple>| -> Result<Vec<Triple>, E> { filter(&pixels) };
    let mut picture = picture.clone();
    match &mut picture {
        Picture::Colour(image) => image.xyz = clean(image.xyz.iter().map(|xyz| xyz.map(light)).collect())?,
        Picture::Spectral(image) => {
            image.xyz = clean(image.xyz.iter().map(|xyz| xyz.map(light)).collect())?;
            bands(image, &mut clean)?;
        }
    }
    picture.metadata_mut().push(("denoised".into(), "true".into()));
    Ok(picture)
}

/// Albedo and normals of a picture, where it has them: `albedo.R`, `.G`, `.B` and `normal.X`, `.Y`, `.Z`.
pub fn features(picture: &Picture) -> (Option<Vec<Triple>>, Option<Vec<Triple>>) {
    let three = |names: [&str; 3]| -> Option<Vec<Triple>> {
        let named = |name: &str| picture.channels().iter().find(|c| c.name == name).map(|c| c.samples.as_slice());
        let [Some(a), Some(b), Some(c)] = names.map(named) else { return None };
        let finite = |value: f32| if value.is_finite() { value } else { 0.0 };
        Some((0..a.len()).map(|i| [finite(a[i]), finite(b[i]), finite(c[i])]).collect())
    };
    (three(["albedo.R", "albedo.G", "albedo.B"]), three(["normal.X", "normal.Y", "normal.Z"]))
}

fn light(value: f32) -> f32 {
    if value.is_finite() { value.max(0.0) } else { 0.0 }
}

fn bands<E>(image: &mut SpectralImage, clean: &mut impl FnMut(Vec<Triple>) -> Result<Vec<Triple>, E>) -> Result<(), E> {
    let count = image.bands();
    let third = count.div_ceil(3);
    for first in 0..third {
        // Where the thirds are not even, the first band stands in for the missing one.
        let wanted = [first, first + third, first + 2 * third];
        let three = wanted.map(|band| if band < count { band } else { first });
        let slots = || wanted.into_iter().enumerate().filter(|(_, band)| *band < count);
        let noisy = image.radiance.chunks_exact(count).map(|bands| three.map(|band| light(bands[band]))).collect();
        let filtered = clean(noisy)?;
        if let Some(stokes) = &mut image.stokes {
            for parameter in 0..3 {
                let mut analysed = |sign: f32| {
                    let pixels = image.radiance.chunks_exact(count).zip(stokes.chunks_exact(count));
                    let part = |s0: f32, s: f32| light(0.5 * (s0 + sign * s));
                    clean(pixels.map(|(s0, s)| three.map(|band| part(s0[band], s[band][parameter]))).collect())
                };
                let (plus, minus) = (analysed(1.0)?, analysed(-1.0)?);
                for (i, stokes) in stokes.chunks_exact_mut(count).enumerate() {
                    for (k, band) in slots() {
                        stokes[band][parameter] = plus[i][k] - minus[i][k];
                    }
                }
            }
        }
        for (bands, filtered) in image.radiance.chunks_exact_mut(count).zip(filtered) {
            for (k, band) in slots() {
                bands[band] = filtered[k];
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn picture(bands: usize) -> Picture {
        let n = 4 * bands;
        Picture::Spectral(SpectralImage {
            width: 2,
            height: 2,
            band_edges_nm: (0..=bands).map(|i| 400.0 + i as f64).collect(),
            radiance: (0..n).map(|i| 1.0 + i as f32).collect(),
            stokes: Some((0..n).map(|i| [0.5 * i as f32, -0.25 * i as f32, 0.0]).collect()),
            xyz: vec![[1.0, 2.0, 3.0]; 4],
            channels: vec![],
            metadata: vec![],
        })
    }

    /// A filter that does nothing changes nothing, whatever the number of bands; one that doubles doubles.
    #[test]
    fn every_band_goes_through_the_filter_once() {
        for bands in [1, 2, 3, 4, 47] {
            let same = denoised(&picture(bands), |p| Ok::<_, Infallible>(p.to_vec())).unwrap();
            let (Picture::Spectral(same), Picture::Spectral(was)) = (same, picture(bands)) else { panic!() };
            assert_eq!((same.radiance, same.xyz), (was.radiance.clone(), was.xyz));
            for (a, b) in same.stokes.unwrap().iter().flatten().zip(was.stokes.unwrap().iter().flatten()) {
                assert!((a - b).abs() < 1e-3, "{bands} bands: {a} and {b}");
            }
            let twice = |p: &[Triple]| Ok::<_, Infallible>(p.iter().map(|p| p.map(|v| 2.0 * v)).collect());
            let Picture::Spectral(twice) = denoised(&picture(bands), twice).unwrap() else { panic!() };
            assert!(twice.radiance.iter().zip(&was.radiance).all(|(a, b)| *a == 2.0 * b), "{bands} bands");
        }
    }

    #[test]
    fn the_filter_never_sees_what_is_not_light() {
        let Picture::Spectral(mut image) = picture(4) else { panic!() };
        image.radiance[3] = f32::NAN;
        image.xyz[1] = [-1.0, f32::INFINITY, 2.0];
        let seen = |pixels: &[Triple]| {
            assert!(pixels.iter().flatten().all(|v| *v >= 0.0 && v.is_finite()));
            Ok::<_, Infallible>(pixels.to_vec())
        };
        denoised(&Picture::Spectral(image), seen).unwrap();
    }
}
