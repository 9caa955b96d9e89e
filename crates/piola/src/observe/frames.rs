//! The observer that writes particle files.

use super::files::WrittenFiles;
use super::memory::{decode, encode, inside};
use crate::output::{Compression, OutputError, ResultsFolder, pvd, vtp};
use crate::time::{Misfit, Moment, ObserveError, Observer, Schedule};

/// Writes a particle file at each due time and keeps the time series that names them.
pub struct FrameWriter {
    schedule: Schedule,
    folder: ResultsFolder,
    fields: Vec<&'static str>,
    compression: Compression,
    written: WrittenFiles,
    frames: Vec<pvd::Frame>,
    last_time: Option<f64>,
}

impl FrameWriter {
    /// Writes `fields` into `folder` at `schedule`, and records the files in `written`.
    pub fn new(
        folder: ResultsFolder,
        schedule: Schedule,
        fields: Vec<&'static str>,
        compression: Compression,
        written: WrittenFiles,
    ) -> Self {
        Self { schedule, folder, fields, compression, written, frames: Vec::new(), last_time: None }
    }

    fn write(&mut self, moment: &mut Moment) -> Result<(), OutputError> {
        let shot = moment.now.snapshot(moment.step, &self.fields);
        let path = self.folder.particles(self.frames.len() as u64)?;
        vtp::write(&path, &shot, self.compression)?;
        let file = self.folder.relative(&path);
        self.frames.push(pvd::Frame { time: moment.now.time(), file });
        // The series is written after its newest file, so that it never names a missing one.
        pvd::write(&self.folder.series(), &self.frames)?;
        self.written.push(self.folder.series());
        self.written.push(path);
        Ok(())
    }
}

impl Observer for FrameWriter {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError> {
        if self.last_time == Some(moment.now.time()) {
            return Ok(());
        }
        self.last_time = Some(moment.now.time());
        self.write(moment).map_err(|source| ObserveError {
            what: "writing a particle file",
            time: moment.now.time(),
            source: source.into(),
        })
    }

    fn save(&self) -> Vec<u8> {
        encode(&(&self.frames, self.last_time))
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Misfit> {
        (self.frames, self.last_time) = decode(saved, "the particle files")?;
        inside(self.frames.iter().map(|frame| &frame.file))
    }

    fn rewind(&mut self, time: f64) -> Result<(), ObserveError> {
        for frame in self.frames.extract_if(.., |frame| frame.time > time) {
            self.written.remove(&self.folder.path().join(frame.file));
        }
        self.last_time = self.frames.last().map(|frame| frame.time);
        Ok(())
    }
}
