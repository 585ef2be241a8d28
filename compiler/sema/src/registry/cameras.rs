//! Cameras.

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Across, Camera, Filter, FisheyeMapping, Focus, Lens, Projection};

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Type::{self, Angle, Float, Int, Point, Vec3};
use crate::value::Value;

/// Pixels along one side.
const MAX_RESOLUTION: f64 = 65_536.0;

/// A camera with parameters of its own after those that say where it stands. What all share comes last.
fn placed(name: &'static str, doc: &'static str, own: Vec<Param>) -> Builtin {
    let filter = Filter::Gaussian { radius: 1.5, sigma: 0.5 };
    let resolution = Value::Tuple([Value::Int(512), Value::Int(512)].into());
    let whole = Value::Tuple([0.0, 0.0, 1.0, 1.0].map(Value::Float).into());
    let mut builtin = Builtin::new(name, doc)
        .param(Param::new("eye", Point, "where the camera is"))
        .param(
            Param::new("target", Point, "what is in the middle of the picture; without it, the middle of the scene")
                .optional(),
        )
        .param(Param::new("up", Vec3, "upwards in the picture").vec3([0.0, 0.0, 1.0]));
    builtin.params.extend(own);
    builtin
        .param(
            Param::new("resolution", Type::tuple([Int, Int]), "width and height, pixels")
                .default_value("(512, 512)", resolution)
                .within(1.0, MAX_RESOLUTION),
        )
        .param(
            Param::new("filter", Type::Filter, "reconstruction filter")
                .default_value("gaussian()", Value::Filter(filter.into())),
        )
        .param(Param::new("twist", Angle, "turns the camera clockwise about its view axis").degrees(0.0))
        .param(Param::new("pixel_aspect", Float, "width of a pixel over its height").float(1.0).within(1e-3, 1e3))
        .param(
            Param::new(
                "crop",
                Type::tuple([Float, Float, Float, Float]),
                "left, top, right and bottom of what is rendered, as shares of the picture; the rest stays black",
            )
            .default_value("(0, 0, 1, 1)", whole)
            .within(0.0, 1.0),
        )
}

/// Parameters before and after those that a camera has for itself.
const BEFORE: usize = 3;

fn fov() -> Param {
    Param::new("fov", Angle, "full angle of the field of view").degrees(40.0).degrees_between(0.0, 180.0)
}

fn across(of: &'static str) -> Param {
    Param::new("across", Type::Across, of).default_value("shorter", Value::Across(Across::Shorter))
}

const FOV_OF: &str = "what `fov` refers to: the `shorter` side, the `horizontal` or `vertical` one, or the `diagonal`";

pub fn builtins() -> Vec<Builtin> {
    vec![
        placed("perspective", "A pinhole camera.", vec![fov(), across(FOV_OF)]).runs(Type::Camera, |_, a, site| {
            camera(Projection::Perspective { fov: a[BEFORE].as_float(), across: a[BEFORE + 1].as_across() }, 2, a, site)
        }),
        thin_lens(),
        placed(
            "orthographic",
            "A camera with parallel rays, which leave from the plane through `eye`.",
            vec![
                Param::new("extent", Float, "length that the picture shows").float(2.0).positive(),
                across("what `extent` refers to"),
            ],
        )
        .runs(Type::Camera, |_, a, site| {
            let projection =
                Projection::Orthographic { extent: a[BEFORE].as_float(), across: a[BEFORE + 1].as_across() };
            camera(projection, 2, a, site)
        }),
        placed(
            "fisheye",
            "A fisheye. What lies beyond its field of view stays black.",
            vec![
                Param::new("fov", Angle, "full angle of the field of view").degrees(180.0).degrees_up_to(360.0),
                across(FOV_OF),
                Param::new("mapping", Type::FisheyeMapping, "`equidistant`: distances in proportion to angles; `equal_area`: areas in proportion to solid angles")
                    .default_value("equidistant", Value::FisheyeMapping(FisheyeMapping::Equidistant)),
            ],
        )
        .runs(Type::Camera, |_, a, site| {
            let (fov, across) = (a[BEFORE].as_float(), a[BEFORE + 1].as_across());
            camera(Projection::Fisheye { mapping: a[BEFORE + 2].as_fisheye_mapping(), fov, across }, 3, a, site)
        }),
        placed(
            "panorama",
            "All directions: azimuth across the width, angle from `up` along the height. In the middle is the direction of `target`, made level. Pictures twice as wide as high have square pixels at the horizon.",
            vec![],
        )
        .runs(Type::Camera, |_, a, site| camera(Projection::Panorama, 0, a, site)),
        Builtin::new("fit", "The camera moved along its view axis until all of the bounded scene is in its picture, aimed at the scene's middle. Keeps the field of view of `perspective` and `thin_lens`, and sets the extent of `orthographic`.")
            .param(Param::new("view", Type::Camera, "perspective, thin_lens or orthographic"))
            .param(Param::new("margin", Float, "share of the picture that stays free at its edges").float(0.05).within(0.0, 0.9))
            .runs(Type::Camera, fit),
    ]
}

fn thin_lens() -> Builtin {
    let own = vec![
        fov(),
        across(FOV_OF),
        Param::new("aperture", Float, "radius of the aperture, or of the circle through its corners")
            .float(0.01)
            .non_negative(),
        Param::new("focus", Float, "distance of the plane in focus along the view axis; without it, that of `target`")
            .positive()
            .optional(),
        Param::new("focus_on", Point, "a point that is in focus, in place of `focus`").optional(),
        Param::new("blades", Int, "corners of the aperture, from 3 on; 0 for a disk").int(0).within(0.0, 64.0),
        Param::new("rotation", Angle, "of the aperture's corners, clockwise; at 0 one is on top").degrees(0.0),
    ];
    placed("thin_lens", "A camera with depth of field.", own).runs(Type::Camera, |_, a, site| {
        let focus = match (&a[BEFORE + 3], &a[BEFORE + 4]) {
            (Value::Missing, Value::Missing) => Focus::Target,
            (distance, Value::Missing) => Focus::Distance(distance.as_float()),
            (Value::Missing, point) => Focus::Point(point.as_vec3()),
            _ => {
                let message = "`focus` and `focus_on` both say where the plane in focus is";
                return Err(site.fail_arg(BEFORE + 4, codes::OUT_OF_RANGE, message, "leave out one of them"));
            }
        };
        let blades = a[BEFORE + 5].as_int() as u32;
        if matches!(blades, 1 | 2) {
            let message = format!("an aperture of {blades} corners has no area");
            return Err(site.fail_arg(BEFORE + 5, codes::OUT_OF_RANGE, message, "three at least, or 0 for a disk"));
        }
        let lens = Lens { radius: a[BEFORE + 2].as_float(), blades, rotation: a[BEFORE + 6].as_float(), focus };
        let (fov, across) = (a[BEFORE].as_float(), a[BEFORE + 1].as_across());
        camera(Projection::ThinLens { fov, across, lens }, 7, a, site)
    })
}

/// A camera from its arguments, `own` of which belong to the projection.
fn camera(projection: Projection, own: usize, a: &[Value], site: &Site) -> Eval {
    let (eye, up) = (a[0].as_vec3(), a[2].as_vec3());
    let target = if matches!(a[1], Value::Missing) { None } else { Some(a[1].as_vec3()) };
    if let Some(target) = target {
        check_axes(eye, target, up, site)?;
    } else if up.try_normalize().is_none() {
        return Err(site.fail_arg(2, codes::OUT_OF_RANGE, "`up` must not be zero", "no direction"));
    }
    let shared = &a[BEFORE + own..];
    let size = shared[0].as_tuple();
    let crop: Vec<f64> = shared[4].as_tuple().iter().map(Value::as_float).collect();
    let [left, top, right, bottom] = [crop[0], crop[1], crop[2], crop[3]];
    if left >= right || top >= bottom {
        let message = "the crop is empty: left must be less than right, and top less than bottom";
        return Err(site.fail_arg(BEFORE + own + 4, codes::OUT_OF_RANGE, message, "left, top, right, bottom"));
    }
    let crop = [left, top, right, bottom];
    let camera = Camera {
        projection,
        eye,
        target,
        up,
        twist: shared[2].as_float(),
        fit: None,
        resolution: [size[0].as_int() as u32, size[1].as_int() as u32],
        pixel_aspect: shared[3].as_float(),
        crop: (crop != [0.0, 0.0, 1.0, 1.0]).then_some(crop),
        filter: shared[1].as_filter(),
    };
    Ok(Value::Camera(camera.into()))
}

/// The view axis is a direction, and `up` is another one.
fn check_axes(
    eye: arsc_geometry::DVec3,
    target: arsc_geometry::DVec3,
    up: arsc_geometry::DVec3,
    site: &Site,
) -> Eval<()> {
    let Some(view) = (target - eye).try_normalize() else {
        let message = "the camera's `target` must differ from its `eye`";
        return Err(site.fail_arg(1, codes::OUT_OF_RANGE, message, "the same point"));
    };
    if view.cross(up).try_normalize().is_none() {
        let message = "`up` must not be parallel to the direction of view";
        let failure = site.fail_arg(2, codes::OUT_OF_RANGE, message, "parallel to `target` - `eye`, or zero");
        return Err(Box::new(failure.help("give another, such as `up: (0, 1, 0)` for a view from above")));
    }
    Ok(())
}

fn fit(_: &mut Machine<'_>, a: &[Value], site: &Site) -> Eval {
    let camera = a[0].as_camera();
    if matches!(camera.projection, Projection::Fisheye { .. } | Projection::Panorama) {
        let message = "`fit` moves perspective, thin_lens and orthographic cameras only";
        return Err(site.fail_arg(0, codes::OUT_OF_RANGE, message, "this camera shows the scene from where it stands"));
    }
    Ok(Value::Camera(Camera { fit: Some(a[1].as_float()), ..camera.as_ref().clone() }.into()))
}
