//! The order of the passes, and the driver that runs them.

use arsc_diagnostics::{Diagnostic, Span, codes};
use arsc_ir::{Ir, verify};

use crate::{Counts, Optimised, Options, PassReport, check_normal_form};

/// A pass: IR → IR.
pub struct Pass {
    pub name: &'static str,
    pub summary: &'static str,
    /// Part of the way to the normal form: runs with the optimisation off, too.
    pub lowering: bool,
    run: fn(Ir, &mut Log) -> Ir,
}

/// Every pass, in the order in which they run.
pub const PASSES: &[Pass] = &[
    Pass {
        name: "propagate_attributes",
        summary: "move attributes to the leaves and intern materials",
        lowering: true,
        run: crate::propagate_attributes::run,
    },
    Pass {
        name: "separate_media",
        summary: "divide the scene into objects; transmissive ones stand alone",
        lowering: true,
        run: crate::separate_media::run,
    },
    Pass {
        name: "split_environments",
        summary: "take environments out of unions",
        lowering: true,
        run: crate::split_environments::run,
    },
    Pass {
        name: "split_lights",
        summary: "take lights and open surfaces out of unions",
        lowering: true,
        run: crate::split_lights::run,
    },
    Pass {
        name: "fill_interiors",
        summary: "give each transmissive solid one medium and index of refraction",
        lowering: true,
        run: crate::fill_interiors::run,
    },
    Pass {
        name: "share_subtrees",
        summary: "make equal subtrees one node",
        lowering: false,
        run: crate::share_subtrees::run,
    },
    Pass {
        name: "split_union",
        summary: "split top-level unions into independent solids",
        lowering: false,
        run: crate::split_union::run,
    },
    Pass {
        name: "fold_transforms",
        summary: "fold transforms into the leaves, keep instances of large solids",
        lowering: true,
        run: crate::fold_transforms::run,
    },
    Pass {
        name: "flatten",
        summary: "make nested unions, intersections and differences n-ary",
        lowering: false,
        run: crate::flatten::run,
    },
    Pass {
        name: "bound_unbounded",
        summary: "end unbounded solids where a bounded partner hides it",
        lowering: false,
        run: crate::bound_unbounded::run,
    },
    Pass {
        name: "drop_operands",
        summary: "drop operands that are proved empty, full or absorbed",
        lowering: false,
        run: crate::drop_operands::run,
    },
];

/// The lints look at the scene after this pass.
const LINTED_AFTER: &str = "split_lights";

/// So many degenerate shapes are reported.
const MAX_DEGENERATE: usize = 10;

/// What a pass writes down while it runs.
pub(crate) struct Log<'a> {
    pub options: &'a Options,
    pub diagnostics: Vec<Diagnostic>,
    rewrites: Vec<(&'static str, usize)>,
}

impl<'a> Log<'a> {
    pub(crate) fn new(options: &'a Options) -> Log<'a> {
        Log { options, diagnostics: Vec::new(), rewrites: Vec::new() }
    }

    /// A rewrite fired.
    pub(crate) fn fire(&mut self, rewrite: &'static str) {
        self.fire_times(rewrite, 1);
    }

    pub(crate) fn fire_times(&mut self, rewrite: &'static str, times: usize) {
        if times == 0 {
            return;
        }
        match self.rewrites.iter_mut().find(|(name, _)| *name == rewrite) {
            Some((_, count)) => *count += times,
            None => self.rewrites.push((rewrite, times)),
        }
    }

    /// The solids of the scene are too large to be written out.
    pub(crate) fn too_many_leaves(&mut self, ir: &Ir, leaves: u64) {
        let message = format!("the scene has {leaves} primitives; the limit is {}", self.options.max_leaves);
        let diagnostic = Diagnostic::new(codes::geometry::TOO_MANY_PRIMITIVES, message)
            .label(ir.node(ir.root).origin, "repeated parts multiply in here")
            .help("place copies side by side at the top level of the scene, where they become instances");
        self.diagnostics.push(diagnostic);
    }

    /// A product of maps has no finite inverse, or the shape under it no finite size.
    pub(crate) fn degenerate(&mut self, origin: Span) {
        if self.diagnostics.len() < MAX_DEGENERATE {
            let message = "the transforms above a shape together leave nothing of it";
            let diagnostic = Diagnostic::new(codes::sema::DEGENERATE_TRANSFORM, message)
                .label(origin, "becomes too small, too large or flat")
                .help("use scale factors that do not multiply to almost zero or infinity");
            self.diagnostics.push(diagnostic);
        }
    }

    fn has_error(&self) -> bool {
        self.diagnostics.iter().any(Diagnostic::is_error)
    }
}

/// Brings an IR into the normal form (see the crate's documentation), optimised or not.
///
/// The IR must verify. When `diagnostics` holds an error, the IR is the one before the pass that found it.
pub fn optimise(ir: Ir, options: &Options) -> Optimised {
    optimise_observed(ir, options, &mut |_, _| {})
}

/// [`optimise`] that shows the IR after every pass, with the pass's name.
pub fn optimise_observed(ir: Ir, options: &Options, observe: &mut dyn FnMut(&'static str, &Ir)) -> Optimised {
    let mut log = Log::new(options);
    let mut ir = ir;
    let mut reports = Vec::new();
    let mut before = Counts::of(&ir);
    for pass in PASSES.iter().filter(|pass| pass.lowering || options.optimise) {
        ir = (pass.run)(ir, &mut log);
        ir.compact();
        if cfg!(debug_assertions) && !log.has_error() {
            assert_eq!(verify(&ir), Ok(()), "after {}", pass.name);
        }
        let after = Counts::of(&ir);
        reports.push(PassReport { name: pass.name, before, after, rewrites: std::mem::take(&mut log.rewrites) });
        before = after;
        observe(pass.name, &ir);
        if pass.name == LINTED_AFTER && options.lint {
            log.diagnostics.extend(crate::lints::lint(&ir, options));
        }
        if log.has_error() {
            break;
        }
    }
    if cfg!(debug_assertions) && !log.has_error() {
        assert_eq!(check_normal_form(&ir), Ok(()));
    }
    Optimised { ir, diagnostics: log.diagnostics, passes: reports }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arsc_diagnostics::SourceId;
    use arsc_geometry::{DAffine3, DVec3, Shape};
    use arsc_ir::{Attributes, Bsdf, Builder, Leaf, Light, Node, NodeKind, Precedence, Spectrum};

    #[test]
    fn a_placed_covered_union_with_a_light_reaches_the_normal_form() {
        let at = Span::new(SourceId(0), 0, 1);
        let mut b = Builder::new();
        let lambert = b.bsdf(Bsdf::Lambert { reflectance: Spectrum::Constant(0.25) });
        let sphere = b.solid(Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY, at);
        let cube = b.solid(Shape::Box { min: -DVec3::ONE, max: DVec3::ONE }, DAffine3::IDENTITY, at);
        let light = b.light(Light::Point { intensity: Spectrum::Constant(1.0) }, at);
        let union = b.union(vec![sphere, light, cube], at);
        let covered =
            b.attributes(Attributes { bsdf: Some(lambert), ..Attributes::default() }, Precedence::Inner, union, at);
        let moved = b.transform(DAffine3::from_translation(DVec3::X), covered, at);
        let root = b.union(vec![moved], at);
        let optimised = optimise(b.finish(root), &Options { optimise: false, ..Options::default() });
        assert!(optimised.diagnostics.iter().all(|finding| !finding.is_error()));
        let ir = optimised.ir;
        let NodeKind::Group(members) = ir.kind(ir.root) else { panic!("the root is a group") };
        assert_eq!(members.len(), 2);
        let NodeKind::Union(operands) = ir.kind(members[0]) else { panic!("the solid comes first") };
        for &operand in operands {
            let NodeKind::Leaf(leaf) = ir.kind(operand) else { panic!("operands are leaves") };
            let Leaf::Solid { parent_from_object, material, .. } = **leaf else { panic!("leaves are solid") };
            assert_eq!(parent_from_object.translation, DVec3::X);
            assert_eq!(ir.materials[material.expect("a material").0 as usize].bsdf, Some(0));
        }
        let NodeKind::Transform { child, .. } = ir.kind(members[1]) else { panic!("the light is placed") };
        assert!(matches!(ir.node(*child), Node { kind: NodeKind::Light(_), .. }));
    }
}
