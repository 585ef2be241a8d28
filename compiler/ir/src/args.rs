//! Arguments and scalars of the text form, taken one by one (for the module `read`).

use arsc_geometry::{DAffine3, DVec3};

use crate::term::{Fault, Term, TermKind};

/// The arguments of a call, taken one by one.
pub(crate) struct Args<'a> {
    pub(crate) name: &'a str,
    pub(crate) offset: usize,
    pub(crate) rest: std::collections::VecDeque<(Option<&'a str>, Term<'a>)>,
}

impl<'a> Args<'a> {
    pub(crate) fn new(term: Term<'a>) -> Result<Args<'a>, Fault> {
        match term.kind {
            TermKind::Call(name, arguments) => Ok(Args { name, offset: term.offset, rest: arguments.into() }),
            _ => Err((term.offset, "expected `name(…)`".to_owned())),
        }
    }

    pub(crate) fn next(&mut self) -> Result<Term<'a>, Fault> {
        match self.rest.front() {
            Some((None, _)) => Ok(self.rest.pop_front().expect("it is there").1),
            _ => Err((self.offset, format!("`{}` lacks an operand", self.name))),
        }
    }

    /// The next operand, if it is a list.
    pub(crate) fn next_list(&mut self) -> Option<Term<'a>> {
        match self.rest.front() {
            Some((None, Term { kind: TermKind::List(_), .. })) => self.rest.pop_front().map(|(_, term)| term),
            _ => None,
        }
    }

    pub(crate) fn optional(&mut self, name: &str) -> Option<Term<'a>> {
        let at = self.rest.iter().position(|(given, _)| *given == Some(name))?;
        self.rest.remove(at).map(|(_, term)| term)
    }

    pub(crate) fn take(&mut self, name: &str) -> Result<Term<'a>, Fault> {
        self.optional(name).ok_or_else(|| (self.offset, format!("`{}` lacks `{name}`", self.name)))
    }

    pub(crate) fn float(&mut self, name: &str) -> Result<f64, Fault> {
        float(&self.take(name)?)
    }

    pub(crate) fn point(&mut self, name: &str) -> Result<DVec3, Fault> {
        floats(&self.take(name)?).map(DVec3::from_array)
    }

    pub(crate) fn integer<T: std::str::FromStr>(&mut self, name: &str) -> Result<T, Fault> {
        integer(&self.take(name)?)
    }

    pub(crate) fn text(&mut self, name: &str) -> Result<String, Fault> {
        let term = self.take(name)?;
        match term.kind {
            TermKind::Text(text) => Ok(text),
            _ => Err((term.offset, "expected a string".to_owned())),
        }
    }

    pub(crate) fn boolean(&mut self, name: &str) -> Result<bool, Fault> {
        let term = self.take(name)?;
        match term.kind {
            TermKind::Word("true") => Ok(true),
            TermKind::Word("false") => Ok(false),
            _ => Err((term.offset, "expected `true` or `false`".to_owned())),
        }
    }

    pub(crate) fn map(&mut self) -> Result<DAffine3, Fault> {
        if let Some(at) = self.optional("at") {
            return Ok(DAffine3::from_translation(DVec3::from_array(floats(&at)?)));
        }
        match self.optional("map") {
            Some(map) => Ok(DAffine3::from_cols_array(&floats(&map)?)),
            None => Ok(DAffine3::IDENTITY),
        }
    }

    pub(crate) fn index(&mut self, name: &str, prefix: char, length: usize) -> Result<Option<u32>, Fault> {
        self.optional(name).map(|term| index(&term, prefix, length)).transpose()
    }

    pub(crate) fn unknown<T>(&self, what: &str) -> Result<T, Fault> {
        Err((self.offset, format!("`{}` is no {what}", self.name)))
    }

    pub(crate) fn end(self) -> Result<(), Fault> {
        match self.rest.front() {
            None => Ok(()),
            Some((_, term)) => Err((term.offset, format!("`{}` takes no such argument", self.name))),
        }
    }
}

/// One of few values by its name.
pub(crate) fn named<T: Copy>(term: &Term, all: &[T], name: impl Fn(T) -> &'static str) -> Result<T, Fault> {
    let found = match term.kind {
        TermKind::Word(word) => all.iter().copied().find(|value| name(*value) == word),
        _ => None,
    };
    found.ok_or_else(|| {
        let names: Vec<String> = all.iter().map(|value| format!("`{}`", name(*value))).collect();
        (term.offset, format!("expected one of {}", names.join(", ")))
    })
}

pub(crate) fn float(term: &Term) -> Result<f64, Fault> {
    match term.kind {
        TermKind::Number(text) => text.parse().map_err(|_| (term.offset, format!("`{text}` is no number"))),
        TermKind::Word("inf") => Ok(f64::INFINITY),
        TermKind::Word("NaN") => Ok(f64::NAN),
        _ => Err((term.offset, "expected a number".to_owned())),
    }
}

pub(crate) fn float_list(term: &Term) -> Result<Vec<f64>, Fault> {
    match &term.kind {
        TermKind::List(items) => items.iter().map(float).collect(),
        _ => Err((term.offset, "expected a list of numbers".to_owned())),
    }
}

pub(crate) fn floats<const N: usize>(term: &Term) -> Result<[f64; N], Fault> {
    float_list(term)?.try_into().map_err(|_| (term.offset, format!("expected {N} numbers")))
}

pub(crate) fn integer<T: std::str::FromStr>(term: &Term) -> Result<T, Fault> {
    match term.kind {
        TermKind::Number(text) => text.parse().map_err(|_| (term.offset, format!("`{text}` is no such integer"))),
        _ => Err((term.offset, "expected an integer".to_owned())),
    }
}

pub(crate) fn index(term: &Term, prefix: char, length: usize) -> Result<u32, Fault> {
    let index = match term.kind {
        TermKind::Word(word) => word.strip_prefix(prefix).and_then(|digits| digits.parse::<u32>().ok()),
        _ => None,
    };
    match index {
        Some(index) if (index as usize) < length => Ok(index),
        Some(_) => Err((term.offset, "not defined before its use".to_owned())),
        None => Err((term.offset, format!("expected `{prefix}` and a number"))),
    }
}
