//! A binary tree of rectangles, for shapes made from thousands of edges.

use glam::DVec2;

/// Leaves hold at most so many items.
const LEAF: usize = 4;

#[derive(Clone, Copy, Debug)]
struct Node {
    min: DVec2,
    max: DVec2,
    /// Leaf: its first position in `order`. Inner: the second child; the first follows the node.
    first: u32,
    /// 0 for inner nodes.
    count: u32,
}

/// Rectangles by number.
#[derive(Clone, Debug)]
pub(crate) struct BoxTree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl BoxTree {
    /// Of rectangles (least and greatest corner), at least one.
    pub(crate) fn new(boxes: &[(DVec2, DVec2)]) -> BoxTree {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        build(boxes, &mut order, 0, &mut nodes);
        BoxTree { nodes, order }
    }

    /// Calls `item` for the items of all leaves whose rectangle, and those of its ancestors, `enter` accepts.
    pub(crate) fn visit(&self, mut enter: impl FnMut(DVec2, DVec2) -> bool, mut item: impl FnMut(u32)) {
        // Halves are of equal size, so the depth is below 32.
        let mut stack = [0u32; 64];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let at = stack[height];
            let node = &self.nodes[at as usize];
            if !enter(node.min, node.max) {
                continue;
            }
            if node.count > 0 {
                self.order[node.first as usize..][..node.count as usize].iter().for_each(|&i| item(i));
            } else {
                stack[height] = node.first;
                stack[height + 1] = at + 1;
                height += 2;
            }
        }
    }
}

fn build(boxes: &[(DVec2, DVec2)], order: &mut [u32], start: u32, nodes: &mut Vec<Node>) {
    let min = order.iter().fold(DVec2::INFINITY, |m, &i| m.min(boxes[i as usize].0));
    let max = order.iter().fold(DVec2::NEG_INFINITY, |m, &i| m.max(boxes[i as usize].1));
    let at = nodes.len();
    nodes.push(Node { min, max, first: start, count: order.len() as u32 });
    if order.len() <= LEAF {
        return;
    }
    let axis = usize::from((max - min).y > (max - min).x);
    let key = |i: u32| boxes[i as usize].0[axis] + boxes[i as usize].1[axis];
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&i, &j| key(i).total_cmp(&key(j)).then(i.cmp(&j)));
    let (low, high) = order.split_at_mut(half);
    build(boxes, low, start, nodes);
    let second = nodes.len() as u32;
    build(boxes, high, start + half as u32, nodes);
    nodes[at].first = second;
    nodes[at].count = 0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_overlaps() {
        let boxes: Vec<(DVec2, DVec2)> = (0..500)
            .map(|i| {
                let p = DVec2::new(f64::from(i * 37 % 101), f64::from(i * 53 % 97));
                (p, p + DVec2::new(f64::from(i % 7), 1.0))
            })
            .collect();
        let tree = BoxTree::new(&boxes);
        let (low, high) = (DVec2::new(20.0, 30.0), DVec2::new(40.0, 35.0));
        let overlaps = |min: DVec2, max: DVec2| min.cmple(high).all() && max.cmpge(low).all();
        let mut found = Vec::new();
        tree.visit(overlaps, |i| {
            if overlaps(boxes[i as usize].0, boxes[i as usize].1) {
                found.push(i);
            }
        });
        found.sort_unstable();
        let expected: Vec<u32> = (0..500).filter(|&i| overlaps(boxes[i as usize].0, boxes[i as usize].1)).collect();
        assert!(!expected.is_empty());
        assert_eq!(found, expected);
    }
}
