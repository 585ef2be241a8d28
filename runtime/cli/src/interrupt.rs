//! Ctrl-C: once asks the render to stop and write what it has; twice ends the command at once.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::exit::Exit;

static PRESSED: AtomicUsize = AtomicUsize::new(0);

/// From now on Ctrl-C is a request. If the system refuses, Ctrl-C simply ends the command.
pub fn install() {
    let _ = ctrlc::set_handler(|| {
        if PRESSED.fetch_add(1, Ordering::SeqCst) == 0 {
            eprintln!("\ninterrupted: writing what has been rendered (Ctrl-C again to stop at once)");
        } else {
            // Files are written whole or not at all, so that leaving here tears nothing.
            std::process::exit(i32::from(Exit::Interrupted.code()));
        }
    });
}

pub fn requested() -> bool {
    PRESSED.load(Ordering::Relaxed) > 0
}
