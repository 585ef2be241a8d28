//! The oracle of the tests: every leaf crossed, the whole expression evaluated anew at every crossing (Roth 1982). Slow and
//! obvious; it shares nothing with the strategies but the leaves, the expression and the rule for coincident crossings.

use std::cell::RefCell;

use crate::coincidence::{Event, Plain, States, settle};
use crate::expression::{Expression, eval};
use crate::solid::{SolidModel, SolidRay};
use crate::transition::Transition;

#[derive(Default)]
struct Scratch {
    events: Vec<Event>,
    states: Vec<bool>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Calls `visit` for every transition after the ray's start, in order, until it returns false. Returns whether the ray
/// starts inside.
pub fn transitions(solid: &SolidModel, ray: &SolidRay, mut visit: impl FnMut(Transition) -> bool) -> bool {
    let tokens = match &solid.expression {
        Expression::Constant(value) => return *value,
        Expression::Tokens(tokens) => tokens,
    };
    SCRATCH.with_borrow_mut(|Scratch { events, states }| {
        events.clear();
        states.clear();
        for (slot, leaf) in (0..).zip(&solid.leaves) {
            let crossings = leaf.crossings(ray.origin, ray.dir);
            states.push(crossings.inside_after(ray.start));
            let after = crossings.iter().filter(|&(t, _)| t > ray.start);
            events.extend(after.map(|(t, face)| Event { t, slot, face }));
        }
        events.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.slot.cmp(&b.slot)));
        let mut states = Plain { states, eval: |states: &[bool]| eval(tokens, |leaf| states[leaf as usize]) };
        let start = states.value();
        let mut inside = start;
        let mut rest = &events[..];
        while let Some(first) = rest.first() {
            let together = rest.iter().take_while(|event| event.t <= first.t + solid.tolerance).count();
            let (cluster, later) = rest.split_at(together);
            let (after, owner) = settle(cluster, inside, &mut states);
            if let Some(owner) = owner {
                let Event { t, slot, face } = cluster[owner];
                let flipped = states.get(slot) != after;
                let shared = cluster.len() > 1;
                if !visit(Transition { t, leaf: slot, face, entering: after, flipped, shared }) {
                    break;
                }
            }
            inside = after;
            rest = later;
        }
        start
    })
}
