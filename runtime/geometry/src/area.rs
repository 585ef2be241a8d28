//! Surface area of placed shapes, and points uniform over it in object space.
//!
//! A sheared shape is sampled uniformly in object space (a superquadric nearly so) and carries the density of the world:
//! `pdf_area` is that of object space, divided by the stretch of the area element, |det M| |M⁻ᵀ n|.

use glam::DVec3;

use crate::area_table::AreaTable;
use crate::{Placed, Shape, SurfacePoint, TriangleMesh, closed_mesh::fold, cone, cuboid, sphere, torus};

/// A point chosen on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaPoint {
    pub point: SurfacePoint,
    pub face: u32,
    /// Density per unit of world area.
    pub pdf_area: f64,
}

impl Shape {
    /// Number of faces; numbers from 0. The face may be empty.
    pub fn face_count(&self) -> u32 {
        match self {
            Shape::Sphere { .. } | Shape::Torus { .. } | Shape::HalfSpace | Shape::InfiniteCylinder { .. } => 1,
            Shape::Superquadric(_) => 1,
            Shape::Lathe(lathe) => lathe.areas().len() as u32,
            Shape::Box { .. } => 6,
            Shape::Cylinder { .. } | Shape::Cone { .. } | Shape::Paraboloid(_) | Shape::Hyperboloid(_) => 3,
            Shape::Mesh(mesh) => mesh.mesh().triangles.len() as u32,
            Shape::Polyhedron(polyhedron) => polyhedron.areas().len() as u32,
            Shape::Prism(prism) => prism.areas().len() as u32,
        }
    }

    /// Area of a face in object space; infinite for unbounded shapes.
    pub fn face_area(&self, face: u32) -> f64 {
        let face = face as usize;
        match *self {
            Shape::Sphere { radius } => 4.0 * std::f64::consts::PI * radius * radius,
            Shape::Box { min, max } => cuboid::areas(min, max)[face],
            Shape::Cylinder { radius, height } => cone::areas(radius, radius, height)[face],
            Shape::Cone { base_radius, top_radius, height } => cone::areas(base_radius, top_radius, height)[face],
            Shape::Torus { major, minor } => torus::area(major, minor),
            Shape::InfiniteCylinder { .. } | Shape::HalfSpace => f64::INFINITY,
            Shape::Paraboloid(ref paraboloid) => paraboloid.areas()[face],
            Shape::Hyperboloid(ref hyperboloid) => hyperboloid.areas()[face],
            Shape::Mesh(ref mesh) => 0.5 * mesh.mesh().cross(face).length(),
            Shape::Polyhedron(ref polyhedron) => polyhedron.areas().area(face),
            Shape::Prism(ref prism) => prism.areas().area(face),
            Shape::Lathe(ref lathe) => lathe.areas().area(face),
            Shape::Superquadric(ref superquadric) => superquadric.area(),
        }
    }

    /// Areas of shapes that may have many faces.
    fn area_table(&self) -> Option<&AreaTable> {
        match self {
            Shape::Prism(prism) => Some(prism.areas()),
            Shape::Lathe(lathe) => Some(lathe.areas()),
            Shape::Polyhedron(polyhedron) => Some(polyhedron.areas()),
            _ => None,
        }
    }

    /// Surface area in object space; infinite for unbounded shapes.
    pub fn area(&self) -> f64 {
        match (self, self.area_table()) {
            (_, Some(table)) => table.total(),
            (Shape::Mesh(mesh), None) => mesh.area(),
            _ => (0..self.face_count()).map(|face| self.face_area(face)).sum(),
        }
    }

    /// A face chosen in proportion to area, and what is left of `u`, uniform again.
    fn choose_face(&self, u: f64) -> (u32, f64) {
        if let Some(table) = self.area_table() {
            let (face, rest) = table.choose(u);
            return (face as u32, rest);
        }
        let last = self.face_count() - 1;
        let mut rest = u * self.area();
        let mut face = 0;
        let mut area = self.face_area(0);
        while face < last && rest >= area {
            rest -= area;
            face += 1;
            area = self.face_area(face);
        }
        (face, if area > 0.0 { (rest / area).clamp(0.0, 1.0) } else { 0.0 })
    }

    /// A point uniform over a face; `None` for unbounded shapes. `u` in [0, 1)².
    fn sample_face(&self, face: u32, u: [f64; 2]) -> Option<DVec3> {
        Some(match *self {
            Shape::Sphere { radius } => sphere::sample(radius, u),
            Shape::Box { min, max } => cuboid::sample(min, max, face, u),
            Shape::Cylinder { radius, height } => cone::sample(radius, radius, height, face, u),
            Shape::Cone { base_radius, top_radius, height } => cone::sample(base_radius, top_radius, height, face, u),
            Shape::Torus { major, minor } => torus::sample(major, minor, u),
            Shape::InfiniteCylinder { .. } | Shape::HalfSpace => return None,
            Shape::Paraboloid(ref paraboloid) => paraboloid.sample(face, u),
            Shape::Hyperboloid(ref hyperboloid) => hyperboloid.sample(face, u),
            Shape::Mesh(ref mesh) => mesh.mesh().surface(face as usize, fold(u)).p,
            Shape::Polyhedron(ref polyhedron) => polyhedron.sample(face, u),
            Shape::Prism(ref prism) => prism.sample(face, u),
            Shape::Lathe(ref lathe) => lathe.sample(face, u),
            Shape::Superquadric(ref superquadric) => superquadric.sample(u),
        })
    }

    /// A point uniform over the surface, with its face; `None` for unbounded shapes. `u` in [0, 1)².
    fn sample(&self, u: [f64; 2]) -> Option<(DVec3, u32)> {
        if !self.is_bounded() {
            return None;
        }
        if let Shape::Mesh(mesh) = self {
            return Some(mesh.sample(u));
        }
        let (face, rest) = self.choose_face(u[0]);
        self.sample_face(face, [rest, u[1]]).map(|p| (p, face))
    }
}

impl Placed {
    /// A point of the surface; `None` for unbounded shapes. `u` in [0, 1)².
    pub fn sample_area(&self, u: [f64; 2]) -> Option<AreaPoint> {
        let (p, face) = self.shape().sample(u)?;
        let point = self.surface(self.world_from_object().transform_point3(p), face);
        Some(AreaPoint { point, face, pdf_area: self.pdf_area(point.p, point.n) })
    }

    /// A point uniform over some of the faces in object space; `None` for unbounded shapes and for faces without area.
    pub fn sample_faces(&self, faces: &[u32], u: [f64; 2]) -> Option<AreaPoint> {
        let areas = AreaTable::new(faces.iter().map(|&face| self.shape().face_area(face)));
        if !(areas.total() > 0.0 && areas.total().is_finite()) {
            return None;
        }
        let (i, rest) = areas.choose(u[0]);
        let face = faces[i];
        let p = self.shape().sample_face(face, [rest, u[1]])?;
        let point = self.surface(self.world_from_object().transform_point3(p), face);
        Some(AreaPoint { point, face, pdf_area: self.pdf_faces(faces, point.n) })
    }

    /// Density with which [`Placed::sample_faces`] gives a point of these faces with its outward or inward unit normal.
    pub fn pdf_faces(&self, faces: &[u32], world_normal: DVec3) -> f64 {
        let area: f64 = faces.iter().map(|&face| self.shape().face_area(face)).sum();
        1.0 / (area * self.area_scale(world_normal))
    }

    /// Density with which [`Placed::sample_area`] gives a surface point with its outward or inward unit normal; zero
    /// for unbounded shapes.
    pub fn pdf_area(&self, p: DVec3, world_normal: DVec3) -> f64 {
        let density = match self.shape() {
            Shape::Superquadric(superquadric) => superquadric.density(self.object_from_world().transform_point3(p)),
            shape => 1.0 / shape.area(),
        };
        density / self.area_scale(world_normal)
    }

    /// Surface area in the world; infinite for unbounded shapes. Exact for flat faces; else by quadrature over about ten
    /// thousand points, exact for similarities, and to a thousandth under maps that stretch tenfold.
    pub fn area(&self) -> f64 {
        let shape = self.shape();
        if !shape.is_bounded() {
            return f64::INFINITY;
        }
        let scale = |p: DVec3, face: u32| self.area_scale(self.world_normal(shape.surface(p, face).n));
        match shape {
            Shape::Mesh(mesh) => self.mesh_area(mesh.mesh()),
            Shape::Superquadric(superquadric) => {
                superquadric.pieces().into_iter().map(|(p, area)| area * scale(p, 0)).sum()
            }
            _ => (0..shape.face_count()).map(|face| shape.face_area(face) * self.mean_over(face, &scale)).sum(),
        }
    }

    /// The mean of a function over a face in object space.
    fn mean_over(&self, face: u32, value: &impl Fn(DVec3, u32) -> f64) -> f64 {
        const POINTS: u32 = 10_000;
        if matches!(self.shape(), Shape::Box { .. } | Shape::Prism(_) | Shape::Polyhedron(_)) {
            // Any point will do: the face is flat.
            return value(DVec3::ZERO, face);
        }
        let strata = (POINTS / self.shape().face_count()).isqrt().max(8);
        let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(strata);
        let places = (0..strata).flat_map(|i| (0..strata).map(move |j| [middle(i), middle(j)]));
        let points = places.filter_map(|u| self.shape().sample_face(face, u));
        points.map(|p| value(p, face)).sum::<f64>() / f64::from(strata * strata)
    }

    fn mesh_area(&self, mesh: &TriangleMesh) -> f64 {
        let half_cross = |triangle: usize| {
            let [a, b, c] = mesh.corners(triangle).map(|p| self.world_from_object().transform_vector3(p));
            0.5 * (b - a).cross(c - a).length()
        };
        (0..mesh.triangles.len()).map(half_cross).sum()
    }
}
