//! A linear polariser in front of a picture.
//!
//! Its Mueller matrix for the transmission axis at the angle θ from the picture's x towards y (Collett 2005, "Field guide to
//! polarization", page 13), mixed with the identity: at strength 0 there is no filter, at 1 an ideal one. Unpolarised
//! pictures are treated as unpolarised light: they lose half at full strength.

use arsc_image::{Picture, SpectralImage, xyz_of_bands};
use arsc_spectral::Observer;

use crate::ImagingError;

/// The picture behind the filter. X, Y, Z change by the ratio that the bands give, so that what the filter does not
/// touch stays to the bit.
pub fn linear_polariser(picture: &Picture, angle: f64, strength: f64) -> Result<Picture, ImagingError> {
    if !angle.is_finite() || !(0.0..=1.0).contains(&strength) {
        return Err(ImagingError::Arguments("a polariser has an angle and a strength from 0 to 1".into()));
    }
    let Picture::Spectral(image) = picture else { return Err(ImagingError::NoSpectrum) };
    let mut image = image.clone();
    let observer = observer(&image);
    let before = xyz_of_bands(&image.radiance, &image.band_edges_nm, observer);
    let (sin, cos) = (2.0 * angle).sin_cos();
    let unpolarised = vec![[0.0; 3]; if image.stokes.is_none() { image.radiance.len() } else { 0 }];
    for (s0, stokes) in image.radiance.iter_mut().zip(image.stokes.as_ref().unwrap_or(&unpolarised)) {
        let behind = 0.5 * (f64::from(*s0) + cos * f64::from(stokes[0]) + sin * f64::from(stokes[1]));
        *s0 = mixed(*s0, behind, strength);
    }
    // The same light again: what the filter let through of S0 decides S1 and S2.
    if let (Some(stokes), Picture::Spectral(whole)) = (&mut image.stokes, picture) {
        for (stokes, s0) in stokes.iter_mut().zip(&whole.radiance) {
            let behind = 0.5 * (f64::from(*s0) + cos * f64::from(stokes[0]) + sin * f64::from(stokes[1]));
            let filtered = [behind * cos, behind * sin, 0.0];
            *stokes = std::array::from_fn(|i| mixed(stokes[i], filtered[i], strength));
        }
    }
    let after = xyz_of_bands(&image.radiance, &image.band_edges_nm, observer);
    for ((xyz, before), after) in image.xyz.iter_mut().zip(before).zip(after) {
        *xyz = std::array::from_fn(|c| if before[c] > 0.0 { xyz[c] * (after[c] / before[c]) } else { after[c] });
    }
    image.metadata.push(("polariser".into(), format!("{:.3}deg, {strength}", angle.to_degrees())));
    Ok(Picture::Spectral(image))
}

fn mixed(without: f32, with: f64, strength: f64) -> f32 {
    (f64::from(without) * (1.0 - strength) + with * strength) as f32
}

/// Whose X, Y and Z the picture holds.
fn observer(image: &SpectralImage) -> Observer {
    let noted = image.metadata.iter().find(|(name, _)| name == "observer").map(|(_, value)| value.as_str());
    Observer::ALL.into_iter().find(|observer| Some(observer.name()) == noted).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn picture(stokes: Option<[f32; 3]>) -> Picture {
        Picture::Spectral(SpectralImage {
            width: 1,
            height: 1,
            band_edges_nm: vec![500.0, 600.0],
            radiance: vec![2.0],
            stokes: stokes.map(|s| vec![s]),
            xyz: vec![[10.0, 20.0, 30.0]],
            channels: vec![],
            metadata: vec![],
        })
    }

    fn behind(stokes: Option<[f32; 3]>, degrees: f64, strength: f64) -> (f32, [f32; 3]) {
        let Ok(Picture::Spectral(image)) = linear_polariser(&picture(stokes), degrees.to_radians(), strength) else {
            panic!()
        };
        (image.radiance[0], image.xyz[0])
    }

    /// Malus' law.
    #[test]
    fn polarised_light_fades_with_the_angle() {
        for degrees in [0.0, 30.0, 45.0, 90.0, 135.0] {
            let (s0, xyz) = behind(Some([2.0, 0.0, 0.0]), degrees, 1.0);
            let share = (degrees * PI / 180.0).cos().powi(2);
            assert!((f64::from(s0) / 2.0 - share).abs() < 1e-6, "{degrees} deg: {s0}");
            assert!((f64::from(xyz[1]) / 20.0 - share).abs() < 1e-5);
        }
        assert!((behind(Some([0.0, 2.0, 0.0]), 45.0, 1.0).0 - 2.0).abs() < 1e-6);
        assert!((behind(Some([0.0, 0.0, 2.0]), 10.0, 1.0).0 - 1.0).abs() < 1e-6, "circular light loses half");
    }

    #[test]
    fn without_strength_nothing_changes_and_unpolarised_light_loses_half() {
        assert_eq!(behind(Some([1.0, 0.5, 0.2]), 33.0, 0.0), (2.0, [10.0, 20.0, 30.0]));
        assert_eq!(behind(None, 33.0, 1.0).0, 1.0);
        assert_eq!(behind(None, 33.0, 0.5).0, 1.5);
    }

    #[test]
    fn crossed_polarisers_let_nothing_through() {
        let once = linear_polariser(&picture(Some([0.3, 0.4, 0.5])), 0.3, 1.0).unwrap();
        let Picture::Spectral(twice) = linear_polariser(&once, 0.3 + PI / 2.0, 1.0).unwrap() else { panic!() };
        assert!(twice.radiance[0].abs() < 1e-6 && twice.xyz[0][1].abs() < 1e-5);
    }

    #[test]
    fn nonsense_is_refused() {
        for (angle, strength) in [(f64::NAN, 1.0), (0.0, 1.1), (0.0, -0.1), (0.0, f64::NAN)] {
            assert!(linear_polariser(&picture(None), angle, strength).is_err());
        }
    }
}
