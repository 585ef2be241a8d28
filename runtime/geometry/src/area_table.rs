//! Areas of many pieces, to choose one in proportion to its area.

/// Cumulative areas.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AreaTable {
    /// `ends[i]` is the sum of the areas up to piece `i`.
    ends: Vec<f64>,
}

impl AreaTable {
    /// Areas are not negative; at least one piece.
    pub(crate) fn new(areas: impl IntoIterator<Item = f64>) -> AreaTable {
        let mut sum = 0.0;
        let add = |area: f64| {
            sum += area;
            sum
        };
        AreaTable { ends: areas.into_iter().map(add).collect() }
    }

    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(crate) fn total(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    pub(crate) fn area(&self, piece: usize) -> f64 {
        self.ends[piece] - self.start(piece)
    }

    fn start(&self, piece: usize) -> f64 {
        if piece == 0 { 0.0 } else { self.ends[piece - 1] }
    }

    /// A piece in proportion to its area, and what is left of `u`, uniform again. `u` in [0, 1).
    pub(crate) fn choose(&self, u: f64) -> (usize, f64) {
        let wanted = u * self.total();
        let piece = self.ends.partition_point(|&end| end <= wanted).min(self.ends.len() - 1);
        let area = self.area(piece);
        let rest = if area > 0.0 { (wanted - self.start(piece)) / area } else { 0.0 };
        (piece, rest.clamp(0.0, 1.0))
    }
}

/// Barycentric weights of a point uniform over a triangle (the weights of its second and third corner).
pub(crate) fn triangle_weights(u: [f64; 2]) -> [f64; 2] {
    let root = u[0].sqrt();
    [root * (1.0 - u[1]), root * u[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_chosen_by_area() {
        let table = AreaTable::new([1.0, 0.0, 3.0]);
        assert_eq!((table.total(), table.len(), table.area(2)), (4.0, 3, 3.0));
        assert_eq!(table.choose(0.125), (0, 0.5));
        assert_eq!(table.choose(0.25), (2, 0.0));
        assert_eq!(table.choose(0.625), (2, 0.5));
    }
}
