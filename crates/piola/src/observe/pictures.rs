//! The observer that draws the particles.

use super::files::WrittenFiles;
use crate::fields::FieldSelector;
use crate::output::{OutputError, Picture, ResultsFolder};
use crate::schemes::snapshot;
use crate::time::{Moment, ObserveError, Observer, Schedule};

/// What a picture shows.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureRequest {
    /// Stands above it.
    pub title: String,
    /// The number that colours a particle.
    pub field: FieldSelector,
    /// Ends of the colour bar; those of the data if `None`.
    pub range: Option<[f64; 2]>,
    /// Spacing of the particles in the reference in m.
    pub spacing: f64,
}

/// Draws the particles at due times, and the last state of a run that ends before them.
pub struct PictureWriter {
    schedule: Schedule,
    folder: ResultsFolder,
    request: PictureRequest,
    written: WrittenFiles,
    count: u64,
    last_time: Option<f64>,
}

impl PictureWriter {
    /// Draws `request` into `folder` at `schedule`, and notes the files in `written`.
    pub fn new(
        folder: ResultsFolder,
        schedule: Schedule,
        request: PictureRequest,
        written: WrittenFiles,
    ) -> Self {
        Self { schedule, folder, request, written, count: 0, last_time: None }
    }

    fn draw(&mut self, moment: &mut Moment) -> Result<(), OutputError> {
        let PictureRequest { title, field, range, spacing } = &self.request;
        let name = field.field.name;
        let shot = snapshot(moment.scheme, moment.time, moment.step, moment.state, &[name]);
        let Some(found) = shot.field(name) else { return Ok(()) };
        let components = field.field.kind.components(shot.dimension);
        let values: Vec<f64> =
            found.values.chunks_exact(components).map(|value| field.value(value)).collect();
        let label = field.name(shot.dimension);
        let path = self.folder.picture(&label, self.count)?;
        Picture {
            title,
            time: Some(moment.time),
            label: &label,
            unit: field.field.unit,
            dimension: shot.dimension,
            positions: &shot.positions,
            values: &values,
            range: *range,
            spacing: *spacing,
            bounds: None,
        }
        .write_png(&path)?;
        self.count += 1;
        self.written.push(path);
        Ok(())
    }
}

impl Observer for PictureWriter {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError> {
        // The last moment is shown to every observer. It is worth a picture if it was asked for,
        // or if pictures that were asked for will never be.
        let before = self.last_time.unwrap_or(-1.0);
        let pending = self.schedule.next_after(before);
        if self.last_time == Some(moment.time) || (moment.last && pending.is_none()) {
            return Ok(());
        }
        self.last_time = Some(moment.time);
        self.draw(moment).map_err(|source| ObserveError {
            what: "drawing the particles",
            time: moment.time,
            source: source.into(),
        })
    }
}
