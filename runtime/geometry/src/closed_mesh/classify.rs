//! A closed mesh against a box: whether any triangle reaches into it.
//!
//! Triangles are mapped to the box's frame and tested by separating axes (Akenine-Möller 2001); everything is widened by
//! what rounding may be off, so that the answer is never wrongly no.

use glam::{DAffine3, DMat3, DVec3};

use crate::closed_mesh::bvh::{Bvh, Node};
use crate::{Aabb, TriangleMesh};

/// Roundings granted, relative to the numbers involved.
const SLACK: f64 = 64.0 * f64::EPSILON;

pub fn reaches(mesh: &TriangleMesh, bvh: &Bvh, map: &DAffine3, cell: &Aabb) -> bool {
    let (root_center, root_half) = placed(bvh.root(), map);
    let largest = (root_center.abs() + root_half).max(cell.min.abs()).max(cell.max.abs()).max_element();
    let cell = cell.dilated(SLACK * largest);
    let (center, half) = (cell.center(), cell.extent() * 0.5);
    // Stops at the first triangle that does.
    !bvh.visit(
        |node| {
            let (c, h) = placed(node, map);
            (c - center).abs().cmple(h + half).all()
        },
        |triangle| {
            let corners = mesh.corners(triangle as usize).map(|p| map.transform_point3(p) - center);
            !overlaps(corners, half)
        },
    )
}

/// Centre and half extent of a node's box in the world, rounded outwards.
fn placed(node: &Node, map: &DAffine3) -> (DVec3, DVec3) {
    let wide = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let (min, max) = (wide(node.min), wide(node.max));
    let half = (max - min) * 0.5;
    let m = map.matrix3;
    let absolute = DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    let half = absolute * half;
    (map.transform_point3((min + max) * 0.5), half + half * SLACK)
}

/// Whether a triangle overlaps the box of this half extent about the origin.
fn overlaps(corners: [DVec3; 3], half: DVec3) -> bool {
    let [a, b, c] = corners;
    let separates = |axis: DVec3| {
        let (p, q, r) = (axis.dot(a), axis.dot(b), axis.dot(c));
        let reach = half.dot(axis.abs());
        p.min(q).min(r) > reach || p.max(q).max(r) < -reach
    };
    if DVec3::AXES.into_iter().any(separates) {
        return false;
    }
    let edges = [b - a, c - b, a - c];
    if separates(edges[0].cross(edges[1])) {
        return false;
    }
    !edges.iter().any(|edge| DVec3::AXES.iter().any(|axis| separates(axis.cross(*edge))))
}
