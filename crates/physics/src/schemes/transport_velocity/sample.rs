//! Fields of single particles.

use piola_formulas::kernels::Needs;
use piola_formulas::pairs::fluid::FluidSide;
use piola_formulas::pairs::sums::VelocityGradient;
use piola_formulas::pairs::{MovingPair, Of, PairLaw};

use super::fields::Made;
use super::stages::{Instant, Pass};
use super::{Columns, Common, Continuum, Forces, Rates, TransportVelocity};
use crate::geometry::Faces;
use crate::operators::{Among, NeighborBlock, Term, add_at, visit};
use crate::schemes::ledger::Totals;
use crate::{Tensor, Vector};

impl<const D: usize, M: Continuum<D>> TransportVelocity<D, M> {
    /// All passes at a state as it is: sides, rates and forces are those of `state` afterwards.
    pub(super) fn all_passes(&mut self, time: f64, state: &[f64]) {
        let (instant, mut totals) = (Instant { time, step: 0.0 }, Totals::default());
        let mut state = state.to_vec();
        for pass in self.accelerate.passes().to_vec() {
            match pass {
                Pass::Load | Pass::Walls | Pass::Forces | Pass::BodyForces | Pass::Own(_) => {}
                _ => continue,
            }
            self.run(pass, instant, &mut state, &mut totals);
        }
        self.matter.find_rates(&self.common, time);
    }

    /// The terms of the equations at a state, particle by particle, for those who want to see
    /// them apart.
    #[inline(never)]
    pub fn terms(&mut self, time: f64, state: &[f64]) -> Vec<(Rates, Forces<D>)> {
        self.all_passes(time, state);
        let common = &self.common;
        let terms = |&place: &u32| {
            let place = place as usize;
            (*self.matter.rates_at(place), common.forces[place])
        };
        common.support.list().places().iter().map(terms).collect()
    }

    /// The stages of observation: what neighbours show, then free surfaces.
    pub(super) fn make_fields(&mut self, stage: usize, time: f64, state: &[f64]) {
        if stage == 1 {
            self.load(state);
            self.common.wall_pass(&mut self.matter, time);
            self.matter.prepare_fields(&self.common);
        } else if self.common.settings.free_surface {
            self.common.opening_pass();
            self.common.find_surfaces();
        }
    }
}

impl<const D: usize> Common<D> {
    /// Appends the components of one field of one particle.
    pub(super) fn push_field(
        &self,
        field: Made,
        number: usize,
        at: &Columns<'_, D>,
        values: &mut Vec<f64>,
    ) {
        let place = self.support.list().places()[number] as usize;
        match field {
            Made::transport_velocity => {
                let velocity = at.velocity[number] + at.deviation[number];
                values.extend_from_slice(velocity.as_slice());
            }
            Made::acceleration => values.extend_from_slice(at.kick[number].as_slice()),
            Made::force => {
                let force = at.kick[number] * self.mass_at(number, at.density[number]);
                values.extend_from_slice(force.as_slice());
            }
            Made::vorticity => values.push(self.vorticity(place)),
            Made::divergence => values.push(self.velocity_gradient(place).trace()),
            Made::surface => {
                let is_surface = self.openings.get(place).is_some_and(|o| o.is_surface);
                values.push(f64::from(is_surface && !self.is_wall[number]));
            }
            Made::surface_normal => {
                let normal = self.openings.get(place).map_or(Vector::zeros(), |o| o.normal);
                values.extend_from_slice(normal.as_slice());
            }
            Made::wall => {
                let is_wall = self.is_wall[number] && self.wall_of(number as u32).is_some();
                values.push(f64::from(is_wall));
            }
            Made::normal => {
                let normal = self.faces(number).map_or(Vector::zeros(), Faces::between);
                values.extend_from_slice(normal.as_slice());
            }
            Made::neighbors => values.push(self.neighbor_count(place) as f64),
            Made::mass => values.push(self.mass_at(number, at.density[number])),
        }
    }

    /// Numbers of the particles inside the support of a particle.
    pub(super) fn neighbors_of(&self, number: usize) -> Vec<u32> {
        let list = self.support.list();
        let place = list.places()[number] as usize;
        let mut found = Vec::new();
        self.for_each_neighbor(place, |other| found.push(list.numbers()[other]));
        found
    }

    fn neighbor_count(&self, place: usize) -> usize {
        let mut count = 0;
        self.for_each_neighbor(place, |_| count += 1);
        count
    }

    fn for_each_neighbor(&self, place: usize, mut look: impl FnMut(usize)) {
        let block = &mut NeighborBlock::default();
        visit(&self.support, place, Among::All, Needs::Nothing, block, |other, _| {
            look(other);
        });
    }

    /// A sum over all neighbours, added to `sums`.
    pub(super) fn add_all<L: PairLaw<Pair = MovingPair<D>, Side = FluidSide<D>>>(
        &self,
        law: L,
        place: usize,
        sums: &mut Of<L::Sums, f64>,
    ) {
        let sum = Term { law, source: self.sides.as_slice(), among: Among::All };
        add_at(&self.support, &sum, place, &mut NeighborBlock::default(), sums);
    }

    /// The faces that a wall particle is behind.
    pub(super) fn faces(&self, number: usize) -> Option<&Faces<D>> {
        Some(&self.walls[self.wall_of(number as u32)?].faces)
    }

    /// The velocity gradient `d u_i / d x_j` in 1/s, CTVF (31).
    fn velocity_gradient(&self, place: usize) -> Tensor<D> {
        let mut gradient = Tensor::zeros();
        self.add_all(VelocityGradient, place, &mut gradient);
        gradient
    }

    /// Curl of the velocity in 1/s: its component across the plane in 2D, its magnitude in 3D.
    fn vorticity(&self, place: usize) -> f64 {
        let gradient = self.velocity_gradient(place);
        let curl = |i: usize, j: usize| gradient[(j, i)] - gradient[(i, j)];
        match D {
            1 => 0.0,
            2 => curl(0, 1),
            _ => [curl(1, 2), curl(2, 0), curl(0, 1)].map(|c| c * c).iter().sum::<f64>().sqrt(),
        }
    }
}
