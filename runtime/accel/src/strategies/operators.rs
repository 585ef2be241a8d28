//! The whole operator tree of a solid, evaluated along a ray.
//!
//! Strategies that collect the crossings of leaves first and evaluate afterwards share this. Every operator counts its
//! operands that decide it (true ones of an OR, false ones of an AND); where a leaf is crossed the change goes up as
//! far as values change. The counts of a point outside all leaves are made once, at build; a ray starts from a copy, so the
//! cost is one copy of a word per operator and a walk to the root per crossing (n-ary operators, Roth's lists unrolled:
//! S. D. Roth, "Ray casting for modeling solids", 1982).
//!
//! Leaves that a strategy leaves out count as outside all along the ray. It may do so where that does not change the
//! value between the ray's start and end: a leaf whose box the ray misses, or one below an operator that others decide.

use crate::coincidence::{Event, States, settle};
use crate::expression::{Expression, Op, Token, Word};
use crate::solid::{SolidModel, SolidRay};
use crate::transition::Transition;

const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Operator {
    parent: u32,
    /// The operand value that decides it.
    absorbing: bool,
}

/// The operators of an expression, and which of them each leaf is an operand of.
#[derive(Clone, Debug, Default)]
pub struct Operators {
    operators: Vec<Operator>,
    /// Per operator: deciding operands when every leaf is outside.
    outside: Vec<u32>,
    /// The literals of leaf `i` are `literals[first[i]..first[i + 1]]`: operator, negated.
    first: Vec<u32>,
    literals: Vec<(u32, bool)>,
    constant: bool,
}

impl Operators {
    pub fn new(solid: &SolidModel) -> Operators {
        match &solid.expression {
            Expression::Constant(value) => Operators { constant: *value, ..Operators::default() },
            Expression::Tokens(tokens) => Operators::from_tokens(tokens, solid.leaves.len()),
        }
    }

    fn from_tokens(tokens: &[Token], leaves: usize) -> Operators {
        let mut operators = Vec::new();
        let mut found: Vec<(u32, u32, bool)> = Vec::new();
        let mut open: Vec<(u32, usize)> = Vec::new();
        if let [_] = tokens {
            operators.push(Operator { parent: NONE, absorbing: true });
            open.push((0, 1));
        }
        for (i, token) in tokens.iter().enumerate() {
            while open.last().is_some_and(|&(_, end)| i >= end) {
                open.pop();
            }
            let parent = open.last().map_or(NONE, |&(operator, _)| operator);
            match token.word() {
                Word::Literal { leaf, negated } => found.push((leaf, parent, negated)),
                Word::Node { op, length } => {
                    open.push((operators.len() as u32, i + length as usize));
                    operators.push(Operator { parent, absorbing: op == Op::Or });
                }
            }
        }
        found.sort_unstable();
        let first = (0..=leaves as u32).map(|leaf| found.partition_point(|&(l, ..)| l < leaf) as u32).collect();
        let literals = found.iter().map(|&(_, operator, negated)| (operator, negated)).collect();
        let outside = outside_counts(&operators, &found);
        Operators { operators, outside, first, literals, constant: false }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.operators[..])
            + size_of_val(&self.outside[..])
            + size_of_val(&self.first[..])
            + size_of_val(&self.literals[..])
    }

    /// Calls `visit` for every transition after the ray's start, in order, until it returns false.
    ///
    /// `gathered` holds the crossings of the leaves that the ray may meet; it is empty afterwards.
    pub fn transitions(
        &self,
        solid: &SolidModel,
        gathered: &mut Gathered,
        values: &mut Values,
        visit: impl FnMut(Transition) -> bool,
    ) {
        if !gathered.events.is_empty() {
            let Gathered { events, inside } = gathered;
            events.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.slot.cmp(&b.slot)));
            values.begin(self);
            let mut along = Along { operators: self, values };
            inside.iter().for_each(|&leaf| along.flip(leaf));
            walk(events, solid.tolerance, &mut along, visit);
            events.iter().for_each(|event| values.inside[event.slot as usize] = false);
            inside.iter().for_each(|&leaf| values.inside[leaf as usize] = false);
        }
        gathered.clear();
    }
}

/// Deciding operands of each operator when every leaf is outside. Operands come after their operators, so backwards
/// each is complete when its parent counts it.
fn outside_counts(operators: &[Operator], literals: &[(u32, u32, bool)]) -> Vec<u32> {
    let mut counts = vec![0; operators.len()];
    for &(_, operator, negated) in literals {
        counts[operator as usize] += u32::from(negated == operators[operator as usize].absorbing);
    }
    for i in (1..operators.len()).rev() {
        let Operator { parent, absorbing } = operators[i];
        let value = (counts[i] > 0) == absorbing;
        counts[parent as usize] += u32::from(value == operators[parent as usize].absorbing);
    }
    counts
}

/// Goes along sorted events, cluster by cluster.
fn walk(events: &[Event], tolerance: f64, along: &mut Along, mut visit: impl FnMut(Transition) -> bool) {
    let mut inside = along.value();
    let mut rest = events;
    while let Some(first) = rest.first() {
        let together = rest.iter().take_while(|event| event.t <= first.t + tolerance).count();
        let (cluster, later) = rest.split_at(together);
        let (after, owner) = settle(cluster, inside, along);
        if let Some(owner) = owner {
            let Event { t, slot, face } = cluster[owner];
            let flipped = along.get(slot) != after;
            let shared = cluster.len() > 1;
            if !visit(Transition { t, leaf: slot, face, entering: after, flipped, shared }) {
                return;
            }
        }
        inside = after;
        rest = later;
    }
}

/// Crossings of a solid's leaves along a ray; slots are leaves.
#[derive(Debug, Default)]
pub struct Gathered {
    events: Vec<Event>,
    /// Leaves that the ray starts in.
    inside: Vec<u32>,
}

/// A position to go back to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mark {
    events: usize,
    inside: usize,
}

impl Gathered {
    /// Crosses a leaf. Returns its value if it is the same from `low` to `high`, which lie within the ray.
    pub fn cross(&mut self, solid: &SolidModel, leaf: u32, ray: &SolidRay, low: f64, high: f64) -> Option<bool> {
        let crossings = solid.leaves[leaf as usize].crossings(ray.origin, ray.dir);
        let inside = crossings.inside_after(ray.start);
        if inside {
            self.inside.push(leaf);
        }
        let (mut value, mut changes) = (inside, false);
        let end = ray.end + solid.tolerance;
        for (t, face) in crossings.iter().filter(|&(t, _)| t > ray.start && t <= end) {
            self.events.push(Event { t, slot: leaf, face });
            value ^= t <= low;
            changes |= t > low && t <= high;
        }
        (!changes).then_some(value)
    }

    pub fn mark(&self) -> Mark {
        Mark { events: self.events.len(), inside: self.inside.len() }
    }

    /// Forgets what came after `mark`; names the leaves, some of them repeatedly.
    pub fn rewind(&mut self, mark: Mark, forgotten: impl FnMut(u32)) {
        let events = self.events.drain(mark.events..).map(|event| event.slot);
        events.chain(self.inside.drain(mark.inside..)).for_each(forgotten);
    }

    pub fn clear(&mut self) {
        self.events.clear();
        self.inside.clear();
    }
}

/// The state of an evaluation: counts of operators, and the leaves that the point is in (all false between rays).
#[derive(Debug, Default)]
pub struct Values {
    counts: Vec<u32>,
    inside: Vec<bool>,
}

impl Values {
    fn begin(&mut self, operators: &Operators) {
        self.counts.clear();
        self.counts.extend_from_slice(&operators.outside);
        let leaves = operators.first.len();
        if self.inside.len() < leaves {
            self.inside.resize(leaves, false);
        }
    }
}

/// Values under way.
struct Along<'a> {
    operators: &'a Operators,
    values: &'a mut Values,
}

impl States for Along<'_> {
    fn get(&self, slot: u32) -> bool {
        self.values.inside[slot as usize]
    }

    fn flip(&mut self, slot: u32) {
        let inside = &mut self.values.inside[slot as usize];
        *inside = !*inside;
        let inside = *inside;
        let Operators { operators, first, literals, .. } = self.operators;
        for &(operator, negated) in &literals[first[slot as usize] as usize..first[slot as usize + 1] as usize] {
            let (mut at, mut value) = (operator, inside != negated);
            loop {
                let Operator { parent, absorbing } = operators[at as usize];
                let count = &mut self.values.counts[at as usize];
                let decided = *count > 0;
                *count = if value == absorbing { *count + 1 } else { *count - 1 };
                if decided == (*count > 0) || parent == NONE {
                    break;
                }
                value = (*count > 0) == absorbing;
                at = parent;
            }
        }
    }

    fn value(&self) -> bool {
        match self.operators.operators.first() {
            Some(root) => (self.values.counts[0] > 0) == root.absorbing,
            None => self.operators.constant,
        }
    }
}
