//! The observer that writes particle files.

use std::path::PathBuf;

use crate::output::{OutputError, pvd, vtp};
use crate::schemes::snapshot;
use crate::time::{Moment, ObserveError, Observer, Schedule};

/// Writes a particle file at each due time and keeps the time series that names them.
pub struct FrameWriter {
    schedule: Schedule,
    folder: PathBuf,
    fields: Vec<&'static str>,
    compression: vtp::Compression,
    frames: Vec<pvd::Frame>,
    last_time: Option<f64>,
}

impl FrameWriter {
    /// The folder of the particle files inside the results folder.
    pub const PARTICLES: &'static str = "particles";
    /// The file of the time series inside the results folder.
    pub const SERIES: &'static str = "particles.pvd";

    /// Writes `fields` into the results folder `folder` at `schedule`.
    pub fn new(
        folder: PathBuf,
        schedule: Schedule,
        fields: Vec<&'static str>,
        compression: vtp::Compression,
    ) -> Self {
        Self { schedule, folder, fields, compression, frames: Vec::new(), last_time: None }
    }

    fn write(&mut self, moment: &mut Moment) -> Result<(), OutputError> {
        let shot = snapshot(moment.scheme, moment.time, moment.step, moment.state, &self.fields);
        let file = format!("{}/frame_{:06}.vtp", Self::PARTICLES, self.frames.len());
        vtp::write(&self.folder.join(&file), &shot, self.compression)?;
        self.frames.push(pvd::Frame { time: moment.time, file });
        // The series is written after its newest file, so that it never names a missing one.
        pvd::write(&self.folder.join(Self::SERIES), &self.frames)?;
        Ok(())
    }
}

impl Observer for FrameWriter {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError> {
        if self.last_time == Some(moment.time) {
            return Ok(());
        }
        self.last_time = Some(moment.time);
        self.write(moment).map_err(|source| ObserveError {
            what: "writing a particle file",
            time: moment.time,
            source: source.into(),
        })
    }
}
