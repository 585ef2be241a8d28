//! Costly leaves, solved only where the answer hangs on them.
//!
//! A torus has a signed distance for a few operations where its crossings take a quartic. So the first transition of a cell
//! is looked for along the crossings of its other leaves: between them the expression often does not depend on the torus, or
//! the distance shows that its surface is not near; at them the distance tells its state. Where neither helps, the answer
//! is given up and the torus is solved after all. The answer is the same, and most rays that hit a grooved ball beside its
//! grooves solve no quartic.

use arsc_geometry::Placed;
use glam::DVec3;

use crate::cells::query::{Line, Window};
use crate::cells::{CellLeaf, Leaves};
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
        let distance = self.leaf.shape().distance(self.origin + self.dir * middle)?;
        // False for the NaN of an endless stretch.
        (distance.abs() > (half + MARGIN * self.tolerance) * self.speed).then_some(distance < 0.0)
    }
}

/// The state of one leaf throughout a stretch of the line, if that is easily known.
pub fn constant_state(leaf: &CellLeaf, line: &Line, window: &Window) -> Option<bool> {
    let placed = &line.solid.leaves[leaf.leaf as usize];
    Distance::new(placed, line, window.tolerance).state(window.from(), window.to())
}

/// What is known of a cell with a truth table when some of its leaves are not solved.
pub struct Deferral<'a> {
    pub table: u64,
    /// States of the solved leaves at the beginning, bit by bit; the others' are clear.
    pub states: u32,
    /// The leaves that are not solved.
    pub deferred: u32,
    pub leaves: Leaves<'a>,
    pub line: &'a Line<'a>,
    pub window: &'a Window,
}

impl Deferral<'_> {
    /// The first transition in the window, if there is any; `None` where that hangs on crossings of deferred leaves.
    /// `events` are the others' crossings.
    pub fn first(&self, events: &[Event]) -> Option<Option<Transition>> {
        let Window { low, high, tolerance, .. } = *self.window;
        let mut states = self.states;
        let mut from = self.window.from();
        let mut inside = self.value(states, from, events.first().map_or(self.window.to(), |event| event.t))?;
        for (i, &Event { t, slot, face }) in events.iter().enumerate() {
            if t > high {
                break;
            }
            let next = events.get(i + 1).map_or(f64::INFINITY, |event| event.t);
            if next <= t + tolerance {
                return None;
            }
            let before = states;
            states ^= 1 << slot;
            // Next to the crossing, on both sides.
            let here = [before, states].map(|states| self.value(states, t, t));
            let [Some(left), Some(right)] = here else { return None };
            if left != inside {
                return None;
            }
            if right != left && t > low {
                let flipped = (states >> slot & 1 == 1) != right;
                let leaf = self.leaves.get(slot as usize).leaf;
                return Some(Some(Transition { t, leaf, face, entering: right, flipped, shared: false }));
            }
            from = t;
            inside = self.value(states, from, next.min(self.window.to()))?;
        }
        Some(None)
    }

    /// The value between two neighbouring crossings, if it is the same throughout.
    fn value(&self, states: u32, from: f64, to: f64) -> Option<bool> {
        let value = |states: u32| self.table >> states & 1 == 1;
        let first = value(states);
        let mut others = self.deferred;
        let mut depends = false;
        while others != 0 {
            depends |= value(states | others) != first;
            others = (others - 1) & self.deferred;
        }
        if !depends {
            return Some(first);
        }
        let mut known = states;
        for (slot, leaf) in self.leaves.iter().enumerate().filter(|(slot, _)| self.deferred >> slot & 1 == 1) {
            let placed = &self.line.solid.leaves[leaf.leaf as usize];
            let state = Distance::new(placed, self.line, self.window.tolerance).state(from, to)?;
            known |= u32::from(state) << slot;
        }
        Some(value(known))
    }
}
