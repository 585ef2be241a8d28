//! The text form of what varies over a surface.
//!
//! ```text
//! varying(part(lambert(reflectance: constant(0.5)), weight: expression(1.0), reflectance: blend(
//!     term(expression(x, 0.0, less(1, 0)), constant(0.8)))))
//! ```
//!
//! An expression lists its steps: a number, an input by its name, or an operation on earlier steps, counted from 0.

use std::fmt::{self, Display, Formatter};

use arsc_texture::{Binary, Expression, Input, Noise, Step, Unary};

use crate::args::{Args, float, integer};
use crate::print::Text;
use crate::read::{bsdf, spectrum};
use crate::term::{Fault, Term, TermKind};
use crate::varying::{Parameter, Part, SpectrumTerm, SpectrumTexture, Varying};
use crate::write::{Call, Float};

impl Display for Text<'_, Varying> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let call = self.0.parts.iter().try_fold(Call::new(f, "varying")?, |call, part| call.value(Text(part)))?;
        call.map(&self.0.texture_from_object)?.end()
    }
}

impl Display for Text<'_, Part> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let call = Call::new(f, "part")?.value(Text(&self.0.bsdf))?.arg("weight", Text(&self.0.weight))?;
        self.0.parameters.iter().try_fold(call, parameter)?.end()
    }
}

fn parameter<'a, 'b>(call: Call<'a, 'b>, parameter: &Parameter) -> Result<Call<'a, 'b>, fmt::Error> {
    match parameter {
        Parameter::Reflectance(texture) => call.arg("reflectance", Text(texture)),
        Parameter::Sigma(sigma) => call.arg("sigma", Text(sigma)),
        Parameter::Exponent(exponent) => call.arg("exponent", Text(exponent)),
        Parameter::Height(height) => call.arg("height", Text(height)),
        Parameter::Normal([u, v, n]) => {
            call.arg("normal", format_args!("normal({}, {}, {})", Text(u), Text(v), Text(n)))
        }
        Parameter::Roughness([along, across]) => call.arg("roughness", Text(along))?.arg("across", Text(across)),
    }
}

impl Display for Text<'_, SpectrumTexture> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.terms.iter().try_fold(Call::new(f, "blend")?, |call, term| call.value(Text(term)))?.end()
    }
}

impl Display for Text<'_, SpectrumTerm> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Call::new(f, "term")?.value(Text(&self.0.weight))?.value(Text(&self.0.spectrum))?.end()
    }
}

impl Display for Text<'_, Expression> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let call = Call::new(f, "expression")?;
        self.0.steps().iter().try_fold(call, |call, step| call.value(Text(step)))?.end()
    }
}

impl Display for Text<'_, Step> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self.0 {
            Step::Constant(value) => write!(f, "{}", Float(value)),
            Step::Input(input) => f.write_str(input.name()),
            Step::Unary(op, a) => Call::new(f, op.name())?.value(a)?.end(),
            Step::Binary(op, a, b) => Call::new(f, op.name())?.value(a)?.value(b)?.end(),
            Step::Select(condition, a, b) => Call::new(f, "select")?.value(condition)?.value(a)?.value(b)?.end(),
            Step::Noise(noise, place) => {
                let name = match noise {
                    Noise::Perlin { .. } => "noise",
                    Noise::Fbm { .. } => "fbm",
                    Noise::Turbulence { .. } => "turbulence",
                };
                let call = place.iter().try_fold(Call::new(f, name)?, |call, operand| call.value(operand))?;
                match noise {
                    Noise::Perlin { seed } => call.arg("seed", seed)?.end(),
                    Noise::Fbm { seed, octaves, lacunarity, gain }
                    | Noise::Turbulence { seed, octaves, lacunarity, gain } => call
                        .arg("seed", seed)?
                        .arg("octaves", octaves)?
                        .float("lacunarity", lacunarity)?
                        .float("gain", gain)?
                        .end(),
                }
            }
        }
    }
}

pub(crate) fn varying(mut args: Args) -> Result<Varying, Fault> {
    let texture_from_object = args.map()?;
    let mut parts = Vec::new();
    while !args.rest.is_empty() {
        parts.push(part(args.next()?)?);
    }
    Ok(Varying { parts, texture_from_object })
}

fn named<'a>(term: Term<'a>, name: &str) -> Result<Args<'a>, Fault> {
    let args = Args::new(term)?;
    if args.name == name { Ok(args) } else { args.unknown(name) }
}

fn part(term: Term) -> Result<Part, Fault> {
    let mut args = named(term, "part")?;
    let mut part = Part { bsdf: bsdf(args.next()?)?, weight: expression(args.take("weight")?)?, parameters: vec![] };
    // The order of the parameters is part of what equality means.
    while let Some((name, _)) = args.rest.front() {
        let (name, offset) = (*name, args.offset);
        let Some((_, term)) = args.rest.pop_front() else { break };
        part.parameters.push(match name {
            Some("reflectance") => Parameter::Reflectance(blend(term)?),
            Some("sigma") => Parameter::Sigma(expression(term)?),
            Some("exponent") => Parameter::Exponent(expression(term)?),
            Some("height") => Parameter::Height(expression(term)?),
            Some("normal") => {
                let mut parts = named(term, "normal")?;
                let normal = [expression(parts.next()?)?, expression(parts.next()?)?, expression(parts.next()?)?];
                parts.end()?;
                Parameter::Normal(normal)
            }
            Some("roughness") => Parameter::Roughness([expression(term)?, expression(args.take("across")?)?]),
            _ => return Err((offset, "a part takes no such argument".to_owned())),
        });
    }
    Ok(part)
}

fn blend(term: Term) -> Result<SpectrumTexture, Fault> {
    let mut args = named(term, "blend")?;
    let mut terms = Vec::new();
    while !args.rest.is_empty() {
        let mut term = named(args.next()?, "term")?;
        terms.push(SpectrumTerm { weight: expression(term.next()?)?, spectrum: spectrum(term.next()?)? });
        term.end()?;
    }
    Ok(SpectrumTexture { terms })
}

fn expression(term: Term) -> Result<Expression, Fault> {
    let mut args = named(term, "expression")?;
    let offset = args.offset;
    let mut steps = Vec::new();
    while !args.rest.is_empty() {
        steps.push(step(args.next()?)?);
    }
    Expression::new(steps).map_err(|error| (offset, error.to_string()))
}

fn step(term: Term) -> Result<Step, Fault> {
    match term.kind {
        TermKind::Number(_) => return Ok(Step::Constant(float(&term)?)),
        TermKind::Word(word) => {
            let input = Input::ALL.into_iter().find(|input| input.name() == word);
            return input.map(Step::Input).ok_or_else(|| (term.offset, format!("`{word}` is no input")));
        }
        _ => {}
    }
    let mut args = Args::new(term)?;
    let name = args.name;
    let step = if let Some(op) = Unary::ALL.into_iter().find(|op| op.name() == name) {
        Step::Unary(op, operand(&mut args)?)
    } else if let Some(op) = Binary::ALL.into_iter().find(|op| op.name() == name) {
        Step::Binary(op, operand(&mut args)?, operand(&mut args)?)
    } else if name == "select" {
        Step::Select(operand(&mut args)?, operand(&mut args)?, operand(&mut args)?)
    } else {
        let place = [operand(&mut args)?, operand(&mut args)?, operand(&mut args)?];
        let seed = args.integer("seed")?;
        let noise = match name {
            "noise" => Noise::Perlin { seed },
            "fbm" | "turbulence" => {
                let octaves = args.integer("octaves")?;
                let (lacunarity, gain) = (args.float("lacunarity")?, args.float("gain")?);
                if name == "fbm" {
                    Noise::Fbm { seed, octaves, lacunarity, gain }
                } else {
                    Noise::Turbulence { seed, octaves, lacunarity, gain }
                }
            }
            _ => return args.unknown("operation"),
        };
        Step::Noise(noise, place)
    };
    args.end()?;
    Ok(step)
}

fn operand(args: &mut Args) -> Result<u32, Fault> {
    integer(&args.next()?)
}
