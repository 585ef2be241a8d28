//! Triangles of mesh operands as primitives of Embree.
//!
//! Wherever all other leaves of a solid are constant near a triangle, the expression is the mesh or its complement there (or
//! constant: then the triangle is not on the boundary and goes). A ray that meets such a triangle has met the solid: no
//! parity is needed. The few triangles where something else comes near have a cell: what the expression is in their box. A
//! ray that meets one of these asks the cell, which counts crossings as all cells do, about the place alone.
//!
//! Embree only culls, by padded boxes; whether a ray passes through a triangle is decided exactly, as by
//! [`ClosedMesh::crossings`]. (Embree's own triangles, however grown, lose rays along them.) Near an edge the line may pass a
//! neighbour within the tolerance, in and out again: there the crossings of the whole mesh are asked.
//!
//! Meshes are walked down their own hierarchies, so that most triangles are decided many at a time.

use std::cell::RefCell;
use std::rc::Rc;

use arsc_geometry::{Aabb, ClosedMesh, Passage, Placed, Projection, Shape};
use glam::DVec3;
use smallvec::SmallVec;

use crate::Budget;
use crate::cells::{Cell, CellLeaf, CellSet, Line, PAD, Window, essential, leaf_transitions, leaves_of, state};
use crate::expression::{Expression, Token, Word, substitute};
use crate::level::Solids;
use crate::query::{Mode, Query};
use crate::solid::SolidModel;
use crate::transition::Transition;

/// A triangle of a mesh leaf, on the boundary of the solid in some place at least.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// In the level.
    solid: u32,
    leaf: u32,
    triangle: u32,
    part: Part,
}

/// How much of a facet is boundary.
#[derive(Clone, Copy, Debug)]
enum Part {
    /// All of it; the mesh may be subtracted there.
    Whole { flipped: bool },
    /// What the cell says.
    Cell(u32),
}

/// The mesh that a leaf is made of.
pub fn mesh_of(leaf: &Placed) -> Option<&ClosedMesh> {
    match leaf.shape() {
        Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    }
}

/// What is known below a node of a mesh's hierarchy.
#[derive(Clone)]
struct Below {
    tokens: Rc<[Token]>,
    /// Over budget: one cell for all.
    cell: Option<u32>,
}

/// The facets of all mesh leaves of a solid, with their cells in `set`.
pub fn append(facets: &mut Vec<Facet>, set: &mut CellSet, number: u32, solid: &SolidModel, budget: &Budget) {
    let Expression::Tokens(tokens) = &solid.expression else { return };
    if solid.leaves.iter().all(|leaf| mesh_of(leaf).is_none()) {
        return;
    }
    let first_kernel = set.push_kernels(&solid.leaves);
    let first = set.cells.len();
    let set = RefCell::new(set);
    for (leaf, placed) in (0..).zip(&solid.leaves) {
        let Some(mesh) = mesh_of(placed) else { continue };
        let map = placed.world_from_object();
        let near = Near { solid, leaf };
        let push = |bounds: &Aabb, tokens: &[Token]| {
            let bounds = bounds.dilated(solid.tolerance);
            set.borrow_mut().push(number, bounds, &leaves_of(tokens), tokens, first_kernel)
        };
        let is_spent = || set.borrow().cells.len() - first >= budget.cells;
        let is_settled = |below: &Below| below.cell.is_some() || near.single(&below.tokens).is_some();
        let node = |above: &Below, bounds: Aabb| {
            if is_settled(above) {
                return Some(above.clone());
            }
            let bounds = bounds.transformed(map);
            let tokens = near.narrowed(&above.tokens, &bounds)?;
            let cell = (is_spent() && near.single(&tokens).is_none()).then(|| push(&bounds, &tokens));
            Some(Below { tokens, cell })
        };
        let triangle = |below: &Below, triangle: u32| {
            let mut tokens = below.tokens.clone();
            let bounds = hull(mesh.mesh().corners(triangle as usize).map(|p| map.transform_point3(p)));
            if !is_settled(below) {
                match near.narrowed(&tokens, &bounds) {
                    Some(narrowed) => tokens = narrowed,
                    None => return,
                }
            }
            let part = match (near.single(&tokens), below.cell) {
                (Some(flipped), _) => Part::Whole { flipped },
                (None, Some(cell)) => Part::Cell(cell),
                (None, None) => Part::Cell(push(&bounds, &tokens)),
            };
            facets.push(Facet { solid: number, leaf, triangle, part });
        };
        mesh.descend(Below { tokens: tokens.as_slice().into(), cell: None }, node, triangle);
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

    /// Meets the facet, which Embree has come to by its padded box: exactly where the crossings of the whole mesh have it.
    #[inline]
    pub fn visit(&self, solids: &Solids, set: &CellSet, query: &mut Query) {
        if solids.is_left_out(self.solid, query) {
            return;
        }
        query.tests += 1;
        let placed = &solids.models[self.solid as usize].leaves[self.leaf as usize];
        let Some(mesh) = mesh_of(placed) else { return };
        let mut moved = None;
        let (ray, start) = solids.near(self.solid, &query.view, &mut moved);
        let map = placed.object_from_world();
        let line = Projection::new(map.transform_point3(ray.origin), map.transform_vector3(ray.dir));
        let Some(Passage { t, enters, is_marginal }) = mesh.crossing(&line, self.triangle) else { return };
        let flipped = match self.part {
            Part::Whole { flipped } if is_marginal => return self.visit_leaf(solids, t, flipped, query),
            Part::Whole { flipped } => flipped,
            Part::Cell(cell) => return self.visit_cell(solids, set, &set.cells[cell as usize], t, query),
        };
        let (leaf, face, entering) = (self.leaf, self.triangle, enters != flipped);
        let transition = Transition { t, leaf, face, entering, flipped, shared: false };
        query.offer(solids.candidate(self.solid, transition, start, &query.view));
    }

    /// The stretch in which the cluster of coincident crossings that one at `t` is in begins: at most a tolerance before.
    fn window(&self, solids: &Solids, start: f64, end: f64, t: f64) -> Option<Window> {
        let tolerance = solids.tolerance(self.solid);
        let (low, high) = ((t - 1.5 * tolerance).max(start), (t + 0.5 * tolerance).min(end));
        (low <= high).then_some(Window { low, high, start, tolerance })
    }

    /// Asks the whole mesh about what happens at `t`: crossings within the tolerance cancel in pairs.
    #[cold]
    fn visit_leaf(&self, solids: &Solids, t: f64, flipped: bool, query: &mut Query) {
        let (view, mut moved) = (query.view, None);
        let (ray, start) = solids.near(self.solid, &view, &mut moved);
        let Some(window) = self.window(solids, start, start + query.limit() * view.scale, t) else { return };
        let model = &solids.models[self.solid as usize];
        let leaf = CellLeaf::new(self.leaf, &model.leaves);
        let line = Line::new(model, self.solid, ray, &view);
        let mut found: SmallVec<[Transition; 4]> = SmallVec::new();
        let scratch = &mut query.scratch;
        leaf_transitions(&leaf, flipped, &line, &window, scratch, |transition| {
            found.push(transition);
            true
        });
        for transition in found {
            query.offer(solids.candidate(self.solid, transition, start, &view));
        }
    }

    /// Asks the cell about what happens at `t`.
    fn visit_cell(&self, solids: &Solids, set: &CellSet, cell: &Cell, t: f64, query: &mut Query) {
        let (view, mut moved) = (query.view, None);
        let (ray, start) = solids.near(self.solid, &view, &mut moved);
        let Some(window) = self.window(solids, start, start + query.limit() * view.scale, t) else { return };
        let line = Line::new(&solids.models[self.solid as usize], self.solid, ray, &view);
        let all = query.mode == Mode::Collect;
        let mut found: SmallVec<[Transition; 4]> = SmallVec::new();
        set.transitions(cell, &line, &window, &mut query.scratch, all, |transition| found.push(transition));
        for transition in found {
            query.offer(solids.candidate(self.solid, transition, start, &view));
        }
    }
}
