//! Point membership in higher precision: knows the definitions of the shapes and nothing of the tracer.
//!
//! A leaf gives a value that is negative inside, zero on the boundary and changes by no more than the distance moved, in object
//! space, so its size is a lower bound of the distance to the boundary. A point is *near* the boundary when that bound,
//! taken to the world by the map's norm, is below a threshold; then the leaf's answer is open, and the tree is evaluated
//! with three values.

use arsc_accel::{Csg, CsgLeaf, Shape};
use arsc_geometry::{Hyperboloid, Paraboloid};
use glam::{DAffine3, DVec3};

use crate::dd::{Dd, Number};
use crate::flat;

/// A point, or a row of a map, in double-double.
type V = [Dd; 3];

pub struct Leaf {
    pub shape: Shape,
    /// Rows of the exact inverse, with the translation.
    rows: [(V, Dd); 3],
    /// Bounds how many times longer a vector is in object space.
    pub shrink: f64,
    /// The same in single rows of plain doubles, and the error that comes of them per unit of the largest coordinate.
    quick: DAffine3,
    quick_slope: f64,
    quick_floor: f64,
}

/// Open (`None`) or decided.
pub type Answer = Option<bool>;

fn dot<N: Number>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &V, b: &V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn exact(v: DVec3) -> V {
    v.to_array().map(Dd::from)
}

fn plain<N: Number>(v: &[N; 3]) -> DVec3 {
    DVec3::from_array(v.map(N::to_f64))
}

impl Leaf {
    /// `outer` is the frame of an instance.
    pub fn new(leaf: &CsgLeaf, outer: Option<&DAffine3>) -> Leaf {
        // Columns of the composed map.
        let m = leaf.world_from_object;
        let mut columns = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis, m.translation].map(exact);
        if let Some(outer) = outer {
            let rows = outer.matrix3.transpose();
            let rows = [rows.x_axis, rows.y_axis, rows.z_axis].map(exact);
            for (i, column) in columns.iter_mut().enumerate() {
                let shift = if i == 3 { exact(outer.translation) } else { [Dd::ZERO; 3] };
                *column = std::array::from_fn(|k| dot(&rows[k], column) + shift[k]);
            }
        }
        let [x, y, z, origin] = columns;
        let over = |v: V, det: Dd| v.map(|c| c.over(det));
        let (yz, zx, xy) = (cross(&y, &z), cross(&z, &x), cross(&x, &y));
        let det = dot(&x, &yz);
        let rows = [over(yz, det), over(zx, det), over(xy, det)].map(|row| (row, -dot(&row, &origin)));
        let shrink = rows.iter().map(|(row, _)| plain(row).length_squared()).sum::<f64>().sqrt();
        let quick = DAffine3 {
            matrix3: glam::DMat3::from_cols(plain(&rows[0].0), plain(&rows[1].0), plain(&rows[2].0)).transpose(),
            translation: DVec3::from_array(rows.map(|(_, shift)| shift.to_f64())),
        };
        let size = leaf.shape.magnitude() + quick.translation.abs().max_element();
        let rounding = 64.0 * f64::EPSILON;
        let (quick_slope, quick_floor) = (rounding * 3.0 * shrink, rounding * size);
        Leaf { shape: leaf.shape.clone(), rows, shrink, quick, quick_slope, quick_floor }
    }

    /// The value at a point, and its bound in object space below which the point is near.
    pub fn answer(&self, p: &V, plain: DVec3, near: f64) -> Answer {
        let threshold = near * self.shrink;
        if let Shape::Superquadric(superquadric) = &self.shape {
            return flat::superquadric(superquadric, self.quick.transform_point3(plain), threshold);
        }
        let quick = value(&self.shape, &self.quick.transform_point3(plain).to_array());
        let error = self.quick_slope * plain.abs().max_element() + self.quick_floor;
        if quick.abs() > 2.0 * error + threshold {
            return Some(quick < 0.0);
        }
        let value = self.value(p).to_f64();
        (value.abs() > threshold).then_some(value < 0.0)
    }

    /// On the sharp ridges of a pinched superellipsoid, which has two normals there.
    pub fn is_ridge(&self, p: DVec3) -> bool {
        let Shape::Superquadric(superquadric) = &self.shape else { return false };
        let pinched = superquadric.exponents().into_iter().any(|e| e > 2.0);
        pinched && self.quick.transform_point3(p).abs().min_element() < 1e-6
    }

    /// How far a point is from the surface that a face is part of, in object space; `None` where faces are no simple matter.
    pub fn off_face(&self, face: u32, p: DVec3) -> Option<f64> {
        let p = self.quick.transform_point3(p);
        let end = |low: f64, high: f64, side: f64| match face {
            0 => side,
            1 => p.z - low,
            _ => p.z - high,
        };
        let ring = p.truncate().length();
        Some(
            match self.shape {
                Shape::Box { min, max } => {
                    let axis = face as usize / 2;
                    p[axis] - if face.is_multiple_of(2) { min[axis] } else { max[axis] }
                }
                Shape::Cylinder { radius, height } => end(0.0, height, ring - radius),
                Shape::Cone { base_radius, top_radius, height } => {
                    end(0.0, height, ring - base_radius - (top_radius - base_radius) * p.z / height)
                }
                Shape::Paraboloid(Paraboloid { radius, height }) => {
                    end(0.0, height, ring.powi(2) / radius.powi(2) - p.z / height)
                }
                Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets }) => {
                    let offset = if two_sheets { -radius * radius } else { radius * radius };
                    end(-half_height, half_height, ring.powi(2) - (slope * p.z).powi(2) - offset)
                }
                Shape::Mesh(ref mesh) => {
                    let [a, b, c] = mesh.mesh().corners(face as usize);
                    (b - a).cross(c - a).normalize().dot(p - a)
                }
                Shape::Prism(ref prism) if face < 2 => p.z - if face == 0 { 0.0 } else { prism.height() },
                _ => return None,
            }
            .abs(),
        )
    }

    pub fn value(&self, p: &V) -> Dd {
        value(&self.shape, &self.rows.map(|(row, shift)| dot(&row, p) + shift))
    }
}

/// Where a value is a polynomial over its greatest slope, that slope is taken over points this far away, in sizes: the bound
/// holds below that.
const CLOSE: f64 = 1e-3;

/// Distance from the z axis.
fn ring<N: Number>(p: &[N; 3]) -> N {
    (p[0].squared() + p[1].squared()).sqrt()
}

fn slab<N: Number>(z: N, low: f64, high: f64) -> N {
    (-z + low).max(z - high)
}

/// Negative inside, zero on the boundary; its size is at most the distance to the boundary, as far as that is small.
fn value<N: Number>(shape: &Shape, p: &[N; 3]) -> N {
    match *shape {
        Shape::Sphere { radius } => dot(p, p).sqrt() - radius,
        Shape::Box { min, max } => slab(p[0], min.x, max.x).max(slab(p[1], min.y, max.y)).max(slab(p[2], min.z, max.z)),
        Shape::Cylinder { radius, height } => (ring(p) - radius).max(slab(p[2], 0.0, height)),
        Shape::InfiniteCylinder { radius } => ring(p) - radius,
        Shape::Cone { base_radius, top_radius, height } => {
            let slope = (N::from(top_radius) - base_radius).over(N::from(height));
            let slant = (slope.squared() + 1.0).sqrt();
            let side = (ring(p) - slope * p[2] - base_radius).over(slant);
            side.max(slab(p[2], 0.0, height))
        }
        Shape::Torus { major, minor } => ((ring(p) - major).squared() + p[2].squared()).sqrt() - minor,
        Shape::HalfSpace => p[2],
        Shape::Paraboloid(Paraboloid { radius, height }) => {
            let latus = N::from(radius).squared().over(N::from(height));
            let level = p[0].squared() + p[1].squared() - latus * p[2];
            let reach = ring(p) + CLOSE * radius.max(height);
            let steepest = (reach.squared() * 4.0 + latus.squared()).sqrt();
            level.over(steepest).max(p[2] - height)
        }
        Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets }) => {
            let steep = N::from(slope).squared();
            let offset = N::from(radius).squared() * if two_sheets { -1.0 } else { 1.0 };
            let level = p[0].squared() + p[1].squared() - steep * p[2].squared() - offset;
            let close = CLOSE * shape.magnitude();
            let (across, along) = (ring(p) + close, steep * (p[2].abs() + close));
            let steepest = (across.squared() + along.squared()).sqrt() * 2.0;
            level.over(steepest).max(slab(p[2], -half_height, half_height))
        }
        Shape::Mesh(ref mesh) => N::from(flat::mesh(mesh.mesh(), plain(p))),
        Shape::Polyhedron(ref polyhedron) => N::from(flat::polyhedron(polyhedron, plain(p))),
        Shape::Prism(ref prism) => N::from(flat::prism(prism, plain(p))),
        Shape::Lathe(ref lathe) => N::from(flat::lathe(lathe, plain(p))),
        Shape::Superquadric(_) => unreachable!("has an answer of its own"),
    }
}

/// The tree over the leaves' answers.
pub fn eval(tree: &Csg, answers: &[Answer]) -> Answer {
    match tree {
        Csg::Leaf(i) => answers[*i as usize],
        Csg::Union(list) => any(list.iter().map(|node| eval(node, answers))),
        Csg::Intersection(list) => not(any(list.iter().map(|node| not(eval(node, answers))))),
        Csg::Difference(a, b) => {
            let (a, b) = (eval(a, answers), eval(b, answers));
            not(any([not(a), b].into_iter()))
        }
    }
}

fn not(answer: Answer) -> Answer {
    answer.map(|x| !x)
}

fn any(answers: impl Iterator<Item = Answer>) -> Answer {
    let mut sum = Some(false);
    for answer in answers {
        match answer {
            Some(true) => return Some(true),
            Some(false) => {}
            None => sum = None,
        }
    }
    sum
}
