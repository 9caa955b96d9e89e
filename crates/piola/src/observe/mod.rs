//! What is recorded of a run while it goes (probes, energies, steps, particle files, pictures),
//! and how histories become single numbers.

mod frames;
mod probe;
mod recorder;
pub mod reduce;
mod tables;

pub use frames::FrameWriter;
pub use probe::{Probe, ProbeKind};
pub use recorder::{Recorder, SharedTables};
pub use tables::{Series, Tables};
