//! Progress: a bar on a terminal, a line now and then elsewhere, JSON for programs.

use std::sync::LazyLock;
use std::time::{Duration, Instant};

use console::Term;
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use piola::time::Progress;

use crate::text::{count, duration, large, significant};
use crate::{events, terminal};

/// Time between updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(100);
/// Time between lines where stderr is no terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(5);
/// Time between JSON objects.
const JSON_INTERVAL: Duration = Duration::from_millis(250);
/// Positions of the bar.
const BAR_LENGTH: u64 = 1000;

/// The bars of all runs, one below the other.
static BARS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// Who is to read the progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Audience {
    /// Nobody.
    Nobody,
    /// A person at a terminal or with a log.
    Person,
    /// A program.
    Program,
}

/// Shows how far a run is.
pub struct Display {
    audience: Audience,
    label: String,
    pace: Pace,
    last: Instant,
    bar: Option<ProgressBar>,
    interval: Duration,
}

/// How fast a run goes, from where it stood when it was first seen: a resumed run has not earned
/// what was done before.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    start: Instant,
    /// Simulated time in s and evaluations at the first look.
    first: Option<(f64, u64)>,
}

/// What there is to say about a run besides its own numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// How much of the simulated time is done, from 0 to 1.
    pub share: f64,
    /// Wall time left in s if the rest goes as fast as what was seen; not finite if unknown.
    pub seconds_left: f64,
    /// Particle evaluations a second.
    pub evaluations_per_second: f64,
}

impl Pace {
    /// A pace that is first asked at `start`, or later.
    pub fn new(start: Instant) -> Self {
        Self { start, first: None }
    }

    /// Where the run stands, on one line.
    pub fn line(&mut self, progress: &Progress) -> String {
        line(progress, &self.estimate(progress, Instant::now()))
    }

    fn estimate(&mut self, progress: &Progress, now: Instant) -> Estimate {
        let elapsed = now.duration_since(self.start).as_secs_f64();
        let (time, evaluations) = *self.first.get_or_insert((progress.time, progress.evaluations));
        let share = progress.time / progress.end;
        // A run that went back may stand before where it was first seen.
        let done = (progress.time - time).max(0.0);
        Estimate {
            share: if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 },
            seconds_left: elapsed * (progress.end - progress.time) / done,
            evaluations_per_second: progress.evaluations.saturating_sub(evaluations) as f64
                / elapsed,
        }
    }
}

impl Display {
    /// A display for a run called `label`, which may be empty.
    pub fn new(label: &str, audience: Audience) -> Self {
        let now = Instant::now();
        let on_terminal = Term::stderr().is_term();
        let bar = (audience == Audience::Person && on_terminal).then(|| {
            let bar = BARS.add(ProgressBar::new(BAR_LENGTH));
            let template = "{prefix}[{bar:20}] {wide_msg}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style.progress_chars("=> "));
            }
            if !label.is_empty() {
                bar.set_prefix(format!("{label} "));
            }
            bar
        });
        let interval = match (audience, on_terminal) {
            (Audience::Nobody, _) => Duration::MAX,
            (Audience::Program, _) => JSON_INTERVAL,
            (Audience::Person, true) => BAR_INTERVAL,
            (Audience::Person, false) => LINE_INTERVAL,
        };
        if audience == Audience::Person && !on_terminal && !label.is_empty() {
            terminal::report(&format!("running {label}\n"));
        }
        Self { audience, label: label.to_owned(), pace: Pace::new(now), last: now, bar, interval }
    }

    /// Shows `progress` if enough time has passed since the last update.
    pub fn update(&mut self, progress: &Progress) {
        let now = Instant::now();
        if self.pace.first.is_none() {
            self.pace.estimate(progress, now);
        }
        if now.duration_since(self.last) < self.interval {
            return;
        }
        self.last = now;
        let estimate = self.pace.estimate(progress, now);
        if self.audience == Audience::Program {
            return events::progress(progress, &estimate);
        }
        let line = line(progress, &estimate);
        match &self.bar {
            Some(bar) => {
                bar.set_position((estimate.share * BAR_LENGTH as f64) as u64);
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

/// Where the run stands.
fn line(progress: &Progress, estimate: &Estimate) -> String {
    let retries = match progress.retries {
        0 => String::new(),
        1 => ", 1 retry".into(),
        retries => format!(", {retries} retries"),
    };
    format!(
        "{:.1} %, {} left, t = {} of {} s, {}, dt {} s ({}), {} evaluations/s{retries}",
        100.0 * estimate.share,
        duration(estimate.seconds_left),
        significant(progress.time, 5),
        significant(progress.end, 5),
        count(progress.step, "step"),
        significant(progress.step_size, 3),
        progress.limiter,
        large(estimate.evaluations_per_second),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROGRESS: Progress = Progress {
        time: 0.75,
        end: 3.0,
        step: 1234,
        step_size: 6.0e-4,
        limiter: "acoustic",
        evaluations: 50_000_000,
        retries: 0,
    };

    #[test]
    fn a_line_says_all_that_matters() {
        let start = Instant::now();
        let mut pace = Pace { start, first: Some((0.0, 0)) };
        let after = start + Duration::from_secs(10);
        assert_eq!(
            line(&PROGRESS, &pace.estimate(&PROGRESS, after)),
            "25.0 %, 30 s left, t = 0.75 of 3 s, 1234 steps, dt 0.0006 s (acoustic), \
             5 million evaluations/s"
        );
        let retried = Progress { retries: 2, ..PROGRESS };
        assert!(line(&retried, &pace.estimate(&retried, after)).ends_with("2 retries"));
        let nothing = Progress { time: 0.0, end: 0.0, evaluations: 0, ..PROGRESS };
        assert!(line(&nothing, &pace.estimate(&nothing, start)).contains("unknown left"));
    }

    /// What was done before a run was resumed took no time of this one.
    #[test]
    fn a_resumed_run_is_judged_by_what_it_does_itself() {
        let start = Instant::now();
        let mut pace = Pace { start, first: Some((0.5, 40_000_000)) };
        let estimate = pace.estimate(&PROGRESS, start + Duration::from_secs(10));
        assert_eq!((estimate.share, estimate.seconds_left), (0.25, 90.0));
        assert_eq!(estimate.evaluations_per_second, 1e6);
    }
}
