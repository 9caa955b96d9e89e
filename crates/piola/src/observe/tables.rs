//! The tables of a run, and quantities found in them by name.

use crate::output::{Column, Table};

/// Everything that is recorded. The first column is the time in s, in profiles the distance in m.
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    /// Columns `PROBE.FIELD` and `PROBE.FIELD.COMPONENT`.
    pub probes: Table,
    /// Energies, the work of each mechanism so far, and the balance, in J.
    pub energy: Table,
    /// Momentum, the impulse of each source of momentum so far, and the balance.
    pub momentum: Table,
    /// Steps: count, size, and health figures.
    pub steps: Table,
    /// The last profile along each line: distance from its start, position, and the fields.
    pub profiles: Vec<Table>,
    /// Columns of lines at all times.
    pub over_time: Vec<SpaceTime>,
}

/// A column of a line at all times at which it was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceTime {
    /// Name and unit of the column.
    pub column: Column,
    /// Distances from the start of the line in m, ascending.
    pub distances: Vec<f64>,
    /// Times in s, ascending.
    pub times: Vec<f64>,
    /// The values, one row of all points for each time.
    pub values: Vec<f64>,
}

/// What a name stands for in the record of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Series {
    /// A column against time, or along a line.
    Curve {
        /// What it is against: the time in s, or the distance from the start of the line in m.
        against: Column,
        /// Its values, ascending.
        abscissa: Vec<f64>,
        /// The values, equally many.
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
    /// All tables against time.
    pub fn all(&self) -> [&Table; 4] {
        [&self.probes, &self.energy, &self.momentum, &self.steps]
    }

    /// All tables, in the order of [`Tables::all`].
    pub fn all_mut(&mut self) -> [&mut Table; 4] {
        [&mut self.probes, &mut self.energy, &mut self.momentum, &mut self.steps]
    }

    /// The column that `name` stands for: `energy.NAME`, `momentum.NAME`, `step.NAME`, or a column
    /// of a probe, against time or along its line.
    pub fn curve(&self, name: &str) -> Option<Series> {
        let (table, column) = match name.split_once('.') {
            Some(("energy", column)) => (&self.energy, column),
            Some(("momentum", column)) => (&self.momentum, column),
            Some(("step", column)) => (&self.steps, column),
            _ => {
                let profile = self.profiles.iter().find(|table| table.index(name).is_some());
                (profile.unwrap_or(&self.probes), name)
            }
        };
        let unit = table.columns()[table.index(column)?].unit.clone();
        let against = table.columns()[0].clone();
        let abscissa = table.column(0).collect();
        Some(Series::Curve { against, abscissa, values: table.values(column)?, unit })
    }

    /// The names that [`Tables::curve`] knows.
    pub fn names(&self) -> Vec<String> {
        let columns = |table: &Table, prefix: &str| -> Vec<String> {
            let names = table.columns().iter().skip(1);
            names.map(|column| format!("{prefix}{}", column.name)).collect()
        };
        let mut names = columns(&self.probes, "");
        // Places of a line have no point in their names.
        let profiles = self.profiles.iter().flat_map(|table| columns(table, ""));
        names.extend(profiles.filter(|name| name.contains('.')));
        names.extend(columns(&self.energy, "energy."));
        names.extend(columns(&self.momentum, "momentum."));
        names.extend(columns(&self.steps, "step."));
        names
    }
}
