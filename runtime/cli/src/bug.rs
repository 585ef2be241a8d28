//! Bugs: panics, caught at the top and reported with the stage, the seed and a request to report.

use std::sync::Mutex;

use crate::exit::Exit;

/// What was being done, for the report.
#[derive(Clone)]
struct Situation {
    stage: &'static str,
    seed: Option<u64>,
}

static SITUATION: Mutex<Situation> = Mutex::new(Situation { stage: "start", seed: None });
static FIRST_PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Names what is being done from here on.
pub fn stage(name: &'static str) {
    if let Ok(mut situation) = SITUATION.lock() {
        situation.stage = name;
    }
}

/// Names the seed of the render.
pub fn seed(seed: u64) {
    if let Ok(mut situation) = SITUATION.lock() {
        situation.seed = Some(seed);
    }
}

/// Runs `work` on a thread with `stack` bytes of stack; a panic in it becomes a report on standard error.
pub fn guarded(stack: usize, work: impl FnOnce() -> Exit + Send + 'static) -> Exit {
    std::panic::set_hook(Box::new(|panic| {
        // Only the first panic counts: others are its echo in other threads.
        if let Ok(mut first) = FIRST_PANIC.lock() {
            first.get_or_insert_with(|| panic.to_string());
        }
    }));
    let thread = std::thread::Builder::new().name("arsc".into()).stack_size(stack).spawn(work);
    let end = thread.map(std::thread::JoinHandle::join);
    drop(std::panic::take_hook());
    match end {
        Ok(Ok(exit)) => exit,
        Ok(Err(_)) => {
            report();
            Exit::Bug
        }
        Err(error) => {
            eprintln!("error: cannot start a thread: {error}");
            Exit::CouldNotRun
        }
    }
}

fn report() {
    let panic = FIRST_PANIC.lock().ok().and_then(|mut first| first.take()).unwrap_or_default();
    let situation = SITUATION.lock().map(|s| s.clone()).unwrap_or(Situation { stage: "unknown", seed: None });
    let seed = situation.seed.map_or_else(String::new, |seed| format!(", seed {seed}"));
    eprintln!("\nbug: arsc {} failed in stage `{}`{seed}", env!("CARGO_PKG_VERSION"), situation.stage);
    eprintln!("  {}", panic.replace('\n', "\n  "));
    eprintln!("This is not your scene's fault. Please report it with these lines, the command line and the scene.");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_in_any_thread_of_the_work_is_a_bug_and_not_the_end() {
        assert_eq!(guarded(1 << 20, || Exit::Clean), Exit::Clean);
        assert_eq!(guarded(1 << 20, || panic!("a bug of the test")), Exit::Bug);
        let in_worker = || std::thread::scope(|s| s.spawn(|| panic!("a bug in a worker")).join().is_ok());
        assert_eq!(guarded(1 << 20, move || if in_worker() { Exit::Clean } else { panic!("its echo") }), Exit::Bug);
    }
}
