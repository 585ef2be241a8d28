//! Mueller matrices of scattering, and of paths, at the wavelengths of a path.

use std::ops::Mul;

use arsc_spectral::SampledSpectrum;
use glam::DVec3;

use super::stokes::without_rounding;
use super::{DiattenuatingRetarder, Mueller, ReferenceFrame, StokesSpectrum};
use crate::frame::Frame;

const ZERO: SampledSpectrum = SampledSpectrum::ZERO;

/// A matrix between the frames of the light that leaves and of the light that arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MuellerSpectrum {
    /// `[row][column]`.
    pub m: [[SampledSpectrum; 4]; 4],
    pub outgoing: ReferenceFrame,
    pub incoming: ReferenceFrame,
}

impl MuellerSpectrum {
    /// The same effect on light described in another incoming frame.
    #[inline]
    fn with_incoming(&self, frame: ReferenceFrame) -> MuellerSpectrum {
        let [cos, sin] = frame.doubled_angle_to(&self.incoming);
        let mut m = self.m;
        for row in &mut m {
            (row[1], row[2]) = (row[1] * cos - row[2] * sin, row[1] * sin + row[2] * cos);
        }
        MuellerSpectrum { m, outgoing: self.outgoing, incoming: frame }
    }

    /// The same effect described in another outgoing frame.
    #[inline]
    fn with_outgoing(&self, frame: ReferenceFrame) -> MuellerSpectrum {
        let [cos, sin] = self.outgoing.doubled_angle_to(&frame);
        let mut m = self.m;
        let [_, s1, s2, _] = &mut m;
        for (s1, s2) in s1.iter_mut().zip(s2) {
            (*s1, *s2) = (*s1 * cos + *s2 * sin, *s2 * cos - *s1 * sin);
        }
        MuellerSpectrum { m, outgoing: frame, incoming: self.incoming }
    }

    #[inline]
    fn map(mut self, f: impl Fn(SampledSpectrum) -> SampledSpectrum) -> MuellerSpectrum {
        for element in self.m.as_flattened_mut() {
            *element = f(*element);
        }
        self
    }
}

impl Mul<f32> for MuellerSpectrum {
    type Output = MuellerSpectrum;
    #[inline]
    fn mul(self, factor: f32) -> MuellerSpectrum {
        self.map(|m| m * factor)
    }
}

impl Mul<SampledSpectrum> for MuellerSpectrum {
    type Output = MuellerSpectrum;
    #[inline]
    fn mul(self, factor: SampledSpectrum) -> MuellerSpectrum {
        self.map(|m| m * factor)
    }
}

impl Mueller for MuellerSpectrum {
    type Stokes = StokesSpectrum;

    #[inline]
    fn identity(x: DVec3, k: DVec3) -> MuellerSpectrum {
        let frame = ReferenceFrame::new(x, k);
        let mut m = [[ZERO; 4]; 4];
        for (i, row) in m.iter_mut().enumerate() {
            row[i] = SampledSpectrum::ONE;
        }
        MuellerSpectrum { m, outgoing: frame, incoming: frame }
    }

    #[inline]
    fn depolariser(factor: SampledSpectrum) -> MuellerSpectrum {
        let mut m = [[ZERO; 4]; 4];
        m[0][0] = factor;
        MuellerSpectrum { m, outgoing: ReferenceFrame::default(), incoming: ReferenceFrame::default() }
    }

    #[inline]
    fn diattenuating_retarder(effect: &DiattenuatingRetarder, axis: DVec3, wo: DVec3, wi: DVec3) -> MuellerSpectrum {
        let DiattenuatingRetarder { a, b, c, s } = *effect;
        MuellerSpectrum {
            m: [[a, b, ZERO, ZERO], [b, a, ZERO, ZERO], [ZERO, ZERO, c, s * -1.0], [ZERO, ZERO, s, c]],
            outgoing: ReferenceFrame::new(axis, wo),
            incoming: ReferenceFrame::new(axis, -wi),
        }
    }

    #[inline]
    fn from_elements(
        elements: impl Fn(usize, usize) -> SampledSpectrum,
        axes: [DVec3; 2],
        wo: DVec3,
        wi: DVec3,
    ) -> MuellerSpectrum {
        let mut m = [[ZERO; 4]; 4];
        for (i, j) in (0..16).map(|k| (k / 4, k % 4)) {
            m[i][j] = elements(i, j);
        }
        MuellerSpectrum { m, outgoing: ReferenceFrame::new(axes[0], wo), incoming: ReferenceFrame::new(axes[1], -wi) }
    }

    #[inline]
    fn intensity(&self) -> SampledSpectrum {
        self.m[0][0]
    }

    #[inline]
    fn then(&self, inner: &MuellerSpectrum) -> MuellerSpectrum {
        let outer = self.with_incoming(inner.outgoing);
        let mut m = [[ZERO; 4]; 4];
        for (row, left) in m.iter_mut().zip(&outer.m) {
            for (l, right) in left.iter().zip(&inner.m) {
                for (sum, r) in row.iter_mut().zip(right) {
                    *sum += *l * *r;
                }
            }
        }
        MuellerSpectrum { m, outgoing: self.outgoing, incoming: inner.incoming }
    }

    #[inline]
    fn plus(&self, other: &MuellerSpectrum) -> MuellerSpectrum {
        // A frame that is free takes that of the other.
        let choose = |a: ReferenceFrame, b: ReferenceFrame| if a == ReferenceFrame::default() { b } else { a };
        let (outgoing, incoming) = (choose(self.outgoing, other.outgoing), choose(self.incoming, other.incoming));
        let mut sum = self.with_outgoing(outgoing).with_incoming(incoming);
        let other = other.with_outgoing(outgoing).with_incoming(incoming);
        for (sum, more) in sum.m.as_flattened_mut().iter_mut().zip(other.m.as_flattened()) {
            *sum += *more;
        }
        sum
    }

    #[inline]
    fn apply(&self, light: &StokesSpectrum) -> StokesSpectrum {
        let s = light.in_frame(self.incoming).s;
        let of = |row: &[SampledSpectrum; 4]| row[0] * s[0] + row[1] * s[1] + row[2] * s[2] + row[3] * s[3];
        let mut out = [of(&self.m[0]), of(&self.m[1]), of(&self.m[2]), of(&self.m[3])];
        out[0] = without_rounding(out[0], self.m[0][0] * s[0]);
        StokesSpectrum { s: out, frame: self.outgoing }
    }

    #[inline]
    fn to_world(self, frame: &Frame) -> MuellerSpectrum {
        MuellerSpectrum { m: self.m, outgoing: self.outgoing.to_world(frame), incoming: self.incoming.to_world(frame) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polarisation::Stokes;

    fn polariser(angle: f64) -> MuellerSpectrum {
        let half = SampledSpectrum::splat(0.5);
        let effect = DiattenuatingRetarder { a: half, b: half, c: ZERO, s: ZERO };
        let axis = DVec3::new(angle.cos(), angle.sin(), 0.0);
        MuellerSpectrum::diattenuating_retarder(&effect, axis, DVec3::Z, -DVec3::Z)
    }

    /// A retarder whose component across the axis lags by a phase.
    fn retarder(angle: f64, phase: f64) -> MuellerSpectrum {
        let one = SampledSpectrum::ONE;
        let effect =
            DiattenuatingRetarder { a: one, b: ZERO, c: one * phase.cos() as f32, s: one * phase.sin() as f32 };
        let axis = DVec3::new(angle.cos(), angle.sin(), 0.0);
        MuellerSpectrum::diattenuating_retarder(&effect, axis, DVec3::Z, -DVec3::Z)
    }

    /// Malus: half of unpolarised light passes the first polariser, the squared cosine of that the second. Crossed, the
    /// rest is zero and never negative.
    #[test]
    fn malus() {
        for degrees in 0..=180 {
            let angle = f64::from(degrees).to_radians();
            let both = polariser(0.3 + angle).then(&polariser(0.3));
            let seen = both.apply(&StokesSpectrum::unpolarised(SampledSpectrum::ONE)).intensity().hero();
            assert!((f64::from(seen) - 0.5 * angle.cos().powi(2)).abs() < 1e-6 && seen >= 0.0, "{degrees}: {seen}");
        }
    }

    /// A chain applied at once and link by link; a third polariser at 45 degrees opens two crossed ones: 1/8.
    #[test]
    fn chains_are_associative() {
        let light = StokesSpectrum::unpolarised(SampledSpectrum::ONE);
        let links = [polariser(0.0), polariser(std::f64::consts::FRAC_PI_4), polariser(std::f64::consts::FRAC_PI_2)];
        let whole = links[2].then(&links[1]).then(&links[0]).apply(&light);
        let stepwise = links[2].apply(&links[1].apply(&links[0].apply(&light)));
        for (a, b) in whole.s.iter().zip(stepwise.s) {
            assert!((a.hero() - b.hero()).abs() < 1e-6);
        }
        assert!((whole.intensity().hero() - 0.125).abs() < 1e-6);
    }

    /// A quarter-wave plate at 45 degrees makes linear light circular; two of them make a half-wave plate, which
    /// turns linear light by 90 degrees; a plate along the light's own axis does nothing.
    #[test]
    fn retarders() {
        let light = polariser(0.0).apply(&StokesSpectrum::unpolarised(SampledSpectrum::splat(2.0)));
        let quarter = retarder(std::f64::consts::FRAC_PI_4, std::f64::consts::FRAC_PI_2);
        let circular = quarter.apply(&light);
        assert!((circular.s[3].hero().abs() - 1.0).abs() < 1e-6, "{circular:?}");
        let turned = quarter.apply(&circular).in_frame(light.frame);
        assert!((turned.s[1].hero() + 1.0).abs() < 1e-6, "{turned:?}");
        let same = retarder(0.0, 1.1).apply(&light).in_frame(light.frame);
        assert!((same.s[1].hero() - 1.0).abs() < 1e-6, "{same:?}");
    }

    /// Sums do not depend on the frames of their terms.
    #[test]
    fn sums_agree_with_sums_of_light() {
        let light = retarder(0.4, 0.9).apply(&polariser(0.2).apply(&StokesSpectrum::unpolarised(SampledSpectrum::ONE)));
        let (a, b) = (polariser(0.7), retarder(1.9, 2.0));
        let sum = a.plus(&b).apply(&light);
        let mut expected = a.apply(&light);
        expected += b.apply(&light).in_frame(expected.frame);
        for (x, y) in sum.in_frame(expected.frame).s.iter().zip(expected.s) {
            assert!((x.hero() - y.hero()).abs() < 1e-6);
        }
        let depolarised = MuellerSpectrum::depolariser(SampledSpectrum::ONE).plus(&a).apply(&light);
        assert!((depolarised.intensity().hero() - 0.5 - a.apply(&light).intensity().hero()).abs() < 1e-6);
    }
}
