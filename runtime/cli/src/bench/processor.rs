//! Processor time, which other programs on the machine leave alone.

use std::path::PathBuf;

use arsc_assembly::{Host, HostError};
use rustix::time::ClockId;

use crate::host::Machine;

/// Of this thread.
pub fn thread_seconds() -> f64 {
    seconds(ClockId::ThreadCPUTime)
}

/// Of this process: its threads together.
pub fn process_seconds() -> f64 {
    seconds(ClockId::ProcessCPUTime)
}

fn seconds(clock: ClockId) -> f64 {
    let now = rustix::time::clock_gettime(clock);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// A machine that writes nothing and whose clock is the processor time of this process.
pub struct ProcessorClock(pub Machine<'static>);

impl Host for ProcessorClock {
    fn write(&self, _: &str, _: &[u8]) -> Result<Option<PathBuf>, HostError> {
        Ok(None)
    }

    fn say(&self, line: &str) {
        self.0.say(line);
    }

    fn begin(&self, paths: u64, time_limit: Option<f64>) -> Box<dyn arsc_render::Progress + '_> {
        self.0.begin(paths, time_limit)
    }

    fn seconds(&self) -> f64 {
        process_seconds()
    }
}
