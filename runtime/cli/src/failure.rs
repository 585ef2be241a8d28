//! Operational errors on standard error: what failed, and why, down to the root.

use std::error::Error;

use crate::exit::Exit;

/// Prints the chain of causes. Gives the exit of what could not run.
pub fn failure(error: &dyn Error) -> Exit {
    eprintln!("error: {error}");
    let mut cause = error.source();
    while let Some(error) = cause {
        eprintln!("  because: {error}");
        cause = error.source();
    }
    Exit::CouldNotRun
}
