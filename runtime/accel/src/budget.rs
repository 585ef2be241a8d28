//! What the structures over solids may take. Over budget they are left coarser: rays are as right, and slower.

/// Most cells, and most bytes of cells, for all solids of a scene together. Each solid gets a share by the number of
/// its leaves, at least one cell; a solid may go beyond its share by the cells that were begun when it was spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    pub cells: usize,
    pub bytes: usize,
}

impl Budget {
    /// No limit but those that bound the cost of hard solids.
    pub const UNLIMITED: Budget = Budget { cells: usize::MAX, bytes: usize::MAX };

    /// What `part` leaves of `whole` get.
    pub(crate) fn share(&self, part: usize, whole: usize) -> Budget {
        let of = |all: usize| (all as u128 * part as u128 / whole.max(1) as u128) as usize;
        Budget { cells: of(self.cells).max(1), bytes: of(self.bytes) }
    }
}

impl Default for Budget {
    fn default() -> Budget {
        Budget::UNLIMITED
    }
}
