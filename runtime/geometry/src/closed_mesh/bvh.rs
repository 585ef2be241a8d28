//! A bounding volume hierarchy over triangles: binary, by the surface area heuristic with bins (Wald 2007).
//!
//! Boxes are single precision, as the vertices are, and so exact. Deterministic: the same mesh gives the same tree.

use std::rc::Rc;

use glam::{DVec3, Vec3};
use smallvec::SmallVec;

use crate::{Aabb, TriangleMesh};

const BINS: usize = 16;
/// Leaves have at most so many triangles, unless their centres coincide.
const LEAF: usize = 4;
/// Cost of a node, in triangles.
const NODE_COST: f32 = 1.0;

#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub min: [f32; 3],
    /// Of two children that follow each other, or of the leaf's triangles in `order`.
    first: u32,
    pub max: [f32; 3],
    /// Number of triangles; 0 for an inner node.
    count: u32,
}

#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

/// What is known of a triangle during the build.
struct Item {
    min: Vec3,
    max: Vec3,
}

impl Item {
    fn center(&self) -> Vec3 {
        // Halved first: the sum of large coordinates may overflow.
        self.min * 0.5 + self.max * 0.5
    }
}

#[derive(Clone, Copy)]
struct Box3 {
    min: Vec3,
    max: Vec3,
}

impl Box3 {
    const EMPTY: Box3 = Box3 { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    fn add(&mut self, min: Vec3, max: Vec3) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }

    fn area(&self) -> f32 {
        let e = (self.max - self.min).max(Vec3::ZERO);
        e.x * e.y + e.y * e.z + e.z * e.x
    }
}

impl Bvh {
    pub fn new(mesh: &TriangleMesh) -> Bvh {
        let item = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| Vec3::from_array(mesh.positions[i as usize]));
            Item { min: a.min(b).min(c), max: a.max(b).max(c) }
        };
        let items: Vec<Item> = mesh.triangles.iter().map(item).collect();
        let mut bvh = Bvh { nodes: Vec::new(), order: (0..items.len() as u32).collect() };
        bvh.nodes.push(Node { min: [0.0; 3], first: 0, max: [0.0; 3], count: 0 });
        let mut work = vec![(0usize, 0usize, items.len())];
        while let Some((node, start, end)) = work.pop() {
            let bounds = bvh.bounds(&items, start, end);
            let cut = bvh.cut(&items, start, end, &bounds);
            let first = if cut.is_some() { bvh.nodes.len() } else { start } as u32;
            let count = if cut.is_some() { 0 } else { end - start } as u32;
            bvh.nodes[node] = Node { min: bounds.min.to_array(), first, max: bounds.max.to_array(), count };
            if let Some(middle) = cut {
                let blank = bvh.nodes[node];
                bvh.nodes.extend([blank, blank]);
                work.push((first as usize, start, middle));
                work.push((first as usize + 1, middle, end));
            }
        }
        bvh
    }

    fn bounds(&self, items: &[Item], start: usize, end: usize) -> Box3 {
        let mut bounds = Box3::EMPTY;
        for &i in &self.order[start..end] {
            bounds.add(items[i as usize].min, items[i as usize].max);
        }
        bounds
    }

    /// Partitions a stretch of `order` in two; `None` when it is to be a leaf.
    fn cut(&mut self, items: &[Item], start: usize, end: usize, bounds: &Box3) -> Option<usize> {
        if end - start <= 1 {
            return None;
        }
        let order = &mut self.order[start..end];
        let mut centers = Box3::EMPTY;
        for &i in order.iter() {
            centers.add(items[i as usize].center(), items[i as usize].center());
        }
        let extent = centers.max - centers.min;
        let axis = extent.max_position();
        if !(extent[axis] > 0.0 && extent[axis].is_finite()) {
            // All in one place: halves keep leaves small.
            return (order.len() > LEAF).then_some(start + order.len() / 2);
        }
        let scale = BINS as f32 * 0.999_999 / extent[axis];
        let bin = |i: u32| (((items[i as usize].center()[axis] - centers.min[axis]) * scale) as usize).min(BINS - 1);
        let mut bins = [(Box3::EMPTY, 0usize); BINS];
        for &i in order.iter() {
            let (hull, count) = &mut bins[bin(i)];
            hull.add(items[i as usize].min, items[i as usize].max);
            *count += 1;
        }
        let (plane, cost) = best_plane(&bins);
        let leaf_cost = order.len() as f32;
        if order.len() <= LEAF && NODE_COST + cost / bounds.area().max(f32::MIN_POSITIVE) >= leaf_cost {
            return None;
        }
        let mut middle = 0;
        for i in 0..order.len() {
            if bin(order[i]) <= plane {
                order.swap(i, middle);
                middle += 1;
            }
        }
        Some(start + middle)
    }

    /// Calls `triangle` for every triangle in leaves below nodes that `node` admits, until it returns false. Returns whether it
    /// never did.
    #[inline]
    pub fn visit(&self, node: impl Fn(&Node) -> bool, mut triangle: impl FnMut(u32) -> bool) -> bool {
        let mut stack: SmallVec<[u32; 64]> = SmallVec::new();
        let mut next = node(self.root()).then_some(0);
        while let Some(at) = next {
            let at = &self.nodes[at as usize];
            if at.count == 0 {
                let [low, high] = [at.first, at.first + 1].map(|child| node(&self.nodes[child as usize]));
                if low && high {
                    stack.push(at.first + 1);
                }
                if low || high {
                    next = Some(at.first + u32::from(!low));
                    continue;
                }
            } else {
                for &i in &self.order[at.first as usize..][..at.count as usize] {
                    if !triangle(i) {
                        return false;
                    }
                }
            }
            next = stack.pop();
        }
        true
    }

    /// See [`crate::ClosedMesh::descend`].
    pub fn descend<S>(&self, start: S, mut node: impl FnMut(&S, Aabb) -> Option<S>, mut triangle: impl FnMut(&S, u32)) {
        let wide = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        let mut stack = vec![(0u32, Rc::new(start))];
        while let Some((at, above)) = stack.pop() {
            let at = &self.nodes[at as usize];
            let Some(state) = node(&above, Aabb::new(wide(at.min), wide(at.max))) else { continue };
            let state = Rc::new(state);
            if at.count == 0 {
                stack.extend([(at.first + 1, state.clone()), (at.first, state)]);
            } else {
                self.order[at.first as usize..][..at.count as usize].iter().for_each(|&i| triangle(&state, i));
            }
        }
    }

    pub fn root(&self) -> &Node {
        &self.nodes[0]
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.order[..])
    }
}

/// The last bin before the cheapest cut, and its cost times the node's area.
fn best_plane(bins: &[(Box3, usize); BINS]) -> (usize, f32) {
    let mut right = [(0.0f32, 0usize); BINS];
    let (mut hull, mut count) = (Box3::EMPTY, 0);
    for i in (1..BINS).rev() {
        hull.add(bins[i].0.min, bins[i].0.max);
        count += bins[i].1;
        right[i] = (hull.area() * count as f32, count);
    }
    let (mut hull, mut count) = (Box3::EMPTY, 0);
    let mut best = (0, f32::INFINITY);
    for i in 0..BINS - 1 {
        hull.add(bins[i].0.min, bins[i].0.max);
        count += bins[i].1;
        let cost = hull.area() * count as f32 + right[i + 1].0;
        if count > 0 && right[i + 1].1 > 0 && (cost < best.1 || best.1 == f32::INFINITY) {
            best = (i, cost);
        }
    }
    best
}
