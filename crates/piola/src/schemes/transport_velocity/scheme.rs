//! The transport-velocity formulation as integrators, clock and output see it.

use piola_device::Device;

use super::fields::{ColumnsMut, Made};
use super::{ENERGIES, LEDGER, TransportVelocity, WALLS};
use crate::fields::FieldDescription;
use crate::schemes::ledger::Totals;
use crate::schemes::momentum::of_particles;
use crate::schemes::{
    Capability, DeviceRefusal, DeviceSteps, Escape, Health, Particle, Phase, Scheme,
    SchemeDescription, SplitScheme, StepLimit,
};

/// Names and units of the figures of the formulation.
const FIGURES: [(&str, &str); 5] =
    [("shifting_passes", "1"), ("removed", "1"), ("behind", "1"), ("gap", "1"), ("pieces", "1")];

/// What the formulation is called and what it shows.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: "transport_velocity",
    offers: &[Capability::Kicks],
    fields: Made::FIELDS,
    energies: &ENERGIES,
    ledger: LEDGER,
    figures: &FIGURES,
};

impl<const D: usize> Scheme for TransportVelocity<D> {
    fn description(&self) -> &'static SchemeDescription {
        &DESCRIPTION
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.particles.len()
    }

    fn initial_state(&self) -> Vec<f64> {
        self.start().to_vec()
    }

    /// Rates with the deviations of the state. The stored accelerations and deviations are not
    /// unknowns and have none, and neither has the matter of solids, whose stress does not only follow
    /// from rates.
    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]) {
        self.all_passes(time, state);
        rate.fill(0.0);
        let (own, _) = ColumnsMut::<D>::of(rate, self.particles.len());
        for number in 0..self.particles.len() {
            let place = self.support.list().places()[number] as usize;
            let side = &self.sides[place];
            if self.is_wall[number] {
                continue;
            }
            own.velocity[number] = self.forces[place].total();
            own.position[number] = side.velocity + side.deviation;
            own.density[number] = self.density_rate(place);
            own.pressure[number] = self.pressure_rates(place).iter().sum();
        }
    }

    fn constrain(&self, time: f64, state: &mut [f64]) {
        let mut totals = Totals::default();
        totals.book(WALLS, &self.hold_velocities(time, state));
        let (own, tail) = ColumnsMut::<D>::of(state, self.particles.len());
        LEDGER.add(D, &totals, tail);
        for entry in self.motion.iter() {
            let number = self.walls[entry.particle].number as usize;
            own.velocity[number][entry.component] = entry.value.value(entry.place, time);
        }
    }

    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.look(state, limits)
    }

    fn escape(&self, index: usize, state: &[f64]) -> Option<Escape> {
        self.escape_of(index, state)
    }

    fn figures(&self, state: &[f64], figures: &mut Vec<f64>) {
        let tail = self.columns(state).tail;
        figures.extend([
            LEDGER.behind(D, tail)[0],
            self.removed_count(state),
            self.behind_count(state),
            self.largest_gap(state),
            self.piece_count(state),
        ]);
    }

    fn energies(&self, state: &[f64], energies: &mut [f64]) {
        energies[0] = self.kinetic_energy(state);
        [energies[1], energies[2]] = match self.solids {
            Some(_) => self.energies_of_solids(state),
            None => [self.compression_energy(state), 0.0],
        };
    }

    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let at = self.columns(state);
        let of = |number: usize| {
            let mass = if self.is_wall[number] { 0.0 } else { self.mass[number] };
            [at.position[number], at.velocity[number] * mass]
        };
        of_particles(self.particles.len(), of, momentum);
    }

    fn observe(&mut self, stage: usize, time: f64, state: &[f64]) {
        self.make_fields(stage, time, state);
    }

    fn derive(
        &self,
        state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let Some(made) = Made::of(field) else { return };
        let at = self.columns(state);
        particles.iter().for_each(|&a| self.push_field(made, a as usize, (&at, state), values));
    }

    fn phases(&self) -> Vec<&Phase> {
        vec![self.drift.phase(), self.accelerate.phase()]
    }

    fn bodies(&self) -> &[u32] {
        &self.particles.body
    }

    fn ids(&self) -> &[u32] {
        &self.particles.id
    }

    fn particle(&self, index: usize) -> Particle {
        Particle {
            id: self.particles.id[index],
            reference: self.particles.position[index].iter().copied().collect(),
        }
    }

    fn neighborhood(&self, index: usize) -> Vec<u32> {
        self.neighbors_of(index)
    }

    fn stability_advice(&self) -> &'static str {
        "raise `scheme.artificial_viscosity`"
    }

    fn collapse_advice(&self, _index: usize) -> String {
        "the density has lost its meaning there: lower `time.cfl`, raise the wave speed of the \
         fluid to ten times the speeds that occur, or raise `scheme.artificial_viscosity`"
            .into()
    }

    fn memory(&self) -> usize {
        let side = size_of::<super::Side<D>>() + size_of::<super::Forces<D>>();
        let particle = side + size_of::<super::Rates>() + 4 * size_of::<f64>();
        let solids = if self.solids.is_some() { 4 * size_of::<super::Forces<D>>() } else { 0 };
        let arrays = self.particles.len() * (particle + solids);
        self.support.memory() + arrays + size_of_val(self.start.as_slice())
    }

    /// Accelerations are kept in the state, for kicks.
    fn has_rates(&self) -> bool {
        false
    }

    fn on_device(&self, device: Device) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        self.to_device(device)
    }

    fn split(&mut self) -> Option<&mut dyn SplitScheme> {
        Some(self)
    }
}
