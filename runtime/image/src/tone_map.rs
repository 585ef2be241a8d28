//! From radiance to a screen: exposure, gamut, highlights, transfer function.
//!
//! 1. *Exposure.* Automatic: the log-average luminance of the pixels that are not black is mapped to 0.18 (Reinhard et
//!    al. 2002, "Photographic tone reproduction for digital images", equations 1 and 2, with black left out of the
//!    mean instead of the small delta, so that a black background does not brighten the picture). By hand: radiances
//!    are multiplied by 2^EV; at 0 EV an equal-energy radiance of 1 W m^-2 sr^-1 nm^-1 is white.
//! 2. *Gamut.* A colour with a negative component is mixed with the grey of its luminance until none is negative.
//! 3. *Highlights.* Linear up to [`KNEE`], then an exponential shoulder towards 1 with a continuous slope, each
//!    component alone, so that bright colours pale gently.
//! 4. The sRGB transfer function and rounding to 8 bit.

use arsc_spectral::srgb;
use glam::{DMat3, DVec3, Vec3};

use crate::{DisplayImage, ImageError, SpectralImage, UNIT_LUMINANCE};

/// Where highlights begin to roll off.
pub const KNEE: f64 = 0.75;

/// Luminance that the log-average is mapped to.
const KEY: f64 = 0.18;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// From the log-average luminance of the image.
    Auto,
    /// In stops: radiances are multiplied by 2^ev.
    Ev(f64),
}

/// Gives the display image and adds the exposure that was used, in EV, to its metadata. Pixels that are not finite
/// come out black.
pub fn tone_map(image: &SpectralImage, exposure: Exposure) -> Result<DisplayImage, ImageError> {
    image.verify()?;
    let ev = match exposure {
        Exposure::Auto => automatic_ev(&image.xyz),
        Exposure::Ev(ev) => ev,
    };
    let scale = ev.exp2() / UNIT_LUMINANCE;
    let rgb_from_xyz = srgb::rgb_from_xyz();
    let pixel = |&xyz: &[f32; 3]| display_pixel(Vec3::from_array(xyz).as_dvec3() * scale, &rgb_from_xyz);
    let rgb = image.xyz.iter().map(pixel).collect();
    let mut metadata = image.metadata.clone();
    metadata.push(("exposure_ev".into(), format!("{ev:.3}")));
    Ok(DisplayImage { width: image.width, height: image.height, rgb, metadata })
}

/// The EV that brings the log-average luminance to the key; 0 for a black image.
fn automatic_ev(xyz: &[[f32; 3]]) -> f64 {
    let (sum, count) = xyz
        .iter()
        .map(|p| f64::from(p[1]))
        .filter(|y| y.is_finite() && *y > 0.0)
        .fold((0.0, 0u64), |(sum, count), y| (sum + y.log2(), count + 1));
    if count == 0 { 0.0 } else { KEY.log2() - (sum / count as f64 - UNIT_LUMINANCE.log2()) }
}

fn display_pixel(xyz: DVec3, rgb_from_xyz: &DMat3) -> [u8; 3] {
    if !xyz.is_finite() {
        return [0; 3];
    }
    let rgb = into_gamut(*rgb_from_xyz * xyz, xyz.y);
    rgb.to_array().map(|c| (srgb::encode(roll_off(c)) * 255.0).round() as u8)
}

/// Mixes with the grey of the same luminance until no component is negative.
fn into_gamut(rgb: DVec3, luminance: f64) -> DVec3 {
    let least = rgb.min_element();
    if least >= 0.0 {
        return rgb;
    }
    if luminance <= 0.0 {
        return DVec3::ZERO;
    }
    DVec3::splat(luminance).lerp(rgb, luminance / (luminance - least))
}

fn roll_off(x: f64) -> f64 {
    if x <= KNEE { x } else { KNEE + (1.0 - KNEE) * (1.0 - (-(x - KNEE) / (1.0 - KNEE)).exp()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(luminances: &[f64]) -> SpectralImage {
        // D65 white, so that equal components are expected.
        let pixel = |l: &f64| [(l * 0.9505) as f32, *l as f32, (l * 1.0891) as f32];
        SpectralImage {
            width: luminances.len(),
            height: 1,
            band_edges_nm: vec![360.0, 830.0],
            radiance: vec![0.0; luminances.len()],
            stokes: None,
            xyz: luminances.iter().map(pixel).collect(),
            channels: vec![],
            metadata: vec![],
        }
    }

    #[test]
    fn automatic_exposure_maps_the_log_average_to_the_key_and_ignores_black() {
        let image = grey(&[0.0, 1e3, 1e5, 0.0]);
        let shown = tone_map(&image, Exposure::Auto).unwrap();
        // The log-average is 1e4: the two pixels lie a factor ten below and above 0.18.
        let dark = (srgb::encode(0.018) * 255.0).round() as i32;
        assert!((i32::from(shown.rgb[1][1]) - dark).abs() <= 1, "{:?}", shown.rgb);
        assert_eq!(shown.rgb[0], [0, 0, 0]);
        assert!(shown.rgb[2][1] > 240);
        let scaled = tone_map(&grey(&[0.0, 1e6, 1e8, 0.0]), Exposure::Auto).unwrap();
        assert_eq!(scaled.rgb, shown.rgb, "automatic exposure does not depend on the unit");
    }

    #[test]
    fn one_stop_doubles() {
        let image = grey(&[0.1 * UNIT_LUMINANCE]);
        let level = |ev| tone_map(&image, Exposure::Ev(ev)).unwrap().rgb[0][1];
        assert_eq!(level(0.0), (srgb::encode(0.1) * 255.0).round() as u8);
        assert_eq!(level(1.0), (srgb::encode(0.2) * 255.0).round() as u8);
    }

    #[test]
    fn highlights_roll_off_monotonically_and_smoothly() {
        let mut last = 0.0;
        for i in 0..4000 {
            let y = roll_off(f64::from(i) * 1e-3);
            assert!(y > last || i == 0);
            assert!(y - last < 1.001e-3 && y <= 1.0);
            last = y;
        }
    }

    #[test]
    fn colours_outside_the_gamut_keep_their_luminance() {
        let xyz = DVec3::new(0.1, 0.5, 0.1);
        let rgb = into_gamut(srgb::rgb_from_xyz() * xyz, xyz.y);
        assert!((srgb::rgb_from_xyz() * xyz).min_element() < 0.0 && rgb.min_element() > -1e-12);
        assert!(((srgb::xyz_from_rgb() * rgb).y - xyz.y).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_finite_comes_out_black() {
        let mut image = grey(&[1e4, 1e4]);
        image.xyz[0] = [f32::NAN, f32::INFINITY, 0.0];
        assert_eq!(tone_map(&image, Exposure::Ev(0.0)).unwrap().rgb[0], [0, 0, 0]);
    }
}
