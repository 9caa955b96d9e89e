//! From displacements to forces: two products and what is between them.

use super::ends::{self, End, Ends, outward, slope_of};
use super::settings::is_linear;
use super::{Configuration, Elastodynamics};
use crate::operators::{Cover, PlaneData};
use crate::schemes::solid::Row;
use crate::{Tensor, Vector, parallel};

/// Powers in W that boundaries do on the strain energy through the ghosts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct GhostPowers {
    /// Of loaded ends.
    pub traction: f64,
    /// Of held ends and rollers.
    pub motion: f64,
}

impl<const D: usize> Elastodynamics<D> {
    /// Takes displacements and velocities out of a state.
    pub(super) fn load(&mut self, state: &[f64]) {
        let length = Row::<D>::LENGTH;
        parallel::for_each_chunk(&mut self.displacement, |first, rows| {
            for (offset, displacement) in rows.iter_mut().enumerate() {
                *displacement =
                    Row::<D>::displacement(&state[(first + offset) * length..][..length]);
            }
        });
        parallel::for_each_chunk(&mut self.velocity, |first, rows| {
            for (offset, velocity) in rows.iter_mut().enumerate() {
                *velocity = Row::<D>::velocity(&state[(first + offset) * length..][..length]);
            }
        });
    }

    /// Gradient, stress, tension and internal force of all particles at the loaded state.
    pub(super) fn evaluate(&mut self, time: f64) {
        if self.settings.configuration == Configuration::Updated && !self.rebuild() {
            // No matrices: two particles meet. The state that follows is refused as not finite.
            self.force.fill(Vector::from_element(f64::NAN));
            return;
        }
        let (data, stress_data) = self.data(time);
        if self.ends.is_some() {
            self.slopes = data[0];
        }
        self.matrix.gradient(&self.displacement, &data, &mut self.gradient);
        if self.settings.is_viscous() {
            let rates = self.data_rates(time);
            self.matrix.gradient(&self.velocity, &rates, &mut self.gradient_rate);
        }
        if self.settings.configuration == Configuration::Updated {
            self.turn_to_reference();
        }
        let mut stress = std::mem::take(&mut self.stress);
        parallel::for_each_chunk(&mut stress, |first, rows| {
            for (offset, stress) in rows.iter_mut().enumerate() {
                let a = first + offset;
                *stress = self.mixtures[self.mixture[a] as usize].stress(&self.gradient[a]);
            }
        });
        if let Some(ends) = &self.ends {
            for end in ends.loaded() {
                stress[end.particle][(0, 0)] = stress_data[0][usize::from(end.is_upper)];
            }
        }
        self.stress = stress;
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
        for end in self.ends.iter().flat_map(Ends::loaded) {
            // The load is all of the stress there, also of a viscous material.
            tension[end.particle] = self.stress[end.particle] * self.particles.volume[end.particle];
        }
        self.tension = tension;
        let mut force = std::mem::take(&mut self.force);
        match &self.ends {
            Some(ends) => {
                let volume = &self.particles.volume;
                parallel::for_each_chunk(&mut force, |first, rows| {
                    for (offset, force) in rows.iter_mut().enumerate() {
                        let a = first + offset;
                        let field = |b: usize| {
                            Vector::<D>::from_fn(|i, _| self.tension[b][(i, 0)] / volume[b])
                        };
                        let slope = ends.divergence.gradient_of(field, &stress_data, a);
                        *force = Vector::from_fn(|i, _| slope[(i, 0)] * volume[a]);
                    }
                });
            }
            None => self.matrix.forces(&self.tension, &mut force),
        }
        if let Some(hourglass) = &self.hourglass {
            hourglass.add_forces(&self.displacement, &data, &mut force);
        }
        self.force = force;
    }

    /// What planes and ends prescribe at the loaded state: for displacements, and for stresses.
    pub(super) fn data(&self, time: f64) -> (PlaneData<D>, PlaneData<D>) {
        match &self.ends {
            Some(ends) => {
                let of = |end: &End| match end.is_held {
                    true => [self.displacement[end.particle][0], 0.0],
                    false => {
                        let stress = self.end_stress(end, time);
                        let mixture = &self.mixtures[self.mixture[end.particle] as usize];
                        [slope_of(mixture, stress), stress]
                    }
                };
                let [displacement, stress] = ends.data(of);
                (displacement, stress)
            }
            None => (self.plane_data(&self.displacement), [[0.0; 2]; D]),
        }
    }

    /// The data of displacements in a state, which keeps the slopes at loaded ends.
    pub(super) fn data_of(&self, displacement: &[Vector<D>], state: &[f64]) -> PlaneData<D> {
        let Some(ends) = &self.ends else { return self.plane_data(displacement) };
        let kept = &state[self.mass.len() * Row::<D>::LENGTH + Self::slopes_at()..];
        let of = |end: &End| match end.is_held {
            true => [displacement[end.particle][0], 0.0],
            false => [kept[usize::from(end.is_upper)], 0.0],
        };
        ends.data(of)[0]
    }

    /// The rates of the data of displacements.
    pub(super) fn data_rates(&self, time: f64) -> PlaneData<D> {
        let Some(ends) = &self.ends else { return self.plane_data(&self.velocity) };
        let of = |end: &End| {
            if end.is_held {
                return [self.velocity[end.particle][0], 0.0];
            }
            let mixture = &self.mixtures[self.mixture[end.particle] as usize];
            let mut gradient = Tensor::zeros();
            gradient[(0, 0)] = slope_of(mixture, self.end_stress(end, time));
            let stress_rate: f64 = (self.loaded.iter())
                .filter(|load| load.particle == end.particle)
                .map(|load| load.force_rate(time).dot(&outward(end)))
                .sum();
            [stress_rate / mixture.wave_moduli(&gradient)[1], 0.0]
        };
        ends.data(of)[0]
    }

    fn plane_data(&self, field: &[Vector<D>]) -> PlaneData<D> {
        let mut data = [[0.0; 2]; D];
        for (mirror, particle) in &self.mirrors {
            data[mirror.axis][usize::from(mirror.is_upper)] = field[*particle][mirror.axis];
        }
        data
    }

    /// Stress along the row at a loaded end, Pa.
    fn end_stress(&self, end: &End, time: f64) -> f64 {
        let loads = self.loaded.iter().filter(|load| load.particle == end.particle);
        loads.map(|load| load.force(time).dot(&outward(end))).sum()
    }

    /// Makes the matrices of the places of the moment; whether they exist.
    fn rebuild(&mut self) -> bool {
        let Some(known) = &self.ends else { return true };
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
        match ends::matrices(&cover, &known.ends) {
            Ok([gradient, divergence]) => {
                self.matrix = gradient;
                self.ends = Some(Ends { ends: known.ends.clone(), divergence });
                true
            }
            Err(_) => false,
        }
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

    /// The powers of boundaries through ghosts at the evaluated state: `speed` are velocities, or what
    /// stands for them, with the rates of the data that go with them.
    pub(super) fn ghost_powers(
        &self,
        time: f64,
        speed: &[Vector<D>],
        rates: &PlaneData<D>,
    ) -> GhostPowers {
        let motion = self.matrix.source_power(&self.tension, &self.held_only(rates))
            + self.hourglass.as_ref().map_or(0.0, |hourglass| {
                let data = self.data(time).0;
                hourglass.source_power(&self.displacement, &data, rates)
            });
        if self.ends.is_none() {
            return GhostPowers { traction: 0.0, motion };
        }
        // What the forces do, and the energy that is stored: the rest has come in at the ends.
        let sum = parallel::sum(speed.len(), |a| {
            let rate = self.matrix.gradient_at(speed, rates, a);
            self.force[a].dot(&speed[a]) + self.tension[a].dot(&rate)
        });
        GhostPowers { traction: sum - motion, motion }
    }

    /// The rates of held ends and planes alone.
    fn held_only(&self, rates: &PlaneData<D>) -> PlaneData<D> {
        let mut held = *rates;
        for end in self.ends.iter().flat_map(Ends::loaded) {
            held[0][usize::from(end.is_upper)] = 0.0;
        }
        held
    }
}
