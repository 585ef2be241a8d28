//! How a render tells that it is alive: a bar on a terminal, a plain line every few seconds in a log, or nothing.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::interrupt;

/// Time between two lines in a log.
const LOG_INTERVAL: Duration = Duration::from_secs(5);

/// Progress of one render; advanced from worker threads.
pub struct Progress {
    total: u64,
    done: AtomicU64,
    start: Instant,
    output: Output,
}

enum Output {
    Bar(ProgressBar),
    /// Milliseconds after the start when the next line is due.
    Lines(AtomicU64),
    Nothing,
}

impl Progress {
    /// `total` is the number of camera paths.
    pub fn new(total: u64, quiet: bool) -> Progress {
        let output = if quiet {
            Output::Nothing
        } else if std::io::IsTerminal::is_terminal(&std::io::stderr()) {
            Output::Bar(bar(total))
        } else {
            Output::Lines(AtomicU64::new(LOG_INTERVAL.as_millis() as u64))
        };
        Progress { total, done: AtomicU64::new(0), start: Instant::now(), output }
    }

    fn line(&self, done: u64) -> String {
        let elapsed = self.start.elapsed().as_secs_f64();
        let rate = done as f64 / elapsed.max(1e-9);
        let remaining = self.total.saturating_sub(done) as f64 / rate.max(1e-9);
        let percent = 100.0 * done as f64 / self.total.max(1) as f64;
        let (elapsed, remaining) = (seconds(elapsed), seconds(remaining));
        format!("{percent:5.1} %  {} samples/s  {elapsed} elapsed  {remaining} remaining", count(rate))
    }
}

impl arsc_render::Progress for Progress {
    fn advance(&self, paths: u64) {
        let done = self.done.fetch_add(paths, Ordering::Relaxed) + paths;
        match &self.output {
            Output::Bar(bar) => bar.set_position(done.min(self.total)),
            Output::Lines(due) => {
                let now = self.start.elapsed().as_millis() as u64;
                let at = due.load(Ordering::Relaxed);
                let next = now + LOG_INTERVAL.as_millis() as u64;
                // Whoever moves the due time prints.
                if now >= at && due.compare_exchange(at, next, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
                    eprintln!("{}", self.line(done));
                }
            }
            Output::Nothing => {}
        }
    }

    fn cancelled(&self) -> bool {
        interrupt::requested()
    }
}

/// Removes the bar.
impl Drop for Progress {
    fn drop(&mut self) {
        if let Output::Bar(bar) = &self.output {
            bar.finish_and_clear();
        }
    }
}

fn bar(total: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr_with_hz(5));
    let template = "{bar:30} {percent:>3} %  {rate} samples/s  {elapsed} elapsed  {eta} remaining";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.set_style(style.with_key("rate", |state: &indicatif::ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{}", count(state.per_sec()));
    }));
    bar
}

/// `1.25 M`, for rates.
pub fn count(n: f64) -> String {
    match n {
        n if !n.is_finite() => "?".into(),
        n if n >= 1e9 => format!("{:.2} G", n / 1e9),
        n if n >= 1e6 => format!("{:.2} M", n / 1e6),
        n if n >= 1e3 => format!("{:.1} k", n / 1e3),
        n => format!("{n:.0}"),
    }
}

/// `12.3 s`, `4 min 05 s`, `2 h 07 min`.
pub fn seconds(s: f64) -> String {
    match s {
        s if !s.is_finite() || s > 1e9 => "?".into(),
        s if s < 99.95 => format!("{s:.1} s"),
        s if s < 3600.0 => format!("{} min {:02} s", s as u64 / 60, s as u64 % 60),
        s => format!("{} h {:02} min", s as u64 / 3600, s as u64 % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_times_are_short() {
        assert_eq!(count(1_250_000.0), "1.25 M");
        assert_eq!(count(999.0), "999");
        assert_eq!(seconds(12.34), "12.3 s");
        assert_eq!(seconds(245.0), "4 min 05 s");
        assert_eq!(seconds(7630.0), "2 h 07 min");
        assert_eq!(seconds(f64::INFINITY), "?");
    }
}
