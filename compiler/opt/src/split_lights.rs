//! Takes lights and open surfaces out of unions.
//!
//! Rewrites: `split_surface`, `split_light`.

use arsc_ir::{Ir, Leaf, NodeKind};

use crate::hoist::hoist;
use crate::pipeline::Log;

pub(crate) fn run(mut ir: Ir, log: &mut Log) -> Ir {
    let moved = hoist(&mut ir, is_surface, log);
    log.fire_times("split_surface", moved);
    let moved = hoist(&mut ir, |kind| matches!(kind, NodeKind::Light(_)), log);
    log.fire_times("split_light", moved);
    ir
}

fn is_surface(kind: &NodeKind) -> bool {
    matches!(kind, NodeKind::Leaf(leaf) if matches!(**leaf, Leaf::Surface { .. }))
}
