//! Implicit steps of `du/dt = f(u, t)`, and what a formulation offers for them.

use thiserror::Error;

use super::{NoSolution, Scheme};

/// One implicit step of `du/dt = f(u, t)`, theory (55): by the theta method, Upwind (4.4) and (4.5),
///
/// ```text
/// u' = u + h [(1 - theta) f(u, t) + theta f(u', t')]
/// ```
///
/// or by the implicit midpoint rule, `u' = u + h f((u + u')/2, t + h/2)`. Both ask for the zero of
/// `s - b - k f(s, t_s)` with a base b that is known and a weight k: s is u' in the first, and
/// `(u + u')/2` in the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theta {
    theta: f64,
    is_midpoint: bool,
}

/// A share of the end of a step with which no step is safe, however small, or only small ones are.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "theta = {theta} does not give unconditionally stable steps: 1/2 to 1 does, 1/2 is of \
     second order and 1 damps most"
)]
pub struct UnstableTheta {
    /// What was asked for.
    pub theta: f64,
}

impl Theta {
    /// First order; short periods are damped away.
    pub const BACKWARD_EULER: Self = Self { theta: 1.0, is_midpoint: false };

    /// The mean of both ends: second order, without damping; the energy of a linear system is kept.
    pub const CRANK_NICOLSON: Self = Self { theta: 0.5, is_midpoint: false };

    /// A theta of 0.55, unless another is asked for: short periods are damped, long ones hardly.
    pub const DAMPED: Self = Self { theta: 0.55, is_midpoint: false };

    /// The rate in the middle: second order, without damping; quadratic invariants are kept.
    pub const MIDPOINT: Self = Self { theta: 0.5, is_midpoint: true };

    /// The theta method.
    ///
    /// # Errors
    /// [`UnstableTheta`] outside of 1/2 to 1.
    pub fn new(theta: f64) -> Result<Self, UnstableTheta> {
        match (0.5..=1.0).contains(&theta) {
            true => Ok(Self { theta, is_midpoint: false }),
            false => Err(UnstableTheta { theta }),
        }
    }

    /// Whether it takes energy from periods that are short against its steps.
    pub fn damps(&self) -> bool {
        self.theta > 0.5
    }

    /// Order of its errors in the length of a step.
    pub fn order(&self) -> i32 {
        if self.theta == 0.5 { 2 } else { 1 }
    }

    /// Share of the rate at the start of a step.
    pub fn share_at_start(&self) -> f64 {
        if self.is_midpoint { 0.0 } else { 1.0 - self.theta }
    }

    /// `k/h`: share of the rate that is asked for.
    pub fn weight(&self) -> f64 {
        self.theta
    }

    /// How far into a step that rate is, as a share of it.
    pub fn instant(&self) -> f64 {
        if self.is_midpoint { 0.5 } else { 1.0 }
    }

    /// The end of a step from `old`, in place of the `state` that was asked for.
    pub fn finish(&self, old: &[f64], state: &mut [f64]) {
        if self.is_midpoint {
            state.iter_mut().zip(old).for_each(|(state, old)| *state = 2.0 * *state - old);
        }
    }
}

/// A formulation that finds the state at the end of a step from its rates there.
pub trait ThetaScheme: Scheme {
    /// Writes the state one step of `rule` after `old` at `time` to `new`. All that it depends on is
    /// in its arguments.
    ///
    /// # Errors
    /// [`NoSolution`]; `new` is of no use then.
    fn advance(
        &mut self,
        rule: &Theta,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), NoSolution>;

    /// Taylor test of the tangent of a step of `rule` from `state`: how far the residual is from
    /// linear at a distance of each of `sizes` in one direction. It falls as the square of these
    /// where the tangent is the derivative, Upwind (6.24) to (6.26).
    fn remainders(
        &mut self,
        rule: &Theta,
        time: f64,
        step: f64,
        state: &[f64],
        sizes: &[f64],
    ) -> Vec<f64>;

    /// `sqrt(sum_a m_a |v_a - w_a|^2)` of the velocities v and w of two states, in J^(1/2).
    fn kinetic_distance(&self, one: &[f64], other: &[f64]) -> f64;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_that_need_small_steps_are_refused() {
        for theta in [0.0, 0.49, 1.01, f64::NAN] {
            assert!(Theta::new(theta).is_err(), "{theta}");
        }
        assert_eq!(Theta::new(0.5), Ok(Theta::CRANK_NICOLSON));
        assert_eq!(Theta::new(1.0), Ok(Theta::BACKWARD_EULER));
        assert!(Theta::BACKWARD_EULER.damps() && !Theta::MIDPOINT.damps());
    }
}
