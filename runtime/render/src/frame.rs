//! Orthonormal frames (Duff et al. 2017, "Building an orthonormal basis, revisited").

use glam::DVec3;

/// A right-handed frame with `z` as its third axis.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub x: DVec3,
    pub y: DVec3,
    pub z: DVec3,
}

impl Frame {
    /// Any frame about a unit vector.
    #[inline]
    pub fn new(z: DVec3) -> Frame {
        let sign = 1f64.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Frame {
            x: DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: DVec3::new(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// About a unit vector, with x as near to `tangent` as can be; any frame where that is undetermined.
    #[inline]
    pub fn with_tangent(z: DVec3, tangent: DVec3) -> Frame {
        match (tangent - z * z.dot(tangent)).try_normalize() {
            Some(x) => Frame { x, y: z.cross(x), z },
            None => Frame::new(z),
        }
    }

    #[inline]
    pub fn to_local(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    #[inline]
    pub fn to_world(&self, v: DVec3) -> DVec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        let axes = [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(1e-9, -1e-9, -1.0), DVec3::new(0.3, -0.4, 0.1)];
        for z in axes.map(DVec3::normalize) {
            let f = Frame::new(z);
            assert!((f.x.cross(f.y) - f.z).length() < 1e-12, "{f:?}");
            assert!((f.x.length() - 1.0).abs() < 1e-12 && f.x.dot(f.z).abs() < 1e-12, "{f:?}");
            let v = DVec3::new(0.2, -0.7, 0.5);
            assert!((f.to_world(f.to_local(v)) - v).length() < 1e-12);
        }
    }
}
