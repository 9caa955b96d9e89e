//! Paths on which loads may fall.

use super::Stability;
use super::krylov::{advance, dot, norm};
use super::load_steps::{Increment, LoadError};
use super::newton::{Iteration, LoadedEquations, Newton, NewtonError, Solved};

/// How a path is followed by cylindrical arc length: steps of the unknowns have a given length,
/// and the load factor is what balances them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcLength {
    /// Load factor that the first step would have alone; it sets the length.
    pub first: f64,
    /// Steps before it stops.
    pub most_steps: usize,
    /// Iterations a step is meant to take: its length is adapted to that.
    pub wanted_iterations: usize,
    /// Largest length over the first one.
    pub most_growth: f64,
}

impl Default for ArcLength {
    fn default() -> Self {
        Self { first: 0.1, most_steps: 100, wanted_iterations: 4, most_growth: 4.0 }
    }
}

/// Halvings of a step's length before it is given up.
const MOST_CUTS: usize = 8;

/// Follows the path from `start` at a load factor of 0, through limit points, as long as
/// `show(equations, increment)` wants more. Equilibria are shown whether they are stable or not.
///
/// # Errors
/// [`LoadError::Newton`] where a step does not converge however short it is.
pub fn follow_arc<E: LoadedEquations + ?Sized>(
    equations: &mut E,
    newton: &Newton,
    arc: &ArcLength,
    start: Vec<f64>,
    mut show: impl FnMut(&mut E, Increment) -> bool,
) -> Result<(), LoadError> {
    let mut walk = ArcPath { factor: 0.0, x: start, last: None };
    let mut radius = None;
    let mut largest = f64::INFINITY;
    for _ in 0..arc.most_steps {
        let mut cuts = 0;
        let (factor, x, solved) = loop {
            match walk.attempt(equations, newton, arc.first, &mut radius) {
                Ok(Increment { factor, x, solved, .. }) => break (factor, x, solved),
                Err(_) if cuts < MOST_CUTS => {
                    cuts += 1;
                    radius = radius.map(|radius| 0.5 * radius);
                }
                Err(source) => {
                    let reached = walk.factor;
                    return Err(LoadError::Newton { factor: reached, reached, source });
                }
            }
        };
        if largest.is_infinite() {
            largest = radius.map_or(largest, |radius| arc.most_growth * radius);
        }
        let taken = solved.iterations.len().max(1);
        let growth = (arc.wanted_iterations as f64 / taken as f64).sqrt();
        radius = radius.map(|radius| (radius * growth).min(largest));
        let moved = x.iter().zip(&walk.x).map(|(new, old)| new - old).collect();
        walk = ArcPath { factor, x: x.clone(), last: Some(moved) };
        if !show(equations, Increment { factor, x, solved, jumped: false }) {
            break;
        }
    }
    Ok(())
}

/// Where a path by arc length has come to: the last state with the way that led to it.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcPath {
    /// Load factor of the state.
    pub factor: f64,
    /// Its unknowns.
    pub x: Vec<f64>,
    /// The last step of the unknowns, of any length; none at the start.
    pub last: Option<Vec<f64>>,
}

impl ArcPath {
    /// The state one step of a length of `radius` further, stable or not. Where there is no radius
    /// yet it becomes the length of the step that a load factor of `first` would have alone.
    ///
    /// # Errors
    /// [`NewtonError`] where the step does not converge.
    pub fn attempt<E: LoadedEquations + ?Sized>(
        &self,
        equations: &mut E,
        newton: &Newton,
        first: f64,
        radius: &mut Option<f64>,
    ) -> Result<Increment, NewtonError> {
        let count = self.x.len();
        let linear = |source, history: &[Iteration]| NewtonError::Linear {
            source,
            history: history.to_vec(),
        };
        let tight = 1e-2 * newton.tolerance;
        let (mut rate, mut along) = (vec![0.0; count], vec![0.0; count]);
        equations
            .linearise(self.factor, &self.x, false)
            .and_then(|()| {
                equations.load_rate(self.factor, &mut rate);
                equations.solve(&rate, tight, &mut along)
            })
            .map_err(|source| linear(source, &[]))?;
        let size = norm(&along);
        let radius = *radius.get_or_insert(first.abs() * size);
        // Onwards: the way along the load that goes on where the last step went.
        let ahead = match &self.last {
            Some(last) => dot(last, &along).signum(),
            None => first.signum(),
        };
        let mut factor = self.factor + ahead * radius / size;
        let mut moved: Vec<f64> = along.iter().map(|d| ahead * radius / size * d).collect();
        let mut history = Vec::new();
        let (mut left, mut back) = (vec![0.0; count], vec![0.0; count]);
        loop {
            let mut x = self.x.clone();
            advance(&mut x, 1.0, &moved);
            if let Some(particle) = equations.trial(factor, &x).broken {
                return Err(NewtonError::Broken { particle, history, residual: f64::NAN });
            }
            let mut residual = equations.residual(factor, &x, &mut left);
            if residual <= newton.tolerance && equations.settle(factor, &x) {
                residual = equations.residual(factor, &x, &mut left);
            }
            if residual <= newton.tolerance {
                equations.linearise(factor, &x, false).map_err(|e| linear(e, &history))?;
                let stability: Stability = equations.stability();
                let solved = Solved { iterations: history, residual, stability };
                return Ok(Increment { factor, x, solved, jumped: false });
            }
            if history.len() >= newton.most_iterations || !residual.is_finite() {
                return Err(NewtonError::NoConvergence { history, residual });
            }
            let report = equations
                .linearise(factor, &x, false)
                .and_then(|()| {
                    equations.load_rate(factor, &mut rate);
                    equations.solve(&rate, tight, &mut along)?;
                    equations.solve(&left, tight, &mut back)
                })
                .map_err(|e| linear(e, &history))?;
            let Some(change) = balance(&moved, &back, &along, radius) else {
                return Err(NewtonError::NoConvergence { history, residual });
            };
            factor += change;
            advance(&mut moved, 1.0, &back);
            advance(&mut moved, change, &along);
            history.push(Iteration {
                residual,
                length: 1.0,
                linear_steps: report.steps,
                indefinite: report.indefinite,
            });
        }
    }
}

/// The change c of the load factor for which `|moved + back + c along| = radius`, of the two the
/// one that turns round less; none where the sphere is missed.
fn balance(moved: &[f64], back: &[f64], along: &[f64], radius: f64) -> Option<f64> {
    let reached: Vec<f64> = moved.iter().zip(back).map(|(m, b)| m + b).collect();
    let (a, half) = (dot(along, along), dot(along, &reached));
    let c = dot(&reached, &reached) - radius * radius;
    let under = half * half - a * c;
    if !(under >= 0.0 && a > 0.0) {
        return None;
    }
    let roots = [(-half + under.sqrt()) / a, (-half - under.sqrt()) / a];
    let turn = dot(moved, along);
    let forward = |root: &f64| turn * root;
    Some(if forward(&roots[0]) >= forward(&roots[1]) { roots[0] } else { roots[1] })
}
