//! Who looks at a run, and when.

use super::Executor;
use crate::schemes::Observation;
use crate::time::observer::{Moment, ObserveError, Observer};
use crate::time::run::Run;

impl Executor {
    /// Lets `observer` look from now on, at the moment as it is if that is the start.
    pub fn observe(&mut self, observer: Box<dyn Observer>) {
        let (schedule, time) = (observer.schedule(), self.run.clock.time);
        let is_now = self.run.clock.step == 0 && schedule.includes_start();
        let due = if is_now { Some(0.0) } else { schedule.next_after(time) };
        self.observers.push(observer);
        self.run.due.push(due);
        self.run.history.add_output(due);
        self.is_seen = false;
    }

    /// Its observers, who are shown nothing any more.
    pub fn take_observers(&mut self) -> Vec<Box<dyn Observer>> {
        self.run.due.clear();
        self.run.history.remove_outputs();
        std::mem::take(&mut self.observers)
    }

    /// Shows the moment to the observers for whom it is due, or to all if it is the last.
    pub(super) fn show(&mut self, last: bool) -> Result<(), ObserveError> {
        let time = self.run.clock.time * (1.0 + 1e-12);
        if last || self.run.due.iter().flatten().any(|due| *due <= time) {
            let is_new = !self.is_here;
            self.bring();
            if is_new {
                self.ask();
            }
        }
        let Run { clock, tally, state, due, .. } = &mut self.run;
        let (scheme, observers) = (self.scheme.as_mut(), &mut self.observers);
        tally.watches.observe.time(|| {
            let mut now = Observation::new(scheme, clock.time, state);
            for (observer, due) in observers.iter_mut().zip(due) {
                let is_due = due.is_some_and(|due| due <= clock.time * (1.0 + 1e-12));
                if !is_due && !last {
                    continue;
                }
                observer.observe(&mut Moment {
                    step: clock.step,
                    step_size: clock.chosen.step,
                    limiter: clock.chosen.limiter,
                    health: &clock.health,
                    now: &mut now,
                    last,
                })?;
                *due = observer.schedule().next_after(clock.time);
            }
            Ok(())
        })
    }
}
