//! How a render tells that it is alive: a bar on a terminal, a plain line every few seconds in a log, or nothing.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::interrupt;

/// Time between two lines in a log.
const LOG_INTERVAL: Duration = Duration::from_secs(5);

/// Progress of one render; advanced from worker threads.
pub struct Progress {
    /// Camera paths that the render will take, as it seems.
    expected: AtomicU64,
    done: AtomicU64,
    start: Instant,
    time_limit: Option<f64>,
    /// Relative noise of the picture, as bits; NaN where it is not known.
    noise: AtomicU64,
    output: Output,
}

enum Output {
    Bar(ProgressBar),
    /// Milliseconds after the start when the next line is due.
    Lines(AtomicU64),
    Nothing,
}

impl Progress {
    /// `paths` is the number of camera paths at most; `time_limit` in seconds.
    pub fn new(paths: u64, time_limit: Option<f64>, quiet: bool) -> Progress {
        let output = if quiet {
            Output::Nothing
        } else if std::io::IsTerminal::is_terminal(&std::io::stderr()) {
            Output::Bar(bar(paths))
        } else {
            Output::Lines(AtomicU64::new(LOG_INTERVAL.as_millis() as u64))
        };
        Progress {
            expected: AtomicU64::new(paths),
            done: AtomicU64::new(0),
            start: Instant::now(),
            time_limit,
            noise: AtomicU64::new(f64::NAN.to_bits()),
            output,
        }
    }

    fn elapsed(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Share of the render that is done, by paths or by time.
    fn share(&self, done: u64) -> f64 {
        let by_paths = done as f64 / self.expected.load(Ordering::Relaxed).max(1) as f64;
        let by_time = self.time_limit.map_or(0.0, |limit| self.elapsed() / limit);
        by_paths.max(by_time).min(1.0)
    }

    fn line(&self, done: u64) -> String {
        let (elapsed, share) = (self.elapsed(), self.share(done));
        let rate = count(done as f64 / elapsed.max(1e-9));
        let (noise, percent) = (noise(f64::from_bits(self.noise.load(Ordering::Relaxed))), 100.0 * share);
        let remaining = seconds(elapsed * (1.0 - share) / share.max(1e-9));
        format!("{percent:5.1} %  {rate} samples/s  {noise}{} elapsed  {remaining} remaining", seconds(elapsed))
    }
}

/// `noise 1.3 %  `, or nothing where it is not known.
fn noise(noise: f64) -> String {
    if noise.is_finite() { format!("noise {}  ", percent(noise)) } else { String::new() }
}

/// Two digits at least: `12 %`, `1.3 %`, `0.042 %`.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let digits = if percent >= 10.0 {
        0
    } else if percent >= 1.0 {
        1
    } else if percent >= 0.1 {
        2
    } else {
        3
    };
    format!("{percent:.digits$} %")
}

impl arsc_render::Progress for Progress {
    fn advance(&self, paths: u64) {
        let done = self.done.fetch_add(paths, Ordering::Relaxed) + paths;
        match &self.output {
            Output::Bar(bar) => bar.set_position(done),
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

    fn seconds_left(&self) -> Option<f64> {
        self.time_limit.map(|limit| (limit - self.elapsed()).max(0.0))
    }

    fn pass(&self, pass: &arsc_render::Pass) {
        self.noise.store(pass.noise.unwrap_or(f64::NAN).to_bits(), Ordering::Relaxed);
        self.expected.store(pass.expected_paths, Ordering::Relaxed);
        if let Output::Bar(bar) = &self.output {
            let done = self.done.load(Ordering::Relaxed);
            // With a time limit as many as the time seems to allow.
            bar.set_length((done as f64 / self.share(done).max(1e-9)) as u64);
            bar.set_message(pass.noise.map(noise).unwrap_or_default());
        }
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
    let template = "{bar:30} {percent:>3} %  {rate} samples/s  {msg}{elapsed} elapsed  {eta} remaining";
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

    /// What a render says of itself: paths or time, whichever is further.
    #[test]
    fn shares_follow_paths_and_time() {
        use arsc_render::{Pass, Progress as _};
        let progress = Progress::new(1000, None, true);
        progress.advance(100);
        assert_eq!((progress.share(100), progress.seconds_left()), (0.1, None));
        progress.pass(&Pass { noise: Some(0.034), expected_paths: 200 });
        assert_eq!(progress.share(100), 0.5);
        assert!(progress.line(100).contains("noise 3.4 %"), "{}", progress.line(100));
        let late = Progress::new(1000, Some(1e-9), true);
        assert_eq!((late.share(1), late.seconds_left()), (1.0, Some(0.0)));
    }

    #[test]
    fn counts_and_times_are_short() {
        assert_eq!(count(1_250_000.0), "1.25 M");
        assert_eq!(count(999.0), "999");
        assert_eq!([0.123, 0.0123, 0.00123, 0.00042].map(percent), ["12 %", "1.2 %", "0.12 %", "0.042 %"]);
        assert_eq!(seconds(12.34), "12.3 s");
        assert_eq!(seconds(245.0), "4 min 05 s");
        assert_eq!(seconds(7630.0), "2 h 07 min");
        assert_eq!(seconds(f64::INFINITY), "?");
    }
}
