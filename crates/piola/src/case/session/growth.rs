//! Runs whose reserve of particles was too small.

use super::{RunError, Session, executor};
use crate::case::assembly::Built;
use crate::case::{Problems, ranks};
use crate::time::Executor;

/// A reserve that was too small grows by one of so many particles of the run.
const GROWTH: usize = 4;

/// With more particles than these a reserve does not grow.
const MOST_PARTICLES: usize = 100_000_000;

impl Session {
    /// Enlarges the reserve if the run has come to its end, as long as it may grow. Returns whether the last step is to be
    /// taken again.
    pub(super) fn grows(&mut self) -> Result<bool, RunError> {
        let count = self.executor.scheme.particle_count();
        if !self.executor.has_none_in_reserve() || count > MOST_PARTICLES {
            return Ok(false);
        }
        self.enlarge(self.case.more_in_reserve + count.div_ceil(GROWTH))?;
        Ok(true)
    }

    /// Builds the case anew with this many more particles in each reserve than it asks for, and lets that go on where the
    /// run is. Particles do not depend on how many there were before; sums over rows may differ by rounding. Where that
    /// cannot be done the run ends.
    pub(super) fn enlarge(&mut self, reserve: usize) -> Result<(), RunError> {
        self.case.more_in_reserve = reserve;
        if !self.executor.leave(reserve) {
            return Ok(());
        }
        let (mut next, mut built) = match self.larger() {
            Ok(larger) => larger,
            Err(problems) => {
                let why = problems.to_string();
                let why = why.lines().next().unwrap_or_default().trim_start_matches("error: ");
                let cause = format!("the reserve of particles cannot be extended: {why}");
                self.executor.give_up(cause, false);
                return Ok(());
            }
        };
        let checkpoint = self.executor.handed_over(next.scheme.as_ref());
        let outside = self.executor.take_observers().split_off(self.own);
        std::mem::swap(&mut self.executor, &mut next);
        built.warnings = std::mem::take(&mut self.built.warnings);
        self.built = built;
        self.rows_of_bodies.clear();
        self.equip(outside);
        Ok(self.executor.take_over(&next, checkpoint)?)
    }

    /// The run of the case at its start, on as many ranks.
    fn larger(&self) -> Result<(Executor, Built), Problems> {
        let case = &self.case;
        match &self.processes {
            Some(ranks) => {
                let (mut next, built) = ranks::begin(case, ranks.as_ref())?;
                ranks::lead(&mut next, case, ranks.clone())?;
                Ok((next, built))
            }
            None => {
                let (mut next, built) = executor(case)?;
                ranks::use_threads(&mut next, case)
                    .map_err(|problem| case.refuse(vec![problem]))?;
                Ok((next, built))
            }
        }
    }
}
