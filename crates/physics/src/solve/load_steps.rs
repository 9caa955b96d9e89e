//! Loads that grow step by step.

use thiserror::Error;

use super::krylov::{advance, norm};
use super::newton::{Iteration, LoadedEquations, Newton, NewtonError, Solved};
use super::{LinearReport, Stability};

/// The load factors to be visited, from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadSteps {
    /// These, each in one step, whatever the way there leads over.
    Given(Vec<f64>),
    /// These, in steps that are cut in two where there is no convergence or where the tangent was
    /// indefinite on the way, so that no limit is jumped over, and that grow again where it is
    /// quick.
    Automatic {
        /// Factors that are met exactly, ascending; the last one is the end.
        levels: Vec<f64>,
        /// First step.
        first: f64,
        /// Step below which it is given up.
        least: f64,
    },
}

/// A state in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Increment {
    /// The load factor.
    pub factor: f64,
    /// The unknowns.
    pub x: Vec<f64>,
    /// What it took.
    pub solved: Solved,
    /// Whether it may lie beyond a limit of the load, which a smaller step tells.
    pub jumped: bool,
}

/// No further state in equilibrium.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LoadError {
    /// Newton's method has failed, on the last of ever smaller steps where they are automatic.
    #[error(
        "no equilibrium was found at a load factor of {factor}, after {reached}: {source}; take \
         smaller load steps"
    )]
    Newton {
        /// The load factor.
        factor: f64,
        /// The last one with an equilibrium.
        reached: f64,
        /// Why.
        source: NewtonError,
    },
    /// Equilibrium that the least disturbance leaves.
    #[error(
        "the body is unstable at a load factor of {factor}, and stable at {reached}: energy falls \
         in {} there; the body buckles, its material softens, or it is not held sufficiently; \
         follow the path by arc length to continue",
        directions(*negative)
    )]
    Unstable {
        /// The load factor.
        factor: f64,
        /// The last one with a stable equilibrium.
        reached: f64,
        /// Directions in which the energy falls, where they were counted.
        negative: Option<usize>,
    },
    /// Load factors that are not finite or not in order, or steps that are not positive.
    #[error("{value} cannot be the load factor or step after {before}")]
    Steps {
        /// The number.
        value: f64,
        /// The one before.
        before: f64,
    },
}

/// Iterations up to which the next step is larger, and from which it is smaller.
const QUICK: usize = 5;
const SLOW: usize = 10;
/// By how much.
const GROWTH: f64 = 1.5;
/// Distance of a state from where its step was to lead, over the length of that step, that is too
/// far, and that is notable.
const FAR: f64 = 2.0;
const OFF: f64 = 0.3;
/// Ratio of the lengths of two steps per load that is notable.
const HASTE: f64 = 3.0;

/// Finds a stable equilibrium at each of the load factors in turn, from `start` at a factor of 0,
/// and shows each.
///
/// A step starts where the last two states lead, `x_n + (x_n - x_(n-1))` for steps of equal size,
/// and the first one where the tangent leads.
///
/// # Errors
/// [`LoadError`] for the first factor at which there is none.
pub fn follow<E: LoadedEquations + ?Sized>(
    equations: &mut E,
    newton: &Newton,
    steps: &LoadSteps,
    start: Vec<f64>,
    mut show: impl FnMut(&mut E, Increment),
) -> Result<(), LoadError> {
    check(steps)?;
    let mut path = Path { before: None, factor: 0.0, x: start };
    match steps {
        LoadSteps::Given(factors) => {
            for &factor in factors {
                let increment = path.attempt(equations, newton, factor, false)?;
                path.accept(&increment);
                show(equations, increment);
            }
        }
        LoadSteps::Automatic { levels, first, least } => {
            let mut step = *first;
            for &level in levels {
                while path.factor < level {
                    let near = path.factor + step >= level - 1e-9 * level.abs();
                    let factor = if near { level } else { path.factor + step };
                    match path.attempt(equations, newton, factor, true) {
                        Ok(increment) => {
                            match increment.solved.iterations.len() {
                                count if count <= QUICK => step *= GROWTH,
                                count if count >= SLOW => step /= GROWTH,
                                _ => {}
                            }
                            path.accept(&increment);
                            show(equations, increment);
                        }
                        Err(error) => {
                            step = 0.5 * (factor - path.factor);
                            if step < *least {
                                return Err(error);
                            }
                        }
                    }
                }
            }
        }
    }
    Ok(())
}

/// Where load steps have come to: the last two states.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Load factor and unknowns of the state before; none at the start.
    pub before: Option<(f64, Vec<f64>)>,
    /// Load factor of the last state.
    pub factor: f64,
    /// Its unknowns.
    pub x: Vec<f64>,
}

impl Path {
    /// The state at a load factor, in one step; with `near` only one that belongs to the path so far.
    ///
    /// # Errors
    /// [`LoadError`] where none is found, or none that stays.
    pub fn attempt<E: LoadedEquations + ?Sized>(
        &self,
        equations: &mut E,
        newton: &Newton,
        factor: f64,
        near: bool,
    ) -> Result<Increment, LoadError> {
        let reached = self.factor;
        let failed = |source| LoadError::Newton { factor, reached, source };
        let (start, before) = self.start(equations, newton, factor, near).map_err(failed)?;
        let mut x = start.clone();
        let unstable = |negative| LoadError::Unstable { factor, reached, negative };
        let solved =
            newton.solve(equations, factor, &mut x, before).map_err(|error| match error {
                NewtonError::NoConvergence { history, .. } if near && any_indefinite(&history) => {
                    unstable(None)
                }
                error => failed(error),
            })?;
        if let Stability::Unstable(negative) = solved.stability {
            return Err(unstable(negative));
        }
        let jumped = self.may_have_jumped(factor, &start, &x, &solved);
        if near && jumped {
            return Err(unstable(None));
        }
        Ok(Increment { factor, x, solved, jumped })
    }

    /// Whether a state may lie beyond a limit, which a smaller step tells: where the tangent was
    /// indefinite on the way, where the start was far off, or where it was off and the step is
    /// much larger for its load than the one before.
    fn may_have_jumped(&self, factor: f64, start: &[f64], x: &[f64], solved: &Solved) -> bool {
        let missed = distance(start, x) / distance(start, &self.x);
        let hastens = self.before.as_ref().is_some_and(|(earlier, last)| {
            let now = distance(x, &self.x) / (factor - self.factor).abs();
            let before = distance(&self.x, last) / (self.factor - earlier).abs();
            now > HASTE * before
        });
        any_indefinite(&solved.iterations) || missed > FAR || hastens && missed > OFF
    }

    fn accept(&mut self, increment: &Increment) {
        let last = std::mem::replace(&mut self.x, increment.x.clone());
        self.before = Some((self.factor, last));
        self.factor = increment.factor;
    }

    /// Where Newton's method starts from, and the iterations that this took.
    fn start<E: LoadedEquations + ?Sized>(
        &self,
        equations: &mut E,
        newton: &Newton,
        factor: f64,
        near: bool,
    ) -> Result<(Vec<f64>, Vec<Iteration>), NewtonError> {
        let is_sound = |equations: &mut E, x: &[f64]| equations.trial(factor, x).broken.is_none();
        if let Some((earlier, last)) = &self.before {
            let ratio = (factor - self.factor) / (self.factor - earlier);
            let onwards = |(now, last): (&f64, &f64)| now + ratio * (now - last);
            let x: Vec<f64> = self.x.iter().zip(last).map(onwards).collect();
            // More left than there are loads: the path has turned.
            let mut left = vec![0.0; x.len()];
            if is_sound(equations, &x) && equations.residual(factor, &x, &mut left) < 1.0 {
                return Ok((x, Vec::new()));
            }
        }
        let mut right = vec![0.0; self.x.len()];
        let mut direction = right.clone();
        let report = equations.linearise(self.factor, &self.x, true).and_then(|()| {
            equations.step_residual(self.factor, factor, &mut right);
            equations.solve(&right, newton.forcing(1.0), &mut direction)
        });
        let LinearReport { steps, indefinite, .. } =
            report.map_err(|source| NewtonError::Linear { source, history: Vec::new() })?;
        let taken =
            |length| vec![Iteration { residual: 1.0, length, linear_steps: steps, indefinite }];
        let mut x = self.x.clone();
        advance(&mut x, 1.0, &direction);
        match is_sound(equations, &x) {
            true => Ok((x, taken(1.0))),
            // Loads alone can be met from where they were; what is moved by hand may not.
            false => match equations.trial(factor, &self.x).broken {
                None if !near => Ok((self.x.clone(), taken(0.0))),
                broken => {
                    let broken = equations.trial(factor, &x).broken.or(broken);
                    let (history, residual) = (taken(0.0), f64::NAN);
                    let particle = broken.unwrap_or_default();
                    Err(NewtonError::Broken { particle, history, residual })
                }
            },
        }
    }
}

fn any_indefinite(iterations: &[Iteration]) -> bool {
    iterations.iter().any(|iteration| iteration.indefinite)
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let changes: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    norm(&changes)
}

fn check(steps: &LoadSteps) -> Result<(), LoadError> {
    let (factors, sizes) = match steps {
        LoadSteps::Given(factors) => (factors, [1.0, 1.0]),
        LoadSteps::Automatic { levels, first, least } => (levels, [*first, *least]),
    };
    let mut before = 0.0;
    for &value in factors {
        // Given factors may fall, but each is to differ from the one before.
        let ordered = match steps {
            LoadSteps::Given(_) => value != before,
            LoadSteps::Automatic { .. } => value > before,
        };
        if !(ordered && value.is_finite()) {
            return Err(LoadError::Steps { value, before });
        }
        before = value;
    }
    let wrong = sizes.into_iter().find(|&size| !(size > 0.0 && size.is_finite()));
    wrong.map_or(Ok(()), |value| Err(LoadError::Steps { value, before: 0.0 }))
}

fn directions(negative: Option<usize>) -> String {
    match negative {
        Some(1) => "one direction".into(),
        Some(count) => format!("{count} directions"),
        None => "some direction".into(),
    }
}
