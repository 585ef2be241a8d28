//! Bsdfs, lights, cameras, samplers, film and integrators.
//!
//! An integrator sees a [`World`] and a [`Camera`], and gives a [`Film`]: sums and weights per pixel and band, mergeable.
//! Every random number is a function of (seed, pixel, sample, dimension): same seed, same bytes, whatever the threads.
//! Transport is generic over [`polarisation::Polarisation`], and compiled for light with and without.
//! Radiometry: radiance in W m^-2 sr^-1 nm^-1, one scene unit is one metre (docs/radiometry.md).

mod absorptance;
mod ambient_occlusion;
pub mod bsdf;
mod camera;
#[cfg(test)]
mod conformance;
mod emitter;
mod features;
mod film;
mod filter;
mod first_hit;
mod frame;
pub mod fresnel;
mod integrator;
mod interiors;
pub mod light;
mod medium;
mod noise;
mod passes;
mod path_trace;
mod phase;
pub mod polarisation;
mod preview;
mod sampler;
mod varying;
mod volume;
pub mod warp;
mod world;

pub use ambient_occlusion::ambient_occlusion;
pub use bsdf::{Bsdf, BsdfSample};
pub use camera::{Across, Camera, CameraRay, FisheyeMapping, Lens, Projection, View};
pub use emitter::AreaEmitter;
pub use features::features;
pub use film::{Bands, Film, FilmMismatch, Tile};
pub use filter::{FilterSample, FilterShape, ReconstructionFilter};
pub use frame::Frame;
pub use integrator::incident_radiance;
pub use light::{Environment, EnvironmentSample, Light, SkyModel, SkySettings};
pub use medium::{Density, Medium};
pub use passes::{Pass, Progress, Sampling};
pub use path_trace::{PathTraceSettings, path_trace};
pub use phase::PhaseFunction;
pub use preview::preview;
pub use sampler::{SampleSequence, Sampler};
pub use varying::{ColorTexture, Parameter, SpectrumTerm, VaryingBsdf, VaryingPart};
pub use world::{LightSource, Material, Media, World};
