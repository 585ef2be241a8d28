//! Optimiser passes, one file each, and geometric lints over the IR.
//!
//! Every pass keeps the set of points, the materials and the orientation of every solid; what it cannot prove it
//! leaves alone. The verifier runs between passes in debug and test builds.
//!
//! # The normal form
//!
//! What [`optimise`] gives, with the optimisation on or off, is what `arsc-assembly` lowers:
//!
//! * The root is a `Group`. Its members are independent: each is traced as if alone, and the nearest hit of all wins.
//!   Where faces of two members coincide, the earlier member has precedence. A member is one of
//!   1. a *solid*: a tree of `Union`, `Intersection` and `Difference` over `Leaf::Solid`. No other kind of node is
//!      in it; intersections and differences have operands (`Union` of nothing is the empty solid, and appears only with
//!      the optimisation off); `parent_from_object` of a leaf maps to world space;
//!   2. an *instance*: `Transform { parent_from_child, child }` where `child` is a solid as in 1 whose leaves map to
//!      the frame of the instance, and `parent_from_child` maps from there to the world. Several instances name
//!      the same child. Instances do not nest;
//!   3. a *surface*: a `Leaf::Surface` whose `parent_from_object` maps to world space;
//!   4. a *light*: `Light`, or `Transform` over a `Light`. `Distant` directions are in world space and have no
//!      transform; a `Point` sits at the image of the origin, and its intensity does not depend on the map;
//!   5. an *environment*: `Environment`, or `Transform` over an `Environment`, whose linear part maps directions of
//!      the environment to the world (normalise after mapping; `Constant` and `Medium` never have one).
//! * Nodes of solids may be shared (one id, several parents): the graph is acyclic, and expanded to trees it has at
//!   most [`Options::max_leaves`] leaves. The same node under two parents is the same solid twice.
//! * Every leaf has `material: Some(id)`. [`arsc_ir::Ir::materials`] holds each material once.
//!   Cut rules are resolved: the wall that a subtraction leaves shows the material of the subtracted leaf.
//!   A solid that light gets into has one interior: all its materials name the same medium and the same index of
//!   refraction behind their walls (the pass `fill_interiors`). Where such solids overlap, the earlier member fills
//!   the common part and hides the walls of the later one.
//! * No `Attributes` node is left, and no unreachable node.
//! * Operands of Boolean nodes are in the order of precedence: where two faces coincide, the first operand's shows.
//! * Solids come first in the group, in the order of their first part in the script; then surfaces, then lights
//!   and environments. [`check_normal_form`] checks all of this.
//!
//! # What the scene's union means
//!
//! The `scene` block collects *objects*: the operands of the root union. The opaque ones are one regularised union, so
//! an object that reaches into another shows no wall inside of it, and the earlier object's face wins where two
//! coincide. An object with a transmissive material stands alone, because a union would remove the wall between two
//! different media (the pass `separate_media`). An explicit `a | b` within one object is one solid, unless the
//! two are filled differently.

mod bound_unbounded;
mod bounds;
mod box_tree;
mod counts;
mod drop_operands;
mod fill_interiors;
mod flatten;
mod fold_transforms;
mod hoist;
mod intern;
mod lints;
mod normal_form;
mod pipeline;
mod propagate_attributes;
mod separate_media;
mod share_subtrees;
mod split_environments;
mod split_lights;
mod split_union;
mod texture_space;

pub use counts::Counts;
pub use normal_form::check_normal_form;
pub use pipeline::{PASSES, Pass, optimise, optimise_observed};

use arsc_diagnostics::Diagnostic;
use arsc_ir::Ir;

/// What the optimiser may do.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Off: only the passes that lead to the normal form.
    pub optimise: bool,
    /// Look for findings about geometry and light (errors are always found).
    pub lint: bool,
    /// Ceiling on the leaves of all solids expanded to trees (instances count once).
    pub max_leaves: u64,
}

impl Default for Options {
    fn default() -> Options {
        Options { optimise: true, lint: true, max_leaves: 20_000_000 }
    }
}

/// What one pass did.
#[derive(Clone, Debug)]
pub struct PassReport {
    pub name: &'static str,
    pub before: Counts,
    pub after: Counts,
    /// Names of the rewrites that fired, with how often.
    pub rewrites: Vec<(&'static str, usize)>,
}

/// An optimised IR and what was found on the way.
pub struct Optimised {
    /// In the normal form, unless `diagnostics` holds an error.
    pub ir: Ir,
    pub diagnostics: Vec<Diagnostic>,
    pub passes: Vec<PassReport>,
}
