//! The operator tree of a solid, evaluated along a ray: what strategies share that gather the crossings of leaves first and
//! evaluate afterwards.
//!
//! Every operator counts its operands that decide it (true ones of an OR, false ones of an AND); where a leaf is crossed
//! the change goes up as far as values change. The counts at the ray's start are found in one of two ways:
//!
//! - [`Evaluation::Whole`]: by evaluating the whole tree there, as the programs do that `native`, `collect` and `kd` stand for
//!   (S. D. Roth, "Ray casting for modeling solids", 1982). It takes a time proportional to the number of literals.
//! - [`Evaluation::Kept`]: by a copy of those of a point outside all leaves, made at build, and a flip for every leaf
//!   that the ray starts in. It takes no more than the number of operators, which are few where operands are many.
//!
//! Leaves that a strategy leaves out count as outside all along the ray. It may do so where that does not change the
//! value between the ray's start and end: a leaf whose box the ray misses, or one below an operator that others decide.

use crate::cells::Kernel;
use crate::coincidence::{Event, States, settle};
use crate::expression::{Expression, Op, Token, Word};
use crate::solid::SolidModel;
use crate::strategies::gather::Gathered;
use crate::transition::Transition;

const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Operator {
    parent: u32,
    /// The operand value that decides it.
    absorbing: bool,
}

/// How the values at a ray's start are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Evaluation {
    #[default]
    Whole,
    Kept,
}

/// An operand of an operator that is a leaf or its complement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Literal {
    leaf: u32,
    operator: u32,
    negated: bool,
}

/// The operators of an expression, which of them each leaf is an operand of, and how leaves are crossed.
#[derive(Clone, Debug, Default)]
pub struct Operators {
    pub kernels: Vec<Kernel>,
    evaluation: Evaluation,
    operators: Vec<Operator>,
    /// Per operator: deciding operands when every leaf is outside.
    outside: Vec<u32>,
    /// By leaf: those of leaf `i` are `literals[first[i]..first[i + 1]]`.
    literals: Vec<Literal>,
    first: Vec<u32>,
}

impl Operators {
    pub fn new(solid: &SolidModel, evaluation: Evaluation) -> Operators {
        let kernels = solid.leaves.iter().map(Kernel::new).collect();
        match &solid.expression {
            Expression::Constant(_) => Operators { kernels, ..Operators::default() },
            Expression::Tokens(tokens) => {
                Operators { kernels, evaluation, ..Operators::from_tokens(tokens, solid.leaves.len()) }
            }
        }
    }

    fn from_tokens(tokens: &[Token], leaves: usize) -> Operators {
        let (mut operators, mut literals) = (vec![], vec![]);
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
                Word::Literal { leaf, negated } => literals.push(Literal { leaf, operator: parent, negated }),
                Word::Node { op, length } => {
                    open.push((operators.len() as u32, i + length as usize));
                    operators.push(Operator { parent, absorbing: op == Op::Or });
                }
            }
        }
        literals.sort_unstable();
        let first = (0..=leaves as u32).map(|leaf| literals.partition_point(|l| l.leaf < leaf) as u32).collect();
        let mut made = Operators { operators, literals, first, ..Operators::default() };
        let mut outside = vec![];
        made.count(&vec![false; leaves], &mut outside);
        made.outside = outside;
        made
    }

    /// Deciding operands of each operator, from the leaves that a point is in: the whole tree, once. Operands come after
    /// their operators, so backwards each is complete when its parent counts it.
    fn count(&self, inside: &[bool], counts: &mut Vec<u32>) {
        counts.clear();
        counts.resize(self.operators.len(), 0);
        for &Literal { leaf, operator, negated } in &self.literals {
            let value = inside[leaf as usize] != negated;
            counts[operator as usize] += u32::from(value == self.operators[operator as usize].absorbing);
        }
        for i in (1..self.operators.len()).rev() {
            let Operator { parent, absorbing } = self.operators[i];
            let value = (counts[i] > 0) == absorbing;
            counts[parent as usize] += u32::from(value == self.operators[parent as usize].absorbing);
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.kernels[..])
            + size_of_val(&self.operators[..])
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
        // A constant has no operators.
        if !gathered.events.is_empty() && !self.operators.is_empty() {
            let Gathered { events, inside, .. } = gathered;
            events.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.slot.cmp(&b.slot)));
            let mut along = values.begin(self, inside);
            walk(events, solid.tolerance, &mut along, visit);
            events.iter().for_each(|event| values.inside[event.slot as usize] = false);
            inside.iter().for_each(|&leaf| values.inside[leaf as usize] = false);
        }
        gathered.clear();
    }
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

/// The state of an evaluation: counts of operators, and the leaves that the point is in (all false between rays).
#[derive(Debug, Default)]
pub struct Values {
    counts: Vec<u32>,
    inside: Vec<bool>,
}

impl Values {
    /// The values at a point in these leaves.
    fn begin<'a>(&'a mut self, operators: &'a Operators, inside: &[u32]) -> Along<'a> {
        let leaves = operators.first.len();
        if self.inside.len() < leaves {
            self.inside.resize(leaves, false);
        }
        match operators.evaluation {
            Evaluation::Whole => {
                inside.iter().for_each(|&leaf| self.inside[leaf as usize] = true);
                operators.count(&self.inside, &mut self.counts);
                Along { operators, values: self }
            }
            Evaluation::Kept => {
                self.counts.clear();
                self.counts.extend_from_slice(&operators.outside);
                let mut along = Along { operators, values: self };
                inside.iter().for_each(|&leaf| along.flip(leaf));
                along
            }
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
        let own = &literals[first[slot as usize] as usize..first[slot as usize + 1] as usize];
        for &Literal { operator, negated, .. } in own {
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
        (self.values.counts[0] > 0) == self.operators.operators[0].absorbing
    }
}
