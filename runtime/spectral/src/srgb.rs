//! sRGB (IEC 61966-2-1): primaries of ITU-R BT.709, white D65, and its transfer function.
//!
//! Linear components are relative: white is (1, 1, 1) and has Y = 1.

use glam::{DMat3, DVec3};

/// Chromaticities x, y of red, green, blue and white.
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
const WHITE: [f64; 2] = [0.3127, 0.3290];

/// XYZ from linear sRGB.
pub fn xyz_from_rgb() -> DMat3 {
    let column = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let primaries = DMat3::from_cols(column(PRIMARIES[0]), column(PRIMARIES[1]), column(PRIMARIES[2]));
    let scale = primaries.inverse() * column(WHITE);
    primaries * DMat3::from_diagonal(scale)
}

/// Linear sRGB from XYZ.
pub fn rgb_from_xyz() -> DMat3 {
    xyz_from_rgb().inverse()
}

/// Linear component to its coded value, both in [0, 1].
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Coded value to its linear component, both in [0, 1].
pub fn decode(coded: f64) -> f64 {
    if coded <= 0.040_45 { coded / 12.92 } else { ((coded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrix_is_the_published_one() {
        let m = xyz_from_rgb();
        let published =
            DMat3::from_cols_array(&[0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722, 0.9505]);
        assert!((m - published).abs_diff_eq(DMat3::ZERO, 6e-5), "{m}");
    }

    #[test]
    fn transfer_functions_are_inverse() {
        for i in 0..=1000 {
            let x = i as f64 / 1000.0;
            assert!((encode(decode(x)) - x).abs() < 1e-6, "{x}");
        }
        assert!((encode(0.18) - 0.4613).abs() < 1e-4);
    }
}
