//! Prism: a polygon with holes in the plane z = 0, extruded to z = `height`. Faces: 0 bottom, 1 top, then the sides in
//! the order of the corners that they begin at (the outline's, then the holes').

use std::fmt;
use std::sync::OnceLock;

use glam::{DVec2, DVec3};

use crate::area_table::{AreaTable, triangle_weights};
use crate::polygon::Polygon;
use crate::region::Region;
use crate::{Aabb, Classification, Crossings, LocalPoint};

const BOTTOM: u32 = 0;
const TOP: u32 = 1;
const FIRST_SIDE: u32 = 2;

/// An upright prism.
pub struct Prism {
    polygon: Polygon,
    height: f64,
    areas: AreaTable,
    /// Triangles of the base, made when first needed.
    caps: OnceLock<(Vec<[DVec2; 3]>, AreaTable)>,
}

impl fmt::Debug for Prism {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Prism").field("polygon", &self.polygon).field("height", &self.height).finish()
    }
}

impl PartialEq for Prism {
    fn eq(&self, other: &Prism) -> bool {
        self.height == other.height && self.polygon == other.polygon
    }
}

impl Prism {
    /// `None` unless `height` and all areas are positive and finite.
    pub fn new(polygon: Polygon, height: f64) -> Option<Prism> {
        let sides = polygon.edges().iter().map(|edge| edge.a.distance(edge.b) * height);
        let areas = AreaTable::new([polygon.area, polygon.area].into_iter().chain(sides));
        let valid = height > 0.0 && polygon.area > 0.0 && areas.total().is_finite();
        valid.then(|| Prism { polygon, height, areas, caps: OnceLock::new() })
    }

    pub fn polygon(&self) -> &Polygon {
        &self.polygon
    }

    pub fn height(&self) -> f64 {
        self.height
    }

    pub(crate) fn contains(&self, p: DVec3) -> bool {
        (0.0..=self.height).contains(&p.z) && self.polygon.contains(p.truncate())
    }

    pub(crate) fn bounds(&self) -> Aabb {
        Aabb::new(self.polygon.min.extend(0.0), self.polygon.max.extend(self.height))
    }

    /// `dir` of any length. Two crossings for each stretch of the line within the polygon. Roots are off the face by at
    /// most 16 units in the last place of the largest coordinate.
    pub(crate) fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        let (mut z0, mut z1) = ((f64::NEG_INFINITY, BOTTOM), (f64::INFINITY, TOP));
        if dir.z != 0.0 {
            let (bottom, top) = ((-origin.z / dir.z, BOTTOM), ((self.height - origin.z) / dir.z, TOP));
            (z0, z1) = if dir.z > 0.0 { (bottom, top) } else { (top, bottom) };
        } else if !(0.0..=self.height).contains(&origin.z) {
            return Crossings::NONE;
        }
        let (o, d) = (origin.truncate(), dir.truncate());
        if d == DVec2::ZERO {
            let inside = self.polygon.contains(o);
            return if inside { Crossings::interval(z0.0, z0.1, z1.0, z1.1) } else { Crossings::NONE };
        }
        let mut found = Crossings::NONE;
        for pair in self.polygon.crossings(o, d).chunks_exact(2) {
            let side = |i: usize| (pair[i].0, FIRST_SIDE + pair[i].1);
            let (enter, leave) = (side(0), side(1));
            let enter = if enter.0 > z0.0 { enter } else { z0 };
            let leave = if leave.0 < z1.0 { leave } else { z1 };
            if enter.0 < leave.0 {
                found.push(enter.0, enter.1);
                found.push(leave.0, leave.1);
            }
        }
        found
    }

    /// Bottom and top: u and v over the rectangle about the polygon. Sides: u along the edge, v = z / height.
    pub(crate) fn surface(&self, p: DVec3, face: u32) -> LocalPoint {
        if face < FIRST_SIDE {
            let (z, n) = if face == TOP { (self.height, DVec3::Z) } else { (0.0, DVec3::NEG_Z) };
            let uv = (p.truncate() - self.polygon.min) / (self.polygon.max - self.polygon.min);
            return LocalPoint { p: p.truncate().extend(z), n, uv, dpdu: DVec3::X };
        }
        let edge = self.polygon.edges()[(face - FIRST_SIDE) as usize];
        let along = edge.b - edge.a;
        let u = ((p.truncate() - edge.a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let z = p.z.clamp(0.0, self.height);
        let uv = DVec2::new(u, z / self.height);
        LocalPoint { p: (edge.a + along * u).extend(z), n: edge.normal().extend(0.0), uv, dpdu: along.extend(0.0) }
    }

    /// Greatest `n · p`.
    pub(crate) fn support(&self, n: DVec3) -> f64 {
        let flat = self.polygon.rings()[0].iter().map(|p| p.dot(n.truncate())).fold(f64::NEG_INFINITY, f64::max);
        flat + (n.z * self.height).max(0.0)
    }

    pub(crate) fn classify(&self, region: &Region) -> Classification {
        region.refined(3, &|part| self.classify_once(part), &|p| self.contains(p))
    }

    fn classify_once(&self, region: &Region) -> Classification {
        if region.beyond_slab(0.0, self.height) {
            return Classification::Outside;
        }
        if self.polygon.meets(region.c.truncate(), region.e.map(DVec3::truncate)) {
            return Classification::Boundary;
        }
        let (low, high) = region.z_range();
        if !self.polygon.contains(region.c.truncate()) {
            Classification::Outside
        } else if low >= 0.0 && high <= self.height {
            Classification::Inside
        } else {
            Classification::Boundary
        }
    }

    /// Of bottom, top and sides; closed form.
    pub(crate) fn areas(&self) -> &AreaTable {
        &self.areas
    }

    /// Uniform on a face.
    pub(crate) fn sample(&self, face: u32, u: [f64; 2]) -> DVec3 {
        if face >= FIRST_SIDE {
            let edge = self.polygon.edges()[(face - FIRST_SIDE) as usize];
            return (edge.a + (edge.b - edge.a) * u[0]).extend(self.height * u[1]);
        }
        let (triangles, areas) = self.caps.get_or_init(|| {
            let triangles = self.polygon.triangles();
            let areas = AreaTable::new(triangles.iter().map(|[a, b, c]| 0.5 * (*b - *a).perp_dot(*c - *a).abs()));
            (triangles, areas)
        });
        if triangles.is_empty() {
            return self.polygon.rings()[0][0].extend(0.0);
        }
        let (triangle, rest) = areas.choose(u[0]);
        let [origin, first, second] = triangles[triangle];
        let [b, c] = triangle_weights([rest, u[1]]);
        let p = origin + (first - origin) * b + (second - origin) * c;
        p.extend(if face == TOP { self.height } else { 0.0 })
    }
}
