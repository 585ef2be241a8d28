//! The camera of the IR → the renderer's, and one for scenes without.

use arsc_geometry::{Aabb, DVec3};
use arsc_ir::{Across, Filter, FisheyeMapping, Focus, Projection};
use arsc_render::{self as render, Camera, FilterShape, ReconstructionFilter, View};

/// Pixels where nobody says otherwise.
const DEFAULT_RESOLUTION: [u32; 2] = [512, 512];

/// The camera's place follows from the scene.
pub fn needs_bounds(camera: &arsc_ir::Camera) -> bool {
    camera.target.is_none() || camera.fit.is_some()
}

/// The renderer's camera, and the pixels that it crops the picture to; `resolution` overrides what the script says.
/// `bounds` are those of the scene, for [`needs_bounds`].
pub fn lower(camera: &arsc_ir::Camera, resolution: Option<[u32; 2]>, bounds: &Aabb) -> (Camera, Option<[u32; 4]>) {
    let resolution = resolution.unwrap_or(camera.resolution);
    let bounds = usable(bounds);
    let target = camera.target.unwrap_or(bounds.center());
    let view = View {
        eye: camera.eye,
        target,
        up: camera.up,
        twist: camera.twist,
        resolution,
        pixel_aspect: camera.pixel_aspect,
        projection: projection(&camera.projection),
    };
    let mut view = camera.fit.and_then(|margin| view.fitted(&bounds, margin)).unwrap_or(view);
    if let (Projection::ThinLens { lens, .. }, render::Projection::Perspective { lens: Some(built), .. }) =
        (&camera.projection, &mut view.projection)
    {
        built.focus = focus_distance(lens.focus, view.eye, view.target);
    }
    let camera_crop = camera.crop.map(|crop| crop_pixels(crop, resolution));
    (Camera::new(&view, ReconstructionFilter::new(filter(&camera.filter))), camera_crop)
}

fn filter(filter: &Filter) -> FilterShape {
    match *filter {
        Filter::Box { radius } => FilterShape::Box { radius },
        Filter::Tent { radius } => FilterShape::Tent { radius },
        Filter::Gaussian { radius, sigma } => FilterShape::Gaussian { radius, sigma },
        Filter::Mitchell { radius, b, c } => FilterShape::Mitchell { radius, b, c },
        Filter::Lanczos { radius } => FilterShape::Lanczos { radius },
    }
}

fn across(across: Across) -> render::Across {
    match across {
        Across::Shorter => render::Across::Shorter,
        Across::Horizontal => render::Across::Horizontal,
        Across::Vertical => render::Across::Vertical,
        Across::Diagonal => render::Across::Diagonal,
    }
}

/// The distance of the focus is set later, once the camera stands.
fn projection(projection: &Projection) -> render::Projection {
    match *projection {
        Projection::Perspective { fov, across: of } => {
            render::Projection::Perspective { fov, across: across(of), lens: None }
        }
        Projection::ThinLens { fov, across: of, lens } => {
            let lens = render::Lens { radius: lens.radius, focus: 1.0, blades: lens.blades, rotation: lens.rotation };
            render::Projection::Perspective { fov, across: across(of), lens: Some(lens) }
        }
        Projection::Orthographic { extent, across: of } => {
            render::Projection::Orthographic { extent, across: across(of) }
        }
        Projection::Fisheye { mapping, fov, across: of } => {
            let mapping = match mapping {
                FisheyeMapping::Equidistant => render::FisheyeMapping::Equidistant,
                FisheyeMapping::EqualArea => render::FisheyeMapping::EqualArea,
            };
            render::Projection::Fisheye { mapping, fov, across: across(of) }
        }
        Projection::Panorama => render::Projection::Panorama,
    }
}

/// Along the view axis; a point behind the camera or beside it counts as the target.
fn focus_distance(focus: Focus, eye: DVec3, target: DVec3) -> f64 {
    let to_target = eye.distance(target);
    let distance = match focus {
        Focus::Distance(distance) => distance,
        Focus::Target => to_target,
        Focus::Point(point) => (point - eye).dot((target - eye).normalize_or_zero()),
    };
    if distance > 0.0 { distance } else { to_target.max(f64::MIN_POSITIVE) }
}

/// Whole pixels, one at least, of shares of the picture.
fn crop_pixels([left, top, right, bottom]: [f64; 4], [width, height]: [u32; 2]) -> [u32; 4] {
    let span = |from: f64, to: f64, pixels: u32| {
        let first = ((from * f64::from(pixels)).round() as u32).min(pixels.saturating_sub(1));
        (first, ((to * f64::from(pixels)).round() as u32).clamp(first + 1, pixels.max(1)))
    };
    let ((x0, x1), (y0, y1)) = (span(left, right, width), span(top, bottom, height));
    [x0, y0, x1, y1]
}

/// The unit box about the origin where bounds are empty, infinite or a point.
fn usable(bounds: &Aabb) -> Aabb {
    let usable = !bounds.is_empty() && bounds.is_finite() && bounds.extent().max_element() > 0.0;
    if usable { *bounds } else { Aabb::new(DVec3::splat(-1.0), DVec3::ONE) }
}

/// A camera that sees all of `bounds` from the front, somewhat from the right and above. Where the bounds are empty or
/// not finite, it looks at the unit box around the origin.
pub fn framing(bounds: &Aabb) -> arsc_ir::Camera {
    let bounds = usable(bounds);
    let fov = 40f64.to_radians();
    let radius = 0.5 * bounds.extent().length();
    let distance = 1.05 * radius / (0.5 * fov).sin();
    let target = bounds.center();
    arsc_ir::Camera {
        projection: Projection::Perspective { fov, across: Across::Shorter },
        eye: target + DVec3::new(0.45, -1.0, 0.55).normalize() * distance,
        target: Some(target),
        up: DVec3::Z,
        twist: 0.0,
        fit: None,
        resolution: DEFAULT_RESOLUTION,
        pixel_aspect: 1.0,
        crop: None,
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
            let Projection::Perspective { fov, .. } = camera.projection else { panic!("{camera:?}") };
            let target = camera.target.expect("a target");
            let forward = (target - camera.eye).normalize();
            let right = forward.cross(camera.up).normalize();
            let frame =
                DAffine3::from_mat3_translation(DMat3::from_cols(right, right.cross(forward), forward), camera.eye)
                    .inverse();
            let corners = if bounds.is_finite() { bounds.corners() } else { [target; 8] };
            for corner in corners {
                let p = frame.transform_point3(corner);
                let edge = (0.5 * fov).tan() * p.z;
                assert!(p.z > 0.0 && p.x.abs() <= edge && p.y.abs() <= edge, "{bounds:?} {p}");
            }
        }
    }
    fn script_camera(projection: Projection) -> arsc_ir::Camera {
        arsc_ir::Camera { projection, ..framing(&Aabb::EMPTY) }
    }

    #[test]
    fn crops_are_whole_pixels_at_every_resolution() {
        assert_eq!(crop_pixels([0.0, 0.25, 0.5, 1.0], [100, 40]), [0, 10, 50, 40]);
        assert_eq!(crop_pixels([0.999, 0.0, 1.0, 1e-9], [10, 10]), [9, 0, 10, 1]);
        assert_eq!(crop_pixels([0.2, 0.2, 0.3, 0.3], [1, 1]), [0, 0, 1, 1]);
        let camera = arsc_ir::Camera { crop: Some([0.5, 0.0, 1.0, 1.0]), ..framing(&Aabb::EMPTY) };
        assert_eq!(lower(&camera, Some([64, 32]), &Aabb::EMPTY).1, Some([32, 0, 64, 32]));
    }

    #[test]
    fn the_focus_is_measured_along_the_view_axis() {
        let (eye, target) = (DVec3::ZERO, DVec3::new(0.0, 5.0, 0.0));
        assert_eq!(focus_distance(Focus::Target, eye, target), 5.0);
        assert_eq!(focus_distance(Focus::Distance(2.0), eye, target), 2.0);
        assert_eq!(focus_distance(Focus::Point(DVec3::new(9.0, 3.0, 1.0)), eye, target), 3.0);
        assert_eq!(focus_distance(Focus::Point(DVec3::new(9.0, -3.0, 1.0)), eye, target), 5.0, "behind the camera");
    }

    #[test]
    fn cameras_find_the_scene() {
        let bounds = Aabb::new(DVec3::new(10.0, 20.0, 0.0), DVec3::new(14.0, 22.0, 2.0));
        let fov = 0.6;
        let mut camera = script_camera(Projection::Perspective { fov, across: Across::Diagonal });
        camera.target = None;
        assert!(needs_bounds(&camera));
        let middle = lower(&camera, None, &bounds).0.ray(glam::DVec2::splat(256.0)).expect("a ray");
        let to_center = bounds.center() - middle.origin;
        assert!(middle.dir.cross(to_center).length() < 1e-9 && middle.dir.dot(to_center) > 0.0);
        camera.fit = Some(0.0);
        let fitted = lower(&camera, None, &bounds).0;
        let eye = fitted.ray(glam::DVec2::ZERO).expect("a ray").origin;
        assert!(eye.distance(bounds.center()) < 20.0, "{eye}");
    }
}
