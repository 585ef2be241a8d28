//! Piecewise constant densities over the unit square, sampled row first, then column, by inversion: neighbouring u give
//! neighbouring points, so that stratification survives.

/// A density over `columns` x `rows` equal cells.
#[derive(Clone, Debug)]
pub struct GridDistribution {
    columns: usize,
    rows: usize,
    /// Distribution function over rows, `rows + 1` entries.
    row_cumulative: Vec<f64>,
    /// Distribution function within each row, `columns + 1` entries a row.
    column_cumulative: Vec<f64>,
}

impl GridDistribution {
    /// In proportion to `weights[row][column]`: finite, not negative; uniform when all are zero.
    pub fn new(columns: usize, weights: &[f64]) -> GridDistribution {
        let rows = weights.len() / columns;
        let mut column_cumulative = Vec::with_capacity(rows * (columns + 1));
        let mut row_sums = Vec::with_capacity(rows);
        for row in weights.chunks_exact(columns) {
            row_sums.push(row.iter().sum::<f64>());
            column_cumulative.extend(cumulative(row));
        }
        GridDistribution { columns, rows, row_cumulative: cumulative(&row_sums), column_cumulative }
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.column_cumulative[row * (self.columns + 1)..(row + 1) * (self.columns + 1)]
    }

    /// A point (column, row) of the unit square, and its density.
    #[inline]
    pub fn sample(&self, u: [f64; 2]) -> ([f64; 2], f64) {
        let (y, row, row_density) = invert(&self.row_cumulative, u[1]);
        let (x, _, column_density) = invert(self.row(row), u[0]);
        ([x, y], row_density * column_density)
    }

    /// Density at a point of the unit square.
    #[inline]
    pub fn density(&self, point: [f64; 2]) -> f64 {
        let row = ((point[1] * self.rows as f64) as usize).min(self.rows - 1);
        let column = ((point[0] * self.columns as f64) as usize).min(self.columns - 1);
        density(&self.row_cumulative, row) * density(self.row(row), column)
    }
}

fn cumulative(weights: &[f64]) -> Vec<f64> {
    let total: f64 = weights.iter().sum();
    let n = weights.len() as f64;
    let mut sum = 0.0;
    let mut result = vec![0.0];
    for weight in weights {
        sum += if total > 0.0 { weight / total } else { 1.0 / n };
        result.push(sum);
    }
    result
}

#[inline]
fn density(cumulative: &[f64], cell: usize) -> f64 {
    (cumulative[cell + 1] - cumulative[cell]) * (cumulative.len() - 1) as f64
}

/// Position in [0, 1], its cell and the density there.
#[inline]
fn invert(cumulative: &[f64], u: f64) -> (f64, usize, f64) {
    let cells = cumulative.len() - 1;
    let cell = cumulative.partition_point(|c| *c <= u).clamp(1, cells) - 1;
    let mass = cumulative[cell + 1] - cumulative[cell];
    let within = if mass > 0.0 { ((u - cumulative[cell]) / mass).min(1.0) } else { 0.5 };
    ((cell as f64 + within) / cells as f64, cell, mass * cells as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A regular grid of u: frequencies per cell are the weights; sampled and evaluated densities agree.
    #[test]
    fn frequencies_and_densities_are_the_weights() {
        let weights = [1.0, 0.0, 3.0, 2.0, 5.0, 1.0, 0.0, 0.0];
        let grid = GridDistribution::new(4, &weights);
        let (n, mut counts) = (400, [0.0; 8]);
        for i in 0..n * n {
            let u = [i % n, i / n].map(|k| (k as f64 + 0.5) / n as f64);
            let (point, density) = grid.sample(u);
            let cell = (point[1] * 2.0) as usize * 4 + (point[0] * 4.0) as usize;
            counts[cell] += 1.0 / (n * n) as f64;
            assert!((density - 8.0 * weights[cell] / 12.0).abs() < 1e-12 && grid.density(point) == density);
        }
        for (count, weight) in counts.iter().zip(weights) {
            assert!((count - weight / 12.0).abs() < 5e-3);
        }
    }

    #[test]
    fn nothing_is_uniform() {
        let grid = GridDistribution::new(2, &[0.0; 6]);
        assert!((grid.density([0.9, 0.1]) - 1.0).abs() < 1e-12);
    }
}
