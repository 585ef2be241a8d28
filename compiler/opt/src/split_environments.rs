//! Takes environments out of unions.
//!
//! Rewrite: `split_environment`.

use arsc_ir::{Ir, NodeKind};

use crate::hoist::hoist;
use crate::pipeline::Log;

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let moved = hoist(&mut ir, |kind| matches!(kind, NodeKind::Environment(_)), log);
    log.fire_times("split_environment", moved);
    ir
}
