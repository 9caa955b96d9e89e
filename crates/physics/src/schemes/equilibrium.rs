//! What a formulation offers where there is no motion, only loads that grow.

use thiserror::Error;

use piola_formulas::hyperelastic::HyperelasticLaw;

use super::Scheme;
use crate::solve::LinearError;

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

    /// The derivatives of a state in equilibrium by a constant of the material of a body, at the same
    /// loads; `law` is the derivative of its law.
    ///
    /// # Errors
    /// [`NoSensitivity`].
    fn sensitivity(
        &mut self,
        state: &[f64],
        body: u32,
        law: &HyperelasticLaw,
    ) -> Result<Sensitivity, NoSensitivity>;
}

/// The derivatives of a state in equilibrium by a constant of a material, particle by particle with a
/// number for each axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Of the displacements, m over the unit of the constant.
    pub displacement: Vec<f64>,
    /// Of the forces of the supports, N over the unit of the constant.
    pub reaction: Vec<f64>,
}

/// Why the derivatives of a state are not known.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum NoSensitivity {
    /// The run has no states in equilibrium.
    #[error(
        "only states in equilibrium have one: set `time.integrator` to `static` or `arc_length`"
    )]
    NotStatic,
    /// Particles are made of several materials.
    #[error("it is not available where bodies are joined: take the difference of two runs")]
    Joined,
    /// Faces of cells are held.
    #[error("it is not available where faces of cells are held: take the difference of two runs")]
    Faces,
    /// The state is not one in equilibrium, as at the start of a run with loads.
    #[error(
        "the state is not in equilibrium, {residual:.1e} of the loads is left: take a step first"
    )]
    NotInEquilibrium {
        /// The norm of what loads and inner forces leave over that of the loads.
        residual: f64,
    },
    /// The tangent has no inverse.
    #[error(
        "the tangent is nearly singular, a residual of {residual:.1e} is left: the state is close \
         to a limit point, or needs the `direct` solver"
    )]
    Singular {
        /// What is left of the right-hand side.
        residual: f64,
    },
    /// The tangent has no solution.
    #[error(transparent)]
    Linear(#[from] LinearError),
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

/// A step is less accurate than was asked for. The run takes a shorter one.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the step of {step:.4e} s from t = {time:.6} s has an error of {error:.1e}, where {largest:.1e} is allowed"
)]
pub struct Inaccurate {
    /// What its error was estimated to be.
    pub error: f64,
    /// What it may be.
    pub largest: f64,
    /// Simulated time at its start in s.
    pub time: f64,
    /// Its length in s.
    pub step: f64,
}
