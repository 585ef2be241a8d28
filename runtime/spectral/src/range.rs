//! Ranges of wavelengths: what is tabulated, and what a render samples.
//!
//! Tables of the renderer have a knot every nanometre from [`TABLE_MIN_NM`] to [`TABLE_MAX_NM`], whatever is rendered, so
//! that the cost of a lookup does not depend on the range. What a render samples is a [`WavelengthRange`] within; by
//! default the visible one, [`WavelengthRange::VISIBLE`]. UV-excited fluorescence needs 300 nm and up.

/// The range of the renderer's tables, nm.
pub const TABLE_MIN_NM: f64 = 200.0;
/// The range of the renderer's tables, nm.
pub const TABLE_MAX_NM: f64 = 1100.0;

/// Number of 1 nm knots of the renderer's tables, both ends included.
pub const KNOTS: usize = (TABLE_MAX_NM - TABLE_MIN_NM) as usize + 1;

/// The wavelengths that a render samples; within the tables, at least 5 nm wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavelengthRange {
    min_nm: f64,
    max_nm: f64,
}

impl WavelengthRange {
    /// 360 to 830 nm: where the CIE 1931 observer is defined.
    pub const VISIBLE: WavelengthRange = WavelengthRange { min_nm: 360.0, max_nm: 830.0 };

    /// `None` unless the ends are finite, in order, at least 5 nm apart and within the tables.
    pub fn new(min_nm: f64, max_nm: f64) -> Option<WavelengthRange> {
        let within = min_nm >= TABLE_MIN_NM && max_nm <= TABLE_MAX_NM && max_nm - min_nm >= 5.0;
        within.then_some(WavelengthRange { min_nm, max_nm })
    }

    pub const fn min_nm(&self) -> f64 {
        self.min_nm
    }

    pub const fn max_nm(&self) -> f64 {
        self.max_nm
    }

    pub const fn width_nm(&self) -> f64 {
        self.max_nm - self.min_nm
    }
}

impl Default for WavelengthRange {
    fn default() -> WavelengthRange {
        WavelengthRange::VISIBLE
    }
}

/// The wavelength of a knot.
#[inline]
pub(crate) fn knot_nm(knot: usize) -> f64 {
    TABLE_MIN_NM + knot as f64
}

/// Index of the nearest knot; wavelengths outside of the tables take the end knots.
#[inline]
pub(crate) fn nearest_knot(lambda_nm: f32) -> u32 {
    ((lambda_nm - (TABLE_MIN_NM as f32 - 0.5)) as u32).min(KNOTS as u32 - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_ordered_and_within_the_tables() {
        let range = WavelengthRange::new(300.0, 830.0).unwrap();
        assert_eq!((range.min_nm(), range.max_nm(), range.width_nm()), (300.0, 830.0, 530.0));
        for (min, max) in [(830.0, 360.0), (500.0, 504.5), (199.9, 500.0), (500.0, 1100.1), (f64::NAN, 600.0)] {
            assert_eq!(WavelengthRange::new(min, max), None, "{min} to {max}");
        }
    }

    #[test]
    fn knots_are_nearest() {
        for (lambda, knot) in [(0.0, 0), (200.0, 0), (200.49, 0), (200.51, 1), (555.0, 355), (1100.0, 900), (2e9, 900)]
        {
            assert_eq!(nearest_knot(lambda), knot, "{lambda} nm");
        }
        assert_eq!(knot_nm(KNOTS - 1), TABLE_MAX_NM);
    }
}
