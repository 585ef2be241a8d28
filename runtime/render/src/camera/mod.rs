//! Cameras: which ray belongs to a point of the picture.
//!
//! World frame right-handed. Pixel coordinates are continuous, x to the right and y downwards, with the upper left
//! corner of the image at (0, 0). A pixel's value is the radiance along its rays, not weighted by any cosine.
//! The picture plane is measured in heights of a pixel from the picture's middle, so that pixels need not be square.
//!
//! Sources: lens as in Kolb, Mitchell and Hanrahan 1995, section 3.2 (thin lens approximation); fisheyes after
//! Fleck 1995, "Perspective projection: the wrong imaging model".

mod fit;
mod lens;
#[cfg(test)]
mod tests;

use std::f64::consts::{PI, TAU};

use arsc_geometry::Ray;
use glam::{DVec2, DVec3};

use crate::filter::ReconstructionFilter;
use crate::frame::Frame;

pub use lens::Lens;

/// The part of the picture that a field of view or an extent refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Across {
    /// The shorter side.
    Shorter,
    /// Width.
    Horizontal,
    /// Height.
    Vertical,
    /// From corner to corner.
    Diagonal,
}

/// How directions map to the picture. Angles are full angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Straight lines stay straight; `fov` in (0, pi). Sharp everywhere without a lens.
    Perspective { fov: f64, across: Across, lens: Option<Lens> },
    /// Parallel rays from the plane of the eye; `extent` is the length that the picture shows, positive.
    Orthographic { extent: f64, across: Across },
    /// The distance from the middle follows the angle from the view axis; `fov` in (0, 2 pi]. Directions beyond half
    /// of `fov` have no ray: there the picture is black.
    Fisheye { mapping: FisheyeMapping, fov: f64, across: Across },
    /// All directions: azimuth across the width, polar angle from `up` along the height. In the middle is the view
    /// direction, made level.
    Panorama,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FisheyeMapping {
    /// In proportion to the angle.
    Equidistant,
    /// In proportion to the sine of half the angle: equal areas of the picture show equal solid angles.
    EqualArea,
}

/// Where a camera stands and what it shows.
#[derive(Clone, Debug)]
pub struct View {
    pub eye: DVec3,
    pub target: DVec3,
    /// Upwards in the picture. Where it is parallel to the view axis, or `eye` equals `target`, an arbitrary direction
    /// takes its place.
    pub up: DVec3,
    /// Turns the camera clockwise about its view axis, radians.
    pub twist: f64,
    /// Width and height in pixels.
    pub resolution: [u32; 2],
    /// Width of a pixel over its height, positive.
    pub pixel_aspect: f64,
    pub projection: Projection,
}

/// A camera ready for use.
#[derive(Clone, Debug)]
pub struct Camera {
    eye: DVec3,
    axes: Axes,
    model: Model,
    resolution: [u32; 2],
    pub filter: ReconstructionFilter,
}

/// Unit vectors of the view: along its axis, to the right and downwards in the picture.
#[derive(Clone, Copy, Debug)]
struct Axes {
    forward: DVec3,
    right: DVec3,
    down: DVec3,
}

#[derive(Clone, Debug)]
enum Model {
    /// What one pixel spans at unit distance along the view axis.
    Perspective { pixel_right: DVec3, pixel_down: DVec3 },
    /// The same, and a lens with the distance of the plane in focus along the view axis.
    ThinLens { pixel_right: DVec3, pixel_down: DVec3, lens: Lens },
    /// What one pixel spans.
    Orthographic { pixel_right: DVec3, pixel_down: DVec3 },
    /// Pixel to the unit of the picture plane, in which the rim of the field of view has radius 1.
    Fisheye { mapping: FisheyeMapping, scale: DVec2, max_angle: f64 },
    /// Radians per pixel.
    Panorama { step: DVec2 },
}

/// A ray and the x axis of its reference frame.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    pub ray: Ray,
    /// Unit, across the ray and the picture's vertical there, to the right.
    pub horizontal: DVec3,
}

impl View {
    fn axes(&self) -> Axes {
        let forward = (self.target - self.eye).normalize_or(DVec3::Y);
        let right = forward.cross(self.up).try_normalize().unwrap_or(Frame::new(forward).x);
        let down = forward.cross(right);
        let forward = match self.projection {
            // The pole is `up` itself.
            Projection::Panorama => right.cross(-self.up.normalize_or(-down)),
            _ => forward,
        };
        let down = forward.cross(right);
        let (sin, cos) = self.twist.sin_cos();
        Axes { forward, right: right * cos + down * sin, down: down * cos - right * sin }
    }

    /// Half of the picture's width and height, in heights of a pixel.
    fn half_size(&self) -> DVec2 {
        let [width, height] = self.resolution.map(|pixels| f64::from(pixels.max(1)));
        DVec2::new(0.5 * width * self.pixel_aspect, 0.5 * height)
    }

    fn half_length(&self, across: Across) -> f64 {
        let half = self.half_size();
        match across {
            Across::Shorter => half.min_element(),
            Across::Horizontal => half.x,
            Across::Vertical => half.y,
            Across::Diagonal => half.length(),
        }
    }
}

impl Camera {
    pub fn new(view: &View, filter: ReconstructionFilter) -> Camera {
        let axes = view.axes();
        let span = |per_height: f64| (axes.right * (per_height * view.pixel_aspect), axes.down * per_height);
        let model = match view.projection {
            Projection::Perspective { fov, across, lens } => {
                let (pixel_right, pixel_down) = span((0.5 * fov).tan() / view.half_length(across));
                match lens.filter(|lens| lens.radius > 0.0) {
                    None => Model::Perspective { pixel_right, pixel_down },
                    Some(lens) => Model::ThinLens { pixel_right, pixel_down, lens },
                }
            }
            Projection::Orthographic { extent, across } => {
                let (pixel_right, pixel_down) = span(0.5 * extent / view.half_length(across));
                Model::Orthographic { pixel_right, pixel_down }
            }
            Projection::Fisheye { mapping, fov, across } => {
                let scale = DVec2::new(view.pixel_aspect, 1.0) / view.half_length(across);
                Model::Fisheye { mapping, scale, max_angle: 0.5 * fov }
            }
            Projection::Panorama => {
                let [width, height] = view.resolution.map(|pixels| f64::from(pixels.max(1)));
                Model::Panorama { step: DVec2::new(TAU / width, PI / height) }
            }
        };
        Camera { eye: view.eye, axes, model, resolution: view.resolution, filter }
    }

    /// A pinhole camera with square pixels. `fov` is the full angle across the shorter side of the image, radians, in
    /// (0, pi).
    pub fn perspective(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        fov: f64,
        resolution: [u32; 2],
        filter: ReconstructionFilter,
    ) -> Camera {
        let projection = Projection::Perspective { fov, across: Across::Shorter, lens: None };
        Camera::new(&View { eye, target, up, twist: 0.0, resolution, pixel_aspect: 1.0, projection }, filter)
    }

    /// Width and height in pixels.
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// Rays depend on where they cross the lens.
    #[inline]
    pub fn has_lens(&self) -> bool {
        matches!(self.model, Model::ThinLens { .. })
    }

    /// The ray through a point of the image and the middle of the lens; `None` outside of the field of view.
    #[inline]
    pub fn ray(&self, pixel: DVec2) -> Option<Ray> {
        match self.model {
            Model::ThinLens { pixel_right, pixel_down, .. } => {
                Some(Ray::new(self.eye, self.through(pixel, pixel_right, pixel_down).normalize()))
            }
            _ => self.sample_ray(pixel, [0.5; 2]).map(|sample| sample.ray),
        }
    }

    /// The ray through a point of the image and a point of the lens, uniform over its area for uniform `lens_u`.
    /// `None` outside of the field of view.
    #[inline]
    pub fn sample_ray(&self, pixel: DVec2, lens_u: [f64; 2]) -> Option<CameraRay> {
        let axes = &self.axes;
        let (origin, dir, horizontal) = match self.model {
            Model::Perspective { pixel_right, pixel_down } => {
                let dir = self.through(pixel, pixel_right, pixel_down).normalize();
                (self.eye, dir, axes.down.cross(dir).normalize())
            }
            Model::ThinLens { pixel_right, pixel_down, lens } => {
                let point = lens.sample(lens_u);
                let offset = axes.right * point.x + axes.down * point.y;
                let dir = (self.through(pixel, pixel_right, pixel_down) * lens.focus - offset).normalize();
                (self.eye + offset, dir, axes.down.cross(dir).normalize())
            }
            Model::Orthographic { pixel_right, pixel_down } => {
                let off = self.off_middle(pixel);
                (self.eye + pixel_right * off.x + pixel_down * off.y, axes.forward, axes.right)
            }
            Model::Fisheye { mapping, scale, max_angle } => {
                let at = self.off_middle(pixel) * scale;
                let (dir, horizontal) = axes.fisheye(at, mapping.angle(at.length(), max_angle)?);
                (self.eye, dir, horizontal)
            }
            Model::Panorama { step } => {
                let (sin, cos) = (self.off_middle(pixel).x * step.x).sin_cos();
                let (sin_polar, cos_polar) = (pixel.y * step.y).sin_cos();
                let dir = (axes.forward * cos + axes.right * sin) * sin_polar - axes.down * cos_polar;
                (self.eye, dir.normalize(), axes.right * cos - axes.forward * sin)
            }
        };
        Some(CameraRay { ray: Ray::new(origin, dir), horizontal })
    }

    #[inline]
    fn off_middle(&self, pixel: DVec2) -> DVec2 {
        pixel - DVec2::new(0.5 * f64::from(self.resolution[0]), 0.5 * f64::from(self.resolution[1]))
    }

    /// From the eye to the point of the plane at unit distance.
    #[inline]
    fn through(&self, pixel: DVec2, pixel_right: DVec3, pixel_down: DVec3) -> DVec3 {
        let off = self.off_middle(pixel);
        self.axes.forward + pixel_right * off.x + pixel_down * off.y
    }
}

impl Axes {
    /// The direction at an angle from the view axis, on the side of the picture where `at` lies, and the picture's
    /// horizontal carried there along the great circle.
    fn fisheye(&self, at: DVec2, angle: f64) -> (DVec3, DVec3) {
        let Some(side) = at.try_normalize() else { return (self.forward, self.right) };
        let outwards = self.right * side.x + self.down * side.y;
        let around = self.down * side.x - self.right * side.y;
        let (sin, cos) = angle.sin_cos();
        let dir = (self.forward * cos + outwards * sin).normalize();
        let away = outwards * cos - self.forward * sin;
        (dir, (away * side.x - around * side.y).normalize())
    }
}

impl FisheyeMapping {
    /// Angle from the view axis at a distance from the middle, the rim being at 1; `None` beyond the field of view.
    #[inline]
    fn angle(self, distance: f64, max_angle: f64) -> Option<f64> {
        let angle = match self {
            FisheyeMapping::Equidistant => distance * max_angle,
            FisheyeMapping::EqualArea => 2.0 * (distance * (0.5 * max_angle).sin()).min(1.0).asin(),
        };
        (distance <= 1.0).then_some(angle)
    }
}
