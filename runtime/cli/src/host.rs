//! This machine as the renderer sees it: files through [`crate::files`], messages on standard error, the clock.

use std::path::PathBuf;
use std::time::Instant;

use arsc_assembly::{Host, HostError};

use crate::files::Output;
use crate::progress::Progress;

pub struct Machine<'a> {
    /// `None`: nothing is written.
    pub output: Option<&'a Output>,
    pub quiet: bool,
    start: Instant,
}

impl<'a> Machine<'a> {
    pub fn new(output: Option<&'a Output>, quiet: bool) -> Machine<'a> {
        Machine { output, quiet, start: Instant::now() }
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

    fn say(&self, line: &str) {
        eprintln!("{line}");
    }

    fn begin(&self, paths: u64) -> Box<dyn arsc_render::Progress + '_> {
        Box::new(Progress::new(paths, self.quiet))
    }

    fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}
