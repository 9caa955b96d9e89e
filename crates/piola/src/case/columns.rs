//! The columns of a session: their descriptions, their current values, and which can be set.

use thiserror::Error;

use super::session::Session;
use super::suggest::one_of;
use crate::fields::{FieldDescription, FieldValues, component_name};

/// A column that cannot be read or set.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ColumnError {
    /// The formulation has no column of this name.
    #[error("the scheme `{scheme}` has no field `{name}`; expected {known}")]
    Unknown {
        /// The name.
        name: String,
        /// Name of the scheme.
        scheme: &'static str,
        /// Those that it has.
        known: String,
    },
    /// It follows from others, or others would have to follow it.
    #[error(
        "the field `{name}` cannot be set; {} can be set",
        if settable.is_empty() {
            "no field of this scheme".to_owned()
        } else {
            format!("only {}", one_of(settable.iter().copied()))
        }
    )]
    NotSettable {
        /// The name.
        name: &'static str,
        /// Those that can be, of all particles that were asked for.
        settable: Vec<&'static str>,
    },
    /// Too few numbers, or too many.
    #[error("the field `{name}` has {expected} numbers, not {got}")]
    Length {
        /// The name.
        name: &'static str,
        /// How many values it has.
        expected: usize,
        /// How many values were given.
        got: usize,
    },
    /// A value that is not finite.
    #[error(
        "the value for particle {particle}{} of the field `{name}` is {value}",
        if component.is_empty() { String::new() } else { format!(", component {component},") }
    )]
    NotFinite {
        /// The name.
        name: &'static str,
        /// Which of the particles, counted from 0 in the order of the column.
        particle: usize,
        /// Which of its components; empty for scalars.
        component: String,
        /// The value.
        value: f64,
    },
}

impl Session {
    /// Number of each particle in the order of creation, in the order of all columns. Particles that wait in a reserve, and
    /// those that were born from it, have the number of another one: see [`Session::ids_of`].
    pub fn ids(&self) -> &[u32] {
        self.executor.scheme.ids()
    }

    /// The ids, as in files, of the particles of [`Session::particles_of`].
    pub fn ids_of(&mut self, body: Option<usize>) -> Vec<u32> {
        let particles = self.rows(body).list();
        let now = self.executor.now();
        now.scheme().ids_of(now.state(), &particles)
    }

    /// The columns that [`Session::column`] knows.
    pub fn columns(&self) -> &'static [FieldDescription] {
        self.executor.scheme.description().fields
    }

    /// The current values of a column, particle by particle.
    ///
    /// # Errors
    /// [`ColumnError::Unknown`].
    pub fn column(&mut self, name: &str) -> Result<FieldValues, ColumnError> {
        let (description, mut values) = (self.described(name)?, Vec::new());
        let particles: Vec<u32> = (0..self.ids().len() as u32).collect();
        self.executor.now().read(description, &particles, &mut values);
        Ok(FieldValues { description: *description, values })
    }

    /// The particles present that belong to the body with this number in the case, or to any body, in the order of
    /// all columns.
    pub fn particles_of(&mut self, body: Option<usize>) -> Vec<usize> {
        self.rows(body).list().into_iter().map(|particle| particle as usize).collect()
    }

    /// The current energies in J, by name; the last is their sum, `total`.
    pub fn energies(&mut self) -> Vec<(&'static str, f64)> {
        let now = self.executor.now();
        let names = now.scheme().description().energies;
        let mut energies = vec![0.0; names.len()];
        now.scheme().energies(now.state(), &mut energies);
        let total = energies.iter().sum();
        names.iter().copied().zip(energies).chain([("total", total)]).collect()
    }

    /// Sets the values of a column, particle by particle, before the first step or between two steps. Accelerations
    /// are updated, and prescribed values stay as they are. The energy and momentum that this adds to a run that has
    /// begun are in no ledger: the balances are off by them from then on. Setting the values that a column already
    /// has changes nothing.
    ///
    /// # Errors
    /// There is no such column, it cannot be set, or the values are too few, too many or not finite;
    /// then nothing is changed.
    pub fn set(&mut self, name: &str, values: &[f64]) -> Result<(), ColumnError> {
        let all: Vec<usize> = (0..self.ids().len()).collect();
        self.put(name, &all, values)
    }

    /// The same for the particles of [`Session::particles_of`], in their order. Of a fluid with solids in it each system has
    /// fields of its own that can be set.
    ///
    /// # Errors
    /// As [`Session::set`].
    pub fn set_of(
        &mut self,
        name: &str,
        body: Option<usize>,
        values: &[f64],
    ) -> Result<(), ColumnError> {
        let particles = self.particles_of(body);
        self.put(name, &particles, values)
    }

    fn put(&mut self, name: &str, particles: &[usize], values: &[f64]) -> Result<(), ColumnError> {
        let field = self.described(name)?;
        let (name, scheme) = (field.name, self.executor.scheme.as_ref());
        let place = |&particle: &usize| {
            let stretch = scheme.stretch(field, &(particle..particle + 1));
            stretch.filter(|_| scheme.settable(particle).contains(&name))
        };
        let of_all = || {
            let mut settable =
                particles.first().map_or(&[][..], |&first| scheme.settable(first)).to_vec();
            settable.retain(|name| particles.iter().all(|&it| scheme.settable(it).contains(name)));
            ColumnError::NotSettable { name, settable }
        };
        let places: Option<Vec<_>> = particles.iter().map(place).collect();
        let places = places.ok_or_else(of_all)?;
        let components = field.kind.components(self.case.dimension);
        let (expected, got) = (components * places.len(), values.len());
        if got != expected {
            return Err(ColumnError::Length { name, expected, got });
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let dimension = self.case.dimension;
            let component = component_name(field.kind, index % components, dimension);
            let particle = index / components;
            return Err(ColumnError::NotFinite { name, particle, component, value: values[index] });
        }
        let state = self.executor.state();
        let rows = || places.iter().cloned().zip(values.chunks_exact(components));
        if rows().any(|(place, row)| state[place] != *row) {
            self.executor
                .change(|state| rows().for_each(|(place, row)| state[place].copy_from_slice(row)));
        }
        Ok(())
    }

    pub(super) fn described(&self, name: &str) -> Result<&'static FieldDescription, ColumnError> {
        let scheme = self.executor.scheme.description();
        scheme.field(name).ok_or_else(|| ColumnError::Unknown {
            name: name.to_owned(),
            scheme: scheme.name,
            known: one_of(scheme.shown().map(|column| column.name)),
        })
    }
}
