//! When a Mueller matrix is physical (Cloude 1986): its coherency matrix, Hermitian and 4 x 4, has no negative eigenvalue. It
//! is then a sum of effects of amplitudes, and takes no light to more than completely polarised light.

use crate::polarisation::MuellerSpectrum;

type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Pauli's matrices in the order of the Stokes parameters: for S1 diag(1, -1), for S2 the real, for S3 the imaginary one.
const PAULI: [[[Complex; 2]; 2]; 4] = {
    let (o, one, minus, i, minus_i) = ([0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]);
    [[[one, o], [o, one]], [[one, o], [o, minus]], [[o, one], [one, o]], [[o, minus_i], [i, o]]]
};

/// The coherency matrix 1/2 sum m_ij sigma_i (x) sigma_j*, whose trace is 2 m_00.
fn coherency(m: &[[f64; 4]; 4]) -> [[Complex; 4]; 4] {
    let mut h = [[[0.0; 2]; 4]; 4];
    for (i, j) in (0..16).map(|k| (k / 4, k % 4)) {
        for (row, column) in (0..16).map(|k| (k / 4, k % 4)) {
            let a = PAULI[i][row / 2][column / 2];
            let [re, im] = PAULI[j][row % 2][column % 2];
            let product = times(a, [re, -im]);
            h[row][column][0] += 0.5 * m[i][j] * product[0];
            h[row][column][1] += 0.5 * m[i][j] * product[1];
        }
    }
    h
}

/// Whether a Hermitian matrix, with `shift` added to its diagonal, has a Cholesky decomposition.
fn is_positive(h: &[[Complex; 4]; 4], shift: f64) -> bool {
    let mut l = [[[0.0; 2]; 4]; 4];
    for column in 0..4 {
        for row in column..4 {
            let mut sum = h[row][column];
            for (&a, [re, im]) in l[row].iter().zip(l[column]).take(column) {
                let product = times(a, [re, -im]);
                sum = [sum[0] - product[0], sum[1] - product[1]];
            }
            if row == column {
                if sum[0] + shift <= 0.0 || sum[0].is_nan() {
                    return false;
                }
                l[row][row] = [(sum[0] + shift).sqrt(), 0.0];
            } else {
                l[row][column] = sum.map(|x| x / l[column][column][0]);
            }
        }
    }
    true
}

/// Panics where a matrix is not physical at a wavelength, but for rounding of 2e-6 of its intensity.
pub fn assert_physical(name: &str, mueller: &MuellerSpectrum) {
    for lane in 0..4 {
        let m = mueller.m.map(|row| row.map(|x| f64::from(x.0[lane])));
        let largest = m.iter().flatten().fold(0.0f64, |a, b| a.max(b.abs()));
        assert!(m.iter().flatten().all(|x| x.is_finite()), "{name}: {m:?}");
        assert!(largest <= m[0][0] * (1.0 + 1e-6), "{name}: {m:?}");
        assert!(m[0][0] == 0.0 || is_positive(&coherency(&m), 2e-6 * m[0][0]), "{name}: {m:?}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polarisers, retarders and their mixtures are physical; diag(1, 1, 1, -1), which turns only circular light over, is
    /// the textbook case of a matrix that makes no light overpolarised and is not physical; gain in S1 alone is neither.
    #[test]
    fn the_criterion_knows_the_textbook_cases() {
        let diagonal = |d: [f64; 4]| {
            let mut m = [[0.0; 4]; 4];
            (0..4).for_each(|i| m[i][i] = d[i]);
            m
        };
        let mut polariser = diagonal([0.5, 0.5, 0.0, 0.0]);
        (polariser[0][1], polariser[1][0]) = (0.5, 0.5);
        let mut rotation = diagonal([1.0, 0.6, 0.6, 1.0]);
        (rotation[1][2], rotation[2][1]) = (0.8, -0.8);
        let good = [polariser, rotation, diagonal([1.0, 1.0, -1.0, -1.0]), diagonal([1.0, 0.0, 0.0, 0.0])];
        assert!(good.iter().all(|m| is_positive(&coherency(m), 1e-12)));
        let bad = [diagonal([1.0, 1.0, 1.0, -1.0]), diagonal([1.0, 1.01, 0.0, 0.0])];
        assert!(bad.iter().all(|m| !is_positive(&coherency(m), 1e-6)));
    }
}
