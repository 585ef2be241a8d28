//! Shading expressions: numbers that vary over a surface.
//!
//! Pure data and mathematics, shared by the compiler, which builds and folds them, and the renderer, which evaluates them
//! at hits. An [`Expression`] is a list of operations on numbers, each naming earlier ones; vectors are three of them. An
//! [`ExpressionGraph`] makes expressions: equal operations once, those on constants at once.
//!
//! Conventions: lengths in metres, angles in radians; true is 1 and false is 0. Every operation is total: where
//! mathematics has no finite value the result is a stated finite one, so that no NaN and no infinity reaches a renderer.

mod expression;
mod gradient;
mod graph;
mod image;
mod noise;
mod operation;

pub use expression::{Expression, ExpressionError, Inputs, Needs, Step, evaluate};
pub use gradient::{Dual, evaluate_gradients};
pub use graph::{ExpressionGraph, StepId};
pub use image::ImageMap;
pub use noise::{MAX_OCTAVES, Noise, PERLIN_BOUND, perlin};
pub use operation::{Binary, Input, Unary};
