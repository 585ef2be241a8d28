//! A closed triangle mesh as a solid.
//!
//! Invariants: every edge is used an even number of times (positions that are equal being one), no triangle has a corner
//! twice, and triangles run counter-clockwise as seen from outside. Inside is where a line to infinity crosses the surface
//! an odd number of times: of two pieces that overlap, what they share is outside (even-odd rule). The mesh is not
//! searched for self-intersections. Vertices are single precision and exact; everything else is double precision.
//!
//! Faces are the triangles, by number.

mod bvh;
mod classify;
mod projection;
mod topology;

use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DVec2, DVec3};
use smallvec::SmallVec;

use crate::{Aabb, Crossings, LocalPoint, TriangleMesh};
use bvh::Bvh;

use projection::crossing;

pub use projection::{Passage, Projection};

/// Direction of the rays that decide membership: about z, along no plane that meshes are made of.
const PROBE: DVec3 = DVec3::new(0.132_719, 0.071_933, 1.0);

/// Crossings so far apart, of the largest number involved, are at one place: some times the error of [`crossing`].
const SAME_PLACE: f64 = 1.0 / (1u64 << 44) as f64;

/// A mesh whose surface bounds a solid. Shared: it is cheap to place it many times.
pub struct ClosedMesh {
    name: Arc<str>,
    mesh: TriangleMesh,
    bvh: Bvh,
    bounds: Aabb,
    area: f64,
    /// Sums of the areas up to and including each triangle, made when first asked for.
    cumulative_area: OnceLock<Vec<f64>>,
}

/// What had to be done to a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshRepairs {
    /// Triangles without an area.
    pub degenerate: usize,
    /// Triangles that were turned to agree with their neighbours.
    pub flipped: usize,
    /// Pieces that were turned as a whole, inside out.
    pub inverted_pieces: usize,
}

/// Why a mesh bounds no solid.
#[derive(Clone, Debug, PartialEq)]
pub enum ClosedMeshError {
    /// Edges are used an odd number of times; one of them, and how often.
    Open {
        edges: usize,
        edge: [DVec3; 2],
        uses: usize,
    },
    /// It has one side only; an edge where that shows.
    Unorientable {
        edge: [DVec3; 2],
    },
    Empty,
    TooLarge,
    /// An index or a number of attributes is wrong, or a coordinate is not finite.
    Invalid,
}

impl std::fmt::Display for ClosedMeshError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [from, to] = match self {
            ClosedMeshError::Open { edge, .. } | ClosedMeshError::Unorientable { edge } => {
                edge.map(|p| format!("({}, {}, {})", p.x as f32, p.y as f32, p.z as f32))
            }
            ClosedMeshError::Empty => return f.write_str("it has no triangle with an area"),
            ClosedMeshError::TooLarge => return f.write_str("it has more triangles than can be numbered"),
            ClosedMeshError::Invalid => return f.write_str("an index or a coordinate is out of range"),
        };
        match self {
            ClosedMeshError::Open { edges, uses, .. } => {
                let faces = if *uses == 1 { "one face".to_owned() } else { format!("{uses} faces") };
                let more = if *edges == 1 { "the only such edge" } else { &format!("one of {edges} such edges") };
                write!(f, "the edge from {from} to {to} belongs to {faces}, {more}")
            }
            _ => write!(f, "the surface has one side only, as the edge from {from} to {to} shows"),
        }
    }
}

impl std::error::Error for ClosedMeshError {}

impl ClosedMesh {
    /// Checks that the mesh closes, and turns its triangles outwards. `name` is what people know it by; nothing depends
    /// on it.
    pub fn new(name: Arc<str>, mut mesh: TriangleMesh) -> Result<(ClosedMesh, MeshRepairs), ClosedMeshError> {
        if !mesh.is_valid() {
            return Err(ClosedMeshError::Invalid);
        }
        // One zero only, so that equal positions are equal bits.
        mesh.positions.as_flattened_mut().iter_mut().for_each(|x| *x += 0.0);
        let mut repairs = MeshRepairs { degenerate: mesh.count_degenerate(), ..MeshRepairs::default() };
        topology::drop_collapsed(&mut mesh);
        let pieces = topology::orient(&mut mesh)?;
        let (mut bounds, mut area) = (Aabb::EMPTY, 0.0);
        for triangle in 0..mesh.triangles.len() {
            for p in mesh.corners(triangle) {
                bounds = bounds.union(&Aabb::new(p, p));
            }
            area += 0.5 * mesh.cross(triangle).length();
        }
        if area.is_nan() || area <= 0.0 {
            return Err(ClosedMeshError::Empty);
        }
        let bvh = Bvh::new(&mesh);
        let mut closed = ClosedMesh { name, mesh, bvh, bounds, area, cumulative_area: OnceLock::new() };
        closed.turn_outwards(&pieces, &mut repairs);
        Ok((closed, repairs))
    }

    /// Turns the pieces whose normals point inwards.
    fn turn_outwards(&mut self, pieces: &[topology::Piece], repairs: &mut MeshRepairs) {
        for piece in pieces {
            let is_inverted = self.is_inverted(piece);
            if is_inverted {
                for &triangle in &piece.triangles {
                    self.mesh.triangles[triangle as usize].swap(1, 2);
                }
            }
            let size = piece.triangles.len();
            let changed = if is_inverted { size - piece.flipped } else { piece.flipped };
            if changed == size {
                repairs.inverted_pieces += 1;
            } else {
                repairs.flipped += changed;
            }
        }
    }

    /// Whether the region that the piece's normals point to is inside: by a line along the normal of its largest triangle.
    fn is_inverted(&self, piece: &topology::Piece) -> bool {
        let area = |triangle: u32| self.mesh.cross(triangle as usize).length_squared();
        let Some(&largest) = piece.triangles.iter().max_by(|&&a, &&b| area(a).total_cmp(&area(b)).then(b.cmp(&a)))
        else {
            return false;
        };
        let centroid = self.mesh.corners(largest as usize).iter().sum::<DVec3>() / 3.0;
        let Some(normal) = self.mesh.cross(largest as usize).try_normalize() else { return false };
        let crossings = self.crossings(centroid, normal);
        let own = crossings.faces().iter().position(|&face| face == largest);
        own.is_some_and(|own| (crossings.len() - own - 1) % 2 == 1)
    }

    pub fn name(&self) -> &Arc<str> {
        &self.name
    }

    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Tight, and exact.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// The largest coordinate.
    pub fn magnitude(&self) -> f64 {
        self.bounds.min.abs().max(self.bounds.max.abs()).max_element()
    }

    /// Surface area.
    pub fn area(&self) -> f64 {
        self.area
    }

    pub fn bytes(&self) -> usize {
        self.mesh.bytes() + self.bvh.bytes()
    }

    /// Least and greatest of `direction · p`.
    pub fn extent_along(&self, direction: DVec3) -> (f64, f64) {
        let along = self.mesh.positions.iter().map(|p| direction.dot(DVec3::from_array(p.map(f64::from))));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    }

    /// Membership; a point within rounding of the surface may be either.
    pub fn contains(&self, p: DVec3) -> bool {
        let mut is_inside = false;
        if self.bounds.contains(p) {
            self.visit_crossings(p, PROBE, |passage, _| is_inside ^= passage.t > 0.0);
        }
        is_inside
    }

    /// All crossings of the line, an even number, sorted; those at one place by triangle, but so that the line goes in
    /// and out by turns.
    pub fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        let mut found: SmallVec<[(Passage, u32); 16]> = SmallVec::new();
        self.visit_crossings(origin, dir, |passage, triangle| found.push((passage, triangle)));
        found.sort_unstable_by(|a, b| a.0.t.total_cmp(&b.0.t).then(a.1.cmp(&b.1)));
        self.alternate(&mut found);
        let mut crossings = Crossings::NONE;
        for (passage, triangle) in found {
            crossings.push(passage.t, triangle);
        }
        crossings
    }

    /// Orders triangles that the line passes at one place, through an edge or a vertex. Places stay.
    fn alternate(&self, found: &mut [(Passage, u32)]) {
        for i in 0..found.len() {
            let place = found[i].0.t;
            let same = place + (self.magnitude() + place.abs()) * SAME_PLACE;
            let fits = |(passage, _): &(Passage, u32)| passage.enters == (i % 2 == 0);
            let mut here = (i..found.len()).take_while(|&k| found[k].0.t <= same);
            if let Some(k) = here.find(|&k| fits(&found[k])).filter(|&k| k > i) {
                found.swap(i, k);
                (found[i].0.t, found[k].0.t) = (found[k].0.t, found[i].0.t);
            }
        }
    }

    fn visit_crossings(&self, origin: DVec3, dir: DVec3, visit: impl FnMut(Passage, u32)) {
        let line = Projection::new(origin, dir);
        match line.major() {
            0 => self.visit_along::<0>(&line, visit),
            1 => self.visit_along::<1>(&line, visit),
            _ => self.visit_along::<2>(&line, visit),
        }
    }

    fn visit_along<const MAJOR: usize>(&self, line: &Projection, mut visit: impl FnMut(Passage, u32)) {
        self.bvh.visit(
            |node| line.meets_box::<MAJOR>(node.min, node.max),
            |triangle| {
                if let Some(passage) = self.crossing_along::<MAJOR>(line, triangle) {
                    visit(passage, triangle);
                }
                true
            },
        );
    }

    /// Where the line passes through a triangle.
    #[inline]
    pub fn crossing(&self, line: &Projection, triangle: u32) -> Option<Passage> {
        match line.major() {
            0 => self.crossing_along::<0>(line, triangle),
            1 => self.crossing_along::<1>(line, triangle),
            _ => self.crossing_along::<2>(line, triangle),
        }
    }

    #[inline]
    fn crossing_along<const MAJOR: usize>(&self, line: &Projection, triangle: u32) -> Option<Passage> {
        let corners = self.mesh.triangles[triangle as usize];
        let [a, b, c] = corners.map(|i| line.project::<MAJOR>(self.mesh.positions[i as usize]));
        crossing(line, a, b, c)
    }

    /// Goes down the hierarchy of boxes, which hold their triangles: `node` makes the state below a box of that above it, or
    /// `None` where nothing below matters.
    pub fn descend<S>(&self, start: S, node: impl FnMut(&S, Aabb) -> Option<S>, triangle: impl FnMut(&S, u32)) {
        self.bvh.descend(start, node, triangle);
    }

    /// Whether any triangle reaches into the box, after the map; never wrongly no.
    pub fn reaches(&self, world_from_object: &DAffine3, cell: &Aabb) -> bool {
        classify::reaches(&self.mesh, &self.bvh, world_from_object, cell)
    }

    /// The point of the triangle that is nearest to `p` in its plane, with its frame.
    pub fn surface(&self, p: DVec3, triangle: u32) -> LocalPoint {
        let point = self.mesh.surface(triangle as usize, self.mesh.weights(triangle as usize, p));
        LocalPoint { p: point.p, n: point.n, uv: point.uv, dpdu: point.dpdu }
    }

    /// The interpolated normal there, unit, on the outer side; `None` for a mesh without.
    pub fn shading_normal(&self, p: DVec3, triangle: u32) -> Option<DVec3> {
        let triangle = triangle as usize;
        (!self.mesh.normals.is_empty()).then(|| self.mesh.surface(triangle, self.mesh.weights(triangle, p)).ns)
    }

    /// A point uniform over the surface, with its triangle. `u` in [0, 1)².
    pub fn sample(&self, u: [f64; 2]) -> (DVec3, u32) {
        let sums = self.cumulative_area.get_or_init(|| {
            let mut sum = 0.0;
            let areas = (0..self.mesh.triangles.len()).map(|triangle| 0.5 * self.mesh.cross(triangle).length());
            areas.map(|area| (sum, sum += area, sum).2).collect()
        });
        let last = sums.len() - 1;
        let wanted = u[0] * sums[last];
        let triangle = sums.partition_point(|&sum| sum <= wanted).min(last);
        let before = if triangle == 0 { 0.0 } else { sums[triangle - 1] };
        let width = sums[triangle] - before;
        // What is left of the choice of the triangle is uniform again.
        let rest = if width > 0.0 { ((wanted - before) / width).clamp(0.0, 1.0) } else { 0.0 };
        let weights = fold([rest, u[1]]);
        (self.mesh.surface(triangle, weights).p, triangle as u32)
    }
}

/// Weights uniform over a triangle, by folding the square (Heitz 2019).
pub fn fold(u: [f64; 2]) -> DVec2 {
    if u[0] + u[1] > 1.0 { DVec2::new(1.0 - u[0], 1.0 - u[1]) } else { DVec2::from_array(u) }
}

impl PartialEq for ClosedMesh {
    fn eq(&self, other: &ClosedMesh) -> bool {
        std::ptr::eq(self, other) || (self.name == other.name && self.mesh == other.mesh)
    }
}

impl std::fmt::Debug for ClosedMesh {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "ClosedMesh({:?}, {:?})", self.name, self.mesh)
    }
}
