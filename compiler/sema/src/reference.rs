//! The manual of builtins, written from the registry.

use std::fmt::Write;

use crate::registry::{Builtin, Constraint, Default, Implementation, Param, Registry, choices};
use crate::types::{Class, Type};

const INTRODUCTION: &str = "\
# Builtins

Written from the table that the checker and the evaluator read. A parameter that stands as `name: type = value` has a
default; `name: type?` may be left out; `name…` takes any number of arguments. `T` and `U` stand for any type, where a
class follows for any of that class. Lengths are in scene units (one unit is one metre), angles in `deg` or `rad`.

Names need no import unless a module is given.
";

/// The manual as Markdown: what `docs/reference/builtins.md` holds.
pub fn reference() -> String {
    let registry = Registry::get();
    let mut text = INTRODUCTION.to_owned();
    let mut family = "";
    for builtin in &registry.builtins {
        if builtin.family != family {
            family = builtin.family;
            section(&mut text, family);
        }
        entry(&mut text, builtin);
    }
    section(&mut text, "Constants");
    for constant in &registry.constants {
        line(&mut text, &format!("- `{}: {}`: {}", constant.name, constant.ty, constant.doc));
    }
    section(&mut text, "Choices");
    line(&mut text, "Names that mean something where these types are wanted:\n");
    for ty in [
        Type::Across,
        Type::FisheyeMapping,
        Type::Sampler,
        Type::Exposure,
        Type::Observer,
        Type::Strategy,
        Type::Distribution,
        Type::SkyModel,
    ] {
        let names: Vec<String> = choices(&ty).iter().map(|(name, _)| format!("`{name}`")).collect();
        line(&mut text, &format!("- `{ty}`: {}", names.join(", ")));
    }
    text
}

fn line(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

fn section(text: &mut String, title: &str) {
    line(text, &format!("\n## {title}\n"));
}

fn entry(text: &mut String, builtin: &Builtin) {
    line(text, &format!("### `{}`\n", builtin.name));
    line(text, &format!("```\n{}\n```\n", builtin.signature()));
    let mut notes = vec![builtin.doc.to_owned()];
    if builtin.module != crate::registry::PRELUDE {
        notes.push(format!("Module `{}`.", builtin.module));
    }
    for (i, class) in builtin.bounds.iter().enumerate().filter(|(_, class)| **class != Class::Any) {
        notes.push(format!("`{}` is {}.", Type::Var(i as u8), class.description()));
    }
    if let Implementation::Later(_) = builtin.implementation {
        notes.push("*Not implemented yet.*".into());
    }
    line(text, &format!("{}\n", notes.join(" ")));
    for param in &builtin.params {
        parameter(text, param);
    }
    if !builtin.params.is_empty() {
        text.push('\n');
    }
}

fn parameter(text: &mut String, param: &Param) {
    // Writing to a string cannot fail.
    let _ = write!(text, "- `{}`: {}", param.name, param.doc);
    if let Default::Value { text: value, .. } = &param.default {
        let _ = write!(text, "; `{value}` by default");
    }
    if param.constraint != Constraint::None {
        let _ = write!(text, "; {}", param.constraint.description());
    }
    text.push('\n');
}

impl Builtin {
    /// `sphere(radius: float = 1, center: point = (0, 0, 0)) -> solid`
    pub fn signature(&self) -> String {
        let last = self.params.len().wrapping_sub(1);
        let param = |(i, param): (usize, &Param)| {
            let dots = if self.variadic && i == last { "…" } else { "" };
            let (optional, default) = match &param.default {
                Default::Required => ("", String::new()),
                Default::Optional => ("?", String::new()),
                Default::Value { text, .. } => ("", format!(" = {text}")),
            };
            format!("{}{dots}: {}{optional}{default}", param.name, param.ty)
        };
        let params: Vec<String> = self.params.iter().enumerate().map(param).collect();
        format!("{}({}) -> {}", self.name, params.join(", "), self.result)
    }
}
