//! Halton's sequence, scrambled.
//!
//! Coordinate d of sample i is the radical inverse of i in the d-th prime. Digits are scrambled from the first one on, by
//! x -> a x + c modulo the prime with a and c hashed from the dimension's seed and the digits before (Owen 1995 with the
//! affine permutations of Matousek 1998); the digits after the last one of 32-bit indices are one uniform number. So
//! any b^k consecutive samples from a multiple of b^k on fall into different intervals of width b^-k.

use super::{fraction, mix};

/// Bases of the first dimensions; those beyond are independent.
const PRIMES: [u32; 64] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103, 107, 109,
    113, 127, 131, 137, 139, 149, 151, 157, 163, 167, 173, 179, 181, 191, 193, 197, 199, 211, 223, 227, 229, 233, 239,
    241, 251, 257, 263, 269, 271, 277, 281, 283, 293, 307, 311,
];

/// The coordinate of a sample in one of the two dimensions of a pair.
pub fn coordinate(index: u32, pair: u32, coordinate: u32, pair_seed: u32) -> f64 {
    let dimension = pair.saturating_mul(2).saturating_add(coordinate) as usize;
    match PRIMES.get(dimension) {
        Some(&base) => scrambled_radical_inverse(base, index, mix(pair_seed ^ coordinate.wrapping_mul(0x85eb_ca6b))),
        None => super::independent(index, pair_seed, coordinate),
    }
}

fn scrambled_radical_inverse(base: u32, mut index: u32, seed: u32) -> f64 {
    let inverse_base = 1.0 / f64::from(base);
    let (mut value, mut place, mut prefix) = (0.0, 1.0, seed);
    // Every index has the same number of digits, so that equal beginnings are scrambled alike.
    let mut capacity = 1u64;
    while capacity < 1 << 32 {
        let digit = index % base;
        index /= base;
        let hash = mix(prefix);
        let (a, c) = (1 + (hash & 0xffff) % (base - 1).max(1), (hash >> 16) % base);
        let scrambled = (a * digit + c) % base;
        place *= inverse_base;
        value += f64::from(scrambled) * place;
        prefix = hash ^ mix(digit + 1);
        capacity *= u64::from(base);
    }
    (value + place * fraction(mix(prefix ^ 0x9e37_79b9))).min(1.0 - f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn radical_inverse(base: u32, mut index: u32) -> f64 {
        let (mut value, mut place) = (0.0, 1.0 / f64::from(base));
        while index > 0 {
            value += f64::from(index % base) * place;
            place /= f64::from(base);
            index /= base;
        }
        value
    }

    /// The scrambled points are the radical inverses with intervals exchanged: whoever shares k digits with another
    /// before, does so afterwards, and no more.
    #[test]
    fn scrambling_keeps_common_digits_of_radical_inverses() {
        for base in [2, 3, 5, 7, 311] {
            let common = |x: f64, y: f64| {
                let (mut x, mut y, mut digits) = (x, y, 0);
                while digits < 6 {
                    (x, y) = (x * f64::from(base), y * f64::from(base));
                    // Exact radical inverses lie on the edges of intervals: half a digit of the smallest place helps.
                    if (x + 1e-9).floor() != (y + 1e-9).floor() {
                        break;
                    }
                    (x, y) = (x - (x + 1e-9).floor(), y - (y + 1e-9).floor());
                    digits += 1;
                }
                digits
            };
            for i in 0..60 {
                for j in 0..i {
                    let plain = common(radical_inverse(base, i), radical_inverse(base, j));
                    let of = |index| scrambled_radical_inverse(base, index, 77);
                    assert_eq!(common(of(i), of(j)), plain, "base {base}, samples {i} and {j}");
                }
            }
        }
    }

    /// Aligned blocks of b^k samples have one in each interval of width b^-k, and b1 b2 samples one in each
    /// elementary rectangle of the first two bases.
    #[test]
    fn aligned_blocks_are_stratified() {
        for (dimension, power, block) in [(0, 5, 3), (1, 4, 0), (2, 3, 7), (10, 2, 1)] {
            let base = PRIMES[dimension];
            let n = base.pow(power);
            let sample = |i| coordinate(block * n + i, dimension as u32 / 2, dimension as u32 % 2, 99);
            let mut cells: Vec<u32> = (0..n).map(|i| (sample(i) * f64::from(n)) as u32).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..n).collect::<Vec<u32>>(), "base {base}");
        }
        let mut cells: Vec<u32> = (0..72)
            .map(|i| (coordinate(i, 0, 0, 5) * 8.0) as u32 * 9 + (coordinate(i, 0, 1, 5) * 9.0) as u32)
            .collect();
        cells.sort_unstable();
        assert_eq!(cells, (0..72).collect::<Vec<u32>>());
    }

    #[test]
    fn bases_are_the_first_primes() {
        let primes: Vec<u32> = (2..=311).filter(|n| (2..*n).all(|d| n % d != 0)).collect();
        assert_eq!(PRIMES.to_vec(), primes);
    }
}
