//! Which of many boxes overlap or contain a given one: a binary tree over boxes, split at the median of the widest axis.
//!
//! Built in O(n log n), asked in O(log n + answers) for boxes that do not overlap much. Where all overlap all, the answers
//! are as many as the boxes, so searches draw on a budget of [`Work`] and may end early. Boxes that are not finite
//! in every axis stand beside the tree and are compared one by one.

use arsc_geometry::Aabb;

const LEAF_BOXES: usize = 4;
/// Boxes (also those of tree nodes) compared per search, on average over all searches. Scenes that are not made to be
/// hard need some 30.
const STEPS_PER_SEARCH: usize = 128;
/// No single search may use up what is meant for the others.
const MOST_STEPS: usize = 4096;

/// What a number of searches may do together. Counted, not timed: the same input always ends at the same place.
#[derive(Default)]
pub(crate) struct Work {
    steps_left: usize,
}

impl Work {
    pub fn for_searches(searches: usize) -> Work {
        Work { steps_left: MOST_STEPS + STEPS_PER_SEARCH * searches }
    }

    pub fn is_spent(&self) -> bool {
        self.steps_left == 0
    }
}

/// What is looked for, and how far the search may go.
struct Search<'q> {
    query: &'q Aabb,
    meets: fn(&Aabb, &Aabb) -> bool,
    steps_left: usize,
}

impl Search<'_> {
    /// `None` when nothing may be compared any more.
    fn admits(&mut self, bounds: &Aabb) -> Option<bool> {
        self.steps_left = self.steps_left.checked_sub(1)?;
        Some((self.meets)(bounds, self.query))
    }
}

struct Node {
    bounds: Aabb,
    /// Range of `order`.
    start: u32,
    end: u32,
    /// Index of the right child; the left one follows its parent. 0: no children.
    right: u32,
}

pub(crate) struct BoxTree<'a> {
    boxes: &'a [Aabb],
    order: Vec<u32>,
    nodes: Vec<Node>,
    unbounded: Vec<u32>,
}

impl<'a> BoxTree<'a> {
    /// Empty boxes overlap nothing.
    pub fn new(boxes: &'a [Aabb]) -> BoxTree<'a> {
        let indices = (0..boxes.len() as u32).filter(|&i| !boxes[i as usize].is_empty());
        let (order, unbounded): (Vec<u32>, Vec<u32>) = indices.partition(|&i| boxes[i as usize].is_finite());
        let mut tree = BoxTree { boxes, order, nodes: Vec::new(), unbounded };
        if !tree.order.is_empty() {
            tree.build(0, tree.order.len());
        }
        tree
    }

    /// Depth is logarithmic because every split is at the median.
    fn build(&mut self, start: usize, end: usize) {
        let bounds = self.order[start..end].iter().fold(Aabb::EMPTY, |hull, &i| hull.union(&self.boxes[i as usize]));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, start: start as u32, end: end as u32, right: 0 });
        if end - start <= LEAF_BOXES {
            return;
        }
        let centers = self.order[start..end].iter().fold(Aabb::EMPTY, |hull, &i| {
            let center = self.boxes[i as usize].center();
            hull.union(&Aabb::new(center, center))
        });
        let axis = centers.extent().max_position();
        let middle = (end - start) / 2;
        let key = |i: &u32| self.boxes[*i as usize].center()[axis];
        self.order[start..end].select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        self.build(start, start + middle);
        self.nodes[node].right = self.nodes.len() as u32;
        self.build(start + middle, end);
    }

    /// Calls `found` for each box that overlaps (touching counts), until it says false. In no order to rely on. Returns
    /// whether it went as far as it should: false when the work ran out.
    pub fn overlapping(&self, query: &Aabb, work: &mut Work, found: impl FnMut(usize) -> bool) -> bool {
        self.search(query, Aabb::overlaps, work, found)
    }

    /// Like [`BoxTree::overlapping`] for each box that contains the query; large ones tend to come first.
    pub fn containing(&self, query: &Aabb, work: &mut Work, found: impl FnMut(usize) -> bool) -> bool {
        self.search(query, Aabb::contains_box, work, found)
    }

    fn search(
        &self,
        query: &Aabb,
        meets: fn(&Aabb, &Aabb) -> bool,
        work: &mut Work,
        found: impl FnMut(usize) -> bool,
    ) -> bool {
        if query.is_empty() {
            return true;
        }
        let granted = work.steps_left.min(MOST_STEPS);
        let mut search = Search { query, meets, steps_left: granted };
        let complete = self.walk(&mut search, found).is_some();
        work.steps_left -= granted - search.steps_left;
        complete
    }

    /// `None` when the work ran out.
    fn walk(&self, search: &mut Search, mut found: impl FnMut(usize) -> bool) -> Option<()> {
        for &i in &self.unbounded {
            if search.admits(&self.boxes[i as usize])? && !found(i as usize) {
                return Some(());
            }
        }
        let mut stack: Vec<u32> = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at as usize];
            if !search.admits(&node.bounds)? {
                continue;
            }
            if node.right != 0 {
                let children = [node.right, at + 1];
                let [right, left] = children.map(|child| self.nodes[child as usize].bounds.extent().element_sum());
                stack.extend(if left < right { [at + 1, node.right] } else { children });
                continue;
            }
            for &i in &self.order[node.start as usize..node.end as usize] {
                if search.admits(&self.boxes[i as usize])? && !found(i as usize) {
                    return Some(());
                }
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arsc_geometry::DVec3;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn finds_what_the_pairwise_test_finds() {
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let boxes: Vec<Aabb> = (0..300)
            .map(|i| {
                let min = DVec3::from_array(std::array::from_fn(|_| rng.random_range(0..20) as f64));
                let size = DVec3::from_array(std::array::from_fn(|_| rng.random_range(0..4) as f64));
                match i % 50 {
                    0 => Aabb::EMPTY,
                    1 => Aabb::new(min, DVec3::new(min.x, min.y, f64::INFINITY)),
                    _ => Aabb::new(min, min + size),
                }
            })
            .collect();
        let tree = BoxTree::new(&boxes);
        let mut work = Work::for_searches(100 * boxes.len());
        for query in &boxes {
            let mut found = [Vec::new(), Vec::new()];
            assert!(tree.overlapping(query, &mut work, |i| {
                found[0].push(i);
                true
            }));
            assert!(tree.containing(query, &mut work, |i| {
                found[1].push(i);
                true
            }));
            found.iter_mut().for_each(|list| list.sort());
            let all = |meets: fn(&Aabb, &Aabb) -> bool| {
                (0..boxes.len()).filter(|&i| !query.is_empty() && meets(&boxes[i], query)).collect::<Vec<usize>>()
            };
            assert_eq!(found, [all(Aabb::overlaps), all(Aabb::contains_box)]);
        }
    }

    /// Counts what is compared, for boxes that overlap all others.
    #[test]
    fn work_is_proportional_to_the_number_of_boxes() {
        const N: usize = 20_000;
        let cube = |i: usize, size: fn(usize) -> f64, shift: fn(usize) -> f64| {
            let (half, at) = (DVec3::splat(size(i)), DVec3::new(shift(i), 0.0, 0.0));
            Aabb::new(at - half, at + half)
        };
        let endless = |i: usize| Aabb::new(DVec3::splat(-(i as f64)), DVec3::splat(f64::INFINITY));
        let equal: Vec<Aabb> = (0..N).map(|i| cube(i, |_| 1.0, |_| 0.0)).collect();
        let nested: Vec<Aabb> = (0..N).map(|i| cube(i, |i| 1.0 + i as f64, |_| 0.0)).collect();
        let shifted: Vec<Aabb> = (0..N).map(|i| cube(i, |_| 1.0, |i| 1e-5 * i as f64)).collect();
        let unbounded: Vec<Aabb> = (0..N).map(endless).collect();
        for boxes in [equal, nested, shifted, unbounded] {
            let tree = BoxTree::new(&boxes);
            let mut work = Work::for_searches(N);
            let (mut pairs, mut complete) = (0, 0);
            for query in &boxes {
                complete += usize::from(tree.overlapping(query, &mut work, |_| {
                    pairs += 1;
                    true
                }));
            }
            assert!(work.is_spent() && pairs < 200 * N, "{pairs}");
            assert_eq!(complete, 0, "a search that ends early says so");
        }
    }

    #[test]
    fn the_largest_of_nested_boxes_is_found_at_once() {
        const N: usize = 20_000;
        let cube = |i: usize| Aabb::new(DVec3::splat(-1.0 - i as f64), DVec3::splat(1.0 + i as f64));
        // In an order that the tree cannot profit from.
        let boxes: Vec<Aabb> = (0..N).map(|i| cube(i * 7919 % N)).collect();
        let tree = BoxTree::new(&boxes);
        let mut work = Work::for_searches(1);
        for query in &boxes[..20] {
            let mut first = Vec::new();
            assert!(tree.containing(query, &mut work, |i| {
                first.push(boxes[i].max.x);
                first.len() < LEAF_BOXES
            }));
            let half = first.into_iter().fold(0.0, f64::max);
            assert!(half > 0.99 * N as f64, "{half}");
        }
    }
}
