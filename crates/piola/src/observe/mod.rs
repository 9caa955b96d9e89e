//! What is recorded during a run (probes, energies, steps, particle files, pictures), and how histories become single
//! numbers.

mod comparison;
mod files;
mod flow;
mod frames;
mod interpolation;
mod memory;
mod pictures;
mod probe;
mod profile;
mod recorder;
pub mod reduce;
mod sensor;
mod tables;
mod void;

pub use comparison::{Deviation, Norm};
pub use files::WrittenFiles;
pub use flow::{Flux, Gauge};
pub use frames::FrameWriter;
pub use interpolation::Interpolated;
pub use pictures::{PictureRequest, PictureWriter};
pub use probe::{Probe, ProbeKind, TANGENT_COLUMNS, moment_axes, opening_columns};
pub use profile::{Line, ProfileRecorder};
pub use recorder::{Recorder, STEP_COLUMNS, SharedTables, energy_columns, momentum_columns};
pub use sensor::Sensor;
pub use tables::{Series, SpaceTime, Tables};
pub use void::Void;
