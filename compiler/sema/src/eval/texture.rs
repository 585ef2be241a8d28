//! Values that vary over a surface: numbers, vectors and spectra made of steps of the machine's expression graph.
//!
//! A value of a texture type that is the same everywhere is an ordinary value (a number, a vector, a tuple of numbers, a
//! spectrum): plain materials stay plain.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_ir::{ColorTexture, Expression, ImageMap, Parameter, Spectrum, SpectrumTerm, SpectrumTexture};
use arsc_syntax::ast::BinaryOp;
use arsc_texture::{Binary, Inputs, Step, StepId, Unary};
use glam::{DVec2, DVec3};

use super::{Eval, Machine, limit};
use crate::code::Site;
use crate::value::Value;

/// Steps of one expression, and terms of one spectrum.
const MAX_STEPS: usize = 10_000;
const MAX_TERMS: usize = 256;

/// What varies.
#[derive(Clone, Debug)]
pub enum Texture {
    /// A number or an angle in radians; a truth value as 1 or 0.
    Scalar(StepId),
    /// Two or three components.
    Vector(Vec<StepId>),
    /// The sum of weighted spectra.
    Spectrum(Vec<Term>),
}

/// A spectrum of a texture: weight times spectrum times colour.
#[derive(Clone, Debug)]
pub struct Term {
    pub weight: StepId,
    pub spectrum: Arc<Spectrum>,
    pub color: Option<Color>,
}

/// A colour that varies.
#[derive(Clone, Debug, PartialEq)]
pub enum Color {
    /// Linear sRGB.
    Rgb([StepId; 3]),
    Image {
        image: Arc<ImageMap>,
        uv: [StepId; 2],
    },
}

impl Machine<'_> {
    fn step_of(&mut self, op: Binary, a: StepId, b: StepId) -> StepId {
        self.expressions.binary(op, a, b)
    }

    /// A number that may vary.
    pub fn scalar(&mut self, value: &Value) -> StepId {
        match value {
            Value::Texture(texture) => match &**texture {
                Texture::Scalar(id) => *id,
                other => panic!("the checker let pass {other:?} where a number is needed"),
            },
            Value::Bool(truth) => self.expressions.constant(f64::from(*truth)),
            other => self.expressions.constant(other.as_float()),
        }
    }

    /// The components of a vector that may vary.
    pub fn components(&mut self, value: &Value) -> Vec<StepId> {
        match value {
            Value::Texture(texture) => match &**texture {
                Texture::Vector(components) => components.clone(),
                other => panic!("the checker let pass {other:?} where a vector is needed"),
            },
            Value::Vec2(v) => v.to_array().map(|c| self.expressions.constant(c)).to_vec(),
            Value::Vec3(v) => v.to_array().map(|c| self.expressions.constant(c)).to_vec(),
            other => other.as_tuple().iter().map(|part| self.scalar(part)).collect(),
        }
    }

    fn terms(&mut self, value: &Value) -> Vec<Term> {
        if let Value::Texture(texture) = value {
            return match &**texture {
                Texture::Spectrum(terms) => terms.clone(),
                // Greys.
                Texture::Scalar(weight) => vec![Term { weight: *weight, spectrum: white(), color: None }],
                Texture::Vector(_) => panic!("the checker let pass a vector where a spectrum is needed"),
            };
        }
        let spectrum = match value {
            Value::Spectrum(spectrum) => spectrum.clone(),
            other => Arc::new(Spectrum::Constant(other.as_float())),
        };
        let mut terms = Vec::new();
        let one = self.expressions.constant(1.0);
        self.add_term(&mut terms, Term { weight: one, spectrum, color: None });
        terms
    }

    /// Greys are one spectrum.
    fn add_term(&mut self, terms: &mut Vec<Term>, mut term: Term) {
        if let Spectrum::Constant(value) = *term.spectrum {
            let value = self.expressions.constant(value);
            term.weight = self.step_of(Binary::Multiply, term.weight, value);
            term.spectrum = white();
        }
        let is_same = |known: &Term| {
            let greys = matches!((&*known.spectrum, &*term.spectrum), (Spectrum::Constant(_), Spectrum::Constant(_)));
            (greys || Arc::ptr_eq(&known.spectrum, &term.spectrum)) && known.color == term.color
        };
        match terms.iter_mut().find(|known| is_same(known)) {
            Some(known) => known.weight = self.expressions.binary(Binary::Add, known.weight, term.weight),
            None => terms.push(term),
        }
    }

    /// A value of steps; an ordinary one where they are constant.
    pub fn scalar_value(&self, id: StepId) -> Value {
        match self.expressions.as_constant(id) {
            Some(value) => Value::Float(value),
            None => Value::Texture(Arc::new(Texture::Scalar(id))),
        }
    }

    pub fn vector_value(&self, components: Vec<StepId>) -> Value {
        let constants: Option<Vec<f64>> = components.iter().map(|id| self.expressions.as_constant(*id)).collect();
        match constants.as_deref() {
            Some([x, y]) => Value::Vec2(DVec2::new(*x, *y)),
            Some([x, y, z]) => Value::Vec3(DVec3::new(*x, *y, *z)),
            _ => Value::Texture(Arc::new(Texture::Vector(components))),
        }
    }

    fn spectrum_value(&self, terms: Vec<Term>, span: Span) -> Eval {
        if terms.len() > MAX_TERMS {
            return Err(limit(span, "spectra in one texture", MAX_TERMS as u64, "blend fewer spectra"));
        }
        if let [Term { weight, spectrum, color: None }] = &terms[..]
            && let Some(weight) = self.expressions.as_constant(*weight)
        {
            return super::scale_value(&Value::Spectrum(spectrum.clone()), weight, span);
        }
        Ok(Value::Texture(Arc::new(Texture::Spectrum(terms))))
    }

    /// An operation on numbers or on each component of vectors; a number beside a vector counts for each.
    pub fn texture_map2(&mut self, op: Binary, a: &Value, b: &Value) -> Value {
        match (is_vector(a), is_vector(b)) {
            (false, false) => {
                let (a, b) = (self.scalar(a), self.scalar(b));
                let result = self.step_of(op, a, b);
                self.scalar_value(result)
            }
            (vector_a, vector_b) => {
                let n = if vector_a { self.components(a).len() } else { self.components(b).len() };
                let mut all = |value: &Value, is_vector: bool| {
                    if is_vector { self.components(value) } else { vec![self.scalar(value); n] }
                };
                let (a, b) = (all(a, vector_a), all(b, vector_b));
                let parts = a.into_iter().zip(b).map(|(a, b)| self.step_of(op, a, b)).collect();
                self.vector_value(parts)
            }
        }
    }

    pub fn texture_map(&mut self, op: Unary, a: &Value) -> Value {
        if is_vector(a) {
            let parts = self.components(a).into_iter().map(|a| self.expressions.unary(op, a)).collect();
            return self.vector_value(parts);
        }
        let a = self.scalar(a);
        let result = self.expressions.unary(op, a);
        self.scalar_value(result)
    }

    pub(super) fn texture_binary(&mut self, op: BinaryOp, a: &Value, b: &Value, span: Span) -> Eval {
        self.spend_elements(1, span)?;
        if is_spectrum(a) || is_spectrum(b) {
            return self.spectrum_binary(op, a, b, span);
        }
        if let Value::Transform(map) = a {
            let p = self.components(b);
            let columns = map.to_cols_array();
            let rows = (0..3).map(|row| {
                let mut sum = self.expressions.constant(columns[9 + row]);
                for (column, &x) in p.iter().enumerate() {
                    let factor = self.expressions.constant(columns[3 * column + row]);
                    let product = self.step_of(Binary::Multiply, factor, x);
                    sum = self.step_of(Binary::Add, sum, product);
                }
                sum
            });
            let rows = rows.collect();
            return Ok(self.vector_value(rows));
        }
        let (op, a, b) = match op {
            BinaryOp::Add => (Binary::Add, a, b),
            BinaryOp::Sub => (Binary::Subtract, a, b),
            BinaryOp::Mul => (Binary::Multiply, a, b),
            BinaryOp::Div => (Binary::Divide, a, b),
            BinaryOp::Rem => (Binary::Modulo, a, b),
            BinaryOp::Pow => (Binary::Power, a, b),
            BinaryOp::Lt => (Binary::Less, a, b),
            BinaryOp::Le => (Binary::LessOrEqual, a, b),
            BinaryOp::Gt => (Binary::Less, b, a),
            BinaryOp::Ge => (Binary::LessOrEqual, b, a),
            BinaryOp::And => (Binary::And, a, b),
            BinaryOp::Or => (Binary::Or, a, b),
            BinaryOp::Eq => (Binary::Equal, a, b),
            BinaryOp::Ne => {
                let equal = self.texture_map2(Binary::Equal, a, b);
                return Ok(self.texture_map(Unary::Not, &equal));
            }
            BinaryOp::Union | BinaryOp::Intersection => panic!("the checker let pass {op:?} of textures"),
        };
        Ok(self.texture_map2(op, a, b))
    }

    fn spectrum_binary(&mut self, op: BinaryOp, a: &Value, b: &Value, span: Span) -> Eval {
        let mut result = Vec::new();
        match op {
            BinaryOp::Add => {
                result = self.terms(a);
                for term in self.terms(b) {
                    self.add_term(&mut result, term);
                }
            }
            BinaryOp::Mul if is_spectrum(a) && is_spectrum(b) => {
                let (a, b) = (self.terms(a), self.terms(b));
                self.spend_elements(a.len() * b.len(), span)?;
                for a in &a {
                    for b in &b {
                        let weight = self.step_of(Binary::Multiply, a.weight, b.weight);
                        if a.color.is_some() && b.color.is_some() {
                            let message = "two colours that vary cannot be multiplied";
                            let failure = Diagnostic::new(codes::OPERANDS, message).label(span, "here");
                            return Err(Box::new(
                                failure.help("multiply their components, and make one colour by `rgb`"),
                            ));
                        }
                        let color = a.color.clone().or(b.color.clone());
                        let spectrum = product(&a.spectrum, &b.spectrum);
                        self.add_term(&mut result, Term { weight, spectrum, color });
                    }
                }
            }
            _ => {
                let (spectrum, factor) = if is_spectrum(a) { (a, b) } else { (b, a) };
                let factor = self.scalar(factor);
                let op = if op == BinaryOp::Div { Binary::Divide } else { Binary::Multiply };
                for term in self.terms(spectrum) {
                    result.push(Term { weight: self.step_of(op, term.weight, factor), ..term });
                }
            }
        }
        self.spend_elements(result.len(), span)?;
        self.spectrum_value(result, span)
    }

    /// `a` where the condition holds, else `b`.
    pub fn texture_select(&mut self, condition: &Value, a: &Value, b: &Value, span: Span) -> Eval {
        let condition = self.scalar(condition);
        if is_spectrum(a) || is_spectrum(b) {
            let not = self.expressions.unary(Unary::Not, condition);
            let truth = self.expressions.unary(Unary::Not, not);
            return self.weighted_sum(truth, a, not, b, span);
        }
        if is_vector(a) {
            let (a, b) = (self.components(a), self.components(b));
            let parts = a.into_iter().zip(b).map(|(a, b)| self.expressions.select(condition, a, b)).collect();
            return Ok(self.vector_value(parts));
        }
        let (a, b) = (self.scalar(a), self.scalar(b));
        let result = self.expressions.select(condition, a, b);
        Ok(self.scalar_value(result))
    }

    /// (1 - t) a + t b.
    pub fn texture_lerp(&mut self, a: &Value, b: &Value, t: &Value, span: Span) -> Eval {
        let t = self.scalar(t);
        let one = self.expressions.constant(1.0);
        let rest = self.step_of(Binary::Subtract, one, t);
        if is_spectrum(a) || is_spectrum(b) {
            return self.weighted_sum(rest, a, t, b, span);
        }
        let (rest, t) = (self.scalar_value(rest), self.scalar_value(t));
        let a = self.texture_map2(Binary::Multiply, a, &rest);
        let b = self.texture_map2(Binary::Multiply, b, &t);
        Ok(self.texture_map2(Binary::Add, &a, &b))
    }

    fn weighted_sum(&mut self, wa: StepId, a: &Value, wb: StepId, b: &Value, span: Span) -> Eval {
        let mut result = Vec::new();
        for (factor, value) in [(wa, a), (wb, b)] {
            for term in self.terms(value) {
                let weight = self.step_of(Binary::Multiply, term.weight, factor);
                self.add_term(&mut result, Term { weight, ..term });
            }
        }
        self.spend_elements(result.len(), span)?;
        self.spectrum_value(result, span)
    }

    /// What the renderer evaluates.
    pub fn expression(&self, id: StepId, span: Span) -> Eval<Expression> {
        let expression = self.expressions.expression(id);
        if expression.steps().len() > MAX_STEPS {
            return Err(limit(span, "operations in one expression", MAX_STEPS as u64, "make it simpler"));
        }
        Ok(expression)
    }

    /// A number of a bsdf: its value, or `standing` where it varies and `parameter` is added.
    pub fn number_parameter(
        &mut self,
        value: &Value,
        standing: f64,
        parameter: fn(Expression) -> Parameter,
        parameters: &mut Vec<Parameter>,
        span: Span,
    ) -> Eval<f64> {
        if !is_varying(value) {
            return Ok(value.as_float());
        }
        let id = self.scalar(value);
        parameters.push(parameter(self.expression(id, span)?));
        Ok(standing)
    }

    /// A reflectance of a bsdf: the spectrum, or grey where it varies and a parameter is added.
    pub fn reflectance_parameter(
        &mut self,
        value: &Value,
        parameters: &mut Vec<Parameter>,
        site: &Site,
        arg: usize,
    ) -> Eval<Spectrum> {
        if !is_varying(value) {
            self.lint_reflectance(value, site, arg);
            return Ok(value.as_spectrum().as_ref().clone());
        }
        let texture = self.spectrum_texture(value, site.args[arg])?;
        self.lint_varying_reflectance(&texture, site, arg);
        parameters.push(Parameter::Reflectance(texture));
        Ok(Spectrum::Constant(0.5))
    }

    fn spectrum_texture(&mut self, value: &Value, span: Span) -> Eval<SpectrumTexture> {
        let mut terms = Vec::new();
        for Term { weight, spectrum, color } in self.terms(value) {
            let weight = self.expression(weight, span)?;
            let color = color.map(|color| self.color(&color, span)).transpose()?;
            terms.push(SpectrumTerm { weight, spectrum: spectrum.as_ref().clone(), color });
        }
        Ok(SpectrumTexture { terms })
    }

    fn color(&self, color: &Color, span: Span) -> Eval<ColorTexture> {
        let of = |id: StepId| self.expression(id, span);
        Ok(match color {
            Color::Rgb([r, g, b]) => ColorTexture::Rgb([of(*r)?, of(*g)?, of(*b)?]),
            Color::Image { image, uv: [u, v] } => ColorTexture::Image { image: image.clone(), uv: [of(*u)?, of(*v)?] },
        })
    }

    /// A reflectance of a colour that varies.
    pub fn color_value(&mut self, color: Color) -> Value {
        let weight = self.expressions.constant(1.0);
        Value::Texture(Arc::new(Texture::Spectrum(vec![Term { weight, spectrum: white(), color: Some(color) }])))
    }

    /// Looks for a place where a reflectance leaves [0, 1]: at points of a cube of 4 m about the origin.
    fn lint_varying_reflectance(&mut self, texture: &SpectrumTexture, site: &Site, arg: usize) {
        const PLACES: usize = 200;
        const SLACK: f64 = 1e-6;
        let lambdas = [400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0];
        let spectra: Vec<[f64; 7]> =
            texture.terms.iter().map(|term| lambdas.map(|nm| term.spectrum.eval(nm))).collect();
        let (mut low, mut high) = (0.0f64, 1.0f64);
        let mut scratch = Vec::new();
        for i in 0..PLACES {
            let inputs = place(i);
            let mut sum = [0.0; 7];
            for (term, values) in texture.terms.iter().zip(&spectra) {
                let weight = term.weight.evaluate(&inputs, &mut scratch) * brightness(term, &inputs, &mut scratch);
                sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
            }
            low = sum.iter().fold(low, |a, b| a.min(*b));
            high = sum.iter().fold(high, |a, b| a.max(*b));
        }
        if low >= -SLACK && high <= 1.0 + SLACK {
            return;
        }
        let shown = |x: f64| (x * 1e3).round() / 1e3;
        let (message, reached) = if high > 1.0 + SLACK {
            ("the reflectance exceeds 1 in places: it is limited there", shown(high))
        } else {
            ("the reflectance falls below 0 in places: it is limited there", shown(low))
        };
        self.lint(
            Diagnostic::new(codes::REFLECTANCE_ABOVE_ONE, message)
                .label(site.args[arg], format!("reaches {reached}"))
                .help("keep it within 0 and 1: noise goes from -1 to 1, `clamp(x, 0, 1)` limits"),
        );
    }
}

fn white() -> Arc<Spectrum> {
    Arc::new(Spectrum::Constant(1.0))
}

/// The largest component of a term's colour.
fn brightness(term: &SpectrumTerm, inputs: &Inputs, scratch: &mut Vec<f64>) -> f64 {
    match &term.color {
        None => 1.0,
        Some(ColorTexture::Rgb(rgb)) => rgb.iter().map(|c| c.evaluate(inputs, scratch)).fold(0.0, f64::max),
        Some(ColorTexture::Image { image, uv: [u, v] }) => {
            let uv = DVec2::new(u.evaluate(inputs, scratch), v.evaluate(inputs, scratch));
            (0..3).map(|channel| image.channel(uv, channel)).fold(0.0, f64::max)
        }
    }
}

/// The i-th of places spread over a cube, surface coordinates and directions (Roberts' sequence: powers of the root of
/// x⁷ = x + 1).
fn place(i: usize) -> Inputs {
    let at = |k: i32| (0.5 + i as f64 * 1.112_775_684_278_705_5f64.powi(-k)).fract();
    let p = DVec3::new(at(1), at(2), at(3)) * 4.0 - 2.0;
    let normal = (DVec3::new(at(4), at(5), at(6)) - 0.5).normalize_or(DVec3::Z);
    Inputs {
        p,
        world_p: p,
        uv: DVec2::new(at(1), at(2)),
        normal,
        world_normal: normal,
        color: DVec3::new(at(4), at(5), at(6)),
    }
}

fn product(a: &Arc<Spectrum>, b: &Arc<Spectrum>) -> Arc<Spectrum> {
    match (&**a, &**b) {
        (Spectrum::Constant(x), _) if *x == 1.0 => b.clone(),
        (_, Spectrum::Constant(x)) if *x == 1.0 => a.clone(),
        _ => Arc::new(Spectrum::Product(a.clone(), b.clone())),
    }
}

/// The value differs from place to place.
pub fn is_varying(value: &Value) -> bool {
    matches!(value, Value::Texture(_))
}

fn is_spectrum(value: &Value) -> bool {
    match value {
        Value::Spectrum(_) => true,
        Value::Texture(texture) => matches!(**texture, Texture::Spectrum(_)),
        _ => false,
    }
}

fn is_vector(value: &Value) -> bool {
    match value {
        Value::Vec2(_) | Value::Vec3(_) | Value::Tuple(_) => true,
        Value::Texture(texture) => matches!(**texture, Texture::Vector(_)),
        _ => false,
    }
}

impl Texture {
    /// A component of a vector.
    pub fn component(&self, i: usize) -> StepId {
        match self {
            Texture::Vector(components) => components[i],
            other => panic!("the checker let pass {other:?} where a vector is needed"),
        }
    }

    /// An input of the surface, or several.
    pub fn inputs(m: &mut Machine<'_>, inputs: &[arsc_texture::Input]) -> Value {
        let ids: Vec<StepId> = inputs.iter().map(|input| m.expressions.add(Step::Input(*input))).collect();
        match ids[..] {
            [id] => m.scalar_value(id),
            _ => m.vector_value(ids),
        }
    }
}
