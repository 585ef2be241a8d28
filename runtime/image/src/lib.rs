//! Image types and files.
//!
//! Files are written whole or not at all: into a temporary beside the target, then renamed.

mod spectral;

pub use spectral::SpectralImage;
