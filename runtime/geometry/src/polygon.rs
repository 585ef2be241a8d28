//! Simple polygons with holes, in the plane.
//!
//! A polygon is checked once, with exact predicates (Shewchuk 1997): no edge touches another but its neighbours at their
//! common corner, and holes lie within the outline and beside each other. Corners may go round either way.
//!
//! Every question about a line looks only at the sides that corners lie on, computed alike for both edges of a corner: so
//! a line crosses each ring an even number of times, whatever the rounding.

use std::fmt;

use glam::DVec2;
use robust::{Coord, orient2d};
use smallvec::SmallVec;

use crate::box_tree::BoxTree;

/// More make scripts slow before they make pictures better.
pub const MOST_CORNERS: usize = 1 << 16;

/// A corner by ring (0 is the outline, then the holes) and position, as it was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    pub ring: usize,
    pub corner: usize,
}

/// Why rings make no polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolygonError {
    /// A coordinate is not finite, or too large or too small to compute with.
    OutOfRange,
    TooManyCorners,
    TooFewCorners {
        ring: usize,
    },
    /// This corner and the next are the same point.
    Repeated(Corner),
    /// The edges that begin at these corners touch.
    Crossing(Corner, Corner),
    /// The hole is not inside of the outline, or is inside of another hole.
    StrayHole {
        ring: usize,
    },
}

impl fmt::Display for Corner {
    /// Counted from 0, as lists are.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.ring {
            0 => write!(f, "corner {}", self.corner),
            hole => write!(f, "corner {} of hole {}", self.corner, hole - 1),
        }
    }
}

impl fmt::Display for PolygonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PolygonError::OutOfRange => f.write_str("a coordinate is not finite, or too large or small"),
            PolygonError::TooManyCorners => write!(f, "there are more than {MOST_CORNERS} corners"),
            PolygonError::TooFewCorners { ring: 0 } => f.write_str("a polygon has three corners or more"),
            PolygonError::TooFewCorners { ring } => write!(f, "hole {} has less than three corners", ring - 1),
            PolygonError::Repeated(corner) => write!(f, "{corner} and the next are the same point"),
            PolygonError::Crossing(a, b) => write!(f, "the edges from {a} and from {b} touch or cross"),
            PolygonError::StrayHole { ring } => write!(f, "hole {} is not inside of the outline alone", ring - 1),
        }
    }
}

impl std::error::Error for PolygonError {}

/// From `a` to `b`, the inside to the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Edge {
    pub(crate) a: DVec2,
    pub(crate) b: DVec2,
}

impl Edge {
    /// Outward unit normal.
    pub(crate) fn normal(&self) -> DVec2 {
        (self.a - self.b).perp().normalize()
    }
}

/// A checked polygon.
#[derive(Clone)]
pub struct Polygon {
    rings: Vec<Vec<DVec2>>,
    /// In the order of the corners that they begin at as given.
    edges: Vec<Edge>,
    tree: BoxTree,
    pub(crate) min: DVec2,
    pub(crate) max: DVec2,
    pub(crate) area: f64,
}

impl fmt::Debug for Polygon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Polygon").field(&self.rings).finish()
    }
}

impl PartialEq for Polygon {
    /// All else follows from the corners.
    fn eq(&self, other: &Polygon) -> bool {
        self.rings == other.rings
    }
}

impl Polygon {
    /// `rings`: the outline, then holes; a ring's last corner is joined to its first.
    ///
    /// # Errors
    /// The first reason why the rings bound no area.
    pub fn new(rings: Vec<Vec<DVec2>>) -> Result<Polygon, PolygonError> {
        check_corners(&rings)?;
        let corners = rings.iter().flatten();
        let min = corners.clone().fold(DVec2::INFINITY, |m, p| m.min(*p));
        let max = corners.fold(DVec2::NEG_INFINITY, |m, p| m.max(*p));
        let mut edges: Vec<Edge> = rings.iter().flat_map(|ring| ring_edges(ring)).collect();
        let boxes: Vec<(DVec2, DVec2)> = edges.iter().map(|edge| (edge.a.min(edge.b), edge.a.max(edge.b))).collect();
        let tree = BoxTree::new(&boxes);
        check_crossings(&rings, &edges, &boxes, &tree)?;
        check_nesting(&rings)?;
        let mut first = 0;
        let mut area = 0.0;
        for (i, ring) in rings.iter().enumerate() {
            let own = signed_area(ring, min);
            area += if i == 0 { own.abs() } else { -own.abs() };
            if (own > 0.0) != (i == 0) {
                edges[first..first + ring.len()].iter_mut().for_each(|edge| *edge = Edge { a: edge.b, b: edge.a });
            }
            first += ring.len();
        }
        Ok(Polygon { rings, edges, tree, min, max, area })
    }

    /// As they were given: the outline, then holes.
    pub fn rings(&self) -> &[Vec<DVec2>] {
        &self.rings
    }

    pub(crate) fn edges(&self) -> &[Edge] {
        &self.edges
    }

    pub(crate) fn contains(&self, p: DVec2) -> bool {
        let mut inside = false;
        self.tree.visit(
            |min, max| min.y <= p.y && p.y <= max.y && p.x <= max.x,
            |i| {
                let Edge { a, b } = self.edges[i as usize];
                if (a.y > p.y) != (b.y > p.y) {
                    // From the lower corner up, so that the order of the corners makes no difference.
                    let (a, b) = if a.y < b.y { (a, b) } else { (b, a) };
                    inside ^= (b - a).perp_dot(p - a) > 0.0;
                }
            },
        );
        inside
    }

    /// Where the line `o + t d` crosses edges, sorted by t: pairs of entry and exit, each with the edge's number. `d` not 0.
    pub(crate) fn crossings(&self, o: DVec2, d: DVec2) -> SmallVec<[(f64, u32); 8]> {
        /// Bounds the rounding in which side of the line a corner is on.
        const ROUNDING: f64 = 16.0 * f64::EPSILON;
        let inverse = 1.0 / d.length_squared();
        let mut found: SmallVec<[(f64, u32); 8]> = SmallVec::new();
        let reach = |min: DVec2, max: DVec2| {
            let (middle, half) = (0.5 * (min + max) - o, 0.5 * (max - min));
            let width = d.y.abs() * half.x + d.x.abs() * half.y;
            let slack = ROUNDING * (d.y.abs() * (middle.x.abs() + half.x) + d.x.abs() * (middle.y.abs() + half.y));
            d.perp_dot(middle).abs() <= width + slack
        };
        self.tree.visit(reach, |i| {
            let Edge { a, b } = self.edges[i as usize];
            let (side_a, side_b) = (d.perp_dot(a - o), d.perp_dot(b - o));
            if (side_a >= 0.0) != (side_b >= 0.0) {
                let p = a + (b - a) * (side_a / (side_a - side_b));
                found.push(((p - o).dot(d) * inverse, i));
            }
        });
        found.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        found
    }

    /// Whether an edge meets the projection of a box: centre `c`, half edges `e` (three, as seen from above).
    pub(crate) fn meets(&self, c: DVec2, e: [DVec2; 3]) -> bool {
        let half = e[0].abs() + e[1].abs() + e[2].abs();
        let reach = |n: DVec2| e.iter().map(|e| e.dot(n).abs()).sum::<f64>();
        let axes = e.map(|e| e.perp());
        let reaches = axes.map(reach);
        let mut met = false;
        self.tree.visit(
            |min, max| min.cmple(c + half).all() && max.cmpge(c - half).all(),
            |i| {
                let Edge { a, b } = self.edges[i as usize];
                let (a, b) = (a - c, b - c);
                let apart = |n: DVec2, reach: f64| {
                    let (u, v) = (a.dot(n), b.dot(n));
                    u.min(v) > reach || u.max(v) < -reach
                };
                let n = (b - a).perp();
                met |= !(apart(n, reach(n)) || axes.iter().zip(reaches).any(|(&n, reach)| apart(n, reach)));
            },
        );
        met
    }

    /// Triangles whose union is the polygon.
    pub(crate) fn triangles(&self) -> Vec<[DVec2; 3]> {
        let corners: Vec<DVec2> = self.rings.iter().flatten().copied().collect();
        let mut holes = Vec::new();
        let mut next = 0;
        for ring in &self.rings[..self.rings.len() - 1] {
            next += ring.len() as u32;
            holes.push(next);
        }
        let mut indices: Vec<u32> = Vec::new();
        earcut::Earcut::new().earcut(corners.iter().map(|p| p.to_array()), &holes, &mut indices);
        indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|i| corners[i as usize])).collect()
    }
}

fn ring_edges(ring: &[DVec2]) -> impl Iterator<Item = Edge> + '_ {
    (0..ring.len()).map(|i| Edge { a: ring[i], b: ring[(i + 1) % ring.len()] })
}

fn signed_area(ring: &[DVec2], origin: DVec2) -> f64 {
    0.5 * ring_edges(ring).map(|edge| (edge.a - origin).perp_dot(edge.b - origin)).sum::<f64>()
}

fn check_corners(rings: &[Vec<DVec2>]) -> Result<(), PolygonError> {
    if rings.iter().map(Vec::len).sum::<usize>() > MOST_CORNERS {
        return Err(PolygonError::TooManyCorners);
    }
    if rings.is_empty() {
        return Err(PolygonError::TooFewCorners { ring: 0 });
    }
    for (r, ring) in rings.iter().enumerate() {
        if !ring.iter().all(|p| p.is_finite() && p.abs().max_element() < 1e70) {
            return Err(PolygonError::OutOfRange);
        }
        if ring.len() < 3 {
            return Err(PolygonError::TooFewCorners { ring: r });
        }
        if let Some(corner) = ring_edges(ring).position(|edge| edge.a == edge.b) {
            return Err(PolygonError::Repeated(Corner { ring: r, corner }));
        }
        if ring_edges(ring).any(|edge| (edge.b - edge.a).abs().max_element() < 1e-70) {
            return Err(PolygonError::OutOfRange);
        }
    }
    Ok(())
}

/// The sign of the turn from a over b to c.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let at = |p: DVec2| Coord { x: p.x, y: p.y };
    let turn = orient2d(at(a), at(b), at(c));
    if turn == 0.0 { 0.0 } else { turn.signum() }
}

/// The segments have a point in common.
fn touch(p: &Edge, q: &Edge) -> bool {
    let within = |p: &Edge, x: DVec2| x.cmpge(p.a.min(p.b)).all() && x.cmple(p.a.max(p.b)).all();
    let (c, d) = (turn(p.a, p.b, q.a), turn(p.a, p.b, q.b));
    let (a, b) = (turn(q.a, q.b, p.a), turn(q.a, q.b, p.b));
    (c * d < 0.0 && a * b < 0.0)
        || (c == 0.0 && within(p, q.a))
        || (d == 0.0 && within(p, q.b))
        || (a == 0.0 && within(q, p.a))
        || (b == 0.0 && within(q, p.b))
}

/// An edge turns back upon the one before, which ends where it begins.
fn turns_back(before: &Edge, after: &Edge) -> bool {
    turn(before.a, before.b, after.b) == 0.0 && (before.b - before.a).dot(after.b - after.a) < 0.0
}

fn check_crossings(
    rings: &[Vec<DVec2>],
    edges: &[Edge],
    boxes: &[(DVec2, DVec2)],
    tree: &BoxTree,
) -> Result<(), PolygonError> {
    let mut number = 0;
    for (r, ring) in rings.iter().enumerate() {
        let first = number;
        for corner in 0..ring.len() {
            let (i, next) = (number, first + (corner + 1) % ring.len());
            let mut bad = turns_back(&edges[i], &edges[next]).then_some(next);
            let (min, max) = boxes[i];
            tree.visit(
                |low, high| low.cmple(max).all() && high.cmpge(min).all(),
                |j| {
                    let j = j as usize;
                    // Edges of a triangle are neighbours on both sides.
                    let before = first + (corner + ring.len() - 1) % ring.len();
                    if j > i && j != next && j != before && touch(&edges[i], &edges[j]) {
                        bad = Some(bad.map_or(j, |other| other.min(j)));
                    }
                },
            );
            if let Some(j) = bad {
                return Err(PolygonError::Crossing(Corner { ring: r, corner }, corner_at(rings, j)));
            }
            number += 1;
        }
    }
    Ok(())
}

fn corner_at(rings: &[Vec<DVec2>], mut edge: usize) -> Corner {
    for (ring, corners) in rings.iter().enumerate() {
        if edge < corners.len() {
            return Corner { ring, corner: edge };
        }
        edge -= corners.len();
    }
    Corner { ring: 0, corner: 0 }
}

fn check_nesting(rings: &[Vec<DVec2>]) -> Result<(), PolygonError> {
    let holds = |ring: &[DVec2], p: DVec2| {
        ring_edges(ring).fold(false, |inside, Edge { a, b }| {
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            inside ^ ((a.y > p.y) != (b.y > p.y) && turn(low, high, p) > 0.0)
        })
    };
    for (r, hole) in rings.iter().enumerate().skip(1) {
        let inside = |other: usize| holds(&rings[other], hole[0]);
        if !inside(0) || (1..rings.len()).any(|other| other != r && inside(other)) {
            return Err(PolygonError::StrayHole { ring: r });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(corners: &[(f64, f64)]) -> Vec<DVec2> {
        corners.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        ring(&[(low, low), (high, low), (high, high), (low, high)])
    }

    #[test]
    fn either_way_round() {
        let mut backwards = square(1.0, 2.0);
        let hole = backwards.clone();
        backwards.reverse();
        for hole in [hole, backwards] {
            let polygon = Polygon::new(vec![square(0.0, 4.0), hole]).unwrap();
            assert_eq!(polygon.area, 15.0);
            assert!(polygon.contains(DVec2::new(0.5, 1.5)) && !polygon.contains(DVec2::new(1.5, 1.5)));
            let area: f64 = polygon.triangles().iter().map(|[a, b, c]| 0.5 * (b - a).perp_dot(c - a).abs()).sum();
            assert_eq!(area, 15.0);
            let out = polygon.edges().iter().all(|edge| {
                let middle = 0.5 * (edge.a + edge.b);
                !polygon.contains(middle + 1e-3 * edge.normal()) && polygon.contains(middle - 1e-3 * edge.normal())
            });
            assert!(out);
        }
    }

    #[test]
    fn what_is_no_polygon() {
        let error = |rings: Vec<Vec<DVec2>>| Polygon::new(rings).err();
        let corner = |ring, corner| Corner { ring, corner };
        let bow = ring(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(error(vec![bow]), Some(PolygonError::Crossing(corner(0, 0), corner(0, 2))));
        assert_eq!(error(vec![ring(&[(0.0, 0.0), (1.0, 1.0)])]), Some(PolygonError::TooFewCorners { ring: 0 }));
        let twice = ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
        assert_eq!(error(vec![twice]), Some(PolygonError::Repeated(corner(0, 1))));
        let flat = ring(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]);
        assert!(matches!(error(vec![flat]), Some(PolygonError::Crossing(..))));
        let spike = ring(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
        assert!(matches!(error(vec![spike]), Some(PolygonError::Crossing(..))));
        let pinched = ring(&[(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (1.0, 0.0), (2.0, -1.0), (0.0, -1.0)]);
        assert!(matches!(error(vec![pinched]), Some(PolygonError::Crossing(..))));
        assert_eq!(error(vec![square(0.0, 1.0), square(2.0, 3.0)]), Some(PolygonError::StrayHole { ring: 1 }));
        let nested = vec![square(0.0, 9.0), square(1.0, 8.0), square(2.0, 3.0)];
        assert_eq!(error(nested), Some(PolygonError::StrayHole { ring: 2 }));
        assert_eq!(error(vec![square(0.0, f64::NAN)]), Some(PolygonError::OutOfRange));
        assert!(matches!(error(vec![square(0.0, 2.0), square(1.0, 3.0)]), Some(PolygonError::Crossing(..))));
    }

    #[test]
    fn a_line_crosses_each_ring_an_even_number_of_times() {
        let star: Vec<DVec2> = (0..2000)
            .map(|i| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 2000.0) * (1.0 + 0.5 * f64::from(i % 2)))
            .collect();
        let polygon = Polygon::new(vec![star.clone(), square(-0.3, 0.3)]).unwrap();
        for i in 0..2000 {
            // Through corners, along edges, and anywhere.
            let (o, d) = match i % 3 {
                0 => (star[i], star[(i * 7 + 5) % 2000] - star[i]),
                1 => (star[i], star[(i + 1) % 2000] - star[i]),
                _ => (DVec2::new(-3.0, i as f64 / 1000.0 - 1.0), DVec2::new(1.0, 0.1)),
            };
            if d == DVec2::ZERO {
                continue;
            }
            let found = polygon.crossings(o, d);
            assert!(found.len().is_multiple_of(2));
            for pair in found.chunks(2).filter(|pair| (pair[1].0 - pair[0].0) * d.length() > 1e-9) {
                assert!(polygon.contains(o + d * (0.5 * (pair[0].0 + pair[1].0))));
            }
        }
    }
}
