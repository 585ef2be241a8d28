//! Environments from pictures in latitude and longitude.
//!
//! The top row is about +z, the bottom row about -z; the middle of the picture shows +x, and what is right of it -y, as seen
//! from within. Radiance is bilinear between the centres of pixels, around the seam, and constant from the outermost rows to the poles.
//! Colours become spectra by [`ColourBasis::emission`]; spectral pictures hold radiance, W m^-2 sr^-1 nm^-1.
//!
//! Sampling: between the centres of rows and columns lie patches; each is chosen in proportion to its mean radiance times its
//! solid angle, which is the mean of its corners (the mean over colours or wavelengths of each), then a direction uniform per solid
//! angle within it. The density is that of exactly this, and no lit direction has none.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use arsc_spectral::{Channels, ColourBasis, Raster, SampledSpectrum, SampledWavelengths};
use glam::{DMat3, DVec3};

use super::EnvironmentSample;
use super::grid::GridDistribution;

#[derive(Clone, Debug)]
pub struct ImageEnvironment {
    image: Arc<Raster>,
    /// Orthonormal; may be left-handed.
    world_from_local: DMat3,
    scale: f32,
    /// Over patches: columns from centre to centre, rows from the pole over the centres to the other pole.
    patches: GridDistribution,
    /// Cosines of the angle from +z at the borders of the rows of patches.
    cosines: Vec<f64>,
    fluence: f64,
}

/// The four pixels about a direction.
struct Corners {
    columns: [usize; 2],
    rows: [usize; 2],
    /// Of each of the pixels (column 0 and 1 of row 0, then of row 1).
    weights: [f32; 4],
}

impl ImageEnvironment {
    /// `world_from_local` is orthonormal; `scale` is finite and not negative.
    pub(super) fn new(image: Arc<Raster>, world_from_local: DMat3, scale: f64) -> ImageEnvironment {
        let (columns, rows) = (image.width(), image.height());
        let theta = |border: usize| match border {
            0 => 0.0,
            border if border > rows => PI,
            border => PI * (border as f64 - 0.5) / rows as f64,
        };
        let cosines: Vec<f64> = (0..=rows + 1).map(|border| theta(border).cos()).collect();
        let brightness = |column: usize, row: usize| {
            let pixel = image.pixel(column % columns, row);
            f64::from(pixel.iter().map(|value| value.max(0.0)).sum::<f32>()) / pixel.len() as f64
        };
        let mut weights = Vec::with_capacity(columns * (rows + 1));
        let mut total = 0.0;
        for row in 0..=rows {
            let (above, below) = (row.saturating_sub(1), row.min(rows - 1));
            let solid_angle = TAU / columns as f64 * (cosines[row] - cosines[row + 1]);
            for column in 0..columns {
                let corners = [(column, above), (column + 1, above), (column, below), (column + 1, below)];
                let mean = 0.25 * corners.iter().map(|(c, r)| brightness(*c, *r)).sum::<f64>();
                total += mean * solid_angle;
                weights.push(mean * solid_angle);
            }
        }
        let scale = if scale.is_finite() { scale.max(0.0) } else { 0.0 };
        ImageEnvironment {
            patches: GridDistribution::new(columns, &weights),
            image,
            world_from_local,
            scale: scale as f32,
            cosines,
            fluence: total * scale,
        }
    }

    /// Position in patches: column from 0, row from 0, both with fractions.
    #[inline]
    fn place(&self, wi: DVec3) -> [f64; 2] {
        let local = self.world_from_local.transpose() * wi;
        // Columns run against the turn about z, and the first one begins half a turn from +x.
        let turn = 0.5 - local.y.atan2(local.x) / TAU;
        let (columns, rows) = (self.image.width() as f64, self.image.height() as f64);
        let column = (turn * columns - 0.5).rem_euclid(columns);
        // From the chord near the poles, where the cosine has lost its digits.
        let sin = (local.x * local.x + local.y * local.y).sqrt();
        let row = sin.atan2(local.z) / PI * rows + 0.5;
        [column.min(columns.next_down()), row.clamp(0.0, (rows + 1.0).next_down())]
    }

    #[inline]
    fn corners(&self, wi: DVec3) -> Corners {
        let [column, row] = self.place(wi);
        let (c, r) = (column as usize, row as usize);
        let (across, down) = ((column - c as f64) as f32, (row - r as f64) as f32);
        let last = self.image.height() - 1;
        Corners {
            columns: [c, (c + 1) % self.image.width()],
            rows: [r.saturating_sub(1), r.min(last)],
            weights: [(1.0 - across) * (1.0 - down), across * (1.0 - down), (1.0 - across) * down, across * down],
        }
    }

    #[inline]
    pub(super) fn radiance(&self, wi: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let Corners { columns, rows, weights } = self.corners(wi);
        let pixels = [(columns[0], rows[0]), (columns[1], rows[0]), (columns[0], rows[1]), (columns[1], rows[1])];
        match self.image.channels() {
            Channels::Rgb => {
                let mut rgb = [0.0; 3];
                for ((column, row), weight) in pixels.into_iter().zip(weights) {
                    let pixel = self.image.pixel(column, row);
                    (0..3).for_each(|c| rgb[c] += pixel[c].max(0.0) * weight);
                }
                ColourBasis::emission().sample(rgb, wavelengths) * self.scale
            }
            Channels::Spectral(_) => {
                let mut sum = SampledSpectrum::ZERO;
                for ((column, row), weight) in pixels.into_iter().zip(weights) {
                    sum += self.image.spectrum(column, row, wavelengths).map(|value| value.max(0.0)) * weight;
                }
                sum * self.scale
            }
        }
    }

    #[inline]
    pub(super) fn sample(&self, u: [f64; 2], wavelengths: &SampledWavelengths) -> Option<EnvironmentSample> {
        let ([x, y], _) = self.patches.sample(u);
        let rows = (self.cosines.len() - 1) as f64;
        let row = ((y * rows) as usize).min(self.cosines.len() - 2);
        let z =
            self.cosines[row] + (self.cosines[row + 1] - self.cosines[row]) * (y * rows - row as f64).clamp(0.0, 1.0);
        let columns = self.image.width() as f64;
        let turn = TAU * (0.5 - (x * columns + 0.5) / columns);
        let (sin, cos) = turn.sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        let wi = (self.world_from_local * DVec3::new(r * cos, r * sin, z)).normalize();
        let pdf = self.pdf(wi);
        (pdf > 0.0).then(|| EnvironmentSample { wi, radiance: self.radiance(wi, wavelengths), pdf })
    }

    #[inline]
    pub(super) fn pdf(&self, wi: DVec3) -> f64 {
        let [column, row] = self.place(wi);
        let rows = (self.cosines.len() - 1) as f64;
        let density = self.patches.density([column / self.image.width() as f64, row / rows]);
        let row = (row as usize).min(self.cosines.len() - 2);
        density / (rows * TAU * (self.cosines[row] - self.cosines[row + 1]))
    }

    /// Mean radiance per nm over the sphere times its solid angle, roughly; W m^-2 nm^-1.
    pub(super) fn fluence(&self) -> f64 {
        self.fluence
    }
}
