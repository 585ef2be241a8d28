//! Whether triangles close, and how they are to be turned.
//!
//! Vertices at equal positions are one (files repeat them at seams of texture coordinates, and STL always does). A mesh is
//! closed when every edge is used an even number of times: then every line crosses it an even number of times. Where
//! exactly two triangles meet at an edge they must run through it in opposite directions; pieces that hang together by
//! such edges are turned as a whole.

use std::cmp::Ordering;

use crate::{ClosedMeshError, TriangleMesh};

const NONE: u32 = u32::MAX;

/// A piece of the mesh that hangs together, consistently turned.
#[derive(Clone, Debug, Default)]
pub struct Piece {
    pub triangles: Vec<u32>,
    /// Those whose winding differs from the file's.
    pub flipped: usize,
}

/// Drops triangles with a corner twice. Returns how many.
pub fn drop_collapsed(mesh: &mut TriangleMesh) -> usize {
    let before = mesh.triangles.len();
    let TriangleMesh { positions, triangles, .. } = mesh;
    triangles.retain(|t| {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        a != b && b != c && c != a
    });
    before - mesh.triangles.len()
}

/// Checks that the mesh closes and turns its triangles so that neighbours agree.
pub fn orient(mesh: &mut TriangleMesh) -> Result<Vec<Piece>, ClosedMeshError> {
    let neighbours = neighbours(mesh)?;
    let mut turned: Vec<Option<bool>> = vec![None; mesh.triangles.len()];
    let mut pieces = Vec::new();
    for seed in 0..mesh.triangles.len() {
        if turned[seed].is_some() {
            continue;
        }
        turned[seed] = Some(false);
        let mut piece = Piece { triangles: vec![seed as u32], flipped: 0 };
        let mut next = 0;
        while next < piece.triangles.len() {
            let triangle = piece.triangles[next] as usize;
            next += 1;
            for side in 0..3 {
                let Some((other, same_way)) = neighbours[3 * triangle + side].get() else { continue };
                let wanted = turned[triangle] != Some(same_way);
                match turned[other] {
                    None => {
                        turned[other] = Some(wanted);
                        piece.triangles.push(other as u32);
                    }
                    Some(is) if is != wanted => return Err(unorientable(mesh, triangle, side)),
                    Some(_) => {}
                }
            }
        }
        pieces.push(piece);
    }
    for piece in &mut pieces {
        for &triangle in &piece.triangles {
            if turned[triangle as usize] == Some(true) {
                mesh.triangles[triangle as usize].swap(1, 2);
                piece.flipped += 1;
            }
        }
    }
    Ok(pieces)
}

/// The triangle beyond an edge, and whether it runs through the edge in the same direction.
#[derive(Clone, Copy)]
struct Neighbour(u32);

impl Neighbour {
    fn get(self) -> Option<(usize, bool)> {
        (self.0 != NONE).then_some((self.0 as usize >> 1, self.0 & 1 == 1))
    }
}

/// An edge as a triangle uses it.
#[derive(Clone, Copy)]
struct Use {
    low: u32,
    high: u32,
    /// Three times the triangle, plus the side.
    at: u32,
    forward: bool,
}

/// By triangle and side.
fn neighbours(mesh: &TriangleMesh) -> Result<Vec<Neighbour>, ClosedMeshError> {
    if mesh.triangles.len() > (u32::MAX / 3) as usize {
        return Err(ClosedMeshError::TooLarge);
    }
    let same = weld(mesh);
    let mut uses = Vec::with_capacity(3 * mesh.triangles.len());
    for (triangle, corners) in (0u32..).zip(&mesh.triangles) {
        let corners = corners.map(|i| same[i as usize]);
        for side in 0..3 {
            let (a, b) = (corners[side], corners[(side + 1) % 3]);
            uses.push(Use { low: a.min(b), high: a.max(b), at: 3 * triangle + side as u32, forward: a < b });
        }
    }
    uses.sort_unstable_by_key(|u| (u.low, u.high, u.at));
    let mut neighbours = vec![Neighbour(NONE); uses.len()];
    let (mut odd, mut first): (usize, Option<(u32, usize)>) = (0, None);
    for edge in uses.chunk_by(|a, b| a.low == b.low && a.high == b.high) {
        if edge.len() % 2 == 1 {
            odd += 1;
            if first.is_none_or(|(at, _)| edge[0].at < at) {
                first = Some((edge[0].at, edge.len()));
            }
        }
        if let [a, b] = edge {
            let same_way = u32::from(a.forward == b.forward);
            neighbours[a.at as usize] = Neighbour((b.at / 3) << 1 | same_way);
            neighbours[b.at as usize] = Neighbour((a.at / 3) << 1 | same_way);
        }
    }
    match first {
        None => Ok(neighbours),
        Some((at, uses)) => {
            let edge = ends(mesh, at as usize / 3, at as usize % 3);
            Err(ClosedMeshError::Open { edges: odd, edge, uses })
        }
    }
}

fn ends(mesh: &TriangleMesh, triangle: usize, side: usize) -> [glam::DVec3; 2] {
    let corners = mesh.corners(triangle);
    [corners[side], corners[(side + 1) % 3]]
}

fn unorientable(mesh: &TriangleMesh, triangle: usize, side: usize) -> ClosedMeshError {
    ClosedMeshError::Unorientable { edge: ends(mesh, triangle, side) }
}

/// For each vertex the first one at its position.
fn weld(mesh: &TriangleMesh) -> Vec<u32> {
    let order = |a: &u32, b: &u32| {
        let (p, q) = (mesh.positions[*a as usize], mesh.positions[*b as usize]);
        let by_place = p.iter().zip(&q).map(|(x, y)| x.total_cmp(y)).find(|o| *o != Ordering::Equal);
        by_place.unwrap_or_else(|| a.cmp(b))
    };
    let mut sorted: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    sorted.sort_unstable_by(order);
    let mut same = vec![0; sorted.len()];
    for run in sorted.chunk_by(|a, b| mesh.positions[*a as usize] == mesh.positions[*b as usize]) {
        run.iter().for_each(|&vertex| same[vertex as usize] = run[0]);
    }
    same
}
