//! Paraboloid of revolution: `(x² + y²) height <= radius² z`, `z <= height`. Convex. Faces: 0 side, 2 top (as of a
//! cylinder; there is no bottom).

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::cone::{SIDE, TOP, disk_point, disk_surface};
use crate::quadratic::{Inside, not_positive};
use crate::region::Region;
use crate::{Aabb, Classification, Crossings, LocalPoint};

/// Vertex at the origin, about the z axis, closed by a disk of `radius` at z = `height`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    pub radius: f64,
    pub height: f64,
}

impl Paraboloid {
    /// Half the latus rectum: `x² + y² = 2 p z`.
    fn p(&self) -> f64 {
        0.5 * self.radius * (self.radius / self.height)
    }

    pub(crate) fn is_valid(&self) -> bool {
        self.radius > 0.0 && self.height > 0.0 && self.p() > 0.0 && (self.p() + self.slant()).is_finite()
    }

    pub(crate) fn contains(&self, p: DVec3) -> bool {
        p.z <= self.height && p.truncate().length_squared() <= 2.0 * self.p() * p.z
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let r = self.radius;
        Aabb::new(DVec3::new(-r, -r, 0.0), DVec3::new(r, r, self.height))
    }

    /// `dir` is unit. Roots are off the surface by at most 32 units in the last place of the largest of the origin's
    /// distance and the sizes.
    pub(crate) fn crossings(&self, origin: DVec3, dir: DVec3) -> Crossings {
        // From the point nearest to the middle nothing large is subtracted.
        let shift = (DVec3::new(0.0, 0.0, 0.5 * self.height) - origin).dot(dir);
        let o = origin + dir * shift;
        let p = self.p();
        let (flat_o, flat_d) = (o.truncate(), dir.truncate());
        let (a, half_b) = (flat_d.length_squared(), flat_o.dot(flat_d) - p * dir.z);
        let Inside::Between(low, high) = not_positive(a, half_b, flat_o.length_squared() - 2.0 * p * o.z) else {
            return Crossings::NONE;
        };
        let (mut enter, mut leave) = ((low, SIDE), (high, SIDE));
        let top = (self.height - o.z) / dir.z;
        if dir.z > 0.0 && top < leave.0 {
            leave = (top, TOP);
        } else if dir.z < 0.0 && top > enter.0 {
            enter = (top, TOP);
        } else if dir.z == 0.0 && o.z > self.height {
            return Crossings::NONE;
        }
        Crossings::interval(enter.0 + shift, enter.1, leave.0 + shift, leave.1)
    }

    pub(crate) fn classify(&self, region: &Region) -> Classification {
        if region.is_apart(|n| self.farthest(n)) {
            Classification::Outside
        } else if region.corners().all(|p| self.contains(p)) {
            Classification::Inside
        } else {
            Classification::Boundary
        }
    }

    /// u is the azimuth, v = z / height; on the top a square about the disk.
    pub(crate) fn surface(&self, p: DVec3, face: u32) -> LocalPoint {
        if face == TOP {
            return disk_surface(self.radius, self.height, 1.0, p);
        }
        let azimuth = p.y.atan2(p.x);
        let (sin, cos) = azimuth.sin_cos();
        // One step along the gradient of (ρ² − 2 p z) / 2, whose length is at least p.
        let (rho, half) = (p.truncate().length(), self.p());
        let step = 0.5 * (rho * rho - 2.0 * half * p.z) / (rho * rho + half * half);
        let rho = (rho - step * rho).clamp(0.0, self.radius);
        let z = self.height * (rho / self.radius) * (rho / self.radius);
        let n = DVec3::new(rho * cos, rho * sin, -half).normalize();
        let uv = DVec2::new(azimuth.rem_euclid(TAU) / TAU, z / self.height);
        LocalPoint { p: DVec3::new(rho * cos, rho * sin, z), n, uv, dpdu: DVec3::new(-sin, cos, 0.0) }
    }

    /// The point farthest along `n`.
    pub(crate) fn farthest(&self, n: DVec3) -> DVec3 {
        let ring = n.truncate().length();
        let half = self.p();
        // On the side the normal is (ρ, −p); beyond the rim the rim is farthest.
        let rho = if n.z < 0.0 { (half * ring / -n.z).min(self.radius) } else { self.radius };
        let z = self.height * (rho / self.radius) * (rho / self.radius);
        let out = if ring > 0.0 { n.truncate() / ring } else { DVec2::X };
        (out * rho).extend(z)
    }

    /// Of side, bottom (there is none) and top; closed form.
    pub(crate) fn areas(&self) -> [f64; 3] {
        let (r, s) = (self.radius, self.slant());
        [TAU * r / 3.0 * (s * s + s * r + r * r) / (s + r), 0.0, PI * r * r]
    }

    /// √(radius² + 4 height²): the side's area up to a radius grows as the cube of what stands there for `radius`.
    fn slant(&self) -> f64 {
        self.radius.hypot(2.0 * self.height)
    }

    /// Uniform on a face. On the side w(ρ) = √(1 + 4 (h ρ / r²)²) has w³ uniform.
    pub(crate) fn sample(&self, face: u32, u: [f64; 2]) -> DVec3 {
        if face == TOP {
            return disk_point(self.radius, self.height, u);
        }
        let steep = 2.0 * self.height / self.radius;
        let w = self.slant() / self.radius;
        // w − 1 without cancellation, so that flat dishes are right.
        let excess = steep * steep / (w + 1.0) * (w * w + w + 1.0) * u[1];
        let w = (1.0 + excess).cbrt();
        let rho = self.radius * ((excess / (w * w + w + 1.0) * (w + 1.0)).sqrt() / steep).min(1.0);
        let (sin, cos) = (TAU * u[0]).sin_cos();
        DVec3::new(rho * cos, rho * sin, self.height * (rho / self.radius) * (rho / self.radius))
    }
}
