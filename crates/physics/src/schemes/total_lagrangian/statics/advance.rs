//! One step of the loads, from a state that is known from elsewhere.

use super::{StaticState, Statics, StaticsError};
use crate::Vector;
use crate::solve::{ArcPath, LoadError, NewtonError, Path};

/// A state that a step starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct Known<const D: usize> {
    /// Its load factor.
    pub factor: f64,
    /// Its displacements in m.
    pub displacement: Vec<Vector<D>>,
    /// Their rate by the load factor in the step that led there, in m; none at the start.
    pub rate: Option<Vec<Vector<D>>>,
}

impl<const D: usize> Statics<D> {
    /// The state at a load factor, one step after a known one: Newton's method starts where the rate
    /// leads, or the tangent where there is none.
    ///
    /// # Errors
    /// [`StaticsError`] where none is found, or none that stays.
    pub fn advance(
        &mut self,
        known: &Known<D>,
        factor: f64,
    ) -> Result<StaticState<D>, StaticsError> {
        let x = self.collect(&known.displacement);
        let step = factor - known.factor;
        let before = known.rate.as_ref().map(|rate| {
            let last = x.iter().zip(self.collect(rate)).map(|(x, rate)| x - step * rate);
            (known.factor - step, last.collect())
        });
        self.faces.reset();
        self.solver.restart();
        let path = Path { before, factor: known.factor, x };
        let newton = self.newton;
        let increment =
            path.attempt(self, &newton, factor, false).map_err(|error| self.located(error))?;
        Ok(self.state(increment))
    }

    /// The state one step of arc length after a known one, stable or not, whatever its load factor is:
    /// displacements move by `radius` in the norm of all unknowns together, or where there is none yet
    /// by what a load factor of `first` would move them alone, which `radius` then is.
    ///
    /// # Errors
    /// [`StaticsError`] where none is found.
    pub fn advance_along(
        &mut self,
        known: &Known<D>,
        first: f64,
        radius: &mut Option<f64>,
    ) -> Result<StaticState<D>, StaticsError> {
        let x = self.collect(&known.displacement);
        let last = known.rate.as_ref().map(|rate| self.collect(rate));
        self.faces.reset();
        self.solver.restart();
        let path = ArcPath { factor: known.factor, x, last };
        let newton = self.newton;
        let increment = path.attempt(self, &newton, first, radius).map_err(|source| {
            let factor = known.factor;
            self.located(LoadError::Newton { factor, reached: factor, source })
        })?;
        Ok(self.state(increment))
    }

    /// Force of the supports on each particle in N in equilibrium at displacements and a load factor,
    /// that of held faces by their coefficients.
    pub fn support_forces(&mut self, factor: f64, displacement: &[Vector<D>]) -> Vec<Vector<D>> {
        let x = self.collect(displacement);
        self.holding(factor, &x)
    }

    /// The unknowns of displacements.
    pub(super) fn collect(&self, rows: &[Vector<D>]) -> Vec<f64> {
        let mut x = vec![0.0; self.unknowns()];
        self.solver.reduction().collect(rows, &mut x);
        x
    }

    /// The particle where most force is left, and the force in N.
    pub(super) fn most_left(&self) -> (usize, f64) {
        let reduction = self.solver.reduction();
        let free = |a: usize| (self.left[a] - reduction.held_part(a, &self.left[a])).norm();
        let worse = |worst: usize, a: usize| if free(a) > free(worst) { a } else { worst };
        let particle = (1..self.left.len()).fold(0, worse);
        (particle, free(particle))
    }

    /// An error with the particle where most force is left, if that is what went wrong.
    fn located(&self, error: LoadError) -> StaticsError {
        let LoadError::Newton { source: NewtonError::NoConvergence { .. }, .. } = error else {
            return self.named(error);
        };
        let (particle, force) = self.most_left();
        let particles = &self.discrete.solid.particles;
        StaticsError::Residual {
            id: particles.id[particle],
            position: particles.position[particle].iter().copied().collect(),
            force,
            source: error,
        }
    }
}
