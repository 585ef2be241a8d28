//! Double-double arithmetic: some 106 bits (Dekker 1971; Hida, Li and Bailey 2001). No fused multiply-add.

use std::ops::{Add, Mul, Neg, Sub};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dd {
    hi: f64,
    lo: f64,
}

/// a + b exactly.
fn two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    let bb = hi - a;
    Dd { hi, lo: (a - (hi - bb)) + (b - bb) }
}

/// The same for |a| >= |b|.
fn quick_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    Dd { hi, lo: b - (hi - a) }
}

/// Halves of 26 bits.
fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a;
    let high = t - (t - a);
    (high, a - high)
}

/// a b exactly.
fn two_product(a: f64, b: f64) -> Dd {
    let hi = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    Dd { hi, lo: ((ah * bh - hi) + ah * bl + al * bh) + al * bl }
}

impl Dd {
    pub const ZERO: Dd = Dd { hi: 0.0, lo: 0.0 };

    pub fn to_f64(self) -> f64 {
        self.hi
    }
}

/// What the definitions of the shapes need of a number: plain doubles tell where it is clear, double-doubles where it is not.
pub trait Number:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    fn to_f64(self) -> f64;
    fn sqrt(self) -> Self;
    fn over(self, b: Self) -> Self;

    fn abs(self) -> Self {
        if self.to_f64() < 0.0 { -self } else { self }
    }

    fn max(self, other: Self) -> Self {
        if (self - other).to_f64() < 0.0 { other } else { self }
    }

    fn squared(self) -> Self {
        self * self
    }
}

impl Number for f64 {
    fn to_f64(self) -> f64 {
        self
    }

    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    fn over(self, b: f64) -> f64 {
        self / b
    }
}

impl Number for Dd {
    fn to_f64(self) -> f64 {
        self.hi
    }

    fn sqrt(self) -> Dd {
        if self.hi <= 0.0 {
            return Dd::ZERO;
        }
        let root = self.hi.sqrt();
        let rest = self - two_product(root, root);
        quick_sum(root, rest.hi / (2.0 * root))
    }

    fn over(self, b: Dd) -> Dd {
        let first = self.hi / b.hi;
        let rest = self - b * first;
        let second = rest.hi / b.hi;
        let rest = rest - b * second;
        quick_sum(first, second) + Dd::from(rest.hi / b.hi)
    }
}

impl From<f64> for Dd {
    fn from(x: f64) -> Dd {
        Dd { hi: x, lo: 0.0 }
    }
}

impl Add for Dd {
    type Output = Dd;
    fn add(self, b: Dd) -> Dd {
        let s = two_sum(self.hi, b.hi);
        let t = two_sum(self.lo, b.lo);
        let s = quick_sum(s.hi, s.lo + t.hi);
        quick_sum(s.hi, s.lo + t.lo)
    }
}

impl Neg for Dd {
    type Output = Dd;
    fn neg(self) -> Dd {
        Dd { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Dd {
    type Output = Dd;
    fn sub(self, b: Dd) -> Dd {
        self + -b
    }
}

impl Mul for Dd {
    type Output = Dd;
    fn mul(self, b: Dd) -> Dd {
        let p = two_product(self.hi, b.hi);
        quick_sum(p.hi, p.lo + (self.hi * b.lo + self.lo * b.hi))
    }
}

impl Mul<f64> for Dd {
    type Output = Dd;
    fn mul(self, b: f64) -> Dd {
        let p = two_product(self.hi, b);
        quick_sum(p.hi, p.lo + self.lo * b)
    }
}

impl std::ops::Add<f64> for Dd {
    type Output = Dd;
    fn add(self, b: f64) -> Dd {
        self + Dd::from(b)
    }
}

impl std::ops::Sub<f64> for Dd {
    type Output = Dd;
    fn sub(self, b: f64) -> Dd {
        self + Dd::from(-b)
    }
}
