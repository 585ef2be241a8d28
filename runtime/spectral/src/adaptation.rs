//! Chromatic adaptation: what a colour seen under one white looks like under another.
//!
//! Diagonal scaling in a space of sharpened cone responses: Bradford (Lam 1985, as in ICC.1:2010, annex E) or CAT16 (Li
//! et al. 2017, "Comprehensive color solutions: CAM16, CAT16, and CAM16-UCS", complete adaptation). Luminance of the
//! white stays.

use glam::DMat3;

use crate::colour_space::xyz_of_chromaticity;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Adaptation {
    #[default]
    Bradford,
    Cat16,
}

impl Adaptation {
    pub const ALL: [Adaptation; 2] = [Adaptation::Bradford, Adaptation::Cat16];

    /// As it is written in scripts and arguments.
    pub const fn name(self) -> &'static str {
        match self {
            Adaptation::Bradford => "bradford",
            Adaptation::Cat16 => "cat16",
        }
    }

    /// Sharpened responses from XYZ.
    fn responses_from_xyz(self) -> DMat3 {
        let rows = match self {
            Adaptation::Bradford => [0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296],
            Adaptation::Cat16 => {
                [0.401288, 0.650173, -0.051461, -0.250268, 1.204414, 0.045854, -0.002079, 0.048952, 0.953127]
            }
        };
        DMat3::from_cols_array(&rows).transpose()
    }

    /// Maps XYZ so that the chromaticity `from` becomes `to`.
    pub fn matrix(self, from: [f64; 2], to: [f64; 2]) -> DMat3 {
        let responses = self.responses_from_xyz();
        let (from, to) = (responses * xyz_of_chromaticity(from), responses * xyz_of_chromaticity(to));
        responses.inverse() * DMat3::from_diagonal(to / from) * responses
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chromaticity;
    use crate::colour_space::D65_WHITE;

    #[test]
    fn white_goes_to_white() {
        for adaptation in Adaptation::ALL {
            let adapted = adaptation.matrix([0.44758, 0.40745], D65_WHITE) * xyz_of_chromaticity([0.44758, 0.40745]);
            let found = chromaticity(adapted.to_array());
            assert!((0..2).all(|c| (found[c] - D65_WHITE[c]).abs() < 1e-12) && (adapted.y - 1.0).abs() < 1e-12);
            let there_and_back = adaptation.matrix([0.3, 0.3], D65_WHITE) * adaptation.matrix(D65_WHITE, [0.3, 0.3]);
            assert!(there_and_back.abs_diff_eq(DMat3::IDENTITY, 1e-12));
        }
    }

    /// The matrix from D65 to D50 that ICC profiles of sRGB carry.
    #[test]
    fn bradford_is_the_published_one() {
        let found = Adaptation::Bradford.matrix(D65_WHITE, [0.34567, 0.35850]);
        let published = [1.0478, 0.0229, -0.0501, 0.0295, 0.9905, -0.0171, -0.0092, 0.0150, 0.7521];
        let published = DMat3::from_cols_array(&published).transpose();
        assert!((found - published).abs_diff_eq(DMat3::ZERO, 3e-4), "{found}");
    }
}
