//! Spectra: in closed form, of a colour, in samples, from files.
//!
//! Every kind of spectrum has its own type ([`SpectrumKind`]); a constructor says by its name which kind it gives.

mod colours;
mod formulas;
mod samples;

use super::Builtin;
use crate::types::{SpectrumKind, Type};

pub fn builtins() -> Vec<Builtin> {
    let mut list = colours::builtins();
    list.extend(formulas::builtins());
    list.extend(samples::builtins());
    list.extend(super::fluorescence::builtins());
    list
}

fn kind(kind: SpectrumKind) -> Type {
    Type::Spectrum(kind)
}
