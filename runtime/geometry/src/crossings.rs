//! Where a line crosses a solid's surface.

/// So many crossings are kept without the heap: all that a convex shape or a torus can have.
const INLINE: usize = 4;

/// All crossings of the line `origin + t dir`, `-inf < t < inf`, with the surface of one shape.
///
/// `t` is sorted, and each crossing changes inside to outside or back: parity is part of the value, so a ray that
/// starts inside needs no special case. A tangent line has no crossings. One cache line, and no heap up to four.
#[derive(Clone, Debug)]
pub struct Crossings {
    t: [f64; INLINE],
    face: [u32; INLINE],
    len: u32,
    /// The line is inside the shape for `t` towards minus infinity (unbounded shapes only).
    pub inside_before: bool,
    /// From five crossings on: all of them.
    many: Option<Box<Many>>,
}

#[derive(Clone, Debug, Default)]
struct Many {
    t: Vec<f64>,
    face: Vec<u32>,
}

impl Crossings {
    pub const NONE: Crossings =
        Crossings { t: [0.0; INLINE], face: [0; INLINE], len: 0, inside_before: false, many: None };
    pub const ALWAYS_INSIDE: Crossings = Crossings { inside_before: true, ..Crossings::NONE };

    /// Enters at `t0` through face `f0`, leaves at `t1` through `f1`; nothing unless `t0 < t1`.
    #[inline]
    pub fn interval(t0: f64, f0: u32, t1: f64, f1: u32) -> Crossings {
        if t0 < t1 {
            Crossings { t: [t0, t1, 0.0, 0.0], face: [f0, f1, 0, 0], len: 2, ..Crossings::NONE }
        } else {
            Crossings::NONE
        }
    }

    /// One crossing, of an unbounded shape.
    #[inline]
    pub fn single(t: f64, inside_before: bool) -> Crossings {
        Crossings { t: [t, 0.0, 0.0, 0.0], len: 1, inside_before, ..Crossings::NONE }
    }

    /// From crossings in any order. Those at the same place stay in the order that they were found in.
    pub fn sorted(found: &mut [(f64, u32)]) -> Crossings {
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut crossings = Crossings::NONE;
        for &(t, face) in found.iter() {
            crossings.push(t, face);
        }
        crossings
    }

    /// Appends a crossing at `t`, not below those already there.
    #[inline]
    pub fn push(&mut self, t: f64, face: u32) {
        let n = self.len as usize;
        self.len += 1;
        if n < INLINE {
            self.t[n] = t;
            self.face[n] = face;
        } else {
            self.push_beyond(t, face);
        }
    }

    #[cold]
    fn push_beyond(&mut self, t: f64, face: u32) {
        let (first_t, first_face) = (self.t, self.face);
        let many = self.many.get_or_insert_with(|| Box::new(Many { t: first_t.to_vec(), face: first_face.to_vec() }));
        many.t.push(t);
        many.face.push(face);
    }

    #[inline]
    pub fn len(&self) -> usize {
        self.len as usize
    }

    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Parameters of the crossings, ascending.
    #[inline]
    pub fn t(&self) -> &[f64] {
        match &self.many {
            None => &self.t[..self.len()],
            Some(many) => &many.t,
        }
    }

    /// Face numbers, beside [`Crossings::t`].
    #[inline]
    pub fn faces(&self) -> &[u32] {
        match &self.many {
            None => &self.face[..self.len()],
            Some(many) => &many.face,
        }
    }

    #[inline]
    pub fn face(&self, i: usize) -> u32 {
        self.faces()[i]
    }

    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (f64, u32)> + '_ {
        self.t().iter().copied().zip(self.faces().iter().copied())
    }

    /// Inside just after `t`.
    #[inline]
    pub fn inside_after(&self, t: f64) -> bool {
        self.inside_before ^ (self.t().iter().filter(|&&root| root <= t).count() % 2 == 1)
    }

    /// The same crossings with every parameter `t` become `(t + shift) * scale`; `scale > 0`.
    #[inline]
    pub(crate) fn remapped(mut self, shift: f64, scale: f64) -> Crossings {
        let all = match &mut self.many {
            None => &mut self.t[..self.len as usize],
            Some(many) => &mut many.t[..],
        };
        for t in all {
            *t = (*t + shift) * scale;
        }
        self
    }
}

impl PartialEq for Crossings {
    fn eq(&self, other: &Crossings) -> bool {
        self.inside_before == other.inside_before && self.t() == other.t() && self.faces() == other.faces()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_crossings() {
        assert_eq!(size_of::<Crossings>(), 64);
        for n in 0..12u32 {
            let mut found: Vec<(f64, u32)> = (0..n).rev().map(|i| (f64::from(i), i)).collect();
            let crossings = Crossings::sorted(&mut found).remapped(1.0, 2.0);
            let expected: Vec<(f64, u32)> = (0..n).map(|i| (2.0 * f64::from(i) + 2.0, i)).collect();
            assert_eq!(crossings.iter().collect::<Vec<_>>(), expected);
            assert_eq!(crossings.len(), expected.len());
            assert_eq!(crossings.inside_after(5.0), n.min(2) % 2 == 1);
            assert_eq!(crossings.clone(), crossings);
        }
    }
}
