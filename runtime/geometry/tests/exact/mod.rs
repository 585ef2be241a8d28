//! Lines and polynomials in 320 bits: an oracle that shares nothing with the intersectors.
//!
//! A solid is a Boolean combination of polynomial inequalities in the parameter of the line. The coefficients are formed
//! from the exact double-precision inputs. The real roots of a polynomial are found between those of its derivative, by
//! signs and safeguarded Newton steps, to some 120 bits; a root where the sign does not change is none.

#![allow(dead_code)] // Each test binary uses its part.

use std::cmp::Ordering;

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use glam::DVec3;

pub type Big = FBig<HalfEven, 2>;

/// Precision of all numbers. A torus loses some 110 bits to cancellation for an origin 10⁸ sizes away.
const BITS: usize = 320;
/// Relative precision of roots, bits.
const ROOT_BITS: isize = 120;

pub fn big(x: f64) -> Big {
    Big::try_from(x).expect("finite").with_precision(BITS).value()
}

fn power_of_two(exponent: isize) -> Big {
    Big::from_parts(1.into(), exponent).with_precision(BITS).value()
}

fn sign(x: &Big) -> Ordering {
    x.cmp(&Big::ZERO)
}

fn abs(x: &Big) -> Big {
    if *x < Big::ZERO { -x.clone() } else { x.clone() }
}

/// Coefficients from the constant on.
#[derive(Clone, Debug)]
pub struct Poly(Vec<Big>);

impl Poly {
    pub fn constant(c: Big) -> Poly {
        Poly(vec![c])
    }

    pub fn linear(c0: f64, c1: f64) -> Poly {
        Poly(vec![big(c0), big(c1)])
    }

    pub fn squared(&self) -> Poly {
        self.times(self)
    }

    pub fn times(&self, other: &Poly) -> Poly {
        let mut product = vec![big(0.0); self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Poly(product)
    }

    pub fn scaled(&self, by: &Big) -> Poly {
        Poly(self.0.iter().map(|c| c * by).collect())
    }

    pub fn plus(&self, other: &Poly) -> Poly {
        let n = self.0.len().max(other.0.len());
        let at = |p: &Poly, i: usize| p.0.get(i).cloned().unwrap_or(big(0.0));
        Poly((0..n).map(|i| at(self, i) + at(other, i)).collect())
    }

    pub fn minus(&self, other: &Poly) -> Poly {
        self.plus(&other.scaled(&big(-1.0)))
    }

    pub fn eval(&self, t: &Big) -> Big {
        self.0.iter().rev().fold(big(0.0), |sum, c| sum * t + c)
    }

    fn derivative(&self) -> Poly {
        Poly(self.0.iter().enumerate().skip(1).map(|(i, c)| c * big(i as f64)).collect())
    }

    fn trimmed(&self) -> Poly {
        let degree = self.0.iter().rposition(|c| *c != Big::ZERO).unwrap_or(0);
        Poly(self.0[..=degree].to_vec())
    }

    /// Ascending parameters at which the sign changes.
    pub fn roots(&self) -> Vec<Big> {
        let poly = self.trimmed();
        let degree = poly.0.len() - 1;
        if degree == 0 {
            return vec![];
        }
        if degree == 1 {
            return vec![-&poly.0[0] / &poly.0[1]];
        }
        let derivative = poly.derivative();
        // All roots are below Cauchy's bound.
        let lead = abs(&poly.0[degree]);
        let bound = poly.0[..degree].iter().fold(big(0.0), |most, c| most.max(abs(c) / &lead)) + big(1.0);
        let mut points = vec![-bound.clone()];
        points.extend(derivative.roots());
        points.push(bound);
        let values: Vec<Ordering> = points.iter().map(|t| sign(&poly.eval(t))).collect();
        let mut roots = Vec::new();
        // The last point with a sign; a point that is a root to all our bits belongs to no piece.
        let mut from = 0;
        for to in 1..points.len() {
            if values[to] == Ordering::Equal {
                continue;
            }
            if values[from] != Ordering::Equal && values[from] != values[to] {
                roots.push(poly.root_between(&derivative, &points[from], &points[to], values[to]));
            }
            from = to;
        }
        roots
    }

    /// The root in a bracket with a sign change; `rising` is the sign at `b`.
    fn root_between(&self, derivative: &Poly, a: &Big, b: &Big, rising: Ordering) -> Big {
        let (mut a, mut b) = (a.clone(), b.clone());
        let half = big(0.5);
        let mut t = (&a + &b) * &half;
        for _ in 0..5000 {
            let value = self.eval(&t);
            match sign(&value) {
                Ordering::Equal => return t,
                s if s == rising => b = t.clone(),
                _ => a = t.clone(),
            }
            let slope = derivative.eval(&t);
            let newton = if slope == Big::ZERO { a.clone() } else { &t - value / slope };
            let next = if newton > a && newton < b { newton } else { (&a + &b) * &half };
            if abs(&(&next - &t)) <= abs(&next) * power_of_two(-ROOT_BITS) {
                return next;
            }
            t = next;
        }
        t
    }

    /// Where the polynomial is not positive.
    pub fn not_positive(&self) -> LineSet {
        let poly = self.trimmed();
        let lead = sign(&poly.0[poly.0.len() - 1]);
        let odd = poly.0.len().is_multiple_of(2);
        let before = match lead {
            Ordering::Equal => true,
            Ordering::Less => !odd,
            Ordering::Greater => odd,
        };
        LineSet { before, ends: poly.roots() }
    }
}

/// Union of intervals of the real line: inside before the first end or not, and every end changes that.
#[derive(Clone, Debug)]
pub struct LineSet {
    pub before: bool,
    pub ends: Vec<Big>,
}

impl LineSet {
    pub fn everything() -> LineSet {
        LineSet { before: true, ends: vec![] }
    }

    pub fn from_doubles(before: bool, ends: &[f64]) -> LineSet {
        LineSet { before, ends: ends.iter().map(|&t| big(t)).collect() }
    }

    fn combined(&self, other: &LineSet, keep: fn(bool, bool) -> bool) -> LineSet {
        let (mut a, mut b) = (self.before, other.before);
        let before = keep(a, b);
        let (mut i, mut j, mut now) = (0, 0, before);
        let mut ends = Vec::new();
        while i < self.ends.len() || j < other.ends.len() {
            let t = match (self.ends.get(i), other.ends.get(j)) {
                (Some(x), Some(y)) => x.min(y).clone(),
                (Some(x), None) => x.clone(),
                (None, Some(y)) => y.clone(),
                (None, None) => unreachable!("one of them goes on"),
            };
            while self.ends.get(i) == Some(&t) {
                a = !a;
                i += 1;
            }
            while other.ends.get(j) == Some(&t) {
                b = !b;
                j += 1;
            }
            if keep(a, b) != now {
                now = !now;
                ends.push(t);
            }
        }
        LineSet { before, ends }
    }

    pub fn and(&self, other: &LineSet) -> LineSet {
        self.combined(other, |a, b| a && b)
    }

    pub fn or(&self, other: &LineSet) -> LineSet {
        self.combined(other, |a, b| a || b)
    }

    /// Nothing of it, but for single points, lies outside of `other`.
    pub fn is_within(&self, other: &LineSet) -> bool {
        let rest = self.combined(other, |a, b| a && !b);
        !rest.before && rest.ends.is_empty()
    }
}

/// A line with exact double-precision origin and direction.
#[derive(Clone, Debug)]
pub struct Line {
    pub x: Poly,
    pub y: Poly,
    pub z: Poly,
}

impl Line {
    pub fn new(o: DVec3, d: DVec3) -> Line {
        Line { x: Poly::linear(o.x, d.x), y: Poly::linear(o.y, d.y), z: Poly::linear(o.z, d.z) }
    }

    /// x² + y²
    pub fn ring(&self) -> Poly {
        self.x.squared().plus(&self.y.squared())
    }

    /// x² + y² + z²
    pub fn square(&self) -> Poly {
        self.ring().plus(&self.z.squared())
    }

    /// `low <= z <= high`
    pub fn slab(&self, low: &Big, high: &Big) -> LineSet {
        between(&self.z, low, high)
    }
}

/// Where `low <= p <= high`.
pub fn between(p: &Poly, low: &Big, high: &Big) -> LineSet {
    let above = Poly::constant(low.clone()).minus(p).not_positive();
    above.and(&p.minus(&Poly::constant(high.clone())).not_positive())
}
