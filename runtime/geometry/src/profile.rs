//! Profiles of solids of revolution: outlines in the half-plane of radius (x, not negative) and height (y).
//!
//! An open profile is closed by lines to the axis at the heights of its ends. A smooth one is the Catmull–Rom spline
//! through its points (Catmull and Rom 1974): cubic segments whose tangent at a point is parallel to the line between its
//! neighbours; at an open end on the axis the tangent is across the axis, so that the solid is smooth there.

use std::fmt;

use glam::DVec2;

use crate::polygon::{Polygon, PolygonError};

/// More make scripts slow before they make pictures better.
pub const MOST_PROFILE_POINTS: usize = 1 << 14;
/// Chords that a cubic segment is checked by.
const CHORDS: usize = 16;

/// Why points bound no solid of revolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProfileError {
    TooFewPoints,
    TooManyPoints,
    /// The radius is negative at this point, or on the curve after it.
    NegativeRadius {
        point: usize,
    },
    /// This point and the next are the same.
    Repeated {
        point: usize,
    },
    /// The segments that begin at these points touch (for an open profile, the last ones are the lines to the axis).
    Crossing(usize, usize),
    /// A coordinate is not finite, or too large or too small to compute with.
    OutOfRange,
}

impl fmt::Display for ProfileError {
    /// Points are counted from 0, as in lists.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ProfileError::TooFewPoints => f.write_str("there are too few points: two or more, three if closed"),
            ProfileError::TooManyPoints => write!(f, "there are more than {MOST_PROFILE_POINTS} points"),
            ProfileError::NegativeRadius { point } => write!(f, "the radius is negative at or after point {point}"),
            ProfileError::Repeated { point } => write!(f, "point {point} and the next are the same"),
            ProfileError::Crossing(a, b) => write!(f, "the outline touches or crosses itself after points {a} and {b}"),
            ProfileError::OutOfRange => f.write_str("a coordinate is not finite, or too large or small"),
        }
    }
}

impl std::error::Error for ProfileError {}

/// A stretch of an outline as a cubic Bézier curve over [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    pub(crate) c: [DVec2; 4],
    /// At even speed along a line.
    pub(crate) is_line: bool,
}

impl Segment {
    pub(crate) fn line(a: DVec2, b: DVec2) -> Segment {
        Segment { c: [a, a + (b - a) / 3.0, b - (b - a) / 3.0, b], is_line: true }
    }

    pub(crate) fn at(&self, s: f64) -> DVec2 {
        let [a, b, c, d] = self.c;
        if self.is_line {
            return if s == 1.0 { d } else { a + (d - a) * s };
        }
        let r = 1.0 - s;
        a * (r * r * r) + b * (3.0 * r * r * s) + c * (3.0 * r * s * s) + d * (s * s * s)
    }

    pub(crate) fn rate(&self, s: f64) -> DVec2 {
        let [a, b, c, d] = self.c;
        if self.is_line {
            return d - a;
        }
        let r = 1.0 - s;
        (b - a) * (3.0 * r * r) + (c - b) * (6.0 * r * s) + (d - c) * (3.0 * s * s)
    }

    /// The part between two parameters.
    pub(crate) fn part(&self, from: f64, to: f64) -> Segment {
        let (a, d) = (self.at(from), self.at(to));
        if self.is_line {
            return Segment::line(a, d);
        }
        let third = (to - from) / 3.0;
        Segment { c: [a, a + self.rate(from) * third, d - self.rate(to) * third, d], is_line: false }
    }

    /// Where `weights · curve` is stationary within (0, 1).
    pub(crate) fn stationary(&self, weights: DVec2) -> Vec<f64> {
        if self.is_line {
            return Vec::new();
        }
        let [a, b, c, d] = self.c.map(|p| p.dot(weights));
        let (u, v, w) = (b - a, c - b, d - c);
        roots(u - 2.0 * v + w, v - u, u)
    }

    /// Where the curvature changes sign within (0, 1).
    pub(crate) fn inflections(&self) -> Vec<f64> {
        if self.is_line {
            return Vec::new();
        }
        let [a, b, c, d] = self.c;
        let (u, v, w) = (b - a, c - b, d - c);
        // Cross product of the first derivative u r² + 2 v r s + w s² and the second (v − u) r + (w − v) s.
        let (uv, uw, vw) = (u.perp_dot(v), u.perp_dot(w), v.perp_dot(w));
        roots(uv - uw + vw, 0.5 * (uw - 2.0 * uv), uv)
    }
}

/// Roots of `a s² + 2 b s + c` within (0, 1), ascending.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return Vec::new();
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let mut found: Vec<f64> = [q / a, c / q].into_iter().filter(|&s| s > 0.0 && s < 1.0).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// The segments of an outline: those between points, then for an open profile the lines to the axis from its last point
/// and to its first.
///
/// # Errors
/// The first reason why they bound no solid.
pub(crate) fn segments(points: &[DVec2], closed: bool, smooth: bool) -> Result<Vec<Segment>, ProfileError> {
    if points.len() < if closed { 3 } else { 2 } {
        return Err(ProfileError::TooFewPoints);
    }
    if points.len() > MOST_PROFILE_POINTS {
        return Err(ProfileError::TooManyPoints);
    }
    if !points.iter().all(|p| p.is_finite() && p.abs().max_element() < 1e70) {
        return Err(ProfileError::OutOfRange);
    }
    if let Some(point) = points.iter().position(|p| p.x < 0.0) {
        return Err(ProfileError::NegativeRadius { point });
    }
    let n = points.len();
    let count = if closed { n } else { n - 1 };
    if let Some(point) = (0..count).find(|&i| points[i] == points[(i + 1) % n]) {
        return Err(ProfileError::Repeated { point });
    }
    let mut segments: Vec<Segment> = (0..count)
        .map(|i| {
            let (a, b) = (points[i], points[(i + 1) % n]);
            if smooth {
                cubic(a, b, tangent(points, closed, i), tangent(points, closed, (i + 1) % n))
            } else {
                Segment::line(a, b)
            }
        })
        .collect();
    let negative = |segment: &Segment| segment.stationary(DVec2::X).into_iter().any(|s| segment.at(s).x < 0.0);
    if let Some(point) = segments.iter().position(negative) {
        return Err(ProfileError::NegativeRadius { point });
    }
    if !closed {
        let (first, last) = (points[0], points[n - 1]);
        let foot = |p: DVec2| DVec2::new(0.0, p.y);
        segments.extend([Segment::line(last, foot(last)), Segment::line(foot(first), first)]);
    }
    check_outline(&segments, closed)?;
    Ok(segments)
}

/// Half the way from the point before to the point after.
fn tangent(points: &[DVec2], closed: bool, i: usize) -> DVec2 {
    let n = points.len();
    let end = |p: DVec2, other: DVec2| if p.x == 0.0 { DVec2::new(other.x, 0.0) } else { other - p };
    match i {
        _ if closed => 0.5 * (points[(i + 1) % n] - points[(i + n - 1) % n]),
        0 => end(points[0], points[1]),
        _ if i == n - 1 => -end(points[i], points[i - 1]),
        _ => 0.5 * (points[i + 1] - points[i - 1]),
    }
}

fn cubic(a: DVec2, b: DVec2, tangent_a: DVec2, tangent_b: DVec2) -> Segment {
    Segment { c: [a, a + tangent_a / 3.0, b - tangent_b / 3.0, b], is_line: false }
}

/// Every outline is a simple polygon; cubic segments count as their chords.
fn check_outline(segments: &[Segment], closed: bool) -> Result<(), ProfileError> {
    let mut ring = Vec::new();
    let mut owners = Vec::new();
    for (i, segment) in segments.iter().enumerate() {
        let chords = if segment.is_line { 1 } else { CHORDS };
        for k in 0..chords {
            let p = segment.at(k as f64 / chords as f64);
            // Ends on the axis have no line to it.
            if ring.last() != Some(&p) {
                ring.push(p);
                owners.push(i);
            }
        }
        if !closed && i + 2 == segments.len() && ring.last() != Some(&segment.c[3]) {
            // From here the outline goes along the axis.
            ring.push(segment.c[3]);
            owners.push(i);
        }
    }
    if !closed && ring.first() == ring.last() {
        ring.pop();
    }
    match Polygon::new(vec![ring]) {
        Ok(_) => Ok(()),
        Err(PolygonError::Crossing(a, b)) => Err(ProfileError::Crossing(owners[a.corner], owners[b.corner])),
        Err(PolygonError::Repeated(corner)) => Err(ProfileError::Repeated { point: owners[corner.corner] }),
        Err(PolygonError::TooManyCorners) => Err(ProfileError::TooManyPoints),
        Err(PolygonError::TooFewCorners { .. }) => Err(ProfileError::TooFewPoints),
        Err(PolygonError::OutOfRange | PolygonError::StrayHole { .. }) => Err(ProfileError::OutOfRange),
    }
}
