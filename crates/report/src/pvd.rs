//! The time series of particle files that ParaView opens (`.pvd`).

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::vtp::escape;
use super::{OutputError, atomic};

/// One instant of a time series.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Simulated time in s.
    pub time: f64,
    /// The particle file, relative to the folder of the series, with `/` between its parts.
    pub file: String,
}

/// Writes the series `frames` to the file `path`, whole at each call, so that a run that is killed
/// leaves a series of all frames finished before.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, frames: &[Frame]) -> Result<u64, OutputError> {
    atomic::write_file(path, |out| {
        out.write_all(
            b"<?xml version=\"1.0\"?>\n\
              <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
              <Collection>\n",
        )?;
        for Frame { time, file } in frames {
            let file = escape(file);
            writeln!(out, "    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>")?;
        }
        out.write_all(b"  </Collection>\n</VTKFile>\n")
    })
}
