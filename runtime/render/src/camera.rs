//! Cameras.
//!
//! World frame right-handed. Pixel coordinates are continuous, x to the right and y downwards, with the upper left
//! corner of the image at (0, 0). A pixel's value is the radiance along its rays, not weighted by any cosine.

use arsc_geometry::Ray;
use glam::{DVec2, DVec3};

use crate::filter::ReconstructionFilter;
use crate::frame::Frame;

/// A pinhole at `eye` that looks at `target`.
#[derive(Clone, Debug)]
pub struct Camera {
    eye: DVec3,
    /// View axis, and the world vectors that one pixel spans at unit distance along it.
    forward: DVec3,
    pixel_right: DVec3,
    pixel_down: DVec3,
    resolution: [u32; 2],
    pub filter: ReconstructionFilter,
}

impl Camera {
    /// A perspective camera. `fov` is the full angle across the shorter side of the image, radians, in (0, pi).
    /// Where `up` is parallel to the view axis, or `eye` equals `target`, an arbitrary direction takes its place.
    pub fn perspective(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        fov: f64,
        resolution: [u32; 2],
        filter: ReconstructionFilter,
    ) -> Camera {
        let forward = (target - eye).normalize_or(DVec3::Y);
        let frame = Frame::new(forward);
        let right = forward.cross(up).try_normalize().unwrap_or(frame.x);
        let down = forward.cross(right);
        let pixel = 2.0 * (0.5 * fov).tan() / f64::from(resolution[0].min(resolution[1]).max(1));
        Camera { eye, forward, pixel_right: right * pixel, pixel_down: down * pixel, resolution, filter }
    }

    /// Width and height in pixels.
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// The ray through a point of the image.
    #[inline]
    pub fn ray(&self, pixel: DVec2) -> Ray {
        let x = pixel.x - 0.5 * f64::from(self.resolution[0]);
        let y = pixel.y - 0.5 * f64::from(self.resolution[1]);
        Ray::new(self.eye, (self.forward + self.pixel_right * x + self.pixel_down * y).normalize())
    }

    /// The x axis of a ray's reference frame: across the ray and the picture's vertical, to the right.
    #[inline]
    pub fn horizontal(&self, ray: &Ray) -> DVec3 {
        self.pixel_down.cross(ray.dir).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::FilterShape;

    fn camera(resolution: [u32; 2]) -> Camera {
        let filter = ReconstructionFilter::new(FilterShape::default());
        Camera::perspective(DVec3::new(1.0, -5.0, 2.0), DVec3::new(1.0, 0.0, 2.0), DVec3::Z, 1.0, resolution, filter)
    }

    #[test]
    fn x_goes_right_and_y_goes_down() {
        let c = camera([400, 200]);
        assert!((c.ray(DVec2::new(200.0, 100.0)).dir - DVec3::Y).length() < 1e-12);
        assert!(c.ray(DVec2::new(399.0, 100.0)).dir.x > 0.0);
        assert!(c.ray(DVec2::new(200.0, 199.0)).dir.z < 0.0);
    }

    #[test]
    fn reference_frames_are_level_and_point_to_the_right() {
        let c = camera([400, 200]);
        for pixel in [DVec2::new(200.0, 100.0), DVec2::new(399.0, 3.0), DVec2::new(10.0, 180.0)] {
            let ray = c.ray(pixel);
            let x = c.horizontal(&ray);
            assert!(x.z.abs() < 1e-12 && x.dot(ray.dir).abs() < 1e-12 && x.x > 0.5 && (x.length() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_shorter_side_spans_the_field_of_view() {
        for (resolution, a, b) in [
            ([400, 200], DVec2::new(200.0, 0.0), DVec2::new(200.0, 200.0)),
            ([200, 400], DVec2::new(0.0, 200.0), DVec2::new(200.0, 200.0)),
        ] {
            let c = camera(resolution);
            let angle = c.ray(a).dir.angle_between(c.ray(b).dir);
            assert!((angle - 1.0).abs() < 1e-12, "{resolution:?}: {angle}");
        }
    }

    #[test]
    fn looking_along_up_gives_a_frame_all_the_same() {
        let filter = ReconstructionFilter::new(FilterShape::default());
        let c = Camera::perspective(DVec3::Z, DVec3::ZERO, DVec3::Z, 1.0, [10, 10], filter);
        let ray = c.ray(DVec2::new(0.0, 0.0));
        assert!(ray.dir.is_finite() && (ray.dir.length() - 1.0).abs() < 1e-12 && ray.dir.z < 0.0);
    }
}
