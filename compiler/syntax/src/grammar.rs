//! The parser that pest makes of `grammar/arsl.pest`.

use pest_derive::Parser;

#[derive(Parser)]
#[grammar = "../../grammar/arsl.pest"]
pub(crate) struct Grammar;

pub(crate) type Pair<'t> = pest::iterators::Pair<'t, Rule>;
