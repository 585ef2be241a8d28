//! Stokes vectors of light at the wavelengths of a path, and their reference frames.

use std::ops::{AddAssign, Mul};

use arsc_spectral::SampledSpectrum;
use glam::DVec3;

use super::Stokes;
use crate::frame::Frame;

/// What S1 to S3 refer to: x and y across the direction of travel k, x cross y = k. Both vectors are zero for light
/// without linear polarisation, which fits every frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReferenceFrame {
    pub x: DVec3,
    pub y: DVec3,
}

impl ReferenceFrame {
    /// With the unit vector `x` across the unit vector `k`.
    #[inline]
    pub fn new(x: DVec3, k: DVec3) -> ReferenceFrame {
        ReferenceFrame { x, y: k.cross(x) }
    }

    #[inline]
    pub(super) fn to_world(self, frame: &Frame) -> ReferenceFrame {
        ReferenceFrame { x: frame.to_world(self.x), y: frame.to_world(self.y) }
    }

    /// Cosine and sine of twice the angle from the x of `self` to that of `other`, about the direction of travel.
    #[inline]
    pub(super) fn doubled_angle_to(&self, other: &ReferenceFrame) -> [f32; 2] {
        let (cos, sin) = (other.x.dot(self.x), other.x.dot(self.y));
        let norm = cos * cos + sin * sin;
        if norm == 0.0 {
            return [1.0, 0.0]; // one of the two is free
        }
        [((cos * cos - sin * sin) / norm) as f32, (2.0 * cos * sin / norm) as f32]
    }
}

/// The four Stokes parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StokesSpectrum {
    pub s: [SampledSpectrum; 4],
    pub frame: ReferenceFrame,
}

impl StokesSpectrum {
    /// The same light in another frame about the same direction.
    #[inline]
    pub fn in_frame(&self, frame: ReferenceFrame) -> StokesSpectrum {
        let [cos, sin] = self.frame.doubled_angle_to(&frame);
        let [s0, s1, s2, s3] = self.s;
        StokesSpectrum { s: [s0, s1 * cos + s2 * sin, s2 * cos - s1 * sin, s3], frame }
    }
}

/// Share of the intensity by which rounding may push S0 below zero behind crossed polarisers.
const ROUNDING: f32 = 1e-5;

/// Zero for what rounding has made negative; `scale` is the sum of the terms' absolute values.
#[inline]
pub(super) fn without_rounding(s0: SampledSpectrum, scale: SampledSpectrum) -> SampledSpectrum {
    let is_rounding = s0.0.cmplt(glam::Vec4::ZERO) & s0.0.cmpgt(scale.0 * -ROUNDING);
    SampledSpectrum(glam::Vec4::select(is_rounding, glam::Vec4::ZERO, s0.0))
}

/// Of light in the same frame, or of unpolarised light.
impl AddAssign for StokesSpectrum {
    #[inline]
    fn add_assign(&mut self, other: StokesSpectrum) {
        for (sum, s) in self.s.iter_mut().zip(other.s) {
            *sum += s;
        }
    }
}

impl Mul<f32> for StokesSpectrum {
    type Output = StokesSpectrum;
    #[inline]
    fn mul(self, factor: f32) -> StokesSpectrum {
        let [s0, s1, s2, s3] = self.s;
        StokesSpectrum { s: [s0 * factor, s1 * factor, s2 * factor, s3 * factor], frame: self.frame }
    }
}

impl Stokes for StokesSpectrum {
    #[inline]
    fn unpolarised(radiance: SampledSpectrum) -> StokesSpectrum {
        let zero = SampledSpectrum::ZERO;
        StokesSpectrum { s: [radiance, zero, zero, zero], frame: ReferenceFrame::default() }
    }

    #[inline]
    fn linear(radiance: SampledSpectrum, s1: SampledSpectrum, axis: DVec3, k: DVec3) -> StokesSpectrum {
        let zero = SampledSpectrum::ZERO;
        StokesSpectrum { s: [radiance, s1, zero, zero], frame: ReferenceFrame::new(axis, k) }
    }

    #[inline]
    fn intensity(&self) -> SampledSpectrum {
        self.s[0]
    }

    #[inline]
    fn polarisation(&self) -> Option<[SampledSpectrum; 3]> {
        Some([self.s[1], self.s[2], self.s[3]])
    }

    #[inline]
    fn to_world(self, frame: &Frame) -> StokesSpectrum {
        StokesSpectrum { s: self.s, frame: self.frame.to_world(frame) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Light along x, seen from a frame turned by 30 degrees: S1 = cos 60, S2 = -sin 60; and back again.
    #[test]
    fn frames_turn_by_twice_the_angle() {
        let one = SampledSpectrum::ONE;
        let light = StokesSpectrum::linear(one, one, DVec3::X, DVec3::Z);
        let angle = 30f64.to_radians();
        let turned = ReferenceFrame::new(DVec3::new(angle.cos(), angle.sin(), 0.0), DVec3::Z);
        let seen = light.in_frame(turned);
        let expected = [1.0, 0.5, -(0.75f32.sqrt()), 0.0];
        for (s, expected) in seen.s.iter().zip(expected) {
            assert!((s.hero() - expected).abs() < 1e-6, "{seen:?}");
        }
        let back = seen.in_frame(light.frame);
        assert!((back.s[1].hero() - 1.0).abs() < 1e-6 && back.s[2].hero().abs() < 1e-6, "{back:?}");
    }

    #[test]
    fn rounding_is_removed_and_nothing_else() {
        let of = |s0: f32| without_rounding(SampledSpectrum::splat(s0), SampledSpectrum::ONE).hero();
        assert_eq!([of(-1e-6), of(-1e-3), of(0.5)], [0.0, -1e-3, 0.5]);
        assert!(of(f32::NAN).is_nan());
    }
}
