//! The last steps of a run: where it can go back to, and what a failure looked like coming.

use serde::{Deserialize, Serialize};

use super::clock::{Clock, Tally};
use super::integrator::Integrator;
use crate::fields::{FieldDescription, component_name};
use crate::schemes::{Observation, Scheme};

/// A run at one instant in memory.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Mark {
    pub clock: Clock,
    pub tally: Tally,
    pub due: Vec<Option<f64>>,
    pub state: Vec<f64>,
}

/// Marks at multiples of a number of steps, the last two of them, and the steps since the older
/// one. Integrators are deterministic, so the states between are found again by taking the same
/// steps: nothing but two copies is kept of states that are almost never wanted.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct History {
    older: Mark,
    newer: Mark,
    /// Time and size of each step since the older mark.
    steps: Vec<(f64, f64)>,
}

impl Mark {
    /// The instant of a run.
    pub fn of(clock: &Clock, tally: &Tally, due: &[Option<f64>], state: &[f64]) -> Self {
        let (clock, tally) = (*clock, tally.clone());
        Self { clock, tally, due: due.to_vec(), state: state.to_vec() }
    }

    /// Takes a run back to this instant. What the time since then took, the retries and the warnings are
    /// not forgotten.
    pub fn restore(
        &self,
        clock: &mut Clock,
        tally: &mut Tally,
        due: &mut [Option<f64>],
        state: &mut [f64],
    ) {
        let (watches, warned) = (tally.watches, tally.warned);
        let retries = std::mem::take(&mut tally.retries);
        let warnings = std::mem::take(&mut tally.warnings);
        *clock = self.clock;
        *tally = Tally { watches, retries, warnings, warned, ..self.tally.clone() };
        due.copy_from_slice(&self.due);
        state.copy_from_slice(&self.state);
    }

    fn set(&mut self, clock: &Clock, tally: &Tally, due: &[Option<f64>], state: &[f64]) {
        self.clock = *clock;
        self.tally.clone_from(tally);
        self.due.copy_from_slice(due);
        self.state.copy_from_slice(state);
    }
}

impl History {
    /// Steps between marks.
    const INTERVAL: u64 = 16;

    /// A history that starts at `mark`.
    pub fn new(mark: Mark) -> Self {
        // Up to two intervals of steps are kept: from here on nothing is allocated.
        let steps = Vec::with_capacity(2 * Self::INTERVAL as usize);
        Self { older: mark.clone(), newer: mark, steps }
    }

    /// Whether it is time for a mark.
    pub fn is_due(&self, clock: &Clock) -> bool {
        clock.step.is_multiple_of(Self::INTERVAL) && clock.step != self.newer.clock.step
    }

    /// The last mark.
    pub fn last(&self) -> &Mark {
        &self.newer
    }

    /// Takes a mark if it is time for one.
    pub fn mark(&mut self, clock: &Clock, tally: &Tally, due: &[Option<f64>], state: &[f64]) {
        if !self.is_due(clock) {
            return;
        }
        std::mem::swap(&mut self.older, &mut self.newer);
        self.newer.set(clock, tally, due, state);
        let kept = clock.step.saturating_sub(self.older.clock.step) as usize;
        self.steps.drain(..self.steps.len().saturating_sub(kept));
    }

    /// Notes a step.
    pub fn step(&mut self, time: f64, size: f64) {
        self.steps.push((time, size));
    }

    /// Forgets the last step.
    pub fn take_back(&mut self) {
        self.steps.pop();
    }

    /// All states in it.
    pub fn states(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        [&mut self.older, &mut self.newer].into_iter().map(|mark| &mut mark.state)
    }

    /// The mark to go back to, which becomes the only one.
    pub fn go_back(&mut self) -> &Mark {
        self.steps.clear();
        let Mark { clock, tally, due, state } = &self.older;
        self.newer.set(clock, tally, due, state);
        &self.older
    }

    /// Takes note of another output, which is due at this time.
    pub fn add_output(&mut self, due: Option<f64>) {
        [&mut self.older, &mut self.newer].into_iter().for_each(|mark| mark.due.push(due));
    }

    /// Forgets all outputs.
    pub fn remove_outputs(&mut self) {
        [&mut self.older, &mut self.newer].into_iter().for_each(|mark| mark.due.clear());
    }

    /// Lengths of all states in it.
    pub fn lengths(&self) -> impl Iterator<Item = usize> + '_ {
        [&self.older, &self.newer].into_iter().map(|mark| mark.state.len())
    }

    /// Steps taken at its marks.
    pub fn mark_steps(&self) -> impl Iterator<Item = u64> + '_ {
        [&self.older, &self.newer].into_iter().map(|mark| mark.clock.step)
    }

    /// Numbers of outputs that its marks know.
    pub fn outputs(&self) -> impl Iterator<Item = usize> + '_ {
        [&self.older, &self.newer].into_iter().map(|mark| mark.due.len())
    }

    /// Takes the steps since the older mark once more and writes down what `particle` (index in
    /// memory) and its neighbours did in the last of them.
    pub fn trace(
        &self,
        scheme: &mut dyn Scheme,
        integrator: &mut dyn Integrator,
        particle: usize,
    ) -> Trace {
        let mut trace = Trace::new(scheme, particle);
        let mut state = self.older.state.clone();
        let mut next = state.clone();
        let first = self.older.clock.step;
        let shown = self.steps.len().saturating_sub(Trace::STEPS);
        let mut limits = Vec::new();
        for (count, &(time, size)) in self.steps.iter().enumerate() {
            // What a step does may follow from the look before it.
            scheme.inspect(&state, &mut limits);
            if integrator.step(scheme, time, size, &state, &mut next).is_err() {
                break;
            }
            std::mem::swap(&mut state, &mut next);
            if count >= shown {
                trace.record(scheme, first + count as u64 + 1, time + size, size, &state);
            }
        }
        if self.steps.is_empty() {
            trace.record(scheme, first, self.older.clock.time, 0.0, &state);
        }
        trace
    }
}

/// What the first bad particle and its neighbours did in the last steps: a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Name and unit of each column: step, time, size of the step, number of the particle, whether
    /// it is the bad one, and every component of every field.
    pub columns: Vec<(String, &'static str)>,
    /// The numbers row by row, a row for each step and particle.
    pub numbers: Vec<f64>,
    bad: u32,
    particles: Vec<u32>,
}

impl Trace {
    /// Steps that it shows at most.
    pub const STEPS: usize = 12;

    fn new(scheme: &dyn Scheme, particle: usize) -> Self {
        let bad = particle as u32;
        let mut particles = vec![bad];
        let neighbors = scheme.neighborhood(particle);
        particles.extend(neighbors.into_iter().filter(|&neighbor| neighbor != bad));
        let head = [("step", "1"), ("time", "s"), ("step_size", "s"), ("particle", "1")];
        let head = head.into_iter().chain([("is_bad", "1")]);
        let mut columns: Vec<_> = head.map(|(name, unit)| (name.to_owned(), unit)).collect();
        let dimension = scheme.dimension();
        for field in scheme.description().shown() {
            columns.extend((0..field.kind.components(dimension)).map(|number| {
                let component = component_name(field.kind, number, dimension);
                let dot = if component.is_empty() { "" } else { "." };
                (format!("{}{dot}{component}", field.name), field.unit)
            }));
        }
        Self { columns, numbers: Vec::new(), bad, particles }
    }

    fn record(&mut self, scheme: &mut dyn Scheme, step: u64, time: f64, size: f64, state: &[f64]) {
        let dimension = scheme.dimension();
        let shown = scheme.description().shown();
        let mut observation = Observation::new(scheme, time, state);
        let mut read = |field: &FieldDescription| {
            let mut values = Vec::new();
            observation.read(field, &self.particles, &mut values);
            (field.kind.components(dimension), values)
        };
        let fields: Vec<(usize, Vec<f64>)> = shown.map(&mut read).collect();
        let ids = scheme.ids_of(state, &self.particles);
        for (row, (&particle, id)) in self.particles.iter().zip(ids).enumerate() {
            let is_bad = f64::from(u8::from(particle == self.bad));
            self.numbers.extend([step as f64, time, size, f64::from(id), is_bad]);
            for (components, values) in &fields {
                self.numbers.extend_from_slice(&values[row * components..][..*components]);
            }
        }
    }
}
