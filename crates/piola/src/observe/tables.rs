//! The tables of a run, and quantities found in them by name.

use crate::output::Table;

/// Everything that is recorded against time. Each table's first column is the time in s.
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    /// Columns `PROBE.FIELD` and `PROBE.FIELD.COMPONENT`.
    pub probes: Table,
    /// Energies, the work of each mechanism so far, and the balance, in J.
    pub energy: Table,
    /// Momentum, the impulse of each way in so far, and the balance.
    pub momentum: Table,
    /// Steps: count, size, and health figures.
    pub steps: Table,
}

/// What a name stands for in the record of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Series {
    /// A column against time.
    Curve {
        /// Times in s, ascending.
        time: Vec<f64>,
        /// The values, as many.
        values: Vec<f64>,
        /// Their unit.
        unit: String,
    },
    /// One number of the run as a whole.
    Number {
        /// The number.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// One text of the run as a whole.
    Text(String),
}

impl Tables {
    /// All tables.
    pub fn all(&self) -> [&Table; 4] {
        [&self.probes, &self.energy, &self.momentum, &self.steps]
    }

    /// All tables, in the order of [`Tables::all`].
    pub fn all_mut(&mut self) -> [&mut Table; 4] {
        [&mut self.probes, &mut self.energy, &mut self.momentum, &mut self.steps]
    }

    /// The column that `name` stands for: `energy.NAME`, `momentum.NAME`, `step.NAME`, or a column
    /// of a probe.
    pub fn curve(&self, name: &str) -> Option<Series> {
        let (table, column) = match name.split_once('.') {
            Some(("energy", column)) => (&self.energy, column),
            Some(("momentum", column)) => (&self.momentum, column),
            Some(("step", column)) => (&self.steps, column),
            _ => (&self.probes, name),
        };
        let unit = table.columns()[table.index(column)?].unit.clone();
        let time = table.column(0).collect();
        Some(Series::Curve { time, values: table.values(column)?, unit })
    }

    /// The names that [`Tables::curve`] knows.
    pub fn names(&self) -> Vec<String> {
        let columns = |table: &Table, prefix: &str| -> Vec<String> {
            let names = table.columns().iter().skip(1);
            names.map(|column| format!("{prefix}{}", column.name)).collect()
        };
        let mut names = columns(&self.probes, "");
        names.extend(columns(&self.energy, "energy."));
        names.extend(columns(&self.momentum, "momentum."));
        names.extend(columns(&self.steps, "step."));
        names
    }
}
