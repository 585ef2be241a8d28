//! Curves that bring light without a limit into the range of a display.
//!
//! All but the calibration work on components of linear light, and all have 1 as their limit.
//!
//! - *Shoulder*: linear up to [`KNEE`], then exponential towards 1 with a continuous slope.
//! - *Exponential*: 1 - exp(-k x).
//! - *Calibrated*: a straight line in log luminance about the average (Matković and Neumann 1996, "Interactive
//!   calibration of the mapping of global illumination values to display devices"): aperture moves it, contrast is its slope;
//!   the chromaticity stays.
//! - *ACES*: Hill's fit of the reference rendering and output transforms for sRGB (S. Hill, "ACES fitted", in
//!   BakingLab, MIT licence): two matrices and a rational function.
//! - *AgX*: the transform of T. Sobotka: an inset matrix, log2 from 10 stops below to 6.5 stops above middle grey,
//!   a sigmoid through (10 / 16.5, 0.5) with slope 2 there and powers 3 and 3.25 for toe and shoulder, the inverse
//!   matrix, and the power 2.2. The sigmoid is computed from these four numbers, not fitted.
//!
//! ACES and AgX are defined for components of sRGB; other spaces go there and back.

use glam::{DMat3, DVec3};

use super::gamut::Gamut;
use crate::colour_space::ColourSpace;

/// Where highlights begin to roll off.
pub const KNEE: f64 = 0.75;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Curve {
    /// Linear with a soft end.
    #[default]
    Shoulder,
    /// Linear, cut off at 1.
    Linear,
    /// With a target in (0, 1), the log-average becomes that; else k = 1.
    Exponential {
        target: Option<f64>,
    },
    Calibrated(Calibration),
    Aces,
    Agx,
}

/// A line in log luminance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// Stops by which the average is moved.
    pub aperture: f64,
    /// Percent; the slope of the line is a hundredth of it.
    pub contrast: f64,
    /// The line itself, instead: Y becomes a Y^b.
    pub line: Option<[f64; 2]>,
}

impl Default for Calibration {
    /// The identity, as in ART.
    fn default() -> Calibration {
        Calibration { aperture: 0.0, contrast: 100.0, line: None }
    }
}

impl Curve {
    /// As they are written in scripts and arguments.
    pub const NAMES: [&str; 6] = ["shoulder", "linear", "exponential", "calibrated", "aces", "agx"];

    /// One of each.
    #[cfg(test)]
    pub(super) const EXAMPLES: [Curve; 7] = [
        Curve::Shoulder,
        Curve::Linear,
        Curve::Exponential { target: None },
        Curve::Exponential { target: Some(0.3) },
        Curve::Calibrated(Calibration { aperture: 0.5, contrast: 70.0, line: None }),
        Curve::Aces,
        Curve::Agx,
    ];

    pub const fn name(self) -> &'static str {
        match self {
            Curve::Shoulder => Curve::NAMES[0],
            Curve::Linear => Curve::NAMES[1],
            Curve::Exponential { .. } => Curve::NAMES[2],
            Curve::Calibrated(_) => Curve::NAMES[3],
            Curve::Aces => Curve::NAMES[4],
            Curve::Agx => Curve::NAMES[5],
        }
    }
}

/// A curve made ready for one picture.
#[derive(Clone, Debug)]
pub(super) enum Ready {
    Shoulder,
    Linear,
    Exponential(f64),
    Calibrated { a: f64, b: f64 },
    Aces(Sandwich),
    Agx(Sandwich),
}

/// Matrices before and after a curve: from components of the display's space, and back. Between them lies sRGB, into
/// whose gamut colours are brought first.
#[derive(Clone, Debug)]
pub(super) struct Sandwich {
    xyz_from_display: DMat3,
    inset_from_srgb: DMat3,
    srgb_from_outset: DMat3,
    display_from_srgb: DMat3,
}

impl Sandwich {
    fn new(space: ColourSpace, inset: DMat3, outset: DMat3) -> Sandwich {
        Sandwich {
            xyz_from_display: space.xyz_from_rgb(),
            inset_from_srgb: inset,
            srgb_from_outset: outset,
            display_from_srgb: space.rgb_from_xyz() * ColourSpace::Srgb.xyz_from_rgb(),
        }
    }

    fn apply(&self, rgb: DVec3, curve: impl Fn(f64) -> f64, finish: impl Fn(f64) -> f64) -> DVec3 {
        let xyz = self.xyz_from_display * rgb;
        let srgb = Gamut::Desaturate.into(&ColourSpace::Srgb.rgb_from_xyz(), xyz, f64::INFINITY);
        let through = self.srgb_from_outset * each(self.inset_from_srgb * srgb, curve);
        self.display_from_srgb * each(through, finish)
    }
}

fn each(v: DVec3, f: impl Fn(f64) -> f64) -> DVec3 {
    DVec3::new(f(v.x), f(v.y), f(v.z))
}

impl Ready {
    /// For a picture with this log-average luminance after exposure.
    pub(super) fn new(curve: Curve, average: f64, space: ColourSpace) -> Ready {
        match curve {
            Curve::Shoulder => Ready::Shoulder,
            Curve::Linear => Ready::Linear,
            Curve::Exponential { target: Some(target) } if average > 0.0 => {
                Ready::Exponential(-(-target).ln_1p() / average)
            }
            Curve::Exponential { .. } => Ready::Exponential(1.0),
            Curve::Calibrated(Calibration { line: Some([a, b]), .. }) => Ready::Calibrated { a, b },
            Curve::Calibrated(calibration) => {
                let b = calibration.contrast / 100.0;
                let average = if average > 0.0 { average } else { 1.0 };
                Ready::Calibrated { a: calibration.aperture.exp2() * average.powf(1.0 - b), b }
            }
            Curve::Aces => Ready::Aces(Sandwich::new(space, rows(ACES_INPUT), rows(ACES_OUTPUT))),
            Curve::Agx => Ready::Agx(Sandwich::new(space, rows(AGX_INSET), rows(AGX_INSET).inverse())),
        }
    }

    /// Whether components above 1 are cut off.
    pub(super) fn is_linear(&self) -> bool {
        matches!(self, Ready::Linear | Ready::Calibrated { .. })
    }

    /// The exposed colour with the luminance that the calibration gives it.
    pub(super) fn calibrated(&self, xyz: DVec3) -> DVec3 {
        match self {
            Ready::Calibrated { a, b } if xyz.y > 0.0 => xyz * (a * xyz.y.powf(b - 1.0)),
            _ => xyz,
        }
    }

    /// Components after the curve; `rgb` has no negative one.
    pub(super) fn components(&self, rgb: DVec3) -> DVec3 {
        match self {
            Ready::Linear | Ready::Calibrated { .. } => rgb,
            Ready::Shoulder => each(rgb, shoulder),
            Ready::Exponential(k) => each(rgb, |x| -(-k * x).exp_m1()),
            Ready::Aces(sandwich) => sandwich.apply(rgb, aces, |x| x),
            Ready::Agx(sandwich) => sandwich.apply(rgb, agx, |x| x.max(0.0).powf(2.2)),
        }
    }
}

fn shoulder(x: f64) -> f64 {
    if x <= KNEE { x } else { KNEE + (1.0 - KNEE) * -(-(x - KNEE) / (1.0 - KNEE)).exp_m1() }
}

fn rows(rows: [f64; 9]) -> DMat3 {
    DMat3::from_cols_array(&rows).transpose()
}

const ACES_INPUT: [f64; 9] = [0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777];
const ACES_OUTPUT: [f64; 9] = [1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602];

fn aces(x: f64) -> f64 {
    (x * (x + 0.024_578_6) - 0.000_090_537) / (x * (0.983_729 * x + 0.432_951_0) + 0.238_081)
}

#[rustfmt::skip]
const AGX_INSET: [f64; 9] = [
    0.842_479_062_253_094, 0.078_433_599_999_999_2, 0.079_223_745_147_764_3,
    0.042_328_242_261_012_3, 0.878_468_636_469_772, 0.079_166_127_460_543_4,
    0.042_375_654_905_705_1, 0.078_433_6, 0.879_142_973_793_104,
];

/// Stops below and above middle grey.
const AGX_STOPS: [f64; 2] = [10.0, 6.5];

fn agx(x: f64) -> f64 {
    let [below, above] = AGX_STOPS;
    let stops = (x.max(f64::MIN_POSITIVE) / 0.18).log2().clamp(-below, above);
    sigmoid((stops + below) / (below + above), below / (below + above))
}

/// Through (pivot, 0.5) with slope 2, 0 at 0 and 1 at 1: the line through the pivot divided by
/// (1 + (d / s)^p)^(1/p), where d is the distance from the pivot and s makes the ends meet.
fn sigmoid(x: f64, pivot: f64) -> f64 {
    const SLOPE: f64 = 2.0;
    let (power, reach) = if x < pivot { (3.0, pivot) } else { (3.25, 1.0 - pivot) };
    let (distance, end) = ((x - pivot).abs() / reach, SLOPE * reach / 0.5);
    let scale = end.powf(power) - 1.0;
    0.5 + SLOPE * (x - pivot) * (1.0 + scale * distance.powf(power)).powf(-1.0 / power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn highlights_roll_off_monotonically_and_smoothly() {
        let mut last = 0.0;
        for i in 0..4000 {
            let y = shoulder(f64::from(i) * 1e-3);
            assert!((y > last || i == 0) && y - last < 1.001e-3 && y <= 1.0);
            last = y;
        }
    }

    #[test]
    fn the_average_meets_the_target() {
        let ready = Ready::new(Curve::Exponential { target: Some(0.3) }, 0.05, ColourSpace::Srgb);
        assert!((ready.components(DVec3::splat(0.05)).x - 0.3).abs() < 1e-12);
    }

    #[test]
    fn calibration_turns_about_the_average() {
        let grey = |calibration, average: f64, y: f64| {
            Ready::new(Curve::Calibrated(calibration), average, ColourSpace::Srgb).calibrated(DVec3::splat(y)).y
        };
        let of = |aperture, contrast| Calibration { aperture, contrast, line: None };
        assert!((grey(Calibration::default(), 0.2, 0.7) - 0.7).abs() < 1e-12, "the default changes nothing");
        assert!(
            (grey(of(0.0, 50.0), 0.2, 0.2) - 0.2).abs() < 1e-12 && (grey(of(1.0, 50.0), 0.2, 0.2) - 0.4).abs() < 1e-12
        );
        assert!((grey(of(0.0, 50.0), 0.2, 0.8) - 0.4).abs() < 1e-12, "two stops above become one");
        let line = Calibration { line: Some([0.5, 2.0]), ..Calibration::default() };
        assert!((grey(line, 0.2, 0.8) - 0.32).abs() < 1e-12);
    }

    /// The sigmoid's constants as AgX's author prints them for its table.
    #[test]
    fn agx_has_the_published_sigmoid() {
        let (x, pivot) = (0.3f64, 10.0 / 16.5);
        let published = 0.5 + (2.0 * x - 2.0 * pivot) * (1.0 + 59.507_875 * (pivot - x).powf(3.0)).powf(-1.0 / 3.0);
        assert!((sigmoid(x, pivot) - published).abs() < 1e-7);
        let x = 0.9f64;
        let published = 0.5 + (2.0 * x - 2.0 * pivot) * (1.0 + 69.862_789 * (x - pivot).powf(3.25)).powf(-1.0 / 3.25);
        assert!((sigmoid(x, pivot) - published).abs() < 1e-7);
        assert!(sigmoid(0.0, pivot).abs() < 1e-12 && (sigmoid(1.0, pivot) - 1.0).abs() < 1e-12);
        assert!((agx(0.18) - 0.5).abs() < 1e-12, "middle grey lies at the pivot");
    }

    /// Middle grey of the reference transforms is 0.1 of their white (ACES) and 0.5^2.2 (AgX).
    #[test]
    fn middle_grey_has_its_place() {
        let grey = |curve| Ready::new(curve, 1.0, ColourSpace::Srgb).components(DVec3::splat(0.18)).y;
        assert!((grey(Curve::Aces) - 0.1058).abs() < 2e-3, "{}", grey(Curve::Aces));
        assert!((grey(Curve::Agx) - 0.5f64.powf(2.2)).abs() < 1e-3, "{}", grey(Curve::Agx));
    }

    #[test]
    fn other_spaces_show_the_same_colour() {
        for curve in [Curve::Aces, Curve::Agx] {
            let xyz = ColourSpace::Srgb.xyz_from_rgb() * DVec3::new(2.0, 0.4, 0.1);
            let shown = |space: ColourSpace| {
                space.xyz_from_rgb() * Ready::new(curve, 1.0, space).components(space.rgb_from_xyz() * xyz)
            };
            assert!(shown(ColourSpace::Rec2020).abs_diff_eq(shown(ColourSpace::Srgb), 1e-9));
        }
    }
}
