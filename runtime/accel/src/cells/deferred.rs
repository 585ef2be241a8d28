//! Costly leaves, solved only where the answer hangs on them.
//!
//! How far a point is from a torus takes a few operations, its crossings take a quartic. So the first transition of a cell
//! is looked for along the crossings of its other leaves: between them the expression often does not depend on the torus, or
//! the distance shows that its surface is not near; at them the distance tells its state. Where neither helps, the tori that
//! it hangs on are solved, and no others. The answer is the same, and most rays that hit a grooved ball beside its grooves solve no
//! quartic.

use arsc_geometry::Placed;
use glam::DVec3;

use crate::cells::query::{Line, Window};
use crate::cells::{CellLeaf, Leaves, TABLE_LEAVES};
use crate::coincidence::Event;
use crate::transition::Transition;

/// A distance that decides a state exceeds so many tolerances: clusters and roundings are well within.
const MARGIN: f64 = 4.0;

/// A leaf's signed distance along a line.
#[derive(Clone, Copy)]
struct Distance<'a> {
    leaf: &'a Placed,
    origin: DVec3,
    dir: DVec3,
    /// Lengths in the leaf's frame per unit of the line's parameter: how fast the distance can change.
    speed: f64,
    tolerance: f64,
}

impl<'a> Distance<'a> {
    fn new(leaf: &'a Placed, line: &Line, tolerance: f64) -> Distance<'a> {
        let map = leaf.object_from_world();
        let dir = map.transform_vector3(line.ray.dir);
        Distance { leaf, origin: map.transform_point3(line.ray.origin), dir, speed: dir.length(), tolerance }
    }

    /// The state throughout the stretch, if the surface is certainly beyond it.
    fn state(&self, from: f64, to: f64) -> Option<bool> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let margin = (half + MARGIN * self.tolerance) * self.speed;
        // Not for the NaN of an endless stretch.
        self.leaf.shape().state_around(self.origin + self.dir * middle, margin)
    }
}

/// The state of one leaf throughout the window, if that is easily known.
pub fn constant_state(leaf: &CellLeaf, line: &Line, window: &Window) -> Option<bool> {
    let placed = &line.solid.leaves[leaf.leaf as usize];
    Distance::new(placed, line, window.tolerance).state(window.from(), window.to())
}

/// What is known of a cell with a truth table when some of its leaves are not solved. Sets of slots are bit sets.
pub struct Deferral<'a> {
    table: u64,
    leaves: Leaves<'a>,
    line: &'a Line<'a>,
    window: &'a Window,
    /// As far as they have been asked for.
    distances: [Option<Distance<'a>>; TABLE_LEAVES],
    /// Slots that are not solved.
    deferred: u32,
}

impl<'a> Deferral<'a> {
    /// `unsolved` are the costly leaves whose crossings are not known.
    pub fn new(table: u64, leaves: Leaves<'a>, line: &'a Line<'a>, window: &'a Window, unsolved: u32) -> Deferral<'a> {
        Deferral { table, leaves, line, window, distances: [None; TABLE_LEAVES], deferred: unsolved }
    }

    /// Slots whose crossings are not asked for.
    pub fn deferred(&self) -> u32 {
        self.deferred
    }

    /// Nothing hangs on crossings that are not known.
    pub fn is_settled(&self) -> bool {
        self.deferred == 0
    }

    /// These slots are solved from now on.
    pub fn solve(&mut self, slots: u32) {
        self.deferred &= !slots;
    }

    /// The first transition in the window, if there is any; or the slots whose crossings it hangs on. `events` and `states` are
    /// those of the other leaves.
    pub fn first(&mut self, events: &[Event], mut states: u32) -> Result<Option<Transition>, u32> {
        let Window { low, high, tolerance, .. } = *self.window;
        let mut from = self.window.from();
        let mut inside = self.value(states, from, events.first().map_or(self.window.to(), |event| event.t))?;
        for (i, &Event { t, slot, face }) in events.iter().enumerate() {
            if t > high {
                break;
            }
            let next = events.get(i + 1).map_or(f64::INFINITY, |event| event.t);
            if next <= t + tolerance {
                return Err(self.deferred);
            }
            // Next to the crossing, on both sides.
            let after = states ^ 1 << slot;
            let (left, right) = if self.depends(states) || self.depends(after) {
                let known = self.states(t, t)?;
                (self.look_up(states | known), self.look_up(after | known))
            } else {
                (self.look_up(states), self.look_up(after))
            };
            states = after;
            if left != inside {
                return Err(self.deferred);
            }
            if right != left && t > low {
                let flipped = (states >> slot & 1 == 1) != right;
                let leaf = self.leaves.get(slot as usize).leaf;
                return Ok(Some(Transition { t, leaf, face, entering: right, flipped, shared: false }));
            }
            from = t;
            inside = self.value(states, from, next.min(self.window.to()))?;
        }
        Ok(None)
    }

    fn look_up(&self, states: u32) -> bool {
        self.table >> states & 1 == 1
    }

    /// The value is not the same whatever the states of the deferred leaves are.
    fn depends(&self, states: u32) -> bool {
        let first = self.look_up(states);
        let mut others = self.deferred;
        while others != 0 {
            if self.look_up(states | others) != first {
                return true;
            }
            others = (others - 1) & self.deferred;
        }
        false
    }

    /// The value between two neighbouring crossings; or the slots that it hangs on, as far as it may change between them.
    fn value(&mut self, states: u32, from: f64, to: f64) -> Result<bool, u32> {
        if !self.depends(states) {
            return Ok(self.look_up(states));
        }
        let known = self.states(from, to)?;
        Ok(self.look_up(states | known))
    }

    /// States of the deferred leaves throughout a stretch; or those that may change there.
    fn states(&mut self, from: f64, to: f64) -> Result<u32, u32> {
        let (mut inside, mut unclear) = (0, 0);
        for (slot, known) in self.distances.iter_mut().enumerate().filter(|(slot, _)| self.deferred >> slot & 1 == 1) {
            let placed = &self.line.solid.leaves[self.leaves.get(slot).leaf as usize];
            let distance = known.get_or_insert_with(|| Distance::new(placed, self.line, self.window.tolerance));
            match distance.state(from, to) {
                Some(state) => inside |= u32::from(state) << slot,
                None => unclear |= 1 << slot,
            }
        }
        if unclear == 0 { Ok(inside) } else { Err(unclear) }
    }
}
