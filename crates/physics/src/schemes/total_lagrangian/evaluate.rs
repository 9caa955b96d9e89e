//! From displacements to forces: two products and what is between them.

use super::fields::Columns;
use super::{Matrices, TotalLagrangian};
use crate::{Vector, parallel};

impl<const D: usize> TotalLagrangian<D> {
    /// The columns of a state.
    pub(super) fn columns<'a>(&self, state: &'a [f64]) -> Columns<'a, D> {
        Columns::of(state, self.solid.len())
    }

    /// Current position of particle a in m.
    #[inline]
    pub(super) fn position(&self, a: usize, at: &Columns<'_, D>) -> Vector<D> {
        self.solid.particles.position[a] + at.displacement[a]
    }

    /// Takes displacements, and what edges need of velocities, out of a state.
    pub(super) fn load(&mut self, at: &Columns<'_, D>) {
        self.is_evaluated = false;
        let count = self.solid.len();
        parallel::copy(&mut self.displacement[..count], at.displacement);
        let mut displacement = std::mem::take(&mut self.displacement);
        self.append_kept(&mut displacement, at.tail);
        self.displacement = displacement;
        if !self.velocity.is_empty() {
            parallel::copy(&mut self.velocity[..count], at.velocity);
        }
        match &self.matrices {
            Matrices::Strong(edges) => edges.append_held(count, &mut self.velocity),
            Matrices::Adjoint(discrete) => {
                discrete.continue_on(&self.team, self.has_images, &mut self.displacement);
                if !self.velocity.is_empty() {
                    discrete.continue_on(&self.team, self.has_images, &mut self.velocity);
                }
            }
        }
    }

    /// Rates of the displacement gradients of the loaded state.
    pub(super) fn fill_rates(&mut self, at: &Columns<'_, D>) {
        let mut rates = std::mem::take(&mut self.gradient_rate);
        self.matrices.gradients(self.velocity(at), &mut rates);
        self.gradient_rate = rates;
    }

    /// Displacement gradients of the loaded state, and with their stresses what forces gather, in the
    /// adjoint form.
    pub(super) fn fill_strains(&mut self) {
        let Matrices::Adjoint(discrete) = &self.matrices else { return };
        let (solid, dissipation, rates) = (&*self.solid, self.dissipation, &self.gradient_rate);
        let is_viscous = dissipation.is_viscous();
        discrete.operator.strain(
            &self.displacement,
            &mut self.strained,
            |first, gradients, stresses| {
                solid.stresses(first, gradients, stresses);
                for ((a, gradient), stress) in (first..).zip(gradients).zip(stresses) {
                    if is_viscous {
                        *stress += dissipation.at(solid, a).stress(gradient, &rates[a]);
                    }
                    *stress *= solid.particles.volume[a];
                }
            },
        );
        let width = discrete.operator.tensions();
        self.team.refresh(&mut self.strained.tension, discrete.operator.owned(), width);
    }

    /// Internal forces.
    pub(super) fn fill_forces(&mut self) {
        let (tension, force) = (&self.strained.tension, &mut self.force);
        match &self.matrices {
            Matrices::Strong(edges) => {
                edges.forces(tension, &edges.stress, &self.solid.particles.volume, force);
            }
            Matrices::Adjoint(discrete) => {
                discrete.operator.forces(&self.displacement, tension, force);
                discrete.operator.fold(force);
            }
        }
        self.is_evaluated = true;
    }

    /// Velocities of a loaded state, with what stands behind them where gradients are taken of them.
    pub(super) fn velocity<'a>(&'a self, at: &Columns<'a, D>) -> &'a [Vector<D>] {
        if self.velocity.is_empty() { at.velocity } else { &self.velocity }
    }

    /// Displacements with what stands behind them, of which a state keeps data of edges in its tail.
    pub(super) fn continued(&self, displacement: &[Vector<D>], tail: &[f64]) -> Vec<Vector<D>> {
        let mut displacement = displacement.to_vec();
        displacement.resize(self.displacement.len(), Vector::zeros());
        match &self.matrices {
            Matrices::Strong(_) => self.append_kept(&mut displacement, tail),
            Matrices::Adjoint(discrete) => discrete.continue_field(&mut displacement),
        }
        displacement
    }
}
