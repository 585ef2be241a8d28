//! Faces of leaves: planes, spheres and cylinders, to find out which of them lie in one place.

use std::hash::{Hash, Hasher};

use arsc_geometry::{Aabb, DAffine3, DVec2, DVec3, Shape, invert};
use arsc_ir::{Leaf, Surface};
use rustc_hash::FxHasher;

/// A face of a leaf in its object space.
#[derive(Clone, Copy, Debug)]
enum Patch {
    /// Corner, the two edges from it, and the normal as a multiple of an axis.
    Parallelogram {
        corner: DVec3,
        edges: [DVec3; 2],
        normal: DVec3,
    },
    Triangle {
        corner: DVec3,
        edges: [DVec3; 2],
        normal: DVec3,
    },
    /// Across the z axis.
    Disc {
        z: f64,
        radius: f64,
        normal: DVec3,
    },
    Plane {
        normal: DVec3,
    },
    Sphere {
        radius: f64,
    },
    /// About the z axis from 0 to `height`.
    Tube {
        radius: f64,
        height: f64,
    },
}

/// A face in its place.
#[derive(Clone, Debug)]
pub(super) struct Face {
    patch: Patch,
    world_from_object: DAffine3,
    object_from_world: DAffine3,
}

impl Face {
    /// The n-th face of a leaf, if it has that many of the kinds known here.
    pub fn of(leaf: &Leaf, n: usize) -> Option<Face> {
        let (patch, map) = match leaf {
            Leaf::Solid { shape, parent_from_object, .. } => (solid_patch(shape, n)?, parent_from_object),
            Leaf::Surface { surface, parent_from_object, .. } => (surface_patch(surface, n)?, parent_from_object),
        };
        Some(Face { patch, world_from_object: *map, object_from_world: invert(map)? })
    }

    /// The same for all faces with one carrier (plane, sphere or cylinder), up to rounding; `unit` is the length
    /// below which positions in the scene are one. `None` for curved faces under maps that distort them.
    pub fn carrier(&self, unit: f64) -> Option<u64> {
        let mut hasher = FxHasher::default();
        let mut put = |x: f64, unit: f64| ((x / unit).round() as i64).hash(&mut hasher);
        let map = &self.world_from_object;
        match self.patch {
            Patch::Sphere { radius } => {
                put(0.0, 1.0);
                put(radius * similarity(map)?, unit);
                map.translation.to_array().into_iter().for_each(|x| put(x, unit));
            }
            Patch::Tube { radius, .. } => {
                put(1.0, 1.0);
                put(radius * similarity(map)?, unit);
                let axis = unsigned(map.transform_vector3(DVec3::Z).normalize());
                axis.to_array().into_iter().for_each(|x| put(x, 1e-6));
                (map.translation - axis * axis.dot(map.translation)).to_array().into_iter().for_each(|x| put(x, unit));
            }
            _ => {
                put(2.0, 1.0);
                let (p, n) = self.point(DVec2::splat(0.5));
                let n = unsigned(n);
                n.to_array().into_iter().for_each(|x| put(x, 1e-6));
                put(n.dot(p), unit);
            }
        }
        Some(hasher.finish())
    }

    /// A point of the face with the normal there; `u` in the unit square.
    pub fn point(&self, u: DVec2) -> (DVec3, DVec3) {
        let angle = std::f64::consts::TAU * u.y;
        let round = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let (p, n) = match self.patch {
            Patch::Parallelogram { corner, edges: [a, b], normal } => (corner + a * u.x + b * u.y, normal),
            Patch::Triangle { corner, edges: [a, b], normal } => {
                let root = u.x.sqrt();
                (corner + a * (1.0 - root) + b * (root * u.y), normal)
            }
            Patch::Disc { z, radius, normal } => (round * (radius * u.x.sqrt()) + DVec3::Z * z, normal),
            Patch::Plane { normal } => (DVec3::ZERO, normal),
            Patch::Sphere { radius } => {
                let z = 1.0 - 2.0 * u.x;
                let n = round * (1.0 - z * z).sqrt() + DVec3::Z * z;
                (n * radius, n)
            }
            Patch::Tube { radius, height } => (round * radius + DVec3::Z * (height * u.x), round),
        };
        let world_normal = self.object_from_world.matrix3.transpose().mul_vec3(n).normalize();
        (self.world_from_object.transform_point3(p), world_normal)
    }

    /// Whether a point of the carrier lies in the face, not close to its rim.
    pub fn holds(&self, p: DVec3) -> bool {
        const RIM: f64 = 1e-6;
        let p = self.object_from_world.transform_point3(p);
        let within = |x: f64| (RIM..1.0 - RIM).contains(&x);
        let coordinates = |corner: DVec3, [a, b]: [DVec3; 2]| {
            let (d, aa, ab, bb) = (p - corner, a.dot(a), a.dot(b), b.dot(b));
            let det = aa * bb - ab * ab;
            DVec2::new(bb * d.dot(a) - ab * d.dot(b), aa * d.dot(b) - ab * d.dot(a)) / det
        };
        match self.patch {
            Patch::Parallelogram { corner, edges, .. } => {
                let u = coordinates(corner, edges);
                within(u.x) && within(u.y)
            }
            Patch::Triangle { corner, edges, .. } => {
                let u = coordinates(corner, edges);
                u.x > RIM && u.y > RIM && u.x + u.y < 1.0 - RIM
            }
            Patch::Disc { radius, .. } => p.truncate().length() < radius * (1.0 - RIM),
            Patch::Plane { .. } | Patch::Sphere { .. } => true,
            Patch::Tube { height, .. } => within(p.z / height),
        }
    }

    /// The box of the face; infinite for a plane.
    pub fn bounds(&self) -> Aabb {
        let hull = |points: &[DVec3]| points.iter().fold(Aabb::EMPTY, |hull, &p| hull.union(&Aabb::new(p, p)));
        let local = match self.patch {
            Patch::Parallelogram { corner, edges: [a, b], .. } => {
                let corners = [corner, corner + a, corner + b, corner + a + b];
                return hull(&corners.map(|p| self.world_from_object.transform_point3(p)));
            }
            Patch::Triangle { corner, edges: [a, b], .. } => {
                return hull(&[corner, corner + a, corner + b].map(|p| self.world_from_object.transform_point3(p)));
            }
            Patch::Disc { z, radius, .. } => Aabb::new(DVec3::new(-radius, -radius, z), DVec3::new(radius, radius, z)),
            Patch::Plane { .. } => Aabb::EVERYTHING,
            Patch::Sphere { radius } => Aabb::new(DVec3::splat(-radius), DVec3::splat(radius)),
            Patch::Tube { radius, height } => {
                Aabb::new(DVec3::new(-radius, -radius, 0.0), DVec3::new(radius, radius, height))
            }
        };
        local.transformed(&self.world_from_object)
    }
}

/// The factor of a map that keeps shapes.
fn similarity(map: &DAffine3) -> Option<f64> {
    let m = map.matrix3;
    let lengths = [m.x_axis.length(), m.y_axis.length(), m.z_axis.length()];
    let skew = m.x_axis.dot(m.y_axis).abs().max(m.y_axis.dot(m.z_axis).abs()).max(m.z_axis.dot(m.x_axis).abs());
    let even = lengths.iter().all(|l| (l - lengths[0]).abs() < 1e-9 * lengths[0]);
    (even && skew < 1e-9 * lengths[0] * lengths[0]).then_some(lengths[0])
}

/// One of the two directions of a line, the same for both.
fn unsigned(n: DVec3) -> DVec3 {
    let leading = n.to_array().into_iter().find(|x| x.abs() > 1e-6).unwrap_or(1.0);
    if leading < 0.0 { -n } else { n }
}

fn solid_patch(shape: &Shape, n: usize) -> Option<Patch> {
    match *shape {
        Shape::Sphere { radius } if n == 0 => Some(Patch::Sphere { radius }),
        Shape::Box { min, max } if n < 6 => {
            let axis = n / 2;
            let size = max - min;
            let units = [DVec3::X, DVec3::Y, DVec3::Z];
            let [a, b] = [(axis + 1) % 3, (axis + 2) % 3].map(|i| units[i] * size[i]);
            let high = n % 2 == 1;
            let corner = if high { min + units[axis] * size[axis] } else { min };
            let normal = if high { units[axis] } else { -units[axis] };
            Some(Patch::Parallelogram { corner, edges: [a, b], normal })
        }
        Shape::Cylinder { radius, height } => match n {
            0 => Some(Patch::Disc { z: 0.0, radius, normal: -DVec3::Z }),
            1 => Some(Patch::Disc { z: height, radius, normal: DVec3::Z }),
            2 => Some(Patch::Tube { radius, height }),
            _ => None,
        },
        Shape::Cone { base_radius, top_radius, height } => {
            let discs = [(0.0, base_radius, -DVec3::Z), (height, top_radius, DVec3::Z)];
            let (z, radius, normal) = *discs.iter().filter(|disc| disc.1 > 0.0).nth(n)?;
            Some(Patch::Disc { z, radius, normal })
        }
        Shape::HalfSpace if n == 0 => Some(Patch::Plane { normal: DVec3::Z }),
        _ => None,
    }
}

fn surface_patch(surface: &Surface, n: usize) -> Option<Patch> {
    match surface {
        Surface::Triangle([a, b, c]) if n == 0 => Some(triangle(*a, *b, *c)),
        // A planar quadrilateral is two triangles.
        Surface::Quad([a, b, c, d]) if n < 2 => Some(if n == 0 { triangle(*a, *b, *c) } else { triangle(*a, *c, *d) }),
        Surface::Rectangle { width, depth } if n == 0 => Some(Patch::Parallelogram {
            corner: DVec3::new(-0.5 * width, -0.5 * depth, 0.0),
            edges: [DVec3::X * *width, DVec3::Y * *depth],
            normal: DVec3::Z,
        }),
        Surface::Disk { radius } if n == 0 => Some(Patch::Disc { z: 0.0, radius: *radius, normal: DVec3::Z }),
        Surface::Plane if n == 0 => Some(Patch::Plane { normal: DVec3::Z }),
        _ => None,
    }
}

fn triangle(a: DVec3, b: DVec3, c: DVec3) -> Patch {
    let edges = [b - a, c - a];
    Patch::Triangle { corner: a, edges, normal: edges[0].cross(edges[1]) }
}
