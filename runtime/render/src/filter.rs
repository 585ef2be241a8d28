//! Reconstruction filters, used by filter importance sampling (Ernst, Stamminger and Greiner 2006).
//!
//! A filter is a product of the same function of x and of y, with the pixel's centre at the origin and lengths in
//! pixels. Samples are placed with density |f| / integral |f|, and carry the weight sign(f) integral |f| / integral f,
//! which is 1 for filters without negative lobes. So no sample contributes to a neighbouring pixel, and the mean
//! weight is 1.

use glam::DVec2;

/// Shapes; radii in pixels, positive and finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterShape {
    Box {
        radius: f64,
    },
    Tent {
        radius: f64,
    },
    /// exp(-x^2 / 2 sigma^2), lowered to zero at the radius.
    Gaussian {
        radius: f64,
        sigma: f64,
    },
    /// Mitchell and Netravali 1988, stretched from its own radius 2.
    Mitchell {
        radius: f64,
        b: f64,
        c: f64,
    },
    /// sinc(x) sinc(x / radius): the sinc windowed by its own main lobe (Lanczos 1956; Duchon 1979).
    Lanczos {
        radius: f64,
    },
}

impl Default for FilterShape {
    fn default() -> FilterShape {
        FilterShape::Gaussian { radius: 1.5, sigma: 0.5 }
    }
}

impl FilterShape {
    /// The one-dimensional filter, unnormalised; zero beyond the radius.
    pub fn eval(&self, x: f64) -> f64 {
        let x = x.abs();
        if x > self.radius() {
            return 0.0;
        }
        match *self {
            FilterShape::Box { .. } => 1.0,
            FilterShape::Tent { radius } => 1.0 - x / radius,
            FilterShape::Gaussian { radius, sigma } => {
                let bell = |x: f64| (-0.5 * (x / sigma).powi(2)).exp();
                (bell(x) - bell(radius)).max(0.0)
            }
            FilterShape::Mitchell { radius, b, c } => mitchell(2.0 * x / radius, b, c),
            FilterShape::Lanczos { radius } => sinc(x) * sinc(x / radius),
        }
    }

    pub fn radius(&self) -> f64 {
        match *self {
            FilterShape::Box { radius }
            | FilterShape::Tent { radius }
            | FilterShape::Gaussian { radius, .. }
            | FilterShape::Mitchell { radius, .. }
            | FilterShape::Lanczos { radius } => radius,
        }
    }
}

/// sin(pi x) / (pi x)
fn sinc(x: f64) -> f64 {
    let angle = std::f64::consts::PI * x;
    if angle.abs() < 1e-8 { 1.0 } else { angle.sin() / angle }
}

/// Equation 8 of the paper, times six; `x` >= 0.
fn mitchell(x: f64, b: f64, c: f64) -> f64 {
    let (x2, x3) = (x * x, x * x * x);
    if x < 1.0 {
        (12.0 - 9.0 * b - 6.0 * c) * x3 + (-18.0 + 12.0 * b + 6.0 * c) * x2 + (6.0 - 2.0 * b)
    } else if x < 2.0 {
        (-b - 6.0 * c) * x3 + (6.0 * b + 30.0 * c) * x2 + (-12.0 * b - 48.0 * c) * x + (8.0 * b + 24.0 * c)
    } else {
        0.0
    }
}

/// Cells per axis: the density is constant within one.
const CELLS: usize = 512;

/// A filter ready for sampling.
#[derive(Clone, Debug)]
pub struct ReconstructionFilter {
    radius: f64,
    /// Distribution function of |f| at the edges of the cells, from 0 to 1.
    cumulative: Vec<f64>,
    /// The cell of u = i / CELLS, where the search for a u from there on begins.
    guide: Vec<u16>,
    /// Signed weight of each cell, one axis.
    weights: Vec<f64>,
}

/// Where in the pixel, and with which weight.
#[derive(Clone, Copy, Debug)]
pub struct FilterSample {
    /// From the pixel's centre, pixels.
    pub offset: DVec2,
    pub weight: f64,
}

impl ReconstructionFilter {
    /// Tabulates. A shape whose integral is not positive and finite falls back to the unit box.
    pub fn new(shape: FilterShape) -> ReconstructionFilter {
        let radius = shape.radius();
        let width = 2.0 * radius / CELLS as f64;
        let values: Vec<f64> = (0..CELLS).map(|i| shape.eval((i as f64 + 0.5) * width - radius)).collect();
        let (sum, sum_abs) = (values.iter().sum::<f64>(), values.iter().map(|v| v.abs()).sum::<f64>());
        if !(radius > 0.0 && radius.is_finite() && sum > 0.0 && sum_abs.is_finite()) {
            return ReconstructionFilter::new(FilterShape::Box { radius: 0.5 });
        }
        let mut cumulative = vec![0.0];
        for value in &values {
            cumulative.push(cumulative[cumulative.len() - 1] + value.abs() / sum_abs);
        }
        let cell_of = |u: f64| cumulative.partition_point(|c| *c <= u).clamp(1, CELLS) - 1;
        let guide = (0..CELLS).map(|i| cell_of(i as f64 / CELLS as f64) as u16).collect();
        let weights = values.iter().map(|v| v.signum() * sum_abs / sum).collect();
        ReconstructionFilter { radius, cumulative, guide, weights }
    }

    #[inline]
    pub fn sample(&self, u: [f64; 2]) -> FilterSample {
        let (x, wx) = self.sample_axis(u[0]);
        let (y, wy) = self.sample_axis(u[1]);
        FilterSample { offset: DVec2::new(x, y), weight: wx * wy }
    }

    #[inline]
    fn sample_axis(&self, u: f64) -> (f64, f64) {
        let mut cell = usize::from(self.guide[((u * CELLS as f64) as usize).min(CELLS - 1)]);
        while cell + 1 < CELLS && self.cumulative[cell + 1] <= u {
            cell += 1;
        }
        let (low, high) = (self.cumulative[cell], self.cumulative[cell + 1]);
        let within = if high > low { (u - low) / (high - low) } else { 0.5 };
        let x = (cell as f64 + within) * (2.0 * self.radius / CELLS as f64) - self.radius;
        (x.clamp(-self.radius, self.radius), self.weights[cell])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPES: [FilterShape; 7] = [
        FilterShape::Box { radius: 0.5 },
        FilterShape::Tent { radius: 1.0 },
        FilterShape::Gaussian { radius: 1.5, sigma: 0.5 },
        FilterShape::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 },
        FilterShape::Mitchell { radius: 1.5, b: 0.0, c: 0.5 },
        FilterShape::Lanczos { radius: 2.0 },
        FilterShape::Lanczos { radius: 3.0 },
    ];

    /// A picture that is linear in x and y keeps its value at the pixel's centre, the total weight being one. Bound: the
    /// tables' cells, and 1024 x 1024 regular samples, whose number in a lobe is off by one at most.
    #[test]
    fn a_linear_ramp_is_reproduced() {
        for shape in SHAPES {
            let (n, filter) = (1024, ReconstructionFilter::new(shape));
            let (mut weight, mut value) = (0.0, 0.0);
            for i in 0..n * n {
                let u = [i % n, i / n].map(|k| (k as f64 + 0.5) / n as f64);
                let sample = filter.sample(u);
                weight += sample.weight / (n * n) as f64;
                let ramp = 3.0 + 0.7 * sample.offset.x - 1.3 * sample.offset.y;
                value += sample.weight * ramp / (n * n) as f64;
            }
            assert!((weight - 1.0).abs() < 1e-2 && (value - 3.0 * weight).abs() < 1e-9, "{shape:?}: {weight}, {value}");
        }
    }

    /// Weighted moments of 4096 regular samples agree with those of the filter by quadrature.
    #[test]
    fn weighted_samples_have_the_moments_of_the_filter() {
        for shape in SHAPES {
            let (n, r) = (4096, shape.radius());
            let filter = ReconstructionFilter::new(shape);
            let axis = |i: usize| filter.sample_axis((i as f64 + 0.5) / n as f64);
            let grid = |i: usize| ((i as f64 + 0.5) / n as f64 * 2.0 - 1.0) * r;
            let norm: f64 = (0..n).map(|i| shape.eval(grid(i))).sum();
            for power in [0, 1, 2, 4] {
                let sampled = (0..n).map(|i| axis(i).1 * axis(i).0.powi(power)).sum::<f64>() / n as f64;
                let exact = (0..n).map(|i| shape.eval(grid(i)) * grid(i).powi(power)).sum::<f64>() / norm;
                assert!((sampled - exact).abs() < 2e-3, "{shape:?}, moment {power}: {sampled} instead of {exact}");
            }
        }
    }

    #[test]
    fn only_negative_lobes_cost_weight() {
        for shape in SHAPES {
            let weight = ReconstructionFilter::new(shape).sample([0.5, 0.5]).weight;
            let signed = matches!(shape, FilterShape::Mitchell { .. } | FilterShape::Lanczos { .. });
            assert!(if signed { weight > 1.0 } else { weight == 1.0 }, "{shape:?}: {weight}");
        }
    }

    #[test]
    fn nonsense_becomes_a_box() {
        for shape in [
            FilterShape::Box { radius: 0.0 },
            FilterShape::Gaussian { radius: f64::NAN, sigma: 1.0 },
            FilterShape::Gaussian { radius: 1.0, sigma: 0.0 },
            FilterShape::Lanczos { radius: -1.0 },
            FilterShape::Mitchell { radius: 2.0, b: 1e300, c: -1e300 },
        ] {
            let sample = ReconstructionFilter::new(shape).sample([0.999_999, 0.0]);
            assert!(sample.offset.is_finite() && sample.weight.is_finite(), "{shape:?}");
        }
    }
}
