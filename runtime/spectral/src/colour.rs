//! Colour spaces and the difference of colours.
//!
//! CIE XYZ in any unit, xyY, CIE L*a*b* (CIE 15:2018, section 8.2.1) and the CIEDE2000 colour difference (Sharma, Wu and
//! Dalal 2005, "The CIEDE2000 color-difference formula: implementation notes", equations 2 to 22). L*, a*, b* refer to a
//! white point in the same unit as the colour; L* = 100 is white.

use std::f64::consts::PI;

/// X, Y, Z of chromaticity x, y (y > 0) and luminance Y.
pub fn xyz_from_xyy([x, y, luminance]: [f64; 3]) -> [f64; 3] {
    [x / y * luminance, luminance, (1.0 - x - y) / y * luminance]
}

const DELTA: f64 = 6.0 / 29.0;

/// X, Y, Z of L*, a*, b*.
pub fn xyz_from_lab([l, a, b]: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    let middle = (l + 16.0) / 116.0;
    let inverse = |t: f64| if t > DELTA { t * t * t } else { 3.0 * DELTA * DELTA * (t - 4.0 / 29.0) };
    let relative = [inverse(middle + a / 500.0), inverse(middle), inverse(middle - b / 200.0)];
    std::array::from_fn(|c| relative[c] * white[c])
}

/// L*, a*, b* of X, Y, Z.
pub fn lab_from_xyz(xyz: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    let f = |t: f64| if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 };
    let [x, y, z]: [f64; 3] = std::array::from_fn(|c| f(xyz[c] / white[c]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// CIEDE2000 of two colours in L*, a*, b*, all weights one.
pub fn delta_e_2000(one: [f64; 3], two: [f64; 3]) -> f64 {
    let chroma = |[_, a, b]: [f64; 3]| a.hypot(b);
    let mean = 0.5 * (chroma(one) + chroma(two));
    let stretch = 1.0 + 0.5 * (1.0 - compressed(mean));
    let polar = |[l, a, b]: [f64; 3]| {
        let a = a * stretch;
        let hue = if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a).rem_euclid(2.0 * PI) };
        (l, a.hypot(b), hue)
    };
    let ((l1, c1, h1), (l2, c2, h2)) = (polar(one), polar(two));
    let grey = c1 * c2 == 0.0;
    let turn = match h2 - h1 {
        _ if grey => 0.0,
        d if d > PI => d - 2.0 * PI,
        d if d < -PI => d + 2.0 * PI,
        d => d,
    };
    let (dl, dc, dh) = (l2 - l1, c2 - c1, 2.0 * (c1 * c2).sqrt() * (0.5 * turn).sin());
    let (l, c) = (0.5 * (l1 + l2), 0.5 * (c1 + c2));
    let h = match h1 + h2 {
        sum if grey => sum,
        sum if (h1 - h2).abs() <= PI => 0.5 * sum,
        sum if sum < 2.0 * PI => 0.5 * sum + PI,
        sum => 0.5 * sum - PI,
    };
    let degrees = |d: f64| d.to_radians();
    let t = 1.0 - 0.17 * (h - degrees(30.0)).cos() + 0.24 * (2.0 * h).cos() + 0.32 * (3.0 * h + degrees(6.0)).cos()
        - 0.20 * (4.0 * h - degrees(63.0)).cos();
    let blue = degrees(30.0) * (-((h - degrees(275.0)) / degrees(25.0)).powi(2)).exp();
    let off = (l - 50.0) * (l - 50.0);
    let (sl, sc, sh) = (1.0 + 0.015 * off / (20.0 + off).sqrt(), 1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
    let rotation = -2.0 * compressed(c) * (2.0 * blue).sin();
    let (dl, dc, dh) = (dl / sl, dc / sc, dh / sh);
    (dl * dl + dc * dc + dh * dh + rotation * dc * dh).max(0.0).sqrt()
}

/// sqrt(C^7 / (C^7 + 25^7)).
fn compressed(chroma: f64) -> f64 {
    let power = chroma.powi(7);
    (power / (power + 25f64.powi(7))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of table 1 of Sharma, Wu and Dalal 2005, chosen for hues across the wrap, greys and the blue rotation.
    #[test]
    fn differences_are_the_published_ones() {
        for (one, two, published) in [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
            ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009], 7.1792),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0011], 7.2195),
            ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
            ([22.7233, 20.0904, -46.6940], [23.0331, 14.9730, -42.5619], 2.0373),
            ([90.8027, -2.0831, 1.4410], [91.1528, -1.6435, 0.0447], 1.4441),
            ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
        ] {
            let (there, back) = (delta_e_2000(one, two), delta_e_2000(two, one));
            assert!((there - published).abs() < 5e-5, "{one:?} {two:?}: {there} instead of {published}");
            assert!((there - back).abs() < 1e-12);
        }
        assert_eq!(delta_e_2000([0.0; 3], [0.0; 3]), 0.0);
    }

    #[test]
    fn lab_and_xyz_are_inverse() {
        let white = [0.9504, 1.0, 1.0888];
        assert!(lab_from_xyz(white, white).iter().zip([100.0, 0.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12));
        for lab in [[50.0, 20.0, -30.0], [3.0, 1.0, 1.0], [97.0, -10.0, 80.0]] {
            let back = lab_from_xyz(xyz_from_lab(lab, white), white);
            assert!((0..3).all(|c| (back[c] - lab[c]).abs() < 1e-10), "{lab:?} comes back as {back:?}");
        }
        assert_eq!(xyz_from_xyy([0.25, 0.5, 2.0]), [1.0, 2.0, 1.0]);
    }
}
