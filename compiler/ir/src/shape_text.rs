//! The text form of solid shapes: written and read back.

use std::fmt::{self, Formatter};

use arsc_geometry::{Hyperboloid, Paraboloid, Shape};

use crate::args::Args;
use crate::print::Quoted;
use crate::term::Fault;
use crate::write::Call;

/// Writes a shape's name and parameters; the call stays open for more.
pub(crate) fn open_shape<'a, 'b>(f: &'a mut Formatter<'b>, shape: &Shape) -> Result<Call<'a, 'b>, fmt::Error> {
    match *shape {
        Shape::Sphere { radius } => Call::new(f, "sphere")?.float("radius", radius),
        Shape::Box { min, max } => Call::new(f, "box")?.point("min", min)?.point("max", max),
        Shape::Cylinder { radius, height } => {
            Call::new(f, "cylinder")?.float("radius", radius)?.float("height", height)
        }
        Shape::InfiniteCylinder { radius } => Call::new(f, "infinite_cylinder")?.float("radius", radius),
        Shape::Cone { base_radius, top_radius, height } => Call::new(f, "cone")?
            .float("base_radius", base_radius)?
            .float("top_radius", top_radius)?
            .float("height", height),
        Shape::Torus { major, minor } => Call::new(f, "torus")?.float("major", major)?.float("minor", minor),
        Shape::HalfSpace => Call::new(f, "half_space"),
        Shape::Mesh(ref mesh) => Call::new(f, "mesh_solid")?.arg("path", Quoted(mesh.name())),
        Shape::Paraboloid(Paraboloid { radius, height }) => {
            Call::new(f, "paraboloid")?.float("radius", radius)?.float("height", height)
        }
        Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets }) => Call::new(f, "hyperboloid")?
            .float("radius", radius)?
            .float("slope", slope)?
            .float("half_height", half_height)?
            .arg("two_sheets", two_sheets),
    }
}

/// Takes a shape's parameters from a call; `None` if its name is no shape's.
pub(crate) fn shape(args: &mut Args) -> Result<Option<Shape>, Fault> {
    Ok(Some(match args.name {
        "sphere" => Shape::Sphere { radius: args.float("radius")? },
        "box" => Shape::Box { min: args.point("min")?, max: args.point("max")? },
        "cylinder" => Shape::Cylinder { radius: args.float("radius")?, height: args.float("height")? },
        "infinite_cylinder" => Shape::InfiniteCylinder { radius: args.float("radius")? },
        "cone" => Shape::Cone {
            base_radius: args.float("base_radius")?,
            top_radius: args.float("top_radius")?,
            height: args.float("height")?,
        },
        "torus" => Shape::Torus { major: args.float("major")?, minor: args.float("minor")? },
        "half_space" => Shape::HalfSpace,
        "paraboloid" => Shape::Paraboloid(Paraboloid { radius: args.float("radius")?, height: args.float("height")? }),
        "hyperboloid" => Shape::Hyperboloid(Hyperboloid {
            radius: args.float("radius")?,
            slope: args.float("slope")?,
            half_height: args.float("half_height")?,
            two_sheets: args.boolean("two_sheets")?,
        }),
        _ => return Ok(None),
    }))
}

#[cfg(test)]
pub(crate) mod tests {
    use arsc_geometry::DVec3;
    use proptest::prelude::*;

    use super::*;

    fn positive() -> impl Strategy<Value = f64> {
        prop_oneof![1e-3..1e3f64, Just(f64::MIN_POSITIVE)]
    }

    fn size() -> impl Strategy<Value = f64> {
        1e-3..1e3f64
    }

    pub(crate) fn any_shape() -> impl Strategy<Value = Shape> {
        let vector = || prop::array::uniform3(-1e3..1e3f64).prop_map(DVec3::from_array);
        prop_oneof![
            positive().prop_map(|radius| Shape::Sphere { radius }),
            (vector(), [positive(), positive(), positive()])
                .prop_map(|(min, size)| Shape::Box { min, max: min + min.abs() + DVec3::from_array(size) }),
            (positive(), positive()).prop_map(|(radius, height)| Shape::Cylinder { radius, height }),
            positive().prop_map(|radius| Shape::InfiniteCylinder { radius }),
            (positive(), positive()).prop_map(|(r, height)| Shape::Cone { base_radius: r, top_radius: 0.0, height }),
            (positive(), positive()).prop_map(|(major, minor)| Shape::Torus { major, minor }),
            Just(Shape::HalfSpace),
            (size(), size()).prop_map(|(radius, height)| Shape::Paraboloid(Paraboloid { radius, height })),
            (size(), size(), size(), any::<bool>()).prop_map(|(radius, slope, beyond, two_sheets)| {
                let half_height = radius / slope + beyond;
                Shape::Hyperboloid(Hyperboloid { radius, slope, half_height, two_sheets })
            }),
        ]
    }
}
