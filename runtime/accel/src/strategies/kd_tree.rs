//! A KD tree of our own over boxes: the structure of `native` and `kd`.
//!
//! Built top down by the surface area heuristic with the cost constants of the tree that it stands for (traversal 8,
//! intersection 64) and its depth limit of 48 (V. Havran, "Heuristic Ray Shooting Algorithms", 2000; I. Wald and V. Havran, "On
//! building fast kd-trees", 2006). Boxes are clipped to the cell. Planes are the boxes' faces where a cell holds few
//! boxes, 32 even bins otherwise. What is not in any cell of a ray costs nothing; a box in several cells is
//! met once, by a stamp (mailbox) per box.
//!
//! Boxes must be finite and grown by more than the roundings of a ray: a ray that passes a cell's corner may be sent
//! to the neighbour.

use glam::DVec3;

use arsc_geometry::Aabb;

use crate::Budget;

const TRAVERSAL: f64 = 8.0;
const INTERSECTION: f64 = 64.0;
const DEPTH: u32 = 48;
/// Up to so many boxes every face is tried.
const EXACT: usize = 48;
const BINS: usize = 32;
/// Share of a cell's cost that an empty half saves besides its area.
const EMPTY_BONUS: f64 = 0.2;
/// Boxes may be held this many times over (and some more), then cells stay as they are.
const COPIES: usize = 16;

#[derive(Clone, Copy, Debug)]
enum Node {
    /// The half below the plane is the next node.
    Inner {
        axis: u8,
        position: f64,
        above: u32,
    },
    Leaf {
        first: u32,
        count: u32,
    },
}

#[derive(Clone, Debug, Default)]
pub struct KdTree {
    bounds: Aabb,
    nodes: Vec<Node>,
    items: Vec<u32>,
    /// Number of boxes.
    count: usize,
}

/// Which boxes a ray has met, and the cells that it has still to pass.
#[derive(Debug, Default)]
pub struct Mailbox {
    stamps: Vec<u32>,
    stamp: u32,
    todo: Vec<(u32, f64, f64)>,
}

impl Mailbox {
    /// Forgets everything; numbers below `count` may be asked for.
    pub fn begin(&mut self, count: usize) {
        if self.stamps.len() < count {
            self.stamps.resize(count, 0);
        }
        self.stamp = self.stamp.wrapping_add(1);
        if self.stamp == 0 {
            self.stamps.fill(0);
            self.stamp = 1;
        }
    }

    /// Whether this is the first time.
    pub fn is_new(&mut self, number: u32) -> bool {
        std::mem::replace(&mut self.stamps[number as usize], self.stamp) != self.stamp
    }

    pub fn forget(&mut self, number: u32) {
        self.stamps[number as usize] = 0;
    }
}

impl KdTree {
    /// `boxes` are finite; an empty one is never met. Numbers are positions in the list. When the budget is spent cells
    /// stay as they are.
    pub fn build(boxes: &[Aabb], budget: &Budget) -> KdTree {
        let numbers = 0..boxes.len() as u32;
        let items: Vec<(u32, Aabb)> = numbers.zip(boxes.iter().copied()).filter(|(_, b)| !b.is_empty()).collect();
        let bounds = items.iter().fold(Aabb::EMPTY, |hull, (_, b)| hull.union(b));
        let mut tree = KdTree { bounds, nodes: vec![], items: vec![], count: boxes.len() };
        let most = (COPIES * items.len() + 4096).min(budget.bytes / (size_of::<Node>() + size_of::<u32>()));
        // Every cut makes one cell more.
        let mut cells = 1;
        let mut work = vec![(bounds, items, 0, None)];
        // Cells that wait hold items too: counted with those that are placed.
        let mut held = work[0].1.len();
        while let Some((cell, items, depth, parent)) = work.pop() {
            let here = tree.nodes.len() as u32;
            if let Some(parent) = parent
                && let Node::Inner { above, .. } = &mut tree.nodes[parent as usize]
            {
                *above = here;
            }
            let split =
                if depth < DEPTH && held < most && cells < budget.cells { best_split(&cell, &items) } else { None };
            match split {
                None => tree.push_leaf(&items),
                Some((axis, position)) => {
                    cells += 1;
                    tree.nodes.push(Node::Inner { axis: axis as u8, position, above: 0 });
                    let [low, high] = halves(&cell, axis, position);
                    let within = |half: &Aabb| -> Vec<(u32, Aabb)> {
                        let clipped = items.iter().map(|(number, b)| (*number, b.intersection(half)));
                        clipped.filter(|(_, b)| !b.is_empty()).collect()
                    };
                    let (below, above) = (within(&low), within(&high));
                    held = held - items.len() + below.len() + above.len();
                    work.push((high, above, depth + 1, Some(here)));
                    work.push((low, below, depth + 1, None));
                }
            }
        }
        tree
    }

    fn push_leaf(&mut self, items: &[(u32, Aabb)]) {
        let first = self.items.len() as u32;
        self.items.extend(items.iter().map(|(number, _)| number));
        self.nodes.push(Node::Leaf { first, count: items.len() as u32 });
    }

    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.items[..])
    }

    pub fn cells(&self) -> usize {
        self.nodes.iter().filter(|node| matches!(node, Node::Leaf { count: 1.., .. })).count()
    }

    /// Calls `visit` once for every box in the cells that the ray passes between `low` and `high`, front to back.
    pub fn visit(
        &self,
        origin: DVec3,
        inverse_dir: DVec3,
        (low, high): (f64, f64),
        mailbox: &mut Mailbox,
        mut visit: impl FnMut(u32),
    ) {
        mailbox.begin(self.count);
        let (enter, exit) = crate::query::slab(&self.bounds, origin, inverse_dir);
        let (mut low, mut high) = (low.max(enter), high.min(exit));
        if self.nodes.is_empty() || low > high {
            return;
        }
        let mut at = 0;
        mailbox.todo.clear();
        loop {
            match self.nodes[at as usize] {
                Node::Inner { axis, position, above } => {
                    let axis = usize::from(axis);
                    let rising = inverse_dir[axis] > 0.0;
                    let t = (position - origin[axis]) * inverse_dir[axis];
                    let (near, far) = if rising { (at + 1, above) } else { (above, at + 1) };
                    if t.is_nan() || inverse_dir[axis].is_infinite() {
                        // Along the plane: one side, or both if in it.
                        if origin[axis] == position {
                            mailbox.todo.push((above, low, high));
                        }
                        at = if origin[axis] <= position { at + 1 } else { above };
                    } else if t >= high {
                        at = near;
                    } else if t <= low {
                        at = far;
                    } else {
                        mailbox.todo.push((far, t, high));
                        (at, high) = (near, t);
                    }
                    continue;
                }
                Node::Leaf { first, count } => {
                    for &number in &self.items[first as usize..][..count as usize] {
                        if mailbox.is_new(number) {
                            visit(number);
                        }
                    }
                }
            }
            match mailbox.todo.pop() {
                Some(next) => (at, low, high) = next,
                None => return,
            }
        }
    }
}

fn halves(cell: &Aabb, axis: usize, position: f64) -> [Aabb; 2] {
    let (mut low, mut high) = (*cell, *cell);
    low.max[axis] = position;
    high.min[axis] = position;
    [low, high]
}

fn half_area(b: &Aabb) -> f64 {
    let e = b.extent();
    e.x * e.y + e.y * e.z + e.z * e.x
}

/// The cheapest plane, if it is cheaper than no cut. Costs are relative to the area of the cell.
fn best_split(cell: &Aabb, items: &[(u32, Aabb)]) -> Option<(usize, f64)> {
    let whole = half_area(cell);
    if items.is_empty() || whole <= 0.0 {
        return None;
    }
    let mut best = (INTERSECTION * items.len() as f64, None);
    for axis in 0..3 {
        let mut consider = |position: f64, below: usize, above: usize| {
            if !(position > cell.min[axis] && position < cell.max[axis]) {
                return;
            }
            let [low, high] = halves(cell, axis, position).map(|half| half_area(&half) / whole);
            let bonus = if below == 0 || above == 0 { 1.0 - EMPTY_BONUS } else { 1.0 };
            let cost = TRAVERSAL + bonus * INTERSECTION * (low * below as f64 + high * above as f64);
            if cost < best.0 {
                best = (cost, Some((axis, position)));
            }
        };
        if items.len() <= EXACT { faces(items, axis, &mut consider) } else { bins(cell, items, axis, &mut consider) }
    }
    best.1
}

/// Every face of a box, with the numbers of boxes that reach below and above it. A box with its face in the plane is on
/// both sides, as the closed halves are.
fn faces(items: &[(u32, Aabb)], axis: usize, consider: &mut impl FnMut(f64, usize, usize)) {
    for (_, b) in items {
        for position in [b.min[axis].next_down(), b.max[axis].next_up()] {
            let below = items.iter().filter(|(_, b)| b.min[axis] <= position).count();
            let above = items.iter().filter(|(_, b)| b.max[axis] >= position).count();
            consider(position, below, above);
        }
    }
}

/// Even planes; boxes are counted by the bins that they begin and end in.
fn bins(cell: &Aabb, items: &[(u32, Aabb)], axis: usize, consider: &mut impl FnMut(f64, usize, usize)) {
    let (low, width) = (cell.min[axis], cell.max[axis] - cell.min[axis]);
    let bin = |x: f64| (((x - low) / width * BINS as f64) as usize).min(BINS - 1);
    let (mut begins, mut ends) = ([0usize; BINS], [0usize; BINS]);
    for (_, b) in items {
        begins[bin(b.min[axis])] += 1;
        ends[bin(b.max[axis])] += 1;
    }
    let (mut below, mut above) = (0, items.len());
    for i in 1..BINS {
        below += begins[i - 1];
        above -= ends[i - 1];
        consider(low + width * i as f64 / BINS as f64, below, above);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [-1, 1) from a linear congruence.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn every_box_on_the_way_is_met_once() {
        let mut number = numbers(1);
        let mut point = move || DVec3::new(number(), number(), number());
        let mut mailbox = Mailbox::default();
        for count in [0usize, 1, 7, 60, 900] {
            let mut boxes: Vec<Aabb> = (0..count)
                .map(|_| {
                    let (center, half) = (point(), point().abs() * 0.2);
                    Aabb::new(center - half, center + half)
                })
                .collect();
            // Flat ones, equal ones and an empty one.
            if count > 5 {
                boxes[1] = boxes[0];
                boxes[2].max.x = boxes[2].min.x;
                boxes[3] = Aabb::EMPTY;
            }
            let tree = KdTree::build(&boxes, &Budget::UNLIMITED);
            for i in 0..400 {
                let mut dir = point();
                if i % 4 == 0 {
                    dir[i / 4 % 3] = 0.0;
                }
                let (origin, inverse, range) = (point() * 1.5, dir.recip(), (0.0, if i % 3 == 0 { 0.7 } else { 1e9 }));
                let mut met = vec![0; count];
                tree.visit(origin, inverse, range, &mut mailbox, |number| met[number as usize] += 1);
                for (b, met) in boxes.iter().zip(met) {
                    let (low, high) = crate::query::slab(b, origin, inverse);
                    let expected = !b.is_empty() && low.max(range.0) <= high.min(range.1);
                    assert!(met <= 1 && (met == 1 || !expected), "{b:?} met {met} times");
                }
            }
        }
    }

    #[test]
    fn a_ray_meets_few_of_many() {
        let mut number = numbers(2);
        let half = DVec3::splat(0.005);
        let boxes: Vec<Aabb> = (0..20_000)
            .map(|_| {
                let center = DVec3::new(number(), number(), number());
                Aabb::new(center - half, center + half)
            })
            .collect();
        let tree = KdTree::build(&boxes, &Budget::UNLIMITED);
        let (mut mailbox, mut met) = (Mailbox::default(), 0);
        for _ in 0..100 {
            let origin = DVec3::new(-2.0, number(), number());
            let dir = DVec3::new(1.0, 0.2 * number(), 0.2 * number());
            tree.visit(origin, dir.recip(), (0.0, 1e9), &mut mailbox, |_| met += 1);
        }
        assert!(met < 100 * 60, "{met}");
        assert!(tree.bytes() < 300 * 20_000, "{} bytes", tree.bytes());
    }
}
