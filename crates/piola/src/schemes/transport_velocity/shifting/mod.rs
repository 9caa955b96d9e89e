//! How particles are kept evenly spread: a velocity deviation, or an iterated displacement.

mod iterative;
mod sun;

pub(super) use iterative::Iteration;
