//! Implicit steps as an integrator.

use super::failure::Failure;
use super::integrator::{Integrator, Unserved};
use crate::schemes::{ImplicitRule, Inaccurate, Scheme};

/// Goes from state to state by solving for the next one: Newmark's method and those that damp short
/// periods, backward Euler, Crank-Nicolson, what is between them, and the implicit midpoint rule. No
/// step is too large to be stable, only too large to be accurate.
#[derive(Clone, Debug)]
pub struct ImplicitStepping {
    name: &'static str,
    rule: ImplicitRule,
    estimate: Option<Estimate>,
}

/// What it takes to know the error of a step.
#[derive(Clone, Debug)]
struct Estimate {
    /// Largest error of a step.
    largest: f64,
    /// Error of the last one that was tried.
    last: f64,
    whole: Vec<f64>,
    middle: Vec<f64>,
}

impl ImplicitStepping {
    /// Share of the step with just the error that is allowed: one that is not taken is lost.
    const CAUTION: f64 = 0.9;

    /// Least and largest factor from a step to the next.
    const FACTORS: [f64; 2] = [0.2, 2.0];

    /// Steps of `rule`, which goes by `name` in a case file.
    pub fn new(name: &'static str, rule: ImplicitRule) -> Self {
        Self { name, rule, estimate: None }
    }

    /// The same with an estimate of the error of each step, which may be `largest`, for states of
    /// `length` numbers. A step is taken as a whole and in two halves: of those the state at the end
    /// is, and `1 / (2^p - 1)` of the difference of the velocities at the end, for a rule of order p,
    /// is its error (Richardson). It is measured by the velocity that all energy of the
    /// particles would give them if it were kinetic.
    #[must_use]
    pub fn with_error(mut self, largest: f64, length: usize) -> Self {
        let (whole, middle) = (vec![0.0; length], vec![0.0; length]);
        self.estimate = Some(Estimate { largest, last: 0.0, whole, middle });
        self
    }

    fn advance(
        &self,
        scheme: &mut dyn Scheme,
        [time, step]: [f64; 2],
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        new.copy_from_slice(old);
        let advanced = match &self.rule {
            ImplicitRule::Newmark(rule) => {
                scheme.newmark().map(|scheme| scheme.advance(rule, time, step, old, new))
            }
            ImplicitRule::Theta(rule) => {
                scheme.theta().map(|scheme| scheme.advance(rule, time, step, old, new))
            }
        };
        match advanced {
            Some(advanced) => advanced.map_err(Failure::NoSolution),
            None => Err(Unserved::new(self.name, scheme).into()),
        }
    }
}

/// How far the velocities of two states are apart, over those that all energy would give.
fn distance(rule: &ImplicitRule, scheme: &mut dyn Scheme, one: &[f64], other: &[f64]) -> f64 {
    let mut energies = vec![0.0; scheme.description().energies.len()];
    let mut all = |state: &[f64]| {
        scheme.energies(state, &mut energies);
        energies.iter().map(|energy| energy.abs()).sum::<f64>()
    };
    let size = (2.0 * all(one).max(all(other))).sqrt();
    let apart = match rule {
        ImplicitRule::Newmark(_) => scheme.newmark().map(|it| it.kinetic_distance(one, other)),
        ImplicitRule::Theta(_) => scheme.theta().map(|it| it.kinetic_distance(one, other)),
    };
    match apart {
        Some(apart) if apart != 0.0 => apart / size,
        _ => 0.0,
    }
}

impl Integrator for ImplicitStepping {
    fn name(&self) -> &'static str {
        self.name
    }

    /// About as many products as a step takes iteratively: for estimates only.
    fn evaluations(&self, _scheme: &mut dyn Scheme) -> u64 {
        100
    }

    fn is_timed_by_steps(&self) -> bool {
        false
    }

    fn renewed(&self, _scheme: &mut dyn Scheme) -> Option<Box<dyn Integrator>> {
        let plain = Self::new(self.name, self.rule);
        Some(Box::new(match &self.estimate {
            // Each of several ranks has the whole state.
            Some(estimate) => plain.with_error(estimate.largest, estimate.whole.len()),
            None => plain,
        }))
    }

    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        let Some(mut estimate) = self.estimate.take() else {
            return self.advance(scheme, [time, step], old, new);
        };
        let Estimate { largest, last, whole, middle } = &mut estimate;
        let half = 0.5 * step;
        let taken = self
            .advance(scheme, [time, step], old, whole)
            .and_then(|()| self.advance(scheme, [time, half], old, middle))
            .and_then(|()| self.advance(scheme, [time + half, half], middle, new))
            .and_then(|()| {
                *last = distance(&self.rule, scheme, whole, new)
                    / (2_f64.powi(self.rule.order()) - 1.0);
                match *last <= *largest {
                    true => Ok(()),
                    false => Err(Inaccurate { error: *last, largest: *largest, time, step }.into()),
                }
            });
        self.estimate = Some(estimate);
        taken
    }

    /// The local error grows with the step to the power of the order and one.
    fn growth(&self) -> Option<f64> {
        let Estimate { largest, last, .. } = self.estimate.as_ref()?;
        let [least, most] = Self::FACTORS;
        let ideal = (largest / last).powf(1.0 / f64::from(self.rule.order() + 1));
        // An error that is no number makes the step as short as can be.
        Some((Self::CAUTION * ideal).max(least).min(most))
    }
}
