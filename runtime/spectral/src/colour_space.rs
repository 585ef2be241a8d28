//! Colour spaces of displays: primaries, the white D65 and the transfer function.
//!
//! sRGB (IEC 61966-2-1), Display P3 (SMPTE EG 432-1 primaries with the transfer function of sRGB), ITU-R BT.2020 and
//! Adobe RGB (1998). Linear components are relative: white is (1, 1, 1) and has Y = 1. Every transfer function is the
//! parametric curve of type 3 of ICC.1:2010, section 10.15, so that a profile can state it exactly.

use glam::{DMat3, DVec3};

/// Chromaticity of the white D65, as the standards of displays state it.
pub const D65_WHITE: [f64; 2] = [0.3127, 0.3290];

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColourSpace {
    #[default]
    Srgb,
    DisplayP3,
    Rec2020,
    AdobeRgb,
}

/// From a coded value to linear light: `(a v + b)^g` from `d` on, `c v` below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer {
    pub g: f64,
    pub a: f64,
    pub b: f64,
    pub c: f64,
    pub d: f64,
}

impl Transfer {
    const SRGB: Transfer = Transfer { g: 2.4, a: 1.0 / 1.055, b: 0.055 / 1.055, c: 1.0 / 12.92, d: 0.040_45 };
    /// The inverse of the encoding of ITU-R BT.2020, table 4, with its exact constants.
    const REC2020: Transfer = Transfer {
        g: 1.0 / 0.45,
        a: 1.0 / 1.099_296_826_809_44,
        b: 0.099_296_826_809_44 / 1.099_296_826_809_44,
        c: 1.0 / 4.5,
        d: 4.5 * 0.018_053_968_510_807,
    };
    const ADOBE_RGB: Transfer = Transfer { g: 563.0 / 256.0, a: 1.0, b: 0.0, c: 0.0, d: 0.0 };

    /// Coded value to its linear component, both in [0, 1].
    pub fn decode(&self, coded: f64) -> f64 {
        if coded >= self.d { (self.a * coded + self.b).max(0.0).powf(self.g) } else { self.c * coded }
    }

    /// Linear component to its coded value, both in [0, 1].
    pub fn encode(&self, linear: f64) -> f64 {
        if linear > self.c * self.d {
            (linear.powf(self.g.recip()) - self.b) / self.a
        } else if self.c > 0.0 {
            linear / self.c
        } else {
            0.0
        }
    }
}

impl ColourSpace {
    pub const ALL: [ColourSpace; 4] =
        [ColourSpace::Srgb, ColourSpace::DisplayP3, ColourSpace::Rec2020, ColourSpace::AdobeRgb];

    /// As it is written in scripts and arguments.
    pub const fn name(self) -> &'static str {
        match self {
            ColourSpace::Srgb => "srgb",
            ColourSpace::DisplayP3 => "display_p3",
            ColourSpace::Rec2020 => "rec2020",
            ColourSpace::AdobeRgb => "adobe_rgb",
        }
    }

    /// As people know it.
    pub const fn title(self) -> &'static str {
        match self {
            ColourSpace::Srgb => "sRGB",
            ColourSpace::DisplayP3 => "Display P3",
            ColourSpace::Rec2020 => "Rec. 2020",
            ColourSpace::AdobeRgb => "Adobe RGB (1998)",
        }
    }

    /// Chromaticities x, y of red, green and blue.
    pub const fn primaries(self) -> [[f64; 2]; 3] {
        match self {
            ColourSpace::Srgb => [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]],
            ColourSpace::DisplayP3 => [[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]],
            ColourSpace::Rec2020 => [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]],
            ColourSpace::AdobeRgb => [[0.64, 0.33], [0.21, 0.71], [0.15, 0.06]],
        }
    }

    pub const fn transfer(self) -> Transfer {
        match self {
            ColourSpace::Srgb | ColourSpace::DisplayP3 => Transfer::SRGB,
            ColourSpace::Rec2020 => Transfer::REC2020,
            ColourSpace::AdobeRgb => Transfer::ADOBE_RGB,
        }
    }

    /// XYZ from linear components.
    pub fn xyz_from_rgb(self) -> DMat3 {
        xyz_from_rgb(self.primaries(), D65_WHITE)
    }

    /// Linear components from XYZ.
    pub fn rgb_from_xyz(self) -> DMat3 {
        self.xyz_from_rgb().inverse()
    }
}

/// XYZ from linear components of the space with these chromaticities; their y must be positive.
pub fn xyz_from_rgb(primaries: [[f64; 2]; 3], white: [f64; 2]) -> DMat3 {
    let [red, green, blue] = primaries.map(xyz_of_chromaticity);
    let primaries = DMat3::from_cols(red, green, blue);
    primaries * DMat3::from_diagonal(primaries.inverse() * xyz_of_chromaticity(white))
}

/// X, Y, Z with Y = 1.
pub fn xyz_of_chromaticity([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ITU-R BT.2020 table 4, Adobe RGB (1998) section 4.3.5.3, SMPTE RP 431-2 with D65: luminances of the primaries.
    #[test]
    fn luminances_of_primaries_are_the_published_ones() {
        for (space, published) in [
            (ColourSpace::Srgb, [0.2126, 0.7152, 0.0722]),
            (ColourSpace::DisplayP3, [0.2290, 0.6917, 0.0793]),
            (ColourSpace::Rec2020, [0.2627, 0.6780, 0.0593]),
            (ColourSpace::AdobeRgb, [0.29734, 0.62736, 0.07529]),
        ] {
            let luminances = space.xyz_from_rgb().transpose().y_axis.to_array();
            assert!((0..3).all(|c| (luminances[c] - published[c]).abs() < 6e-5), "{}: {luminances:?}", space.name());
        }
        assert!((ColourSpace::Srgb.xyz_from_rgb() - crate::srgb::xyz_from_rgb()).abs_diff_eq(DMat3::ZERO, 1e-15));
    }

    #[test]
    fn transfer_functions_are_inverse_and_continuous() {
        for space in ColourSpace::ALL {
            let transfer = space.transfer();
            for i in 0..=1000 {
                let x = f64::from(i) / 1000.0;
                assert!((transfer.encode(transfer.decode(x)) - x).abs() < 1e-6, "{}: {x}", space.name());
            }
            let gap = transfer.decode(transfer.d) - transfer.decode(transfer.d - 1e-12);
            assert!(gap.abs() < 1e-6, "{}: {gap}", space.name());
            assert!(transfer.encode(0.0).abs() < 1e-12 && (transfer.encode(1.0) - 1.0).abs() < 1e-12);
        }
        for x in [0.0, 0.001, 0.02, 0.5] {
            assert!((Transfer::SRGB.encode(x) - crate::srgb::encode(x)).abs() < 1e-7);
        }
    }
}
