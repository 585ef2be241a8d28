//! Surface area of placed shapes, and points uniform over it in object space.
//!
//! A sheared shape is sampled uniformly in object space and carries the density of the world: `pdf_area` is one over the
//! object area, divided by the stretch of the area element, |det M| |M⁻ᵀ n|.

use glam::DVec3;

use crate::{Placed, Shape, SurfacePoint, cone, cuboid, sphere, torus};

/// A point chosen on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaPoint {
    pub point: SurfacePoint,
    pub face: u32,
    /// Density per unit of world area.
    pub pdf_area: f64,
}

impl Shape {
    /// Areas of the faces in object space; empty for unbounded shapes.
    fn face_areas(&self) -> ([f64; 6], usize) {
        let mut areas = [0.0; 6];
        let count = match *self {
            Shape::Sphere { radius } => {
                areas[0] = 4.0 * std::f64::consts::PI * radius * radius;
                1
            }
            Shape::Box { min, max } => {
                areas = cuboid::areas(min, max);
                6
            }
            Shape::Cylinder { radius, height } => {
                areas[..3].copy_from_slice(&cone::areas(radius, radius, height));
                3
            }
            Shape::Cone { base_radius, top_radius, height } => {
                areas[..3].copy_from_slice(&cone::areas(base_radius, top_radius, height));
                3
            }
            Shape::Torus { major, minor } => {
                areas[0] = torus::area(major, minor);
                1
            }
            Shape::InfiniteCylinder { .. } | Shape::HalfSpace => 0,
        };
        (areas, count)
    }

    /// Surface area in object space; infinite for unbounded shapes.
    pub fn area(&self) -> f64 {
        match self.face_areas() {
            (_, 0) => f64::INFINITY,
            (areas, count) => areas[..count].iter().sum(),
        }
    }

    /// A point uniform over the surface, with its face; `None` for unbounded shapes. `u` in [0, 1)².
    fn sample(&self, u: [f64; 2]) -> Option<(DVec3, u32)> {
        let (areas, count) = self.face_areas();
        let total: f64 = areas[..count].iter().sum();
        let mut rest = u[0] * total;
        let mut face = 0;
        while face + 1 < count && rest >= areas[face] {
            rest -= areas[face];
            face += 1;
        }
        // What is left of the choice of the face is uniform again.
        let inner = if count > 0 && areas[face] > 0.0 { (rest / areas[face]).clamp(0.0, 1.0) } else { 0.0 };
        let u = [inner, u[1]];
        let face = face as u32;
        let p = match *self {
            Shape::Sphere { radius } => sphere::sample(radius, u),
            Shape::Box { min, max } => cuboid::sample(min, max, face, u),
            Shape::Cylinder { radius, height } => cone::sample(radius, radius, height, face, u),
            Shape::Cone { base_radius, top_radius, height } => cone::sample(base_radius, top_radius, height, face, u),
            Shape::Torus { major, minor } => torus::sample(major, minor, u),
            Shape::InfiniteCylinder { .. } | Shape::HalfSpace => return None,
        };
        Some((p, face))
    }
}

impl Placed {
    /// A point of the surface; `None` for unbounded shapes. `u` in [0, 1)².
    pub fn sample_area(&self, u: [f64; 2]) -> Option<AreaPoint> {
        let (p, face) = self.shape().sample(u)?;
        let point = self.surface(self.world_from_object().transform_point3(p), face);
        Some(AreaPoint { point, face, pdf_area: self.pdf_area(point.n) })
    }

    /// Density with which [`Placed::sample_area`] gives a surface point with this outward or inward unit normal; zero
    /// for unbounded shapes.
    pub fn pdf_area(&self, world_normal: DVec3) -> f64 {
        1.0 / (self.shape().area() * self.area_scale(world_normal))
    }

    /// Surface area in the world, by stratified quadrature over object area (exact for similarities and boxes);
    /// infinite for unbounded shapes.
    pub fn area(&self) -> f64 {
        const STRATA: usize = 48;
        let object_area = self.shape().area();
        if object_area.is_infinite() {
            return object_area;
        }
        let middle = |i: usize| (i as f64 + 0.5) / STRATA as f64;
        let mut sum = 0.0;
        if let Shape::Box { min, max } = *self.shape() {
            for (face, area) in cuboid::areas(min, max).into_iter().enumerate() {
                sum += area * self.area_scale(self.world_normal(DVec3::AXES[face / 2]));
            }
            return sum;
        }
        for i in 0..STRATA {
            for j in 0..STRATA {
                if let Some((p, face)) = self.shape().sample([middle(i), middle(j)]) {
                    sum += self.area_scale(self.world_normal(self.shape().surface(p, face).n));
                }
            }
        }
        object_area * sum / (STRATA * STRATA) as f64
    }
}
