//! The surface of a superellipsoid cut into patches of known area.
//!
//! The faces of the cube about it are projected from the centre: with `w` on a face, the point is `w / F(w)` and its area
//! element `|∇F(w)| / F(w)³` times that of the face. Coordinates on a face are powers of uniform ones, so that the elements
//! stay finite at spikes. Only the octant of positive coordinates is tabulated.

use glam::DVec3;

use crate::area_table::AreaTable;
use crate::superquadric::Superquadric;

/// Cells along one side of a face.
const CELLS: usize = 24;
/// Nodes and weights of Gauss's quadrature on [0, 1].
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_92),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_92),
];

/// Areas of the patches of an octant, face by face.
#[derive(Clone, Debug)]
pub(crate) struct Patches {
    cells: AreaTable,
    /// Coordinates on a face are uniform ones to this power.
    power: f64,
}

impl Patches {
    pub(crate) fn new(solid: &Superquadric) -> Patches {
        let power = solid.exponents().into_iter().fold(1.0, |power: f64, e| power.max(0.5 * e));
        let step = 1.0 / CELLS as f64;
        let cell = |i: usize| {
            let (face, row, column) = (i / (CELLS * CELLS), i / CELLS % CELLS, i % CELLS);
            let at = |cell: usize, node: f64| (cell as f64 + node) * step;
            let nodes = GAUSS.iter().flat_map(|&(x, wx)| GAUSS.iter().map(move |&(y, wy)| (x, y, wx * wy)));
            let sum: f64 =
                nodes.map(|(x, y, weight)| weight * element(solid, power, face, [at(row, x), at(column, y)])).sum();
            sum * step * step
        };
        Patches { cells: AreaTable::new((0..3 * CELLS * CELLS).map(cell)), power }
    }

    pub(crate) fn area(&self) -> f64 {
        8.0 * self.cells.total()
    }

    /// The octant by the first bits of `u`.
    pub(crate) fn sample(&self, solid: &Superquadric, u: [f64; 2]) -> DVec3 {
        let (octant, rest) = ((8.0 * u[0]).floor().min(7.0), (8.0 * u[0]).fract());
        let (cell, inner) = self.cells.choose(rest);
        let (face, row, column) = (cell / (CELLS * CELLS), cell / CELLS % CELLS, cell % CELLS);
        let w =
            direction(face, self.power, [(row as f64 + inner) / CELLS as f64, (column as f64 + u[1]) / CELLS as f64]);
        w / solid.gauge(w) * signs(octant as u32)
    }

    /// The middle of every patch with its area.
    pub(crate) fn pieces(&self, solid: &Superquadric) -> Vec<(DVec3, f64)> {
        let middle = |i: usize| (i as f64 + 0.5) / CELLS as f64;
        let octant = (0..self.cells.len()).map(|cell| {
            let (face, row, column) = (cell / (CELLS * CELLS), cell / CELLS % CELLS, cell % CELLS);
            let w = direction(face, self.power, [middle(row), middle(column)]);
            (w / solid.gauge(w), self.cells.area(cell))
        });
        octant.flat_map(|(p, area)| (0..8).map(move |octant| (p * signs(octant), area))).collect()
    }

    /// Per unit of area, at a surface point.
    pub(crate) fn density(&self, solid: &Superquadric, p: DVec3) -> f64 {
        let a = p.abs();
        let face = if a.z >= a.x && a.z >= a.y { 2 } else { usize::from(a.y > a.x) };
        let place = [a[(face + 1) % 3], a[(face + 2) % 3]].map(|x| (x / a[face]).min(1.0).powf(1.0 / self.power));
        let [row, column] = place.map(|x| ((x * CELLS as f64) as usize).min(CELLS - 1));
        let mean = self.cells.area((face * CELLS + row) * CELLS + column) * (CELLS * CELLS) as f64;
        mean / element(solid, self.power, face, place) / self.area()
    }
}

fn signs(octant: u32) -> DVec3 {
    let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
    DVec3::new(sign(0), sign(1), sign(2))
}

/// The point of a face of the cube (0 +x, 1 +y, 2 +z) at uniform coordinates.
fn direction(face: usize, power: f64, place: [f64; 2]) -> DVec3 {
    let mut w = DVec3::ONE;
    w[(face + 1) % 3] = place[0].powf(power);
    w[(face + 2) % 3] = place[1].powf(power);
    w
}

/// Area per unit square of uniform coordinates.
fn element(solid: &Superquadric, power: f64, face: usize, place: [f64; 2]) -> f64 {
    // Not on the edges, where some factors are 0 and others infinite.
    let place = place.map(|x| x.max(1e-12));
    let w = direction(face, power, place);
    let stretch: f64 = place.iter().map(|x| power * x.powf(power - 1.0)).product();
    stretch * solid.gradient(w).length() / solid.gauge(w).powi(3)
}
