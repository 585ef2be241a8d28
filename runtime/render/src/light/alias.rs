//! Discrete distributions in constant time (Walker's alias method, built as by Vose 1991).

/// A distribution over 0..n.
#[derive(Clone, Debug, Default)]
pub struct AliasTable {
    entries: Vec<Entry>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    probability: f64,
    /// Share of this cell that belongs to its own index.
    own: f64,
    alias: u32,
}

impl AliasTable {
    /// In proportion to `weights`: finite, not negative; uniform when all are zero.
    pub fn new(weights: &[f64]) -> AliasTable {
        let (n, total) = (weights.len(), weights.iter().sum::<f64>());
        let probability = |w: f64| if total > 0.0 { w / total } else { 1.0 / n as f64 };
        let mut entries: Vec<Entry> = weights
            .iter()
            .enumerate()
            .map(|(i, w)| Entry { probability: probability(*w), own: 1.0, alias: i as u32 })
            .collect();
        let mut scaled: Vec<f64> = entries.iter().map(|e| e.probability * n as f64).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| scaled[i] < 1.0);
        while let (Some(&less), Some(&more)) = (small.last(), large.last()) {
            small.pop();
            entries[less] = Entry { own: scaled[less], alias: more as u32, ..entries[less] };
            scaled[more] -= 1.0 - scaled[less];
            if scaled[more] < 1.0 {
                large.pop();
                small.push(more);
            }
        }
        AliasTable { entries }
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// An index and what is left of `u`, uniform in [0, 1) again. The table must not be empty.
    #[inline]
    pub fn sample(&self, u: f64) -> (usize, f64) {
        let at = u * self.entries.len() as f64;
        let cell = (at as usize).min(self.entries.len() - 1);
        let entry = &self.entries[cell];
        let within = at - cell as f64;
        if within < entry.own {
            (cell, within / entry.own)
        } else {
            (entry.alias as usize, (within - entry.own) / (1.0 - entry.own))
        }
    }

    #[inline]
    pub fn probability(&self, index: usize) -> f64 {
        self.entries[index].probability
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A regular grid of 100 000 values of u: frequencies are exact up to one grid step per cell.
    #[test]
    fn frequencies_are_probabilities() {
        let weights = [0.0, 3.0, 1.0, 0.5, 0.0, 5.5];
        let table = AliasTable::new(&weights);
        let (n, mut counts, mut rest) = (100_000, [0u32; 6], 0.0);
        for i in 0..n {
            let (index, left) = table.sample((f64::from(i) + 0.5) / f64::from(n));
            counts[index] += 1;
            rest += left;
            assert!((0.0..=1.0).contains(&left));
        }
        for i in 0..6 {
            assert!((table.probability(i) - weights[i] / 10.0).abs() < 1e-15);
            assert!((f64::from(counts[i]) / f64::from(n) - weights[i] / 10.0).abs() < 1e-4);
        }
        assert!((rest / f64::from(n) - 0.5).abs() < 1e-3);
    }

    #[test]
    fn no_weight_at_all_is_uniform() {
        let table = AliasTable::new(&[0.0; 4]);
        assert_eq!(table.probability(2), 0.25);
        assert_eq!(table.sample(0.6).0, 2);
        assert!(AliasTable::new(&[]).is_empty());
    }
}
