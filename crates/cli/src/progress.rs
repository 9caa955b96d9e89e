//! Progress on stderr: a bar on a terminal, a line now and then elsewhere.

use std::time::{Duration, Instant};

use console::Term;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use piola::time::Progress;

use crate::terminal;
use crate::text::{duration, large, significant};

/// Time between updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(100);
/// Time between lines where stderr is no terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(5);
/// Positions of the bar.
const BAR_LENGTH: u64 = 1000;

/// Shows how far a run is.
pub struct Display {
    label: String,
    start: Instant,
    last: Instant,
    bar: Option<ProgressBar>,
    interval: Duration,
}

impl Display {
    /// A display for a run called `label`, which may be empty.
    pub fn new(label: &str, quiet: bool) -> Self {
        let now = Instant::now();
        let on_terminal = Term::stderr().is_term();
        let bar = (!quiet && on_terminal).then(|| {
            let bar = ProgressBar::with_draw_target(Some(BAR_LENGTH), ProgressDrawTarget::stderr());
            let template = "{prefix}[{bar:20}] {wide_msg}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style.progress_chars("=> "));
            }
            if !label.is_empty() {
                bar.set_prefix(format!("{label} "));
            }
            bar
        });
        let interval = match (quiet, on_terminal) {
            (true, _) => Duration::MAX,
            (false, true) => BAR_INTERVAL,
            (false, false) => LINE_INTERVAL,
        };
        if !quiet && !on_terminal && !label.is_empty() {
            terminal::report(&format!("running {label}\n"));
        }
        Self { label: label.to_owned(), start: now, last: now, bar, interval }
    }

    /// Shows `progress` if enough time has passed since the last update.
    pub fn update(&mut self, progress: &Progress) {
        let now = Instant::now();
        if now.duration_since(self.last) < self.interval {
            return;
        }
        self.last = now;
        let line = line(progress, now.duration_since(self.start).as_secs_f64());
        match &self.bar {
            Some(bar) => {
                bar.set_position((share(progress) * BAR_LENGTH as f64) as u64);
                bar.set_message(line);
            }
            None if self.label.is_empty() => terminal::report(&format!("{line}\n")),
            None => terminal::report(&format!("{}: {line}\n", self.label)),
        }
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// How much of the simulated time is done, from 0 to 1.
fn share(progress: &Progress) -> f64 {
    let share = progress.time / progress.end;
    if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
}

/// Where the run stands after `elapsed` seconds of wall time. The time left assumes that the rest
/// goes as fast as what is done.
fn line(progress: &Progress, elapsed: f64) -> String {
    let share = share(progress);
    format!(
        "{:.1} %, {} left, t = {} of {} s, step {}, dt {} s ({}), {} evaluations/s",
        100.0 * share,
        duration(elapsed * (1.0 - share) / share),
        significant(progress.time, 5),
        significant(progress.end, 5),
        progress.step,
        significant(progress.step_size, 3),
        progress.limiter,
        large(progress.evaluations as f64 / elapsed),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_all_that_matters() {
        let progress = Progress {
            time: 0.75,
            end: 3.0,
            step: 1234,
            step_size: 6.0e-4,
            limiter: "acoustic",
            evaluations: 50_000_000,
        };
        assert_eq!(
            line(&progress, 10.0),
            "25.0 %, 30 s left, t = 0.75 of 3 s, step 1234, dt 0.0006 s (acoustic), \
             5 million evaluations/s"
        );
        let start = Progress { time: 0.0, end: 0.0, evaluations: 0, ..progress };
        assert!(line(&start, 0.0).contains("unknown left"));
    }
}
