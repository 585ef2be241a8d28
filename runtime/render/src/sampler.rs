//! Low-discrepancy samples, a pure function of (seed, pixel, sample, dimension).
//!
//! Every pair of dimensions is the first two dimensions of Sobol', with the order of the samples shuffled and each
//! coordinate Owen-scrambled by hashing (Burley 2020, "Practical hash-based Owen scrambling"; the hash is Vegdahl's
//! improvement of the one by Laine and Karras). Pairs and pixels have independent hash seeds, hence are
//! decorrelated; any power-of-two prefix of a pixel's samples is stratified in every pair. Neither samples nor
//! dimensions run out below 2^32.
//! Sobol's second coordinate is the product of the index with Pascal's triangle modulo two, which factors into five
//! steps of shift and exclusive or.

/// The samples of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    pixel_seed: u32,
    /// Bit-reversed sample number.
    reversed_index: u32,
}

impl Sampler {
    /// Sample number `index` of a pixel.
    #[inline]
    pub fn new(seed: u64, pixel: [u32; 2], index: u32) -> Sampler {
        let seed = mix(seed as u32 ^ mix((seed >> 32) as u32 ^ 0x9e37_79b9));
        let pixel_seed = mix(pixel[0] ^ mix(pixel[1] ^ seed));
        Sampler { pixel_seed, reversed_index: index.reverse_bits() }
    }

    /// Two coordinates in [0, 1) of pair number `pair`.
    #[inline]
    pub fn pair(&self, pair: u32) -> [f64; 2] {
        let (index, seed) = self.shuffled(pair);
        let x = scramble(index, seed ^ 0x5bd1_e995);
        let y = scramble(pascal(index), seed ^ 0x1b56_c4e9);
        [fraction(x), fraction(y)]
    }

    /// One coordinate in [0, 1): the first of pair number `pair`.
    #[inline]
    pub fn single(&self, pair: u32) -> f64 {
        let (index, seed) = self.shuffled(pair);
        fraction(scramble(index, seed ^ 0x5bd1_e995))
    }

    /// This sample's place in the order of a pair of dimensions, and the seed of that pair.
    #[inline]
    fn shuffled(&self, pair: u32) -> (u32, u32) {
        let seed = mix(self.pixel_seed ^ pair.wrapping_mul(0x9e37_79b9));
        (scramble(self.reversed_index, seed).reverse_bits(), seed)
    }
}

/// The binary fraction whose first digit is the lowest bit.
#[inline]
fn fraction(reversed_digits: u32) -> f64 {
    f64::from(reversed_digits.reverse_bits()) * (1.0 / 4_294_967_296.0)
}

/// Digits of Sobol's second coordinate of an index, the first one in the lowest bit. (Of the first coordinate they
/// are the index itself.)
#[inline]
fn pascal(mut bits: u32) -> u32 {
    bits ^= (bits & 0xffff_0000) >> 16;
    bits ^= (bits & 0xff00_ff00) >> 8;
    bits ^= (bits & 0xf0f0_f0f0) >> 4;
    bits ^= (bits & 0xcccc_cccc) >> 2;
    bits ^ (bits & 0xaaaa_aaaa) >> 1
}

/// A permutation in which each bit is changed by the lower ones alone: Owen scrambling of reversed digits.
#[inline]
fn scramble(mut bits: u32, seed: u32) -> u32 {
    bits ^= bits.wrapping_mul(0x3d20_adea);
    bits = bits.wrapping_add(seed);
    bits = bits.wrapping_mul((seed >> 16) | 1);
    bits ^= bits.wrapping_mul(0x0552_6c56);
    bits ^ bits.wrapping_mul(0x53a2_2864)
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

    /// The definition: digit j is the sum of C(k, j) over the set bits k of the index, modulo two (C(k, j) is odd when
    /// the bits of j are among those of k).
    #[test]
    fn pascal_is_the_matrix_of_sobols_second_coordinate() {
        for index in [0u32, 1, 2, 3, 5, 77, 0xdead_beef, u32::MAX] {
            let expected = (0..32u32).fold(0, |digits, j| {
                let parity = (0..32u32).filter(|k| index >> k & 1 == 1 && j & k == j).count() as u32 & 1;
                digits | parity << j
            });
            assert_eq!(pascal(index), expected, "{index}");
        }
    }

    /// Every block of 2^m samples is a (0, m, 2)-net: one point in each elementary interval.
    #[test]
    fn power_of_two_blocks_are_nets() {
        for (pair, block) in [(0, 0), (1, 3), (9, 12_345)] {
            let samples = (0..64).map(|i| Sampler::new(7, [3, 5], block * 64 + i).pair(pair));
            let points: Vec<[f64; 2]> = samples.collect();
            for a in 0..=6u32 {
                let (columns, rows) = (f64::from(1u32 << a), f64::from(1u32 << (6 - a)));
                let mut cells: Vec<u32> =
                    points.iter().map(|p| (p[0] * columns) as u32 * (1 << (6 - a)) + (p[1] * rows) as u32).collect();
                cells.sort_unstable();
                assert_eq!(cells, (0..64).collect::<Vec<u32>>(), "pair {pair}, block {block}, {columns} columns");
            }
        }
    }

    /// Products of coordinates of different pairs, pixels and seeds average to 1/4 over 4096 samples. Independent
    /// factors give a standard deviation of 0.0034: a bound of 0.017 is five of them, false-alarm rate 6e-7 each.
    #[test]
    fn pairs_pixels_and_seeds_are_decorrelated() {
        let base = |i| Sampler::new(1, [10, 20], i).pair(4);
        let others = [
            ("pair", 1, [10, 20], 5),
            ("column", 1, [11, 20], 4),
            ("row", 1, [10, 21], 4),
            ("transposed", 1, [20, 10], 4),
            ("seed", 1 << 32, [10, 20], 4),
        ];
        for (name, seed, pixel, pair) in others {
            let other = |i| Sampler::new(seed, pixel, i).pair(pair);
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let mean = (0..4096).map(|i| base(i)[a] * other(i)[b]).sum::<f64>() / 4096.0;
                assert!((mean - 0.25).abs() < 0.017, "{name}, coordinates {a} and {b}: {mean}");
            }
        }
    }

    #[test]
    fn single_is_the_first_of_the_pair() {
        let sampler = Sampler::new(3, [1, 2], 99);
        assert_eq!(sampler.single(6), sampler.pair(6)[0]);
    }
}
