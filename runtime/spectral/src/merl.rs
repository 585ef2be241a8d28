//! Measured isotropic reflection in the form of Matusik, Pfister, Brand and McMillan 2003, "A data-driven reflectance model" (the
//! MERL database).
//!
//! f in sr^-1, linear sRGB, over the half angle theta_h from the normal, and the angles theta_d, phi_d of the light about
//! the half vector (Rusinkiewicz 1998): 90 x 90 x 180 values a colour, theta_h denser towards 0 by a square root, the others even. Each value
//! stands at the lower corner of its cell, as in the authors' reader; between them the table is linear. phi_d and phi_d + pi are the same
//! (reciprocity). Values that were not measured are negative in files, and zero here.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

const HALF: usize = 90;
const DIFFERENCE: usize = 90;
const TURN: usize = 180;
const CELLS: usize = HALF * DIFFERENCE * TURN;

/// The scale of the file's red, green and blue.
const SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];

/// A table of reflection.
#[derive(Clone, PartialEq)]
pub struct MerlBrdf {
    /// `[theta_h][theta_d][phi_d]`.
    values: Box<[[f32; 3]]>,
}

impl fmt::Debug for MerlBrdf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("MerlBrdf")
    }
}

/// Why bytes are no such table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MerlError {
    /// The file states other sizes than 90, 90, 180.
    Size,
    /// The file holds fewer or more bytes than its sizes demand.
    Length,
}

impl fmt::Display for MerlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            MerlError::Size => "it does not begin with the sizes 90, 90, 180 of a MERL table",
            MerlError::Length => "it is not as long as a MERL table of 90 by 90 by 180 values of three colours",
        })
    }
}

impl std::error::Error for MerlError {}

impl MerlBrdf {
    /// From the bytes of a `.binary` file: three sizes as i32, then doubles, all red ones first; little-endian.
    ///
    /// # Errors
    /// Bytes of another form.
    pub fn parse(bytes: &[u8]) -> Result<MerlBrdf, MerlError> {
        let (head, data) = bytes.split_at_checked(12).ok_or(MerlError::Length)?;
        let sizes = head.as_chunks::<4>().0.iter().map(|&size| i32::from_le_bytes(size) as usize);
        if !sizes.eq([HALF, DIFFERENCE, TURN]) {
            return Err(MerlError::Size);
        }
        let (numbers, rest) = data.as_chunks::<8>();
        if numbers.len() != 3 * CELLS || !rest.is_empty() {
            return Err(MerlError::Length);
        }
        let value = |cell: usize, c: usize| {
            let value = (f64::from_le_bytes(numbers[c * CELLS + cell]) * SCALES[c]) as f32;
            if value.is_finite() { value.max(0.0) } else { 0.0 }
        };
        Ok(MerlBrdf { values: (0..CELLS).map(|cell| std::array::from_fn(|c| value(cell, c))).collect() })
    }

    /// A table of a function of theta_h, theta_d, phi_d (radians) that gives finite numbers, none negative.
    pub fn from_fn(f: impl Fn([f64; 3]) -> [f64; 3]) -> MerlBrdf {
        let at = |cell: usize| {
            let [half, difference, turn] = [cell / TURN / DIFFERENCE, cell / TURN % DIFFERENCE, cell % TURN];
            let theta_d = difference as f64 / DIFFERENCE as f64 * FRAC_PI_2;
            f([half_angle(half), theta_d, turn as f64 / TURN as f64 * PI]).map(|value| value as f32)
        };
        MerlBrdf { values: (0..CELLS).map(at).collect() }
    }

    /// f in linear sRGB. Angles in radians: `theta_h` and `theta_d` from 0 to pi / 2, any `phi_d`.
    #[inline]
    pub fn eval(&self, theta_h: f64, theta_d: f64, phi_d: f64) -> [f32; 3] {
        let half = (theta_h / FRAC_PI_2).clamp(0.0, 1.0).sqrt() * HALF as f64;
        let difference = (theta_d / FRAC_PI_2).clamp(0.0, 1.0) * DIFFERENCE as f64;
        let turn = (phi_d / PI).rem_euclid(1.0) * TURN as f64;
        let cell = |x: f64, last: usize| ((x as usize).min(last), (x - x.floor()) as f32);
        let ((h, h_part), (d, d_part)) = (cell(half, HALF - 1), cell(difference, DIFFERENCE - 1));
        let (t, t_part) = cell(turn, TURN - 1);
        let mut sum = [0.0; 3];
        for corner in 0..8 {
            let [up_h, up_d, up_t] = [corner & 1, corner >> 1 & 1, corner >> 2];
            let share = |up: usize, part: f32| if up == 1 { part } else { 1.0 - part };
            let weight = share(up_h, h_part) * share(up_d, d_part) * share(up_t, t_part);
            let (h, d, t) = ((h + up_h).min(HALF - 1), (d + up_d).min(DIFFERENCE - 1), (t + up_t) % TURN);
            let value = self.values[(h * DIFFERENCE + d) * TURN + t];
            (0..3).for_each(|c| sum[c] += value[c] * weight);
        }
        sum
    }

    /// For each of the cells of theta_h, by the angle at its lower end: mean of all colours over theta_d and phi_d.
    pub fn means_by_half_angle(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.values.chunks_exact(DIFFERENCE * TURN).enumerate().map(|(half, values)| {
            let sum: f64 = values.iter().map(|value| f64::from(value.iter().sum::<f32>())).sum();
            (half_angle(half), sum / (3 * values.len()) as f64)
        })
    }
}

/// The angle at which a cell of theta_h begins.
fn half_angle(cell: usize) -> f64 {
    (cell as f64 / HALF as f64).powi(2) * FRAC_PI_2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth([h, d, t]: [f64; 3]) -> [f64; 3] {
        [0.2 + h.cos().powi(20), 0.1 * d, 0.3 + 0.1 * (2.0 * t).sin()]
    }

    fn file() -> Vec<u8> {
        let mut bytes: Vec<u8> = [90i32, 90, 180].iter().flat_map(|size| size.to_le_bytes()).collect();
        for (c, scale) in SCALES.into_iter().enumerate() {
            for cell in 0..CELLS {
                let [h, d, t] = [cell / TURN / DIFFERENCE, cell / TURN % DIFFERENCE, cell % TURN];
                let angles = [half_angle(h), d as f64 / 90.0 * FRAC_PI_2, t as f64 / 180.0 * PI];
                bytes.extend((truth(angles)[c] / scale).to_le_bytes());
            }
        }
        bytes
    }

    /// A generated file of a known function comes back, at its knots and between them.
    #[test]
    fn files_come_back() {
        let bytes = file();
        let brdf = MerlBrdf::parse(&bytes).unwrap();
        assert_eq!(brdf, MerlBrdf::from_fn(truth));
        for angles in [[0.0, 0.0, 0.0], [0.1, 0.5, 1.0], [0.7, 1.2, 3.1], [0.02, 1.0, -2.0], [1.3, 0.3, 5.0]] {
            let (got, exact) = (brdf.eval(angles[0], angles[1], angles[2]), truth(angles));
            for c in 0..3 {
                assert!((f64::from(got[c]) - exact[c]).abs() < 3e-3, "{got:?} instead of {exact:?} at {angles:?}");
            }
        }
        assert_eq!(MerlBrdf::parse(&bytes[..bytes.len() - 1]), Err(MerlError::Length));
        assert_eq!(MerlBrdf::parse(&bytes[..11]), Err(MerlError::Length));
        let mut other = bytes;
        other[0] = 91;
        assert_eq!(MerlBrdf::parse(&other), Err(MerlError::Size));
    }
}
