//! Progress of several runs at once: one bar on a terminal, lines elsewhere.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use console::Term;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use piola::time::Progress;

use crate::terminal;

/// Time between updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(100);
/// Time between lines where stderr is no terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(5);
/// Positions of the bar for each member.
const BAR_LENGTH: f64 = 1000.0;

/// Shows how far a sweep is.
pub struct Overall {
    state: Mutex<State>,
    bar: Option<ProgressBar>,
    interval: Option<Duration>,
}

struct State {
    last: Instant,
    ended: usize,
    /// Name and share of the members that run, by their number.
    running: BTreeMap<usize, (String, f64)>,
}

impl Overall {
    /// A display, which shows nothing if `quiet`.
    pub fn new(quiet: bool) -> Self {
        let on_terminal = Term::stderr().is_term();
        let bar = (!quiet && on_terminal).then(|| {
            let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::stderr());
            if let Ok(style) = ProgressStyle::with_template("[{bar:20}] {wide_msg}") {
                bar.set_style(style.progress_chars("=> "));
            }
            bar
        });
        let interval = match (quiet, on_terminal) {
            (true, _) => None,
            (false, true) => Some(BAR_INTERVAL),
            (false, false) => Some(LINE_INTERVAL),
        };
        let state = State { last: Instant::now(), ended: 0, running: BTreeMap::new() };
        Self { state: Mutex::new(state), bar, interval }
    }

    fn locked(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes how far a member is, and shows it if enough time has passed since the last update.
    pub fn update(&self, member: usize, name: &str, progress: &Progress, members: usize) {
        let Some(interval) = self.interval else { return };
        let mut state = self.locked();
        let share = progress.time / progress.end;
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        state.running.insert(member, (name.to_owned(), share));
        if state.last.elapsed() < interval {
            return;
        }
        state.last = Instant::now();
        let line = line(&state, members);
        match &self.bar {
            Some(bar) => {
                let shares: f64 = state.running.values().map(|(_, share)| share).sum();
                bar.set_length((BAR_LENGTH * members as f64) as u64);
                bar.set_position((BAR_LENGTH * (state.ended as f64 + shares)) as u64);
                bar.set_message(line);
            }
            None => terminal::report(&format!("{line}\n")),
        }
    }

    /// Says that a member has ended, and how.
    pub fn ended(&self, member: usize, how: &str, members: usize) {
        let mut state = self.locked();
        state.running.remove(&member);
        state.ended += 1;
        let line = format!("{} of {members}: {how}", state.ended);
        match (&self.bar, self.interval) {
            (Some(bar), _) => bar.println(line),
            (None, Some(_)) => terminal::report(&format!("{line}\n")),
            (None, None) => {}
        }
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// How many members have ended, and how far those are that run.
fn line(state: &State, members: usize) -> String {
    let running =
        state.running.values().map(|(name, share)| format!("{name} {:.0} %", 100.0 * share));
    let running: Vec<String> = running.collect();
    format!("{} of {members} done; {}", state.ended, running.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_names_what_runs() {
        let running = BTreeMap::from([(2, ("a=1".to_owned(), 0.25)), (3, ("a=2".to_owned(), 0.0))]);
        let state = State { last: Instant::now(), ended: 2, running };
        assert_eq!(line(&state, 9), "2 of 9 done; a=1 25 %; a=2 0 %");
    }
}
