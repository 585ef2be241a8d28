//! Directions against their formulas, solid angles, the circle of confusion, and fitting.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use arsc_geometry::Aabb;

use super::*;
use crate::filter::FilterShape;

fn view(resolution: [u32; 2], projection: Projection) -> View {
    View {
        eye: DVec3::new(1.0, -5.0, 2.0),
        target: DVec3::new(1.0, 0.0, 2.0),
        up: DVec3::Z,
        twist: 0.0,
        resolution,
        pixel_aspect: 1.0,
        projection,
    }
}

fn camera(view: &View) -> Camera {
    Camera::new(view, ReconstructionFilter::new(FilterShape::default()))
}

fn pinhole(resolution: [u32; 2]) -> View {
    view(resolution, Projection::Perspective { fov: 1.0, across: Across::Shorter, lens: None })
}

fn fisheye(mapping: FisheyeMapping, fov: f64) -> Projection {
    Projection::Fisheye { mapping, fov, across: Across::Shorter }
}

fn dir(camera: &Camera, x: f64, y: f64) -> DVec3 {
    camera.ray(DVec2::new(x, y)).expect("a ray").dir
}

fn all_projections() -> [Projection; 6] {
    let lens = Some(Lens { radius: 0.1, focus: 4.0, blades: 6, rotation: 0.2 });
    [
        Projection::Perspective { fov: 1.0, across: Across::Shorter, lens: None },
        Projection::Perspective { fov: 1.0, across: Across::Diagonal, lens },
        Projection::Orthographic { extent: 3.0, across: Across::Vertical },
        fisheye(FisheyeMapping::Equidistant, 1.5 * PI),
        fisheye(FisheyeMapping::EqualArea, TAU),
        Projection::Panorama,
    ]
}

#[test]
fn x_goes_right_and_y_goes_down_in_every_camera() {
    for projection in all_projections() {
        let c = camera(&view([400, 200], projection));
        let at = |x, y| {
            let ray = c.ray(DVec2::new(x, y)).expect("a ray");
            // The origin tells for parallel rays, the direction for the others.
            (ray.dir - DVec3::Y) * 1e3 + ray.origin
        };
        let middle = at(200.0, 100.0);
        assert!(c.ray(DVec2::new(200.0, 100.0)).unwrap().dir.distance(DVec3::Y) < 1e-12, "{projection:?}");
        assert!(at(210.0, 100.0).x > middle.x && at(200.0, 110.0).z < middle.z, "{projection:?}");
    }
}

#[test]
fn reference_frames_are_unit_and_across_the_ray_and_point_to_the_right() {
    for projection in all_projections() {
        let c = camera(&view([400, 200], projection));
        for pixel in [[200.0, 100.0], [239.0, 31.0], [150.0, 140.0]] {
            let CameraRay { ray, horizontal } = c.sample_ray(pixel.into(), [0.3, 0.8]).expect("a ray");
            assert!((horizontal.length() - 1.0).abs() < 1e-12 && horizontal.dot(ray.dir).abs() < 1e-12);
            assert!(horizontal.x > 0.2, "{projection:?}: {horizontal}");
            assert!((ray.dir.length() - 1.0).abs() < 1e-12);
            let level = !matches!(projection, Projection::Fisheye { .. });
            assert!(!level || horizontal.z.abs() < 1e-12, "{projection:?}: {horizontal}");
        }
    }
}

#[test]
fn the_field_of_view_is_that_across_what_it_refers_to() {
    for (resolution, aspect) in [([400, 200], 1.0), ([200, 400], 1.0), ([300, 300], 2.0)] {
        let (width, height) = (f64::from(resolution[0]), f64::from(resolution[1]));
        let [left, right] = [[0.0, 0.5 * height], [width, 0.5 * height]];
        let [top, bottom] = [[0.5 * width, 0.0], [0.5 * width, height]];
        let shorter = if width * aspect < height { [left, right] } else { [top, bottom] };
        for (across, [a, b]) in [
            (Across::Shorter, shorter),
            (Across::Horizontal, [left, right]),
            (Across::Vertical, [top, bottom]),
            (Across::Diagonal, [[0.0, 0.0], [width, height]]),
        ] {
            let projection = Projection::Perspective { fov: 1.0, across, lens: None };
            let c = camera(&View { pixel_aspect: aspect, ..view(resolution, projection) });
            let angle = dir(&c, a[0], a[1]).angle_between(dir(&c, b[0], b[1]));
            assert!((angle - 1.0).abs() < 1e-12, "{across:?} of {resolution:?} at {aspect}: {angle}");
        }
    }
}

#[test]
fn a_twist_turns_the_picture_against_it() {
    let c = camera(&View { twist: FRAC_PI_2, ..pinhole([200, 200]) });
    // Turned clockwise by a quarter, the camera's right side looks down.
    assert!(dir(&c, 200.0, 100.0).z < -0.4 && dir(&c, 100.0, 200.0).x < -0.4);
}

#[test]
fn looking_along_up_gives_a_frame_all_the_same() {
    for projection in all_projections() {
        let c = camera(&View { eye: DVec3::Z, target: DVec3::ZERO, ..view([10, 10], projection) });
        let ray = c.sample_ray(DVec2::new(4.0, 4.0), [0.1, 0.2]).expect("a ray");
        assert!(ray.ray.dir.is_finite() && (ray.ray.dir.length() - 1.0).abs() < 1e-12 && ray.horizontal.is_finite());
    }
}

#[test]
fn fisheyes_follow_their_formulas() {
    for (mapping, fov) in [
        (FisheyeMapping::Equidistant, PI),
        (FisheyeMapping::Equidistant, TAU),
        (FisheyeMapping::EqualArea, PI),
        (FisheyeMapping::EqualArea, 1.9 * PI),
    ] {
        let c = camera(&view([300, 200], fisheye(mapping, fov)));
        for r in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let angle = dir(&c, 150.0 + 60.0 * r, 100.0 + 80.0 * r).angle_between(DVec3::Y);
            let expected = match mapping {
                FisheyeMapping::Equidistant => 0.5 * fov * r,
                FisheyeMapping::EqualArea => 2.0 * (r * (0.25 * fov).sin()).asin(),
            };
            assert!((angle - expected).abs() < 1e-7, "{mapping:?}, {fov}, {r}: {angle} instead of {expected}");
        }
        assert!(c.ray(DVec2::new(251.0, 100.0)).is_none(), "outside of the circle");
    }
}

/// The solid angle of a pixel by the cross product of the differences of directions, summed over all pixels.
fn solid_angle(camera: &Camera, weight: impl Fn(DVec3) -> f64) -> f64 {
    let [width, height] = camera.resolution();
    let mut sum = 0.0;
    for i in 0..width * height {
        let (x, y) = (f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        let h = 0.01;
        let at = |dx: f64, dy: f64| camera.ray(DVec2::new(x + dx, y + dy)).map(|ray| ray.dir);
        if let (Some(a), Some(b), Some(c), Some(d), Some(middle)) =
            (at(-h, 0.0), at(h, 0.0), at(0.0, -h), at(0.0, h), at(0.0, 0.0))
        {
            sum += (b - a).cross(d - c).length() / (4.0 * h * h) * weight(middle);
        }
    }
    sum
}

/// Solid angles add up: the rectangle of a perspective camera, the cap of a fisheye, the whole sphere of a panorama,
/// whose upper half has the projected solid angle pi: a uniform radiance L gives the irradiance pi L. Midpoints: the
/// rim of fisheyes limits the accuracy to the share of pixels on it.
#[test]
fn solid_angles_add_up() {
    let c = camera(&view([120, 60], Projection::Perspective { fov: 1.0, across: Across::Vertical, lens: None }));
    let (a, b) = (2.0 * 0.5f64.tan(), 0.5f64.tan());
    // Of the rectangle with half sides a and b at unit distance.
    let exact = 4.0 * (a * b / ((1.0 + a * a) * (1.0 + b * b)).sqrt()).asin();
    assert!((solid_angle(&c, |_| 1.0) / exact - 1.0).abs() < 1e-3);
    for (mapping, fov) in [(FisheyeMapping::Equidistant, PI), (FisheyeMapping::EqualArea, 1.5 * PI)] {
        let c = camera(&view([300, 300], fisheye(mapping, fov)));
        let exact = TAU * (1.0 - (0.5 * fov).cos());
        assert!((solid_angle(&c, |_| 1.0) / exact - 1.0).abs() < 0.01, "{mapping:?}");
    }
    let c = camera(&view([200, 100], Projection::Panorama));
    assert!((solid_angle(&c, |_| 1.0) / (4.0 * PI) - 1.0).abs() < 1e-3);
    assert!((solid_angle(&c, |d| d.z.max(0.0)) / PI - 1.0).abs() < 1e-3);
}

#[test]
fn equal_area_means_equal_solid_angles() {
    let c = camera(&view([200, 200], fisheye(FisheyeMapping::EqualArea, PI)));
    let of = |x: f64, y: f64| {
        let at = |dx: f64, dy: f64| dir(&c, x + dx, y + dy);
        (at(0.01, 0.0) - at(-0.01, 0.0)).cross(at(0.0, 0.01) - at(0.0, -0.01)).length()
    };
    let middle = of(100.3, 100.2);
    for (x, y) in [(150.0, 100.0), (100.0, 12.0), (60.0, 170.0)] {
        assert!((of(x, y) / middle - 1.0).abs() < 1e-3);
    }
}

#[test]
fn panoramas_keep_the_pole_on_top_and_wrap_around() {
    let tilted = View { target: DVec3::new(1.0, 0.0, 6.0), ..view([200, 100], Projection::Panorama) };
    let c = camera(&tilted);
    assert!(dir(&c, 100.0, 50.0).distance(DVec3::Y) < 1e-12, "the middle is level");
    assert!(dir(&c, 77.0, 0.0).distance(DVec3::Z) < 1e-12);
    assert!(dir(&c, 150.0, 50.0).distance(DVec3::X) < 1e-12, "right of the middle by a quarter");
    assert!(dir(&c, -3.0, 20.0).distance(dir(&c, 197.0, 20.0)) < 1e-12);
}

#[test]
fn orthographic_rays_are_parallel_and_span_the_extent() {
    let c = camera(&View {
        pixel_aspect: 2.0,
        ..view([100, 50], Projection::Orthographic { extent: 3.0, across: Across::Vertical })
    });
    let ray = |x, y| c.ray(DVec2::new(x, y)).unwrap();
    let (a, b) = (ray(0.0, 0.0), ray(100.0, 50.0));
    assert_eq!(a.dir, b.dir);
    assert!((b.origin - a.origin - DVec3::new(12.0, 0.0, -3.0)).length() < 1e-12);
}

/// A point at distance d is seen through every point of the lens in a circle about its own place, of radius
/// A |d - f| / d on the plane in focus f: the circle of confusion, r = A |d - f| / (d f) at unit distance.
#[test]
fn the_circle_of_confusion_has_its_radius() {
    let (radius, focus) = (0.1, 4.0);
    let lens = Lens { radius, focus, blades: 0, rotation: 0.0 };
    let projection = Projection::Perspective { fov: 1.0, across: Across::Shorter, lens: Some(lens) };
    let view = view([200, 200], projection);
    let c = camera(&view);
    let per_pixel = 0.5f64.tan() / 100.0;
    for distance in [1.0, 2.0, 4.0, 10.0] {
        // Where rays through one pixel cross the plane of the point, in pixels off the pixel's own place there.
        let mut largest = 0.0f64;
        for i in 0..64 {
            let u = [(f64::from(i % 8) + 0.5) / 8.0, f64::from(i / 8) / 7.0 * (1.0 - 1e-9)];
            let ray = c.sample_ray(DVec2::new(120.0, 90.0), u).unwrap().ray;
            let crossing = ray.origin + ray.dir * (distance / ray.dir.y) - view.eye;
            assert!((crossing.y - distance).abs() < 1e-9);
            let ideal = c.ray(DVec2::new(120.0, 90.0)).unwrap().dir;
            let off = (crossing - ideal * (distance / ideal.y)) / (distance * per_pixel);
            largest = largest.max(off.length());
        }
        let exact = radius * (distance - focus).abs() / (distance * focus) / per_pixel;
        assert!(largest <= exact * (1.0 + 1e-9) + 1e-9 && largest >= 0.9 * exact, "{distance}: {largest} of {exact}");
    }
}

#[test]
fn a_lens_of_no_size_is_a_pinhole() {
    let lens = Lens { radius: 0.0, focus: 1.0, blades: 5, rotation: 0.0 };
    let c = camera(&view([20, 20], Projection::Perspective { fov: 1.0, across: Across::Shorter, lens: Some(lens) }));
    assert!(!c.has_lens());
}

#[test]
fn fitted_views_hold_the_box_and_touch_its_corners() {
    let bounds = [
        Aabb::new(DVec3::new(-3.0, 5.0, 100.0), DVec3::new(4.0, 5.5, 1e3)),
        Aabb::new(DVec3::splat(1e-4), DVec3::splat(2e-4)),
    ];
    let across = Across::Diagonal;
    for projection in
        [Projection::Perspective { fov: 0.7, across, lens: None }, Projection::Orthographic { extent: 1.0, across }]
    {
        for bounds in bounds {
            let base = View { target: DVec3::new(3.0, 1.0, -1.0), twist: 0.4, ..view([300, 200], projection) };
            let fitted = base.fitted(&bounds, 0.1).expect("a view");
            let axes = fitted.axes();
            let (mut largest, half) = (0.0f64, fitted.half_size());
            for corner in bounds.corners() {
                let p = corner - fitted.eye;
                let depth = p.dot(axes.forward);
                let slope = match fitted.projection {
                    Projection::Perspective { fov, .. } => depth * (0.5 * fov).tan(),
                    Projection::Orthographic { extent, .. } => 0.5 * extent,
                    _ => unreachable!(),
                } / fitted.half_length(across);
                assert!(depth > 0.0);
                largest = largest.max((p.dot(axes.right) / (slope * half.x)).abs());
                largest = largest.max((p.dot(axes.down) / (slope * half.y)).abs());
            }
            assert!((largest - 0.9).abs() < 1e-9, "{projection:?}: {largest}");
        }
    }
    assert!(view([10, 10], Projection::Panorama).fitted(&bounds[0], 0.0).is_none());
}
