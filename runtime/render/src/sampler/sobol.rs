//! Owen-scrambled Sobol', two dimensions at a time.
//!
//! Every pair of dimensions is the first two dimensions of Sobol', with the order of the samples shuffled and each
//! coordinate Owen-scrambled by hashing (Burley 2020, "Practical hash-based Owen scrambling"; the hash is Vegdahl's
//! improvement of the one by Laine and Karras). Pairs and pixels have independent hash seeds, hence are
//! decorrelated; any power-of-two prefix of a pixel's samples is stratified in every pair.
//! Sobol's second coordinate is the product of the index with Pascal's triangle modulo two, which factors into five
//! steps of shift and exclusive or.

/// Both coordinates of the sample with this number, bit-reversed.
#[inline]
pub fn pair(reversed_index: u32, pair_seed: u32) -> [f64; 2] {
    let index = shuffled(reversed_index, pair_seed);
    let x = scramble(index, pair_seed ^ 0x5bd1_e995);
    let y = scramble(pascal(index), pair_seed ^ 0x1b56_c4e9);
    [fraction(x), fraction(y)]
}

/// The first coordinate of it.
#[inline]
pub fn single(reversed_index: u32, pair_seed: u32) -> f64 {
    fraction(scramble(shuffled(reversed_index, pair_seed), pair_seed ^ 0x5bd1_e995))
}

/// A sample's place in the order of a pair of dimensions.
#[inline]
fn shuffled(reversed_index: u32, pair_seed: u32) -> u32 {
    scramble(reversed_index, pair_seed).reverse_bits()
}

/// The binary fraction whose first digit is the lowest bit.
#[inline]
fn fraction(reversed_digits: u32) -> f64 {
    super::fraction(reversed_digits.reverse_bits())
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
        for (pair_seed, block) in [(0, 0), (0xdead_beef, 3), (9, 12_345u32)] {
            let samples = (0..64).map(|i| pair((block * 64 + i).reverse_bits(), pair_seed));
            let points: Vec<[f64; 2]> = samples.collect();
            for a in 0..=6u32 {
                let (columns, rows) = (f64::from(1u32 << a), f64::from(1u32 << (6 - a)));
                let mut cells: Vec<u32> =
                    points.iter().map(|p| (p[0] * columns) as u32 * (1 << (6 - a)) + (p[1] * rows) as u32).collect();
                cells.sort_unstable();
                assert_eq!(cells, (0..64).collect::<Vec<u32>>(), "seed {pair_seed}, block {block}, {columns} columns");
            }
        }
    }
}
