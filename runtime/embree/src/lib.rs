//! The one door to Embree 3.13: bindings and a safe wrapper. All `unsafe` of the project is in this crate and in `arsc-denoise`.
//!
//! A [`Device`] turns Embree's error callback into [`EmbreeError`]s and counts the bytes that Embree holds.
//! A [`SceneBuilder`] takes triangles, quads, user geometry and instances; [`SceneBuilder::commit`] gives a
//! [`Scene`], which is immutable and may be traced from any thread by [`Scene::intersect`] and [`Scene::occluded`].
//!
//! User geometry and hit filters are methods of the caller's [`Callbacks`]. They receive the caller's own query
//! state (a double-precision ray and the best hit so far, say), which travels behind Embree's intersection context.
//!
//! Invariants: nothing unwinds across the foreign frames (a panic in a callback is caught, the traversal is ended,
//! and the panic goes on in the caller's frame); rays with NaN or infinite members never reach Embree.
//! MXCSR (flush-to-zero, denormals-are-zero) is left as it is on every thread, so that results do not depend on
//! the thread.
//! Not here: any geometry of our own, which lives in `arsc-accel`.

#[allow(
    non_camel_case_types,
    non_snake_case,
    non_upper_case_globals,
    dead_code,
    clippy::all,
    clippy::undocumented_unsafe_blocks,
    missing_debug_implementations
)]
mod bindings {
    #[cfg(feature = "regen-bindings")]
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
    #[cfg(not(feature = "regen-bindings"))]
    include!("bindings.rs");
}

mod callbacks;
mod device;
mod scene;
mod trace;

pub use callbacks::{Bounds, Callbacks, Candidate, Step};
pub use device::{Device, EmbreeError};
pub use scene::{BuildQuality, GeometryId, Scene, SceneBuilder};
pub use trace::{NativeHit, Segment};

#[cfg(all(test, feature = "regen-bindings"))]
mod tests {
    /// The checked-in bindings are what bindgen makes of the installed headers.
    #[test]
    fn checked_in_bindings_are_current() {
        let words = |text: &str| text.split_whitespace().collect::<String>();
        let generated = include_str!(concat!(env!("OUT_DIR"), "/bindings.rs"));
        assert!(words(generated) == words(include_str!("bindings.rs")), "run with regen-bindings and copy the file");
    }
}
