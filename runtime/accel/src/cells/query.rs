//! A ray through one cell.

use arsc_geometry::{Crossings, Span};
use smallvec::SmallVec;

use crate::cells::deferred::{Deferral, constant_state};
use crate::cells::first::first_of_spans;
use crate::cells::{Cell, CellLeaf, CellSet, Code, Kernel, Leaves, TABLE_LEAVES};
use crate::coincidence::{Event, Plain, States, settle};
use crate::counted::Counted;
use crate::expression::eval;
use crate::query::{PreparedRay, Scratch, View};
use crate::solid::SolidModel;
use crate::transition::Transition;

/// From so many crossings on, values are kept up to date instead of computed anew at each.
const MANY_EVENTS: usize = 32;
/// So few crossings are brought in order by insertion.
const FEW_EVENTS: usize = 16;

/// Crossings in a cell: seldom more than fit.
type Events = SmallVec<[Event; FEW_EVENTS]>;

/// A ray in the frame of a cell's solid.
#[derive(Clone, Copy)]
pub struct Line<'a> {
    pub solid: &'a SolidModel,
    pub ray: &'a PreparedRay,
    /// Tells the solid's leaves from those of others in the scratch.
    pub key: u64,
}

/// The stretch of a ray that a cell answers for: clusters that begin in `(low, high]`.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    pub low: f64,
    pub high: f64,
    /// The ray's own start: crossings up to here are behind it.
    pub start: f64,
    pub tolerance: f64,
}

impl Window {
    /// Crossings up to here are the past: those of clusters that began before the cell are still looked at.
    pub fn from(&self) -> f64 {
        (self.low - self.tolerance).max(self.start)
    }

    /// Crossings from here on are the future: those of clusters that begin in the cell are still looked at.
    pub fn to(&self) -> f64 {
        self.high + self.tolerance
    }
}

impl<'a> Line<'a> {
    /// `ray` is that of `view`, near the solid, whose number in its level is `number`.
    #[inline]
    pub fn new(solid: &'a SolidModel, number: u32, ray: &'a PreparedRay, view: &View) -> Line<'a> {
        Line { solid, ray, key: u64::from(view.first_solid + number) << 32 }
    }

    /// The leaf is costly, and its crossings are not known yet.
    fn is_unsolved(&self, leaf: &CellLeaf, scratch: &Scratch) -> bool {
        matches!(leaf.kernel, Kernel::Costly) && !scratch.has_roots(self.key | u64::from(leaf.leaf))
    }

    fn crossings(&self, leaf: &CellLeaf) -> Crossings {
        self.solid.leaves[leaf.leaf as usize].crossings(self.ray.origin, self.ray.dir)
    }

    #[inline(always)]
    fn meet<'s>(&self, leaf: &CellLeaf, scratch: &'s mut Scratch) -> Met<'s> {
        match leaf.kernel {
            Kernel::Ball { .. } | Kernel::Box { .. } => Met::Span(self.span(leaf)),
            Kernel::Placed | Kernel::Costly => Met::List(self.list(leaf, scratch)),
        }
    }

    /// The stretch in a ball or an upright box; empty for other leaves.
    #[inline(always)]
    pub fn span(&self, leaf: &CellLeaf) -> Span {
        let PreparedRay { origin, dir, inverse_dir, inverse_square, .. } = *self.ray;
        match leaf.kernel {
            Kernel::Ball { center, radius } => Span::of_ball_or_empty(center, radius, origin, dir, inverse_square),
            Kernel::Box { min, max } => Span::of_box(min, max, origin, inverse_dir).unwrap_or(Span::EMPTY),
            Kernel::Placed | Kernel::Costly => Span::EMPTY,
        }
    }

    #[inline(never)]
    fn list<'s>(&self, leaf: &CellLeaf, scratch: &'s mut Scratch) -> &'s Crossings {
        match leaf.kernel {
            Kernel::Costly => scratch.roots(self.key | u64::from(leaf.leaf), || self.crossings(leaf)),
            _ => scratch.keep(self.crossings(leaf)),
        }
    }
}

/// Crossings with one leaf: of a shape that is convex and needs no map, or of any other.
enum Met<'s> {
    Span(Span),
    List(&'s Crossings),
}

impl CellSet {
    /// The first transition in the window.
    #[inline]
    pub fn first(&self, cell: &Cell, line: &Line, window: &Window, scratch: &mut Scratch) -> Option<Transition> {
        if cell.is_plain
            && let Code::Table(table) = self.code(cell)
        {
            let (leaves, pairs) = (self.leaves(cell), &self.pairs[cell.pairs as usize..]);
            let first = if leaves.len() <= 2
                && let Some(pairs) = pairs.first_chunk()
            {
                first_of_spans::<1>(cell, pairs, leaves, table, line, window)
            } else if leaves.len() <= 4
                && let Some(pairs) = pairs.first_chunk()
            {
                first_of_spans::<2>(cell, pairs, leaves, table, line, window)
            } else if let Some(pairs) = pairs.first_chunk() {
                first_of_spans::<3>(cell, pairs, leaves, table, line, window)
            } else {
                None
            };
            if let Some(first) = first {
                return first;
            }
        }
        let mut first = None;
        self.transitions(cell, line, window, scratch, false, |transition| first = Some(transition));
        first
    }

    /// Calls `visit` for every transition in the window (`all`) or for the first, in order.
    ///
    /// Inside or outside at the window's beginning follows from the crossings before it, so a ray may start anywhere. A
    /// cluster that begins just before `low` belongs to the cell before; it is passed over as a whole.
    pub fn transitions(
        &self,
        cell: &Cell,
        line: &Line,
        window: &Window,
        scratch: &mut Scratch,
        all: bool,
        mut visit: impl FnMut(Transition),
    ) {
        let leaves = self.leaves(cell);
        let visit = |transition| {
            visit(transition);
            all
        };
        match (leaves.len(), self.code(cell)) {
            (1, Code::Table(table)) => single(leaves.get(0), table & 1 == 1, line, window, scratch, visit),
            (_, Code::Table(table)) if cell.is_plain => plain(leaves, table, line, window, visit),
            (_, Code::Table(table)) => several(leaves, table, line, window, scratch, all, visit),
            (_, Code::Tokens(tokens)) => {
                let mut states: SmallVec<[bool; 64]> = SmallVec::with_capacity(leaves.len());
                let mut events = Events::new();
                gather(leaves, 0, line, window, scratch, &mut events, |_, state| states.push(state));
                if events.len() < MANY_EVENTS {
                    let eval = |states: &[bool]| eval(tokens, |slot| states[slot as usize]);
                    walk(leaves, &events, window, Plain { states: &mut states, eval }, visit);
                } else {
                    walk(leaves, &events, window, Counted::new(tokens, &states), visit);
                }
            }
        }
    }
}

/// Collects the crossings in the window, sorted, and tells each leaf's state before them. Leaves with a bit in `deferred` are
/// left out.
#[inline]
fn gather(
    leaves: Leaves,
    deferred: u32,
    line: &Line,
    window: &Window,
    scratch: &mut Scratch,
    events: &mut Events,
    mut state: impl FnMut(u32, bool),
) {
    let from = window.from();
    let to = window.to();
    for (slot, leaf) in (0..).zip(leaves.iter()) {
        if slot < 32 && deferred >> slot & 1 == 1 {
            continue;
        }
        let mut push = |t: f64, face: u32| {
            if t > from && t <= to {
                events.push(Event { t, slot, face });
            }
        };
        let inside = match line.meet(leaf, scratch) {
            Met::Span(span) if span.is_empty() || span.t1 <= from => false,
            Met::Span(span) => {
                push(span.t0, span.f0);
                push(span.t1, span.f1);
                span.t0 <= from
            }
            Met::List(crossings) => {
                crossings.iter().for_each(|(t, face)| push(t, face));
                crossings.inside_after(from)
            }
        };
        state(slot, inside);
    }
    sort(events);
}

fn sort(events: &mut [Event]) {
    if events.len() > FEW_EVENTS {
        events.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.slot.cmp(&b.slot)));
        return;
    }
    // Slots ascend already, and insertion keeps the order of equals.
    for i in 1..events.len() {
        let mut j = i;
        while j > 0 && events[j - 1].t > events[j].t {
            events.swap(j - 1, j);
            j -= 1;
        }
    }
}

/// States of at most six leaves as bits, and the value for each combination.
struct Bits {
    states: u32,
    table: u64,
}

impl States for Bits {
    #[inline]
    fn get(&self, slot: u32) -> bool {
        self.states >> slot & 1 == 1
    }

    #[inline]
    fn flip(&mut self, slot: u32) {
        self.states ^= 1 << slot;
    }

    #[inline]
    fn value(&self) -> bool {
        self.table >> self.states & 1 == 1
    }
}

/// A cell with a truth table over balls and upright boxes.
fn plain(leaves: Leaves, table: u64, line: &Line, window: &Window, visit: impl FnMut(Transition) -> bool) {
    // First all spans: their arithmetic overlaps.
    let mut spans = [Span::EMPTY; TABLE_LEAVES];
    for (span, leaf) in spans.iter_mut().zip(leaves.iter()) {
        *span = line.span(leaf);
    }
    let (from, to) = (window.from(), window.to());
    let mut events = Events::new();
    let mut states = 0;
    for (slot, span) in (0..).zip(&spans[..leaves.len()]) {
        if span.is_empty() || span.t1 <= from {
            continue;
        }
        if span.t0 <= from {
            states |= 1 << slot;
        } else if span.t0 <= to {
            events.push(Event { t: span.t0, slot, face: span.f0 });
        }
        if span.t1 <= to {
            events.push(Event { t: span.t1, slot, face: span.f1 });
        }
    }
    if events.is_empty() {
        return;
    }
    sort(&mut events);
    walk(leaves, &events, window, Bits { states, table }, visit);
}

/// A cell with a truth table.
fn several(
    leaves: Leaves,
    table: u64,
    line: &Line,
    window: &Window,
    scratch: &mut Scratch,
    all: bool,
    visit: impl FnMut(Transition) -> bool,
) {
    let unsolved = leaves.iter().enumerate().filter(|(_, leaf)| !all && line.is_unsolved(leaf, scratch));
    let unsolved = unsolved.fold(0, |slots, (slot, _)| slots | 1 << slot);
    let mut deferral = (unsolved != 0).then(|| Deferral::new(table, leaves, line, window, unsolved));
    loop {
        let deferred = deferral.as_ref().map_or(0, Deferral::deferred);
        let (mut events, mut states) = (Events::new(), 0);
        gather(leaves, deferred, line, window, scratch, &mut events, |slot, state| states |= u32::from(state) << slot);
        match &mut deferral {
            Some(deferral) if !deferral.is_settled() => match deferral.first(&events, states) {
                Ok(first) => {
                    first.map(visit);
                    return;
                }
                Err(slots) => deferral.solve(slots),
            },
            _ => return walk(leaves, &events, window, Bits { states, table }, visit),
        }
    }
}

/// States of the leaves of a union.
struct Count {
    states: SmallVec<[bool; 64]>,
    inside: usize,
}

impl States for Count {
    fn get(&self, slot: u32) -> bool {
        self.states[slot as usize]
    }

    fn flip(&mut self, slot: u32) {
        let state = &mut self.states[slot as usize];
        *state = !*state;
        self.inside = if *state { self.inside + 1 } else { self.inside - 1 };
    }

    fn value(&self) -> bool {
        self.inside > 0
    }
}

/// Calls `visit` for every transition of the union of `leaves` in the window, in order, until it returns false. Other leaves
/// of the union are not met in the window.
pub fn union_transitions(
    leaves: &[CellLeaf],
    line: &Line,
    window: &Window,
    scratch: &mut Scratch,
    visit: impl FnMut(Transition) -> bool,
) {
    let ids: SmallVec<[u32; 16]> = (0..leaves.len() as u32).collect();
    let leaves = Leaves { kernels: leaves, ids: &ids };
    let mut events = Events::new();
    let mut states = SmallVec::with_capacity(leaves.len());
    gather(leaves, 0, line, window, scratch, &mut events, |_, state| states.push(state));
    let inside = states.iter().filter(|&&state| state).count();
    walk(leaves, &events, window, Count { states, inside }, visit);
}

/// Where a ray enters a leaf.
pub enum Entry {
    Missed,
    At {
        t: f64,
        face: u32,
    },
    /// It starts in the leaf, or passes through less than the tolerance.
    Unclear,
}

/// The first crossing of a bounded leaf that the ray, which goes from `low` to `high`, does not start in.
#[inline]
pub fn entry(leaf: &CellLeaf, line: &Line, window: &Window, scratch: &mut Scratch) -> Entry {
    let (t0, face, t1) = match line.meet(leaf, scratch) {
        Met::Span(span) if span.is_empty() => return Entry::Missed,
        Met::Span(span) => (span.t0, span.f0, span.t1),
        Met::List(crossings) => {
            let roots = crossings.t();
            let passed = roots.iter().take_while(|&&t| t <= window.low).count();
            // Even: outside. The pair that comes next, or the one that is about to end.
            let Some([t0, t1]) = roots.get(passed & !1..).and_then(|rest| rest.first_chunk()) else {
                return Entry::Missed;
            };
            (*t0, crossings.face(passed & !1), *t1)
        }
    };
    if t1 <= window.low || t0 > window.high {
        Entry::Missed
    } else if t0 <= window.low || t1 <= t0 + window.tolerance {
        Entry::Unclear
    } else {
        Entry::At { t: t0, face }
    }
}

/// Goes along sorted events, cluster by cluster.
#[inline]
fn walk(
    leaves: Leaves,
    events: &[Event],
    window: &Window,
    mut states: impl States,
    mut visit: impl FnMut(Transition) -> bool,
) {
    let mut rest = events;
    if rest.is_empty() {
        return;
    }
    let mut inside = states.value();
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
            let leaf = leaves.get(slot as usize).leaf;
            if !visit(Transition { t, leaf, face, entering: after, flipped, shared }) {
                return;
            }
        }
        inside = after;
        rest = later;
    }
}

/// Calls `visit` for every transition of a solid of one leaf, or (`negated`) its complement, in the window, in order, until it
/// returns false.
#[inline]
pub fn leaf_transitions(
    leaf: &CellLeaf,
    negated: bool,
    line: &Line,
    window: &Window,
    scratch: &mut Scratch,
    visit: impl FnMut(Transition) -> bool,
) {
    single(leaf, negated, line, window, scratch, visit);
}

/// One leaf, or (`negated`) its complement: its crossings are the transitions, pairs within the tolerance cancel.
#[inline]
fn single(
    leaf: &CellLeaf,
    negated: bool,
    line: &Line,
    window: &Window,
    scratch: &mut Scratch,
    mut visit: impl FnMut(Transition) -> bool,
) {
    let from = window.from();
    // Whether to go on.
    let mut found = |t: f64, face: u32, inside: bool| {
        let transition =
            Transition { t, leaf: leaf.leaf, face, entering: inside != negated, flipped: negated, shared: false };
        t <= window.low || visit(transition)
    };
    if line.is_unsolved(leaf, scratch) && constant_state(leaf, line, window).is_some() {
        return;
    }
    let crossings = match line.meet(leaf, scratch) {
        Met::Span(span) if span.is_empty() => return,
        Met::Span(span) => {
            let (enters, thick) = (span.t0 > from, span.t1 > span.t0 + window.tolerance);
            if enters && !(thick && span.t0 <= window.high && found(span.t0, span.f0, true)) {
                return;
            }
            if span.t1 > from && span.t1 <= window.high {
                found(span.t1, span.f1, false);
            }
            return;
        }
        Met::List(crossings) => crossings,
    };
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
            if !found(roots[i], crossings.face(i), inside) {
                return;
            }
        }
        i += together;
    }
}
