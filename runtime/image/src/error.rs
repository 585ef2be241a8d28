//! What can go wrong with image files.

use std::path::PathBuf;

/// An operational error; the cause is chained as its source.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    #[error("cannot write {}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error("cannot encode the image as {format}")]
    Encode { format: &'static str, source: Box<dyn std::error::Error + Send + Sync> },
    #[error("cannot decode the {format} image")]
    Decode { format: &'static str, source: Box<dyn std::error::Error + Send + Sync> },
    /// The buffers do not fit the stated size, or the image has no pixel.
    #[error("{what} holds {found} values where {expected} are due")]
    Shape { what: &'static str, found: usize, expected: usize },
    #[error("not a spectral image: {0}")]
    NotSpectral(String),
    /// No format that is read here.
    #[error(
        "not a picture of a kind that is read: spectral or RGB OpenEXR, PNG, JPEG, TIFF, Radiance HDR, CSV of bands, ARTRAW"
    )]
    Unknown,
    /// Right in form, wrong in content.
    #[error("the picture cannot be used: {0}")]
    Malformed(String),
}
