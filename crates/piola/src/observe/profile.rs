//! The observer that records fields along a line.

use super::files::WrittenFiles;
use super::interpolation::Interpolated;
use super::memory::{decode, encode, inside};
use super::probe::component_columns;
use super::recorder::SharedTables;
use super::tables::{SpaceTime, Tables};
use crate::output::{Column, ResultsFolder, Table};
use crate::time::{Misfit, Moment, ObserveError, Observer, Schedule};

/// A probe along a straight line.
#[derive(Clone)]
pub struct Line {
    /// First part of the names of its columns and of its files.
    pub name: String,
    /// Distances of its points from the first one in m.
    pub distances: Vec<f64>,
    /// Its points, and what is recorded there.
    pub values: Interpolated,
    /// Times at which it is recorded.
    pub schedule: Schedule,
    /// Times of the profiles where each is the mean of what has been recorded since the one before; `None` where each is
    /// what has been recorded once.
    pub means: Option<Schedule>,
    /// Columns that are kept at all times.
    pub over_time: Vec<String>,
}

impl Line {
    /// Columns of its table: the distance, the place, and the fields.
    fn columns(&self, dimension: usize) -> Vec<Column> {
        let place = ["distance", "x", "y", "z"].into_iter().take(1 + dimension);
        let place = place.map(|name| Column::new(name, "m"));
        place.chain(component_columns(&self.name, &self.values.fields, dimension)).collect()
    }

    /// Numbers of its table in `dimension` dimensions, and of what is kept at `times` times.
    pub fn numbers(&self, dimension: usize, times: usize) -> usize {
        let columns = self.columns(dimension).len();
        let samples = if self.means.is_some() { columns * times } else { 0 };
        (columns + samples + self.over_time.len() * times) * self.distances.len()
    }
}

/// Records a line at due times and in the last state of a run, writes each profile into a file of its
/// own, and keeps the newest in the tables. With due times that are listed the last state counts only
/// if some of them were not reached.
pub struct ProfileRecorder {
    line: Line,
    folder: Option<(ResultsFolder, WrittenFiles)>,
    tables: SharedTables,
    /// Number of its table among the profiles.
    number: usize,
    /// Of each column that is kept, where it is in a profile and in the tables.
    kept: Vec<(usize, usize)>,
    /// The files so far, and the times of all profiles in s.
    files: Vec<String>,
    times: Vec<f64>,
    /// What profiles are means of, with the times in s: since the last but one of them, so that a run that goes back past one
    /// makes it again of the same.
    samples: Vec<(f64, Vec<f64>)>,
    scratch: Vec<f64>,
}

impl ProfileRecorder {
    /// A recorder of `line` in `dimension` dimensions that adds its table to `tables`. With a folder it writes a file
    /// for each profile, and records it in the list of files.
    pub fn new(
        line: Line,
        dimension: usize,
        tables: SharedTables,
        folder: Option<(ResultsFolder, WrittenFiles)>,
    ) -> Self {
        let mut shared = tables.lock();
        let number = shared.profiles.len();
        let profile = Table::new(line.columns(dimension));
        let mut kept = Vec::new();
        for place in line.over_time.iter().filter_map(|name| profile.index(name)) {
            kept.push((place, shared.over_time.len()));
            shared.over_time.push(SpaceTime {
                column: profile.columns()[place].clone(),
                distances: line.distances.clone(),
                times: Vec::new(),
                values: Vec::new(),
            });
        }
        shared.profiles.push(profile);
        drop(shared);
        let (files, times, samples, scratch) = Default::default();
        Self { line, folder, tables, number, kept, files, times, samples, scratch }
    }

    /// The values of all fields at all points.
    fn sample(&mut self, moment: &mut Moment) -> Vec<f64> {
        let mut values = Vec::new();
        self.line.values.record(moment.now, &mut self.scratch, &mut values);
        values
    }

    /// Takes a sample, and returns the mean of those since the last profile where one is due.
    fn mean(&mut self, moment: &mut Moment, is_due: bool) -> Option<Vec<f64>> {
        let time = moment.now.time();
        if self.samples.last().is_none_or(|(known, _)| *known != time) {
            let values = self.sample(moment);
            self.samples.push((time, values));
        }
        if !is_due {
            return None;
        }
        let last = self.times.last().copied().unwrap_or(-1.0);
        let since = self.samples.partition_point(|(time, _)| *time <= last);
        let own = &self.samples[since..];
        let mut mean = vec![0.0; own[0].1.len()];
        for (_, values) in own {
            mean.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
        mean.iter_mut().for_each(|sum| *sum /= own.len() as f64);
        self.samples.drain(..since);
        Some(mean)
    }

    /// Writes a profile of these values.
    fn record(&mut self, moment: &mut Moment, values: &[f64]) -> Result<(), ObserveError> {
        let interpolated = &self.line.values;
        let width = values.len() / self.line.distances.len();
        let places = self.line.distances.iter().zip(&interpolated.places);
        let rows =
            places.zip(values.chunks_exact(width)).flat_map(|((distance, place), values)| {
                std::iter::once(distance).chain(place).chain(values).copied()
            });
        let mut tables = self.tables.lock();
        let Tables { profiles, over_time, .. } = &mut *tables;
        let table = &mut profiles[self.number];
        table.set_numbers(rows.collect()).expect("a place has a number for each column");
        self.times.push(moment.now.time());
        for &(place, number) in &self.kept {
            let kept = &mut over_time[number];
            kept.times.push(moment.now.time());
            kept.values.extend(table.rows().map(|row| row[place]));
        }
        let Some((folder, written)) = &self.folder else { return Ok(()) };
        let fail = |source: crate::output::OutputError| ObserveError {
            what: "writing a profile",
            time: moment.now.time(),
            source: source.into(),
        };
        let path = folder.profile(&self.line.name, self.files.len() as u64).map_err(fail)?;
        table.write_csv(&path).map_err(fail)?;
        self.files.push(folder.relative(&path));
        written.push(path);
        Ok(())
    }
}

impl Observer for ProfileRecorder {
    fn schedule(&self) -> &Schedule {
        &self.line.schedule
    }

    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError> {
        let (now, written) = (moment.now.time(), self.times.last().copied());
        let last = self.samples.last().map(|(time, _)| *time).or(written);
        let asked_for = match self.line.schedule {
            Schedule::At(_) => self.line.schedule.next_after(last.unwrap_or(-1.0)).is_some(),
            _ => true,
        };
        if written == Some(now) || (moment.last && !asked_for) {
            return Ok(());
        }
        let ends = self.line.means.as_ref();
        let is_due = ends.map(|ends| moment.last || ends.is_due(written.unwrap_or(-1.0), now));
        let values = match is_due {
            Some(is_due) => self.mean(moment, is_due),
            None => Some(self.sample(moment)),
        };
        values.map_or(Ok(()), |values| self.record(moment, &values))
    }

    fn save(&self) -> Vec<u8> {
        let tables = self.tables.lock();
        let kept = self.kept.iter().map(|(_, number)| &tables.over_time[*number].values);
        let kept: Vec<&Vec<f64>> = kept.collect();
        let profile = tables.profiles[self.number].numbers();
        encode(&(&self.files, &self.times, profile, kept, &self.samples))
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Misfit> {
        let what = format!("the line {}", self.line.name);
        let (numbers, values);
        (self.files, self.times, numbers, values, self.samples) = decode(saved, &what)?;
        let values: Vec<Vec<f64>> = values;
        inside(&self.files)?;
        let length = self.times.len() * self.line.distances.len();
        if values.len() != self.kept.len() || values.iter().any(|kept| kept.len() != length) {
            return Err(Misfit(format!("{what} keeps other columns over time, and not in it")));
        }
        let mut tables = self.tables.lock();
        // Of the columns of a profile all but distance and place.
        let dimension = self.line.values.places.first().map_or(0, Vec::len);
        let columns = tables.profiles[self.number].columns().len() - 1 - dimension;
        let length = columns * self.line.distances.len();
        if self.samples.iter().any(|(_, values)| values.len() != length) {
            return Err(Misfit(format!("{what} has samples of other columns, and not in it")));
        }
        for ((_, number), values) in self.kept.iter().zip(values) {
            let kept = &mut tables.over_time[*number];
            (kept.times, kept.values) = (self.times.clone(), values);
        }
        let other = |columns| Misfit(format!("{what} has {columns} columns, and not in it"));
        tables.profiles[self.number].set_numbers(numbers).map_err(other)
    }

    fn rewind(&mut self, time: f64) -> Result<(), ObserveError> {
        self.samples.retain(|(known, _)| *known <= time);
        let kept = self.times.partition_point(|known| *known <= time);
        if kept == self.times.len() {
            return Ok(());
        }
        self.times.truncate(kept);
        if let Some((folder, written)) = &self.folder {
            for file in self.files.drain(kept..) {
                written.remove(&folder.path().join(file));
            }
        }
        // What follows is recorded again, at the latest at the end of the run.
        let mut tables = self.tables.lock();
        for (_, number) in &self.kept {
            let column = &mut tables.over_time[*number];
            column.times.truncate(kept);
            column.values.truncate(kept * column.distances.len());
        }
        tables.profiles[self.number].set_numbers(Vec::new()).expect("no rows are whole rows");
        Ok(())
    }
}
