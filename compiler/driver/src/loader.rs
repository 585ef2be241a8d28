//! The one way by which text reaches the compiler.

use std::sync::Arc;

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
    Other(String),
}

/// Access to files, granted by the caller. Paths use `/` and are relative to the root script's folder.
pub trait Loader {
    fn load(&self, path: &str) -> Result<Arc<str>, LoadError>;

    /// Whether a data file (a mesh, say) can be read. It is read later, by the renderer.
    fn probe(&self, path: &str) -> Result<(), LoadError>;

    /// The names of the files in a folder, `""` for the root script's, for messages that suggest one. Empty if unknown.
    fn list(&self, _folder: &str) -> Vec<String> {
        Vec::new()
    }
}
