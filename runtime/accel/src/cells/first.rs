//! The first transition in a cell of few balls and upright boxes: what most rays ask of most cells.
//!
//! Balls are crossed two at a time. Times of entry and exit are kept slot by slot; those that are past or do not exist are
//! infinite, so the next crossing is the least of all, and next to nothing branches on the ray. Where crossings coincide
//! the answer is left to [`crate::cells::query`], which knows the rule for them; elsewhere both give the same.

use arsc_geometry::{oblique_face, oblique_span};
use glam::DVec3;
use wide::{CmpGt, CmpLe, CmpLt, f64x2};

use crate::cells::query::{Line, Window};
use crate::cells::{Cell, CellLeaf, Kernel, Leaves};
use crate::query::PreparedRay;
use crate::transition::Transition;

/// Two balls side by side, a cache line. Where there is none the square is negative.
#[derive(Clone, Copy, Debug)]
pub struct BallPair {
    center: [f64x2; 3],
    /// Of the radius.
    square: f64x2,
}

impl BallPair {
    pub fn new(kernels: [Option<&Kernel>; 2]) -> BallPair {
        let ball = |kernel: Option<&Kernel>| match kernel {
            Some(&Kernel::Ball { center, radius }) => (center, radius * radius),
            _ => (DVec3::ZERO, -1.0),
        };
        let [(a, ra), (b, rb)] = kernels.map(ball);
        let both = |axis: usize| f64x2::from([a[axis], b[axis]]);
        BallPair { center: [both(0), both(1), both(2)], square: f64x2::from([ra, rb]) }
    }

    /// Entries and exits, no numbers where a ball is missed: the steps of [`arsc_geometry::Span::of_ball`], so the same bits.
    #[inline(always)]
    fn cross(&self, ray: &Splat) -> (f64x2, f64x2) {
        let [x, y, z] = [0, 1, 2].map(|axis| ray.origin[axis] - self.center[axis]);
        let [dx, dy, dz] = ray.dir;
        let middle = -(x * dx + y * dy + z * dz) * ray.inverse_square;
        let [x, y, z] = [x + dx * middle, y + dy * middle, z + dz * middle];
        let half = ((self.square - (x * x + y * y + z * z)) * ray.inverse_square).sqrt();
        (middle - half, middle + half)
    }
}

/// A ray, every number twice.
struct Splat {
    origin: [f64x2; 3],
    dir: [f64x2; 3],
    inverse_square: f64x2,
}

impl Splat {
    #[inline(always)]
    fn new(ray: &PreparedRay) -> Splat {
        Splat {
            origin: ray.origin.to_array().map(f64x2::splat),
            dir: ray.dir.to_array().map(f64x2::splat),
            inverse_square: f64x2::splat(ray.inverse_square),
        }
    }
}

/// The first transition in the window, if there is any; `None` where crossings coincide. `pairs` are the balls of the cell,
/// slot by slot, and `table` is its expression.
#[inline(always)]
pub fn first_of_spans<const PAIRS: usize>(
    cell: &Cell,
    pairs: &[BallPair; PAIRS],
    leaves: Leaves,
    table: u64,
    line: &Line,
    window: &Window,
) -> Option<Option<Transition>> {
    const NEVER: f64 = f64::INFINITY;
    let Window { low, high, tolerance, .. } = *window;
    let ray = Splat::new(line.ray);
    let mut spans = pairs.map(|pair| pair.cross(&ray));
    if cell.boxes != 0 {
        for slot in 0..2 * PAIRS {
            if cell.boxes >> slot & 1 == 1 {
                let (t0, t1) = span_of_box(line, leaves.get(slot));
                let (entry, exit) = &mut spans[slot / 2];
                entry.as_array_mut()[slot % 2] = t0;
                exit.as_array_mut()[slot % 2] = t1;
            }
        }
    }
    let (never, from) = (f64x2::splat(NEVER), f64x2::splat(window.from()));
    let mut states = 0u32;
    for (pair, (entry, exit)) in spans.iter_mut().enumerate() {
        // False for the NaN of a leaf that is missed.
        let ahead = entry.cmp_lt(*exit) & exit.cmp_gt(from);
        let begun = entry.cmp_le(from);
        states |= ((ahead & begun).move_mask() as u32) << (2 * pair);
        *exit = ahead.blend(*exit, never);
        *entry = begun.blend(never, ahead.blend(*entry, never));
    }
    let mut inside = table >> states & 1;
    loop {
        let next = spans.iter().fold(never, |least, (entry, exit)| least.fast_min(entry.fast_min(*exit)));
        let [a, b] = next.to_array();
        let next = if a < b { a } else { b };
        if next > high || next == NEVER {
            return Some(None);
        }
        let end = f64x2::splat(next + tolerance);
        let (mut entered, mut left) = (0u32, 0u32);
        for (pair, (entry, exit)) in spans.iter_mut().enumerate() {
            let (now_entered, now_left) = (entry.cmp_le(end), exit.cmp_le(end));
            entered |= (now_entered.move_mask() as u32) << (2 * pair);
            left |= (now_left.move_mask() as u32) << (2 * pair);
            *entry = now_entered.blend(never, *entry);
            *exit = now_left.blend(never, *exit);
        }
        let bit = entered | left;
        if bit & (bit - 1) != 0 || entered & left != 0 {
            return None;
        }
        states ^= bit;
        let after = table >> states & 1;
        if after != inside && next > low {
            let slot = bit.trailing_zeros() as usize;
            let (entering, in_leaf, leaf) = (after == 1, entered != 0, leaves.get(slot));
            let face = if cell.boxes & bit as u8 != 0 { face_of_box(line, leaf, next, in_leaf) } else { 0 };
            let (leaf, flipped) = (leaf.leaf, in_leaf != entering);
            return Some(Some(Transition { t: next, leaf, face, entering, flipped, shared: false }));
        }
        inside = after;
    }
}

/// Entry and exit of a box.
#[inline(always)]
fn span_of_box(line: &Line, leaf: &CellLeaf) -> (f64, f64) {
    match leaf.kernel {
        Kernel::Box { min, max } if line.ray.is_oblique => {
            oblique_span(min, max, line.ray.origin, line.ray.inverse_dir)
        }
        _ => {
            let span = line.span(leaf);
            (span.t0, span.t1)
        }
    }
}

/// Through which face a box is entered or left at `t`.
#[inline]
fn face_of_box(line: &Line, leaf: &CellLeaf, t: f64, enters: bool) -> u32 {
    match leaf.kernel {
        Kernel::Box { min, max } if line.ray.is_oblique => {
            oblique_face(min, max, line.ray.origin, line.ray.inverse_dir, t, enters)
        }
        _ => {
            let span = line.span(leaf);
            if enters { span.f0 } else { span.f1 }
        }
    }
}

#[cfg(test)]
mod tests {
    use arsc_geometry::{Ray, Span};
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64;

    use super::*;
    use crate::query::View;

    #[test]
    fn pairs_of_balls_have_the_bits_of_single_ones() {
        let mut rng = Pcg64::seed_from_u64(5);
        let mut met = 0;
        for _ in 0..20_000 {
            let mut point = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let (origin, dir, centers) = (point() * 3.0, point().normalize(), [point(), point()]);
            let radii = [0, 1].map(|_| rng.random_range(0.1..1.5));
            let view = View::world(&Ray::new(origin, dir));
            let kernels = [0, 1].map(|i| Kernel::Ball { center: centers[i], radius: radii[i] });
            let (entries, exits) = BallPair::new([Some(&kernels[0]), Some(&kernels[1])]).cross(&Splat::new(&view.ray));
            for i in 0..2 {
                let (t0, t1) = (entries.to_array()[i], exits.to_array()[i]);
                match Span::of_ball(centers[i], radii[i], origin, dir, view.ray.inverse_square) {
                    Some(span) => assert_eq!((t0, t1), (span.t0, span.t1)),
                    None => assert_ne!(t0.partial_cmp(&t1), Some(std::cmp::Ordering::Less), "{t0} {t1}"),
                }
                met += usize::from(t0 < t1);
            }
            let (entries, _) = BallPair::new([Some(&kernels[0]), None]).cross(&Splat::new(&view.ray));
            assert!(entries.to_array()[1].is_nan());
        }
        assert!(met > 3_000, "{met}");
    }
}
