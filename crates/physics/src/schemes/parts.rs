//! Several systems one after another in one state, and their particles in one row.

use std::ops::Range;

use super::{Health, Scheme};
use crate::fields::FieldDescription;

/// Where a system stands in the state and among the particles of all.
#[derive(Clone)]
pub(super) struct Part {
    /// Its part of a state.
    pub state: Range<usize>,
    /// Its particles that are shown, by index in its memory, and the index of the first of them in the run.
    pub shown: Vec<u32>,
    pub first: usize,
    /// The index in the run of each of its particles; of one that is not shown that of the first one of its system, or
    /// of who stands for it.
    pub index: Vec<u32>,
}

/// Systems one after another.
#[derive(Clone, Default)]
pub(super) struct Parts {
    /// Each of them.
    pub all: Vec<Part>,
    /// Body and number in the order of creation of all particles that are shown.
    pub bodies: Vec<u32>,
    pub ids: Vec<u32>,
}

impl Parts {
    /// Appends a system with its particles that are shown, of which `body` says what the bodies are called in the run, and its
    /// state at the start to that of all.
    pub fn push(
        &mut self,
        system: &dyn Scheme,
        shown: Vec<u32>,
        body: impl Fn(u32) -> u32,
        start: &mut Vec<f64>,
    ) {
        let first = self.bodies.len();
        let mut index = vec![first as u32; system.particle_count()];
        (first as u32..).zip(&shown).for_each(|(own, &a)| index[a as usize] = own);
        self.bodies.extend(shown.iter().map(|&a| body(system.bodies()[a as usize])));
        let before = self.ids.iter().max().map_or(0, |last| last + 1);
        self.ids.extend(shown.iter().map(|&a| before + system.ids()[a as usize]));
        let from = start.len();
        start.extend(system.initial_state());
        self.all.push(Part { state: from..start.len(), shown, first, index });
    }

    /// The same in a state in which the first system has `fewer` numbers.
    pub fn without(&self, fewer: usize) -> Self {
        let mut parts = self.clone();
        for (k, Part { state, .. }) in parts.all.iter_mut().enumerate() {
            let start = if k > 0 { state.start - fewer } else { 0 };
            *state = start..state.end - fewer;
        }
        parts
    }

    /// The system of a particle (index in the run), and its index there.
    pub fn local(&self, index: usize) -> (usize, usize) {
        let system = self.all.partition_point(|part| part.first <= index) - 1;
        let part = &self.all[system];
        (system, part.shown[index - part.first] as usize)
    }

    /// The index in the run of a particle of a system, if it is shown.
    pub fn index_of(&self, system: usize, particle: u32) -> Option<u32> {
        let part = self.all.get(system)?;
        part.shown.binary_search(&particle).ok().map(|number| (part.first + number) as u32)
    }

    /// The system and the indices there of particles of the run that follow each other, if they do so in one system.
    pub fn run_of(&self, particles: &Range<usize>) -> Option<(usize, Range<usize>)> {
        let last = particles.end.checked_sub(1).filter(|last| *last < self.bodies.len())?;
        let [(system, first), (other, last)] = [particles.start, last].map(|a| self.local(a));
        let is_whole = system == other && last.checked_sub(first)? + 1 == particles.len();
        is_whole.then_some((system, first..last + 1))
    }

    /// The index in the run of a particle of a system, or of who stands for it.
    pub fn named(&self, system: usize, particle: usize) -> usize {
        self.all[system].index[particle] as usize
    }

    /// Where the last system ends in a state.
    pub fn end(&self) -> usize {
        self.all.last().map_or(0, |part| part.state.end)
    }
}

/// Health of a system by the index of particles in the run.
pub(super) fn rename(health: Health, index: &dyn Fn(usize) -> usize) -> Health {
    Health {
        largest_speed_particle: index(health.largest_speed_particle),
        smallest_ratio_particle: index(health.smallest_ratio_particle),
        first_not_finite: health.first_not_finite.map(index),
        first_escaped: health.first_escaped.map(index),
        ..health
    }
}

/// The field of one system that a field of all stands for.
pub(super) fn own_field(system: &dyn Scheme, field: &FieldDescription) -> Option<FieldDescription> {
    system.description().field(field.name).filter(|own| own.kind == field.kind).copied()
}
