//! Exit codes.

use std::process::ExitCode;

/// How the command ended. The numbers are documented in [`HELP`] and stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done, nothing to complain about.
    Clean,
    /// The script has errors, or a check has findings.
    Findings,
    /// Could not run: bad arguments, a file that cannot be read or written.
    CouldNotRun,
    /// A bug of arsc.
    Bug,
    /// Ctrl-C. What had been rendered was written, unless Ctrl-C was pressed twice.
    Interrupted,
}

pub const HELP: &str = "\
Exit status:
  0    done
  1    findings: the script has errors (or `check` has something to say)
  2    could not run: bad arguments, or a file that cannot be read or written
  101  a bug of arsc; the report says what to send
  130  interrupted by Ctrl-C; what had been rendered was written (pressed twice: nothing was)";

impl Exit {
    pub const fn code(self) -> u8 {
        match self {
            Exit::Clean => 0,
            Exit::Findings => 1,
            Exit::CouldNotRun => 2,
            Exit::Bug => 101,
            Exit::Interrupted => 130,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit.code())
    }
}
