//! From XYZ to sRGB (IEC 61966-2-1).
//!
//! Linear sRGB here is relative: the equal-energy spectrum of 1 W m^-2 sr^-1 nm^-1 has a relative luminance of 1.

/// Luminance, cd m^-2, of the relative luminance 1: 683 lm/W times the integral of the CIE 1931 ybar over 360–830 nm
/// (106.8566 nm, trapezoid of the 1 nm table).
pub const UNIT_LUMINANCE: f64 = 683.0 * 106.8566;

/// Linear sRGB from XYZ of the same scale, primaries of ITU-R BT.709 and D65 white; may be negative outside the gamut.
pub fn linear_srgb_from_xyz(xyz: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = xyz;
    [
        3.2409699419045226 * x - 1.5373831775700940 * y - 0.4986107602930034 * z,
        -0.9692436362808796 * x + 1.8759675015077202 * y + 0.0415550574071756 * z,
        0.0556300796969936 * x - 0.2039769588889765 * y + 1.0569715142428786 * z,
    ]
}

/// The sRGB transfer function on [0, 1]; beyond, clamped.
pub fn srgb_encode(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn d65_white_is_equal_rgb() {
        let (x, y) = (0.3127, 0.3290);
        let rgb = linear_srgb_from_xyz([x / y, 1.0, (1.0 - x - y) / y]);
        for channel in rgb {
            assert!((channel - 1.0).abs() < 1e-3, "{rgb:?}");
        }
    }

    #[test]
    fn transfer_function_hits_the_standard_points() {
        assert_eq!(srgb_encode(0.0), 0.0);
        assert!((srgb_encode(1.0) - 1.0).abs() < 1e-12);
        assert!((srgb_encode(0.18) - 0.461_356).abs() < 1e-5);
        assert!((srgb_encode(0.003_130_8) - 0.040_449_9).abs() < 1e-6);
    }
}
