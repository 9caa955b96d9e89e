//! The derivatives of a state in equilibrium by a constant of a material.

use piola_formulas::hyperelastic::HyperelasticLaw;

use super::Statics;
use crate::operators::one_by_one;
use crate::schemes::NoSensitivity;
use crate::solve::{Equations, Tangent};
use crate::{Tensor, Vector, parallel};

/// A state with less than this part of the loads left is one that Newton's method has found.
const BALANCED: f64 = 0.1;
/// Part of a right-hand side that Krylov methods are asked to leave.
const TOLERANCE: f64 = 1e-10;
/// Part of a right-hand side that may be left: a direct method leaves round-off times the condition
/// number, Krylov methods more where the state is unstable.
const MOST_LEFT: f64 = 1e-6;

impl<const D: usize> Statics<D> {
    /// The derivatives of the displacements in m, and of the forces of the supports in N, by a constant of
    /// the material of a body at displacements in equilibrium at a load factor: theory (106) and (107).
    /// `law` is the derivative of its law.
    ///
    /// # Errors
    /// [`NoSensitivity`] where particles are made of several materials or faces of cells are held, where the
    /// state is not in equilibrium, and where the tangent is singular.
    pub fn sensitivity(
        &mut self,
        factor: f64,
        displacement: &[Vector<D>],
        body: u32,
        law: &HyperelasticLaw,
    ) -> Result<[Vec<Vector<D>>; 2], NoSensitivity> {
        if self.discrete.solid.mixtures.iter().any(|mixture| mixture.0.len() > 1) {
            return Err(NoSensitivity::Joined);
        }
        if !self.faces.springs().is_empty() {
            return Err(NoSensitivity::Faces);
        }
        let x = self.collect(displacement);
        let mut residual = vec![0.0; x.len()];
        let open = self.residual(factor, &x, &mut residual);
        if !(open < BALANCED) {
            return Err(NoSensitivity::NotInEquilibrium { residual: open });
        }
        self.linearise(factor, &x, false)?;
        let mut left = self.forces_by_constant(body, law);
        self.solver.reduction().restrict(&left, &mut residual);
        let norm =
            |residual: &[f64]| parallel::sum(residual.len(), |k| residual[k] * residual[k]).sqrt();
        let (size, mut moved) = (norm(&residual), vec![Vector::zeros(); left.len()]);
        if size > 0.0 {
            let mut solution = vec![0.0; x.len()];
            let Self { solver, stiffness, .. } = self;
            solver.solve(stiffness, &residual, TOLERANCE, &mut solution)?;
            self.solver.reduction().expand_free(&solution, &mut moved);
            let mut product = moved.clone();
            self.stiffness.apply(&moved, &mut product);
            left.iter_mut().zip(&product).for_each(|(left, product)| *left -= product);
            self.solver.reduction().restrict(&left, &mut residual);
            let residual = norm(&residual) / size;
            if !(residual <= MOST_LEFT) {
                return Err(NoSensitivity::Singular { residual });
            }
        }
        let reduction = self.solver.reduction();
        let held = left.iter().enumerate().map(|(a, left)| -reduction.held_part(a, left));
        Ok([moved, held.collect()])
    }

    /// The derivatives of the internal forces in N by the constant, at the displacements at hand.
    fn forces_by_constant(&self, body: u32, law: &HyperelasticLaw) -> Vec<Vector<D>> {
        let (discrete, solid) = (&*self.discrete, &*self.discrete.solid);
        let is_own = |a: usize| solid.particles.body[a] == body;
        let shear = law.small_strain().mu;
        // Hourglass coefficients are multiples of the shear modulus.
        let hourglass = |a: usize| match is_own(a) {
            true => discrete.operator.hourglass(a) * shear / solid.mixture(a).shear_modulus(),
            false => 0.0,
        };
        let hourglass = (0..solid.len()).map(hourglass).collect();
        let operator = discrete.operator.with_hourglass(&solid.particles, hourglass);
        let mut strained = operator.strained();
        let tension = |a: usize, gradient: &Tensor<D>| match solid.mixture(a).0.first() {
            Some((material, _)) if is_own(a) => {
                material.law.stress_derivative(gradient, law) * solid.particles.volume[a]
            }
            _ => Tensor::zeros(),
        };
        operator.strain(&self.displacement, &mut strained, one_by_one(tension));
        let mut force = vec![Vector::zeros(); self.displacement.len()];
        operator.forces(&self.displacement, &strained.tension, &mut force);
        discrete.fold(&mut force);
        force.truncate(solid.len());
        force
    }
}
