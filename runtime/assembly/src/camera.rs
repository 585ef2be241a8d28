//! The camera of the IR → the renderer's, and one for scenes without.

use arsc_geometry::{Aabb, DVec3};
use arsc_ir::{Filter, Projection};
use arsc_render::{Camera, FilterShape, ReconstructionFilter};

/// Pixels where nobody says otherwise.
const DEFAULT_RESOLUTION: [u32; 2] = [512, 512];

/// The renderer's camera; `resolution` overrides what the script says.
pub fn lower(camera: &arsc_ir::Camera, resolution: Option<[u32; 2]>) -> Camera {
    let Projection::Perspective { fov } = camera.projection;
    let filter = match camera.filter {
        Filter::Box { radius } => FilterShape::Box { radius },
        Filter::Tent { radius } => FilterShape::Tent { radius },
        Filter::Gaussian { radius, sigma } => FilterShape::Gaussian { radius, sigma },
        Filter::Mitchell { radius, b, c } => FilterShape::Mitchell { radius, b, c },
    };
    let filter = ReconstructionFilter::new(filter);
    Camera::perspective(camera.eye, camera.target, camera.up, fov, resolution.unwrap_or(camera.resolution), filter)
}

/// A camera that sees all of `bounds` from the front, somewhat from the right and above. Where the bounds are empty or
/// not finite, it looks at the unit box around the origin.
pub fn framing(bounds: &Aabb) -> arsc_ir::Camera {
    let unit = Aabb::new(DVec3::splat(-1.0), DVec3::ONE);
    let usable = !bounds.is_empty() && bounds.is_finite() && bounds.extent().max_element() > 0.0;
    let bounds = if usable { bounds } else { &unit };
    let fov = 40f64.to_radians();
    let radius = 0.5 * bounds.extent().length();
    let distance = 1.05 * radius / (0.5 * fov).sin();
    let target = bounds.center();
    arsc_ir::Camera {
        projection: Projection::Perspective { fov },
        eye: target + DVec3::new(0.45, -1.0, 0.55).normalize() * distance,
        target,
        up: DVec3::Z,
        resolution: DEFAULT_RESOLUTION,
        filter: Filter::Gaussian { radius: 1.5, sigma: 0.5 },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arsc_geometry::{DAffine3, DMat3};

    #[test]
    fn all_corners_are_in_the_picture() {
        for bounds in [
            Aabb::new(DVec3::new(-3.0, 5.0, 100.0), DVec3::new(4.0, 5.5, 1e3)),
            Aabb::new(DVec3::splat(1e-4), DVec3::splat(2e-4)),
            Aabb::EVERYTHING,
            Aabb::EMPTY,
        ] {
            let camera = framing(&bounds);
            let Projection::Perspective { fov } = camera.projection;
            let forward = (camera.target - camera.eye).normalize();
            let right = forward.cross(camera.up).normalize();
            let frame =
                DAffine3::from_mat3_translation(DMat3::from_cols(right, right.cross(forward), forward), camera.eye)
                    .inverse();
            let corners = if bounds.is_finite() { bounds.corners() } else { [camera.target; 8] };
            for corner in corners {
                let p = frame.transform_point3(corner);
                let edge = (0.5 * fov).tan() * p.z;
                assert!(p.z > 0.0 && p.x.abs() <= edge && p.y.abs() <= edge, "{bounds:?} {p}");
            }
        }
    }
}
