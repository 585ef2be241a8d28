//! Cameras.

use arsc_geometry::DVec3;

#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    pub projection: Projection,
    pub eye: DVec3,
    pub target: DVec3,
    pub up: DVec3,
    /// Pixels: width, height.
    pub resolution: [u32; 2],
    pub filter: Filter,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Full angle across the shorter side of the image, radians.
    Perspective { fov: f64 },
}

/// Reconstruction filters; radii in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    Box { radius: f64 },
    Tent { radius: f64 },
    Gaussian { radius: f64, sigma: f64 },
    Mitchell { radius: f64, b: f64, c: f64 },
}
