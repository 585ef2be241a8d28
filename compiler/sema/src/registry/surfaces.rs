//! Open geometry.

use glam::DVec3;

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::Surface as Shape;

use super::{Builtin, Param};
use crate::AssetError;
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::Type::{Float, Point, Str, Surface};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let corner = |name| Param::new(name, Point, "corner");
    vec![
        Builtin::new("triangle", "A triangle; its normal is on the side from which the corners run counter-clockwise.")
            .param(corner("a"))
            .param(corner("b"))
            .param(corner("c"))
            .runs(Surface, triangle),
        Builtin::new(
            "quad",
            "A planar quadrilateral with corners in order, counter-clockwise as seen from its normal.",
        )
        .param(corner("a"))
        .param(corner("b"))
        .param(corner("c"))
        .param(corner("d"))
        .runs(Surface, quad),
        Builtin::new("rectangle", "A rectangle in the plane z = 0, centred at the origin, normal +z.")
            .param(Param::new("width", Float, "extent along x").float(1.0).positive())
            .param(Param::new("depth", Float, "extent along y").float(1.0).positive())
            .runs(Surface, |m, args, site| {
                m.surface(Shape::Rectangle { width: args[0].as_float(), depth: args[1].as_float() }, site)
            }),
        Builtin::new("disk", "A disk in the plane z = 0, centred at the origin, normal +z.")
            .param(Param::new("radius", Float, "radius").float(1.0).positive())
            .runs(Surface, |m, args, site| m.surface(Shape::Disk { radius: args[0].as_float() }, site)),
        Builtin::new("plane", "The infinite plane z = 0, normal +z.")
            .runs(Surface, |m, _, site| m.surface(Shape::Plane, site)),
        Builtin::new("mesh", "A triangle mesh from a file, as an open surface.")
            .param(Param::new("path", Str, "PLY, OBJ or STL file, relative to the script"))
            .runs(Surface, |m, args, site| {
                let shape = m.open_mesh(args[0].as_str(), site)?;
                m.surface(shape, site)
            }),
    ]
}

fn triangle(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let corners: [DVec3; 3] = std::array::from_fn(|i| args[i].as_vec3());
    if (corners[1] - corners[0]).cross(corners[2] - corners[0]) == DVec3::ZERO {
        return Err(flat(site, "the corners of a triangle lie on one line"));
    }
    m.surface(Shape::Triangle(corners), site)
}

fn quad(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let corners: [DVec3; 4] = std::array::from_fn(|i| args[i].as_vec3());
    let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
    if normal == DVec3::ZERO {
        return Err(flat(site, "the corners of a quad lie on one line"));
    }
    let size = corners.iter().fold(0.0, |size: f64, c| size.max((*c - corners[0]).length()));
    let height = (corners[1] - corners[0]).dot(normal.normalize()).abs();
    if height > 1e-6 * size {
        let help = "split it into two triangles";
        return Err(flat(site, "the corners of a quad must lie in one plane").help(help).into());
    }
    m.surface(Shape::Quad(corners), site)
}

fn flat(site: &Site, message: &str) -> Box<arsc_diagnostics::Diagnostic> {
    Box::new(site.fail(codes::OUT_OF_RANGE, message))
}

/// The diagnostic for a file that cannot be had, at the first argument.
pub fn asset_failure(site: &Site, path: &str, error: &AssetError) -> Box<arsc_diagnostics::Diagnostic> {
    let reason = match error {
        AssetError::NotFound => "does not exist".to_owned(),
        AssetError::NotText => "is not text".to_owned(),
        AssetError::TooLarge => "is larger than the limit".to_owned(),
        AssetError::Forbidden => "lies outside of what scripts may read".to_owned(),
        AssetError::Malformed(reason) => {
            return site.fail_arg(0, codes::MESH, format!("the mesh `{}` cannot be used", shortened(path)), reason);
        }
        AssetError::Other(reason) => format!("cannot be read: {reason}"),
    };
    site.fail_arg(0, codes::ASSET, format!("the file `{}` {reason}", shortened(path)), "named here")
}

/// A path for a message.
pub fn shortened(path: &str) -> String {
    path.chars().take(40).collect()
}
