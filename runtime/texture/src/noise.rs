//! Gradient noise.
//!
//! Perlin 2002, "Improving noise": gradients along the twelve edges of the cube at the integer lattice, blended by
//! 6t⁵ - 15t⁴ + 10t³, twice continuously differentiable, zero at the lattice. The gradients are chosen by a hash of the lattice
//! point and a seed instead of a table of 256 entries, so that nothing repeats. Fractal sums after Musgrave, in Ebert
//! and others 2003, "Texturing and Modeling", chapter 16.

use glam::DVec3;

/// |noise| stays below it. The largest value is 1.0363…: the blend of four edge gradients in the middle of a face's
/// neighbourhood.
pub const PERLIN_BOUND: f64 = 1.04;

pub const MAX_OCTAVES: u32 = 32;

/// A kind of noise; octave i is the noise at the place scaled by `lacunarity`^i with weight `gain`^i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Noise {
    Perlin {
        seed: u32,
    },
    /// Fractional Brownian motion: the sum of octaves.
    Fbm {
        seed: u32,
        octaves: u32,
        lacunarity: f64,
        gain: f64,
    },
    /// The sum of the absolute values of octaves.
    Turbulence {
        seed: u32,
        octaves: u32,
        lacunarity: f64,
        gain: f64,
    },
}

impl Noise {
    pub fn at(&self, p: DVec3) -> f64 {
        match *self {
            Noise::Perlin { seed } => perlin(p, seed),
            Noise::Fbm { seed, octaves, lacunarity, gain } => sum(p, seed, octaves, lacunarity, gain, |x| x),
            Noise::Turbulence { seed, octaves, lacunarity, gain } => sum(p, seed, octaves, lacunarity, gain, f64::abs),
        }
    }

    /// No value is larger in magnitude.
    pub fn bound(&self) -> f64 {
        match *self {
            Noise::Perlin { .. } => PERLIN_BOUND,
            Noise::Fbm { octaves, gain, .. } | Noise::Turbulence { octaves, gain, .. } => {
                (0..octaves.min(MAX_OCTAVES)).map(|i| PERLIN_BOUND * gain.abs().powi(i as i32)).sum()
            }
        }
    }
}

fn sum(p: DVec3, seed: u32, count: u32, lacunarity: f64, gain: f64, shape: fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    octaves(p, seed, count, lacunarity, gain, |p, seed, weight, _| sum += weight * shape(perlin(p, seed)));
    sum
}

/// Calls `visit` with the place, the seed, the weight and the frequency of each octave.
pub(crate) fn octaves(
    mut p: DVec3,
    seed: u32,
    count: u32,
    lacunarity: f64,
    gain: f64,
    mut visit: impl FnMut(DVec3, u32, f64, f64),
) {
    let (mut weight, mut frequency) = (1.0, 1.0);
    for octave in 0..count.min(MAX_OCTAVES) {
        // A lattice of its own for each octave: all would be zero at the origin.
        visit(p, seed.wrapping_add(octave.wrapping_mul(0x9E37_79B9)), weight, frequency);
        p *= lacunarity;
        weight *= gain;
        frequency *= lacunarity;
    }
}

/// The cell of a point.
struct Cell {
    corner: [u64; 3],
    /// The point within it, from 0 to 1.
    f: DVec3,
    seed: u64,
}

impl Cell {
    /// `None` beyond 2^52, where doubles have no fractions.
    #[inline]
    fn of(p: DVec3, seed: u32) -> Option<Cell> {
        const FAR: f64 = 4_503_599_627_370_496.0;
        if !p.abs().cmplt(DVec3::splat(FAR)).all() {
            return None;
        }
        let corner = p.floor();
        let seed = u64::from(seed).wrapping_mul(0xD6E8_FEB8_6659_FD93);
        Some(Cell { corner: corner.to_array().map(|c| c as i64 as u64), f: p - corner, seed })
    }

    #[inline]
    fn hash(&self, i: u64, j: u64, k: u64) -> u64 {
        let [x, y, z] = self.corner;
        hash(x.wrapping_add(i), y.wrapping_add(j), z.wrapping_add(k), self.seed)
    }
}

/// [`perlin`] and its gradient.
pub(crate) fn perlin_gradient(p: DVec3, seed: u32) -> (f64, DVec3) {
    let Some(cell) = Cell::of(p, seed) else { return (0.0, DVec3::ZERO) };
    let f = cell.f;
    let blend = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let slope = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    let (mut value, mut sum) = (0.0, DVec3::ZERO);
    for corner in 0..8u64 {
        let bits = [corner & 1, corner >> 1 & 1, corner >> 2];
        let offset = DVec3::from_array(bits.map(|bit| bit as f64));
        let hash = cell.hash(bits[0], bits[1], bits[2]);
        let edge = DVec3::new(gradient(hash, DVec3::X), gradient(hash, DVec3::Y), gradient(hash, DVec3::Z));
        let along = edge.dot(f - offset);
        // Blend weights of the corner and their derivatives, by axis.
        let w = DVec3::ONE - offset + (2.0 * offset - 1.0) * blend;
        let dw = (2.0 * offset - 1.0) * slope;
        value += w.x * w.y * w.z * along;
        sum += DVec3::new(dw.x * w.y * w.z, w.x * dw.y * w.z, w.x * w.y * dw.z) * along + edge * (w.x * w.y * w.z);
    }
    (value, sum)
}

/// Noise at a point; mean 0 over space, feature size 1. Zero beyond 2^52.
pub fn perlin(p: DVec3, seed: u32) -> f64 {
    let Some(cell) = Cell::of(p, seed) else { return 0.0 };
    let f = cell.f;
    let blend = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let corner = |i: u64, j: u64, k: u64| gradient(cell.hash(i, j, k), f - DVec3::new(i as f64, j as f64, k as f64));
    let lerp = |a: f64, b: f64, t: f64| a + t * (b - a);
    let row = |j, k| lerp(corner(0, j, k), corner(1, j, k), blend.x);
    let plane = |k| lerp(row(0, k), row(1, k), blend.y);
    lerp(plane(0), plane(1), blend.z)
}

/// Mixes a lattice point: odd multipliers, then the finaliser of Steele, Lea and Flood 2014 ("Fast splittable
/// pseudorandom number generators").
fn hash(x: u64, y: u64, z: u64, seed: u64) -> u64 {
    let mut h = x
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add(y.wrapping_mul(0xC2B2_AE3D_27D4_EB4F))
        .wrapping_add(z.wrapping_mul(0x1656_67B1_9E37_79F9))
        .wrapping_add(seed);
    h = (h ^ (h >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    h ^ (h >> 31)
}

/// The product of `v` with one of the twelve edges of the cube.
fn gradient(hash: u64, v: DVec3) -> f64 {
    let signed = |x: f64, bit: u64| if hash & bit == 0 { x } else { -x };
    // A third of the hashes for each axis that the edge has no part of.
    match (hash >> 32) % 3 {
        0 => signed(v.y, 1) + signed(v.z, 2),
        1 => signed(v.x, 1) + signed(v.z, 2),
        _ => signed(v.x, 1) + signed(v.y, 2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of an R2-like sequence in a box far from the lattice's symmetries.
    fn points(n: usize) -> impl Iterator<Item = DVec3> {
        let step = DVec3::new(0.819_172_513_396_164, 0.671_043_606_703_789, 0.549_700_477_901_9);
        (0..n).map(move |i| step * i as f64 * 1.37 - 400.0)
    }

    /// 200 000 points. The variance of the noise averaged over a cell: the mean of |gradient|² moments gives 0.0768 by
    /// quadrature of the blend; here within 3 %.
    #[test]
    fn mean_variance_and_bound() {
        let n = 200_000;
        let (mut sum, mut squares, mut largest) = (0.0, 0.0, 0.0f64);
        for p in points(n) {
            let x = perlin(p, 7);
            sum += x;
            squares += x * x;
            largest = largest.max(x.abs());
        }
        let (mean, variance) = (sum / n as f64, squares / n as f64);
        assert!(mean.abs() < 4.0 * (variance / n as f64).sqrt() * 3.0, "{mean}");
        assert!((variance - expected_variance()).abs() < 0.03 * expected_variance(), "{variance}");
        assert!(largest < PERLIN_BOUND && largest > 0.8, "{largest}");
    }

    /// Gradients of different corners are independent with E[g gᵀ] = 2/3 I: the variance at a point of a cell is the sum
    /// over corners of the squared weight times 2/3 of the squared distance. Its mean by the midpoint rule.
    fn expected_variance() -> f64 {
        const N: usize = 24;
        let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let mut sum = 0.0;
        for i in 0..N * N * N {
            let f = [i % N, i / N % N, i / N / N].map(|k| (k as f64 + 0.5) / N as f64);
            for corner in 0..8 {
                let bits = [corner & 1, corner >> 1 & 1, corner >> 2].map(f64::from);
                let (mut weight, mut distance2) = (1.0, 0.0);
                for axis in 0..3 {
                    weight *= if bits[axis] == 0.0 { 1.0 - fade(f[axis]) } else { fade(f[axis]) };
                    distance2 += (f[axis] - bits[axis]).powi(2);
                }
                sum += weight * weight * distance2 * 2.0 / 3.0;
            }
        }
        sum / (N * N * N) as f64
    }

    #[test]
    fn zero_at_the_lattice_smooth_across_it_and_never_repeating() {
        for p in [DVec3::ZERO, DVec3::new(3.0, -7.0, 255.0), DVec3::splat(-1e6)] {
            assert_eq!(perlin(p, 1), 0.0);
            // The derivative is continuous across the faces of cells.
            let h = 1e-5;
            let at = |t: f64| perlin(p + DVec3::new(t, 0.31, 0.47), 1);
            let (left, right) = ((at(0.0) - at(-h)) / h, (at(h) - at(0.0)) / h);
            assert!((left - right).abs() < 1e-3, "{left} {right}");
        }
        let period = points(50).filter(|p| (perlin(*p, 1) - perlin(*p + DVec3::X * 256.0, 1)).abs() < 1e-9).count();
        assert!(period < 5, "{period}");
        assert!(points(50).any(|p| perlin(p, 1) != perlin(p, 2)));
        assert_eq!(perlin(DVec3::splat(1e300), 0), 0.0);
        assert_eq!(perlin(DVec3::NAN, 0), 0.0);
    }

    #[test]
    fn fractal_sums_are_those_of_their_octaves() {
        let p = DVec3::new(0.3, 1.7, -2.2);
        let octaves: Vec<f64> =
            (0..3).map(|i| perlin(p * 2f64.powi(i), 5u32.wrapping_add((i as u32).wrapping_mul(0x9E37_79B9)))).collect();
        let wanted = octaves[0] + 0.5 * octaves[1] + 0.25 * octaves[2];
        let fbm = Noise::Fbm { seed: 5, octaves: 3, lacunarity: 2.0, gain: 0.5 };
        assert!((fbm.at(p) - wanted).abs() < 1e-15);
        let turbulence = Noise::Turbulence { seed: 5, octaves: 3, lacunarity: 2.0, gain: 0.5 };
        let wanted = octaves[0].abs() + 0.5 * octaves[1].abs() + 0.25 * octaves[2].abs();
        assert!((turbulence.at(p) - wanted).abs() < 1e-15);
        assert!(points(2000).all(|p| fbm.at(p).abs() <= fbm.bound() && turbulence.at(p).abs() <= turbulence.bound()));
    }

    /// Written down once: pictures must not change.
    #[test]
    fn values_are_what_they_always_were() {
        let values: Vec<f64> = points(3).map(|p| perlin(p * 0.37, 0)).collect();
        assert_eq!(values, [0.0, -0.320_741_870_012_281_3, -0.526_232_156_914_884]);
    }
}
