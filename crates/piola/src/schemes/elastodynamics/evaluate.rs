//! From displacements to forces: two products and what is between them.

use super::edges;
use super::fields::Columns;
use super::settings::is_linear;
use super::{Configuration, Elastodynamics};
use crate::operators::{Cover, PlaneData};
use crate::{Tensor, Vector, parallel};

impl<const D: usize> Elastodynamics<D> {
    /// The columns of a state.
    pub(super) fn columns<'a>(&self, state: &'a [f64]) -> Columns<'a, D> {
        Columns::of(state, self.mass.len())
    }

    /// Takes displacements, and what edges need of velocities, out of a state.
    pub(super) fn load(&mut self, at: &Columns<'_, D>) {
        self.is_evaluated = false;
        let count = self.mass.len();
        parallel::copy(&mut self.displacement[..count], at.displacement);
        let mut displacement = std::mem::take(&mut self.displacement);
        self.append_kept(&mut displacement, at.tail);
        self.displacement = displacement;
        if let Some(edges) = &self.edges {
            parallel::copy(&mut self.velocity[..count], at.velocity);
            edges.append_held(count, &mut self.velocity);
        }
    }

    /// Displacement gradients of the loaded state, and their rates where something dissipates.
    pub(super) fn fill_gradients(&mut self, time: f64, at: &Columns<'_, D>) {
        self.continue_displacement(time);
        let data = self.plane_data(&self.displacement);
        self.matrix.gradient(&self.displacement, &data, &mut self.gradient);
        self.continue_velocity(time);
        if self.settings.is_viscous() {
            let velocity = if self.edges.is_some() { &self.velocity } else { at.velocity };
            let rates = self.plane_data(velocity);
            self.matrix.gradient(velocity, &rates, &mut self.gradient_rate);
        }
        if self.settings.configuration == Configuration::Updated {
            self.turn_to_reference();
        }
    }

    /// Stresses of the gradients.
    pub(super) fn fill_stresses(&mut self) {
        let mut stress = std::mem::take(&mut self.stress);
        parallel::for_each_chunk(&mut stress, |first, rows| {
            for (offset, stress) in rows.iter_mut().enumerate() {
                let a = first + offset;
                *stress = self.mixtures[self.mixture[a] as usize].stress(&self.gradient[a]);
            }
        });
        if let Some(edges) = &self.edges {
            edges.overwrite(&mut stress, |_| 1.0);
        }
        self.stress = stress;
    }

    /// What forces gather of the stresses.
    pub(super) fn fill_tensions(&mut self) {
        let mut tension = std::mem::take(&mut self.tension);
        let is_viscous = self.settings.is_viscous();
        parallel::for_each_chunk(&mut tension, |first, rows| {
            for (offset, tension) in rows.iter_mut().enumerate() {
                let a = first + offset;
                let mut stress = self.stress[a];
                if is_viscous {
                    stress += self.viscous_stress(a);
                }
                *tension = stress * self.particles.volume[a];
                if let Some(hourglass) = &self.hourglass {
                    let shape = self.matrix.shape(a);
                    *tension -= self.gradient[a] * shape * (2.0 * hourglass.coefficient(a));
                }
            }
        });
        if let Some(edges) = &self.edges {
            // The load is all of the stress there, also of a viscous material.
            edges.overwrite(&mut tension, |a| self.particles.volume[a]);
        }
        self.tension = tension;
    }

    /// Internal forces.
    pub(super) fn fill_forces(&mut self) {
        let data = self.plane_data(&self.displacement);
        let mut force = std::mem::take(&mut self.force);
        match &self.edges {
            Some(edges) => {
                edges.forces(&self.tension, &edges.stress, &self.particles.volume, &mut force)
            }
            None => self.matrix.forces(&self.tension, &mut force),
        }
        if let Some(hourglass) = &self.hourglass {
            hourglass.add_forces(&self.displacement, &data, &mut force);
        }
        self.force = force;
        self.is_evaluated = true;
    }

    /// Writes the data of edges behind the velocities, at the gradients of the moment.
    fn continue_velocity(&mut self, time: f64) {
        let Some(mut edges) = self.edges.take() else { return };
        let tangents = |a: usize| {
            let mixture = &self.mixtures[self.mixture[a] as usize];
            mixture.tangent(&self.gradient[a])
        };
        let mut velocity = std::mem::take(&mut self.velocity);
        edges.continue_rates(&self.matrix, &mut velocity, tangents, |slot| slot.stress_rate(time));
        self.velocity = velocity;
        self.edges = Some(edges);
    }

    /// Velocities of a loaded state, with the data of edges behind.
    pub(super) fn velocity<'a>(&'a self, at: &Columns<'a, D>) -> &'a [Vector<D>] {
        if self.edges.is_some() { &self.velocity } else { at.velocity }
    }

    pub(super) fn plane_data(&self, field: &[Vector<D>]) -> PlaneData<D> {
        let mut data = [[0.0; 2]; D];
        for (mirror, particle) in &self.mirrors {
            data[mirror.axis][usize::from(mirror.is_upper)] = field[*particle][mirror.axis];
        }
        data
    }

    /// Makes the matrices of the places of the moment; whether they exist.
    pub(super) fn rebuild(&mut self) -> bool {
        let Some(mut known) = self.edges.take() else { return true };
        let mut particles = self.particles.clone();
        for (place, displacement) in particles.position.iter_mut().zip(&self.displacement) {
            *place += displacement;
        }
        let cover = Cover {
            particles: &particles,
            group: &self.group,
            images: &[],
            kernel: self.kernel,
            radius: &self.radius,
            domain: self.domain,
        };
        let made = edges::matrices(&cover, &known.edges, &[]);
        let exist = made.is_ok();
        if let Ok([gradient, divergence]) = made {
            (self.matrix, known.divergence) = (gradient, divergence);
        }
        self.edges = Some(known);
        exist
    }

    /// Turns gradients by the places of the moment into those by the reference places. A law of small
    /// strains makes no difference between them.
    fn turn_to_reference(&mut self) {
        for a in 0..self.gradient.len() {
            if !is_linear(&self.mixtures[self.mixture[a] as usize]) {
                let shrunk = Tensor::identity() - self.gradient[a];
                let inverse = piola_formulas::tensor::inverse(&shrunk);
                let none = || Tensor::from_element(f64::NAN);
                self.gradient[a] = inverse.unwrap_or_else(none) - Tensor::identity();
            }
        }
    }

    /// The powers in W that loaded edges, and held ones with rollers, do on the strain energy through
    /// ghosts at the evaluated state: `speed` are velocities, or what
    /// stands for them, with the rates of the data that go with them.
    pub(super) fn ghost_powers(&self, speed: &[Vector<D>], rates: &PlaneData<D>) -> [f64; 2] {
        let Some(edges) = &self.edges else {
            let hourglass = self.hourglass.as_ref().map_or(0.0, |hourglass| {
                let data = self.plane_data(&self.displacement);
                hourglass.source_power(&self.displacement, &data, rates)
            });
            let motion = self.matrix.source_power(&self.tension, rates) + hourglass;
            return [0.0, motion];
        };
        let count = self.mass.len();
        let held = |datum: usize| {
            let Some(slot) = edges.slots.get(datum) else { return Vector::zeros() };
            let rate = &speed[count + datum];
            Vector::from_fn(|i, _| if slot.is_held[i] { rate[i] } else { 0.0 })
        };
        let motion =
            parallel::sum(count, |a| self.tension[a].dot(&self.matrix.gradient_of_data(held, a)));
        // What the forces do, and the energy that is stored: the rest has come in at the edges.
        let sum = parallel::sum(count, |a| {
            let rate = self.matrix.gradient_at(speed, rates, a);
            self.force[a].dot(&speed[a]) + self.tension[a].dot(&rate)
        });
        [sum - motion, motion]
    }
}
