//! Systems of equations: Newton's method, load steps, and the linear solvers below them.
//!
//! Nothing here knows a formulation. A scheme says what its residual and its tangent are
//! ([`Equations`], [`LoadedEquations`] where loads grow, [`Tangent`]); which components of its
//! rows are unknowns is a [`Reduction`]. From these
//!
//! - [`SparseMatrix`] assembles the reduced tangent on a pattern that is found once, by gathering,
//!   so that it is the same to the bit for any number of threads;
//! - [`BlockMatrix`] has a tangent that is not symmetric, in blocks, for products, and gives its
//!   symmetric half to a factorisation;
//! - [`Factor`] takes it apart as `L D L^T`, in the order of [`dissect`], and counts the negative
//!   pivots: a direction in which the energy falls for each of them;
//! - [`conjugate_gradients`] and [`gmres`] need products only, and are preconditioned by the blocks
//!   on the diagonal and by the motions of a few parts as rigid bodies;
//! - [`largest_mode`] finds the fastest of all vibrations, which bounds explicit steps;
//! - [`LinearSolver`] is one of both ways behind one face;
//! - [`Newton`] finds the zero of a residual, [`follow`] a row of them under growing loads, and
//!   [`follow_arc`] a path on which loads may fall again.

mod arc_length;
mod blocks;
mod coarse;
mod dissection;
mod factor;
mod jacobi;
mod krylov;
mod lanczos;
mod linear;
mod load_steps;
mod newton;
mod reduction;
mod sparse;

pub use arc_length::{ArcLength, ArcPath, follow_arc};
pub use blocks::BlockMatrix;
pub use dissection::dissect;
pub use factor::{Factor, FactorError};
pub use krylov::{Outcome, conjugate_gradients, gmres};
pub use lanczos::{Mode, irregular, largest_mode};
pub use linear::{
    Costs, LinearError, LinearMethod, LinearReport, LinearSolver, Stability, Tangent, most_steps,
};
pub use load_steps::{Increment, LoadError, LoadSteps, Path, follow};
pub use newton::{
    Equations, Found, Iteration, LoadedEquations, Newton, NewtonError, Solved, Trial,
};
pub use reduction::{Local, Reduction};
pub use sparse::SparseMatrix;
