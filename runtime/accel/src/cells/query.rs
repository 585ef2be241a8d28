//! A ray through one cell.

use arsc_geometry::Crossings;
use smallvec::SmallVec;

use crate::cells::Code;
use crate::coincidence::{Event, Plain, States, settle};
use crate::counted::Counted;
use crate::expression::eval;
use crate::tree::Transition;

/// From so many crossings on, values are kept up to date instead of computed anew at each.
const MANY_EVENTS: usize = 32;

/// The stretch of a ray that a cell answers for: clusters that begin in `(low, high]`.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    pub low: f64,
    pub high: f64,
    /// The ray's own start: crossings up to here are behind it.
    pub start: f64,
    pub tolerance: f64,
}

/// Where the crossings of a cell's leaves come from.
pub trait Leaves {
    fn crossings(&mut self, leaf: u32) -> Crossings;
}

/// Calls `visit` for every transition in the window, in order, until it returns false.
///
/// `events` is scratch. Inside or outside at the window's beginning follows from the crossings before it, so a ray may
/// start anywhere. A cluster that begins just before `low` belongs to the cell before; it is passed over as a whole.
pub fn transitions(
    code: Code<'_>,
    leaves: &[u32],
    source: &mut impl Leaves,
    window: &Window,
    events: &mut Vec<Event>,
    visit: impl FnMut(Transition) -> bool,
) {
    if let ([leaf], Code::Table(table)) = (leaves, code) {
        return single(*leaf, table & 1 == 1, source, window, visit);
    }
    let from = (window.low - window.tolerance).max(window.start);
    let mut states: SmallVec<[bool; 64]> = SmallVec::with_capacity(leaves.len());
    events.clear();
    for (slot, &leaf) in (0..).zip(leaves) {
        let crossings = source.crossings(leaf);
        states.push(crossings.inside_after(from));
        for (t, face) in crossings.iter() {
            if t > from && t <= window.high + window.tolerance {
                events.push(Event { t, slot, face });
            }
        }
    }
    if events.is_empty() {
        return;
    }
    events.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.slot.cmp(&b.slot)));
    match code {
        Code::Table(table) => {
            let eval = |states: &[bool]| table >> index(states) & 1 == 1;
            walk(leaves, events, window, Plain { states: &mut states, eval }, visit);
        }
        Code::Tokens(tokens) if events.len() < MANY_EVENTS => {
            let eval = |states: &[bool]| eval(tokens, |slot| states[slot as usize]);
            walk(leaves, events, window, Plain { states: &mut states, eval }, visit);
        }
        Code::Tokens(tokens) => walk(leaves, events, window, Counted::new(tokens, &states), visit),
    }
}

/// Goes along sorted events, cluster by cluster.
fn walk(
    leaves: &[u32],
    events: &[Event],
    window: &Window,
    mut states: impl States,
    mut visit: impl FnMut(Transition) -> bool,
) {
    let mut inside = states.value();
    let mut rest = events;
    while let Some(first) = rest.first() {
        if first.t > window.high {
            return;
        }
        let together = rest.iter().take_while(|event| event.t <= first.t + window.tolerance).count();
        let (cluster, later) = rest.split_at(together);
        let (after, owner) = settle(cluster, inside, &mut states);
        if let Some(owner) = owner
            && first.t > window.low
        {
            let Event { t, slot, face } = cluster[owner];
            let flipped = states.get(slot) != after;
            let shared = cluster.len() > 1;
            if !visit(Transition { t, leaf: leaves[slot as usize], face, entering: after, flipped, shared }) {
                return;
            }
        }
        inside = after;
        rest = later;
    }
}

/// The bits of the states as a number.
fn index(states: &[bool]) -> u32 {
    states.iter().rev().fold(0, |bits, &state| bits << 1 | u32::from(state))
}

/// One leaf, or (`negated`) its complement: its crossings are the transitions, pairs within the tolerance cancel.
fn single(
    leaf: u32,
    negated: bool,
    source: &mut impl Leaves,
    window: &Window,
    mut visit: impl FnMut(Transition) -> bool,
) {
    let crossings = source.crossings(leaf);
    let from = (window.low - window.tolerance).max(window.start);
    let mut inside = crossings.inside_before;
    let roots = crossings.t();
    let mut i = 0;
    while i < roots.len() && roots[i] <= from {
        inside = !inside;
        i += 1;
    }
    while i < roots.len() && roots[i] <= window.high {
        let together = roots[i..].iter().take_while(|&&t| t <= roots[i] + window.tolerance).count();
        if together % 2 == 1 {
            inside = !inside;
            if roots[i] > window.low {
                let (t, face) = (roots[i], crossings.face(i));
                let entering = inside != negated;
                let shared = false;
                if !visit(Transition { t, leaf, face, entering, flipped: negated, shared }) {
                    return;
                }
            }
        }
        i += together;
    }
}
