//! Coincident surfaces: one rule for every strategy (docs/csg.md).
//!
//! Crossings within the solid's tolerance of the first of them form a cluster and happen at once: all leaves flip, then
//! the expression is evaluated. If its value changes, the cluster is a boundary point, and it belongs to the lowest leaf
//! that is *pivotal*: flipping it alone, before or after the cluster, changes the value. Leaves that the expression
//! does not depend on are never pivotal, so an expression simplified for a cell has the same owner as the whole tree.

/// A crossing of a leaf along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    pub t: f64,
    /// Position in the leaf list that the states belong to; ascending positions are ascending leaves.
    pub slot: u32,
    pub face: u32,
}

/// Which leaves a point is in, and what the expression makes of it.
pub trait States {
    fn get(&self, slot: u32) -> bool;
    fn flip(&mut self, slot: u32);
    fn value(&self) -> bool;
}

/// States whose value is computed each time.
pub struct Plain<'a, E> {
    pub states: &'a mut [bool],
    pub eval: E,
}

impl<E: Fn(&[bool]) -> bool> States for Plain<'_, E> {
    fn get(&self, slot: u32) -> bool {
        self.states[slot as usize]
    }

    fn flip(&mut self, slot: u32) {
        let state = &mut self.states[slot as usize];
        *state = !*state;
    }

    fn value(&self) -> bool {
        (self.eval)(self.states)
    }
}

/// Flips the states of a cluster. Returns the value after it, and the index of the owner's event if the value changed.
#[inline]
pub fn settle(cluster: &[Event], before: bool, states: &mut impl States) -> (bool, Option<usize>) {
    flip(cluster, states);
    let after = states.value();
    if after == before {
        return (after, None);
    }
    if cluster.len() == 1 {
        return (after, Some(0));
    }
    (after, owner(cluster, before, after, states))
}

/// The owner's event of a cluster whose flips have changed the value.
#[cold]
fn owner(cluster: &[Event], before: bool, after: bool, states: &mut impl States) -> Option<usize> {
    let slots = flipped_slots(cluster);
    let index = |slot: u32| cluster.iter().position(|event| event.slot == slot);
    for &slot in &slots {
        states.flip(slot);
        let from_after = states.value();
        states.flip(slot);
        flip(cluster, states);
        states.flip(slot);
        let from_before = states.value();
        states.flip(slot);
        flip(cluster, states);
        if from_after != after || from_before != before {
            return index(slot);
        }
    }
    // No single leaf decides: from the outside state on, the last flip in ascending order that changes the value.
    if after {
        flip(cluster, states);
    }
    let (mut value, mut owner) = (false, slots[0]);
    for &slot in &slots {
        states.flip(slot);
        let next = states.value();
        if next != value {
            (value, owner) = (next, slot);
        }
    }
    if !after {
        flip(cluster, states);
    }
    index(owner)
}

fn flip(cluster: &[Event], states: &mut impl States) {
    cluster.iter().for_each(|event| states.flip(event.slot));
}

/// Leaves crossed an odd number of times, ascending.
fn flipped_slots(cluster: &[Event]) -> smallvec::SmallVec<[u32; 8]> {
    let mut slots: smallvec::SmallVec<[u32; 8]> = cluster.iter().map(|event| event.slot).collect();
    slots.sort_unstable();
    let mut odd = smallvec::SmallVec::new();
    for run in slots.chunk_by(|a, b| a == b) {
        if run.len() % 2 == 1 {
            odd.push(run[0]);
        }
    }
    odd
}

#[cfg(test)]
mod tests {
    use super::*;

    fn owner(start: [bool; 3], slots: &[u32], f: fn(&[bool]) -> bool) -> (bool, Option<u32>) {
        let mut states = start;
        let cluster: Vec<Event> = slots.iter().map(|&slot| Event { t: 1.0, slot, face: 0 }).collect();
        let (after, index) = settle(&cluster, f(&start), &mut Plain { states: &mut states, eval: f });
        for (i, state) in states.iter().enumerate() {
            let odd = slots.iter().filter(|&&s| s as usize == i).count() % 2 == 1;
            assert_eq!(*state, start[i] != odd);
        }
        assert_eq!(after, f(&states));
        (after, index.map(|i| cluster[i].slot))
    }

    #[test]
    fn first_operand_owns_coincident_faces() {
        let union: fn(&[bool]) -> bool = |s| s[0] || s[1];
        assert_eq!(owner([false; 3], &[1, 0], union), (true, Some(0)));
        assert_eq!(owner([true, true, false], &[1, 0], union), (false, Some(0)));
        let intersection: fn(&[bool]) -> bool = |s| s[0] && s[1];
        assert_eq!(owner([false; 3], &[1, 0], intersection), (true, Some(0)));
    }

    #[test]
    fn subtracted_coplanar_faces_leave_no_skin() {
        let difference: fn(&[bool]) -> bool = |s| s[0] && !s[1];
        assert_eq!(owner([false; 3], &[0, 1], difference), (false, None));
        assert_eq!(owner([false; 3], &[1, 0], difference), (false, None));
        // The subtrahend touches from outside and removes nothing: the face stays the first operand's.
        assert_eq!(owner([false, true, false], &[0, 1], difference), (true, Some(0)));
    }

    #[test]
    fn leaves_without_influence_own_nothing() {
        // Leaf 0 is removed here by leaf 1; the face is leaf 2's.
        let f: fn(&[bool]) -> bool = |s| (s[0] && !s[1]) || s[2];
        assert_eq!(owner([false, true, false], &[0, 2], f), (true, Some(2)));
        // Touched twice by a tangent: no flip.
        assert_eq!(owner([false; 3], &[0, 0, 2], f), (true, Some(2)));
    }

    #[test]
    fn majority_has_an_owner() {
        let majority: fn(&[bool]) -> bool = |s| s.iter().filter(|&&x| x).count() >= 2;
        assert_eq!(owner([false; 3], &[0, 1, 2], majority), (true, Some(1)));
        assert_eq!(owner([true; 3], &[2, 1, 0], majority), (false, Some(1)));
    }
}
