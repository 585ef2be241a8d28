//! Building expressions: equal steps once, constants folded.
//!
//! Rewrites keep every value, bit for bit but for the sign of zero: x + 0, x - 0, x · 1, x / 1 and `select` on a
//! constant or on equal operands give an operand; x · 0 gives 0, for no value is infinite.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::expression::{Expression, Inputs, Step};
use crate::image::ImageMap;
use crate::noise::Noise;
use crate::operation::{Binary, Unary};

/// A step of an [`ExpressionGraph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StepId(pub u32);

/// Steps of any number of expressions.
#[derive(Clone, Debug, Default)]
pub struct ExpressionGraph {
    steps: Vec<Step>,
    known: FxHashMap<Key, u32>,
    images: Vec<Arc<ImageMap>>,
}

impl ExpressionGraph {
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// The pictures that steps name.
    pub fn images(&self) -> &[Arc<ImageMap>] {
        &self.images
    }

    /// A component, 0 to 2, of a picture at surface coordinates.
    pub fn image(&mut self, image: &Arc<ImageMap>, channel: u8, uv: [StepId; 2]) -> StepId {
        let known = self.images.iter().position(|known| known == image);
        let index = known.unwrap_or_else(|| {
            self.images.push(image.clone());
            self.images.len() - 1
        });
        self.add(Step::Image { image: index as u32, channel, uv: uv.map(|id| id.0) })
    }

    /// All steps; operands stand before their step.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    pub fn constant(&mut self, value: f64) -> StepId {
        // Adding 0 makes one zero of two.
        self.push(Step::Constant(if value.is_finite() { value + 0.0 } else { 0.0 }))
    }

    /// The value of a step, if it is the same everywhere.
    pub fn as_constant(&self, id: StepId) -> Option<f64> {
        match self.steps[id.0 as usize] {
            Step::Constant(value) => Some(value),
            _ => None,
        }
    }

    pub fn unary(&mut self, op: Unary, a: StepId) -> StepId {
        self.add(Step::Unary(op, a.0))
    }

    pub fn binary(&mut self, op: Binary, a: StepId, b: StepId) -> StepId {
        self.add(Step::Binary(op, a.0, b.0))
    }

    pub fn select(&mut self, condition: StepId, a: StepId, b: StepId) -> StepId {
        self.add(Step::Select(condition.0, a.0, b.0))
    }

    /// The step, or one that has the same value. Operands are steps of this graph.
    pub fn add(&mut self, mut step: Step) -> StepId {
        if let Step::Binary(op, a, b) = &mut step
            && op.commutes()
            && a > b
        {
            std::mem::swap(a, b);
        }
        if let Some(same) = self.operand_of_equal_value(&step) {
            return StepId(same);
        }
        match self.folded(step) {
            Some(value) => self.constant(value),
            None => self.push(step),
        }
    }

    /// Takes the steps of an expression over.
    pub fn insert(&mut self, expression: &Expression) -> StepId {
        let mut ids: Vec<u32> = Vec::with_capacity(expression.steps().len());
        for step in expression.steps() {
            let mut step = *step;
            step.for_each_operand(|operand| *operand = ids[*operand as usize]);
            ids.push(match step {
                Step::Image { image, channel, uv } => {
                    self.image(&expression.images()[image as usize], channel, uv.map(StepId)).0
                }
                _ => self.add(step).0,
            });
        }
        StepId(ids.last().copied().unwrap_or(0))
    }

    /// The steps that the value of `root` needs, in order.
    pub fn expression(&self, root: StepId) -> Expression {
        let mut needed = vec![false; root.0 as usize + 1];
        needed[root.0 as usize] = true;
        // Operands stand before their step: one sweep finds operands of operands.
        for i in (0..needed.len()).rev() {
            if needed[i] {
                self.mark_operands(i, &mut needed);
            }
        }
        let mut position = vec![0; needed.len()];
        let (mut steps, mut images) = (Vec::new(), Vec::<Arc<ImageMap>>::new());
        for i in (0..needed.len()).filter(|i| needed[*i]) {
            let mut step = self.steps[i];
            step.for_each_operand(|operand| *operand = position[*operand as usize]);
            if let Step::Image { image, .. } = &mut step {
                let map = &self.images[*image as usize];
                let known = images.iter().position(|known| known == map);
                *image = known.unwrap_or(images.len()) as u32;
                images.extend(known.is_none().then(|| map.clone()));
            }
            position[i] = steps.len() as u32;
            steps.push(step);
        }
        Expression::with_images(steps, images).expect("a graph holds sound steps")
    }

    fn mark_operands(&self, i: usize, needed: &mut [bool]) {
        let mut step = self.steps[i];
        step.for_each_operand(|operand| needed[*operand as usize] = true);
    }

    fn operand_of_equal_value(&self, step: &Step) -> Option<u32> {
        let is = |operand: u32, value: f64| self.as_constant(StepId(operand)) == Some(value);
        match *step {
            Step::Binary(Binary::Add, a, b) if is(a, 0.0) => Some(b),
            Step::Binary(Binary::Add | Binary::Subtract, a, b) if is(b, 0.0) => Some(a),
            Step::Binary(Binary::Multiply, a, b) if is(a, 1.0) || is(b, 0.0) => Some(b),
            Step::Binary(Binary::Multiply, a, b) if is(b, 1.0) || is(a, 0.0) => Some(a),
            Step::Binary(Binary::Divide, a, b) if is(b, 1.0) => Some(a),
            Step::Binary(Binary::Min | Binary::Max, a, b) if a == b => Some(a),
            Step::Select(_, a, b) if a == b => Some(a),
            Step::Select(condition, a, b) => {
                let condition = self.as_constant(StepId(condition))?;
                Some(if condition != 0.0 { a } else { b })
            }
            _ => None,
        }
    }

    /// The value of a step whose operands are constants.
    fn folded(&self, mut step: Step) -> Option<f64> {
        let mut constant = !matches!(step, Step::Input(_));
        step.for_each_operand(|operand| constant &= self.as_constant(StepId(*operand)).is_some());
        let of = |operand: u32| self.as_constant(StepId(operand)).unwrap_or(0.0);
        constant.then(|| step.value(&self.images, &Inputs::default(), of))
    }

    fn push(&mut self, step: Step) -> StepId {
        let next = self.steps.len() as u32;
        let id = *self.known.entry(Key(step)).or_insert(next);
        if id == next {
            self.steps.push(step);
        }
        StepId(id)
    }
}

/// A step without NaN and negative zero: equality is an equivalence.
#[derive(Clone, Debug, PartialEq)]
struct Key(Step);

impl Eq for Key {}

impl Hash for Key {
    fn hash<H: Hasher>(&self, hasher: &mut H) {
        std::mem::discriminant(&self.0).hash(hasher);
        match self.0 {
            Step::Constant(value) => hash_f64(value, hasher),
            Step::Input(input) => input.hash(hasher),
            Step::Unary(op, a) => (op, a).hash(hasher),
            Step::Binary(op, a, b) => (op, a, b).hash(hasher),
            Step::Select(a, b, c) => (a, b, c).hash(hasher),
            Step::Image { image, channel, uv } => (image, channel, uv).hash(hasher),
            Step::Noise(noise, p) => {
                p.hash(hasher);
                match noise {
                    Noise::Perlin { seed } => seed.hash(hasher),
                    Noise::Fbm { seed, octaves, lacunarity, gain }
                    | Noise::Turbulence { seed, octaves, lacunarity, gain } => {
                        (seed, octaves).hash(hasher);
                        hash_f64(lacunarity, hasher);
                        hash_f64(gain, hasher);
                    }
                }
            }
        }
    }
}

/// The hasher multiplies, which carries nothing down to the low bits: the high ones go there, too.
fn hash_f64<H: Hasher>(value: f64, hasher: &mut H) {
    let bits = (value + 0.0).to_bits();
    (bits ^ bits >> 32).hash(hasher);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operation::Input;
    use glam::DVec3;

    fn at(p: DVec3) -> Inputs {
        Inputs { p, ..Inputs::default() }
    }

    #[test]
    fn equal_steps_are_one_and_constants_fold() {
        let mut g = ExpressionGraph::default();
        let (x, y) = (g.add(Step::Input(Input::X)), g.add(Step::Input(Input::Y)));
        assert_eq!(g.binary(Binary::Add, x, y), g.binary(Binary::Add, y, x));
        assert_ne!(g.binary(Binary::Subtract, x, y), g.binary(Binary::Subtract, y, x));
        let (two, zero) = (g.constant(2.0), g.constant(-0.0));
        let four = g.binary(Binary::Multiply, two, two);
        assert_eq!(g.as_constant(four), Some(4.0));
        assert_eq!(g.binary(Binary::Add, x, zero), x);
        assert_eq!(g.binary(Binary::Multiply, x, zero), zero);
        assert_eq!(g.select(two, x, y), x);
        let noise = g.add(Step::Noise(Noise::Perlin { seed: 0 }, [two.0, four.0, zero.0]));
        assert_eq!(g.as_constant(noise), Some(0.0), "at the lattice");
    }

    #[test]
    fn an_expression_holds_what_it_needs_and_goes_back_in() {
        let mut g = ExpressionGraph::default();
        let x = g.add(Step::Input(Input::X));
        let unused = g.unary(Unary::Sin, x);
        let y = g.add(Step::Input(Input::Y));
        let square = g.binary(Binary::Multiply, y, y);
        let root = g.binary(Binary::Subtract, square, x);
        let expression = g.expression(root);
        assert_eq!(expression.steps().len(), 4);
        assert!(expression.needs().local && !expression.needs().uv);
        let mut scratch = Vec::new();
        assert_eq!(expression.evaluate(&at(DVec3::new(2.0, 5.0, 0.0)), &mut scratch), 23.0);
        assert_eq!(g.insert(&expression), root);
        assert_ne!(root, unused);
    }

    /// Folding and evaluation agree on every operation, nasty operands included, and give finite numbers.
    #[test]
    fn folding_is_evaluation_and_all_is_finite() {
        let numbers = [0.0, -0.5, 1.0, -3.0, 0.7, 1e308, -1e308, 1e-320, 2.5];
        for a in numbers {
            for op in Unary::ALL {
                check(|g, x, _| g.unary(op, x), a, 0.0, &format!("{op:?} of {a}"));
            }
            for b in numbers {
                for op in Binary::ALL {
                    check(|g, x, y| g.binary(op, x, y), a, b, &format!("{op:?} of {a}, {b}"));
                }
            }
        }
    }

    fn check(make: impl Fn(&mut ExpressionGraph, StepId, StepId) -> StepId, a: f64, b: f64, what: &str) {
        let mut g = ExpressionGraph::default();
        let (x, y) = (g.add(Step::Input(Input::X)), g.add(Step::Input(Input::Y)));
        let varying = make(&mut g, x, y);
        let value = g.expression(varying).evaluate(&at(DVec3::new(a, b, 0.0)), &mut Vec::new());
        let (x, y) = (g.constant(a), g.constant(b));
        let folded = make(&mut g, x, y);
        assert_eq!(g.as_constant(folded), Some(value), "{what}");
        assert!(value.is_finite(), "{what} is {value}");
    }

    #[test]
    fn operations_do_what_their_names_say() {
        let unary = [
            (Unary::Negate, 2.0, -2.0),
            (Unary::Abs, -2.0, 2.0),
            (Unary::Floor, -0.5, -1.0),
            (Unary::Sqrt, 9.0, 3.0),
            (Unary::Sqrt, -9.0, 0.0),
            (Unary::Exp, 0.0, 1.0),
            (Unary::Ln, 1.0, 0.0),
            (Unary::Sin, 0.0, 0.0),
            (Unary::Cos, 0.0, 1.0),
            (Unary::Acos, 2.0, 0.0),
            (Unary::Not, 0.0, 1.0),
            (Unary::Not, 3.0, 0.0),
        ];
        for (op, a, wanted) in unary {
            assert_eq!(op.apply(a), wanted, "{op:?} of {a}");
        }
        let binary = [
            (Binary::Subtract, 2.0, 5.0, -3.0),
            (Binary::Divide, 1.0, 4.0, 0.25),
            (Binary::Divide, 1.0, 0.0, 0.0),
            (Binary::Modulo, -0.25, 1.0, 0.75),
            (Binary::Modulo, 5.0, 0.0, 0.0),
            (Binary::Modulo, -1e-300, 1.0, 0.0),
            (Binary::Power, 2.0, 10.0, 1024.0),
            (Binary::Power, -2.0, 0.5, 0.0),
            (Binary::Min, 2.0, 5.0, 2.0),
            (Binary::Max, 2.0, 5.0, 5.0),
            (Binary::Less, 2.0, 2.0, 0.0),
            (Binary::LessOrEqual, 2.0, 2.0, 1.0),
            (Binary::And, 1.0, 0.0, 0.0),
            (Binary::Or, 1.0, 0.0, 1.0),
            (Binary::Atan2, 0.0, 0.0, 0.0),
        ];
        for (op, a, b, wanted) in binary {
            assert_eq!(op.apply(a, b), wanted, "{op:?} of {a}, {b}");
        }
    }
}
