//! Derivatives of expressions along two directions of the surface, exact, by carrying them through every step (forward
//! differentiation). Where a step has none (jumps, corners) it counts as 0, or as that of one side.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::expression::{Inputs, Step};
use crate::image::ImageMap;
use crate::noise::Noise;
use crate::operation::{Binary, Unary};

/// A value and its derivatives along the two directions.
pub type Dual = (f64, DVec2);

/// The values of all steps with their derivatives; `along` holds the derivatives of the inputs. Operands must stand
/// before their step.
pub fn evaluate_gradients(
    steps: &[Step],
    images: &[Arc<ImageMap>],
    inputs: &Inputs,
    along: &[Inputs; 2],
    values: &mut Vec<Dual>,
) {
    values.clear();
    for step in steps {
        let value = step.value(images, inputs, |operand| values[operand as usize].0);
        let of = |operand: u32| values[operand as usize];
        let slope = match *step {
            Step::Constant(_) => DVec2::ZERO,
            Step::Input(input) => DVec2::new(along[0].get(input), along[1].get(input)),
            Step::Unary(op, a) => of(a).1 * op.slope(of(a).0),
            Step::Binary(op, a, b) => {
                let [by_a, by_b] = op.slopes(of(a).0, of(b).0);
                of(a).1 * by_a + of(b).1 * by_b
            }
            Step::Select(condition, a, b) => of(if of(condition).0 != 0.0 { a } else { b }).1,
            Step::Noise(noise, [x, y, z]) => {
                let gradient = noise.gradient(DVec3::new(of(x).0, of(y).0, of(z).0));
                of(x).1 * gradient.x + of(y).1 * gradient.y + of(z).1 * gradient.z
            }
            Step::Image { image, channel, uv: [u, v] } => {
                let place = DVec2::new(of(u).0, of(v).0);
                let slope = images[image as usize].channel_slope(place, channel.into());
                of(u).1 * slope.x + of(v).1 * slope.y
            }
        };
        values.push((value, if slope.is_finite() { slope } else { DVec2::ZERO }));
    }
}

impl Unary {
    fn slope(self, a: f64) -> f64 {
        match self {
            Unary::Negate => -1.0,
            Unary::Abs => a.signum(),
            Unary::Floor | Unary::Not => 0.0,
            Unary::Sqrt if a <= 0.0 => 0.0,
            Unary::Sqrt => 0.5 / a.sqrt(),
            Unary::Exp => a.exp(),
            Unary::Ln if a < f64::MIN_POSITIVE => 0.0,
            Unary::Ln => 1.0 / a,
            Unary::Sin => a.cos(),
            Unary::Cos => -a.sin(),
            Unary::Asin | Unary::Acos if a.abs() >= 1.0 => 0.0,
            Unary::Asin => 1.0 / (1.0 - a * a).sqrt(),
            Unary::Acos => -1.0 / (1.0 - a * a).sqrt(),
        }
    }
}

impl Binary {
    /// By the first and the second operand.
    fn slopes(self, a: f64, b: f64) -> [f64; 2] {
        match self {
            Binary::Add => [1.0, 1.0],
            Binary::Subtract => [1.0, -1.0],
            Binary::Multiply => [b, a],
            Binary::Divide | Binary::Modulo if b == 0.0 => [0.0; 2],
            Binary::Divide => [1.0 / b, -a / (b * b)],
            Binary::Modulo => [1.0, -a.div_euclid(b)],
            Binary::Power => {
                let power = a.powf(b);
                let by_b = if a > 0.0 { power * a.ln() } else { 0.0 };
                let slopes = [b * a.powf(b - 1.0), by_b];
                if power.is_finite() { slopes.map(|s| if s.is_finite() { s } else { 0.0 }) } else { [0.0; 2] }
            }
            Binary::Min => {
                if a <= b {
                    [1.0, 0.0]
                } else {
                    [0.0, 1.0]
                }
            }
            Binary::Max => {
                if a >= b {
                    [1.0, 0.0]
                } else {
                    [0.0, 1.0]
                }
            }
            Binary::Atan2 if a == 0.0 && b == 0.0 => [0.0; 2],
            Binary::Atan2 => [b / (a * a + b * b), -a / (a * a + b * b)],
            Binary::Less | Binary::LessOrEqual | Binary::Equal | Binary::And | Binary::Or => [0.0; 2],
        }
    }
}

impl Noise {
    /// By the place.
    fn gradient(&self, p: DVec3) -> DVec3 {
        let (seed, octaves, lacunarity, gain, creased) = match *self {
            Noise::Perlin { seed } => return crate::noise::perlin_gradient(p, seed).1,
            Noise::Fbm { seed, octaves, lacunarity, gain } => (seed, octaves, lacunarity, gain, false),
            Noise::Turbulence { seed, octaves, lacunarity, gain } => (seed, octaves, lacunarity, gain, true),
        };
        let mut sum = DVec3::ZERO;
        crate::noise::octaves(p, seed, octaves, lacunarity, gain, |p, seed, weight, frequency| {
            let (value, gradient) = crate::noise::perlin_gradient(p, seed);
            let sign = if creased { value.signum() } else { 1.0 };
            sum += gradient * (sign * weight * frequency);
        });
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::{ExpressionGraph, StepId};
    use crate::operation::Input;

    /// Against central differences, where the function is smooth.
    #[track_caller]
    fn check(what: &str, make: impl Fn(&mut ExpressionGraph, [StepId; 3]) -> StepId) {
        let mut g = ExpressionGraph::default();
        let p = [Input::X, Input::Y, Input::Z].map(|input| g.add(Step::Input(input)));
        let root = make(&mut g, p);
        let expression = g.expression(root);
        let at = DVec3::new(0.37, 0.61, 1.83);
        let directions = [DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.8, 0.3, 0.5)];
        let of = |p: DVec3| Inputs { p, ..Inputs::default() };
        let mut values = Vec::new();
        evaluate_gradients(expression.steps(), &[], &of(at), &directions.map(of), &mut values);
        let (value, slopes) = *values.last().unwrap();
        let plain = |p: DVec3| expression.evaluate(&of(p), &mut Vec::new());
        assert_eq!(value, plain(at), "{what}");
        let h = 1e-6;
        for (direction, slope) in directions.into_iter().zip(slopes.to_array()) {
            let wanted = (plain(at + direction * h) - plain(at - direction * h)) / (2.0 * h);
            assert!((slope - wanted).abs() < 1e-7 * (1.0 + wanted.abs()), "{what}: {slope} is not {wanted}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        for op in Unary::ALL {
            check(&format!("{op:?}"), |g, [x, ..]| g.unary(op, x));
        }
        for op in Binary::ALL {
            check(&format!("{op:?}"), |g, [x, y, z]| {
                let product = g.binary(Binary::Multiply, y, z);
                g.binary(op, x, product)
            });
            check(&format!("{op:?} the other way round"), |g, [x, y, z]| {
                let product = g.binary(Binary::Multiply, y, z);
                g.binary(op, product, x)
            });
        }
        check("select", |g, [x, y, z]| g.select(x, y, z));
        let noises = [
            Noise::Perlin { seed: 3 },
            Noise::Fbm { seed: 3, octaves: 4, lacunarity: 2.1, gain: 0.6 },
            Noise::Turbulence { seed: 3, octaves: 4, lacunarity: 2.1, gain: 0.6 },
        ];
        for noise in noises {
            check(&format!("{noise:?}"), |g, [x, y, z]| {
                let square = g.binary(Binary::Multiply, x, x);
                g.add(Step::Noise(noise, [square.0, y.0, z.0]))
            });
        }
    }
}
