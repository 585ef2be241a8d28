//! The thin lens and the shape of its aperture.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::warp::concentric_disk;

/// A thin lens in the plane of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Of the aperture, or of the circle through the corners of its polygon; scene units.
    pub radius: f64,
    /// Distance of the plane in focus along the view axis, positive.
    pub focus: f64,
    /// Corners of the aperture, three at least; fewer mean a disk.
    pub blades: u32,
    /// Turns the polygon clockwise in the eyes of who looks along the view axis, radians. At 0 a corner is on top.
    pub rotation: f64,
}

impl Lens {
    /// A point of the aperture, uniform per area: x to the right and y downwards in the picture.
    #[inline]
    pub fn sample(&self, u: [f64; 2]) -> DVec2 {
        if self.blades < 3 {
            return concentric_disk(u) * self.radius;
        }
        // A triangle between the middle and two corners, then a point of it.
        let blades = f64::from(self.blades);
        let scaled = u[0] * blades;
        let blade = scaled.floor().min(blades - 1.0);
        let corner = |i: f64| {
            let (sin, cos) = (TAU * i / blades + self.rotation).sin_cos();
            DVec2::new(sin, -cos) * self.radius
        };
        let outwards = u[1].sqrt();
        corner(blade).lerp(corner(blade + 1.0), (scaled - blade).min(1.0)) * outwards
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean of x^2 + y^2 of a regular polygon with circumradius 1 is (2 + cos(2 pi / n)) / 6; of a disk 1/2. A grid of
    /// midpoints, 256 x 252 (so that no cell straddles two blades), has no sampling noise.
    #[test]
    fn apertures_have_their_moments() {
        for blades in [0, 3, 4, 6, 7, 9] {
            let lens = Lens { radius: 2.0, focus: 1.0, blades, rotation: 0.3 };
            let (n, m) = (252, 256);
            let points =
                (0..n * m).map(|i| lens.sample([((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / m as f64]));
            let (mut first, mut second) = (DVec2::ZERO, 0.0);
            for p in points {
                assert!(p.length() <= 2.0 * (1.0 + 1e-12));
                first += p / (n * m) as f64;
                second += p.length_squared() / (4 * n * m) as f64;
            }
            let exact = if blades == 0 { 0.5 } else { (2.0 + (TAU / f64::from(blades)).cos()) / 6.0 };
            assert!(first.length() < 1e-3, "{blades} blades: {first}");
            assert!((second - exact).abs() < 1e-3, "{blades} blades: {second} instead of {exact}");
        }
    }

    #[test]
    fn the_first_corner_is_on_top_and_turns_clockwise() {
        let lens = |rotation| Lens { radius: 1.0, focus: 1.0, blades: 5, rotation };
        let corner = |rotation| lens(rotation).sample([0.0, 1.0]);
        assert!((corner(0.0) - DVec2::new(0.0, -1.0)).length() < 1e-12);
        assert!((corner(TAU / 4.0) - DVec2::new(1.0, 0.0)).length() < 1e-12);
    }
}
