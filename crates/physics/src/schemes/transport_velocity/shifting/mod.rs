//! How particles are kept evenly spread: a velocity deviation, an iterated displacement, or the push of
//! a background pressure.

mod background;
mod iterative;
mod sun;

pub(super) use iterative::Iteration;
pub(super) use sun::Speed;
