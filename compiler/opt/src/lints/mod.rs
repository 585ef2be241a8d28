//! Lints of geometry and light, over the lowered and flattened scene before anything is dropped from it.
//!
//! They see the same whether the optimisation is on or off. Precision before recall: a finding is proved by boxes, by
//! exact membership of a point, or, where the message says "seems", by a fixed sequence of test lines; what exceeds a
//! budget is not reported. One place in the script may make many nodes (a loop, a function): it is reported only if
//! all nodes that it made are found, and then once.

mod coincident;
mod csg;
mod duplicate;
mod face;
mod light;
mod media;
mod sampling;
mod survey;
mod unbounded;

use arsc_diagnostics::{Diagnostic, Span};
use arsc_ir::{Action, Ir};
use rustc_hash::FxHashMap;

use crate::Options;
use crate::pipeline::Log;
use survey::Survey;

/// Larger scenes are linted only as far as that needs no expanded trees.
const MAX_LEAVES: u64 = 2_000_000;

/// Findings about a scene whose media, lights and environments are separated and whose transforms are not folded.
pub(crate) fn lint(ir: &Ir, options: &Options) -> Vec<Diagnostic> {
    let options = Options { optimise: false, max_leaves: options.max_leaves.min(MAX_LEAVES), ..options.clone() };
    let mut log = Log::new(&options);
    let mut lowered = crate::fold_transforms::run(ir.clone(), &mut log);
    if !log.diagnostics.is_empty() {
        return Vec::new();
    }
    lowered.compact();
    let lowered = crate::flatten::run(lowered, &mut log);
    let survey = Survey::new(&lowered);
    let mut findings = Vec::new();
    csg::lint(&survey, &mut findings);
    duplicate::lint(&survey, &mut findings);
    coincident::lint(&survey, &mut findings);
    unbounded::lint(&survey, &mut findings);
    media::lint(&survey, &mut findings);
    light::lint(&survey, &mut findings);
    findings
}

/// The script renders the scene and writes a picture, as one with a camera does that says nothing else.
fn is_rendered(ir: &Ir) -> bool {
    if ir.actions.is_empty() {
        return ir.camera.is_some();
    }
    let any = |wanted: fn(&Action) -> bool| ir.actions.iter().any(|at| wanted(&at.action));
    any(|action| matches!(action, Action::PathTrace(_))) && any(|action| action.output().is_some())
}

/// Counts by place in the script: how many nodes it made, and how many of them were found.
struct Places<T> {
    index: FxHashMap<Span, usize>,
    places: Vec<(Span, usize, usize, Option<T>)>,
}

impl<T> Places<T> {
    fn new() -> Places<T> {
        Places { index: FxHashMap::default(), places: Vec::new() }
    }

    /// Notes a node made at `origin`, and what was found about it.
    fn note(&mut self, origin: Span, finding: Option<T>) {
        let next = self.places.len();
        let at = *self.index.entry(origin).or_insert(next);
        if at == next {
            self.places.push((origin, 0, 0, None));
        }
        let (_, seen, found, first) = &mut self.places[at];
        *seen += 1;
        *found += usize::from(finding.is_some());
        if first.is_none() {
            *first = finding;
        }
    }

    /// Places all of whose nodes were found, with the first finding.
    fn all_found(self) -> impl Iterator<Item = (Span, T)> {
        let all = |(origin, seen, found, first): (Span, usize, usize, Option<T>)| {
            first.filter(|_| seen == found).map(|first| (origin, first))
        };
        self.places.into_iter().filter_map(all)
    }
}
