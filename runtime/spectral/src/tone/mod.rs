//! From light to a display, one colour at a time: exposure, white balance, highlights, gamut, transfer function.
//!
//! [`ToneMap`] says what is wanted; [`Display`] does it for XYZ relative to [`crate::Y_INTEGRAL_NM`] times
//! [`crate::LUMINOUS_EFFICACY`], so that the equal-energy radiance 1 W m^-2 sr^-1 nm^-1 has Y = 1. The order:
//!
//! 1. *Exposure.* A factor, found from the picture's [`Luminances`] or given.
//! 2. *White balance.* Chromatic adaptation from the scene's white to the display's.
//! 3. *Calibration* ([`Curve::Calibrated`]) and the *clip towards white* in L*a*b*, both optional.
//! 4. *Gamut* ([`Gamut`]): no component of the display's space is negative afterwards.
//! 5. *Highlights* ([`Curve`]) per component, and a clip to [0, 1].
//! 6. The transfer function of the [`ColourSpace`].
//!
//! Colours that are not finite come out black.

mod curve;
mod exposure;
mod gamut;

use glam::{DMat3, DVec3};

use crate::adaptation::Adaptation;
use crate::colour_space::{ColourSpace, D65_WHITE, Transfer, xyz_of_chromaticity};

pub use curve::{Calibration, Curve, KNEE};
pub use exposure::{Exposure, KEY, Luminances};
pub use gamut::Gamut;

/// What is wanted of a display picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToneMap {
    pub exposure: Exposure,
    /// Chromaticity of the light that shall look white; `None` leaves colours as they are.
    pub white: Option<[f64; 2]>,
    pub adaptation: Adaptation,
    pub curve: Curve,
    /// L* from which on a colour is white; colours between L* = 100 and this pale. At least 100.
    pub white_lightness: Option<f64>,
    pub gamut: Gamut,
    pub space: ColourSpace,
}

/// L* of the clip towards white when none is given, as in ART.
pub const WHITE_LIGHTNESS: f64 = 150.0;

/// A [`ToneMap`] made ready for one picture.
#[derive(Clone, Debug)]
pub struct Display {
    curve: curve::Ready,
    white_lightness: Option<f64>,
    gamut: Gamut,
    /// Exposure and white balance.
    exposed_from_xyz: DMat3,
    rgb_from_xyz: DMat3,
    transfer: Transfer,
    ev: f64,
}

impl Display {
    pub fn new(wanted: &ToneMap, luminances: &Luminances) -> Display {
        let ev = wanted.exposure.ev(luminances);
        let balance = wanted.white.map_or(DMat3::IDENTITY, |white| wanted.adaptation.matrix(white, D65_WHITE));
        Display {
            curve: curve::Ready::new(wanted.curve, luminances.log_average() * ev.exp2(), wanted.space),
            white_lightness: wanted.white_lightness,
            gamut: wanted.gamut,
            exposed_from_xyz: balance * ev.exp2(),
            rgb_from_xyz: wanted.space.rgb_from_xyz(),
            transfer: wanted.space.transfer(),
            ev,
        }
    }

    /// The exposure in stops.
    pub fn ev(&self) -> f64 {
        self.ev
    }

    /// Coded components in [0, 1] of a relative colour.
    pub fn coded(&self, xyz: DVec3) -> DVec3 {
        let mut xyz = self.curve.calibrated(self.exposed_from_xyz * xyz);
        if !xyz.is_finite() {
            return DVec3::ZERO;
        }
        if let Some(lightness) = self.white_lightness {
            xyz = paled(xyz, lightness);
        }
        let most = if self.curve.is_linear() { 1.0 } else { f64::INFINITY };
        let linear = self.curve.components(self.gamut.into(&self.rgb_from_xyz, xyz, most));
        let coded = |c: f64| self.transfer.encode(c.clamp(0.0, 1.0)).clamp(0.0, 1.0);
        DVec3::new(coded(linear.x), coded(linear.y), coded(linear.z))
    }
}

/// Colours lighter than the display's white are brought to L* = 100; the lighter, the paler, until at `white` nothing
/// of the colour is left (ART's luminance clipping, from its description).
fn paled(xyz: DVec3, white: f64) -> DVec3 {
    let reference = xyz_of_chromaticity(D65_WHITE).to_array();
    let [l, a, b] = crate::colour::lab_from_xyz(xyz.to_array(), reference);
    if l <= 100.0 {
        return xyz;
    }
    let left = if l < white { (white - l) / (white - 100.0) } else { 0.0 };
    DVec3::from_array(crate::colour::xyz_from_lab([100.0, a * left, b * left], reference))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{chromaticity, srgb};

    fn grey(y: f64) -> DVec3 {
        xyz_of_chromaticity(D65_WHITE) * y
    }

    fn display(wanted: ToneMap, luminances: &[f64]) -> Display {
        Display::new(&wanted, &Luminances::new(luminances.iter().copied()))
    }

    #[test]
    fn one_stop_doubles_and_what_is_not_finite_is_black() {
        let level = |ev| display(ToneMap { exposure: Exposure::Ev(ev), ..ToneMap::default() }, &[]).coded(grey(0.1)).y;
        assert!((level(0.0) - srgb::encode(0.1)).abs() < 1e-7 && (level(1.0) - srgb::encode(0.2)).abs() < 1e-7);
        for curve in Curve::EXAMPLES {
            let display = display(ToneMap { curve, ..ToneMap::default() }, &[0.1, 1.0]);
            assert_eq!(display.coded(DVec3::new(f64::NAN, 1.0, f64::INFINITY)), DVec3::ZERO);
            assert_eq!(display.coded(DVec3::splat(f64::INFINITY)), DVec3::ZERO);
        }
    }

    /// Greys stay grey and in order, whatever the curve, the space and the gamut mapping.
    #[test]
    fn greys_stay_grey_and_monotone() {
        for (curve, space, gamut) in Curve::EXAMPLES
            .iter()
            .flat_map(|c| ColourSpace::ALL.map(|s| (*c, s)))
            .flat_map(|(c, s)| Gamut::ALL.map(|g| (c, s, g)))
        {
            let display = display(ToneMap { curve, space, gamut, ..ToneMap::default() }, &[0.02, 2.0]);
            let mut last = -1.0;
            for i in -40..40 {
                let rgb = display.coded(grey((0.25 * f64::from(i)).exp2()));
                assert!(rgb.max_element() - rgb.min_element() < 2e-3, "{curve:?} {}: {rgb}", space.name());
                assert!(rgb.y >= last && rgb.y <= 1.0, "{curve:?} {}: {rgb} after {last}", space.name());
                last = rgb.y;
            }
        }
    }

    #[test]
    fn the_scenes_white_becomes_the_displays() {
        let white = crate::illuminant::white_point("A").unwrap();
        for adaptation in Adaptation::ALL {
            let wanted = ToneMap { exposure: Exposure::Ev(0.0), white: Some(white), adaptation, ..ToneMap::default() };
            let rgb = display(wanted, &[]).coded(xyz_of_chromaticity(white) * 0.3);
            assert!(rgb.max_element() - rgb.min_element() < 1e-6 && (rgb.y - srgb::encode(0.3)).abs() < 1e-6, "{rgb}");
        }
    }

    #[test]
    fn bright_colours_pale_towards_white() {
        let saturated = |y: f64| srgb::xyz_from_rgb() * DVec3::new(1.0, 0.3, 0.2) * y;
        let off = |xyz: DVec3| {
            let c = chromaticity(xyz.to_array());
            (c[0] - D65_WHITE[0]).hypot(c[1] - D65_WHITE[1])
        };
        assert_eq!(paled(saturated(0.5), WHITE_LIGHTNESS), saturated(0.5));
        let (some, more, most) =
            (paled(saturated(3.0), 150.0), paled(saturated(5.0), 150.0), paled(saturated(20.0), 150.0));
        assert!(off(saturated(1.0)) > off(some) && off(some) > off(more) && off(more) > off(most));
        assert!(off(most) < 1e-9 && (most.y - 1.0).abs() < 1e-9 && (some.y - 1.0).abs() < 1e-9);
    }
}
