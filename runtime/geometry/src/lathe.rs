//! Solid of revolution of a profile about the z axis. Faces: the segments of the profile in order; for an open profile
//! then the disk at its last point and the disk at its first (empty where the profile ends on the axis).
//!
//! The conventions of profiles are those of the module `profile`; how lines cross them is in the module `revolved`.

use std::f64::consts::TAU;
use std::fmt;

use glam::{DVec2, DVec3};

use crate::area_table::AreaTable;
use crate::box_tree::BoxTree;
use crate::cone::frustum_sample;
use crate::profile::{ProfileError, Segment, segments};
use crate::region::Region;
use crate::revolved::{Line, Piece};
use crate::{Aabb, Classification, Crossings, LocalPoint};

/// Cells of a cubic segment's area, and nodes of Gauss's quadrature in each: relative error below 10⁻⁸ for segments
/// whose speed does not vanish.
const CELLS: usize = 32;
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_92),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_92),
];

/// A face: a segment turned about the axis.
#[derive(Clone, Debug)]
struct Face {
    segment: Segment,
    /// Of equal parts of a cubic segment.
    cells: Option<AreaTable>,
    /// Texture coordinate at its beginning and end: the length of the outline so far, of 1.
    v: (f64, f64),
}

/// A solid of revolution.
#[derive(Clone)]
pub struct Lathe {
    points: Vec<DVec2>,
    closed: bool,
    smooth: bool,
    faces: Vec<Face>,
    pieces: Vec<Piece>,
    tree: BoxTree,
    areas: AreaTable,
    /// 1 when the outline has its inside to the left (radius to the right, height up), −1 to the right.
    turn: f64,
    min: DVec2,
    max: DVec2,
}

impl fmt::Debug for Lathe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Lathe {{ points: {:?}, closed: {}, smooth: {} }}", self.points, self.closed, self.smooth)
    }
}

impl PartialEq for Lathe {
    /// All else follows from these.
    fn eq(&self, other: &Lathe) -> bool {
        (&self.points, self.closed, self.smooth) == (&other.points, other.closed, other.smooth)
    }
}

impl Lathe {
    /// `points` are (radius, z).
    ///
    /// # Errors
    /// The first reason why they bound no solid.
    pub fn new(points: Vec<DVec2>, closed: bool, smooth: bool) -> Result<Lathe, ProfileError> {
        let segments = segments(&points, closed, smooth)?;
        let mut pieces = Vec::new();
        for (face, segment) in (0..).zip(&segments) {
            pieces.extend(monotone_parts(segment).into_iter().map(|curve| Piece { curve, face }));
        }
        let ends = |piece: &Piece| (piece.curve.c[0], piece.curve.c[3]);
        let boxes: Vec<(DVec2, DVec2)> = pieces.iter().map(ends).map(|(a, b)| (a.min(b), a.max(b))).collect();
        let min = boxes.iter().fold(DVec2::INFINITY, |m, b| m.min(b.0));
        let max = boxes.iter().fold(DVec2::NEG_INFINITY, |m, b| m.max(b.1));
        let area: f64 = segments.iter().map(signed_area).sum();
        let faces = faces(&segments);
        let areas = AreaTable::new(faces.iter().map(Face::area));
        if !(areas.total() > 0.0 && areas.total().is_finite() && area != 0.0) {
            return Err(ProfileError::OutOfRange);
        }
        let tree = BoxTree::new(&boxes);
        Ok(Lathe { points, closed, smooth, faces, pieces, tree, areas, turn: area.signum(), min, max })
    }

    /// The profile as it was given.
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// The last point is joined to the first, not to the axis.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The profile is the Catmull–Rom spline through its points.
    pub fn is_smooth(&self) -> bool {
        self.smooth
    }

    pub(crate) fn contains(&self, p: DVec3) -> bool {
        self.contains_flat(DVec2::new(p.truncate().length(), p.z))
    }

    /// Radius and height.
    fn contains_flat(&self, p: DVec2) -> bool {
        let mut inside = false;
        self.tree.visit(
            |min, max| min.y <= p.y && p.y <= max.y && p.x <= max.x,
            |i| {
                let piece = &self.pieces[i as usize];
                inside ^= piece.spans(p.y) && piece.radius(p.y) > p.x;
            },
        );
        inside
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let r = self.max.x;
        Aabb::new(DVec3::new(-r, -r, self.min.y), DVec3::new(r, r, self.max.y))
    }

    /// `dir` is unit. Roots are off the surface by at most 64 units in the last place of the largest of the origin's
    /// distance and the sizes; a pair closer than 10⁻¹³ of the greatest radius may be missed.
    pub(crate) fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        // From the point nearest to the middle nothing large is subtracted.
        let shift = (DVec3::Z * (0.5 * (self.min.y + self.max.y)) - origin).dot(dir);
        let Some(line) = Line::new(origin + dir * shift, dir, self.max.x) else { return Crossings::NONE };
        let mut found: smallvec::SmallVec<[(f64, u32); 8]> = smallvec::SmallVec::new();
        self.tree.visit(
            |min, max| line.reaches(min, max),
            |i| line.cross(&self.pieces[i as usize], &mut |t, face| found.push((t + shift, face))),
        );
        if found.len() % 2 == 1 {
            // Only where rounding at the end of the reach differs from that at a point: a line that grazes the rim.
            return Crossings::NONE;
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Crossings::sorted(&mut found)
    }

    /// u is the azimuth; v goes along the outline in proportion to the lengths of its segments.
    pub(crate) fn surface(&self, p: DVec3, face: u32) -> LocalPoint {
        let face = &self.faces[face as usize];
        let azimuth = p.y.atan2(p.x);
        let (sin, cos) = azimuth.sin_cos();
        let s = nearest(&face.segment, DVec2::new(p.truncate().length(), p.z));
        let on = face.segment.at(s);
        let rate = face.segment.rate(s);
        let out = (-rate.perp() * self.turn).try_normalize().unwrap_or(DVec2::X);
        LocalPoint {
            p: DVec3::new(on.x * cos, on.x * sin, on.y),
            n: DVec3::new(out.x * cos, out.x * sin, out.y),
            uv: DVec2::new(azimuth.rem_euclid(TAU) / TAU, face.v.0 + s * (face.v.1 - face.v.0)),
            dpdu: DVec3::new(-sin, cos, 0.0),
        }
    }

    /// Greatest `n · p`.
    pub(crate) fn support(&self, n: DVec3) -> f64 {
        let weights = DVec2::new(n.truncate().length(), n.z);
        let along = |face: &Face| {
            let inner = face.segment.stationary(weights).into_iter().map(|s| face.segment.at(s).dot(weights));
            inner.chain([face.segment.c[0].dot(weights)]).fold(f64::NEG_INFINITY, f64::max)
        };
        let ends = self.faces.iter().map(|face| face.segment.c[3].dot(weights));
        self.faces.iter().map(along).chain(ends).fold(f64::NEG_INFINITY, f64::max)
    }

    pub(crate) fn classify(&self, region: &Region) -> Classification {
        region.refined(4, &|part| self.classify_once(part), &|p| self.contains(p))
    }

    fn classify_once(&self, region: &Region) -> Classification {
        let (rho, z) = (region.rho_range(), region.z_range());
        let (min, max) = (DVec2::new(rho.0, z.0), DVec2::new(rho.1, z.1));
        let mut met = false;
        self.tree.visit(
            |low, high| low.cmple(max).all() && high.cmpge(min).all(),
            |i| met |= self.pieces[i as usize].meets(min, max),
        );
        if met {
            Classification::Boundary
        } else if self.contains_flat(0.5 * (min + max)) {
            Classification::Inside
        } else {
            Classification::Outside
        }
    }

    /// Of the faces; closed form for straight segments, else by quadrature.
    pub(crate) fn areas(&self) -> &AreaTable {
        &self.areas
    }

    /// Uniform on a face.
    pub(crate) fn sample(&self, face: u32, u: [f64; 2]) -> DVec3 {
        let p = self.faces[face as usize].sample(u[0]);
        let (sin, cos) = (TAU * u[1]).sin_cos();
        DVec3::new(p.x * cos, p.x * sin, p.y)
    }
}

impl Face {
    fn area(&self) -> f64 {
        let [a, .., b] = self.segment.c;
        self.cells.as_ref().map_or_else(|| 0.5 * TAU * (a.x + b.x) * a.distance(b), AreaTable::total)
    }

    /// A point of the segment with density in proportion to the radius.
    fn sample(&self, u: f64) -> DVec2 {
        let Some(cells) = &self.cells else {
            let [a, .., b] = self.segment.c;
            return self.segment.at(frustum_sample(a.x, b.x, u).0);
        };
        let (cell, share) = cells.choose(u);
        let (low, high) = (cell as f64 / CELLS as f64, (cell + 1) as f64 / CELLS as f64);
        let wanted = share * cells.area(cell);
        let mut s = low + share * (high - low);
        for _ in 0..8 {
            let rate = area_rate(&self.segment, s);
            let step = (area_between(&self.segment, low, s) - wanted) / rate;
            if !step.is_finite() {
                break;
            }
            s = (s - step).clamp(low, high);
        }
        self.segment.at(s)
    }
}

fn faces(segments: &[Segment]) -> Vec<Face> {
    let cell = |segment: &Segment, i: usize| {
        let n = CELLS as f64;
        area_between(segment, i as f64 / n, (i + 1) as f64 / n)
    };
    let length = |segment: &Segment| {
        let chord = |i: usize| segment.at(i as f64 / 16.0).distance(segment.at((i + 1) as f64 / 16.0));
        (0..16).map(chord).sum::<f64>()
    };
    let total: f64 = segments.iter().map(length).sum();
    let mut so_far = 0.0;
    segments
        .iter()
        .map(|segment| {
            let start = so_far / total;
            so_far += length(segment);
            let cells = (!segment.is_line).then(|| AreaTable::new((0..CELLS).map(|i| cell(segment, i))));
            Face { segment: *segment, cells, v: (start, so_far / total) }
        })
        .collect()
}

/// Area by the segment's parameter.
fn area_rate(segment: &Segment, s: f64) -> f64 {
    TAU * segment.at(s).x * segment.rate(s).length()
}

fn area_between(segment: &Segment, low: f64, high: f64) -> f64 {
    GAUSS.iter().map(|(x, weight)| weight * area_rate(segment, low + x * (high - low))).sum::<f64>() * (high - low)
}

/// Twice the area between the segment and the axis, signed: cubic segments by Gauss's quadrature, which is exact.
fn signed_area(segment: &Segment) -> f64 {
    let integrand = |s: f64| segment.at(s).perp_dot(segment.rate(s));
    GAUSS.iter().map(|(x, weight)| weight * integrand(*x)).sum()
}

/// Cut where radius or height turn, and at inflections.
fn monotone_parts(segment: &Segment) -> Vec<Segment> {
    let [a, .., b] = segment.c;
    if a == b || (a.x == 0.0 && b.x == 0.0) {
        // On the axis there is no surface.
        return Vec::new();
    }
    let mut cuts = vec![0.0, 1.0];
    cuts.extend(segment.stationary(DVec2::X));
    cuts.extend(segment.stationary(DVec2::Y));
    cuts.extend(segment.inflections());
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a < 1e-9);
    if let Some(last) = cuts.last_mut() {
        *last = 1.0;
    }
    cuts.windows(2).map(|pair| segment.part(pair[0], pair[1])).collect()
}

/// The parameter of the segment's point nearest to `p`, which lies close to it.
fn nearest(segment: &Segment, p: DVec2) -> f64 {
    const PLACES: usize = 16;
    let [a, .., b] = segment.c;
    if segment.is_line {
        return if a == b { 0.0 } else { ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0) };
    }
    let place = |i: usize| i as f64 / PLACES as f64;
    let distance = |i: &usize| segment.at(place(*i)).distance_squared(p);
    let first = (0..=PLACES).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0);
    let mut s = place(first);
    for _ in 0..10 {
        // Gauss and Newton's step: the distance to a curve close by is nearly that to its tangent.
        let rate = segment.rate(s);
        let step = (p - segment.at(s)).dot(rate) / rate.length_squared();
        if !step.is_finite() {
            break;
        }
        s = (s + step).clamp(0.0, 1.0);
    }
    s
}
