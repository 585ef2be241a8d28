//! An expression: operations on numbers in an order in which they can be carried out.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::image::ImageMap;
use crate::noise::{MAX_OCTAVES, Noise};
use crate::operation::{Binary, Input, Unary};

/// One operation; operands are positions of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    Constant(f64),
    Input(Input),
    Unary(Unary, u32),
    Binary(Binary, u32, u32),
    /// The second operand where the first is not 0, else the third.
    Select(u32, u32, u32),
    Noise(Noise, [u32; 3]),
    /// A component, 0 to 2, of one of the expression's pictures at surface coordinates.
    Image {
        image: u32,
        channel: u8,
        uv: [u32; 2],
    },
}

impl Step {
    /// Calls `f` on each operand.
    pub fn for_each_operand(&mut self, mut f: impl FnMut(&mut u32)) {
        match self {
            Step::Constant(_) | Step::Input(_) => {}
            Step::Unary(_, a) => f(a),
            Step::Binary(_, a, b) => [a, b].into_iter().for_each(f),
            Step::Select(a, b, c) => [a, b, c].into_iter().for_each(f),
            Step::Noise(_, p) => p.iter_mut().for_each(f),
            Step::Image { uv, .. } => uv.iter_mut().for_each(f),
        }
    }

    /// The value; `of` gives those of operands.
    #[inline]
    pub(crate) fn value(&self, images: &[Arc<ImageMap>], inputs: &Inputs, of: impl Fn(u32) -> f64) -> f64 {
        match *self {
            Step::Constant(value) => value,
            Step::Input(input) => inputs.get(input),
            Step::Unary(op, a) => op.apply(of(a)),
            Step::Binary(op, a, b) => op.apply(of(a), of(b)),
            Step::Select(condition, a, b) => of(if of(condition) != 0.0 { a } else { b }),
            Step::Noise(noise, [x, y, z]) => noise.at(DVec3::new(of(x), of(y), of(z))),
            Step::Image { image, channel, uv: [u, v] } => {
                images[image as usize].channel(DVec2::new(of(u), of(v)), channel.into())
            }
        }
    }
}

/// What the surface gives at a point; see [`Input`]. Every number is finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {
    pub p: DVec3,
    pub world_p: DVec3,
    pub uv: DVec2,
    pub normal: DVec3,
    pub world_normal: DVec3,
    pub color: DVec3,
}

impl Inputs {
    #[inline]
    pub fn get(&self, input: Input) -> f64 {
        match input {
            Input::X => self.p.x,
            Input::Y => self.p.y,
            Input::Z => self.p.z,
            Input::WorldX => self.world_p.x,
            Input::WorldY => self.world_p.y,
            Input::WorldZ => self.world_p.z,
            Input::U => self.uv.x,
            Input::V => self.uv.y,
            Input::NormalX => self.normal.x,
            Input::NormalY => self.normal.y,
            Input::NormalZ => self.normal.z,
            Input::WorldNormalX => self.world_normal.x,
            Input::WorldNormalY => self.world_normal.y,
            Input::WorldNormalZ => self.world_normal.z,
            Input::Red => self.color.x,
            Input::Green => self.color.y,
            Input::Blue => self.color.z,
        }
    }
}

/// Which groups of inputs steps read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The space in which the material was attached.
    pub local: bool,
    pub uv: bool,
    pub color: bool,
}

impl Needs {
    pub fn of(steps: &[Step]) -> Needs {
        let mut needs = Needs::default();
        for step in steps {
            if let Step::Input(input) = step {
                match input {
                    Input::X | Input::Y | Input::Z | Input::NormalX | Input::NormalY | Input::NormalZ => {
                        needs.local = true;
                    }
                    Input::U | Input::V => needs.uv = true,
                    Input::Red | Input::Green | Input::Blue => needs.color = true,
                    _ => {}
                }
            }
        }
        needs
    }
}

/// Why steps are no expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpressionError {
    Empty,
    /// An operand does not stand before its step.
    Operand,
    NotFinite,
    /// More than [`MAX_OCTAVES`].
    Octaves,
    /// There is no such picture or component.
    Image,
}

impl std::fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            ExpressionError::Empty => "an expression has no steps",
            ExpressionError::Operand => "an operand does not stand before its step",
            ExpressionError::NotFinite => "a number of an expression is not finite",
            ExpressionError::Octaves => "a noise has too many octaves",
            ExpressionError::Image => "an expression has no such picture",
        })
    }
}

impl std::error::Error for ExpressionError {}

/// Steps whose last gives the value. Not empty; operands stand before their step; numbers are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    steps: Box<[Step]>,
    images: Box<[Arc<ImageMap>]>,
}

impl Expression {
    /// Of steps without pictures.
    pub fn new(steps: Vec<Step>) -> Result<Expression, ExpressionError> {
        Expression::with_images(steps, Vec::new())
    }

    /// Of steps that name these pictures.
    pub fn with_images(steps: Vec<Step>, images: Vec<Arc<ImageMap>>) -> Result<Expression, ExpressionError> {
        if steps.is_empty() {
            return Err(ExpressionError::Empty);
        }
        for (i, step) in steps.iter().enumerate() {
            let mut before = true;
            step.clone().for_each_operand(|&mut operand| before &= (operand as usize) < i);
            if !before {
                return Err(ExpressionError::Operand);
            }
            match *step {
                Step::Image { image, channel, .. } if image as usize >= images.len() || channel > 2 => {
                    return Err(ExpressionError::Image);
                }
                Step::Constant(value) if !value.is_finite() => return Err(ExpressionError::NotFinite),
                Step::Noise(Noise::Fbm { octaves, lacunarity, gain, .. }, _)
                | Step::Noise(Noise::Turbulence { octaves, lacunarity, gain, .. }, _) => {
                    if !(lacunarity.is_finite() && gain.is_finite()) {
                        return Err(ExpressionError::NotFinite);
                    }
                    if octaves > MAX_OCTAVES {
                        return Err(ExpressionError::Octaves);
                    }
                }
                _ => {}
            }
        }
        Ok(Expression { steps: steps.into(), images: images.into() })
    }

    pub fn constant(value: f64) -> Expression {
        let steps = Box::new([Step::Constant(if value.is_finite() { value } else { 0.0 })]);
        Expression { steps, images: Box::default() }
    }

    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    pub fn images(&self) -> &[Arc<ImageMap>] {
        &self.images
    }

    /// The value, if it is the same everywhere.
    pub fn as_constant(&self) -> Option<f64> {
        match self.steps[..] {
            [Step::Constant(value)] => Some(value),
            _ => None,
        }
    }

    pub fn needs(&self) -> Needs {
        Needs::of(&self.steps)
    }

    /// The value at a point. `scratch` is overwritten; kept, it saves its allocation.
    pub fn evaluate(&self, inputs: &Inputs, scratch: &mut Vec<f64>) -> f64 {
        evaluate(&self.steps, &self.images, inputs, scratch);
        scratch.last().copied().unwrap_or(0.0)
    }
}

/// The values of all steps, in `values`; operands must stand before their step.
#[inline]
pub fn evaluate(steps: &[Step], images: &[Arc<ImageMap>], inputs: &Inputs, values: &mut Vec<f64>) {
    values.clear();
    for step in steps {
        let value = step.value(images, inputs, |operand| values[operand as usize]);
        values.push(value);
    }
}
