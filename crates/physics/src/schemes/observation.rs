//! A state as those see it who look at its fields.

use std::borrow::Cow;

use super::Scheme;
use crate::fields::{FieldDescription, FieldValues, Snapshot};

/// A formulation at a state of a moment, whose fields can be read. The stages that make derived fields
/// are run when the first field needs them, and once, whoever looks.
pub struct Observation<'a> {
    scheme: &'a mut dyn Scheme,
    time: f64,
    state: &'a [f64],
    /// Stages that have been run.
    stages: usize,
}

impl<'a> Observation<'a> {
    /// Of `state` at `time` in s.
    pub fn new(scheme: &'a mut dyn Scheme, time: f64, state: &'a [f64]) -> Self {
        Self { scheme, time, state, stages: 0 }
    }

    /// The formulation.
    pub fn scheme(&self) -> &dyn Scheme {
        self.scheme
    }

    /// The formulation, to ask it for more than fields: stages are run again after this.
    pub fn scheme_mut(&mut self) -> &mut (dyn Scheme + 'a) {
        self.stages = 0;
        self.scheme
    }

    /// Whether the time is a load factor.
    pub fn is_static(&mut self) -> bool {
        self.scheme.equilibrium().is_some()
    }

    /// Simulated time in s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The state.
    pub fn state(&self) -> &'a [f64] {
        self.state
    }

    /// Appends the components of one of the [`fields`](super::SchemeDescription::fields) for each of
    /// `particles` (indices in memory) to `values`.
    pub fn read(&mut self, field: &FieldDescription, particles: &[u32], values: &mut Vec<f64>) {
        while self.stages < field.stages() {
            self.stages += 1;
            self.scheme.observe(self.stages, self.time, self.state);
        }
        let column = self.scheme.column(field);
        if column.is_empty() {
            return self.scheme.derive(self.state, field, particles, values);
        }
        field.read(&self.state[column], self.scheme.dimension(), particles, values);
    }

    /// Those of some particles (indices in memory) that are there, as parts of the body that they are of at the start.
    pub fn present<'p>(&self, particles: &'p [u32]) -> Cow<'p, [u32]> {
        if self.scheme.is_closed() {
            return Cow::Borrowed(particles);
        }
        let bodies = self.scheme.bodies();
        let is_there =
            |a: &u32| self.scheme.body_of(self.state, *a as usize) == Some(bodies[*a as usize]);
        Cow::Owned(particles.iter().copied().filter(is_there).collect())
    }

    /// The components of the field called `name` for each of `particles`, nothing of a name that the
    /// formulation does not have.
    pub fn values(&mut self, name: &str, particles: &[u32]) -> Vec<f64> {
        let mut values = Vec::new();
        if let Some(field) = self.scheme.description().field(name) {
            self.read(field, particles, &mut values);
        }
        values
    }

    /// Positions and the named fields of all particles, after `step` steps; names that the
    /// formulation does not have are left out.
    pub fn snapshot(&mut self, step: u64, names: &[&str]) -> Snapshot {
        let all = 0..self.scheme.particle_count() as u32;
        let (scheme, state) = (&*self.scheme, self.state);
        let body = |a: &u32| scheme.body_of(state, *a as usize);
        let particles: Vec<u32> = all.filter(|a| body(a).is_some()).collect();
        let bodies = particles.iter().filter_map(body).collect();
        let ids = scheme.ids_of(state, &particles);
        let widths = particles.iter().map(|&a| scheme.width_of(a as usize)).collect();
        let fields = self.scheme.description().fields.iter();
        let fields = fields.filter(|field| names.contains(&field.name)).map(|field| {
            let mut values = Vec::new();
            self.read(field, &particles, &mut values);
            FieldValues { description: *field, values }
        });
        let fields = fields.collect();
        Snapshot {
            dimension: self.scheme.dimension(),
            time: self.time,
            step,
            positions: self.values("position", &particles),
            ids,
            bodies,
            widths,
            fields,
        }
    }
}
