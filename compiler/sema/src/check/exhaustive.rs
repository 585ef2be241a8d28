//! Whether the arms of a `match` cover every value, and whether each can be chosen.
//!
//! Usefulness of patterns after Maranget (Warnings for pattern matching, 2007): a row is useful if some value fits
//! it and no row before. Ints are split into the intervals that the patterns distinguish; floats and strings count
//! as covered only by patterns that take anything.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_syntax::ast;

use super::Checker;
use crate::code::{Arm, Pat};
use crate::types::Type;

/// Beyond this many steps a match counts as covered by what was found so far: patterns can be exponentially hard.
const MAX_STEPS: usize = 50_000;

impl Checker<'_> {
    pub(super) fn check_coverage(
        &mut self,
        subject: &Type,
        subject_span: Span,
        arms: &[ast::MatchArm],
        checked: &[Arm],
        span: Span,
    ) {
        let ty = self.known(subject);
        if ty.is_error() || checked.iter().any(|arm| has_error(&arm.pattern)) {
            return;
        }
        if !is_matchable(&ty) {
            let message = format!("{} cannot be matched", ty.with_article());
            return self.error(codes::PATTERN, message, subject_span, "no patterns for this type");
        }
        let mut rows: Vec<Vec<Pat>> = Vec::new();
        for (arm, written) in checked.iter().zip(arms) {
            let row = vec![arm.pattern.clone()];
            let mut steps = 0;
            if useful(&rows, &row, std::slice::from_ref(&ty), &mut steps).is_none() {
                let diagnostic = Diagnostic::new(codes::UNREACHABLE_ARM, "this arm can never be chosen");
                self.report(diagnostic.label(written.pattern.span, "covered by the arms before"));
            }
            if arm.guard.is_none() {
                rows.push(row);
            }
        }
        let mut steps = 0;
        if let Some(witness) = useful(&rows, &[Pat::Any], &[ty], &mut steps) {
            let missing = witness.first().map(String::as_str).unwrap_or("_").to_owned();
            let message = format!("the `match` does not cover `{missing}`");
            let diagnostic = Diagnostic::new(codes::NOT_EXHAUSTIVE, message).label(span, "not every value is covered");
            self.report(diagnostic.help("add an arm for it, or `_ => …` for all others"));
        }
    }
}

fn has_error(pattern: &Pat) -> bool {
    match pattern {
        Pat::Error => true,
        Pat::Tuple(parts) | Pat::Either(parts) => parts.iter().any(has_error),
        _ => false,
    }
}

fn is_matchable(ty: &Type) -> bool {
    match ty {
        Type::Bool | Type::Int | Type::Str | Type::Infer(_) => true,
        Type::Tuple(_) => true,
        ty => ty.is_float_like(),
    }
}

/// A value, described, that fits `row` and none of `rows`.
fn useful(rows: &[Vec<Pat>], row: &[Pat], types: &[Type], steps: &mut usize) -> Option<Vec<String>> {
    *steps += 1 + rows.len();
    if *steps > MAX_STEPS {
        return None;
    }
    let (Some((first, rest)), Some((ty, types))) = (row.split_first(), types.split_first()) else {
        return rows.is_empty().then(Vec::new);
    };
    if let Pat::Either(alternatives) = first {
        return alternatives.iter().find_map(|alternative| {
            let row: Vec<Pat> = std::iter::once(alternative.clone()).chain(rest.iter().cloned()).collect();
            let types: Vec<Type> = std::iter::once(ty.clone()).chain(types.iter().cloned()).collect();
            useful(rows, &row, &types, steps)
        });
    }
    if let Type::Tuple(parts) = ty {
        return useful_tuple(rows, (first, rest), (parts, types), steps);
    }
    for case in cases(rows, first, ty) {
        if !case.fits(first) {
            continue;
        }
        let left: Vec<Vec<Pat>> = rows.iter().filter(|row| case.fits(&row[0])).map(|row| row[1..].to_vec()).collect();
        if let Some(mut witness) = useful(&left, rest, types, steps) {
            witness.insert(0, case.to_string());
            return Some(witness);
        }
    }
    None
}

fn useful_tuple(
    rows: &[Vec<Pat>],
    (first, rest): (&Pat, &[Pat]),
    (parts, types): (&[Type], &[Type]),
    steps: &mut usize,
) -> Option<Vec<String>> {
    let width = parts.len();
    let mut expanded = Vec::new();
    for row in rows {
        expand(row, width, &mut expanded);
    }
    let mut query = Vec::new();
    expand(&std::iter::once(first.clone()).chain(rest.iter().cloned()).collect::<Vec<_>>(), width, &mut query);
    let types: Vec<Type> = parts.iter().chain(types).cloned().collect();
    query.iter().find_map(|row| {
        let mut witness = useful(&expanded, row, &types, steps)?;
        let others = witness.split_off(width.min(witness.len()));
        let tuple = format!("({})", witness.join(", "));
        Some(std::iter::once(tuple).chain(others).collect())
    })
}

/// A row whose first pattern is a tuple, that pattern replaced by its parts.
fn expand(row: &[Pat], width: usize, out: &mut Vec<Vec<Pat>>) {
    let with = |parts: &[Pat]| parts.iter().chain(&row[1..]).cloned().collect();
    match &row[0] {
        // One of another width was wrong and has been reported; it counts as any.
        Pat::Tuple(parts) if parts.len() == width => out.push(with(parts)),
        Pat::Either(alternatives) => {
            for alternative in alternatives {
                let row: Vec<Pat> = std::iter::once(alternative.clone()).chain(row[1..].iter().cloned()).collect();
                expand(&row, width, out);
            }
        }
        _ => out.push(with(&vec![Pat::Any; width])),
    }
}

/// A set of values that no pattern in question tells apart.
#[derive(Clone, Debug, PartialEq)]
enum Case {
    Bool(bool),
    /// Bounds included.
    Ints(i64, i64),
    Float(f64),
    FloatRange(f64, f64, bool),
    Str(String),
    /// All that is not named.
    Others,
}

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Case::Bool(b) => write!(f, "{b}"),
            Case::Ints(a, b) if a == b => write!(f, "{a}"),
            Case::Ints(i64::MIN, b) => write!(f, "{b}"),
            Case::Ints(a, _) => write!(f, "{a}"),
            Case::Float(x) => write!(f, "{x}"),
            Case::FloatRange(a, b, true) => write!(f, "{a}..={b}"),
            Case::FloatRange(a, b, false) => write!(f, "{a}..{b}"),
            Case::Str(text) => write!(f, "{text:?}"),
            Case::Others => f.write_str("_"),
        }
    }
}

impl Case {
    /// Whether a pattern takes every value of the case; by construction it takes all or none.
    fn fits(&self, pattern: &Pat) -> bool {
        match (pattern, self) {
            (Pat::Any | Pat::Bind(_), _) => true,
            (Pat::Bool(a), Case::Bool(b)) => a == b,
            (Pat::Int(i), Case::Ints(a, b)) => a == i && b == i,
            (Pat::IntRange { start, end, inclusive }, Case::Ints(a, b)) => {
                a >= start && (b < end || *inclusive && b <= end)
            }
            (Pat::Float(x), Case::Float(y)) => x == y,
            (Pat::FloatRange { start, end, inclusive }, Case::Float(x)) => {
                x >= start && (x < end || *inclusive && x == end)
            }
            (Pat::FloatRange { start, end, inclusive }, Case::FloatRange(a, b, closed)) => {
                a >= start && (b < end || b == end && (*inclusive || !closed))
            }
            (Pat::Str(a), Case::Str(b)) => a == b,
            (Pat::Either(alternatives), case) => alternatives.iter().any(|pattern| case.fits(pattern)),
            _ => false,
        }
    }
}

/// Cases of the first column.
fn cases(rows: &[Vec<Pat>], first: &Pat, ty: &Type) -> Vec<Case> {
    let patterns: Vec<&Pat> = rows.iter().map(|row| &row[0]).chain([first]).flat_map(alternatives).collect();
    match ty {
        Type::Bool => vec![Case::Bool(true), Case::Bool(false)],
        Type::Int => intervals(&patterns),
        _ => {
            let mut cases: Vec<Case> = Vec::new();
            for pattern in patterns {
                let case = match pattern {
                    Pat::Float(x) => Case::Float(*x),
                    Pat::FloatRange { start, end, inclusive } => Case::FloatRange(*start, *end, *inclusive),
                    Pat::Str(text) => Case::Str(text.clone()),
                    _ => continue,
                };
                if !cases.contains(&case) {
                    cases.push(case);
                }
            }
            cases.push(Case::Others);
            cases
        }
    }
}

fn alternatives(pattern: &Pat) -> Vec<&Pat> {
    match pattern {
        Pat::Either(parts) => parts.iter().flat_map(alternatives).collect(),
        other => vec![other],
    }
}

/// The ints, cut where patterns begin and end.
fn intervals(patterns: &[&Pat]) -> Vec<Case> {
    let mut starts = vec![i64::MIN];
    for pattern in patterns {
        let (first, last) = match pattern {
            Pat::Int(i) => (*i, Some(*i)),
            Pat::IntRange { start, end, inclusive: true } => (*start, Some(*end)),
            Pat::IntRange { start, end, inclusive: false } => (*start, end.checked_sub(1)),
            _ => continue,
        };
        starts.push(first);
        starts.extend(last.and_then(|last| last.checked_add(1)));
    }
    starts.sort_unstable();
    starts.dedup();
    let ends = starts[1..].iter().map(|next| next - 1).chain([i64::MAX]);
    starts.iter().zip(ends).map(|(start, end)| Case::Ints(*start, end)).collect()
}
