//! Cameras.

use arsc_geometry::DVec3;

#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    pub projection: Projection,
    pub eye: DVec3,
    /// What is in the middle of the picture; `None` for the middle of the scene.
    pub target: Option<DVec3>,
    pub up: DVec3,
    /// Turns the camera clockwise about its view axis, radians.
    pub twist: f64,
    /// Moved along its view axis until all of the scene is in the picture, with this share of it free at the edges.
    pub fit: Option<f64>,
    /// Pixels: width, height.
    pub resolution: [u32; 2],
    /// Width of a pixel over its height.
    pub pixel_aspect: f64,
    /// Left, top, right and bottom of what is rendered, as shares of the picture.
    pub crop: Option<[f64; 4]>,
    pub filter: Filter,
}

/// The part of the picture that a field of view or an extent refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Across {
    Shorter,
    Horizontal,
    Vertical,
    Diagonal,
}

impl Across {
    pub const ALL: [Across; 4] = [Across::Shorter, Across::Horizontal, Across::Vertical, Across::Diagonal];

    /// As scripts write it.
    pub const fn name(self) -> &'static str {
        match self {
            Across::Shorter => "shorter",
            Across::Horizontal => "horizontal",
            Across::Vertical => "vertical",
            Across::Diagonal => "diagonal",
        }
    }
}

/// Angles are full angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    Perspective {
        fov: f64,
        across: Across,
    },
    ThinLens {
        fov: f64,
        across: Across,
        lens: Lens,
    },
    /// `extent` is the length that the picture shows.
    Orthographic {
        extent: f64,
        across: Across,
    },
    Fisheye {
        mapping: FisheyeMapping,
        fov: f64,
        across: Across,
    },
    /// All directions, by azimuth and polar angle.
    Panorama,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Of the aperture.
    pub radius: f64,
    /// Corners of the aperture; 0 for a disk.
    pub blades: u32,
    /// Of the polygon, clockwise, radians.
    pub rotation: f64,
    pub focus: Focus,
}

/// Where the plane in focus is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Focus {
    /// Along the view axis.
    Distance(f64),
    /// Through a point.
    Point(DVec3),
    /// Through the target.
    Target,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FisheyeMapping {
    Equidistant,
    EqualArea,
}

impl FisheyeMapping {
    pub const ALL: [FisheyeMapping; 2] = [FisheyeMapping::Equidistant, FisheyeMapping::EqualArea];

    /// As scripts write it.
    pub const fn name(self) -> &'static str {
        match self {
            FisheyeMapping::Equidistant => "equidistant",
            FisheyeMapping::EqualArea => "equal_area",
        }
    }
}

/// Reconstruction filters; radii in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    Box { radius: f64 },
    Tent { radius: f64 },
    Gaussian { radius: f64, sigma: f64 },
    Mitchell { radius: f64, b: f64, c: f64 },
    Lanczos { radius: f64 },
}
