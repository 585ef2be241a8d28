//! Why a scene could not be rendered.

use crate::host::HostError;

/// An operational error; the cause is chained as its source.
#[derive(Debug, thiserror::Error)]
pub enum AssemblyError {
    /// The IR is not what `arsc-opt` promises: a bug of the compiler.
    #[error("the scene is not in normal form: {0}")]
    NotNormal(&'static str),
    #[error("cannot write {name}")]
    Write { name: String, source: HostError },
    #[error("cannot read {name}")]
    Read { name: String, source: HostError },
    #[error("`{action}` cannot use the picture")]
    Imaging { action: &'static str, source: arsc_imaging::ImagingError },
    #[error("cannot denoise the picture")]
    Denoise(#[from] arsc_denoise::DenoiseError),
    #[error("cannot make the picture")]
    Image(#[from] arsc_image::ImageError),
    #[error("cannot build the scene for tracing")]
    Accel(#[source] HostError),
    /// Stack effects are checked by the compiler; this guards IR that was written by hand.
    #[error("`{action}` needs {needs} on the stack, but {found} is there")]
    Stack { action: &'static str, needs: &'static str, found: &'static str },
    #[error("{0}")]
    Settings(String),
}
