//! The observer that fills the tables.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::probe::Probe;
use super::tables::Tables;
use crate::output::OutputError;
use crate::output::{Column, Table};
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

/// Records probes, energies and steps at every due time, and keeps the CSV files up to date.
pub struct Recorder {
    schedule: Schedule,
    /// Times at which the CSV files are written anew.
    save: Schedule,
    next_save: Option<f64>,
    files: Option<[PathBuf; 3]>,
    probes: Vec<Probe>,
    tables: SharedTables,
    start: Option<f64>,
    last_time: Option<f64>,
    row: Vec<f64>,
    scratch: Vec<f64>,
}

impl Recorder {
    /// A recorder of `probes` and of what `scheme` reports, with rows at `schedule`. With `files`
    /// for probes, energies and steps it writes them at `save` and at the end.
    pub fn new(
        scheme: &dyn Scheme,
        probes: Vec<Probe>,
        schedule: Schedule,
        save: Schedule,
        files: Option<[PathBuf; 3]>,
    ) -> Self {
        let time = || Column::new("time", "s");
        let mut probe_columns = vec![time()];
        probe_columns.extend(probes.iter().flat_map(|probe| probe.columns(scheme.dimension())));
        let energy_names = scheme.energy_names().iter().chain(&["total"]);
        let energy_names = energy_names.chain(scheme.mechanisms()).chain(&["balance"]);
        let energy = std::iter::once(time())
            .chain(energy_names.map(|&name| Column::new(name, "J")))
            .collect();
        let steps = vec![
            time(),
            Column::new("count", "1"),
            Column::new("size", "s"),
            Column::new("smallest_ratio", "1"),
            Column::new("ratio_mismatch", "1"),
            Column::new("largest_speed", "m/s"),
        ];
        let tables = Tables {
            probes: Table::new(probe_columns),
            energy: Table::new(energy),
            steps: Table::new(steps),
        };
        Self {
            next_save: save.next_after(0.0),
            schedule,
            save,
            files,
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
        let Some([probes, energy, steps]) = &self.files else { return Ok(()) };
        let tables = self.tables.lock();
        if !self.probes.is_empty() {
            tables.probes.write_csv(probes)?;
        }
        tables.energy.write_csv(energy)?;
        tables.steps.write_csv(steps)?;
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
