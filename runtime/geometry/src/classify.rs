//! A placed shape against a box: certainly outside, certainly inside, or neither.
//!
//! Conservative: `Boundary` may be said too often (slow), the other two never wrongly (loses surface). The box becomes
//! a parallelepiped in object space, centre `c` and half edges `e`; separating directions are found by projecting the
//! shape's centre onto it (coordinate descent), and any direction at all gives a valid proof.

use glam::{DVec2, DVec3};

use crate::region::Region;
use crate::{Aabb, ClosedMesh, Direct, Placed, Shape};

/// How a box lies to a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Classification {
    Outside,
    Inside,
    Boundary,
}

impl Placed {
    /// Where all of the box lies.
    pub fn classify(&self, cell: &Aabb) -> Classification {
        if cell.is_empty() || !self.bounds().overlaps(cell) {
            return Classification::Outside;
        }
        if !cell.is_finite() {
            return Classification::Boundary;
        }
        if let Some(direct) = self.direct() {
            return classify_direct(direct, cell);
        }
        if let Shape::Mesh(mesh) = self.shape() {
            return self.classify_mesh(mesh, cell);
        }
        let region = Region::new(self, cell);
        match self.shape() {
            &Shape::Torus { major, minor } => return region.classify_torus(major, minor),
            Shape::Paraboloid(paraboloid) => return paraboloid.classify(&region),
            Shape::Hyperboloid(hyperboloid) => return hyperboloid.classify(&region),
            Shape::Polyhedron(polyhedron) => return polyhedron.classify(&region),
            Shape::Prism(prism) => return prism.classify(&region),
            Shape::Lathe(lathe) => return lathe.classify(&region),
            Shape::Superquadric(superquadric) => return superquadric.classify(&region),
            _ => {}
        }
        if region.outside(self.shape()) {
            Classification::Outside
        } else if region.inside(self.shape()) {
            Classification::Inside
        } else {
            Classification::Boundary
        }
    }
}

impl Placed {
    /// All on one side unless a triangle reaches into the box.
    fn classify_mesh(&self, mesh: &ClosedMesh, cell: &Aabb) -> Classification {
        if mesh.reaches(self.world_from_object(), cell) {
            Classification::Boundary
        } else if self.contains(cell.center()) {
            Classification::Inside
        } else {
            Classification::Outside
        }
    }
}

/// The cases without a map, exact up to rounding.
fn classify_direct(direct: &Direct, cell: &Aabb) -> Classification {
    let (outside, inside) = match *direct {
        Direct::Ball { center, radius } => {
            let nearest = center.clamp(cell.min, cell.max).distance_squared(center);
            let farthest = (center - cell.min).abs().max((center - cell.max).abs()).length_squared();
            (nearest > radius * radius, farthest <= radius * radius)
        }
        Direct::Box { min, max } => {
            let solid = Aabb::new(min, max);
            (!solid.overlaps(cell), solid.contains_box(cell))
        }
        Direct::HalfSpace { normal, offset } => {
            let middle = normal.dot(cell.center()) + offset;
            let reach = normal.abs().dot(cell.extent()) * 0.5;
            (middle > reach, middle <= -reach)
        }
    };
    match (outside, inside) {
        (true, _) => Classification::Outside,
        (_, true) => Classification::Inside,
        _ => Classification::Boundary,
    }
}

impl Region {
    fn outside(&self, shape: &Shape) -> bool {
        match *shape {
            Shape::Sphere { radius } => self.distance(DVec3::ZERO) > radius,
            Shape::Box { min, max } => self.misses_box(min, max),
            Shape::InfiniteCylinder { radius } => self.axis_distance().0 > radius,
            Shape::Cylinder { radius, height } => {
                self.beyond_slab(0.0, height) || self.axis_distance().0 > radius || self.above_rim(radius, 0.0, height)
            }
            Shape::Cone { base_radius, top_radius, height } => self.misses_cone(base_radius, top_radius, height),
            Shape::HalfSpace => self.z_range().0 > 0.0,
            // They are classified by themselves.
            Shape::Torus { .. }
            | Shape::Paraboloid(_)
            | Shape::Hyperboloid(_)
            | Shape::Polyhedron(_)
            | Shape::Prism(_)
            | Shape::Superquadric(_)
            | Shape::Lathe(_)
            | Shape::Mesh(_) => false,
        }
    }

    /// Separated from an upright cylinder by a direction across its rim: that to the nearest point from the middle
    /// of the part of the axis beside the region.
    fn above_rim(&self, radius: f64, low: f64, high: f64) -> bool {
        let foot = DVec3::new(0.0, 0.0, self.c.z.clamp(low, high));
        let Some(n) = self.nearest(foot, false).try_normalize() else { return false };
        let support = radius * n.truncate().length() + (n.z * low).max(n.z * high);
        self.c.dot(n) - self.reach(n) > support
    }

    fn misses_cone(&self, base: f64, top: f64, height: f64) -> bool {
        if self.beyond_slab(0.0, height) {
            return true;
        }
        let slope = (top - base) / height;
        let (z0, z1) = self.z_range();
        let widest = (base + slope * z0.clamp(0.0, height)).max(base + slope * z1.clamp(0.0, height));
        let (distance, n) = self.axis_distance();
        if distance > widest {
            return true;
        }
        // The tangent plane on the region's side: n · p <= base + slope z for all points of the cone.
        let n = DVec3::new(n.x, n.y, -slope);
        self.c.dot(n) - self.reach(n) > base
    }

    /// By the distance of the centre where that decides: most boxes are either far or have the surface near their middle.
    fn classify_torus(&self, major: f64, minor: f64) -> Classification {
        let (distance, reach) = (self.tube_distance(major), self.half_diagonal());
        if distance - reach > minor || self.beyond_slab(-minor, minor) {
            return Classification::Outside;
        }
        if distance + reach <= minor {
            return Classification::Inside;
        }
        if (distance - minor).abs() < self.inner_radius() {
            return Classification::Boundary;
        }
        let (rho, z) = (self.rho_range(), self.z_range());
        let gap = DVec2::new((rho.0 - major).max(major - rho.1).max(0.0), z.0.max(-z.1).max(0.0));
        let far = DVec2::new((rho.1 - major).max(major - rho.0), z.1.max(-z.0));
        if gap.length() > minor {
            Classification::Outside
        } else if far.length() <= minor {
            Classification::Inside
        } else {
            Classification::Boundary
        }
    }

    /// Distance of the centre from the tube's centre circle: 1-Lipschitz.
    fn tube_distance(&self, major: f64) -> f64 {
        (self.c.truncate().length() - major).hypot(self.c.z)
    }

    /// Separating axes of two parallelepipeds: both sets of face normals and the edge products.
    fn misses_box(&self, min: DVec3, max: DVec3) -> bool {
        let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
        let offset = self.c - center;
        let separates = |n: DVec3| offset.dot(n).abs() > self.reach(n) + half.dot(n.abs());
        let [a, b, c] = self.e;
        let units = [DVec3::X, DVec3::Y, DVec3::Z];
        units.iter().any(|&n| separates(n))
            || [a.cross(b), b.cross(c), c.cross(a)].into_iter().any(separates)
            || self.e.iter().any(|e| units.iter().any(|u| separates(e.cross(*u))))
    }

    /// Convex shapes hold the region when they hold its corners.
    fn inside(&self, shape: &Shape) -> bool {
        self.corners().all(|p| shape.contains(p))
    }
}
