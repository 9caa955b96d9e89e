//! The observer that fills the tables.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::files::WrittenFiles;
use super::probe::Probe;
use super::tables::Tables;
use crate::output::{Column, OutputError, ResultsFolder, Table};
use crate::schemes::Scheme;
use crate::time::{Moment, ObserveError, Observer, Schedule};

/// Tables that the recorder fills and the owner of the run reads when it is over.
#[derive(Clone)]
pub struct SharedTables(Arc<Mutex<Tables>>);

impl SharedTables {
    /// The tables. A thread that panicked while it held them left whole rows.
    pub fn lock(&self) -> MutexGuard<'_, Tables> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Names and units of the columns of the table of steps, after the time.
pub const STEP_COLUMNS: [(&str, &str); 5] = [
    ("count", "1"),
    ("size", "s"),
    ("smallest_ratio", "1"),
    ("ratio_mismatch", "1"),
    ("largest_speed", "m/s"),
];

/// Names of the columns of the energy table, after the time: the energies of a scheme and their
/// sum, the work of its mechanisms so far, and what the sum has gained beyond that work, which by
/// theory (18) is the error of the integrator.
pub fn energy_columns(energies: &[&'static str], mechanisms: &[&'static str]) -> Vec<&'static str> {
    [energies, &["total"], mechanisms, &["balance"]].concat()
}

/// Records probes, energies and steps at every due time, and keeps the CSV files up to date.
pub struct Recorder {
    schedule: Schedule,
    /// Times at which the CSV files are written anew.
    save: Schedule,
    next_save: Option<f64>,
    folder: Option<(ResultsFolder, WrittenFiles)>,
    probes: Vec<Probe>,
    tables: SharedTables,
    start: Option<f64>,
    last_time: Option<f64>,
    row: Vec<f64>,
    scratch: Vec<f64>,
}

impl Recorder {
    /// A recorder of `probes` and of what `scheme` reports, with rows at `schedule`. With a
    /// folder it writes the CSV files at `save` and at the end, and notes them.
    pub fn new(
        scheme: &dyn Scheme,
        probes: Vec<Probe>,
        schedule: Schedule,
        save: Schedule,
        folder: Option<(ResultsFolder, WrittenFiles)>,
    ) -> Self {
        let time = || Column::new("time", "s");
        let mut probe_columns = vec![time()];
        probe_columns.extend(probes.iter().flat_map(|probe| probe.columns(scheme.dimension())));
        let energy_names = energy_columns(scheme.energy_names(), scheme.mechanisms());
        let energy_columns = energy_names.into_iter().map(|name| Column::new(name, "J"));
        let energy = std::iter::once(time()).chain(energy_columns).collect();
        let step_columns = STEP_COLUMNS.iter().map(|&(name, unit)| Column::new(name, unit));
        let steps = std::iter::once(time()).chain(step_columns).collect();
        let tables = Tables {
            probes: Table::new(probe_columns),
            energy: Table::new(energy),
            steps: Table::new(steps),
        };
        Self {
            next_save: save.next_after(0.0),
            schedule,
            save,
            folder,
            probes,
            tables: SharedTables(Arc::new(Mutex::new(tables))),
            start: None,
            last_time: None,
            row: Vec::new(),
            scratch: Vec::new(),
        }
    }

    /// The tables that it fills.
    pub fn tables(&self) -> SharedTables {
        self.tables.clone()
    }

    fn record(&mut self, moment: &mut Moment) {
        let mut tables = self.tables.0.lock().unwrap_or_else(PoisonError::into_inner);
        let row = &mut self.row;
        let complete = "a row has a number for each column";

        row.clear();
        row.push(moment.time);
        for probe in &self.probes {
            probe.record(moment.scheme, moment.time, moment.state, &mut self.scratch, row);
        }
        tables.probes.push_row(row).expect(complete);

        let energies = moment.scheme.energy_names().len();
        row.clear();
        row.resize(1 + energies, 0.0);
        row[0] = moment.time;
        moment.scheme.energies(moment.state, &mut row[1..]);
        let total: f64 = row[1..].iter().sum();
        row.push(total);
        let work = &moment.state[moment.state.len() - moment.scheme.mechanisms().len()..];
        row.extend_from_slice(work);
        let start = *self.start.get_or_insert(total);
        row.push(total - start - work.iter().sum::<f64>());
        tables.energy.push_row(row).expect(complete);

        row.clear();
        let health = moment.health;
        row.extend([
            moment.time,
            moment.step as f64,
            moment.step_size,
            health.smallest_ratio,
            health.ratio_mismatch,
            health.largest_speed,
        ]);
        tables.steps.push_row(row).expect(complete);
    }

    fn write(&self) -> Result<(), OutputError> {
        let Some((folder, written)) = &self.folder else { return Ok(()) };
        let tables = self.tables.lock();
        let mut files = vec![(&tables.energy, folder.energy()), (&tables.steps, folder.steps())];
        if !self.probes.is_empty() {
            files.insert(0, (&tables.probes, folder.probes()));
        }
        for (table, file) in files {
            table.write_csv(&file)?;
            written.push(file);
        }
        Ok(())
    }
}

impl Observer for Recorder {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError> {
        if self.last_time != Some(moment.time) {
            self.record(moment);
            self.last_time = Some(moment.time);
        }
        if moment.last || self.next_save.is_some_and(|due| moment.time >= due) {
            self.next_save = self.save.next_after(moment.time);
            self.write().map_err(|source| ObserveError {
                what: "writing the tables",
                time: moment.time,
                source: source.into(),
            })?;
        }
        Ok(())
    }
}
