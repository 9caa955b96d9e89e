//! What is recorded of a run while it goes, and what becomes of it.

pub mod reduce;
