//! The observer that fills the tables.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};

use super::files::WrittenFiles;
use super::memory::{decode, encode};
use super::probe::Probe;
use super::tables::Tables;
use crate::output::{Column, OutputError, ResultsFolder, Table};
use crate::schemes::{Ledger, MomentumComponent, Scheme, momentum_components};
use crate::time::{Misfit, Moment, ObserveError, Observer, Schedule};

/// Tables that the recorder fills and the owner of the run reads when it has ended.
#[derive(Clone)]
pub struct SharedTables(Arc<Mutex<Tables>>);

impl SharedTables {
    /// The tables. A thread that panicked while it held them left whole rows.
    pub fn lock(&self) -> MutexGuard<'_, Tables> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Names and units of the columns of the table of steps, after the time and before the figures of
/// the scheme.
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

/// Names and units of the columns of the momentum table, after the time: the components of
/// momentum, the impulse so far of each source of momentum, and what momentum has gained beyond these impulses, which
/// by theory (19) is the error of the integrator.
pub fn momentum_columns(
    components: &[MomentumComponent],
    impulses: &[&'static str],
) -> Vec<(String, &'static str)> {
    let plain = components.iter().map(|component| (component.name.to_owned(), component.unit));
    let of = |part: &'static str| {
        let named = move |it: &MomentumComponent| (format!("{part}.{}", it.name), it.unit);
        components.iter().map(named)
    };
    let impulses = impulses.iter().copied().chain(["balance"]);
    plain.chain(impulses.flat_map(of)).collect()
}

/// Records probes, energies, momentum and steps at every due time, and keeps the CSV files up to date.
pub struct Recorder {
    schedule: Schedule,
    /// Times at which the CSV files are written anew.
    save: Schedule,
    folder: Option<(ResultsFolder, WrittenFiles)>,
    probes: Vec<Probe>,
    tables: SharedTables,
    /// Components of momentum.
    components: usize,
    memory: Memory,
    row: Vec<f64>,
    scratch: Vec<f64>,
}

/// What a recorder has to remember, beside its tables.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Memory {
    next_save: Option<f64>,
    /// Energy at the start in J, and momentum.
    start: Option<(f64, Vec<f64>)>,
    last_time: Option<f64>,
}

impl Recorder {
    /// A recorder of `probes` and of what `scheme` reports, with rows at `schedule`. With a folder it writes the CSV
    /// files at `save` and at the end, and records them in the list of files.
    pub fn new(
        scheme: &dyn Scheme,
        probes: Vec<Probe>,
        schedule: Schedule,
        save: Schedule,
        folder: Option<(ResultsFolder, WrittenFiles)>,
    ) -> Self {
        let tables = Self::columns(scheme, &probes);
        Self {
            components: momentum_components(scheme.dimension()).len(),
            memory: Memory { next_save: save.next_after(0.0), ..Memory::default() },
            schedule,
            save,
            folder,
            probes,
            tables: SharedTables(Arc::new(Mutex::new(tables))),
            row: Vec::new(),
            scratch: Vec::new(),
        }
    }

    /// The tables that a recorder of `probes` fills, without rows.
    pub fn columns(scheme: &dyn Scheme, probes: &[Probe]) -> Tables {
        let time = || Column::new("time", "s");
        let description = scheme.description();
        let mut probe_columns = vec![time()];
        probe_columns.extend(probes.iter().flat_map(|probe| probe.columns(scheme.dimension())));
        let energy_names = energy_columns(description.energies, description.ledger.mechanisms);
        let energy_columns = energy_names.into_iter().map(|name| Column::new(name, "J"));
        let energy = std::iter::once(time()).chain(energy_columns).collect();
        let components = momentum_components(scheme.dimension());
        let momentum_columns = momentum_columns(components, description.ledger.impulses);
        let momentum_columns =
            momentum_columns.into_iter().map(|(name, unit)| Column::new(name, unit));
        let momentum = std::iter::once(time()).chain(momentum_columns).collect();
        let step_columns = STEP_COLUMNS.iter().chain(description.figures);
        let step_columns = step_columns.map(|&(name, unit)| Column::new(name, unit));
        let steps = std::iter::once(time()).chain(step_columns).collect();
        Tables {
            probes: Table::new(probe_columns),
            energy: Table::new(energy),
            momentum: Table::new(momentum),
            steps: Table::new(steps),
            profiles: Vec::new(),
            over_time: Vec::new(),
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
        row.push(moment.now.time());
        for probe in &self.probes {
            probe.record(moment.now, &mut self.scratch, row);
        }
        tables.probes.push_row(row).expect(complete);

        let (scheme, state) = (moment.now.scheme(), moment.now.state());
        let ledger = Ledger::of(scheme, state);
        let energies = scheme.description().energies.len();
        row.clear();
        row.resize(1 + energies, 0.0);
        row[0] = moment.now.time();
        scheme.energies(state, &mut row[1..]);
        let total: f64 = row[1..].iter().sum();
        let components = self.components;
        let mut momentum = vec![0.0; components];
        scheme.momentum(state, &mut momentum);
        let (energy_start, momentum_start) =
            self.memory.start.get_or_insert_with(|| (total, momentum.clone()));
        row.push(total);
        row.extend_from_slice(ledger.work);
        row.push(total - *energy_start - ledger.work.iter().sum::<f64>());
        tables.energy.push_row(row).expect(complete);

        row.clear();
        row.push(moment.now.time());
        row.extend_from_slice(&momentum);
        row.extend_from_slice(ledger.impulses);
        row.extend((0..components).map(|component| {
            let entered = ledger.impulses.iter().skip(component).step_by(components);
            momentum[component] - momentum_start[component] - entered.sum::<f64>()
        }));
        tables.momentum.push_row(row).expect(complete);

        row.clear();
        let health = moment.health;
        row.extend([
            moment.now.time(),
            moment.step as f64,
            moment.step_size,
            health.smallest_ratio,
            health.ratio_mismatch,
            health.largest_speed,
        ]);
        scheme.figures(state, row);
        tables.steps.push_row(row).expect(complete);
    }

    fn write(&self) -> Result<(), OutputError> {
        let Some((folder, written)) = &self.folder else { return Ok(()) };
        let tables = self.tables.lock();
        let mut files = vec![
            (&tables.energy, folder.energy()),
            (&tables.momentum, folder.momentum()),
            (&tables.steps, folder.steps()),
        ];
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
        if self.memory.last_time != Some(moment.now.time()) {
            self.record(moment);
            self.memory.last_time = Some(moment.now.time());
        }
        if moment.last || self.memory.next_save.is_some_and(|due| moment.now.time() >= due) {
            self.memory.next_save = self.save.next_after(moment.now.time());
            self.write().map_err(|source| ObserveError {
                what: "writing the tables",
                time: moment.now.time(),
                source: source.into(),
            })?;
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        let tables = self.tables.lock();
        encode(&(&self.memory, tables.all().map(Table::numbers)))
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Misfit> {
        let (memory, numbers): (Memory, [Vec<f64>; 4]) = decode(saved, "the tables")?;
        let mut tables = self.tables.lock();
        let known = memory.start.as_ref().map_or(self.components, |(_, momentum)| momentum.len());
        if known != self.components {
            return Err(Misfit("its momentum is of another dimension".into()));
        }
        for (table, numbers) in tables.all_mut().into_iter().zip(numbers) {
            let other = |columns| Misfit(format!("a table has {columns} columns, and not in it"));
            table.set_numbers(numbers).map_err(other)?;
        }
        drop(tables);
        self.memory = memory;
        Ok(())
    }

    fn rewind(&mut self, time: f64) -> Result<(), ObserveError> {
        self.tables.lock().all_mut().into_iter().for_each(|table| table.truncate_after(time));
        self.memory.last_time = self.tables.lock().energy.column(0).next_back();
        self.memory.next_save = self.save.next_after(time);
        Ok(())
    }
}
