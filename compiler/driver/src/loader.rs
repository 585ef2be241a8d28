//! The one way by which text reaches the compiler.

use std::sync::Arc;

use arsc_geometry::TriangleMesh;

/// Why a text could not be had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoadError {
    NotFound,
    /// Not UTF-8; the offset of the first bad byte.
    NotText(usize),
    TooLarge {
        bytes: u64,
    },
    /// Outside of what may be read.
    Forbidden,
    /// A mesh that is not what its format demands; the reason.
    Malformed(String),
    Other(String),
}

/// Access to files, granted by the caller. Paths use `/` and are relative to the root script's folder.
pub trait Loader {
    fn load(&self, path: &str) -> Result<Arc<str>, LoadError>;

    /// A triangle mesh. Asked for once for each path.
    fn mesh(&self, path: &str) -> Result<Arc<TriangleMesh>, LoadError>;

    /// The bytes of a data file: an image, a grid of densities.
    fn bytes(&self, _path: &str) -> Result<Arc<[u8]>, LoadError> {
        Err(LoadError::NotFound)
    }

    /// The names of the files in a folder, `""` for the root script's, for messages that suggest one. Empty if unknown.
    fn list(&self, _folder: &str) -> Vec<String> {
        Vec::new()
    }
}
