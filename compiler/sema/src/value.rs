//! Values that evaluation handles.
//!
//! Invariants: floats are finite; a value has the static type that the checker gave its expression, so that the
//! accessors below cannot fail on a checked program (a failure is a bug, and says so).

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};

use arsc_ir::{
    Across, Action, ActionAt, Attributes, Camera, Density, Distribution, Dye, Exposure, Filter, FisheyeMapping, NodeId,
    Observer, PhaseFunction, Reradiation, Sampler, SkyModel, Spectrum, Strategy,
};

use crate::code::{Coercion, FnId};
use crate::eval::Texture;
use crate::registry::BuiltinId;

#[derive(Clone, Debug)]
pub enum Value {
    /// An optional argument that was not given.
    Missing,
    Bool(bool),
    Int(i64),
    /// Also angles (rad), wavelengths (nm), temperatures (K).
    Float(f64),
    Vec2(DVec2),
    /// Also points and directions.
    Vec3(DVec3),
    Str(Arc<str>),
    List(Arc<Vec<Value>>),
    /// Also records, fields in the order of their type.
    Tuple(Arc<[Value]>),
    Fn(Arc<Closure>),
    Transform(Arc<DAffine3>),
    Spectrum(Arc<Spectrum>),
    /// What varies over a surface; values that do not stay what they are.
    Texture(Arc<Texture>),
    /// A shape, light or environment.
    Node(NodeId),
    Attributes(Attributes),
    PhaseFunction(PhaseFunction),
    Density(Arc<Density>),
    Reradiation(Arc<Reradiation>),
    Dye(Arc<Dye>),
    Camera(Arc<Camera>),
    Filter(Arc<Filter>),
    Across(Across),
    FisheyeMapping(FisheyeMapping),
    Sampler(Sampler),
    Action(Arc<ActionAt>),
    Exposure(Exposure),
    Observer(Observer),
    Strategy(Strategy),
    Distribution(Distribution),
    SkyModel(SkyModel),
}

/// A function value.
#[derive(Clone, Debug)]
pub enum Closure {
    User {
        function: FnId,
        captures: Box<[Value]>,
    },
    /// Called with the first arguments only; the others take their defaults.
    Builtin(BuiltinId),
    /// Another function whose arguments and result are converted.
    Converted {
        inner: Arc<Closure>,
        parts: Box<[Option<Coercion>]>,
    },
}

fn bug(wanted: &str, found: &Value) -> ! {
    panic!("the checker let pass {found:?} where the evaluator needs {wanted}")
}

impl Value {
    pub fn unit() -> Value {
        Value::Tuple(Arc::new([]))
    }

    pub fn list(elements: Vec<Value>) -> Value {
        Value::List(Arc::new(elements))
    }

    pub fn str(text: impl Into<Arc<str>>) -> Value {
        Value::Str(text.into())
    }

    pub fn spectrum(spectrum: Spectrum) -> Value {
        Value::Spectrum(Arc::new(spectrum))
    }

    pub fn is_given(&self) -> bool {
        !matches!(self, Value::Missing)
    }

    pub fn as_bool(&self) -> bool {
        match self {
            Value::Bool(b) => *b,
            other => bug("a bool", other),
        }
    }

    pub fn as_int(&self) -> i64 {
        match self {
            Value::Int(i) => *i,
            other => bug("an int", other),
        }
    }

    /// Ints too: generic builtins take either.
    pub fn as_float(&self) -> f64 {
        match self {
            Value::Float(x) => *x,
            Value::Int(i) => *i as f64,
            other => bug("a float", other),
        }
    }

    pub fn as_vec2(&self) -> DVec2 {
        match self {
            Value::Vec2(v) => *v,
            other => bug("a vector", other),
        }
    }

    pub fn as_vec3(&self) -> DVec3 {
        match self {
            Value::Vec3(v) => *v,
            other => bug("a vector", other),
        }
    }

    pub fn as_str(&self) -> &Arc<str> {
        match self {
            Value::Str(text) => text,
            other => bug("a string", other),
        }
    }

    pub fn as_list(&self) -> &Arc<Vec<Value>> {
        match self {
            Value::List(list) => list,
            other => bug("a list", other),
        }
    }

    pub fn as_tuple(&self) -> &Arc<[Value]> {
        match self {
            Value::Tuple(elements) => elements,
            other => bug("a tuple", other),
        }
    }

    pub fn as_fn(&self) -> &Arc<Closure> {
        match self {
            Value::Fn(closure) => closure,
            other => bug("a function", other),
        }
    }

    pub fn as_transform(&self) -> &DAffine3 {
        match self {
            Value::Transform(map) => map,
            other => bug("a transform", other),
        }
    }

    pub fn as_spectrum(&self) -> &Arc<Spectrum> {
        match self {
            Value::Spectrum(spectrum) => spectrum,
            other => bug("a spectrum", other),
        }
    }

    pub fn as_node(&self) -> NodeId {
        match self {
            Value::Node(id) => *id,
            other => bug("a shape", other),
        }
    }

    pub fn as_attributes(&self) -> Attributes {
        match self {
            Value::Attributes(attributes) => *attributes,
            other => bug("attributes", other),
        }
    }

    pub fn as_phase_function(&self) -> PhaseFunction {
        match self {
            Value::PhaseFunction(phase) => *phase,
            other => bug("a phase function", other),
        }
    }

    pub fn as_density(&self) -> &Arc<Density> {
        match self {
            Value::Density(density) => density,
            other => bug("a density", other),
        }
    }

    pub fn as_reradiation(&self) -> &Arc<Reradiation> {
        match self {
            Value::Reradiation(reradiation) => reradiation,
            other => bug("a reradiation", other),
        }
    }

    pub fn as_dye(&self) -> &Arc<Dye> {
        match self {
            Value::Dye(dye) => dye,
            other => bug("a dye", other),
        }
    }

    pub fn as_camera(&self) -> &Arc<Camera> {
        match self {
            Value::Camera(camera) => camera,
            other => bug("a camera", other),
        }
    }

    pub fn as_filter(&self) -> Filter {
        match self {
            Value::Filter(filter) => **filter,
            other => bug("a filter", other),
        }
    }

    pub fn as_across(&self) -> Across {
        match self {
            Value::Across(across) => *across,
            other => bug("what a field of view refers to", other),
        }
    }

    pub fn as_fisheye_mapping(&self) -> FisheyeMapping {
        match self {
            Value::FisheyeMapping(mapping) => *mapping,
            other => bug("a mapping of a fisheye", other),
        }
    }

    pub fn as_sampler(&self) -> Sampler {
        match self {
            Value::Sampler(sampler) => *sampler,
            other => bug("a sampler", other),
        }
    }

    pub fn as_exposure(&self) -> Exposure {
        match self {
            Value::Exposure(exposure) => *exposure,
            other => bug("an exposure", other),
        }
    }

    pub fn as_sky_model(&self) -> SkyModel {
        match self {
            Value::SkyModel(model) => *model,
            other => bug("a sky model", other),
        }
    }

    pub fn as_distribution(&self) -> Distribution {
        match self {
            Value::Distribution(distribution) => *distribution,
            other => bug("a distribution", other),
        }
    }

    pub fn as_observer(&self) -> Observer {
        match self {
            Value::Observer(observer) => *observer,
            other => bug("an observer", other),
        }
    }

    pub fn as_strategy(&self) -> Strategy {
        match self {
            Value::Strategy(strategy) => *strategy,
            other => bug("a strategy", other),
        }
    }

    pub fn as_action(&self) -> &Arc<ActionAt> {
        match self {
            Value::Action(action) => action,
            other => bug("an action", other),
        }
    }

    pub fn action(action: Action, origin: arsc_diagnostics::Span) -> Value {
        Value::Action(Arc::new(ActionAt { action, origin }))
    }
}
