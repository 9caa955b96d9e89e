//! What a formulation offers where there is no motion, only loads that grow.

use thiserror::Error;

use super::Scheme;

/// A formulation that finds states in equilibrium. The load factor takes the part of the time.
pub trait StaticScheme: Scheme {
    /// Writes the state in equilibrium with the loads of a factor of `to` to `new`, from `old`,
    /// which is the reference state where `from` is 0 and in equilibrium with the loads of `from`
    /// elsewhere. All that it depends on is in its arguments.
    ///
    /// # Errors
    /// [`NoSolution`]; `new` is of no use then.
    fn equilibrate(
        &mut self,
        from: f64,
        to: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), NoSolution>;

    /// As [`Self::equilibrate`] along a path on which loads may fall: `from` and `to` are lengths of
    /// the path in the space of displacements, in such a unit that in the first step the length is the
    /// load factor that this step would have if it were straight. The load factor is found with the
    /// state, and is one of its figures; states need not be stable.
    ///
    /// # Errors
    /// [`NoSolution`]; `new` is of no use then.
    fn follow(
        &mut self,
        from: f64,
        to: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), NoSolution>;
}

/// Why there is no state that meets the equations, as far as was looked.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{message}")]
pub struct NoSolution {
    /// In which way it was missed.
    pub kind: Missed,
    /// The time in s without one, or the load factor.
    pub time: f64,
    /// The last one with one.
    pub reached: f64,
    /// What happened, where, and what to do about it.
    pub message: String,
}

/// Ways to miss it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missed {
    /// The iteration did not get there.
    NoConvergence,
    /// Every way there turned a particle inside out.
    Inverted,
    /// What was found does not stay.
    Unstable,
}
