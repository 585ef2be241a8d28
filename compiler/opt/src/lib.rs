//! Optimiser passes, one file each, and geometric lints over the IR.
//!
//! Every pass keeps the set of points, the materials and the orientation of every solid; what it cannot prove it
//! leaves alone. The verifier runs between passes in debug and test builds.

use arsc_diagnostics::Diagnostic;
use arsc_ir::Ir;

/// Node counts of an IR by kind, reachable from the root.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub leaves: usize,
    pub unions: usize,
    pub intersections: usize,
    pub differences: usize,
    pub groups: usize,
    pub transforms: usize,
    pub attributes: usize,
    pub lights: usize,
    pub environments: usize,
    pub depth: usize,
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
    pub ir: Ir,
    pub diagnostics: Vec<Diagnostic>,
    pub passes: Vec<PassReport>,
}
