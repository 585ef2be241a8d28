//! A shape under an affine map.
//!
//! Normals go through the inverse transpose, so mirrored maps need no special case: outward stays outward. The
//! parameter of a ray keeps its meaning through the map because directions are not normalised on the way.
//!
//! Error bounds are a priori and linear: a position is wrong by at most `ROUNDINGS` units in the last place of the
//! numbers that it went through, on the way to object space and back (Higham 2002, section 3.1; Pharr, Jakob and
//! Humphreys 2023, section 6.8).

use glam::{DAffine3, DMat3, DVec2, DVec3};

use crate::{Aabb, Crossings, Shape, Span, cuboid};

/// Roundings granted to a position: two affine maps (five each), the projection onto the surface, the offset; doubled.
const ROUNDINGS: f64 = 32.0;

/// What a shape is in the world without its map: the common cases, which need no transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direct {
    /// A sphere under a similarity.
    Ball { center: DVec3, radius: f64 },
    /// A box under a translation and positive scale.
    Box { min: DVec3, max: DVec3 },
    /// z <= 0 with its unit normal: `normal · p + offset <= 0`.
    HalfSpace { normal: DVec3, offset: f64 },
}

impl Direct {
    fn new(shape: &Shape, map: &DAffine3, inverse: &DAffine3) -> Option<Direct> {
        let m = map.matrix3;
        match *shape {
            Shape::Sphere { radius } => {
                let square = m.x_axis.length_squared();
                let off = m.transpose() * m - DMat3::from_diagonal(DVec3::splat(square));
                let skew = off.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
                let similar = skew <= 8.0 * f64::EPSILON * square;
                similar.then(|| Direct::Ball { center: map.translation, radius: radius * square.sqrt() })
            }
            Shape::Box { min, max } => {
                let diagonal = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
                let upright = m == DMat3::from_diagonal(diagonal) && diagonal.min_element() > 0.0;
                upright.then(|| Direct::Box { min: map.transform_point3(min), max: map.transform_point3(max) })
            }
            Shape::HalfSpace => {
                let row = inverse.matrix3.transpose().z_axis;
                let length = row.length();
                Some(Direct::HalfSpace { normal: row / length, offset: inverse.translation.z / length })
            }
            _ => None,
        }
    }
}

/// A shape in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    shape: Shape,
    world_from_object: DAffine3,
    object_from_world: DAffine3,
    direct: Option<Direct>,
    bounds: Aabb,
    /// |det| of the map: volume ratio.
    volume_scale: f64,
    /// Error of a point per unit of its largest coordinate, and the constant beside it.
    error_slope: f64,
    error_floor: f64,
}

/// Why a shape cannot be placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceError {
    /// A size is not positive or not finite.
    InvalidShape,
    /// The map has no finite inverse.
    SingularMap,
}

impl std::fmt::Display for PlaceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            PlaceError::InvalidShape => "a size is not positive and finite",
            PlaceError::SingularMap => "the map has no finite inverse",
        })
    }
}

impl std::error::Error for PlaceError {}

/// A surface point with its frame, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    pub p: DVec3,
    /// Bound on the distance between `p` and the true surface.
    pub p_error: f64,
    /// Outward unit normal.
    pub n: DVec3,
    pub uv: DVec2,
    /// Unit direction of growing u, orthogonal to `n`.
    pub dpdu: DVec3,
}

impl Placed {
    pub fn new(shape: Shape, world_from_object: DAffine3) -> Result<Placed, PlaceError> {
        if !shape.is_valid() {
            return Err(PlaceError::InvalidShape);
        }
        let object_from_world = invert(&world_from_object).ok_or(PlaceError::SingularMap)?;
        let (out, back) = (norm(&world_from_object.matrix3), norm(&object_from_world.matrix3));
        let unit = ROUNDINGS * f64::EPSILON;
        let constant = object_from_world.translation.abs().max_element() + shape.magnitude();
        let placed = Placed {
            direct: Direct::new(&shape, &world_from_object, &object_from_world),
            bounds: bounds(&shape, &world_from_object, &object_from_world),
            shape,
            world_from_object,
            object_from_world,
            volume_scale: world_from_object.matrix3.determinant().abs(),
            error_slope: unit * out * back,
            error_floor: unit * out * constant,
        };
        let finite = (placed.error_slope + placed.error_floor).is_finite() && placed.volume_scale > 0.0;
        if finite { Ok(placed) } else { Err(PlaceError::SingularMap) }
    }

    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    pub fn world_from_object(&self) -> &DAffine3 {
        &self.world_from_object
    }

    pub fn object_from_world(&self) -> &DAffine3 {
        &self.object_from_world
    }

    /// The shape without a map, if that is possible.
    pub fn direct(&self) -> Option<&Direct> {
        self.direct.as_ref()
    }

    /// Tight box in the world, rounded outwards; infinite where the shape is.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    pub fn volume_scale(&self) -> f64 {
        self.volume_scale
    }

    /// Membership in the closed solid.
    pub fn contains(&self, p: DVec3) -> bool {
        self.shape.contains(self.object_from_world.transform_point3(p))
    }

    /// All crossings of the line, sorted; `dir` finite and not zero.
    pub fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        match self.direct {
            Some(Direct::Ball { center, radius }) => {
                return Span::of_ball(center, radius, origin, dir, 1.0 / dir.length_squared()).into();
            }
            Some(Direct::Box { min, max }) => return cuboid::crossings(min, max, origin, dir),
            Some(Direct::HalfSpace { .. }) | None => {}
        }
        let origin = self.object_from_world.transform_point3(origin);
        self.shape.crossings(origin, self.object_from_world.transform_vector3(dir))
    }

    /// The surface point at `p`, which lies on that face up to rounding: projected onto it, with its frame.
    pub fn surface(&self, p: DVec3, face: u32) -> SurfacePoint {
        let local = self.shape.surface(self.object_from_world.transform_point3(p), face);
        let p = self.world_from_object.transform_point3(local.p);
        let n = self.world_normal(local.n);
        let dpdu = self.world_from_object.transform_vector3(local.dpdu);
        let dpdu = (dpdu - n * n.dot(dpdu)).try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
        SurfacePoint { p, p_error: self.error_at(p), n, uv: local.uv, dpdu }
    }

    /// The interpolated normal of a face near `p`, unit, outward; `None` where it is the surface's own.
    #[inline]
    pub fn shading_normal(&self, p: DVec3, face: u32) -> Option<DVec3> {
        if !matches!(self.shape, Shape::Mesh(_)) {
            return None;
        }
        let local = self.shape.shading_normal(self.object_from_world.transform_point3(p), face)?;
        Some(self.world_normal(local))
    }

    /// Bound on the error of a surface point near `p`, in world units.
    pub fn error_at(&self, p: DVec3) -> f64 {
        self.error_slope * p.abs().max_element() + self.error_floor
    }

    pub(crate) fn world_normal(&self, n: DVec3) -> DVec3 {
        self.object_from_world.matrix3.transpose().mul_vec3(n).normalize()
    }

    /// Ratio of world area to object area at a surface element with this world normal.
    pub fn area_scale(&self, world_normal: DVec3) -> f64 {
        self.volume_scale / self.world_from_object.matrix3.transpose().mul_vec3(world_normal).length()
    }
}

/// The inverse, if it and the map are finite.
pub fn invert(map: &DAffine3) -> Option<DAffine3> {
    let inverse = map.matrix3.try_inverse()?;
    let result = DAffine3 { matrix3: inverse, translation: -(inverse * map.translation) };
    (map.is_finite() && result.is_finite()).then_some(result)
}

/// Row-sum norm: bounds how much the largest coordinate grows.
fn norm(m: &DMat3) -> f64 {
    (m.x_axis.abs() + m.y_axis.abs() + m.z_axis.abs()).max_element()
}

fn bounds(shape: &Shape, map: &DAffine3, inverse: &DAffine3) -> Aabb {
    let rows = map.matrix3.transpose();
    let mut hull = Aabb::EVERYTHING;
    for (axis, row) in [rows.x_axis, rows.y_axis, rows.z_axis].into_iter().enumerate() {
        let (low, high) = extent_along(shape, row, inverse, axis);
        let base = map.translation[axis];
        let slack = 16.0 * f64::EPSILON * (base.abs() + row.length() * shape.magnitude());
        if low.is_finite() {
            hull.min[axis] = base + low - slack;
        }
        if high.is_finite() {
            hull.max[axis] = base + high + slack;
        }
    }
    hull
}

/// Least and greatest of `row · p` over the shape (its support function in both directions).
fn extent_along(shape: &Shape, row: DVec3, inverse: &DAffine3, axis: usize) -> (f64, f64) {
    let ring = row.truncate().length();
    let disc = |radius: f64, z: f64| (row.z * z - radius * ring, row.z * z + radius * ring);
    let hull = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
    match *shape {
        Shape::Sphere { radius } => (-radius * row.length(), radius * row.length()),
        Shape::Box { min, max } => {
            let (a, b) = (row * min, row * max);
            let (low, high) = (a.min(b), a.max(b));
            (low.x + low.y + low.z, high.x + high.y + high.z)
        }
        Shape::Cylinder { radius, height } => hull(disc(radius, 0.0), disc(radius, height)),
        Shape::Cone { base_radius, top_radius, height } => hull(disc(base_radius, 0.0), disc(top_radius, height)),
        Shape::Torus { major, minor } => {
            let reach = major * ring + minor * row.length();
            (-reach, reach)
        }
        Shape::InfiniteCylinder { radius } if row.z == 0.0 => disc(radius, 0.0),
        Shape::InfiniteCylinder { .. } => (f64::NEG_INFINITY, f64::INFINITY),
        Shape::HalfSpace => half_space_extent(inverse, axis, row),
        Shape::Paraboloid(ref paraboloid) => (paraboloid.farthest(-row).dot(row), paraboloid.farthest(row).dot(row)),
        Shape::Hyperboloid(ref hyperboloid) => (-hyperboloid.support(-row), hyperboloid.support(row)),
        Shape::Mesh(ref mesh) => mesh.extent_along(row),
        Shape::Polyhedron(ref polyhedron) => (-polyhedron.support(-row), polyhedron.support(row)),
        Shape::Superquadric(ref superquadric) => (-superquadric.support(-row), superquadric.support(row)),
        Shape::Lathe(ref lathe) => (-lathe.support(-row), lathe.support(row)),
        Shape::Prism(ref prism) => (-prism.support(-row), prism.support(row)),
    }
}

/// A half-space is bounded on one side of the axis that its normal is parallel to.
fn half_space_extent(inverse: &DAffine3, axis: usize, row: DVec3) -> (f64, f64) {
    let normal = inverse.matrix3.transpose().z_axis;
    let mut along = normal;
    along[axis] = 0.0;
    if along != DVec3::ZERO {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    // Only z moves along this axis (row · p = row.z z with z <= 0).
    if row.z > 0.0 { (f64::NEG_INFINITY, 0.0) } else { (0.0, f64::INFINITY) }
}
