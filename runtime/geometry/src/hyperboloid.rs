//! Hyperboloids of revolution between two planes: `x² + y² <= slope² z² ± radius²`, `|z| <= half_height`. Faces, as of
//! a cylinder: 0 side (both sheets), 1 bottom, 2 top.
//!
//! With plus it is the body of one sheet, a hyperbolic column with its waist in the plane z = 0; with minus the two
//! bodies of two sheets, convex bowls with their vertices at z = ± radius / slope. Both approach the same cone.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::cone::{BOTTOM, SIDE, TOP, disk_point, disk_surface, slab};
use crate::quadratic::{Inside, not_positive};
use crate::region::Region;
use crate::{Aabb, Classification, Crossings, LocalPoint};

/// About the z axis, centred at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyperboloid {
    /// Of the waist; of two sheets: of the waist of the one-sheeted hyperboloid with the same asymptotes.
    pub radius: f64,
    /// Radius over height of the asymptotic cone.
    pub slope: f64,
    /// With two sheets more than `radius / slope`.
    pub half_height: f64,
    pub two_sheets: bool,
}

impl Hyperboloid {
    pub(crate) fn is_valid(&self) -> bool {
        let positive = [self.radius, self.slope, self.half_height].into_iter().all(|x| x > 0.0 && x.is_finite());
        positive && self.cap_radius() > 0.0 && self.cap_radius().is_finite()
    }

    pub(crate) fn magnitude(&self) -> f64 {
        self.half_height.max(self.radius).max(self.cap_radius())
    }

    /// The side's radius squared is `slope² z²` plus this.
    fn offset(&self) -> f64 {
        self.radius * if self.two_sheets { -self.radius } else { self.radius }
    }

    /// The side's radius squared at a height.
    fn square(&self, z: f64) -> f64 {
        let asymptote = self.slope * z.abs();
        if self.two_sheets {
            (asymptote - self.radius) * (asymptote + self.radius)
        } else {
            asymptote * asymptote + self.radius * self.radius
        }
    }

    /// Radius of the end faces.
    pub(crate) fn cap_radius(&self) -> f64 {
        self.square(self.half_height).max(0.0).sqrt()
    }

    pub(crate) fn contains(&self, p: DVec3) -> bool {
        p.z.abs() <= self.half_height && p.truncate().length_squared() <= self.square(p.z)
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let (r, h) = (self.cap_radius(), self.half_height);
        Aabb::new(DVec3::new(-r, -r, -h), DVec3::new(r, r, h))
    }

    /// `dir` is unit. At most four crossings. Roots are off the surface by at most 64 units in the last place of the
    /// largest of the origin's distance and the sizes, times the slope if that is greater than one.
    pub(crate) fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        let shift = -origin.dot(dir);
        let o = origin + dir * shift;
        let Some((z0, f0, z1, f1)) = slab(-self.half_height, self.half_height, o, dir) else {
            return Crossings::NONE;
        };
        let steep = self.slope * self.slope;
        let (flat_o, flat_d) = (o.truncate(), dir.truncate());
        let a = flat_d.length_squared() - steep * dir.z * dir.z;
        let half_b = flat_o.dot(flat_d) - steep * o.z * dir.z;
        let c = flat_o.length_squared() - steep * o.z * o.z - self.offset();
        let mut found = Crossings::NONE;
        let mut add = |enter: (f64, u32), leave: (f64, u32)| {
            let enter = if enter.0 > z0 { enter } else { (z0, f0) };
            let leave = if leave.0 < z1 { leave } else { (z1, f1) };
            if enter.0 < leave.0 {
                found.push(enter.0 + shift, enter.1);
                found.push(leave.0 + shift, leave.1);
            }
        };
        let side = |t: f64| (self.polished(o, dir, t), SIDE);
        let (first, last) = ((f64::NEG_INFINITY, SIDE), (f64::INFINITY, SIDE));
        match not_positive(a, half_b, c) {
            Inside::Never => {}
            Inside::Always => add(first, last),
            Inside::Between(low, high) => add(side(low), side(high)),
            Inside::Beyond(low, high) => {
                add(first, side(low));
                add(side(high), last);
            }
        }
        found
    }

    /// One Newton step at the root itself, where no large terms cancel as they do in the coefficients.
    fn polished(&self, o: DVec3, dir: DVec3, t: f64) -> f64 {
        let p = o + dir * t;
        let (flat, asymptote) = (p.truncate().length(), self.slope * p.z.abs());
        let (outer, inner) = match self.two_sheets {
            true => (flat.hypot(self.radius), asymptote),
            false => (flat, asymptote.hypot(self.radius)),
        };
        let value = (outer - inner) * (outer + inner);
        let rate = 2.0 * (p.truncate().dot(dir.truncate()) - self.slope * self.slope * p.z * dir.z);
        let step = value / rate;
        if step.abs() < 1e-7 * self.radius { t - step } else { t }
    }

    /// u is the azimuth, v = 0.5 + 0.5 z / half_height; on the end faces a square about the disk.
    pub(crate) fn surface(&self, p: DVec3, face: u32) -> LocalPoint {
        if face != SIDE {
            let sign = if face == TOP { 1.0 } else { -1.0 };
            return disk_surface(self.cap_radius(), sign * self.half_height, sign, p);
        }
        let azimuth = p.y.atan2(p.x);
        let (sin, cos) = azimuth.sin_cos();
        let steep = self.slope * self.slope;
        // One step along the gradient of half the implicit function, in the meridian plane; then onto it exactly.
        let rho = p.truncate().length();
        let asymptote = self.slope * p.z.abs();
        let (outer, inner) = match self.two_sheets {
            true => (rho.hypot(self.radius), asymptote),
            false => (rho, asymptote.hypot(self.radius)),
        };
        let gradient = DVec2::new(rho, -steep * p.z);
        let step = gradient * (0.5 * (outer - inner) * (outer + inner) / gradient.length_squared());
        let z = (p.z - step.y).clamp(-self.half_height, self.half_height);
        let (rho, z) = if self.two_sheets {
            let rho = (rho - step.x).clamp(0.0, self.cap_radius());
            (rho, (rho.hypot(self.radius) / self.slope).min(self.half_height).copysign(p.z))
        } else {
            (self.square(z).sqrt(), z)
        };
        let n = DVec3::new(rho * cos, rho * sin, -steep * z).normalize();
        let uv = DVec2::new(azimuth.rem_euclid(TAU) / TAU, 0.5 + 0.5 * z / self.half_height);
        LocalPoint { p: DVec3::new(rho * cos, rho * sin, z), n, uv, dpdu: DVec3::new(-sin, cos, 0.0) }
    }

    /// Greatest `n · p`: on a rim, which no other point of the body surpasses.
    pub(crate) fn support(&self, n: DVec3) -> f64 {
        self.cap_radius() * n.truncate().length() + self.half_height * n.z.abs()
    }

    pub(crate) fn classify(&self, region: &Region) -> Classification {
        region.refined(5, &|part| self.classify_once(part), &|p| self.contains(p))
    }

    fn classify_once(&self, region: &Region) -> Classification {
        let (low, high) = region.z_range();
        let h = self.half_height;
        let (near, far) = (low.max(-high).max(0.0), high.max(-low));
        let (rho0, rho1) = region.rho_range();
        if near > h || rho0 * rho0 > self.square(far.min(h)) {
            Classification::Outside
        } else if far <= h && rho1 * rho1 <= self.square(near) {
            Classification::Inside
        } else {
            Classification::Boundary
        }
    }

    /// Where the upper half of the side begins.
    fn vertex(&self) -> f64 {
        if self.two_sheets { self.radius / self.slope } else { 0.0 }
    }

    /// Area of the upper half of the side from its beginning up to a height, over π: twice the integral of
    /// `√(κ² z² ± radius²)`, `κ = slope √(1 + slope²)`, in closed form.
    fn half_side(&self, z: f64) -> f64 {
        let kappa = self.slope * self.slope.hypot(1.0);
        let primitive = |z: f64| {
            let x = kappa * z / self.radius;
            let angle = if self.two_sheets { -x.max(1.0).acosh() } else { x.asinh() };
            z * self.slant(z) + self.radius * (self.radius / kappa) * angle
        };
        primitive(z) - primitive(self.vertex())
    }

    /// `√(κ² z² ± radius²)`.
    fn slant(&self, z: f64) -> f64 {
        let x = self.slope * self.slope.hypot(1.0) * z.abs();
        let square =
            if self.two_sheets { (x - self.radius) * (x + self.radius) } else { x * x + self.radius * self.radius };
        square.max(0.0).sqrt()
    }

    /// Of side, bottom and top; closed form.
    pub(crate) fn areas(&self) -> [f64; 3] {
        let cap = PI * self.cap_radius() * self.cap_radius();
        [TAU * self.half_side(self.half_height), cap, cap]
    }

    /// Uniform on a face; on the side the height comes from its distribution by safeguarded Newton steps.
    pub(crate) fn sample(&self, face: u32, u: [f64; 2]) -> DVec3 {
        match face {
            BOTTOM => return disk_point(self.cap_radius(), -self.half_height, u),
            TOP => return disk_point(self.cap_radius(), self.half_height, u),
            _ => {}
        }
        let (sign, share) = if u[1] < 0.5 { (-1.0, 1.0 - 2.0 * u[1]) } else { (1.0, 2.0 * u[1] - 1.0) };
        let wanted = share * self.half_side(self.half_height);
        let (mut low, mut high) = (self.vertex(), self.half_height);
        let mut z = low + share * (high - low);
        for _ in 0..60 {
            let excess = self.half_side(z) - wanted;
            if excess > 0.0 {
                high = z;
            } else {
                low = z;
            }
            let next = z - 0.5 * excess / self.slant(z);
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            if (next - z).abs() < 1e-15 * self.half_height {
                break;
            }
            z = next;
        }
        let (sin, cos) = (TAU * u[0]).sin_cos();
        let rho = self.square(z).max(0.0).sqrt();
        DVec3::new(rho * cos, rho * sin, sign * z)
    }
}
