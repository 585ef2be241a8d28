//! This machine as the renderer sees it: files through [`crate::files`], messages on standard error, the clock.

use std::path::PathBuf;
use std::time::Instant;

use arsc_assembly::{Host, HostError};
use arsc_driver::LoadError;

use crate::files::{Output, ScriptFolder, read_picture};
use crate::progress::Progress;

pub struct Machine<'a> {
    /// `None`: nothing is written.
    pub output: Option<&'a Output>,
    pub quiet: bool,
    /// What a script may read while it renders.
    folder: Option<ScriptFolder>,
    start: Instant,
}

impl<'a> Machine<'a> {
    pub fn new(output: Option<&'a Output>, quiet: bool) -> Machine<'a> {
        Machine { output, quiet, folder: None, start: Instant::now() }
    }

    /// Lets pictures be read below a folder.
    pub fn reading(self, folder: std::io::Result<ScriptFolder>) -> Machine<'a> {
        Machine { folder: folder.ok(), ..self }
    }
}

impl Host for Machine<'_> {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<Option<PathBuf>, HostError> {
        let Some(output) = self.output else { return Ok(None) };
        let place = output.place(name)?;
        if let Some(place) = &place {
            arsc_image::write_whole(place, bytes)?;
        }
        Ok(place)
    }

    fn read(&self, name: &str) -> Result<Vec<u8>, HostError> {
        let Some(folder) = &self.folder else { return Err("no folder to read from".into()) };
        let place = folder.resolve(name).map_err(|error| match error {
            LoadError::NotFound => "there is no such file",
            LoadError::Forbidden => "it lies outside of the script's folder",
            _ => "it cannot be read",
        })?;
        Ok(read_picture(&place)?)
    }

    fn say(&self, line: &str) {
        eprintln!("{line}");
    }

    fn begin(&self, paths: u64, time_limit: Option<f64>) -> Box<dyn arsc_render::Progress + '_> {
        Box::new(Progress::new(paths, time_limit, self.quiet))
    }

    fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}
