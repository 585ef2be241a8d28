//! Spatially localised CSG (docs/csg.md): the solid's box cut into cells, each with the expression that is left of the
//! tree there.
//!
//! Invariants. Every boundary point of the solid lies in the box of some cell. Within `PAD` tolerances of a cell's box
//! the cell's expression has the value of the whole tree and the same owners of coincident faces. Cells are traced over
//! their box dilated by one tolerance, so neighbours overlap and a cluster of coincident crossings is never cut in both.

mod build;
mod deferred;
mod dominance;
mod first;
mod query;
mod split;
mod truth_table;

use arsc_geometry::{Aabb, Direct, Placed};
use glam::DVec3;

use crate::expression::Token;

use first::BallPair;

pub use build::{append_outer, append_solid, core, essential, leaves_of};
pub use query::{Entry, Line, Window, entry, leaf_transitions, union_transitions};
pub use split::state;

/// Expressions of at most so many leaves are kept as truth tables.
pub const TABLE_LEAVES: usize = 6;
/// Leaves of this weight are crossed once per ray, and only if need be.
const COSTLY: f64 = 5.0;
/// The margin around a cell in which its expression holds, in tolerances of the solid.
pub const PAD: f64 = 4.0;

/// A box and what the solid is in it.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Dilated by one tolerance.
    pub bounds: Aabb,
    /// The solid's number among those that share a [`CellSet`].
    pub solid: u32,
    leaf_count: u32,
    /// The truth table, or the index of the first token.
    code: u64,
    /// With a truth table: the kernels of the leaves. Otherwise where those are listed, and the number of tokens.
    ids: [u32; TABLE_LEAVES],
    /// With a truth table over balls and upright boxes: the first of its balls in [`CellSet`].
    pairs: u32,
    /// All leaves are balls or upright boxes.
    is_plain: bool,
    /// Slots that hold boxes, if it is plain.
    boxes: u8,
}

/// The leaves of a cell.
#[derive(Clone, Copy)]
pub struct Leaves<'a> {
    kernels: &'a [CellLeaf],
    ids: &'a [u32],
}

impl<'a> Leaves<'a> {
    #[inline]
    fn len(self) -> usize {
        self.ids.len()
    }

    #[inline]
    fn get(self, slot: usize) -> &'a CellLeaf {
        &self.kernels[self.ids[slot] as usize]
    }

    /// By slots.
    #[inline]
    fn iter(self) -> impl Iterator<Item = &'a CellLeaf> {
        self.ids.iter().map(move |&id| &self.kernels[id as usize])
    }
}

/// A leaf of a cell, with what its crossings are computed from where that is little: a cache line.
#[derive(Clone, Copy, Debug)]
pub struct CellLeaf {
    pub leaf: u32,
    pub kernel: Kernel,
}

/// How a leaf is crossed.
#[derive(Clone, Copy, Debug)]
pub enum Kernel {
    Ball {
        center: DVec3,
        radius: f64,
    },
    Box {
        min: DVec3,
        max: DVec3,
    },
    /// By the placed leaf.
    Placed,
    /// The same, and worth keeping from one cell to the next.
    Costly,
}

impl CellLeaf {
    pub fn new(leaf: u32, placed: &[Placed]) -> CellLeaf {
        CellLeaf { leaf, kernel: Kernel::new(&placed[leaf as usize]) }
    }
}

impl Kernel {
    pub fn new(placed: &Placed) -> Kernel {
        match (placed.direct(), placed.shape()) {
            (Some(&Direct::Ball { center, radius }), _) => Kernel::Ball { center, radius },
            (Some(&Direct::Box { min, max }), _) => Kernel::Box { min, max },
            (_, shape) if split::weight(shape) >= COSTLY => Kernel::Costly,
            _ => Kernel::Placed,
        }
    }
}

/// Cells of any number of solids, in flat arrays.
#[derive(Clone, Debug, Default)]
pub struct CellSet {
    pub cells: Vec<Cell>,
    /// Leaves of all solids, solid by solid.
    kernels: Vec<CellLeaf>,
    /// Kernels of the leaves of cells with many of them, ascending.
    ids: Vec<u32>,
    /// Balls of plain cells with truth tables, by slots.
    pairs: Vec<BallPair>,
    /// Expressions of cells with many leaves, over positions in the cell's leaf list.
    tokens: Vec<Token>,
}

/// What decides inside or outside from the states of a cell's leaves.
#[derive(Clone, Copy, Debug)]
pub enum Code<'a> {
    Table(u64),
    Tokens(&'a [Token]),
}

impl Cell {
    #[inline]
    pub fn leaf_count(&self) -> u32 {
        self.leaf_count
    }
}

impl CellSet {
    #[inline]
    fn leaves<'a>(&'a self, cell: &'a Cell) -> Leaves<'a> {
        let count = cell.leaf_count as usize;
        let ids = match cell.ids.get(..count) {
            Some(ids) => ids,
            None => &self.ids[cell.ids[0] as usize..][..count],
        };
        Leaves { kernels: &self.kernels, ids }
    }

    #[inline]
    fn code(&self, cell: &Cell) -> Code<'_> {
        if cell.leaf_count as usize <= TABLE_LEAVES {
            Code::Table(cell.code)
        } else {
            Code::Tokens(&self.tokens[cell.code as usize..][..cell.ids[1] as usize])
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.cells[..])
            + size_of_val(&self.kernels[..])
            + size_of_val(&self.ids[..])
            + size_of_val(&self.pairs[..])
            + size_of_val(&self.tokens[..])
    }

    /// Adds the leaves of a solid, and returns the number of the first one's kernel.
    pub fn push_kernels(&mut self, placed: &[Placed]) -> u32 {
        let first = self.kernels.len() as u32;
        self.kernels.extend((0..placed.len() as u32).map(|leaf| CellLeaf::new(leaf, placed)));
        first
    }

    /// Adds a cell; `leaves` are those of `tokens`, ascending, `first` is their solid's first kernel. Returns the cell's number.
    pub fn push(&mut self, solid: u32, bounds: Aabb, leaves: &[u32], tokens: &[Token], first: u32) -> u32 {
        let slot = |leaf: u32| leaves.binary_search(&leaf).map_or(0, |i| i as u32);
        let mut ids = [0; TABLE_LEAVES];
        let code = if leaves.len() <= TABLE_LEAVES {
            ids.iter_mut().zip(leaves).for_each(|(id, leaf)| *id = first + leaf);
            truth_table::table(tokens, slot)
        } else {
            ids[0] = self.ids.len() as u32;
            ids[1] = tokens.len() as u32;
            self.ids.extend(leaves.iter().map(|leaf| first + leaf));
            let start = self.tokens.len();
            self.tokens.extend(tokens.iter().map(|token| token.renumbered(slot)));
            start as u64
        };
        let plain = |&leaf: &u32| {
            matches!(self.kernels[(first + leaf) as usize].kernel, Kernel::Ball { .. } | Kernel::Box { .. })
        };
        let is_plain = leaves.iter().all(plain);
        let (pairs, mut boxes) = (self.pairs.len() as u32, 0);
        if is_plain && leaves.len() <= TABLE_LEAVES {
            let kernel = |slot: usize| leaves.get(slot).map(|leaf| &self.kernels[(first + leaf) as usize].kernel);
            for slot in 0..leaves.len() {
                boxes |= u8::from(matches!(kernel(slot), Some(Kernel::Box { .. }))) << slot;
            }
            let slots = (0..leaves.len()).step_by(2);
            self.pairs.extend(slots.map(|slot| BallPair::new([kernel(slot), kernel(slot + 1)])));
        }
        self.cells.push(Cell { bounds, solid, leaf_count: leaves.len() as u32, code, ids, pairs, is_plain, boxes });
        (self.cells.len() - 1) as u32
    }
}
