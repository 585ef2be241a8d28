//! Fresnel's equations for smooth interfaces.
//!
//! For conductors the index is eta + i k, k >= 0 (Born and Wolf, sections 1.5 and 14.2). Light comes from vacuum or from
//! a transparent medium with real index. Amplitudes refer to the axes s, across the plane of incidence, and p = k x s:
//! r_s = (cos_i - u) / (cos_i + u), r_p = (eta^2 cos_i - u) / (eta^2 cos_i + u) with u = eta cos_t, complex where need
//! be, with an imaginary part that is not negative. At normal incidence therefore r_p = -r_s. Effects are stated as
//! [`DiattenuatingRetarder`] with the axis s.

use arsc_spectral::SampledSpectrum;

use crate::polarisation::DiattenuatingRetarder;

/// Reflection and refraction at a dielectric interface, for one wavelength and angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// Reflectances along s and p.
    pub rs: f64,
    pub rp: f64,
    /// Real and imaginary part of r_s r_p*.
    cross: [f64; 2],
    /// Cosine of the refracted ray; zero for total reflection, where the reflectances are 1.
    pub cos_t: f64,
}

impl Interface {
    /// `cos_i` in [0, 1], `eta` the index beyond the interface over the index before it.
    #[inline]
    pub fn new(cos_i: f64, eta: f64) -> Interface {
        let sin2_i = 1.0 - cos_i * cos_i;
        let sin2_t = sin2_i / (eta * eta);
        if sin2_t >= 1.0 {
            // u = i |u|.
            let (real, imaginary) = (sin2_i, cos_i * (sin2_i - eta * eta).max(0.0).sqrt());
            let norm = real * real + imaginary * imaginary;
            let cross = [(real * real - imaginary * imaginary) / norm, 2.0 * real * imaginary / norm];
            return Interface { rs: 1.0, rp: 1.0, cross, cos_t: 0.0 };
        }
        let cos_t = (1.0 - sin2_t).sqrt();
        let rp = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
        let rs = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
        Interface { rs: rs * rs, rp: rp * rp, cross: [rs * rp, 0.0], cos_t }
    }

    /// Of unpolarised light.
    #[inline]
    pub fn reflectance(&self) -> f64 {
        0.5 * (self.rs + self.rp)
    }

    /// The elements a, b, c, s of a [`DiattenuatingRetarder`].
    #[inline]
    pub fn reflection(&self) -> [f64; 4] {
        [self.reflectance(), 0.5 * (self.rs - self.rp), self.cross[0], self.cross[1]]
    }

    /// Likewise, for power that goes through the interface: without the change of radiance by the squared index.
    #[inline]
    pub fn refraction(&self) -> [f64; 4] {
        let (ts, tp) = (1.0 - self.rs, 1.0 - self.rp);
        [1.0 - self.reflectance(), 0.5 * (ts - tp), (ts * tp).max(0.0).sqrt(), 0.0]
    }
}

/// The effects at the four wavelengths, given by their elements, times a factor.
#[inline]
pub fn gather(elements: impl Fn(usize) -> [f64; 4], factor: f64) -> DiattenuatingRetarder {
    let (p, q, r, s) = (elements(0), elements(1), elements(2), elements(3));
    let at = |e: &[f64; 4], i: usize| (e[i] * factor) as f32;
    let of = |i: usize| SampledSpectrum(glam::Vec4::new(at(&p, i), at(&q, i), at(&r, i), at(&s, i)));
    DiattenuatingRetarder { a: of(0), b: of(1), c: of(2), s: of(3) }
}

/// Dielectric: `cos_i` in [0, 1], `eta` the index beyond the interface over the index before it. Gives the
/// reflectance for unpolarised light and the cosine of the refracted ray (zero for total reflection, where the
/// reflectance is 1).
#[inline]
pub fn dielectric(cos_i: f64, eta: f64) -> (f64, f64) {
    let interface = Interface::new(cos_i, eta);
    (interface.reflectance(), interface.cos_t)
}

/// Reflectance of a conductor against vacuum for unpolarised light: `cos_i` in [0, 1], index `eta` + i `k`.
#[inline]
pub fn conductor(cos_i: f32, eta: SampledSpectrum, k: SampledSpectrum) -> SampledSpectrum {
    conductor_reflection(cos_i, eta, k).a
}

/// Reflection by a conductor against vacuum.
#[inline]
pub fn conductor_reflection(cos_i: f32, eta: SampledSpectrum, k: SampledSpectrum) -> DiattenuatingRetarder {
    let cos2 = cos_i * cos_i;
    let sin2 = 1.0 - cos2;
    let splat = SampledSpectrum::splat;
    let positive_root = |x: SampledSpectrum| x.map(|x| x.max(0.0)).sqrt();
    let (eta2, k2) = (eta * eta, k * k);
    // u = a + i b.
    let t0 = eta2 - k2 - splat(sin2);
    let a2_plus_b2 = (t0 * t0 + eta2 * k2 * 4.0).sqrt();
    let a = positive_root((a2_plus_b2 + t0) * 0.5);
    let b = positive_root((a2_plus_b2 - t0) * 0.5);
    let t1 = a2_plus_b2 + splat(cos2);
    let t2 = a * (2.0 * cos_i);
    let rs = (t1 - t2) / (t1 + t2);
    let t3 = a2_plus_b2 * cos2 + splat(sin2 * sin2);
    let t4 = t2 * sin2;
    let rp = rs * ((t3 - t4) / (t3 + t4));
    let cross = rs / (t3 + t4);
    let c = cross * (splat(sin2 * sin2) - a2_plus_b2 * cos2);
    let s = cross * b * (2.0 * cos_i * sin2);
    let mean = ((rs + rp) * 0.5).map(|r| r.clamp(0.0, 1.0));
    DiattenuatingRetarder { a: mean, b: (rs - rp) * 0.5, c, s }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_reflects_four_percent_at_normal_incidence() {
        let (r, cos_t) = dielectric(1.0, 1.5);
        assert!((r - 0.04).abs() < 1e-15 && cos_t == 1.0);
        assert!((dielectric(1.0, 1.0 / 1.5).0 - r).abs() < 1e-15);
    }

    /// At Brewster's angle the parallel component vanishes: R = ((eta^2 - 1) / (eta^2 + 1))^2 / 2.
    #[test]
    fn brewsters_angle() {
        let eta = 1.5f64;
        let cos = (1.0 / (1.0 + eta * eta)).sqrt();
        let expected = 0.5 * ((eta * eta - 1.0) / (eta * eta + 1.0)).powi(2);
        assert!((dielectric(cos, eta).0 - expected).abs() < 1e-15);
    }

    /// Both ways through an interface the reflectance is the same at corresponding angles; beyond the critical angle it
    /// is 1, at grazing incidence as well.
    #[test]
    fn reflectance_is_reciprocal_and_total() {
        for i in 1..100 {
            let cos_i = f64::from(i) / 100.0;
            let (r, cos_t) = dielectric(cos_i, 1.5);
            assert!((dielectric(cos_t, 1.0 / 1.5).0 - r).abs() < 1e-12);
        }
        assert_eq!(dielectric(0.74, 1.0 / 1.5), (1.0, 0.0));
        assert!((dielectric(0.0, 1.5).0 - 1.0).abs() < 1e-15);
        assert!(dielectric(0.3, 1.0).0 < 1e-30);
    }

    #[test]
    fn a_conductor_without_absorption_is_a_dielectric() {
        for i in 0..=20 {
            let cos = i as f32 / 20.0;
            let metal = conductor(cos, SampledSpectrum::splat(1.5), SampledSpectrum::ZERO).hero();
            assert!((f64::from(metal) - dielectric(f64::from(cos), 1.5).0).abs() < 1e-6, "{cos}: {metal}");
        }
    }

    /// Complex amplitudes written out, with numbers as pairs: conductors, dielectrics from both sides, total reflection.
    #[test]
    fn effects_are_those_of_the_complex_amplitudes() {
        type C = [f64; 2];
        let mul = |a: C, b: C| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
        let div = |a: C, b: C| {
            let n = b[0] * b[0] + b[1] * b[1];
            [(a[0] * b[0] + a[1] * b[1]) / n, (a[1] * b[0] - a[0] * b[1]) / n]
        };
        let root = |a: C| {
            let r = a[0].hypot(a[1]);
            [(0.5 * (r + a[0])).max(0.0).sqrt(), (0.5 * (r - a[0])).max(0.0).sqrt()]
        };
        for (eta, k) in [(0.27, 2.95), (1.5, 0.0), (1.0 / 1.5, 0.0), (3.0, 0.5), (0.05, 4.0)] {
            for i in 1..=50 {
                let cos = f64::from(i) / 50.0;
                let index2 = mul([eta, k], [eta, k]);
                let u = root([index2[0] - (1.0 - cos * cos), index2[1]]);
                let rs = div([cos - u[0], -u[1]], [cos + u[0], u[1]]);
                let e = [index2[0] * cos, index2[1] * cos];
                let rp = div([e[0] - u[0], e[1] - u[1]], [e[0] + u[0], e[1] + u[1]]);
                let (s2, p2) = (rs[0] * rs[0] + rs[1] * rs[1], rp[0] * rp[0] + rp[1] * rp[1]);
                let cross = mul(rs, [rp[0], -rp[1]]);
                let exact = [0.5 * (s2 + p2), 0.5 * (s2 - p2), cross[0], cross[1]];
                let splat = |x: f64| SampledSpectrum::splat(x as f32);
                let DiattenuatingRetarder { a, b, c, s } = conductor_reflection(cos as f32, splat(eta), splat(k));
                let metal = [a, b, c, s].map(|x| f64::from(x.hero()));
                let glass = if k == 0.0 { Interface::new(cos, eta).reflection() } else { exact };
                for j in 0..4 {
                    assert!((metal[j] - exact[j]).abs() < 3e-5, "{eta} + {k} i at {cos}: {metal:?}, {exact:?}");
                    assert!((glass[j] - exact[j]).abs() < 1e-12, "{eta} at {cos}: {glass:?}, {exact:?}");
                }
            }
        }
    }

    /// Fresnel's rhomb: two total reflections in glass of index 1.51 at 54 degrees 37 minutes (or 48 degrees 37 minutes)
    /// put s and p a quarter of a wave apart (Born and Wolf, section 1.5.4).
    #[test]
    fn two_total_reflections_make_a_quarter_wave() {
        for degrees in [54.0 + 37.0 / 60.0, 48.0 + 37.0 / 60.0] {
            let [a, b, c, s] = Interface::new(f64::to_radians(degrees).cos(), 1.0 / 1.51).reflection();
            assert!(a == 1.0 && b == 0.0);
            assert!((s.atan2(c).to_degrees() - 45.0).abs() < 0.05, "{} degrees", s.atan2(c).to_degrees());
        }
    }

    /// What is not reflected goes through, for each component, and refraction out of the medium is alike.
    #[test]
    fn refraction_has_the_power_that_is_left() {
        let (cos_i, eta) = (0.4, 1.5);
        let one_way = Interface::new(cos_i, eta);
        let back = Interface::new(one_way.cos_t, 1.0 / eta);
        for (x, y) in one_way.refraction().iter().zip(back.refraction()) {
            assert!((x - y).abs() < 1e-12);
        }
        let ts = 2.0 * cos_i / (cos_i + eta * one_way.cos_t);
        let tp = 2.0 * cos_i / (eta * cos_i + one_way.cos_t);
        let power = eta * one_way.cos_t / cos_i;
        let exact = [0.5 * (ts * ts + tp * tp) * power, 0.5 * (ts * ts - tp * tp) * power, ts * tp * power, 0.0];
        for (x, exact) in one_way.refraction().iter().zip(exact) {
            assert!((x - exact).abs() < 1e-12);
        }
    }

    /// Normal incidence: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2). Gold at 589.3 nm (Johnson and Christy).
    #[test]
    fn gold_at_normal_incidence() {
        let (eta, k) = (0.2734f32, 2.948f32);
        let expected = ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
        let r = conductor(1.0, SampledSpectrum::splat(eta), SampledSpectrum::splat(k)).hero();
        assert!((r - expected).abs() < 1e-6, "{r} instead of {expected}");
        assert!((conductor(0.0, SampledSpectrum::splat(eta), SampledSpectrum::splat(k)).hero() - 1.0).abs() < 1e-6);
    }
}
