//! The intermediate representation of a scene: data, fully resolved.
//!
//! Units: metres, radians, nanometres, kelvin. Ids are indices into the tables of one [`Ir`] and stay stable
//! within a pass. Invariants (checked by the verifier): children come before parents, so the node table is a
//! topological order of an acyclic graph; every id is in range; every map is finite and invertible; sizes are
//! finite and positive; only closed nodes are operands of Boolean nodes, but for what the pass `split_lights`
//! has not yet taken out of unions.
//! Provenance: each node keeps the span of the expression that made it.

mod action;
mod args;
mod builder;
mod camera;
mod camera_text;
mod graph;
mod image_action;
mod light;
mod light_text;
mod material;
mod medium;
mod node;
mod print;
mod read;
mod shape_text;
mod term;
mod varying;
mod varying_text;
mod verify;
mod write;

pub use action::{Action, PathTrace, Sampler, Sampling, Strategy};
pub use builder::Builder;
pub use camera::{Across, Camera, Filter, FisheyeMapping, Focus, Lens, Projection};
pub use image_action::ImageAction;
pub use light::{Environment, Light, Sky, SkyModel};
pub use material::{Attributes, Bsdf, CutRule, Distribution, Emitter, Facets, Material, MaterialId};
pub use medium::{Density, Medium, PhaseFunction};
pub use node::{Leaf, Node, NodeId, NodeKind, Precedence, Surface};
pub use read::{Contents, ReadError, read, read_with};
pub use varying::{ColorTexture, Parameter, Part, SpectrumTerm, SpectrumTexture, Varying};
pub use verify::{Violation, verify};

pub use arsc_geometry::{Aabb, Shape};
pub use arsc_spectral::tone::{Exposure, ToneMap};
pub use arsc_spectral::{DonaldsonMatrix, Dye, Fluorescence, Observer, Reradiation, Spectrum, WavelengthRange};
pub use arsc_texture::{Expression, ImageMap};

/// A scene with its camera and its action sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct Ir {
    /// Children before parents.
    pub nodes: Vec<Node>,
    /// The whole scene: before optimisation a union of everything that the `scene` block collected.
    pub root: NodeId,
    /// What attributes and leaves refer to.
    pub bsdfs: Vec<Bsdf>,
    pub emitters: Vec<Emitter>,
    pub media: Vec<Medium>,
    /// Filled by the pass that propagates attributes to leaves.
    pub materials: Vec<Material>,
    pub camera: Option<Camera>,
    pub actions: Vec<ActionAt>,
}

/// An action and where it was written.
#[derive(Clone, Debug, PartialEq)]
pub struct ActionAt {
    pub action: Action,
    pub origin: arsc_diagnostics::Span,
}
