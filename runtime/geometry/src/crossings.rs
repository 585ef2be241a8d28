//! Where a line crosses a solid's surface.

/// All crossings of the line `origin + t dir`, `-inf < t < inf`, with the surface of one shape.
///
/// `t` is sorted, and each crossing changes inside to outside or back: parity is part of the value, so a ray that
/// starts inside needs no special case. A tangent line has no crossings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossings {
    t: [f64; 4],
    face: [u8; 4],
    len: u8,
    /// The line is inside the shape for `t` towards minus infinity (unbounded shapes only).
    pub inside_before: bool,
}

impl Crossings {
    pub const NONE: Crossings = Crossings { t: [0.0; 4], face: [0; 4], len: 0, inside_before: false };
    pub const ALWAYS_INSIDE: Crossings = Crossings { inside_before: true, ..Crossings::NONE };

    /// Enters at `t0` through face `f0`, leaves at `t1` through `f1`; nothing unless `t0 < t1`.
    pub fn interval(t0: f64, f0: u8, t1: f64, f1: u8) -> Crossings {
        if t0 < t1 {
            Crossings { t: [t0, t1, 0.0, 0.0], face: [f0, f1, 0, 0], len: 2, inside_before: false }
        } else {
            Crossings::NONE
        }
    }

    /// One crossing, of an unbounded shape.
    pub fn single(t: f64, inside_before: bool) -> Crossings {
        Crossings { t: [t, 0.0, 0.0, 0.0], face: [0; 4], len: 1, inside_before }
    }

    /// Appends a crossing at `t`, not below those already there. At most four.
    pub fn push(&mut self, t: f64, face: u8) {
        let n = usize::from(self.len);
        self.t[n] = t;
        self.face[n] = face;
        self.len += 1;
    }

    pub fn len(&self) -> usize {
        usize::from(self.len)
    }

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Parameters of the crossings, ascending.
    pub fn t(&self) -> &[f64] {
        &self.t[..self.len()]
    }

    /// Face numbers, beside [`Crossings::t`].
    pub fn face(&self, i: usize) -> u8 {
        self.face[i]
    }

    pub fn iter(&self) -> impl Iterator<Item = (f64, u8)> + '_ {
        self.t().iter().copied().zip(self.face.iter().copied())
    }

    /// Inside just after `t`.
    pub fn inside_after(&self, t: f64) -> bool {
        self.inside_before ^ (self.t().iter().filter(|&&root| root <= t).count() % 2 == 1)
    }

    /// The same crossings with every parameter `t` become `(t + shift) * scale`; `scale > 0`.
    pub(crate) fn remapped(mut self, shift: f64, scale: f64) -> Crossings {
        for t in &mut self.t[..usize::from(self.len)] {
            *t = (*t + shift) * scale;
        }
        self
    }
}
