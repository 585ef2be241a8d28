//! A solid ready for tracing: placed leaves, expression, and the lengths that its tolerances come from.
//!
//! All tolerances are relative. `magnitude` is the largest coordinate of any leaf; rays are taken from an origin within
//! `NEAR` times that (a far origin is moved along the ray once for the whole solid, so its rounding is the same
//! for all leaves). Then crossings are good to some 2⁻⁴⁷ of the magnitude, and `tolerance`, 2⁻⁴⁰ of it, tells coincident
//! faces from separate ones down to angles of a thousandth.

use glam::DVec3;

use arsc_geometry::{Aabb, Placed};

use crate::query::{PreparedRay, View};
use crate::{AccelError, Csg, Expression, MaterialIndex, Solid};

/// Farthest origin, in magnitudes.
const NEAR: f64 = 16.0;

/// A solid, checked and placed.
#[derive(Clone, Debug)]
pub struct SolidModel {
    pub leaves: Vec<Placed>,
    pub materials: Vec<MaterialIndex>,
    pub expression: Expression,
    /// Holds the solid; infinite where it may be.
    pub bounds: Aabb,
    pub tolerance: f64,
    pub nearness: Nearness,
}

/// How far from a solid rays are taken up.
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    center: DVec3,
    /// Largest coordinate of an origin that is near.
    reach: f64,
}

/// A ray in a solid's frame: unit direction, origin not far away.
#[derive(Clone, Copy, Debug)]
pub struct SolidRay {
    pub origin: DVec3,
    pub dir: DVec3,
    /// The parameter of the ray's start, and of its end.
    pub start: f64,
    pub end: f64,
}

impl SolidModel {
    /// `index` names the solid in errors.
    pub fn new(solid: &Solid, index: u32) -> Result<SolidModel, AccelError> {
        check_leaves(&solid.tree, solid.leaves.len(), index)?;
        let mut leaves = Vec::with_capacity(solid.leaves.len());
        for (i, leaf) in solid.leaves.iter().enumerate() {
            let placed = Placed::new(leaf.shape.clone(), leaf.world_from_object);
            leaves.push(placed.map_err(|source| AccelError::Leaf { solid: index, leaf: i as u32, source })?);
        }
        let expression = Expression::from_csg(&solid.tree);
        let bounds = expression.bounds(|leaf| *leaves[leaf as usize].bounds());
        let mut magnitude = leaves.iter().map(coordinates).fold(0.0, f64::max);
        if bounds.is_finite() {
            // Of leaves that stick out far only what is within matters, as far as they are accurate there.
            magnitude = magnitude.min(bounds.min.abs().max(bounds.max.abs()).max_element());
        }
        let corner = DVec3::splat(magnitude);
        let leaf_error = leaves.iter().map(|leaf| leaf.error_at(corner)).fold(0.0, f64::max);
        let tolerance = (magnitude * 2f64.powi(-40)).max(8.0 * leaf_error);
        let center = if bounds.is_finite() { bounds.center() } else { DVec3::ZERO };
        let materials = solid.leaves.iter().map(|leaf| leaf.material).collect();
        let nearness = Nearness { center, reach: NEAR * magnitude };
        Ok(SolidModel { leaves, materials, expression, bounds, tolerance, nearness })
    }

    /// The ray with its origin brought near. `dir` is unit in the solid's frame.
    pub fn near_ray(&self, origin: DVec3, dir: DVec3, t_max: f64) -> SolidRay {
        self.nearness.near_ray(origin, dir, t_max)
    }
}

impl Nearness {
    /// The ray of a view with its origin brought near, in `moved` if need be, and the parameter of its start.
    #[inline(always)]
    pub fn near<'a>(&self, view: &'a View, moved: &'a mut Option<PreparedRay>) -> (&'a PreparedRay, f64) {
        if view.reach <= self.reach {
            return (&view.ray, 0.0);
        }
        let SolidRay { origin, start, .. } = self.near_ray(view.ray.origin, view.ray.dir, f64::INFINITY);
        (moved.insert(PreparedRay { origin, ..view.ray }), start)
    }

    /// The ray with its origin brought near. `dir` is unit in the solid's frame.
    #[inline]
    pub fn near_ray(&self, origin: DVec3, dir: DVec3, t_max: f64) -> SolidRay {
        if origin.abs().max_element() <= self.reach {
            return SolidRay { origin, dir, start: 0.0, end: t_max };
        }
        let shift = (self.center - origin).dot(dir);
        SolidRay { origin: origin + dir * shift, dir, start: -shift, end: t_max - shift }
    }
}

/// Largest finite coordinate that the leaf brings in.
fn coordinates(leaf: &Placed) -> f64 {
    let finite = |x: f64| if x.is_finite() { x.abs() } else { 0.0 };
    let bounds = leaf.bounds();
    let corners = bounds.min.to_array().into_iter().chain(bounds.max.to_array());
    let place = leaf.world_from_object().translation.abs().max_element();
    corners.map(finite).fold(place, f64::max)
}

fn check_leaves(tree: &Csg, leaves: usize, solid: u32) -> Result<(), AccelError> {
    let mut nodes = vec![tree];
    while let Some(node) = nodes.pop() {
        match node {
            Csg::Leaf(leaf) if *leaf as usize >= leaves => {
                return Err(AccelError::LeafOutOfRange { solid, leaf: *leaf, leaves });
            }
            Csg::Leaf(_) => {}
            Csg::Union(children) | Csg::Intersection(children) => nodes.extend(children),
            Csg::Difference(a, b) => nodes.extend([&**a, &**b]),
        }
    }
    Ok(())
}
