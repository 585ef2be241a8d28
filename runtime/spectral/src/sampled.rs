//! Spectra at the four wavelengths of one path.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

use glam::Vec4;

/// Values at the four wavelengths of a [`crate::SampledWavelengths`]; component 0 belongs to the hero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampledSpectrum(pub Vec4);

impl SampledSpectrum {
    pub const ZERO: SampledSpectrum = SampledSpectrum(Vec4::ZERO);
    pub const ONE: SampledSpectrum = SampledSpectrum(Vec4::ONE);

    #[inline]
    pub fn splat(value: f32) -> SampledSpectrum {
        SampledSpectrum(Vec4::splat(value))
    }

    /// Only the hero's value; the others become zero.
    #[inline]
    pub fn hero_only(self) -> SampledSpectrum {
        SampledSpectrum(Vec4::new(self.0.x, 0.0, 0.0, 0.0))
    }

    #[inline]
    pub fn hero(self) -> f32 {
        self.0.x
    }

    #[inline]
    pub fn max(self) -> f32 {
        self.0.max_element()
    }

    #[inline]
    pub fn mean(self) -> f32 {
        self.0.element_sum() * 0.25
    }

    #[inline]
    pub fn is_black(self) -> bool {
        self.0 == Vec4::ZERO
    }

    /// The four values are one and the same.
    #[inline]
    pub fn is_flat(self) -> bool {
        self.0 == Vec4::splat(self.0.x)
    }

    /// Every component is finite and not negative.
    #[inline]
    pub fn is_valid(self) -> bool {
        // The comparison is false for NaN as well.
        self.0.cmpge(Vec4::ZERO).all() && self.0.cmplt(Vec4::INFINITY).all()
    }

    #[inline]
    pub fn sqrt(self) -> SampledSpectrum {
        SampledSpectrum(Vec4::new(self.0.x.sqrt(), self.0.y.sqrt(), self.0.z.sqrt(), self.0.w.sqrt()))
    }

    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> SampledSpectrum {
        SampledSpectrum(Vec4::from_array(self.0.to_array().map(f)))
    }
}

impl Add for SampledSpectrum {
    type Output = SampledSpectrum;
    #[inline]
    fn add(self, other: SampledSpectrum) -> SampledSpectrum {
        SampledSpectrum(self.0 + other.0)
    }
}

impl Sub for SampledSpectrum {
    type Output = SampledSpectrum;
    #[inline]
    fn sub(self, other: SampledSpectrum) -> SampledSpectrum {
        SampledSpectrum(self.0 - other.0)
    }
}

impl Mul for SampledSpectrum {
    type Output = SampledSpectrum;
    #[inline]
    fn mul(self, other: SampledSpectrum) -> SampledSpectrum {
        SampledSpectrum(self.0 * other.0)
    }
}

impl Div for SampledSpectrum {
    type Output = SampledSpectrum;
    #[inline]
    fn div(self, other: SampledSpectrum) -> SampledSpectrum {
        SampledSpectrum(self.0 / other.0)
    }
}

impl Mul<f32> for SampledSpectrum {
    type Output = SampledSpectrum;
    #[inline]
    fn mul(self, factor: f32) -> SampledSpectrum {
        SampledSpectrum(self.0 * factor)
    }
}

impl AddAssign for SampledSpectrum {
    #[inline]
    fn add_assign(&mut self, other: SampledSpectrum) {
        self.0 += other.0;
    }
}

impl MulAssign for SampledSpectrum {
    #[inline]
    fn mul_assign(&mut self, other: SampledSpectrum) {
        self.0 *= other.0;
    }
}

impl MulAssign<f32> for SampledSpectrum {
    #[inline]
    fn mul_assign(&mut self, factor: f32) {
        self.0 *= factor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validity_excludes_nan_infinity_and_negative_values() {
        assert!(SampledSpectrum::ZERO.is_valid());
        assert!(SampledSpectrum::splat(f32::MAX).is_valid());
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1e-20] {
            assert!(!SampledSpectrum(Vec4::new(1.0, 1.0, bad, 1.0)).is_valid(), "{bad}");
        }
    }

    #[test]
    fn flatness_is_exact() {
        assert!(SampledSpectrum::splat(1.5).is_flat());
        assert!(!SampledSpectrum(Vec4::new(1.5, 1.5, 1.5, 1.500_000_1)).is_flat());
    }
}
