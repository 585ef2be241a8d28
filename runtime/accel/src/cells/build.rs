//! Cutting a solid into cells.

use arsc_geometry::Aabb;

use crate::Budget;
use crate::cells::dominance;
use crate::cells::split::{best_split, halves, state};
use crate::cells::{CellSet, PAD, TABLE_LEAVES, truth_table};
use crate::expression::{Expression, Token, Word, bounds, substitute};
use crate::facets::mesh_of;
use crate::solid::SolidModel;

/// Pairs of leaves are compared up to so many; beyond, cells are cut first.
const DOMINANCE_LEAVES: usize = 256;
/// A cut of a cell with a truth table must save so much of the cost.
const WORTH: f64 = 0.97;
/// Cuts in a row that may save nothing while the cell has many leaves: often only the next one helps.
const GAINLESS: u32 = 10;
const MAX_DEPTH: u32 = 96;
/// Leaf classifications (or the like) granted to a solid: when they are spent, what is left becomes cells with large
/// expressions, slower and still right. Ordinary solids need a tenth.
const WORK_PER_LEAF: u64 = 10_000;
const LEAST_WORK: u64 = 1_000_000;
/// Candidate planes per cell times halves, about: what choosing one costs per leaf.
const SPLIT_WORK: u64 = 40;
/// Tightening rounds per cell.
const ROUNDS: usize = 4;

/// A part of the solid's box that is still to be cut.
struct Work {
    region: Aabb,
    tokens: Vec<Token>,
    gainless: u32,
    depth: u32,
}

/// Adds the cells of a solid, but if `has_facets` for the surfaces of its mesh leaves, which are those of [`crate::facets`].
/// Solids whose box is infinite are cut within the hull of their bounded leaves; what is beyond it is [`append_outer`]'s.
pub fn append_solid(set: &mut CellSet, number: u32, solid: &SolidModel, has_facets: bool, budget: &Budget) {
    let Expression::Tokens(tokens) = &solid.expression else { return };
    let region = core(solid);
    if region.is_empty() {
        return;
    }
    let mut builder = Builder::new(set, number, solid, has_facets, budget);
    builder.run(Work { region, tokens: tokens.clone(), gainless: 0, depth: 0 });
}

/// The box that is cut into cells: all of the solid, or the hull of its bounded leaves.
pub fn core(solid: &SolidModel) -> Aabb {
    if solid.bounds.is_finite() || solid.bounds.is_empty() {
        return solid.bounds;
    }
    let bounded = solid.leaves.iter().map(|leaf| leaf.bounds()).filter(|b| b.is_finite());
    let hull = bounded.fold(Aabb::EMPTY, |hull, b| hull.union(b)).intersection(&solid.bounds);
    if hull.is_empty() { Aabb::EMPTY } else { hull.dilated(2.0 * PAD * solid.tolerance) }
}

/// Adds one pseudo-cell for what an unbounded solid is beyond its core, and returns its number with the core: bounded
/// leaves are outside there. `None` when nothing is left.
pub fn append_outer(set: &mut CellSet, number: u32, solid: &SolidModel) -> Option<(u32, Aabb)> {
    let Expression::Tokens(tokens) = &solid.expression else { return None };
    if solid.bounds.is_finite() || solid.bounds.is_empty() {
        return None;
    }
    let bounded = |leaf: u32| solid.leaves[leaf as usize].bounds().is_finite();
    let mut out = Vec::new();
    if substitute(tokens, |leaf| bounded(leaf).then_some(false), &mut out).is_some() {
        return None;
    }
    let (out, leaves) = essential(out)?;
    let first = set.push_kernels(&solid.leaves);
    let cell = set.push(number, Aabb::EVERYTHING, &leaves, &out, first);
    Some((cell, core(solid)))
}

/// The expression without the leaves that its value does not depend on, as far as a truth table tells, and the leaves that
/// are left; `None` when it is constant.
pub fn essential(tokens: Vec<Token>) -> Option<(Vec<Token>, Vec<u32>)> {
    let leaves = leaves_of(&tokens);
    if leaves.len() > TABLE_LEAVES {
        return Some((tokens, leaves));
    }
    let slot = |leaf: u32| leaves.binary_search(&leaf).map_or(0, |i| i as u32);
    let table = truth_table::table(&tokens, slot);
    let is_idle = |leaf: u32| !truth_table::depends_on(table, slot(leaf) as usize);
    if !leaves.iter().any(|&leaf| is_idle(leaf)) {
        return Some((tokens, leaves));
    }
    let mut out = Vec::with_capacity(tokens.len());
    match substitute(&tokens, |leaf| is_idle(leaf).then_some(false), &mut out) {
        Some(_) => None,
        None => Some((out.clone(), leaves_of(&out))),
    }
}

/// Distinct leaves of an expression, ascending.
pub fn leaves_of(tokens: &[Token]) -> Vec<u32> {
    let literal = |token: &Token| match token.word() {
        Word::Literal { leaf, .. } => Some(leaf),
        Word::Node { .. } => None,
    };
    let mut leaves: Vec<u32> = tokens.iter().filter_map(literal).collect();
    leaves.sort_unstable();
    leaves.dedup();
    leaves
}

struct Builder<'a> {
    set: &'a mut CellSet,
    has_facets: bool,
    number: u32,
    first_kernel: u32,
    solid: &'a SolidModel,
    pad: f64,
    /// States of leaves in the region at hand; `None` is boundary. Only entries of the region's leaves are current.
    states: Vec<Option<bool>>,
    /// Cells may still be cut so often: every cut makes one more, until it is found to be empty.
    cells_left: usize,
    bytes_left: usize,
    work_left: u64,
}

impl<'a> Builder<'a> {
    fn new(set: &'a mut CellSet, number: u32, solid: &'a SolidModel, has_facets: bool, budget: &Budget) -> Builder<'a> {
        let first_kernel = set.push_kernels(&solid.leaves);
        Builder {
            set,
            has_facets,
            number,
            first_kernel,
            solid,
            pad: PAD * solid.tolerance,
            states: vec![None; solid.leaves.len()],
            cells_left: (1024 + 64 * solid.leaves.len()).min(budget.cells.saturating_sub(1)),
            bytes_left: budget.bytes,
            work_left: LEAST_WORK + WORK_PER_LEAF * solid.leaves.len() as u64,
        }
    }

    fn run(&mut self, first: Work) {
        let mut stack = vec![first];
        while let Some(mut work) = stack.pop() {
            let Some(leaves) = self.simplify(&mut work) else {
                self.cells_left = self.cells_left.saturating_add(1);
                continue;
            };
            match self.cut(&work, &leaves) {
                Some((low, high)) => {
                    self.cells_left = self.cells_left.saturating_sub(1);
                    stack.extend([high, low]);
                }
                None => {
                    let before = self.set.bytes();
                    let bounds = work.region.dilated(self.solid.tolerance);
                    self.set.push(self.number, bounds, &leaves, &work.tokens, self.first_kernel);
                    self.bytes_left = self.bytes_left.saturating_sub(self.set.bytes() - before);
                }
            }
        }
    }

    fn spend(&mut self, work: u64) {
        self.work_left = self.work_left.saturating_sub(work);
    }

    /// Reduces the expression to what matters in the region, and the region to where the surface is. Returns the leaves
    /// that are left; `None` when no surface is.
    fn simplify(&mut self, work: &mut Work) -> Option<Vec<u32>> {
        let mut leaves = leaves_of(&work.tokens);
        for _ in 0..ROUNDS {
            let padded = work.region.dilated(self.pad);
            self.spend(leaves.len() as u64);
            for &leaf in &leaves {
                self.states[leaf as usize] = state(&self.solid.leaves[leaf as usize], &padded);
            }
            if leaves.iter().any(|&leaf| self.states[leaf as usize].is_some()) {
                work.tokens = self.substituted(&work.tokens)?;
            }
            (work.tokens, leaves) = essential(std::mem::take(&mut work.tokens))?;
            let pairs = (leaves.len() * leaves.len()) as u64;
            let compare = (2..=DOMINANCE_LEAVES).contains(&leaves.len());
            if compare {
                self.spend(pairs / 16);
            }
            if compare && self.drop_dominated(&mut work.tokens, &padded)? {
                (work.tokens, leaves) = essential(std::mem::take(&mut work.tokens))?;
            }
            if leaves.iter().all(|&leaf| self.is_covered(leaf)) {
                return None;
            }
            let tight = self.tightened(&work.region, &leaves, &work.tokens);
            if tight.is_empty() {
                return None;
            }
            let shrunk = (tight.extent() + self.pad).cmplt(0.99 * (work.region.extent() + self.pad)).any();
            work.region = tight;
            if !shrunk {
                break;
            }
        }
        Some(leaves)
    }

    /// The leaf's surface has cells and facets of its own.
    fn is_covered(&self, leaf: u32) -> bool {
        self.has_facets && mesh_of(&self.solid.leaves[leaf as usize]).is_some()
    }

    /// With the current states put in; `None` when constant.
    fn substituted(&self, tokens: &[Token]) -> Option<Vec<Token>> {
        let mut out = Vec::with_capacity(tokens.len());
        match substitute(tokens, |leaf| self.states[leaf as usize], &mut out) {
            Some(_) => None,
            None => Some(out),
        }
    }

    /// Whether anything went; `None` when the expression became constant.
    fn drop_dominated(&self, tokens: &mut Vec<Token>, padded: &Aabb) -> Option<bool> {
        let Some(known) = dominance::replacements(tokens, &self.solid.leaves, padded, self.pad) else {
            return Some(false);
        };
        // Literals become stand-ins for their positions, so that single occurrences can be replaced.
        let numbered: Vec<Token> = tokens.iter().enumerate().map(|(i, t)| t.renumbered(|_| i as u32)).collect();
        let mut out = Vec::with_capacity(tokens.len());
        if substitute(&numbered, |position| known[position as usize], &mut out).is_some() {
            return None;
        }
        let original = |position: u32| match tokens[position as usize].word() {
            Word::Literal { leaf, .. } => leaf,
            Word::Node { .. } => position,
        };
        let restored = out.iter().map(|t| t.renumbered(original)).collect();
        *tokens = restored;
        Some(true)
    }

    /// The part of the region that can hold surface: where the expression can be true, where it can be false, and where
    /// any leaf has its surface.
    fn tightened(&self, region: &Aabb, leaves: &[u32], tokens: &[Token]) -> Aabb {
        let leaf_bounds = |leaf: u32| *self.solid.leaves[leaf as usize].bounds();
        let surfaces = leaves.iter().filter(|&&leaf| !self.is_covered(leaf));
        let hull = surfaces.fold(Aabb::EMPTY, |hull, &leaf| hull.union(&leaf_bounds(leaf)));
        region.intersection(&hull).intersection(&bounds(tokens, false, leaf_bounds)).intersection(&bounds(
            tokens,
            true,
            leaf_bounds,
        ))
    }

    /// Two halves, if cutting pays.
    fn cut(&mut self, work: &Work, leaves: &[u32]) -> Option<(Work, Work)> {
        if leaves.len() == 1 || work.depth >= MAX_DEPTH {
            return None;
        }
        if self.cells_left == 0 || self.bytes_left == 0 || self.work_left == 0 {
            return None;
        }
        self.spend(SPLIT_WORK * leaves.len() as u64);
        let split = best_split(&work.region, leaves, &work.tokens, &self.solid.leaves, self.pad)?;
        let gain = split.relative_cost < WORTH;
        if !gain && (leaves.len() <= TABLE_LEAVES || work.gainless >= GAINLESS) {
            return None;
        }
        let gainless = if gain { work.gainless } else { work.gainless + 1 };
        let [low, high] = halves(&work.region, split.axis, split.position);
        let half = |region| Work { region, tokens: work.tokens.clone(), gainless, depth: work.depth + 1 };
        Some((half(low), half(high)))
    }
}
