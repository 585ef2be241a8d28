//! The solid shapes in their canonical placement.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::{
    Aabb, ClosedMesh, Crossings, Hyperboloid, Lathe, Paraboloid, Polyhedron, Prism, Superquadric, cone, cuboid,
    half_space, sphere, torus,
};

/// A closed solid in object space. Sizes are positive and finite; the compiler guarantees it.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Centre at the origin.
    Sphere {
        radius: f64,
    },
    /// Axis-aligned, `min < max` in every axis.
    Box {
        min: DVec3,
        max: DVec3,
    },
    /// About the z axis, from z = 0 to z = `height`.
    Cylinder {
        radius: f64,
        height: f64,
    },
    /// About the z axis, unbounded.
    InfiniteCylinder {
        radius: f64,
    },
    /// About the z axis, radius `base_radius` at z = 0 and `top_radius` at z = `height`; at most one is zero.
    Cone {
        base_radius: f64,
        top_radius: f64,
        height: f64,
    },
    /// About the z axis, centre circle of radius `major` in the plane z = 0, tube radius `minor`
    /// (ring, horn and spindle; a spindle torus is the union, its lens included).
    Torus {
        major: f64,
        minor: f64,
    },
    /// z <= 0.
    HalfSpace,
    Paraboloid(Paraboloid),
    Hyperboloid(Hyperboloid),
    /// A profile turned about the z axis.
    Lathe(Arc<Lathe>),
    /// A superellipsoid with unit half axes.
    Superquadric(Arc<Superquadric>),
    /// What a closed triangle mesh bounds.
    Mesh(Arc<ClosedMesh>),
    /// The convex hull of points.
    Polyhedron(Arc<Polyhedron>),
    /// A polygon, extruded.
    Prism(Arc<Prism>),
}

/// A point on a shape's surface with its frame, in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalPoint {
    /// On the surface to rounding.
    pub p: DVec3,
    /// Outward unit normal.
    pub n: DVec3,
    pub uv: DVec2,
    /// Direction of growing u; not normalised, tangent.
    pub dpdu: DVec3,
}

impl Shape {
    /// Every size is positive and finite as the variants demand.
    pub fn is_valid(&self) -> bool {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        match *self {
            Shape::Sphere { radius } | Shape::InfiniteCylinder { radius } => positive(radius),
            Shape::Box { min, max } => min.is_finite() && max.is_finite() && min.cmplt(max).all(),
            Shape::Cylinder { radius, height } => positive(radius) && positive(height),
            Shape::Cone { base_radius, top_radius, height } => {
                let radii = base_radius >= 0.0 && top_radius >= 0.0 && positive(base_radius + top_radius);
                radii && positive(height)
            }
            Shape::Torus { major, minor } => positive(major) && positive(minor),
            Shape::HalfSpace | Shape::Mesh(_) => true,
            Shape::Paraboloid(ref paraboloid) => paraboloid.is_valid(),
            Shape::Hyperboloid(ref hyperboloid) => hyperboloid.is_valid(),
            Shape::Polyhedron(_) | Shape::Prism(_) | Shape::Superquadric(_) | Shape::Lathe(_) => true,
        }
    }

    /// Every number that the shape is made of (but for meshes), in a fixed order: equal shapes of one kind have equal numbers.
    pub fn for_each_size(&self, visit: &mut dyn FnMut(f64)) {
        let sizes: &[f64] = match self {
            Shape::Sphere { radius } | Shape::InfiniteCylinder { radius } => &[*radius],
            Shape::Box { min, max } => &[min.x, min.y, min.z, max.x, max.y, max.z],
            Shape::Cylinder { radius, height } => &[*radius, *height],
            Shape::Cone { base_radius, top_radius, height } => &[*base_radius, *top_radius, *height],
            Shape::Torus { major, minor } => &[*major, *minor],
            Shape::HalfSpace | Shape::Mesh(_) => &[],
            Shape::Paraboloid(Paraboloid { radius, height }) => &[*radius, *height],
            Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets }) => {
                &[*radius, *slope, *half_height, f64::from(u8::from(*two_sheets))]
            }
            Shape::Polyhedron(polyhedron) => {
                return polyhedron.points().iter().flat_map(DVec3::to_array).for_each(visit);
            }
            Shape::Superquadric(superquadric) => &superquadric.exponents(),
            Shape::Lathe(lathe) => {
                visit(f64::from(2 * u8::from(lathe.is_closed()) + u8::from(lathe.is_smooth())));
                return lathe.points().iter().flat_map(DVec2::to_array).for_each(visit);
            }
            Shape::Prism(prism) => {
                visit(prism.height());
                return prism.polygon().rings().iter().flatten().flat_map(DVec2::to_array).for_each(visit);
            }
        };
        sizes.iter().for_each(|&x| visit(x));
    }

    /// Membership in the closed solid.
    pub fn contains(&self, p: DVec3) -> bool {
        let ring = || p.truncate().length();
        match *self {
            Shape::Sphere { radius } => p.length() <= radius,
            Shape::Box { min, max } => Aabb::new(min, max).contains(p),
            Shape::Cylinder { radius, height } => (0.0..=height).contains(&p.z) && ring() <= radius,
            Shape::InfiniteCylinder { radius } => ring() <= radius,
            Shape::Cone { base_radius, top_radius, height } => {
                (0.0..=height).contains(&p.z) && ring() <= base_radius + (top_radius - base_radius) * (p.z / height)
            }
            Shape::Torus { major, minor } => (ring() - major).hypot(p.z) <= minor,
            Shape::HalfSpace => p.z <= 0.0,
            Shape::Paraboloid(ref paraboloid) => paraboloid.contains(p),
            Shape::Hyperboloid(ref hyperboloid) => hyperboloid.contains(p),
            Shape::Mesh(ref mesh) => mesh.contains(p),
            Shape::Polyhedron(ref polyhedron) => polyhedron.contains(p),
            Shape::Prism(ref prism) => prism.contains(p),
            Shape::Lathe(ref lathe) => lathe.contains(p),
            Shape::Superquadric(ref superquadric) => superquadric.contains(p),
        }
    }

    /// Whether the ball of this radius about `p` is inside or outside; `None` where the surface may be in it, and for shapes
    /// whose crossings do not cost more than that.
    #[inline]
    pub fn state_around(&self, p: DVec3, radius: f64) -> Option<bool> {
        match *self {
            Shape::Torus { major, minor } => torus::state_around(major, minor, p, radius),
            _ => None,
        }
    }

    /// Tight box in object space; infinite where the shape is.
    pub fn bounds(&self) -> Aabb {
        let inf = f64::INFINITY;
        match *self {
            Shape::Sphere { radius } => Aabb::new(DVec3::splat(-radius), DVec3::splat(radius)),
            Shape::Box { min, max } => Aabb::new(min, max),
            Shape::Cylinder { radius, height } => upright(radius, 0.0, height),
            Shape::InfiniteCylinder { radius } => upright(radius, -inf, inf),
            Shape::Cone { base_radius, top_radius, height } => upright(base_radius.max(top_radius), 0.0, height),
            Shape::Torus { major, minor } => upright(major + minor, -minor, minor),
            Shape::HalfSpace => Aabb::new(DVec3::NEG_INFINITY, DVec3::new(inf, inf, 0.0)),
            Shape::Paraboloid(ref paraboloid) => paraboloid.bounds(),
            Shape::Hyperboloid(ref hyperboloid) => hyperboloid.bounds(),
            Shape::Mesh(ref mesh) => *mesh.bounds(),
            Shape::Polyhedron(ref polyhedron) => polyhedron.bounds(),
            Shape::Prism(ref prism) => prism.bounds(),
            Shape::Lathe(ref lathe) => lathe.bounds(),
            Shape::Superquadric(ref superquadric) => superquadric.bounds(),
        }
    }

    /// The shape is finite.
    pub fn is_bounded(&self) -> bool {
        !matches!(self, Shape::InfiniteCylinder { .. } | Shape::HalfSpace)
    }

    /// Length that rounding errors of its own scale with.
    pub fn magnitude(&self) -> f64 {
        match *self {
            Shape::Sphere { radius } | Shape::InfiniteCylinder { radius } => radius,
            Shape::Box { min, max } => min.abs().max(max.abs()).max_element(),
            Shape::Cylinder { radius, height } => radius.max(height),
            Shape::Cone { base_radius, top_radius, height } => base_radius.max(top_radius).max(height),
            Shape::Torus { major, minor } => major + minor,
            Shape::HalfSpace => 0.0,
            Shape::Paraboloid(ref paraboloid) => paraboloid.radius.max(paraboloid.height),
            Shape::Hyperboloid(ref hyperboloid) => hyperboloid.magnitude(),
            Shape::Mesh(ref mesh) => mesh.magnitude(),
            Shape::Polyhedron(ref polyhedron) => largest(&polyhedron.bounds()),
            Shape::Prism(ref prism) => largest(&prism.bounds()),
            Shape::Lathe(ref lathe) => largest(&lathe.bounds()),
            Shape::Superquadric(_) => 1.0,
        }
    }

    /// Crossings of the line `origin + t dir` in object space; `dir` need not be unit, but finite and not zero.
    ///
    /// With `B = K · 2⁻⁵³ · (|origin| + magnitude + |t dir|)` what is found holds all of the line inside of the shape shrunk by B
    /// and nothing outside of the shape grown by B: every crossing is within B of the surface, and no chord deeper than B is
    /// missed. K is 8, and 8 + major / minor for a torus (`tests/oracle.rs`).
    pub fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        match *self {
            Shape::Sphere { radius } => sphere::crossings(radius, origin, dir),
            Shape::Box { min, max } => cuboid::crossings(min, max, origin, dir),
            Shape::Cylinder { radius, height } => cone::cylinder_crossings(radius, height, origin, dir),
            Shape::InfiniteCylinder { radius } => cone::infinite_cylinder_crossings(radius, origin, dir),
            Shape::Cone { base_radius, top_radius, height } => {
                unit(dir, |d| cone::cone_crossings(base_radius, top_radius, height, origin, d))
            }
            Shape::Torus { major, minor } => unit(dir, |d| torus::crossings(major, minor, origin, d)),
            Shape::HalfSpace => half_space::crossings(origin, dir),
            Shape::Paraboloid(ref paraboloid) => unit(dir, |d| paraboloid.crossings(origin, d)),
            Shape::Hyperboloid(ref hyperboloid) => unit(dir, |d| hyperboloid.crossings(origin, d)),
            Shape::Mesh(ref mesh) => mesh.crossings(origin, dir),
            Shape::Polyhedron(ref polyhedron) => polyhedron.crossings(origin, dir),
            Shape::Prism(ref prism) => prism.crossings(origin, dir),
            Shape::Lathe(ref lathe) => unit(dir, |d| lathe.crossings(origin, d)),
            Shape::Superquadric(ref superquadric) => unit(dir, |d| superquadric.crossings(origin, d)),
        }
    }

    /// The surface point nearest to `p` (which lies close to that face) with its frame.
    pub fn surface(&self, p: DVec3, face: u32) -> LocalPoint {
        match *self {
            Shape::Sphere { radius } => sphere::surface(radius, p),
            Shape::Box { min, max } => cuboid::surface(min, max, p, face),
            Shape::Cylinder { radius, height } => cone::surface(radius, radius, height, p, face),
            Shape::InfiniteCylinder { radius } => cone::surface(radius, radius, f64::INFINITY, p, face),
            Shape::Cone { base_radius, top_radius, height } => cone::surface(base_radius, top_radius, height, p, face),
            Shape::Torus { major, minor } => torus::surface(major, minor, p),
            Shape::HalfSpace => half_space::surface(p),
            Shape::Paraboloid(ref paraboloid) => paraboloid.surface(p, face),
            Shape::Hyperboloid(ref hyperboloid) => hyperboloid.surface(p, face),
            Shape::Polyhedron(ref polyhedron) => polyhedron.surface(p, face),
            Shape::Prism(ref prism) => prism.surface(p, face),
            Shape::Lathe(ref lathe) => lathe.surface(p, face),
            Shape::Superquadric(ref superquadric) => superquadric.surface(p),
            Shape::Mesh(ref mesh) => mesh.surface(p, face),
        }
    }

    /// The interpolated normal of a face near `p`, unit, on the outer side; `None` where it is the surface's own.
    pub fn shading_normal(&self, p: DVec3, face: u32) -> Option<DVec3> {
        match self {
            Shape::Mesh(mesh) => mesh.shading_normal(p, face),
            _ => None,
        }
    }
}

/// Solves along the normalised direction and restores the parameter.
fn unit(dir: DVec3, solve: impl FnOnce(DVec3) -> Crossings) -> Crossings {
    let length = dir.length();
    solve(dir / length).remapped(0.0, 1.0 / length)
}

fn upright(radius: f64, low: f64, high: f64) -> Aabb {
    Aabb::new(DVec3::new(-radius, -radius, low), DVec3::new(radius, radius, high))
}

fn largest(bounds: &Aabb) -> f64 {
    bounds.min.abs().max(bounds.max.abs()).max_element()
}
