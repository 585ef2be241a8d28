//! The text form of what varies over a surface.
//!
//! ```text
//! varying(part(lambert(reflectance: constant(0.5)), weight: expression(1.0), reflectance: blend(
//!     term(expression(x, 0.0, less(1, 0)), constant(0.8)))))
//! ```
//!
//! An expression lists its steps: a number, an input by its name, or an operation on earlier steps, counted from 0.

use std::fmt::{self, Display, Formatter};
use std::sync::Arc;

use arsc_texture::{Binary, Expression, ImageMap, Input, Noise, Step, Unary};

use crate::args::{Args, float, integer};
use crate::print::{Quoted, Text};
use crate::read::{Contents, bsdf, spectrum};
use crate::term::{Fault, Term, TermKind};
use crate::varying::{ColorTexture, Parameter, Part, SpectrumTerm, SpectrumTexture, Varying};
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
        let call = Call::new(f, "term")?.value(Text(&self.0.weight))?.value(Text(&self.0.spectrum))?;
        match &self.0.color {
            None => call.end(),
            Some(color) => call.arg("color", Text(color))?.end(),
        }
    }
}

impl Display for Text<'_, ColorTexture> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            ColorTexture::Rgb([r, g, b]) => Call::new(f, "rgb")?.value(Text(r))?.value(Text(g))?.value(Text(b))?.end(),
            ColorTexture::Image { image, uv: [u, v] } => {
                picture(Call::new(f, "image")?.value(Text(u))?.value(Text(v))?, image)?.end()
            }
        }
    }
}

fn picture<'a, 'b>(call: Call<'a, 'b>, image: &ImageMap) -> Result<Call<'a, 'b>, fmt::Error> {
    let call = call.arg("path", Quoted(&image.path))?.arg("repeat", image.repeat)?;
    call.arg("smooth", image.smooth)?.arg("data", image.data)
}

impl Display for Text<'_, Expression> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let call = Call::new(f, "expression")?;
        self.0.steps().iter().try_fold(call, |call, step| call.value(Text(&(step, self.0.images()))))?.end()
    }
}

/// A step, with the pictures of its expression.
impl Display for Text<'_, (&Step, &[Arc<ImageMap>])> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (step, images) = *self.0;
        match *step {
            Step::Image { image, channel, uv: [u, v] } => {
                let call = Call::new(f, "image")?.value(u)?.value(v)?.arg("channel", channel)?;
                picture(call, &images[image as usize])?.end()
            }
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

pub(crate) fn varying(mut args: Args, contents: &dyn Contents) -> Result<Varying, Fault> {
    let texture_from_object = args.map()?;
    let mut parts = Vec::new();
    while !args.rest.is_empty() {
        parts.push(part(args.next()?, contents)?);
    }
    Ok(Varying { parts, texture_from_object })
}

fn named<'a>(term: Term<'a>, name: &str) -> Result<Args<'a>, Fault> {
    let args = Args::new(term)?;
    if args.name == name { Ok(args) } else { args.unknown(name) }
}

fn part(term: Term, contents: &dyn Contents) -> Result<Part, Fault> {
    let expression = |term| expression(term, contents);
    let mut args = named(term, "part")?;
    let mut part =
        Part { bsdf: bsdf(args.next()?, contents)?, weight: expression(args.take("weight")?)?, parameters: vec![] };
    // The order of the parameters is part of what equality means.
    while let Some((name, _)) = args.rest.front() {
        let (name, offset) = (*name, args.offset);
        let Some((_, term)) = args.rest.pop_front() else { break };
        part.parameters.push(match name {
            Some("reflectance") => Parameter::Reflectance(blend(term, contents)?),
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

fn blend(term: Term, contents: &dyn Contents) -> Result<SpectrumTexture, Fault> {
    let mut args = named(term, "blend")?;
    let mut terms = Vec::new();
    while !args.rest.is_empty() {
        let mut term = named(args.next()?, "term")?;
        let (weight, spectrum) = (expression(term.next()?, contents)?, spectrum(term.next()?)?);
        let color = term.optional("color").map(|color| color_texture(color, contents)).transpose()?;
        terms.push(SpectrumTerm { weight, spectrum, color });
        term.end()?;
    }
    Ok(SpectrumTexture { terms })
}

fn color_texture(term: Term, contents: &dyn Contents) -> Result<ColorTexture, Fault> {
    let mut args = Args::new(term)?;
    let mut next = || expression(args.next()?, contents);
    let first = [next()?, next()?];
    let color = match args.name {
        "rgb" => {
            let [r, g] = first;
            ColorTexture::Rgb([r, g, expression(args.next()?, contents)?])
        }
        "image" => ColorTexture::Image { uv: first, image: image_map(&mut args, contents)? },
        _ => return args.unknown("colour"),
    };
    args.end()?;
    Ok(color)
}

fn image_map(args: &mut Args, contents: &dyn Contents) -> Result<Arc<ImageMap>, Fault> {
    let path = args.text("path")?;
    let Some(raster) = contents.image(&path) else {
        return Err((args.offset, format!("there is no image `{path}`")));
    };
    let (repeat, smooth, data) = (args.boolean("repeat")?, args.boolean("smooth")?, args.boolean("data")?);
    Ok(Arc::new(ImageMap::new(path.into(), raster, repeat, smooth, data)))
}

fn expression(term: Term, contents: &dyn Contents) -> Result<Expression, Fault> {
    let mut args = named(term, "expression")?;
    let offset = args.offset;
    let (mut steps, mut images) = (Vec::new(), Vec::new());
    while !args.rest.is_empty() {
        steps.push(step(args.next()?, &mut images, contents)?);
    }
    Expression::with_images(steps, images).map_err(|error| (offset, error.to_string()))
}

fn step(term: Term, images: &mut Vec<Arc<ImageMap>>, contents: &dyn Contents) -> Result<Step, Fault> {
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
    } else if name == "image" {
        let uv = [operand(&mut args)?, operand(&mut args)?];
        let channel = args.integer("channel")?;
        let map = image_map(&mut args, contents)?;
        let known = images.iter().position(|known| *known == map);
        let image = known.unwrap_or(images.len()) as u32;
        images.extend(known.is_none().then_some(map));
        Step::Image { image, channel, uv }
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
