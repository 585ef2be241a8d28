//! A box of the world as a parallelepiped in object space, and proofs about where it lies.
//!
//! Every bound is conservative up to rounding: distances are lower bounds, ranges hold the region.

use glam::DVec3;

use crate::{Aabb, Classification, Placed};

/// A box of the world seen from object space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Region {
    /// Centre.
    pub(crate) c: DVec3,
    /// Half edges.
    pub(crate) e: [DVec3; 3],
}

impl Region {
    pub(crate) fn new(placed: &Placed, cell: &Aabb) -> Region {
        let map = placed.object_from_world();
        let half = cell.extent() * 0.5;
        let m = &map.matrix3;
        Region { c: map.transform_point3(cell.center()), e: [m.x_axis * half.x, m.y_axis * half.y, m.z_axis * half.z] }
    }

    /// Half the width along `n`.
    pub(crate) fn reach(&self, n: DVec3) -> f64 {
        self.e.iter().map(|e| e.dot(n).abs()).sum()
    }

    pub(crate) fn z_range(&self) -> (f64, f64) {
        let reach = self.e.iter().map(|e| e.z.abs()).sum::<f64>();
        (self.c.z - reach, self.c.z + reach)
    }

    pub(crate) fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        (0..8).map(|i| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            self.c + self.e[0] * sign(0) + self.e[1] * sign(1) + self.e[2] * sign(2)
        })
    }

    /// A point of the region close to the nearest one to `target`, in three dimensions or (flat) in x and y.
    pub(crate) fn nearest(&self, target: DVec3, flat: bool) -> DVec3 {
        let flatten = |v: DVec3| if flat { DVec3::new(v.x, v.y, 0.0) } else { v };
        let mut at = flatten(self.c - target);
        let e = self.e.map(flatten);
        let mut s = [0.0f64; 3];
        for _ in 0..4 {
            for i in 0..3 {
                let ee = e[i].length_squared();
                if ee > 0.0 {
                    let next = (s[i] - at.dot(e[i]) / ee).clamp(-1.0, 1.0);
                    at += e[i] * (next - s[i]);
                    s[i] = next;
                }
            }
        }
        at
    }

    /// A lower bound on the distance to `target`, proved by a separating direction.
    pub(crate) fn distance(&self, target: DVec3) -> f64 {
        match self.nearest(target, false).try_normalize() {
            Some(n) => (self.c - target).dot(n) - self.reach(n),
            None => 0.0,
        }
    }

    /// A lower bound on the distance to the z axis, with the direction that proves it.
    pub(crate) fn axis_distance(&self) -> (f64, DVec3) {
        match self.nearest(DVec3::ZERO, true).try_normalize() {
            Some(n) => (self.c.dot(n) - self.reach(n), n),
            None => (0.0, DVec3::X),
        }
    }

    /// Distance of the farthest corner from the centre.
    pub(crate) fn half_diagonal(&self) -> f64 {
        self.corners().map(|p| p.distance_squared(self.c)).fold(0.0, f64::max).sqrt()
    }

    /// Radius of a ball about the centre that the region holds.
    pub(crate) fn inner_radius(&self) -> f64 {
        let [a, b, c] = self.e;
        let faces = [a.cross(b), b.cross(c), c.cross(a)];
        let largest = faces.into_iter().map(DVec3::length_squared).fold(0.0, f64::max);
        if largest > 0.0 { faces[0].dot(c).abs() / largest.sqrt() } else { 0.0 }
    }

    /// Bounds on the distance from the z axis.
    pub(crate) fn rho_range(&self) -> (f64, f64) {
        let far = self.corners().map(|p| p.truncate().length_squared()).fold(0.0, f64::max).sqrt();
        (self.axis_distance().0.max(0.0), far)
    }

    /// Beyond `low <= z <= high`.
    pub(crate) fn beyond_slab(&self, low: f64, high: f64) -> bool {
        let (z0, z1) = self.z_range();
        z0 > high || z1 < low
    }

    /// Separated by a plane from a convex shape, given its farthest point in a direction: Gilbert's descent towards the
    /// shortest vector of the Minkowski difference, of which any step is a proof.
    pub(crate) fn is_apart(&self, farthest: impl Fn(DVec3) -> DVec3) -> bool {
        const STEPS: usize = 16;
        let mut v = self.c - farthest(self.c);
        for _ in 0..STEPS {
            let shape = farthest(v);
            let nearest = self.e.iter().fold(self.c, |p, e| p - *e * e.dot(v).signum());
            let w = nearest - shape;
            if v.dot(w) > 0.0 {
                return true;
            }
            // The point of the segment from v to w that is nearest to the origin.
            let along = w - v;
            let length = along.length_squared();
            if length == 0.0 {
                return false;
            }
            v += along * (-v.dot(along) / length).clamp(0.0, 1.0);
        }
        false
    }

    /// Two halves across the longest edge.
    fn halves(&self) -> [Region; 2] {
        let lengths = self.e.map(DVec3::length_squared);
        let longest = (0..3).fold(0, |best, i| if lengths[i] > lengths[best] { i } else { best });
        let mut e = self.e;
        e[longest] *= 0.5;
        [Region { c: self.c - e[longest], e }, Region { c: self.c + e[longest], e }]
    }

    /// Sharper than one proof for the whole: where that fails, and no corner shows that there is surface, the halves are
    /// tried, so many times over.
    pub(crate) fn refined(
        &self,
        depth: u32,
        decide: &impl Fn(&Region) -> Classification,
        contains: &impl Fn(DVec3) -> bool,
    ) -> Classification {
        let whole = decide(self);
        if whole != Classification::Boundary || depth == 0 {
            return whole;
        }
        let center = contains(self.c);
        if self.corners().any(|p| contains(p) != center) {
            return whole;
        }
        let [a, b] = self.halves();
        let first = a.refined(depth - 1, decide, contains);
        if first != Classification::Boundary && b.refined(depth - 1, decide, contains) == first {
            return first;
        }
        Classification::Boundary
    }
}
