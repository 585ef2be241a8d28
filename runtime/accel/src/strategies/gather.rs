//! Crossings of a solid's leaves, gathered before its tree is evaluated.
//!
//! Leaves are crossed by the same kernels as those of cells: balls and upright boxes from what is at hand, others through
//! their maps.

use arsc_geometry::Span;
use glam::DVec3;

use crate::cells::Kernel;
use crate::coincidence::Event;
use crate::query::View;
use crate::solid::{SolidModel, SolidRay};

/// A ray in the frame of a solid, with what is computed of it once.
pub struct SolidLine<'a> {
    pub solid: &'a SolidModel,
    kernels: &'a [Kernel],
    pub ray: SolidRay,
    pub inverse_dir: DVec3,
    inverse_square: f64,
}

impl<'a> SolidLine<'a> {
    /// `ray` has the direction of `view`.
    pub fn new(solid: &'a SolidModel, kernels: &'a [Kernel], ray: SolidRay, view: &View) -> SolidLine<'a> {
        SolidLine { solid, kernels, ray, inverse_dir: view.ray.inverse_dir, inverse_square: view.ray.inverse_square }
    }
}

/// Crossings of a solid's leaves along a ray; slots are leaves.
#[derive(Debug, Default)]
pub struct Gathered {
    pub events: Vec<Event>,
    /// Leaves that the ray starts in.
    pub inside: Vec<u32>,
    /// How many leaves were crossed.
    pub tests: u32,
}

/// A position to go back to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mark {
    events: usize,
    inside: usize,
}

impl Gathered {
    /// Crosses a leaf from the ray's start to its end.
    pub fn cross(&mut self, line: &SolidLine, leaf: u32) {
        self.tests += 1;
        let (from, to) = (line.ray.start, line.ray.end + line.solid.tolerance);
        let span = match line.kernels[leaf as usize] {
            Kernel::Ball { center, radius } => {
                Span::of_ball(center, radius, line.ray.origin, line.ray.dir, line.inverse_square)
            }
            Kernel::Box { min, max } => Span::of_box(min, max, line.ray.origin, line.inverse_dir),
            Kernel::Placed | Kernel::Costly => {
                let crossings = line.solid.leaves[leaf as usize].crossings(line.ray.origin, line.ray.dir);
                let ahead = crossings.iter().filter(|&(t, _)| t > from && t <= to);
                self.events.extend(ahead.map(|(t, face)| Event { t, slot: leaf, face }));
                if crossings.inside_after(from) {
                    self.inside.push(leaf);
                }
                return;
            }
        };
        let Some(span) = span.filter(|span| span.t1 > from) else { return };
        if span.t0 <= from {
            self.inside.push(leaf);
        } else if span.t0 <= to {
            self.events.push(Event { t: span.t0, slot: leaf, face: span.f0 });
        }
        if span.t1 <= to {
            self.events.push(Event { t: span.t1, slot: leaf, face: span.f1 });
        }
    }

    /// The leaf that was crossed last, since `mark`: its value if it is the same from `low` to `high`, which lie within
    /// the ray.
    pub fn constant_since(&self, mark: Mark, low: f64, high: f64) -> Option<bool> {
        let mut value = self.inside.len() > mark.inside;
        for event in &self.events[mark.events..] {
            if event.t > low && event.t <= high {
                return None;
            }
            value ^= event.t <= low;
        }
        Some(value)
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
        self.tests = 0;
    }
}
