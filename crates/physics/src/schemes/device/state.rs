//! The state of a run on a device.

use std::ops::Range;

use piola_device::{DeviceError, Machine};

use crate::boundaries::BodyForce;
use crate::fields::{FieldDescription, column};
use crate::{Vector, parallel};

/// The column `gravity` of body forces.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Gravity {
    /// The time in s of which it is.
    of: Option<f64>,
}

impl Gravity {
    /// Writes that of a time in s, where it is not there yet.
    pub fn write<const D: usize>(
        &mut self,
        machine: &mut Machine,
        (time, forces): (f64, &[BodyForce<D>]),
        count: usize,
        acceleration: impl Fn(usize) -> Vector<D> + Sync,
    ) -> Result<(), DeviceError> {
        let is_steady = forces.iter().all(BodyForce::is_steady);
        if self.of.is_some_and(|of| is_steady || of == time) {
            return Ok(());
        }
        self.of = Some(time);
        let mut all = vec![Vector::<D>::zeros(); count];
        parallel::for_each_chunk(&mut all, |first, rows| {
            for (a, row) in (first..).zip(rows) {
                *row = acceleration(a);
            }
        });
        let all: Vec<f64> = all.iter().flat_map(|row| row.iter().copied()).collect();
        machine.write("gravity", &all)
    }
}

/// A column of a state on a device.
#[derive(Clone, Debug)]
pub(crate) struct StateColumn {
    /// Its name there.
    pub name: &'static str,
    /// The name of what it was before the last step.
    pub before: &'static str,
    /// Where it stands in a state.
    pub place: Range<usize>,
}

impl StateColumn {
    /// Columns of `count` particles with these names, and names of their copies, among the fields of a formulation.
    ///
    /// # Panics
    /// When one of them is no column of the state: that is a fault of whoever names it.
    pub fn all(
        fields: &'static [FieldDescription],
        [dimension, count]: [usize; 2],
        names: &[[&'static str; 2]],
    ) -> Vec<Self> {
        let of = |&[name, before]: &[&'static str; 2]| {
            let field = fields.iter().find(|field| field.name == name);
            let field = field.expect("these are columns of the formulation");
            Self { name, before, place: column(fields, dimension, count, field) }
        };
        names.iter().map(of).collect()
    }
}

/// The columns of a state on a device, and its tail here, with what both were before the last step.
#[derive(Debug)]
pub(crate) struct StateColumns {
    columns: Vec<StateColumn>,
    /// The end of the state.
    pub tail: Vec<f64>,
    tail_before: Vec<f64>,
}

impl StateColumns {
    /// Columns with a tail of this length.
    pub fn new(columns: Vec<StateColumn>, tail: usize) -> Self {
        Self { columns, tail: vec![0.0; tail], tail_before: vec![0.0; tail] }
    }

    /// Bytes that they take on a device.
    pub fn bytes(columns: &[StateColumn]) -> impl Iterator<Item = (&'static str, usize)> {
        columns.iter().map(|column| (column.name, 2 * size_of::<f64>() * column.place.len()))
    }

    /// Numbers of a state.
    pub fn length(&self) -> usize {
        let ends = self.columns.iter().map(|column| column.place.end);
        ends.max().unwrap_or_default() + self.tail.len()
    }

    /// Makes room for them, behind which there is room for `more(name)` numbers.
    pub fn make(
        &self,
        machine: &mut Machine,
        more: impl Fn(&str) -> usize,
    ) -> Result<(), DeviceError> {
        self.columns.iter().try_for_each(|column| {
            let length = column.place.len() + more(column.name);
            machine.add_zeros(column.name, length)?;
            machine.add_zeros(column.before, length)
        })
    }

    /// Takes a state over.
    pub fn put(&mut self, machine: &mut Machine, state: &[f64]) -> Result<(), DeviceError> {
        let rest = state.len() - self.tail.len();
        self.tail.copy_from_slice(&state[rest..]);
        self.columns
            .iter()
            .try_for_each(|column| machine.write(column.name, &state[column.place.clone()]))
    }

    /// Keeps what a state is before a step.
    pub fn mark(&mut self, machine: &mut Machine) -> Result<(), DeviceError> {
        self.tail_before.copy_from_slice(&self.tail);
        self.columns.iter().try_for_each(|column| machine.copy(column.name, column.before))
    }

    /// Changes the tail, of which the first one is what it was before the step.
    pub fn advance_tail(&mut self, change: impl FnOnce(&[f64], &mut [f64])) {
        change(&self.tail_before, &mut self.tail);
    }

    /// Gives the state.
    pub fn give(&self, machine: &Machine, state: &mut [f64]) -> Result<(), DeviceError> {
        self.give_of(machine, |column| column.name, &self.tail, state)
    }

    /// Gives the state before the last step.
    pub fn give_before(&self, machine: &Machine, state: &mut [f64]) -> Result<(), DeviceError> {
        self.give_of(machine, |column| column.before, &self.tail_before, state)
    }

    fn give_of(
        &self,
        machine: &Machine,
        name: impl Fn(&StateColumn) -> &'static str,
        tail: &[f64],
        state: &mut [f64],
    ) -> Result<(), DeviceError> {
        for column in &self.columns {
            let from = machine.column(name(column));
            machine.device().read(from, &mut state[column.place.clone()])?;
        }
        let rest = state.len() - tail.len();
        state[rest..].copy_from_slice(tail);
        Ok(())
    }
}
