//! Fields of single particles.

use super::scheme::Made;
use super::{Forces, Rates, Row, TransportVelocity};
use crate::Vector;
use crate::geometry::Faces;
use crate::operators::{Needs, NeighborBlock};

impl<const D: usize> TransportVelocity<D> {
    /// All passes at a state as it is: sides, rates and forces are those of `state` afterwards.
    pub(super) fn all_passes(&mut self, time: f64, state: &[f64]) {
        self.load(state);
        self.correct_gradients();
        self.wall_pass(time);
        self.rate_pass(time);
        self.force_pass();
        self.add_body_forces(time);
        self.hold_accelerations();
        self.hold_off();
    }

    /// The terms of the equations at a state, particle by particle, for those who want to see
    /// them apart.
    pub fn terms(&mut self, time: f64, state: &[f64]) -> Vec<(Rates, Forces<D>)> {
        self.all_passes(time, state);
        let places = self.support.list().places().iter();
        places.map(|&place| (self.rates[place as usize], self.forces[place as usize])).collect()
    }

    /// The stages of observation: what neighbours show, then free surfaces.
    pub(super) fn make_fields(&mut self, stage: usize, time: f64, state: &[f64]) {
        if stage == 1 {
            self.load(state);
            self.wall_pass(time);
        } else if self.settings.free_surface {
            self.opening_pass();
            self.find_surfaces();
        }
    }

    /// Appends the components of one field of one particle.
    pub(super) fn push_field(
        &self,
        field: Made,
        number: usize,
        state: &[f64],
        values: &mut Vec<f64>,
    ) {
        let row = Row::<D>::of(state, number);
        let velocity = Row::<D>::velocity(row);
        let place = self.support.list().places()[number] as usize;
        match field {
            Made::position => values.extend_from_slice(&row[Row::<D>::POSITION..][..D]),
            Made::velocity => values.extend_from_slice(&row[..D]),
            Made::transport_velocity => {
                values.extend_from_slice((velocity + Row::<D>::deviation(row)).as_slice());
            }
            Made::acceleration => values.extend_from_slice(&row[Row::<D>::ACCELERATION..][..D]),
            Made::force => {
                let force = Row::<D>::acceleration(row) * self.mass[number];
                values.extend_from_slice(force.as_slice());
            }
            Made::pressure => values.push(row[Row::<D>::PRESSURE]),
            Made::density => values.push(row[Row::<D>::DENSITY]),
            Made::summed_density => values.push(self.summed_density(place)),
            Made::vorticity => values.push(self.vorticity(place)),
            Made::divergence => values.push(self.velocity_gradient(place, |axis, i| axis == i)),
            Made::surface => {
                let is_surface = self.openings.get(place).is_some_and(|o| o.is_surface);
                values.push(f64::from(is_surface && !self.is_wall[number]));
            }
            Made::surface_normal => {
                let normal = self.openings.get(place).map_or(Vector::zeros(), |o| o.normal);
                values.extend_from_slice(normal.as_slice());
            }
            Made::wall => {
                let is_wall = self.is_wall[number] && !Self::is_removed(row);
                values.push(f64::from(is_wall));
            }
            Made::normal => {
                let normal = self.faces(number).map_or(Vector::zeros(), Faces::between);
                values.extend_from_slice(normal.as_slice());
            }
            Made::neighbors => values.push(self.neighbor_count(place) as f64),
            Made::mass => values.push(self.mass[number]),
            Made::cauchy_stress | Made::von_mises | Made::plastic_strain | Made::temperature => {
                self.push_solid_field(field, number, state, values)
            }
        }
    }

    /// Numbers of the particles inside the support of a particle.
    pub(super) fn neighbors_of(&self, number: usize) -> Vec<u32> {
        let list = self.support.list();
        let place = list.places()[number] as usize;
        let (mut found, mut block) = (Vec::new(), NeighborBlock::default());
        let mut rest = self.support.all(place);
        while self.support.fill(&mut rest, Needs::Nothing, &mut block) {
            found.extend(block.iter().map(|neighbor| list.numbers()[neighbor.place]));
        }
        found
    }

    fn neighbor_count(&self, place: usize) -> usize {
        let mut count = 0;
        let mut block = NeighborBlock::default();
        let mut rest = self.support.all(place);
        while self.support.fill(&mut rest, Needs::Nothing, &mut block) {
            count += block.iter().count();
        }
        count
    }

    /// The sum of masses, theory (26).
    fn summed_density(&self, place: usize) -> f64 {
        let mut sum = self.sides[place].mass() * self.support.centre();
        let mut block = NeighborBlock::default();
        let mut rest = self.support.all(place);
        while self.support.fill(&mut rest, Needs::Value, &mut block) {
            sum += block.iter().map(|b| self.sides[b.place].mass() * b.value).sum::<f64>();
        }
        sum
    }

    /// The faces that a wall particle is behind.
    pub(super) fn faces(&self, number: usize) -> Option<&Faces<D>> {
        Some(&self.walls[self.wall_of(number as u32)?].faces)
    }

    /// The sum of those `d u_i / d x_axis` for which `which(axis, i)` holds, CTVF (31).
    fn velocity_gradient(&self, place: usize, which: impl Fn(usize, usize) -> bool) -> f64 {
        let me = &self.sides[place];
        let mut sum = 0.0;
        let mut block = NeighborBlock::default();
        let mut rest = self.support.all(place);
        while self.support.fill(&mut rest, Needs::Slope, &mut block) {
            for neighbor in block.iter() {
                let other = &self.sides[neighbor.place];
                let jump = me.velocity - other.velocity;
                let gradient = neighbor.separation * neighbor.slope;
                for axis in 0..D {
                    for i in (0..D).filter(|&i| which(axis, i)) {
                        sum -= other.volume * jump[i] * gradient[axis];
                    }
                }
            }
        }
        sum
    }

    /// Curl of the velocity in 1/s: its component across the plane in 2D, its magnitude in 3D.
    fn vorticity(&self, place: usize) -> f64 {
        let curl = |i: usize, j: usize| {
            let one = self.velocity_gradient(place, |axis, k| (axis, k) == (i, j));
            one - self.velocity_gradient(place, |axis, k| (axis, k) == (j, i))
        };
        match D {
            1 => 0.0,
            2 => curl(0, 1),
            _ => [curl(1, 2), curl(2, 0), curl(0, 1)].map(|c| c * c).iter().sum::<f64>().sqrt(),
        }
    }
}
