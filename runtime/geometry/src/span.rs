//! Where a line is in a ball or an upright box: the two shapes that need no map, made for loops over many of them.
//!
//! Reciprocals of the direction are the caller's, computed once per line. [`Placed::crossings`](crate::Placed::crossings)
//! goes this way too, so that both give the same bits.

use glam::DVec3;

use crate::Crossings;

/// Entry through face `f0` at `t0`, exit through face `f1` at `t1 > t0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub t0: f64,
    pub t1: f64,
    pub f0: u32,
    pub f1: u32,
}

impl Span {
    pub const EMPTY: Span = Span { t0: f64::NAN, t1: f64::NAN, f0: 0, f1: 0 };

    /// The line in a ball; `inverse_square` is `1 / dir²`. The closest approach to the centre is found first, so that
    /// nothing cancels for a far origin (Haines, Günther and Akenine-Möller 2019, "Precision improvements for ray/sphere
    /// intersection").
    #[inline]
    pub fn of_ball(center: DVec3, radius: f64, origin: DVec3, dir: DVec3, inverse_square: f64) -> Option<Span> {
        let span = Span::of_ball_or_empty(center, radius, origin, dir, inverse_square);
        (!span.is_empty()).then_some(span)
    }

    /// The same without a branch, for several balls at a time.
    #[inline]
    pub fn of_ball_or_empty(center: DVec3, radius: f64, origin: DVec3, dir: DVec3, inverse_square: f64) -> Span {
        let o = origin - center;
        let middle = -o.dot(dir) * inverse_square;
        let square = radius * radius - (o + dir * middle).length_squared();
        // Not a number where the ball is missed.
        let half = (square * inverse_square).sqrt();
        Span { t0: middle - half, t1: middle + half, f0: 0, f1: 0 }
    }

    /// Nothing is between its ends, which may be no numbers.
    #[inline]
    pub fn is_empty(&self) -> bool {
        let holds = self.t0 < self.t1;
        !holds
    }

    /// The line in an upright box, whose faces are 0 −x, 1 +x, 2 −y, 3 +y, 4 −z, 5 +z; `inverse_dir` is `1 / dir`.
    /// A line within the plane of a face is inside.
    #[inline]
    pub fn of_box(min: DVec3, max: DVec3, origin: DVec3, inverse_dir: DVec3) -> Option<Span> {
        let mut span = Span { t0: f64::NEG_INFINITY, t1: f64::INFINITY, f0: 0, f1: 0 };
        let mut cut = |min: f64, max: f64, o: f64, inverse: f64, face: u32| {
            if !inverse.is_finite() {
                return (min..=max).contains(&o);
            }
            let (near, far, back) = if inverse > 0.0 { (min, max, 0) } else { (max, min, 1) };
            let (near, far) = ((near - o) * inverse, (far - o) * inverse);
            if near > span.t0 {
                (span.t0, span.f0) = (near, face + back);
            }
            if far < span.t1 {
                (span.t1, span.f1) = (far, face + 1 - back);
            }
            true
        };
        let within = cut(min.x, max.x, origin.x, inverse_dir.x, 0)
            & cut(min.y, max.y, origin.y, inverse_dir.y, 2)
            & cut(min.z, max.z, origin.z, inverse_dir.z, 4);
        (within && span.t0 < span.t1).then_some(span)
    }
}

/// What [`Span::of_box`] finds for a line none of whose reciprocals is infinite, without faces: entry and exit, the entry not before
/// the exit where the box is missed.
#[inline(always)]
pub fn oblique_span(min: DVec3, max: DVec3, origin: DVec3, inverse_dir: DVec3) -> (f64, f64) {
    let (mut t0, mut t1) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (enter, exit) = oblique_slab(min, max, origin, inverse_dir, axis);
        t0 = if enter > t0 { enter } else { t0 };
        t1 = if exit < t1 { exit } else { t1 };
    }
    (t0, t1)
}

/// The face through which such a line enters (or leaves) the box at `t`, an end of its [`oblique_span`].
#[inline]
pub fn oblique_face(min: DVec3, max: DVec3, origin: DVec3, inverse_dir: DVec3, t: f64, enters: bool) -> u32 {
    let met = |&axis: &usize| {
        let (enter, exit) = oblique_slab(min, max, origin, inverse_dir, axis);
        t == if enters { enter } else { exit }
    };
    let axis = (0..3).find(met).unwrap_or(0);
    2 * axis as u32 + u32::from(enters != (inverse_dir[axis] > 0.0))
}

#[inline(always)]
fn oblique_slab(min: DVec3, max: DVec3, origin: DVec3, inverse_dir: DVec3, axis: usize) -> (f64, f64) {
    let (o, inverse) = (origin[axis], inverse_dir[axis]);
    let (near, far) = if inverse > 0.0 { (min[axis], max[axis]) } else { (max[axis], min[axis]) };
    ((near - o) * inverse, (far - o) * inverse)
}

impl From<Option<Span>> for Crossings {
    #[inline]
    fn from(span: Option<Span>) -> Crossings {
        span.map_or(Crossings::NONE, |span| Crossings::interval(span.t0, span.f0, span.t1, span.f1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [-1, 1) from a linear congruence.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn the_short_way_through_a_box_finds_the_same_span_and_faces() {
        let mut number = numbers(3);
        let mut point = move || DVec3::new(number(), number(), number());
        let mut met = 0;
        for i in 0..20_000 {
            let (a, b, origin) = (point(), point(), point() * 2.0);
            // Every other line goes through a corner.
            let dir = if i % 2 == 0 { point() } else { a.min(b) - origin };
            let (min, max, inverse) = (a.min(b), a.max(b), dir.recip());
            let (t0, t1) = oblique_span(min, max, origin, inverse);
            match Span::of_box(min, max, origin, inverse) {
                Some(span) => {
                    assert_eq!((t0, t1), (span.t0, span.t1));
                    let face = |t, enters| oblique_face(min, max, origin, inverse, t, enters);
                    assert_eq!((face(t0, true), face(t1, false)), (span.f0, span.f1));
                    met += 1;
                }
                None => assert!(t0 >= t1),
            }
        }
        assert!(met > 2_000, "{met}");
    }
}
