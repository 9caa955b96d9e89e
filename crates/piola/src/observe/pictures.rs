//! The observer that draws the particles.

use super::files::WrittenFiles;
use super::memory::{decode, encode, inside};
use crate::fields::FieldSelector;
use crate::output::{Bounds, OutputError, Picture, ResultsFolder, When};
use crate::time::{Misfit, Moment, ObserveError, Observer, Schedule};

/// What a picture shows.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureRequest {
    /// The title above it.
    pub title: String,
    /// The number that colours a particle.
    pub field: FieldSelector,
    /// Ends of the colour bar; those of the data if `None`.
    pub range: Option<[f64; 2]>,
    /// The part of space that is shown; where the particles are if `None`.
    pub part: Option<Bounds>,
    /// Spacing of the particles in the reference state in m.
    pub spacing: f64,
    /// Numbers of the bodies that are left out.
    pub hidden: Vec<u32>,
}

/// Draws the particles at due times, and the last state of a run that ends before them.
pub struct PictureWriter {
    schedule: Schedule,
    folder: ResultsFolder,
    request: PictureRequest,
    written: WrittenFiles,
    /// The pictures so far, with their times in s.
    drawn: Vec<(String, f64)>,
}

impl PictureWriter {
    /// Draws `request` into `folder` at `schedule`, and records the files in `written`.
    pub fn new(
        folder: ResultsFolder,
        schedule: Schedule,
        request: PictureRequest,
        written: WrittenFiles,
    ) -> Self {
        Self { schedule, folder, request, written, drawn: Vec::new() }
    }

    fn draw(&mut self, moment: &mut Moment) -> Result<(), OutputError> {
        let PictureRequest { title, field, range, part, spacing, hidden } = &self.request;
        let name = field.field.name;
        let shot = moment.now.snapshot(moment.step, &[name]);
        let Some(found) = shot.field(name) else { return Ok(()) };
        let components = field.field.kind.components(shot.dimension);
        let bodies = &shot.bodies;
        let place = |a: usize| &shot.positions[a * shot.dimension..][..shot.dimension];
        let is_in = |a: usize| part.is_none_or(|part| part.contains(place(a)));
        let shown = || (0..bodies.len()).filter(|&a| !hidden.contains(&bodies[a]) && is_in(a));
        let value = |a: usize| field.value(&found.values[a * components..][..components]);
        let positions: Vec<f64> = shown().flat_map(place).copied().collect();
        let values: Vec<f64> = shown().map(value).collect();
        let widths: Vec<f64> = shown().map(|a| shot.widths[a]).collect();
        let label = field.name(shot.dimension);
        let when = match moment.now.is_static() {
            true => When::LoadFactor(moment.now.time()),
            false => When::Time(moment.now.time()),
        };
        let path = self.folder.picture(&label, self.drawn.len() as u64)?;
        Picture {
            title,
            when: Some(when),
            label: &label,
            unit: field.field.unit,
            dimension: shot.dimension,
            positions: &positions,
            values: &values,
            range: *range,
            spacing: *spacing,
            widths: &widths,
            bounds: *part,
        }
        .write_png(&path)?;
        self.drawn.push((self.folder.relative(&path), moment.now.time()));
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
        let last = self.drawn.last().map(|(_, time)| *time);
        let pending = self.schedule.next_after(last.unwrap_or(-1.0));
        if last == Some(moment.now.time()) || (moment.last && pending.is_none()) {
            return Ok(());
        }
        self.draw(moment).map_err(|source| ObserveError {
            what: "drawing the particles",
            time: moment.now.time(),
            source: source.into(),
        })
    }

    fn save(&self) -> Vec<u8> {
        encode(&self.drawn)
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Misfit> {
        self.drawn = decode(saved, "the pictures")?;
        inside(self.drawn.iter().map(|(file, _)| file))
    }

    fn rewind(&mut self, time: f64) -> Result<(), ObserveError> {
        for (path, _) in self.drawn.extract_if(.., |(_, drawn)| *drawn > time) {
            self.written.remove(&self.folder.path().join(path));
        }
        Ok(())
    }
}
