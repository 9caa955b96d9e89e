//! Newton's method with a line search.

use std::fmt::Write;

use thiserror::Error;

use super::krylov::{advance, dot};
use super::{LinearError, LinearReport, Stability};
use crate::parallel::larger;

/// Equations `r(x, factor) = 0` in unknowns x, where the load factor takes the part of time, or is
/// the time.
pub trait Equations {
    /// Number of unknowns.
    fn unknowns(&self) -> usize;

    /// What a line search asks of a state.
    fn trial(&mut self, factor: f64, x: &[f64]) -> Trial;

    /// Writes the residual: what loads and inner forces leave, minus the slope of the potential
    /// where there is one. Returns its norm over that of all that acts from outside.
    fn residual(&mut self, factor: f64, x: &[f64], residual: &mut [f64]) -> f64;

    /// Moves multipliers, where there are any, to a state with a residual of zero; whether the
    /// residual has changed with them.
    fn settle(&mut self, _factor: f64, _x: &[f64]) -> bool {
        false
    }

    /// Makes the tangent `-dr/dx` of a state; `definite` allows it to be changed so that it is
    /// positive definite.
    ///
    /// # Errors
    /// Where it cannot be factorised.
    fn linearise(&mut self, factor: f64, x: &[f64], definite: bool) -> Result<(), LinearError>;

    /// Solves with that tangent down to a relative residual of `tolerance`.
    ///
    /// # Errors
    /// Where no solution is found.
    fn solve(
        &mut self,
        right: &[f64],
        tolerance: f64,
        solution: &mut [f64],
    ) -> Result<LinearReport, LinearError>;
}

/// Equations with loads that grow with the factor.
pub trait LoadedEquations: Equations {
    /// Writes `dr/dfactor` with what moves with the factor on its own, at the state of the last
    /// [`Equations::linearise`].
    fn load_rate(&mut self, factor: f64, rate: &mut [f64]);

    /// Writes the residual that a step of the load factor leaves at the state of the last
    /// [`Equations::linearise`] if all but the loads is taken as linear.
    fn step_residual(&mut self, from: f64, to: f64, residual: &mut [f64]);

    /// Whether the tangent of the last [`Equations::linearise`], unchanged, is positive definite.
    fn stability(&mut self) -> Stability;
}

/// A state as a line search sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// The potential in J, where the residual has one.
    pub potential: Option<f64>,
    /// A particle that is turned inside out, or whose state is not finite.
    pub broken: Option<usize>,
}

/// One iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Relative residual before it.
    pub residual: f64,
    /// Part of the step that was taken.
    pub length: f64,
    /// Steps of a Krylov method in it.
    pub linear_steps: usize,
    /// Whether the tangent was indefinite there.
    pub indefinite: bool,
}

/// When Newton's method has arrived, and when it gives up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newton {
    /// Relative residual that counts as zero.
    pub tolerance: f64,
    /// Iterations before it gives up.
    pub most_iterations: usize,
    /// Halvings of a step before it gives up.
    pub most_halvings: usize,
}

impl Default for Newton {
    fn default() -> Self {
        Self { tolerance: 1e-8, most_iterations: 40, most_halvings: 12 }
    }
}

/// A zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The iterations that led there.
    pub iterations: Vec<Iteration>,
    /// Relative residual that is left.
    pub residual: f64,
}

/// A zero of which it is known whether it stays.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// The iterations that led there.
    pub iterations: Vec<Iteration>,
    /// Relative residual that is left.
    pub residual: f64,
    /// Whether it is stable.
    pub stability: Stability,
}

/// No zero.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum NewtonError {
    /// The residual does not fall any more.
    #[error("the residual went {}", listed(history, *residual))]
    NoConvergence {
        /// All iterations.
        history: Vec<Iteration>,
        /// Relative residual that is left.
        residual: f64,
    },
    /// Every step along the direction turns a particle inside out.
    #[error("particle {particle} is inverted; the residual went {}", listed(history, *residual))]
    Broken {
        /// Index of the particle in memory.
        particle: usize,
        /// All iterations.
        history: Vec<Iteration>,
        /// Relative residual that is left.
        residual: f64,
    },
    /// The linear equations were not solved.
    #[error("{source} (iteration {})", history.len() + 1)]
    Linear {
        /// Why.
        source: LinearError,
        /// All iterations.
        history: Vec<Iteration>,
    },
}

/// Part of the fall that the slope promises which a step has to bring.
const SUFFICIENT: f64 = 1e-4;
/// Change of a potential, over its size, that may be rounding.
const NOISE: f64 = 1e-11;
/// Change of unknowns, over the largest of them, that is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Newton {
    /// Finds a zero from `x`, after the iterations `before` that a predictor took, and looks
    /// whether it is stable.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn solve<E: LoadedEquations + ?Sized>(
        &self,
        equations: &mut E,
        factor: f64,
        x: &mut Vec<f64>,
        before: Vec<Iteration>,
    ) -> Result<Solved, NewtonError> {
        let Found { iterations, residual } = self.find(equations, factor, x, before)?;
        // Where the potential has a saddle a shift would hide it.
        if let Err(source) = equations.linearise(factor, x, false) {
            return Err(NewtonError::Linear { source, history: iterations });
        }
        let stability = equations.stability();
        Ok(Solved { iterations, residual, stability })
    }

    /// Finds a zero from `x`, after the iterations `before` that a predictor took: a residual within
    /// the tolerance, or a step that is lost in the rounding of the unknowns.
    ///
    /// Along each direction a step is halved until the potential falls as its slope promises; where the
    /// change is lost in rounding, or where there is no potential, until the residual falls. A full step to a
    /// residual within the tolerance is taken if the residual does work along it, whatever the potential says:
    /// energies of small strains are sums of terms that cancel, and lose more digits than their value tells.
    ///
    /// # Errors
    /// [`NewtonError`] with all iterations; `x` is then the last state.
    pub fn find<E: Equations + ?Sized>(
        &self,
        equations: &mut E,
        factor: f64,
        x: &mut Vec<f64>,
        before: Vec<Iteration>,
    ) -> Result<Found, NewtonError> {
        let mut history = before;
        let mut left = vec![0.0; x.len()];
        let mut direction = vec![0.0; x.len()];
        let mut residual = equations.residual(factor, x, &mut left);
        // Where a body comes back to rest there is nothing left that forces could be measured by, and
        // unknowns go to zero: they are rounded as where they came from.
        let usual = largest(x);
        loop {
            if residual <= self.tolerance && equations.settle(factor, x) {
                residual = equations.residual(factor, x, &mut left);
            }
            if residual <= self.tolerance {
                return Ok(Found { iterations: history, residual });
            }
            if history.len() >= self.most_iterations || !residual.is_finite() {
                return Err(NewtonError::NoConvergence { history, residual });
            }
            let report = equations
                .linearise(factor, x, true)
                .and_then(|()| equations.solve(&left, self.forcing(residual), &mut direction))
                .map_err(|source| NewtonError::Linear { source, history: history.clone() })?;
            // Nothing that the unknowns could still hold: the residual is their rounding. A shift
            // would make any step short.
            if report.shift == 0.0 && largest(&direction) <= ROUNDING * largest(x).max(usual) {
                return Ok(Found { iterations: history, residual });
            }
            let start = Start { x: &*x, left: &left, direction: &direction, residual };
            let step = self.search(equations, factor, &start);
            let (length, next) = match step {
                Ok(found) => found,
                Err(Some(particle)) => {
                    return Err(NewtonError::Broken { particle, history, residual });
                }
                Err(None) => return Err(NewtonError::NoConvergence { history, residual }),
            };
            *x = next;
            let LinearReport { steps, indefinite, .. } = report;
            history.push(Iteration { residual, length, linear_steps: steps, indefinite });
            residual = equations.residual(factor, x, &mut left);
        }
    }

    /// How well linear equations are to be solved: as well as keeps convergence quadratic, and no
    /// better than the last iteration needs.
    pub(super) fn forcing(&self, residual: f64) -> f64 {
        (0.1 * residual).max(0.1 * self.tolerance / residual).min(1e-3)
    }

    /// A step length with the state it leads to, or a particle that stands in the way.
    fn search<E: Equations + ?Sized>(
        &self,
        equations: &mut E,
        factor: f64,
        start: &Start<'_>,
    ) -> Result<(f64, Vec<f64>), Option<usize>> {
        let before = equations.trial(factor, start.x).potential;
        let slope = dot(start.left, start.direction);
        let mut left = vec![0.0; start.x.len()];
        let mut length = 1.0;
        let mut broken = None;
        for _ in 0..=self.most_halvings {
            let mut x = start.x.to_vec();
            advance(&mut x, length, start.direction);
            let trial = equations.trial(factor, &x);
            broken = trial.broken;
            if broken.is_none() {
                let change = before
                    .zip(trial.potential)
                    .map(|(before, after)| (after - before, NOISE * before.abs().max(after.abs())));
                let falls = change
                    .filter(|(change, noise)| change.abs() > *noise)
                    .map(|(change, _)| change <= -SUFFICIENT * length * slope);
                let is_taken = match falls {
                    Some(true) => true,
                    Some(false) => {
                        length == 1.0
                            && equations.residual(factor, &x, &mut left) <= self.tolerance
                            && self.work(equations, factor, start, &left) > 0.0
                    }
                    None => {
                        let after = equations.residual(factor, &x, &mut left);
                        let enough = (1.0 - SUFFICIENT * length) * start.residual;
                        after <= self.tolerance || after <= enough
                    }
                };
                if is_taken {
                    return Ok((length, x));
                }
            }
            length *= 0.5;
        }
        Err(broken)
    }

    /// The work of the residual along a full step, by Simpson's rule: what the potential falls by, without
    /// the rounding of the potential. It is exact for potentials of degree four.
    fn work<E: Equations + ?Sized>(
        &self,
        equations: &mut E,
        factor: f64,
        start: &Start<'_>,
        end: &[f64],
    ) -> f64 {
        let (mut x, mut middle) = (start.x.to_vec(), vec![0.0; end.len()]);
        advance(&mut x, 0.5, start.direction);
        equations.residual(factor, &x, &mut middle);
        let along = |residual: &[f64]| dot(residual, start.direction);
        (along(start.left) + 4.0 * along(&middle) + along(end)) / 6.0
    }
}

/// Where a line search starts.
struct Start<'a> {
    x: &'a [f64],
    left: &'a [f64],
    direction: &'a [f64],
    residual: f64,
}

/// The largest of some numbers by size, infinite if one is no number.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest, number| larger(largest, number.abs()))
}

/// The residuals of all iterations, with the lengths of those that were cut.
fn listed(history: &[Iteration], last: f64) -> String {
    let mut text = String::new();
    for iteration in history {
        let _ = write!(text, "{:.1e}", iteration.residual);
        if iteration.length < 1.0 {
            let _ = write!(text, " (step {:.1e})", iteration.length);
        }
        text.push_str(", ");
    }
    let _ = write!(text, "{last:.1e}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A potential of one unknown, with an error of its values, and steps to a place that is given.
    struct Scalar {
        potential: fn(f64) -> f64,
        slope: fn(f64) -> f64,
        target: f64,
        x: f64,
    }

    impl Equations for Scalar {
        fn unknowns(&self) -> usize {
            1
        }

        fn trial(&mut self, _factor: f64, x: &[f64]) -> Trial {
            Trial { potential: Some((self.potential)(x[0])), broken: None }
        }

        fn residual(&mut self, _factor: f64, x: &[f64], residual: &mut [f64]) -> f64 {
            residual[0] = -(self.slope)(x[0]);
            residual[0].abs()
        }

        fn linearise(&mut self, _: f64, x: &[f64], _: bool) -> Result<(), LinearError> {
            self.x = x[0];
            Ok(())
        }

        fn solve(
            &mut self,
            _right: &[f64],
            _tolerance: f64,
            solution: &mut [f64],
        ) -> Result<LinearReport, LinearError> {
            solution[0] = self.target - self.x;
            Ok(LinearReport { steps: 1, shift: 0.0, indefinite: false })
        }
    }

    fn full_step(mut equations: Scalar, from: f64) -> Option<f64> {
        let direction = [equations.target - from];
        let left = [-(equations.slope)(from)];
        let start =
            Start { x: &[from], left: &left, direction: &direction, residual: left[0].abs() };
        let newton = Newton { tolerance: 1e-10, most_halvings: 0, ..Newton::default() };
        newton.search(&mut equations, 1.0, &start).ok().map(|(length, _)| length)
    }

    /// Its minimum is at 1, where its values are wrong by more than what the step gains.
    #[test]
    fn a_step_that_arrives_is_taken_whatever_rounding_does_to_the_potential() {
        let potential = |x: f64| 0.5 * (x - 1.0).powi(2) + if x == 1.0 { 1e-3 } else { 0.0 };
        let slope = |x: f64| x - 1.0;
        assert_eq!(full_step(Scalar { potential, slope, target: 1.0, x: 0.0 }, 0.99), Some(1.0));
    }

    /// From the left of the well at -1, downhill, to the top between two wells: it is higher there.
    #[test]
    fn a_step_that_arrives_at_a_maximum_is_not_taken() {
        let potential = |x: f64| 0.25 * x.powi(4) - 0.5 * x * x;
        let slope = |x: f64| x.powi(3) - x;
        assert_eq!(full_step(Scalar { potential, slope, target: 0.0, x: 0.0 }, -1.2), None);
    }
}
