//! The text form of solid shapes: written and read back.

use std::fmt::{self, Formatter};
use std::sync::Arc;

use arsc_geometry::{DVec2, DVec3, Hyperboloid, Lathe, Paraboloid, Polygon, Polyhedron, Prism, Shape, Superquadric};

use crate::args::{Args, float_list};
use crate::print::Quoted;
use crate::term::{Fault, Term};
use crate::write::{Call, Floats};

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
        Shape::Prism(ref prism) => {
            let call = Call::new(f, "prism")?.float("height", prism.height())?;
            prism.polygon().rings().iter().try_fold(call, |call, ring| call.value(Floats(&flat2(ring))))
        }
        Shape::Lathe(ref lathe) => Call::new(f, "lathe")?
            .value(Floats(&flat2(lathe.points())))?
            .arg("closed", lathe.is_closed())?
            .arg("smooth", lathe.is_smooth()),
        Shape::Superquadric(ref superquadric) => {
            let [e1, e2] = superquadric.exponents();
            Call::new(f, "superquadric")?.float("e1", e1)?.float("e2", e2)
        }
        Shape::Polyhedron(ref polyhedron) => {
            let coordinates: Vec<f64> = polyhedron.points().iter().flat_map(DVec3::to_array).collect();
            Call::new(f, "polyhedron")?.value(Floats(&coordinates))
        }
    }
}

fn flat2(points: &[DVec2]) -> Vec<f64> {
    points.iter().flat_map(DVec2::to_array).collect()
}

fn lathe(args: &mut Args) -> Result<Shape, Fault> {
    let list = args.next()?;
    let points = tuples::<2>(&list)?.into_iter().map(DVec2::from_array).collect();
    let solid = Lathe::new(points, args.boolean("closed")?, args.boolean("smooth")?);
    Ok(Shape::Lathe(Arc::new(solid.map_err(|error| (list.offset, error.to_string()))?)))
}

fn polyhedron(args: &mut Args) -> Result<Shape, Fault> {
    let list = args.next()?;
    let points = tuples::<3>(&list)?.into_iter().map(DVec3::from_array).collect();
    let solid = Polyhedron::new(points).map_err(|error| (list.offset, error.to_string()))?;
    Ok(Shape::Polyhedron(Arc::new(solid)))
}

fn prism(args: &mut Args) -> Result<Shape, Fault> {
    let height = args.float("height")?;
    let mut rings = Vec::new();
    while let Some(list) = args.next_list() {
        rings.push(tuples::<2>(&list)?.into_iter().map(DVec2::from_array).collect());
    }
    let fault = |message: String| (args.offset, message);
    let polygon = Polygon::new(rings).map_err(|error| fault(error.to_string()))?;
    let solid = Prism::new(polygon, height).ok_or_else(|| fault("a size is not positive and finite".to_owned()))?;
    Ok(Shape::Prism(Arc::new(solid)))
}

/// A list of numbers in groups of N.
fn tuples<const N: usize>(list: &Term) -> Result<Vec<[f64; N]>, Fault> {
    let numbers = float_list(list)?;
    let (tuples, rest) = numbers.as_chunks::<N>();
    if rest.is_empty() {
        Ok(tuples.to_vec())
    } else {
        Err((list.offset, format!("expected {N} numbers for each point")))
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
        "prism" => prism(args)?,
        "lathe" => lathe(args)?,
        "polyhedron" => polyhedron(args)?,
        "superquadric" => {
            let solid = Superquadric::new(args.float("e1")?, args.float("e2")?);
            Shape::Superquadric(Arc::new(solid.ok_or((args.offset, "an exponent is out of range".to_owned()))?))
        }
        _ => return Ok(None),
    }))
}

#[cfg(test)]
pub(crate) mod tests {
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
            (size(), size(), size(), any::<bool>()).prop_map(|(width, depth, height, holed)| {
                let rectangle = |w: f64, d: f64| [(-w, -d), (-w, d), (w, d), (w, -d)].map(DVec2::from).to_vec();
                let mut rings = vec![rectangle(width, depth)];
                rings.extend(holed.then(|| rectangle(0.3 * width, 0.5 * depth)));
                Shape::Prism(Arc::new(Prism::new(Polygon::new(rings).unwrap(), height).unwrap()))
            }),
            (size(), size(), any::<bool>(), any::<bool>()).prop_map(|(radius, height, closed, smooth)| {
                let points = [(radius, 0.0), (2.0 * radius, 0.5 * height), (radius, height)].map(DVec2::from);
                Shape::Lathe(Arc::new(Lathe::new(points.to_vec(), closed, smooth).unwrap()))
            }),
            (0.05..10f64, 0.05..10f64)
                .prop_map(|(e1, e2)| Shape::Superquadric(Arc::new(Superquadric::new(e1, e2).unwrap()))),
            (size(), size(), size()).prop_map(|(x, y, z)| {
                let points = vec![DVec3::ZERO, DVec3::X * x, DVec3::Y * (x + y), DVec3::Z * (x + z)];
                Shape::Polyhedron(Arc::new(Polyhedron::new(points).unwrap()))
            }),
        ]
    }
}
