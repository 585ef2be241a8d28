//! Triangles of mesh operands that are boundary of their solid by themselves, and cells for the others.
//!
//! Wherever all other leaves of a solid are constant near a triangle, the expression is the mesh or its complement there (or
//! constant: then the triangle is not on the boundary). Such triangles are given to Embree natively, as those of plain
//! meshes are, and a ray that meets one has met the solid: no parity is needed. The few where something else comes near get
//! a cell each, the size of the triangle, which counts crossings as all cells do.
//!
//! Meshes are walked down their own hierarchies, so that most triangles are decided many at a time.

use std::rc::Rc;

use arsc_geometry::{Aabb, ClosedMesh, Placed, Projection, Shape};
use glam::DVec3;

use crate::Budget;
use crate::cells::{CellSet, PAD, essential, leaves_of, state};
use crate::expression::{Expression, Token, Word, substitute};
use crate::level::Solids;
use crate::query::Query;
use crate::solid::SolidModel;
use crate::transition::Transition;

/// A triangle that is boundary throughout.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// In the level.
    solid: u32,
    leaf: u32,
    triangle: u32,
    /// The mesh is subtracted here.
    flipped: bool,
}

/// The mesh that a leaf is made of.
pub fn mesh_of(leaf: &Placed) -> Option<&ClosedMesh> {
    match leaf.shape() {
        Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    }
}

/// Covers the surfaces of all mesh leaves of a solid: by facets, and by cells in `set`.
pub fn append(facets: &mut Vec<Facet>, set: &mut CellSet, number: u32, solid: &SolidModel, budget: &Budget) {
    let Expression::Tokens(tokens) = &solid.expression else { return };
    let tokens: Rc<[Token]> = tokens.as_slice().into();
    let mut cells_left = budget.cells;
    for (leaf, placed) in (0..).zip(&solid.leaves) {
        let Some(mesh) = mesh_of(placed) else { continue };
        let map = placed.world_from_object();
        let near = Near { solid, leaf };
        let cells = std::cell::RefCell::new((&mut *set, &mut cells_left));
        let push = |bounds: &Aabb, tokens: &[Token]| {
            let (set, cells_left) = &mut *cells.borrow_mut();
            set.push(number, bounds.dilated(solid.tolerance), &leaves_of(tokens), tokens, &solid.leaves);
            **cells_left = cells_left.saturating_sub(1);
        };
        mesh.descend(
            tokens.clone(),
            |tokens, bounds| {
                if near.single(tokens).is_some() {
                    return Some(tokens.clone());
                }
                let bounds = bounds.transformed(map);
                let narrowed = near.narrowed(tokens, &bounds)?;
                if *cells.borrow().1 == 0 && near.single(&narrowed).is_none() {
                    // Over budget: all of it in one cell.
                    push(&bounds, &narrowed);
                    return None;
                }
                Some(narrowed)
            },
            |tokens, triangle| {
                let mut tokens = tokens.clone();
                let corners = mesh.mesh().corners(triangle as usize).map(|p| map.transform_point3(p));
                let bounds = hull(corners);
                if near.single(&tokens).is_none() {
                    match near.narrowed(&tokens, &bounds) {
                        Some(narrowed) => tokens = narrowed,
                        None => return,
                    }
                }
                match near.single(&tokens) {
                    Some(flipped) => facets.push(Facet { solid: number, leaf, triangle, flipped }),
                    None => push(&bounds, &tokens),
                }
            },
        );
    }
}

fn hull(corners: [DVec3; 3]) -> Aabb {
    let [a, b, c] = corners;
    Aabb::new(a.min(b).min(c), a.max(b).max(c))
}

/// The expression near a leaf's surface.
struct Near<'a> {
    solid: &'a SolidModel,
    leaf: u32,
}

impl Near<'_> {
    /// Whether the expression is the leaf (false) or its complement (true).
    fn single(&self, tokens: &[Token]) -> Option<bool> {
        match tokens {
            [token] => match token.word() {
                Word::Literal { leaf, negated } if leaf == self.leaf => Some(negated),
                _ => None,
            },
            _ => None,
        }
    }

    /// What is left of the expression in a box; `None` when it does not depend on the leaf there.
    fn narrowed(&self, tokens: &[Token], bounds: &Aabb) -> Option<Rc<[Token]>> {
        let padded = bounds.dilated(PAD * self.solid.tolerance);
        let leaves = leaves_of(tokens);
        let other =
            |&leaf: &u32| (leaf != self.leaf).then(|| state(&self.solid.leaves[leaf as usize], &padded)).flatten();
        let states: Vec<Option<bool>> = leaves.iter().map(other).collect();
        let value = |leaf: u32| leaves.binary_search(&leaf).ok().and_then(|i| states[i]);
        let mut out = Vec::with_capacity(tokens.len());
        if substitute(tokens, value, &mut out).is_some() {
            return None;
        }
        let (out, leaves) = essential(out)?;
        leaves.contains(&self.leaf).then(|| out.into())
    }
}

impl Facet {
    /// The corners in the level's frame.
    pub fn corners(&self, solids: &Solids) -> [DVec3; 3] {
        let placed = &solids.models[self.solid as usize].leaves[self.leaf as usize];
        let map = placed.world_from_object();
        mesh_of(placed).map_or([DVec3::ZERO; 3], |mesh| {
            mesh.mesh().corners(self.triangle as usize).map(|p| map.transform_point3(p))
        })
    }

    /// Meets the facet: exactly where the crossings of the whole mesh have it.
    #[inline]
    pub fn visit(&self, solids: &Solids, query: &mut Query) {
        if solids.is_left_out(self.solid, query) {
            return;
        }
        query.tests += 1;
        let (ray, view) = (solids.near_ray(self.solid, query), query.view);
        let placed = &solids.models[self.solid as usize].leaves[self.leaf as usize];
        let Some(mesh) = mesh_of(placed) else { return };
        let map = placed.object_from_world();
        let line = Projection::new(map.transform_point3(ray.origin), map.transform_vector3(ray.dir));
        let Some((t, enters)) = mesh.crossing(&line, self.triangle) else { return };
        let transition = Transition {
            t,
            leaf: self.leaf,
            face: self.triangle,
            entering: enters != self.flipped,
            flipped: self.flipped,
            shared: false,
        };
        query.offer(solids.candidate(self.solid, transition, &ray, &view));
    }
}
