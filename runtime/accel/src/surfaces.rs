//! Open surfaces in double precision: flat shapes in their own frame, and triangles.
//!
//! Normals go through the inverse transpose, so a mirrored surface keeps the side that its author gave it.

use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DMat3, DVec2, DVec3};

use arsc_geometry::{Aabb, Foot, SurfacePoint, TriangleMesh, invert};

use crate::{AccelError, Surface, SurfaceShape};

/// Roundings granted to a position on a surface.
const ROUNDINGS: f64 = 32.0;
/// Surfaces closer than so many error bounds coincide.
const COINCIDENT: f64 = 4.0;
/// Points of a triangle keep off its edges by so much of its size.
const EDGE: f64 = 1e-9;

/// The two halves of a quad, as Embree cuts it.
const QUAD: [[u32; 3]; 2] = [[0, 1, 3], [2, 3, 1]];

/// A surface, checked and placed.
#[derive(Clone, Debug)]
pub enum SurfaceModel {
    Flat(Flat),
    Triangles(Triangles),
}

impl SurfaceModel {
    /// `index` names the surface in errors.
    pub fn new(surface: &Surface, index: u32) -> Result<SurfaceModel, AccelError> {
        let fail = |reason| AccelError::Surface { surface: index, reason };
        let map = surface.world_from_object;
        let inverse = invert(&map).ok_or(fail("the map has no finite inverse"))?;
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let flat = |outline| Ok(SurfaceModel::Flat(Flat::new(outline, map, inverse)));
        match &surface.shape {
            SurfaceShape::Rectangle { size } if positive(size.x) && positive(size.y) => {
                flat(Outline::Rectangle { half: *size * 0.5 })
            }
            SurfaceShape::Disk { radius } if positive(*radius) => flat(Outline::Disk { radius: *radius }),
            SurfaceShape::Rectangle { .. } | SurfaceShape::Disk { .. } => {
                Err(fail("a size is not positive and finite"))
            }
            SurfaceShape::Plane => flat(Outline::Plane),
            SurfaceShape::Triangle(corners) => {
                Triangles::place(Content::Triangle(*corners), &map, &inverse).map_err(fail)
            }
            SurfaceShape::Quad(corners) => Triangles::place(Content::Quad(*corners), &map, &inverse).map_err(fail),
            SurfaceShape::Mesh(mesh) => Triangles::place(Content::Mesh(mesh.clone()), &map, &inverse).map_err(fail),
        }
    }

    /// Holds the surface; infinite where it is.
    pub fn bounds(&self) -> Aabb {
        match self {
            SurfaceModel::Flat(flat) => flat.bounds(),
            SurfaceModel::Triangles(triangles) => triangles.bounds,
        }
    }

    /// World area; infinite for a plane.
    pub fn area(&self) -> f64 {
        match self {
            SurfaceModel::Flat(flat) => flat.area,
            SurfaceModel::Triangles(triangles) => triangles.area(),
        }
    }

    /// A point uniform over the world area; `None` for a plane. `choice` picks the triangle.
    pub fn sample(&self, choice: f64, u: [f64; 2]) -> Option<SurfacePoint> {
        match self {
            SurfaceModel::Flat(flat) => flat.sample(u),
            SurfaceModel::Triangles(triangles) => triangles.sample(choice, u),
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Outline {
    Rectangle { half: DVec2 },
    Disk { radius: f64 },
    Plane,
}

/// Part of the plane z = 0 of its own frame, normal +z.
#[derive(Clone, Debug)]
pub struct Flat {
    outline: Outline,
    map: DAffine3,
    inverse: DAffine3,
    normal: DVec3,
    area: f64,
    /// The error of a point is the first times its largest coordinate (and at least the third), plus the second.
    error: [f64; 3],
}

impl Flat {
    fn new(outline: Outline, map: DAffine3, inverse: DAffine3) -> Flat {
        let row = inverse.matrix3.transpose().z_axis;
        let element = map.matrix3.x_axis.cross(map.matrix3.y_axis).length();
        let (size, area) = match outline {
            Outline::Rectangle { half } => (half.max_element(), 4.0 * half.x * half.y * element),
            Outline::Disk { radius } => (radius, std::f64::consts::PI * radius * radius * element),
            Outline::Plane => (0.0, f64::INFINITY),
        };
        // That of the height over the plane, mapped back, that of the other coordinates, and that of the sizes.
        let sizes = map.matrix3.x_axis.length().max(map.matrix3.y_axis.length()) * size;
        let factor = 1.0 + row.abs().element_sum() / row.length();
        let constant = sizes + inverse.translation.z.abs() / row.length();
        let unit = ROUNDINGS * f64::EPSILON;
        let error = [unit * factor, unit * constant, map.translation.abs().max_element()];
        Flat { outline, map, inverse, normal: row.normalize(), area, error }
    }

    /// Parameter of the crossing.
    #[inline]
    pub fn crossing(&self, origin: DVec3, dir: DVec3) -> Option<f64> {
        let o = self.inverse.transform_point3(origin);
        let d = self.inverse.transform_vector3(dir);
        let t = -o.z / d.z;
        let p = (o + d * t).truncate();
        let within = match self.outline {
            Outline::Rectangle { half } => p.abs().cmple(half).all(),
            Outline::Disk { radius } => p.length() <= radius,
            Outline::Plane => true,
        };
        (t.is_finite() && within).then_some(t)
    }

    /// Distance along `dir` within which another surface at `p` coincides.
    #[inline]
    pub fn tolerance(&self, p: DVec3, dir: DVec3) -> f64 {
        COINCIDENT * self.error_at(p) / self.normal.dot(dir).abs().max(1e-3)
    }

    /// The surface point at `p`, which lies close to it.
    pub fn surface(&self, p: DVec3) -> SurfacePoint {
        self.point(self.inverse.transform_point3(p).truncate())
    }

    /// The same, with the normal alone.
    #[inline]
    pub fn foot(&self, p: DVec3) -> Foot {
        let local = self.inverse.transform_point3(p).truncate();
        Foot { p: self.map.transform_point3(local.extend(0.0)), p_error: self.error_at(p), n: self.normal }
    }

    fn point(&self, local: DVec2) -> SurfacePoint {
        let uv = match self.outline {
            Outline::Rectangle { half } => local / (2.0 * half) + 0.5,
            Outline::Disk { radius } => local / (2.0 * radius) + 0.5,
            Outline::Plane => local,
        };
        let (n, dpdu) = (self.normal, self.map.matrix3.x_axis);
        let p = self.map.transform_point3(local.extend(0.0));
        SurfacePoint { p, p_error: self.error_at(p), n, uv, dpdu: (dpdu - n * n.dot(dpdu)).normalize() }
    }

    pub fn object_from_world(&self) -> &DAffine3 {
        &self.inverse
    }

    /// Bound on the error of a point near `p`.
    #[inline]
    fn error_at(&self, p: DVec3) -> f64 {
        let [factor, constant, least] = self.error;
        factor * p.abs().max_element().max(least) + constant
    }

    fn bounds(&self) -> Aabb {
        let m = self.map.matrix3;
        let (x, y) = (m.x_axis, m.y_axis);
        let half = match self.outline {
            Outline::Rectangle { half } => x.abs() * half.x + y.abs() * half.y,
            Outline::Disk { radius } => (x * x + y * y).map(f64::sqrt) * radius,
            Outline::Plane => {
                // Infinite along every axis that the plane is not exactly perpendicular to.
                let across = (x.abs() + y.abs()).map(|reach| if reach > 0.0 { f64::INFINITY } else { 0.0 });
                return Aabb::new(self.map.translation - across, self.map.translation + across);
            }
        };
        let slack = 16.0 * f64::EPSILON * (self.map.translation.abs() + half).max_element();
        Aabb::new(self.map.translation - half, self.map.translation + half).dilated(slack)
    }

    fn sample(&self, u: [f64; 2]) -> Option<SurfacePoint> {
        let local = match self.outline {
            Outline::Rectangle { half } => (DVec2::from_array(u) * 2.0 - 1.0) * half,
            Outline::Disk { radius } => {
                let (sin, cos) = (std::f64::consts::TAU * u[1]).sin_cos();
                DVec2::new(cos, sin) * (radius * u[0].sqrt())
            }
            Outline::Plane => return None,
        };
        Some(self.point(local))
    }
}

/// A triangle: one corner, and from there the edges to the other two.
#[derive(Clone, Copy, Debug)]
pub struct Edges {
    a: DVec3,
    ab: DVec3,
    ac: DVec3,
}

/// Where a line meets a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    pub t: f64,
    /// Of the second and third corner.
    pub weights: DVec2,
    /// Distance along the line per distance from the plane; at most 1000.
    pub slant: f64,
}

impl Edges {
    #[inline]
    pub fn new([a, b, c]: [DVec3; 3]) -> Edges {
        Edges { a, ab: b - a, ac: c - a }
    }

    pub fn corners(&self) -> [DVec3; 3] {
        [self.a, self.a + self.ab, self.a + self.ac]
    }

    /// Twice the area, along the normal.
    #[inline]
    pub fn cross(&self) -> DVec3 {
        self.ab.cross(self.ac)
    }

    #[inline]
    fn at(&self, w: DVec2) -> DVec3 {
        self.a + self.ab * w.x + self.ac * w.y
    }

    /// Where the line meets the triangle's plane; `dir` is unit. `None` beyond the edges, by more than `margin` of the
    /// triangle's size, and for what is parallel or degenerate.
    #[inline]
    pub fn crossing(&self, origin: DVec3, dir: DVec3, margin: f64) -> Option<Crossing> {
        // Möller and Trumbore 1997, with the triple products taken the other way round: the normal gives the slant.
        let (normal, oa) = (self.cross(), self.a - origin);
        let inverse = 1.0 / dir.dot(normal);
        let around = oa.cross(dir);
        let weights = DVec2::new(self.ac.dot(around), -self.ab.dot(around)) * inverse;
        if !(weights.min_element() >= -margin && weights.x + weights.y <= 1.0 + margin) {
            return None;
        }
        let t = oa.dot(normal) * inverse;
        let slant = (normal.length() * inverse).abs().min(1e3);
        t.is_finite().then_some(Crossing { t, weights, slant })
    }
}

/// Never on an edge: a ray that leaves from there would lie in the neighbour's plane.
#[inline]
fn inner_weights(weights: DVec2) -> DVec2 {
    let w = weights.max(DVec2::splat(EDGE));
    if w.x + w.y > 1.0 - EDGE { w * ((1.0 - EDGE) / (w.x + w.y)) } else { w }
}

/// Triangles in the world.
#[derive(Clone, Debug)]
pub struct Triangles {
    content: Content,
    map: DAffine3,
    /// Inverse transpose, of normals.
    normal_map: DMat3,
    bounds: Aabb,
    /// Bound on the error of any point.
    error: f64,
    mirrored: bool,
    /// The map changes nothing.
    in_place: bool,
    /// Sums of the areas up to and including each triangle, made when first asked for.
    cumulative_area: OnceLock<Vec<f64>>,
}

/// What the triangles are made of. Few corners are kept in the world; meshes are shared with whoever read them, and mapped
/// point by point: they may be large.
#[derive(Clone, Debug)]
enum Content {
    Triangle([DVec3; 3]),
    /// In the order of [`QUAD`].
    Quad([DVec3; 4]),
    Mesh(Arc<TriangleMesh>),
}

impl Content {
    fn uvs(&self, triangle: usize) -> Option<[DVec2; 3]> {
        match self {
            Content::Triangle(_) => Some([DVec2::ZERO, DVec2::X, DVec2::Y]),
            Content::Quad(_) => {
                let uvs = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
                Some(QUAD[triangle].map(|i| uvs[i as usize]))
            }
            Content::Mesh(mesh) => mesh.corner_uvs(triangle),
        }
    }
}

impl Triangles {
    fn place(content: Content, map: &DAffine3, inverse: &DAffine3) -> Result<SurfaceModel, &'static str> {
        let mut bounds = Aabb::EMPTY;
        let mut include = |p: DVec3| {
            let p = map.transform_point3(p);
            bounds = bounds.union(&Aabb::new(p, p));
            p.is_finite()
        };
        let finite = match &content {
            Content::Triangle(corners) => corners.iter().all(|&p| include(p)),
            Content::Quad(corners) => corners.iter().all(|&p| include(p)),
            Content::Mesh(mesh) if !mesh.is_valid() => return Err("a vertex is missing, or not finite"),
            Content::Mesh(mesh) => (0..mesh.positions.len() as u32).all(|vertex| include(mesh.position(vertex))),
        };
        if !finite {
            return Err("a vertex is not finite");
        }
        let magnitude = if bounds.is_empty() { 0.0 } else { bounds.min.abs().max(bounds.max.abs()).max_element() };
        let content = match content {
            Content::Triangle(corners) => Content::Triangle(corners.map(|p| map.transform_point3(p))),
            Content::Quad(corners) => Content::Quad(corners.map(|p| map.transform_point3(p))),
            mesh => mesh,
        };
        Ok(SurfaceModel::Triangles(Triangles {
            content,
            map: *map,
            normal_map: inverse.matrix3.transpose(),
            bounds,
            error: ROUNDINGS * f64::EPSILON * magnitude,
            in_place: *map == DAffine3::IDENTITY,
            mirrored: map.matrix3.determinant() < 0.0,
            cumulative_area: OnceLock::new(),
        }))
    }

    /// The mesh in its own space, if it is one.
    pub fn mesh(&self) -> Option<&TriangleMesh> {
        match &self.content {
            Content::Mesh(mesh) => Some(mesh),
            _ => None,
        }
    }

    pub fn object_from_world(&self) -> DAffine3 {
        let matrix3 = self.normal_map.transpose();
        DAffine3 { matrix3, translation: -(matrix3 * self.map.translation) }
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        match &self.content {
            Content::Triangle(_) => 1,
            Content::Quad(_) => 2,
            Content::Mesh(mesh) => mesh.triangles.len(),
        }
    }

    #[inline]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        match &self.content {
            Content::Triangle(corners) => *corners,
            Content::Quad(corners) => QUAD[triangle].map(|i| corners[i as usize]),
            Content::Mesh(mesh) if self.in_place => mesh.corners(triangle),
            Content::Mesh(mesh) => mesh.corners(triangle).map(|p| self.map.transform_point3(p)),
        }
    }

    #[inline]
    pub fn edges(&self, triangle: usize) -> Edges {
        Edges::new(self.corners(triangle))
    }

    fn cross(&self, triangle: usize) -> DVec3 {
        self.edges(triangle).cross()
    }

    /// What [`Crossing::slant`] is multiplied by for the distance within which another surface coincides.
    #[inline]
    pub fn tolerance(&self) -> f64 {
        COINCIDENT * self.error
    }

    /// The point with these weights of the second and third corner, moved to just within the triangle; shading normal
    /// beside.
    #[inline]
    pub fn foot(&self, triangle: usize, weights: DVec2) -> (Foot, DVec3) {
        let (w, edges) = (inner_weights(weights), self.edges(triangle));
        let n = self.normal(&edges);
        let ns = self.shading_normal(triangle, w).map_or(n, |ns| if ns.dot(n) < 0.0 { -ns } else { ns });
        (Foot { p: edges.at(w), p_error: self.error, n }, ns)
    }

    fn normal(&self, edges: &Edges) -> DVec3 {
        let n = edges.cross().normalize_or(DVec3::Z);
        if self.mirrored { -n } else { n }
    }

    /// The same point, with its coordinates.
    pub fn surface(&self, triangle: usize, weights: DVec2) -> SurfacePoint {
        let (w, edges) = (inner_weights(weights), self.edges(triangle));
        let (n, Edges { ab, ac, .. }) = (self.normal(&edges), edges);
        let (uv, along) = match self.content.uvs(triangle) {
            None => (w, ab),
            Some([ua, ub, uc]) => {
                let (du, dv) = (ub - ua, uc - ua);
                (ua + du * w.x + dv * w.y, (ab * dv.y - ac * du.y) * du.perp_dot(dv).signum())
            }
        };
        let dpdu = (along - n * n.dot(along)).try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
        SurfacePoint { p: edges.at(w), p_error: self.error, n, uv, dpdu }
    }

    fn shading_normal(&self, triangle: usize, w: DVec2) -> Option<DVec3> {
        let Content::Mesh(mesh) = &self.content else { return None };
        let [na, nb, nc] = mesh.corner_normals(triangle)?.map(|n| self.normal_map.mul_vec3(n).normalize_or_zero());
        (na * (1.0 - w.x - w.y) + nb * w.x + nc * w.y).try_normalize()
    }

    fn sums(&self) -> &[f64] {
        self.cumulative_area.get_or_init(|| {
            let mut sum = 0.0;
            let up_to = |triangle| {
                sum += 0.5 * self.cross(triangle).length();
                sum
            };
            (0..self.len()).map(up_to).collect()
        })
    }

    fn area(&self) -> f64 {
        self.sums().last().copied().unwrap_or(0.0)
    }

    fn sample(&self, choice: f64, u: [f64; 2]) -> Option<SurfacePoint> {
        let wanted = choice * self.area();
        let triangle = self.sums().partition_point(|&sum| sum <= wanted).min(self.len().checked_sub(1)?);
        // Uniform over the triangle by folding the square (Heitz 2019).
        let weights = if u[0] + u[1] > 1.0 { DVec2::new(1.0 - u[0], 1.0 - u[1]) } else { DVec2::from_array(u) };
        Some(self.surface(triangle, weights))
    }
}
