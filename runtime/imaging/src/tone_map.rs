//! Tone mapping of whole pictures; what happens to a colour is `arsc_spectral::tone`'s matter.

use arsc_image::{DisplayImage, Picture, UNIT_LUMINANCE};
use arsc_spectral::tone::{Display, Luminances, ToneMap};
use glam::DVec3;

/// Luminances relative to [`UNIT_LUMINANCE`], for exposure.
pub fn luminances(xyz: &[[f32; 3]]) -> Luminances {
    Luminances::new(xyz.iter().map(|p| f64::from(p[1]) / UNIT_LUMINANCE))
}

/// Whether a display shows the picture as it is: no spectrum, and nowhere brighter than its white.
pub fn is_display(picture: &Picture) -> bool {
    // Rounding of the white.
    let white = (UNIT_LUMINANCE * 1.001) as f32;
    matches!(picture, Picture::Colour(_)) && picture.xyz().iter().all(|xyz| xyz[1] <= white)
}

/// Gives the display image and adds the exposure that was used, in EV, to its metadata. Pixels that are not finite
/// come out black.
pub fn tone_map(picture: &Picture, wanted: &ToneMap) -> DisplayImage {
    tone_map_colours([picture.width(), picture.height()], picture.xyz(), picture.metadata(), wanted)
}

/// The same of colours with Y in cd m^-2.
pub fn tone_map_colours(
    [width, height]: [usize; 2],
    xyz: &[[f32; 3]],
    metadata: &[(String, String)],
    wanted: &ToneMap,
) -> DisplayImage {
    let display = Display::new(wanted, &luminances(xyz));
    let rgb = xyz.iter().map(|&xyz| coded(&display, xyz)).collect();
    let mut metadata = metadata.to_vec();
    metadata.retain(|(name, _)| name != "exposure_ev");
    metadata.push(("exposure_ev".into(), format!("{:.3}", display.ev())));
    DisplayImage { width, height, space: wanted.space, rgb, metadata }
}

/// Coded components of an absolute colour.
pub(crate) fn coded(display: &Display, xyz: [f32; 3]) -> [f32; 3] {
    display.coded(DVec3::from_array(xyz.map(|c| f64::from(c) / UNIT_LUMINANCE))).as_vec3().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use arsc_image::ColourImage;
    use arsc_spectral::srgb;
    use arsc_spectral::tone::Exposure;

    fn grey(luminances: &[f64]) -> Picture {
        // D65 white, so that equal components are expected.
        let pixel = |l: &f64| [(l * 0.9505) as f32, *l as f32, (l * 1.0891) as f32];
        Picture::Colour(ColourImage {
            width: luminances.len(),
            height: 1,
            xyz: luminances.iter().map(pixel).collect(),
            channels: vec![],
            metadata: vec![],
        })
    }

    #[test]
    fn automatic_exposure_maps_the_log_average_to_the_key_and_ignores_black() {
        let shown = tone_map(&grey(&[0.0, 1e3, 1e5, 0.0]), &ToneMap::default());
        // The log-average is 1e4: the two pixels lie a factor ten below and above 0.18.
        assert!((f64::from(shown.rgb[1][1]) - srgb::encode(0.018)).abs() < 1e-4, "{:?}", shown.rgb);
        assert_eq!(shown.rgb[0], [0.0; 3]);
        assert!(shown.rgb[2][1] > 0.94);
        let scaled = tone_map(&grey(&[0.0, 1e6, 1e8, 0.0]), &ToneMap::default());
        assert_eq!(scaled.bytes(), shown.bytes(), "automatic exposure does not depend on the unit");
    }

    #[test]
    fn the_exposure_is_noted_once() {
        let wanted = ToneMap { exposure: Exposure::Ev(1.5), ..ToneMap::default() };
        let shown = tone_map(&grey(&[1e4]), &wanted);
        assert_eq!(shown.metadata, [("exposure_ev".to_owned(), "1.500".to_owned())]);
        assert!((f64::from(shown.rgb[0][0]) / f64::from(shown.rgb[0][1]) - 1.0).abs() < 1e-3);
    }
}
