//! How rays meet the solids of a frame: one file per strategy (docs/csg.md, "Strategies").
//!
//! All give the same nearest hit, occlusion, intervals and owners of coincident faces; `tests/strategies.rs` holds them to
//! it. They differ in what Embree is given and in what is done at its primitives:
//!
//! | | Embree primitive | along the ray |
//! |---|---|---|
//! | [`local`] | cell with its simplified expression | front to back, stops at the first change |
//! | `native` | none | own KD tree over all leaves, to the end; whole trees |
//! | `collect` | leaf | all leaves met; whole trees afterwards |
//! | `tree` | solid | boxes at the nodes of the operator tree |
//! | `kd` | solid | KD tree over the solid's leaves; whole tree |
//! | `hybrid` | solid | `kd` with mesh operands, else `tree` |
//! | `incremental` | solid | as `kd`, but only what changes is evaluated |
//!
//! A leaf's box is cut to that of its solid, where alone it matters; what is not finite even so is met by every ray. Boxes
//! are grown by [`PAD`] tolerances, so that crossings which coincide with one within are found together.

mod collect;
mod collected;
mod gather;
mod hybrid;
mod kd;
mod kd_tree;
mod local;
mod members;
mod native;
mod operators;
pub mod oracle;
pub mod plain;
mod scene_tree;
mod tree;
mod whole;

use arsc_geometry::Aabb;

use crate::level::Solids;
use crate::query::{Extent, Query};
use crate::solid::SolidModel;
use crate::{Budget, Strategy};

use collect::Collect;
use local::Local;
use native::Native;
use whole::{PerSolid, Structure};

pub use members::Members;
pub use whole::WholeScratch;

/// Room around boxes, in tolerances of the solid.
const PAD: f64 = 4.0;

/// The structures of one strategy over the solids of a frame.
pub trait SolidTracer: Send + Sync {
    /// Number of primitives for Embree.
    fn primitive_count(&self) -> usize;
    fn primitive_bounds(&self, solids: &Solids, primitive: u32) -> Aabb;
    /// Boxes that solids are found by: Embree's, or cells of own trees.
    fn cell_count(&self) -> usize {
        self.primitive_count()
    }
    /// Bytes beside the leaves.
    fn bytes(&self) -> usize;
    /// Meets what Embree does not hold.
    fn visit_open(&self, solids: &Solids, query: &mut Query);
    /// Meets a primitive that Embree's traversal has come to.
    fn visit(&self, solids: &Solids, primitive: u32, query: &mut Query);
}

#[allow(clippy::large_enum_variant, reason = "one to a frame, and every visit reads it")]
pub enum Tracer {
    Local(Local),
    Native(Native),
    Collect(Collect),
    PerSolid(PerSolid),
}

impl Tracer {
    pub fn build(solids: &Solids, strategy: Strategy, budget: &Budget) -> Tracer {
        let per_solid = |structure: fn(&SolidModel, &Budget) -> Structure| {
            Tracer::PerSolid(PerSolid::build(solids, budget, structure))
        };
        match strategy {
            Strategy::Local => Tracer::Local(Local::build(solids, budget)),
            Strategy::Native => Tracer::Native(Native::build(solids, budget)),
            Strategy::Collect => Tracer::Collect(Collect::build(solids)),
            Strategy::Tree => per_solid(Structure::tree),
            Strategy::Kd => per_solid(Structure::kd),
            Strategy::Incremental => per_solid(Structure::incremental),
            Strategy::Hybrid => per_solid(hybrid::structure),
            Strategy::Oracle => per_solid(|_, _| Structure::Oracle),
        }
    }

    pub fn get(&self) -> &dyn SolidTracer {
        match self {
            Tracer::Local(local) => local,
            Tracer::Native(native) => native,
            Tracer::Collect(collect) => collect,
            Tracer::PerSolid(whole) => whole,
        }
    }
}

/// The boxes of a solid's leaves where they matter, and the leaves for which there is none (their boxes are empty).
fn leaf_boxes(solid: &SolidModel) -> (Vec<Aabb>, Vec<u32>) {
    let mut everywhere = vec![];
    let boxes = (0..).zip(&solid.leaves).map(|(number, leaf)| {
        let within = leaf.bounds().intersection(&solid.bounds);
        let grown = within.dilated(PAD * solid.tolerance);
        if within.is_empty() {
            Aabb::EMPTY
        } else if Extent::admits(&grown) {
            grown
        } else {
            everywhere.push(number);
            Aabb::EMPTY
        }
    });
    (boxes.collect(), everywhere)
}
