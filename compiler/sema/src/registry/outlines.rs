//! Solids made from lists of points.

use std::sync::Arc;

use arsc_diagnostics::Diagnostic;
use arsc_diagnostics::codes::sema as codes;
use arsc_geometry::{DAffine3, DVec2, HullError, Lathe, Polygon, PolygonError, Polyhedron, Prism};
use arsc_ir::Shape;

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Type::{self, Bool, Float, Point, Solid, Vec2};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    vec![
        Builtin::new("prism", "A polygon in the plane z = 0, extruded to z = `height`. No edge may touch another. Faces: 0 bottom, 1 top, then the sides in the order of the corners that they begin at, those of holes last.")
            .param(Param::new(
                "polygon",
                Type::list(Vec2),
                "corners, either way round; the last is joined to the first",
            ))
            .param(Param::new("height", Float, "height").float(1.0).positive())
            .param(
                Param::new("holes", Type::list(Type::list(Vec2)), "polygons inside of the first, that are left out")
                    .default_value("[]", Value::list(vec![])),
            )
            .runs(Solid, prism),
        Builtin::new(
            "lathe",
            "A solid of revolution: a profile of points (radius, z), turned about the z axis. Its ends are joined to the \
             axis by lines of constant z, or to each other if `closed`. Faces: the segments of the profile in order, then the disk at the \
             last point and that at the first.",
        )
        .param(Param::new("profile", Type::list(Vec2), "points (radius, z), up or down; radii are not negative"))
        .param(Param::new("closed", Bool, "join the last point to the first: a ring of this section").bool(false))
        .param(Param::new("smooth", Bool, "a cubic spline (Catmull-Rom) through the points").bool(false))
        .runs(Solid, lathe),
        Builtin::new("polyhedron", "The convex hull of points. Points in one plane make one face; faces are in the order of their lowest point numbers.")
            .param(Param::new("points", Type::list(Point), "four or more, not all in one plane"))
            .runs(Solid, polyhedron),
    ]
}

fn prism(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let holes = args[2].as_list();
    let mut rings = vec![corners(m, &args[0], site)?];
    for hole in holes.iter() {
        rings.push(corners(m, hole, site)?);
    }
    let polygon = Polygon::new(rings).map_err(|error| bad_polygon(&error, site))?;
    let Some(prism) = Prism::new(polygon, args[1].as_float()) else {
        return Err(site.fail(codes::OUT_OF_RANGE, "the sizes of this prism lie too far apart").into());
    };
    m.solid(Shape::Prism(Arc::new(prism)), DAffine3::IDENTITY, site)
}

fn corners(m: &mut Machine<'_>, list: &Value, site: &Site) -> Eval<Vec<DVec2>> {
    let list = list.as_list();
    m.spend_elements(list.len(), site.span)?;
    Ok(list.iter().map(Value::as_vec2).collect())
}

/// At the argument that is to blame: the outline, or the holes.
fn bad_polygon(error: &PolygonError, site: &Site) -> Box<Diagnostic> {
    let argument = match error {
        PolygonError::TooFewCorners { ring } => usize::from(*ring > 0),
        PolygonError::Repeated(corner) => usize::from(corner.ring > 0),
        PolygonError::Crossing(a, b) => usize::from(a.ring.max(b.ring) > 0),
        PolygonError::StrayHole { .. } => 1,
        PolygonError::OutOfRange | PolygonError::TooManyCorners => 0,
    };
    let mut diagnostic =
        site.fail_arg(2 * argument, codes::OUT_OF_RANGE, "these corners make no polygon", error.to_string());
    if matches!(error, PolygonError::Crossing(..) | PolygonError::Repeated(_)) {
        diagnostic = Box::new(diagnostic.help("go round the outline once, corner by corner; corners count from 0"));
    }
    diagnostic
}

fn lathe(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let points = corners(m, &args[0], site)?;
    let solid = Lathe::new(points, args[1].as_bool(), args[2].as_bool())
        .map_err(|error| site.fail_arg(0, codes::OUT_OF_RANGE, "this profile bounds no solid", error.to_string()))?;
    m.solid(Shape::Lathe(Arc::new(solid)), DAffine3::IDENTITY, site)
}

fn polyhedron(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let points = args[0].as_list();
    m.spend_elements(points.len(), site.span)?;
    let solid = Polyhedron::new(points.iter().map(Value::as_vec3).collect()).map_err(|error| {
        let diagnostic = site.fail_arg(0, codes::OUT_OF_RANGE, "these points make no polyhedron", error.to_string());
        match error {
            HullError::TooManyPoints => Box::new(diagnostic.help("use a closed mesh for finer shapes")),
            _ => diagnostic,
        }
    })?;
    m.solid(Shape::Polyhedron(Arc::new(solid)), DAffine3::IDENTITY, site)
}
