//! What a run needs from outside: a place for pictures and messages, and somebody to tell about progress.

use std::path::PathBuf;

/// A failure of the host, with its own words.
pub type HostError = Box<dyn std::error::Error + Send + Sync>;

/// The world outside of the renderer.
pub trait Host {
    /// Writes a picture whole or not at all. `name` is the script's and relative to the output folder. Gives the
    /// place, or `None` if the picture is not wanted.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<Option<PathBuf>, HostError>;

    /// The bytes of a picture that the script names, which lies below its folder.
    fn read(&self, name: &str) -> Result<Vec<u8>, HostError> {
        Err(format!("{name} cannot be read here").into())
    }

    /// A line for people: what an action prints.
    fn say(&self, line: &str);

    /// A render of so many camera paths at most begins; the answer is told how it goes, and ends the render after
    /// `time_limit` seconds.
    fn begin(&self, paths: u64, time_limit: Option<f64>) -> Box<dyn arsc_render::Progress + '_>;

    /// Seconds since some fixed moment, for timings.
    fn seconds(&self) -> f64;
}
