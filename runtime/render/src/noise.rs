//! How noisy a film is: the variance of every pixel's luminance, and when a tile has had enough samples.
//!
//! *Variance.* A pixel's samples are taken in blocks of [`BLOCK`] consecutive ones. The variance between the means of
//! blocks estimates the variance of the pixel's mean. For independent samples it is unbiased. Stratified sequences make
//! the pixel's mean better than independent blocks would: there the estimate is an upper bound in the mean, less so than
//! that of single samples would be, for the first four points of Sobol' are stratified already. Moments of disjoint
//! samples add, so films merge.
//!
//! *Noise* of a tile is the root mean square of its pixels' standard errors over the tile's mean luminance, or over
//! [`DARK`] of the picture's (logarithmic) average where the tile is darker than that. The picture's noise is the median.
//!
//! *Stopping.* With a noise threshold, a tile gets samples as long as it or one of its eight neighbours is above the
//! threshold or has fewer than [`FEWEST`] samples. Decisions fall between passes over the picture, from all samples so
//! far: they do not depend on threads. A stopping rule that looks at a pixel's own samples is biased, since a pixel that
//! happens to have missed what is rare and bright looks calm (Kirk and Arvo 1991). Here a pixel weighs 1/256 in its
//! tile's estimate and 1/2304 among those that decide, as in the block-wise rule of Dammertz, Hanika, Keller and
//! Lensch 2010, so what is left of the bias is lost in the noise asked for; tiles also go on again when a neighbour finds
//! what they had missed.

use arsc_spectral::LUMINOUS_EFFICACY;

/// Samples of a block.
const BLOCK: u32 = 4;

/// Samples per pixel before the first decision.
pub(crate) const FEWEST: u32 = 32;

/// Tiles darker than this share of the picture's average luminance are held to the same absolute noise.
const DARK: f64 = 0.1;

/// Luminance per sum of a sample's four estimates.
const SCALE: f64 = 0.25 * LUMINOUS_EFFICACY;

/// Moments of the blocks of a pixel: of their luminance y and of their filter weight w.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LuminanceMoments {
    /// Of closed blocks: y, w, y^2, y w, w^2.
    y: f64,
    w: f64,
    yy: f64,
    yw: f64,
    ww: f64,
    /// Sums of the open block.
    open: [f32; 2],
    /// Samples in closed blocks and in the open one.
    counted: u32,
}

impl LuminanceMoments {
    /// Adds a sample: the sum of its four estimates, weighed by the observer's y and by the filter, and the filter's weight.
    #[inline]
    pub fn add(&mut self, estimate: f64, weight: f64) {
        self.open = [self.open[0] + estimate as f32, self.open[1] + weight as f32];
        self.counted += 1;
        if self.counted.is_multiple_of(BLOCK) {
            let [y, w] = self.open.map(f64::from);
            self.y += y;
            self.w += w;
            self.yy += y * y;
            self.yw += y * w;
            self.ww += w * w;
            self.open = [0.0; 2];
        }
    }

    /// Adds those of other samples; what is in open blocks is left out.
    pub fn merge(&mut self, other: &LuminanceMoments) {
        self.y += other.y;
        self.w += other.w;
        self.yy += other.yy;
        self.yw += other.yw;
        self.ww += other.ww;
        self.open = [0.0; 2];
        self.counted = self.blocks() * BLOCK + other.blocks() * BLOCK;
    }

    fn blocks(&self) -> u32 {
        self.counted / BLOCK
    }

    /// Variance of the mean luminance of `samples` samples, (cd m^-2)^2; `None` with fewer than two blocks. The mean is
    /// the ratio of the sums of y and w, its variance that of y minus the ratio times w (the first order in 1 / samples; exact
    /// for filters without negative lobes, whose weights are one).
    pub fn variance_of_mean(&self, samples: u32) -> Option<f64> {
        let blocks = f64::from(self.blocks());
        if blocks < 2.0 || samples == 0 {
            return None;
        }
        let weight = self.weight();
        let ratio = self.y / weight;
        let of_block = (self.yy - 2.0 * ratio * self.yw + ratio * ratio * self.ww).max(0.0) / (blocks - 1.0);
        let per_sample = SCALE * blocks / weight;
        Some(of_block * per_sample * per_sample * f64::from(BLOCK) / f64::from(samples))
    }

    fn mean(&self) -> f64 {
        self.y * SCALE / self.weight()
    }

    fn weight(&self) -> f64 {
        limited_weight(self.w, self.blocks() * BLOCK).max(f64::MIN_POSITIVE)
    }
}

/// The sum of the filter weights of a number of samples, at least half of that number: weights with negative lobes may nearly
/// cancel while samples are few.
#[inline]
pub(crate) fn limited_weight(sum: f64, samples: u32) -> f64 {
    sum.max(0.5 * f64::from(samples))
}

/// Sums over the pixels of a tile.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TileNoise {
    luminance: f64,
    variance: f64,
    pixels: f64,
    /// Of the pixel with the fewest.
    samples: u32,
}

impl TileNoise {
    /// Takes in a pixel; `None` if nothing can be said about it.
    pub fn add(&mut self, moments: &LuminanceMoments, samples: u32) -> Option<()> {
        self.variance += moments.variance_of_mean(samples)?;
        self.luminance += moments.mean();
        self.samples = if self.pixels == 0.0 { samples } else { self.samples.min(samples) };
        self.pixels += 1.0;
        Some(())
    }

    fn mean_luminance(&self) -> f64 {
        self.luminance / self.pixels
    }
}

/// The noise of a film's tiles; `None` for a tile that cannot tell yet.
pub(crate) struct NoiseMap {
    relative: Vec<Option<f64>>,
    samples: Vec<u32>,
    columns: usize,
}

impl NoiseMap {
    /// `tiles` by rows of `columns`.
    pub fn new(tiles: &[Option<TileNoise>], columns: usize) -> NoiseMap {
        let lit = tiles.iter().flatten().map(TileNoise::mean_luminance).filter(|l| *l > 0.0);
        let (sum, count) = lit.fold((0.0, 0u32), |(sum, count), l| (sum + l.ln(), count + 1));
        // Without any luminance nothing can be said: nobody sees these wavelengths.
        let dark = (count > 0).then(|| DARK * (sum / f64::from(count)).exp());
        let relative = |tile: &TileNoise| {
            let reference = tile.mean_luminance().max(dark?);
            Some((tile.variance / tile.pixels).sqrt() / reference)
        };
        NoiseMap {
            relative: tiles.iter().map(|tile| tile.as_ref().and_then(relative)).collect(),
            samples: tiles.iter().map(|tile| tile.map_or(0, |t| t.samples)).collect(),
            columns: columns.max(1),
        }
    }

    /// The median of the tiles, which a few fireflies do not change; `None` unless all can tell.
    pub fn of_picture(&self) -> Option<f64> {
        let mut noise: Vec<f64> = self.relative.iter().copied().collect::<Option<_>>()?;
        noise.sort_by(f64::total_cmp);
        noise.get(noise.len() / 2).copied()
    }

    /// Samples that a tile seems to need until it and its neighbours are below a threshold: those that it has, if they are.
    pub fn samples_needed(&self, tile: usize, threshold: f64) -> u32 {
        let (row, column) = (tile / self.columns, tile % self.columns);
        let rows = self.relative.len().div_ceil(self.columns);
        let mut needed = self.samples[tile];
        for y in row.saturating_sub(1)..(row + 2).min(rows) {
            for x in column.saturating_sub(1)..(column + 2).min(self.columns) {
                let at = y * self.columns + x;
                needed = needed.max(self.own_samples_needed(at, threshold));
            }
        }
        needed
    }

    fn own_samples_needed(&self, tile: usize, threshold: f64) -> u32 {
        let Some(&samples) = self.samples.get(tile) else { return 0 };
        match self.relative[tile] {
            Some(noise) if samples >= FEWEST && noise <= threshold => 0,
            // Noise falls with the root of the samples; at least one more is needed.
            Some(noise) => {
                let factor = (noise / threshold).powi(2).max(1.0);
                ((f64::from(samples) * factor).ceil() as u32).max(FEWEST).max(samples.saturating_add(1))
            }
            None => u32::MAX,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(samples: impl Iterator<Item = f64>) -> LuminanceMoments {
        let mut moments = LuminanceMoments::default();
        samples.for_each(|sample| moments.add(sample, 1.0));
        moments
    }

    /// Of pseudo-random uniform samples, variance 1/12: over 4000 pixels of 40 samples the mean of the estimates is
    /// that of the truth within five standard errors (relative: sqrt(2 / (9 * 4000)) = 0.75 %).
    #[test]
    fn the_variance_of_independent_samples_is_unbiased() {
        use crate::sampler::{SampleSequence, Sampler};
        let (pixels, n) = (4000, 40);
        let of = |pixel: u32| {
            let sample = |i| Sampler::of(SampleSequence::Independent, 5, [pixel, 0], i).single(0);
            moments((0..n).map(sample)).variance_of_mean(n).unwrap()
        };
        let mean = (0..pixels).map(of).sum::<f64>() / f64::from(pixels);
        let exact = SCALE * SCALE / 12.0 / f64::from(n);
        assert!((mean / exact - 1.0).abs() < 5.0 * 0.0075, "{mean} instead of {exact}");
    }

    /// Luminance in proportion to the weight is no noise: the mean is a ratio.
    #[test]
    fn weights_of_a_constant_cost_no_noise() {
        let mut moments = LuminanceMoments::default();
        (0..32).for_each(|i| moments.add(if i % 5 == 0 { -2.0 } else { 3.0 }, if i % 5 == 0 { -1.0 } else { 1.5 }));
        assert!(moments.variance_of_mean(32).unwrap() < 1e-9 * moments.mean().powi(2));
        assert!((moments.mean() / (2.0 * SCALE) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn moments_merge_block_by_block() {
        let value = |i: u32| f64::from(i * i % 17);
        let whole = moments((0..24).map(value));
        let mut merged = moments((0..8).map(value));
        merged.merge(&moments((8..24).map(value)));
        assert_eq!(merged, whole);
        // An open block is dropped, and the next one begins anew.
        let mut cut = moments((0..10).map(value));
        cut.merge(&moments((8..24).map(value)));
        assert_eq!(cut, whole);
        assert_eq!(moments((0..7).map(value)).variance_of_mean(7), None);
    }

    fn tile(luminance: f64, noise: f64, samples: u32) -> Option<TileNoise> {
        Some(TileNoise { luminance: 4.0 * luminance, variance: 4.0 * noise * noise, pixels: 4.0, samples })
    }

    #[test]
    fn tiles_go_on_while_a_neighbour_is_noisy() {
        let mut tiles = vec![tile(1.0, 0.005, 64); 20];
        tiles[7] = tile(1.0, 0.02, 64);
        let map = NoiseMap::new(&tiles, 5);
        let going_on: Vec<usize> = (0..20).filter(|&i| map.samples_needed(i, 0.01) > 64).collect();
        assert_eq!(going_on, [1, 2, 3, 6, 7, 8, 11, 12, 13]);
        assert_eq!(map.samples_needed(7, 0.01), 256, "twice the noise, four times the samples");
        assert!(NoiseMap::new(&[tile(1.0, 0.0, 16)], 1).samples_needed(0, 0.01) > 16, "too few to decide");
        assert_eq!(NoiseMap::new(&[None], 1).samples_needed(0, 0.01), u32::MAX);
    }

    #[test]
    fn dark_tiles_are_held_to_the_picture() {
        let map = NoiseMap::new(&[tile(1.0, 0.0, 64), tile(1e-3, 1e-3, 64), tile(0.0, 0.0, 64)], 3);
        // The average is sqrt(1e-3): a tenth of it is three times the dark tile's own luminance.
        assert!((map.relative[1].unwrap() - 1e-3 / (0.1 * 1e-3f64.sqrt())).abs() < 1e-9);
        assert_eq!(map.relative[2], Some(0.0));
        let blind = NoiseMap::new(&[tile(0.0, 0.0, 64)], 1);
        assert_eq!((blind.of_picture(), blind.samples_needed(0, 1.0)), (None, u32::MAX));
    }
}
