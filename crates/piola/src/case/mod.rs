//! Case files: what a user writes, checked and turned into types.

pub mod diagnostics;
pub mod expression;
pub mod model;
mod render;
pub mod source;
mod suggest;
pub mod verify;
