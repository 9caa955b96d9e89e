//! The transport-velocity formulation as integrators, clock and output see it.

use std::ops::Range;

use piola_device::{Device, Language};

use super::fields::Made;
use super::{Continuum, TransportVelocity};
use crate::fields::{FieldDescription, column};
use crate::parallel::Team;
use crate::schemes::ledger::Totals;
use crate::schemes::momentum::of_particles;
use crate::schemes::{
    DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Escape, Health, Part, Particle, Passage,
    Phase, RankRefusal, RankShare, Scheme, SchemeDescription, SplitScheme, StepLimit,
};

impl<const D: usize, M: Continuum<D>> Scheme for TransportVelocity<D, M> {
    fn description(&self) -> &'static SchemeDescription {
        M::DESCRIPTION
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.common.count()
    }

    #[inline(never)]
    fn initial_state(&self) -> Vec<f64> {
        self.start.clone()
    }

    /// None: it is moved by kicks and drifts alone.
    #[inline(never)]
    fn rates(&mut self, _time: f64, _state: &[f64], rate: &mut [f64]) {
        rate.fill(0.0);
    }

    #[inline(never)]
    fn constrain(&self, time: f64, state: &mut [f64]) {
        let common = &self.common;
        let mut totals = Totals::default();
        totals.book(M::WALLS, &self.matter.prescribe(common, time, state));
        M::DESCRIPTION.ledger.add(D, &totals, self.tail(state));
        let (own, _) = common.parts(state);
        for entry in common.motion.iter() {
            if let Some(row) = common.row(common.walls[entry.particle].number as usize) {
                own.velocity[row][entry.component] = entry.at(time);
            }
        }
    }

    #[inline(never)]
    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.look(state, limits)
    }

    #[inline(never)]
    fn escape(&self, index: usize, state: &[f64]) -> Option<Escape> {
        self.common.escape_of(index, state)
    }

    fn missing(&self, state: &[f64]) -> u64 {
        self.matter.missing(&self.common, state)
    }

    #[inline(never)]
    fn taken_over(&self, fewer: &dyn Scheme, state: &[f64]) -> Vec<f64> {
        let (before, now) = (fewer.particle_count(), self.particle_count());
        let fields = M::DESCRIPTION.fields;
        let mut taken = self.start.clone();
        for field in fields {
            let own = column(fields, D, before, field);
            let first = column(fields, D, now, field).start;
            taken[first..first + own.len()].copy_from_slice(&state[own]);
        }
        let width = self.width();
        taken[now * width..].copy_from_slice(&state[before * width..]);
        self.matter.add_waiting(&self.common, now - before, &mut taken);
        taken
    }

    #[inline(never)]
    fn figures(&self, state: &[f64], figures: &mut Vec<f64>) {
        let tail = &state[self.particle_count() * self.width()..];
        let waiting = self.matter.waiting(&self.common, state);
        figures.extend([
            M::DESCRIPTION.ledger.behind(D, tail)[0],
            self.common.removed_count(state) - waiting,
        ]);
        self.matter.figures(&self.common, state, figures);
    }

    fn passed(&self, state: &[f64], body: u32) -> Option<Passage> {
        self.matter.passed(&self.common, state, body)
    }

    #[inline(never)]
    fn energies(&self, state: &[f64], energies: &mut [f64]) {
        energies[0] = self.common.kinetic_energy(state);
        self.matter.energies(&self.common, state, &mut energies[1..]);
    }

    #[inline(never)]
    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let common = &self.common;
        let at = common.columns(state);
        let of = |number: usize| {
            let mass = if common.is_wall[number] { 0.0 } else { common.mass[number] };
            [at.position[number], at.velocity[number] * mass]
        };
        of_particles(common.particles.len(), of, momentum);
    }

    #[inline(never)]
    fn observe(&mut self, stage: usize, time: f64, state: &[f64]) {
        self.make_fields(stage, time, state);
    }

    #[inline(never)]
    fn derive(
        &self,
        state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let (common, matter) = (&self.common, &self.matter);
        let at = common.columns(state);
        let numbers = particles.iter().map(|&a| a as usize);
        match Made::of(field) {
            Some(made) => numbers.for_each(|a| common.push_field(made, a, &at, values)),
            None => {
                let Some(number) = field.number.checked_sub(Made::FIELDS.len()) else { return };
                let own = FieldDescription { number, ..*field };
                numbers.for_each(|a| matter.push_field(common, &own, a, (&at, state), values));
            }
        }
    }

    fn phases(&self) -> Vec<&Phase> {
        vec![self.drift.phase(), self.accelerate.phase()]
    }

    fn bodies(&self) -> &[u32] {
        &self.common.particles.body
    }

    fn ids(&self) -> &[u32] {
        &self.common.particles.id
    }

    fn is_closed(&self) -> bool {
        self.common.removed.is_empty()
    }

    fn body_of(&self, state: &[f64], index: usize) -> Option<u32> {
        self.matter.body_of(&self.common, index, state)
    }

    fn birth_of(&self, state: &[f64], index: usize) -> u32 {
        self.matter.birth_of(&self.common, index, state)
    }

    fn mass(&self, index: usize) -> f64 {
        self.common.mass_at(index, self.common.at_rest(index).density)
    }

    #[inline(never)]
    fn particle(&self, index: usize) -> Particle {
        Particle {
            id: self.common.particles.id[index],
            reference: self.common.particles.position[index].iter().copied().collect(),
        }
    }

    #[inline(never)]
    fn neighborhood(&self, index: usize) -> Vec<u32> {
        self.common.neighbors_of(index)
    }

    fn stability_advice(&self) -> &'static str {
        "raise `scheme.artificial_viscosity`"
    }

    #[inline(never)]
    fn collapse_advice(&self, _index: usize) -> String {
        "the density has lost its meaning there: lower `time.cfl`, raise the wave speed of the \
         fluid to ten times the speeds that occur, or raise `scheme.artificial_viscosity`"
            .into()
    }

    #[inline(never)]
    fn memory(&self) -> usize {
        let bytes: f64 = self.matter.arrays().iter().map(|array| array.bytes).sum();
        let matter = self.particle_count() * bytes as usize;
        self.common.memory() + matter + size_of_val(self.start.as_slice())
    }

    /// Accelerations are kept in the state, for kicks.
    fn has_rates(&self) -> bool {
        false
    }

    fn keeps_neighbors(&self) -> bool {
        false
    }

    #[inline(never)]
    fn on_device(
        &self,
        device: Device,
        method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        M::to_device(self, device, method.unless_kicked()?)
    }

    #[inline(never)]
    fn device_stages(
        &self,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        M::device_stages(self, language, method.unless_kicked()?)
    }

    #[inline(never)]
    fn share(&self, part: &Part) -> Result<Box<dyn Scheme>, RankRefusal> {
        Ok(Box::new(self.shared(part)?))
    }

    #[inline(never)]
    fn cost(&self, particles: Range<usize>) -> f64 {
        let list = self.common.support.list();
        let places = &list.places()[particles];
        places.iter().map(|&place| (1 + list.row(place as usize).len()) as f64).sum()
    }

    fn shares(&self, bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        Ok(self.planned(bounds))
    }

    fn team(&self) -> Option<&Team> {
        Some(self.common.team())
    }

    fn find_neighbors(&mut self, state: &[f64]) {
        self.common.find_neighbors(state);
    }

    fn split(&mut self) -> Option<&mut dyn SplitScheme> {
        Some(self)
    }
}
