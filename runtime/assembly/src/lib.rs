//! From the IR to a picture: the one place that turns IR into runtime objects, and the action sequence.
//!
//! In goes an IR in the normal form that `arsc-opt` documents; everything else (spans, parameters, file names as the
//! author wrote them) ends here. Pictures, messages, progress and the clock are reached through [`Host`] alone.
//! [`run`] does the whole; [`trace_scene`] gives the geometry alone, for questions about rays.

mod camera;
mod error;
mod geometry;
mod host;
mod lights;
mod materials;
mod measure;
mod measure_rays;
mod pictures;
mod rendering;
mod sequence;
mod settings;
mod stage;
#[cfg(test)]
mod tests;

pub use error::AssemblyError;
pub use host::{Host, HostError};
pub use measure::{Measurement, measure};
pub use measure_rays::{RayMeasurement, Sight, measure_rays};
pub use rendering::RenderReport;
pub use sequence::{Outcome, actions, run};
pub use settings::Settings;

/// The geometry of a scene in normal form, built for tracing.
pub fn trace_scene(ir: &arsc_ir::Ir, strategy: arsc_accel::Strategy) -> Result<arsc_accel::Scene, AssemblyError> {
    stage::build(geometry::lower(ir)?, strategy.into())
}
