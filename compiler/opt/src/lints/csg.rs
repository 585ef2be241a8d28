//! Boolean expressions that do nothing: empty ones, subtractions that remove nothing, absorbed operands.

use arsc_diagnostics::{Diagnostic, Span, codes::geometry as codes};
use arsc_ir::{NodeId, NodeKind};
use rustc_hash::FxHashMap;

use super::Places;
use super::sampling::{Sampling, Set};
use super::survey::Survey;
use crate::drop_operands::{Value, absorbed};

#[derive(Clone, Copy)]
enum Certainty {
    Proved,
    Seems,
}

/// How a Boolean node came to be empty.
#[derive(Clone, Copy)]
enum Empty {
    Intersection(Certainty),
    Difference(Certainty, Span),
}

pub(super) fn lint(survey: &Survey, findings: &mut Vec<Diagnostic>) {
    let mut empty: Places<Empty> = Places::new();
    let mut useless: Places<(Certainty, Span)> = Places::new();
    let mut swallowed: Places<Span> = Places::new();
    let mut sampling = Sampling::new(survey);
    // Nodes that are reported or empty because an operand is: one finding per cause.
    let mut void = vec![false; survey.ir.nodes.len()];
    for index in 0..survey.ir.nodes.len() {
        let id = NodeId(index as u32);
        match survey.ir.kind(id) {
            NodeKind::Intersection(of) => {
                if of.iter().any(|operand| void[operand.index()]) {
                    void[index] = true;
                    continue;
                }
                let found = is_empty(survey, &mut sampling, id);
                void[index] = found.is_some();
                empty.note(survey.origin(id), found.map(Empty::Intersection));
            }
            NodeKind::Difference(of) => {
                if void[of[0].index()] {
                    void[index] = true;
                    continue;
                }
                let found = is_empty(survey, &mut sampling, id);
                void[index] = found.is_some();
                let remover = remover(survey, of);
                empty.note(survey.origin(id), found.map(|certainty| Empty::Difference(certainty, remover)));
                for &operand in &of[1..] {
                    let skip = void[index] || void[operand.index()];
                    let found = if skip { None } else { removes_nothing(survey, &mut sampling, of[0], operand) };
                    useless.note(survey.origin(operand), found.map(|certainty| (certainty, survey.origin(of[0]))));
                }
            }
            NodeKind::Union(of) => {
                void[index] = !of.is_empty() && of.iter().all(|operand| void[operand.index()]);
                for (&operand, by) in of.iter().zip(absorbers(survey, of)) {
                    // A hidden light has a finding of its own.
                    let by = by.filter(|_| !survey.emits(operand));
                    swallowed.note(survey.origin(operand), by.map(|by| survey.origin(by)));
                }
            }
            _ => {}
        }
    }
    findings.extend(empty.all_found().map(|(origin, found)| report_empty(origin, found)));
    findings.extend(useless.all_found().map(|(origin, (certainty, from))| report_useless(origin, certainty, from)));
    findings.extend(swallowed.all_found().map(|(origin, by)| {
        Diagnostic::new(codes::ABSORBED_OPERAND, "an operand of a union lies inside of another")
            .label(origin, "adds nothing: it cannot be seen")
            .label(by, "all of it is in here")
            .help("remove the operand, or move it out")
    }));
}

/// For each operand of a union, one inside of which it lies. Equal operands are looked at once.
fn absorbers(survey: &Survey, of: &[NodeId]) -> Vec<Option<NodeId>> {
    let mut distinct: Vec<NodeId> = Vec::new();
    let mut index: FxHashMap<NodeId, usize> = FxHashMap::default();
    for &operand in of {
        index.entry(survey.canonical[operand.index()]).or_insert_with(|| {
            distinct.push(operand);
            distinct.len() - 1
        });
    }
    let by = absorbed(survey.ir, &distinct, &survey.bounds);
    of.iter().map(|operand| by[index[&survey.canonical[operand.index()]]].map(|by| distinct[by])).collect()
}

fn is_empty(survey: &Survey, sampling: &mut Sampling, id: NodeId) -> Option<Certainty> {
    if survey.values[id.index()] == Value::Empty || survey.bounds[id.index()].is_empty() {
        return Some(Certainty::Proved);
    }
    (sampling.has_volume(Set::One(id)) == Some(false)).then_some(Certainty::Seems)
}

/// The subtrahend that takes everything, or the first.
fn remover(survey: &Survey, of: &[NodeId]) -> Span {
    let full = of[1..].iter().find(|operand| survey.values[operand.index()] == Value::Full);
    survey.origin(*full.unwrap_or(&of[of.len().min(2) - 1]))
}

fn removes_nothing(survey: &Survey, sampling: &mut Sampling, minuend: NodeId, subtrahend: NodeId) -> Option<Certainty> {
    let [a, b] = [minuend, subtrahend].map(|id| &survey.bounds[id.index()]);
    if survey.values[subtrahend.index()] == Value::Empty || !a.overlaps(b) {
        return Some(Certainty::Proved);
    }
    (sampling.has_volume(Set::Both(minuend, subtrahend)) == Some(false)).then_some(Certainty::Seems)
}

fn report_empty(origin: Span, found: Empty) -> Diagnostic {
    let (message, label) = match found {
        Empty::Intersection(Certainty::Proved) => ("an intersection is empty", "no point is in all operands"),
        Empty::Intersection(Certainty::Seems) => ("an intersection seems to be empty", "no test line met it"),
        Empty::Difference(Certainty::Proved, _) => ("a subtraction removes everything", "nothing is left"),
        Empty::Difference(Certainty::Seems, _) => ("a subtraction seems to remove everything", "no test line met it"),
    };
    let diagnostic = Diagnostic::new(codes::EMPTY_CSG, message).label(origin, label);
    match found {
        Empty::Difference(_, by) if by != origin => diagnostic.label(by, "removes it"),
        _ => diagnostic,
    }
    .help("check the positions and sizes of the operands")
}

fn report_useless(origin: Span, certainty: Certainty, from: Span) -> Diagnostic {
    let (message, label) = match certainty {
        Certainty::Proved => ("a subtraction removes nothing", "does not reach what it is subtracted from"),
        Certainty::Seems => ("a subtraction seems to remove nothing", "no test line met both"),
    };
    let diagnostic = Diagnostic::new(codes::USELESS_SUBTRACTION, message).label(origin, label);
    let diagnostic = if from == origin { diagnostic } else { diagnostic.label(from, "keeps all of its points") };
    diagnostic.help("check its position and size, or remove it")
}
