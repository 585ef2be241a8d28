//! The nearest candidate along a ray, with ties settled by a fixed order.
//!
//! Surfaces of separate solids and open surfaces may coincide too (a lamp in the plane of a ceiling). Within the greater
//! of the two tolerances an open surface wins over a solid and a later surface over an earlier one, as if laid upon it;
//! of two solids the first wins, as the first operand of a union does. The point's error bound is widened so that rays
//! that leave start beyond both.

use glam::DVec2;

use crate::transition::Transition;

/// Something met by a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Parameter of the scene's ray.
    pub t: f64,
    pub part: u32,
    /// Distance within which it coincides with others.
    pub tolerance: f64,
    pub target: Target,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// `solid` counts instances after solids.
    Solid {
        solid: u32,
        transition: Transition,
    },
    Flat {
        surface: u32,
    },
    Triangle {
        surface: u32,
        triangle: u32,
        weights: DVec2,
    },
}

impl Candidate {
    /// Which of two that coincide is seen.
    fn lies_upon(&self, other: &Candidate) -> bool {
        let is_solid = |candidate: &Candidate| matches!(candidate.target, Target::Solid { .. });
        match (is_solid(self), is_solid(other)) {
            (true, true) => self.part < other.part,
            (false, false) => self.part > other.part,
            (solid, _) => !solid,
        }
    }
}

/// The best so far.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    pub best: Option<Candidate>,
    /// Another candidate coincides with the best, at most this far away (with its own tolerance).
    pub tie: f64,
    t_max: f64,
    /// The greatest tolerance of any solid: so far behind the best one may still coincide with it.
    slack: f64,
    limit: f64,
}

impl Nearest {
    pub fn new(t_max: f64, slack: f64) -> Nearest {
        Nearest { best: None, tie: 0.0, t_max, slack, limit: t_max }
    }

    /// Beyond this nothing matters any more.
    #[inline]
    pub fn limit(&self) -> f64 {
        self.limit
    }

    fn set(&mut self, best: Candidate) {
        self.limit = best.t + best.tolerance.max(self.slack);
        self.best = Some(best);
    }

    /// The candidate is of the solid that the best is of, and within the tolerance of it.
    #[inline]
    pub fn coincides_within_solid(&self, candidate: &Candidate) -> bool {
        let solid = |target: &Target| match *target {
            Target::Solid { solid, .. } => Some(solid),
            _ => None,
        };
        self.best.as_ref().is_some_and(|best| {
            (best.t - candidate.t).abs() <= candidate.tolerance && solid(&best.target) == solid(&candidate.target)
        })
    }

    #[inline]
    pub fn offer(&mut self, candidate: Candidate) {
        if !(candidate.t > 0.0 && candidate.t < self.t_max) {
            return;
        }
        let Some(best) = &self.best else { return self.set(candidate) };
        let tolerance = best.tolerance.max(candidate.tolerance);
        let apart = candidate.t - best.t;
        if apart.abs() <= tolerance {
            if candidate.part != best.part {
                self.tie = self.tie.max(apart.abs());
            }
            if candidate.lies_upon(best) {
                self.set(candidate);
            }
        } else if apart < 0.0 {
            self.set(candidate);
            self.tie = 0.0;
        }
    }
}
