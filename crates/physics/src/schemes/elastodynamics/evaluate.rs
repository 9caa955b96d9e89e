//! From displacements to forces: two products and what is between them.

use super::edges;
use super::fields::Columns;
use super::settings::is_linear;
use super::{Configuration, Elastodynamics, Matrices};
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
        if !self.velocity.is_empty() {
            parallel::copy(&mut self.velocity[..count], at.velocity);
        }
        let data = [&self.displacement[..], at.velocity].map(|field| self.plane_data(field));
        match &self.matrices {
            Matrices::Strong(edges) => edges.append_held(count, &mut self.velocity),
            Matrices::Adjoint(operator) => {
                operator.continue_field(&data[0], &mut self.displacement);
                if !self.velocity.is_empty() {
                    operator.continue_field(&data[1], &mut self.velocity);
                }
            }
        }
    }

    /// Displacement gradients of the loaded state, and their rates where something dissipates.
    pub(super) fn fill_gradients(&mut self, time: f64, at: &Columns<'_, D>) {
        self.continue_displacement(time);
        self.matrices.gradients(&self.displacement, &mut self.gradient);
        self.continue_velocity(time);
        if self.settings.is_viscous() {
            let velocity = if self.velocity.is_empty() { at.velocity } else { &self.velocity };
            self.matrices.gradients(velocity, &mut self.gradient_rate);
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
        if let Matrices::Strong(edges) = &self.matrices {
            edges.overwrite(&mut stress, |_| 1.0);
        }
        self.stress = stress;
    }

    /// What forces gather of the stresses.
    pub(super) fn fill_tensions(&mut self) {
        let mut tension = std::mem::take(&mut self.tension);
        let is_viscous = self.settings.is_viscous();
        parallel::for_each_chunk(&mut tension[..self.mass.len()], |first, rows| {
            for (offset, tension) in rows.iter_mut().enumerate() {
                let a = first + offset;
                let mut stress = self.stress[a];
                if is_viscous {
                    stress += self.viscous_stress(a);
                }
                *tension = stress * self.particles.volume[a];
                if let Matrices::Adjoint(operator) = &self.matrices {
                    *tension = operator.tension(a, &self.gradient[a], *tension);
                }
            }
        });
        if let Matrices::Strong(edges) = &self.matrices {
            // The load is all of the stress there, also of a viscous material.
            edges.overwrite(&mut tension, |a| self.particles.volume[a]);
        }
        self.tension = tension;
    }

    /// Internal forces.
    pub(super) fn fill_forces(&mut self) {
        let (tension, force) = (&self.tension, &mut self.force);
        match &self.matrices {
            Matrices::Strong(edges) => {
                edges.forces(tension, &edges.stress, &self.particles.volume, force);
            }
            Matrices::Adjoint(operator) => {
                operator.forces(&self.displacement, tension, force);
                operator.fold(force);
            }
        }
        self.is_evaluated = true;
    }

    /// Writes the data of edges behind the velocities, at the gradients of the moment.
    fn continue_velocity(&mut self, time: f64) {
        let Matrices::Strong(edges) = &mut self.matrices else { return };
        let tangents = |a: usize| {
            let mixture = &self.mixtures[self.mixture[a] as usize];
            mixture.tangent(&self.gradient[a])
        };
        edges.continue_rates(&mut self.velocity, tangents, |slot| slot.stress_rate(time));
    }

    /// Velocities of a loaded state, with what stands behind them where gradients are taken of them.
    pub(super) fn velocity<'a>(&'a self, at: &Columns<'a, D>) -> &'a [Vector<D>] {
        if self.velocity.is_empty() { at.velocity } else { &self.velocity }
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
        let Matrices::Strong(known) = &mut self.matrices else { return true };
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
            (known.gradient, known.divergence) = (gradient, divergence);
        }
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
        let edges = match &self.matrices {
            Matrices::Adjoint(operator) => return [0.0, operator.plane_power(&self.force, rates)],
            Matrices::Strong(edges) => edges,
        };
        let count = self.mass.len();
        let held = |datum: usize| {
            let Some(slot) = edges.slots.get(datum) else { return Vector::zeros() };
            let rate = &speed[count + datum];
            Vector::from_fn(|i, _| if slot.is_held[i] { rate[i] } else { 0.0 })
        };
        let motion = parallel::sum(count, |a| {
            self.tension[a].dot(&edges.gradient.gradient_of_data(held, a))
        });
        // What the forces do, and the energy that is stored: the rest has come in at the edges.
        let sum = parallel::sum(count, |a| {
            let rate = edges.gradient.gradient_at(speed, a);
            self.force[a].dot(&speed[a]) + self.tension[a].dot(&rate)
        });
        [sum - motion, motion]
    }
}
