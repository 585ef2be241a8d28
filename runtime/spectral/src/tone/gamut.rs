//! Bringing colours into the gamut of a display.

use glam::{DMat3, DVec3};

use crate::colour::{lab_from_xyz, xyz_from_lab};
use crate::colour_space::{D65_WHITE, xyz_of_chromaticity};

/// What becomes of a colour that the display's primaries cannot mix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Gamut {
    /// Mixed with the grey of its luminance until no component is negative.
    #[default]
    Desaturate,
    /// Chroma in CIE L*a*b* is reduced at constant lightness and hue angle until the components fit.
    Lab,
    /// Components that do not fit are cut off: changes hue and luminance.
    Clip,
}

impl Gamut {
    pub const ALL: [Gamut; 3] = [Gamut::Desaturate, Gamut::Lab, Gamut::Clip];

    /// As it is written in scripts and arguments.
    pub const fn name(self) -> &'static str {
        match self {
            Gamut::Desaturate => "desaturate",
            Gamut::Lab => "lab",
            Gamut::Clip => "clip",
        }
    }

    /// Components of `xyz`, none negative; with [`Gamut::Lab`] none above `most` either, if the grey of that
    /// luminance fits.
    pub(super) fn into(self, rgb_from_xyz: &DMat3, xyz: DVec3, most: f64) -> DVec3 {
        let rgb = *rgb_from_xyz * xyz;
        match self {
            Gamut::Clip => rgb.max(DVec3::ZERO),
            Gamut::Desaturate => desaturated(rgb, xyz.y),
            Gamut::Lab => less_chroma(rgb_from_xyz, rgb, xyz, most),
        }
    }
}

fn desaturated(rgb: DVec3, luminance: f64) -> DVec3 {
    let least = rgb.min_element();
    if least >= 0.0 {
        return rgb;
    }
    if luminance <= 0.0 {
        return DVec3::ZERO;
    }
    DVec3::splat(luminance).lerp(rgb, luminance / (luminance - least))
}

/// Halvings of the interval of chroma: finer than 16 bit.
const HALVINGS: u32 = 24;

fn less_chroma(rgb_from_xyz: &DMat3, rgb: DVec3, xyz: DVec3, most: f64) -> DVec3 {
    if xyz.y <= 0.0 {
        return DVec3::ZERO;
    }
    let most = if xyz.y < most { most } else { f64::INFINITY };
    let fits = |rgb: DVec3| rgb.min_element() >= 0.0 && rgb.max_element() <= most;
    if fits(rgb) {
        return rgb;
    }
    let white = xyz_of_chromaticity(D65_WHITE).to_array();
    let [l, a, b] = lab_from_xyz(xyz.to_array(), white);
    let at = |chroma: f64| *rgb_from_xyz * DVec3::from_array(xyz_from_lab([l, a * chroma, b * chroma], white));
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if fits(at(middle)) { low = middle } else { high = middle }
    }
    at(low).max(DVec3::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::srgb;

    #[test]
    fn colours_outside_keep_their_luminance() {
        let (xyz, rgb_from_xyz) = (DVec3::new(0.1, 0.5, 0.1), srgb::rgb_from_xyz());
        assert!((rgb_from_xyz * xyz).min_element() < 0.0);
        for gamut in [Gamut::Desaturate, Gamut::Lab] {
            let rgb = gamut.into(&rgb_from_xyz, xyz, 1.0);
            assert!(rgb.min_element() > -1e-12 && rgb.max_element() <= 1.0, "{}: {rgb}", gamut.name());
            assert!(((srgb::xyz_from_rgb() * rgb).y - xyz.y).abs() < 1e-9, "{}", gamut.name());
        }
        assert!(Gamut::Clip.into(&rgb_from_xyz, xyz, 1.0).min_element() == 0.0);
    }

    #[test]
    fn less_chroma_keeps_the_hue_angle() {
        let white = xyz_of_chromaticity(D65_WHITE).to_array();
        let xyz = DVec3::from_array(xyz_from_lab([50.0, -120.0, 40.0], white));
        let inside = srgb::xyz_from_rgb() * Gamut::Lab.into(&srgb::rgb_from_xyz(), xyz, 1.0);
        let [l, a, b] = lab_from_xyz(inside.to_array(), white);
        assert!((l - 50.0).abs() < 1e-6 && (b / a - 40.0 / -120.0).abs() < 1e-6 && a < -20.0, "{l} {a} {b}");
    }

    #[test]
    fn colours_inside_stay() {
        let xyz = srgb::xyz_from_rgb() * DVec3::new(0.2, 0.9, 0.4);
        for gamut in Gamut::ALL {
            assert!(gamut.into(&srgb::rgb_from_xyz(), xyz, 1.0).abs_diff_eq(DVec3::new(0.2, 0.9, 0.4), 1e-12));
        }
    }
}
