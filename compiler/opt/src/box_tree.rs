//! Which of many boxes overlap a given one: a binary tree over boxes, split at the median of the widest axis.
//!
//! Built in O(n log n), asked in O(log n + answers) for boxes that do not overlap much. Boxes that are not finite in
//! every axis stand beside the tree and are compared one by one.

use arsc_geometry::Aabb;

const LEAF_BOXES: usize = 4;

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

    /// Calls `found` for each box that overlaps (touching counts), until it says false. In no order to rely on.
    pub fn overlapping(&self, query: &Aabb, mut found: impl FnMut(usize) -> bool) {
        if query.is_empty() {
            return;
        }
        for &i in &self.unbounded {
            if self.boxes[i as usize].overlaps(query) && !found(i as usize) {
                return;
            }
        }
        let mut stack: Vec<u32> = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at as usize];
            if !node.bounds.overlaps(query) {
                continue;
            }
            if node.right != 0 {
                stack.extend([node.right, at + 1]);
                continue;
            }
            for &i in &self.order[node.start as usize..node.end as usize] {
                if self.boxes[i as usize].overlaps(query) && !found(i as usize) {
                    return;
                }
            }
        }
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
        for query in &boxes {
            let mut found = Vec::new();
            tree.overlapping(query, |i| {
                found.push(i);
                true
            });
            found.sort();
            let expected: Vec<usize> = (0..boxes.len()).filter(|&i| boxes[i].overlaps(query)).collect();
            assert_eq!(found, expected);
        }
    }
}
