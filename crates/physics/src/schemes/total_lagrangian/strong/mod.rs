//! The strong form on a row or a box of particles: `rho dv/dt = X P`, with ghosts beyond the edges that
//! carry displacements and stresses on, theory (64). Its matrices may be made anew in each step.

mod edges;
mod ghosts;
mod holes;
mod slopes;

pub(super) use edges::{Edges, find, matrices};
pub use holes::Hole;

use piola_formulas::kernels::Kernel;

use super::fields::Columns;
use super::{FIGURES, LEDGER, Matrices, TotalLagrangian};
use crate::neighbors::Domain;
use crate::operators::Cover;
use crate::{Tensor, Vector, parallel};

/// What matrices at the places of the moment are made of.
pub(super) struct Moving<const D: usize> {
    pub kernel: Kernel,
    pub radius: Vec<f64>,
    pub group: Vec<u32>,
    pub domain: Domain<D>,
}

impl<const D: usize> TotalLagrangian<D> {
    /// Displacement gradients of the loaded state, and their rates where something dissipates.
    pub(super) fn fill_gradients(&mut self, time: f64, at: &Columns<'_, D>) {
        self.continue_displacement(time);
        self.matrices.gradients(&self.displacement, &mut self.strained.gradient);
        self.continue_velocity(time);
        if self.dissipation.is_viscous() {
            self.fill_rates(at);
        }
        if self.updated.is_some() {
            self.turn_to_reference();
        }
    }

    /// Stresses of the gradients, with what edges know of them.
    pub(super) fn fill_stresses(&mut self) {
        let (solid, gradient) = (&*self.solid, &self.strained.gradient);
        parallel::for_each_chunk(&mut self.stress, |first, rows| {
            solid.stresses(first, &gradient[first..][..rows.len()], rows);
        });
        if let Matrices::Strong(edges) = &self.matrices {
            edges.overwrite(&mut self.stress, |_| 1.0);
        }
    }

    /// What forces gather of the stresses.
    pub(super) fn fill_tensions(&mut self) {
        let (solid, dissipation) = (&*self.solid, self.dissipation);
        let (volume, is_viscous) = (&solid.particles.volume, dissipation.is_viscous());
        let (elastic, rates) = (&self.stress, &self.gradient_rate);
        let gradient = &self.strained.gradient;
        parallel::for_each_chunk(&mut self.strained.tension, |first, rows| {
            for (a, tension) in (first..).zip(rows) {
                let mut stress = elastic[a];
                if is_viscous {
                    stress += dissipation.at(solid, a).stress(&gradient[a], &rates[a]);
                }
                *tension = stress * volume[a];
            }
        });
        if let Matrices::Strong(edges) = &self.matrices {
            // The load is all of the stress there, also of a viscous material.
            edges.overwrite(&mut self.strained.tension, |a| volume[a]);
        }
    }

    /// Writes the data of edges behind the velocities, at the gradients of the moment.
    fn continue_velocity(&mut self, time: f64) {
        let Matrices::Strong(edges) = &mut self.matrices else { return };
        let (solid, gradient) = (&*self.solid, &self.strained.gradient);
        let tangents = |a: usize| solid.mixture(a).tangent(&gradient[a]);
        edges.continue_rates(&mut self.velocity, tangents, |slot| slot.stress_rate(time));
    }

    /// Makes matrices at the places of the moment where they are made anew; whether they exist.
    pub(super) fn rebuild(&mut self) -> bool {
        let (Some(moving), Matrices::Strong(known)) = (&self.updated, &mut self.matrices) else {
            return true;
        };
        let mut particles = self.solid.particles.clone();
        for (place, displacement) in particles.position.iter_mut().zip(&self.displacement) {
            *place += displacement;
        }
        let cover = Cover {
            particles: &particles,
            group: &moving.group,
            images: &[],
            kernel: moving.kernel,
            radius: &moving.radius,
            domain: moving.domain,
        };
        let made = matrices(&cover, &known.edges, &[]);
        let exist = made.is_ok();
        if let Ok([gradient, divergence]) = made {
            (known.gradient, known.divergence) = (gradient, divergence);
        }
        exist
    }

    /// Turns gradients by the places of the moment into those by the reference places. A law of small
    /// strains makes no difference between them.
    fn turn_to_reference(&mut self) {
        for (a, gradient) in self.strained.gradient.iter_mut().enumerate() {
            if !self.solid.mixture(a).is_linear() {
                let inverse = piola_formulas::tensor::inverse(&(Tensor::identity() - *gradient));
                let none = || Tensor::from_element(f64::NAN);
                *gradient = inverse.unwrap_or_else(none) - Tensor::identity();
            }
        }
    }

    /// The powers in W that loaded edges, and held ones with rollers, do on the strain energy through
    /// ghosts at the evaluated state: `speed` are velocities, or what stands for them.
    pub(super) fn ghost_powers(&self, speed: &[Vector<D>]) -> [f64; 2] {
        let edges = match &self.matrices {
            Matrices::Adjoint(discrete) => {
                if !self.has_images {
                    return [0.0; 2];
                }
                let rates = discrete.plane_data(speed);
                let power = discrete.operator.plane_power(&self.team, &self.force, &rates);
                return [0.0, power];
            }
            Matrices::Strong(edges) => edges,
        };
        let (count, tension) = (self.solid.len(), &self.strained.tension);
        let held = |datum: usize| {
            let Some(slot) = edges.slots.get(datum) else { return Vector::zeros() };
            let rate = &speed[count + datum];
            Vector::from_fn(|i, _| if slot.is_held[i] { rate[i] } else { 0.0 })
        };
        let motion =
            parallel::sum(count, |a| tension[a].dot(&edges.gradient.gradient_of_data(held, a)));
        // What the forces do, and the energy that is stored: the rest has come in at the edges.
        let sum = parallel::sum(count, |a| {
            let rate = edges.gradient.gradient_at(speed, a);
            self.force[a].dot(&speed[a]) + tension[a].dot(&rate)
        });
        [sum - motion, motion]
    }

    /// What the state keeps of the data of edges.
    fn kept<'a>(&self, tail: &'a [f64]) -> &'a [f64] {
        &LEDGER.behind(D, tail)[FIGURES..]
    }
}
