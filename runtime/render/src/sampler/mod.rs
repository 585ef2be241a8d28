//! Samples in the unit cube, a pure function of (seed, pixel, sample, dimension).
//!
//! Dimensions come in pairs, numbered from zero; every pair of every pixel is scrambled by a hash of its own. Neither
//! samples nor dimensions run out below 2^32. Three sequences:
//!
//! - *Sobol'* ([`sobol`]), the default: every pair a two-dimensional net, the pairs padded.
//! - *Halton* ([`halton`]): a prime base for each of the first dimensions, all stratified together; independent beyond.
//! - *Independent*: hashes, as plain Monte Carlo has it. Its variance estimates are unbiased.

mod halton;
mod sobol;

/// How the samples of a pixel are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleSequence {
    #[default]
    Sobol,
    Halton,
    Independent,
}

/// One sample of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    sequence: SampleSequence,
    pixel_seed: u32,
    /// The sample's number; bit-reversed for Sobol'.
    index: u32,
}

impl Sampler {
    /// Sample number `index` of a pixel, Sobol'.
    #[inline]
    pub fn new(seed: u64, pixel: [u32; 2], index: u32) -> Sampler {
        Sampler::of(SampleSequence::Sobol, seed, pixel, index)
    }

    /// Sample number `index` of a pixel.
    #[inline]
    pub fn of(sequence: SampleSequence, seed: u64, pixel: [u32; 2], index: u32) -> Sampler {
        let seed = mix(seed as u32 ^ mix((seed >> 32) as u32 ^ 0x9e37_79b9));
        let pixel_seed = mix(pixel[0] ^ mix(pixel[1] ^ seed));
        let index = if sequence == SampleSequence::Sobol { index.reverse_bits() } else { index };
        Sampler { sequence, pixel_seed, index }
    }

    /// Two coordinates in [0, 1) of pair number `pair`.
    #[inline]
    pub fn pair(&self, pair: u32) -> [f64; 2] {
        let seed = self.pair_seed(pair);
        match self.sequence {
            SampleSequence::Sobol => sobol::pair(self.index, seed),
            SampleSequence::Halton => [0, 1].map(|k| halton::coordinate(self.index, pair, k, seed)),
            SampleSequence::Independent => [0, 1].map(|k| independent(self.index, seed, k)),
        }
    }

    /// One coordinate in [0, 1): the first of pair number `pair`.
    #[inline]
    pub fn single(&self, pair: u32) -> f64 {
        let seed = self.pair_seed(pair);
        match self.sequence {
            SampleSequence::Sobol => sobol::single(self.index, seed),
            SampleSequence::Halton => halton::coordinate(self.index, pair, 0, seed),
            SampleSequence::Independent => independent(self.index, seed, 0),
        }
    }

    #[inline]
    fn pair_seed(&self, pair: u32) -> u32 {
        mix(self.pixel_seed ^ pair.wrapping_mul(0x9e37_79b9))
    }
}

/// A coordinate that knows nothing of the others.
fn independent(index: u32, pair_seed: u32, coordinate: u32) -> f64 {
    fraction(mix(index ^ mix(pair_seed ^ coordinate.wrapping_mul(0x85eb_ca6b))))
}

/// 2^-32 times the bits.
#[inline]
fn fraction(bits: u32) -> f64 {
    f64::from(bits) * (1.0 / 4_294_967_296.0)
}

/// A permutation with good avalanche (Wellons' search, "lowbias32").
#[inline]
fn mix(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEQUENCES: [SampleSequence; 3] = [SampleSequence::Sobol, SampleSequence::Halton, SampleSequence::Independent];

    /// Products of coordinates of different pairs, pixels and seeds average to 1/4 over 4096 samples. Independent
    /// factors give a standard deviation of 0.0034: a bound of 0.017 is five of them, false-alarm rate 6e-7 each.
    #[test]
    fn pairs_pixels_and_seeds_are_decorrelated() {
        for sequence in SEQUENCES {
            let base = |i| Sampler::of(sequence, 1, [10, 20], i).pair(4);
            let others = [
                ("pair", 1, [10, 20], 5),
                ("far pair", 1, [10, 20], 500),
                ("column", 1, [11, 20], 4),
                ("row", 1, [10, 21], 4),
                ("transposed", 1, [20, 10], 4),
                ("seed", 1 << 32, [10, 20], 4),
            ];
            for (name, seed, pixel, pair) in others {
                let other = |i| Sampler::of(sequence, seed, pixel, i).pair(pair);
                for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let mean = (0..4096).map(|i| base(i)[a] * other(i)[b]).sum::<f64>() / 4096.0;
                    assert!((mean - 0.25).abs() < 0.017, "{sequence:?}, {name}, coordinates {a} and {b}: {mean}");
                }
            }
        }
    }

    /// Moments up to the second and the mixed one, over 2^14 samples: five standard deviations of independent ones.
    #[test]
    fn coordinates_are_uniform() {
        for sequence in SEQUENCES {
            for pair in [0, 1, 7, 31, 100_000, u32::MAX] {
                let points = || (0..16_384).map(|i| Sampler::of(sequence, 3, [4, 9], i).pair(pair));
                let mean = |f: fn([f64; 2]) -> f64| points().map(f).sum::<f64>() / 16_384.0;
                assert!(points().flatten().all(|u| (0.0..1.0).contains(&u)));
                for (got, exact, deviation) in [
                    (mean(|u| u[0]), 0.5, 0.289),
                    (mean(|u| u[1]), 0.5, 0.289),
                    (mean(|u| u[0] * u[0]), 1.0 / 3.0, 0.298),
                    (mean(|u| u[0] * u[1]), 0.25, 0.22),
                ] {
                    assert!((got - exact).abs() < 5.0 * deviation / 128.0, "{sequence:?}, pair {pair}: {got}, {exact}");
                }
            }
        }
    }

    #[test]
    fn single_is_the_first_of_the_pair() {
        for sequence in SEQUENCES {
            let sampler = Sampler::of(sequence, 3, [1, 2], 99);
            assert_eq!(sampler.single(6), sampler.pair(6)[0]);
        }
    }
}
