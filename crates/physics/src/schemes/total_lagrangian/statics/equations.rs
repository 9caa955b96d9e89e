//! Residual and tangent of a body under loads.

use piola_formulas::tensor;

use super::super::loads::press;
use super::Statics;
use crate::solve::{
    Equations, LinearError, LinearReport, LoadedEquations, Stability, Tangent, Trial,
};
use crate::{Tensor, Vector, parallel};

impl<const D: usize> Statics<D> {
    /// Displacements of unknowns at a load factor.
    fn displace(&mut self, factor: f64, x: &[f64]) {
        let own = &mut self.displacement[..self.left.len()];
        match &self.inertia {
            Some(inertia) => self.solver.reduction().expand(x, &inertia.held, own),
            None => {
                let held = self.supports.values(factor, false);
                self.solver.reduction().expand(x, &held, own);
            }
        }
        self.discrete.continue_field(&mut self.displacement);
    }

    /// Internal forces at the displacements at hand, into `left`.
    fn fill_internal(&mut self) {
        let Self { discrete, displacement, passes, internal, left, .. } = self;
        let tensions = |first: usize, gradients: &[_], tensions: &mut [_]| {
            discrete.tensions(first, gradients, tensions);
        };
        passes.forces(&discrete.operator, displacement, tensions, internal);
        discrete.fold(internal);
        let count = left.len();
        left.copy_from_slice(&internal[..count]);
    }

    /// What loads, internal forces and inertia leave, into `left`, and the norm of loads and motion
    /// squared.
    pub(super) fn balance(&mut self, factor: f64, x: &[f64]) -> f64 {
        self.displace(factor, x);
        self.fill_internal();
        let outside = self.outside(factor);
        let mut size = parallel::sum(outside.len(), |a| outside[a].norm_squared());
        self.left.iter_mut().zip(&outside).for_each(|(left, outside)| *left += outside);
        if let Some(inertia) = &self.inertia {
            size += inertia.size;
            for (a, left) in self.left.iter_mut().enumerate() {
                *left += inertia.force(self.discrete.solid.mass[a], a, &self.displacement[a]);
            }
        }
        size
    }

    /// All loads at a load factor in N, on the displaced body, and what holds its faces.
    fn outside(&mut self, factor: f64) -> Vec<Vector<D>> {
        let mut outside = self.all_loads(factor);
        self.faces.add_forces(&self.displacement, factor, &mut outside);
        outside
    }

    fn all_loads(&mut self, factor: f64) -> Vec<Vector<D>> {
        let mut loads = self.dead_loads(factor).to_vec();
        let pressing = self.loads.pressing(self.discrete.len(), factor, false);
        press(&self.discrete.operator, &self.displacement, &pressing, &mut loads);
        loads
    }

    /// What holds each particle in N in equilibrium at a load factor: against all that is left in held
    /// components, and where held faces act. Multipliers of faces are not asked, so that it is the same
    /// however the state was come by.
    pub(super) fn holding(&mut self, factor: f64, x: &[f64]) -> Vec<Vector<D>> {
        self.displace(factor, x);
        let loads = self.all_loads(factor);
        self.fill_internal();
        self.left.iter_mut().zip(&loads).for_each(|(left, load)| *left += load);
        let reduction = self.solver.reduction();
        let at_faces = self.faces.particles(self.left.len());
        let holds = |(a, left): (usize, &Vector<D>)| match at_faces[a] {
            true => -left,
            false => -reduction.held_part(a, left),
        };
        self.left.iter().enumerate().map(holds).collect()
    }

    fn dead_loads(&mut self, factor: f64) -> &[Vector<D>] {
        let (loads, discrete) = (&self.loads, &*self.discrete);
        let fresh = || (factor, loads.dead(&discrete.solid, factor, false));
        if self.dead.as_ref().is_none_or(|(known, _)| *known != factor) {
            self.dead = Some(fresh());
        }
        &self.dead.get_or_insert_with(fresh).1
    }

    /// Minus what the stiffness makes of moving held components, plus `forces`, on the unknowns.
    fn restricted(&mut self, held: &[Vector<D>], mut forces: Vec<Vector<D>>, into: &mut [f64]) {
        let reduction = self.solver.reduction();
        let mut moved = vec![Vector::zeros(); forces.len()];
        reduction.expand(&vec![0.0; into.len()], held, &mut moved);
        if moved.iter().any(|moved| moved.amax() > 0.0) {
            let mut product = vec![Vector::zeros(); forces.len()];
            self.stiffness.apply(&moved, &mut product);
            forces.iter_mut().zip(&product).for_each(|(force, product)| *force -= product);
        }
        self.solver.reduction().restrict(&forces, into);
    }
}

impl<const D: usize> Equations for Statics<D> {
    fn unknowns(&self) -> usize {
        self.solver.reduction().unknowns()
    }

    #[inline(never)]
    fn trial(&mut self, factor: f64, x: &[f64]) -> Trial {
        self.displace(factor, x);
        self.dead_loads(factor);
        let (discrete, displacement) = (&*self.discrete, &self.displacement);
        let dead = self.dead.as_ref().map_or([].as_slice(), |(_, dead)| dead);
        let is_broken = |a: usize, energy: f64| {
            let is_linear = discrete.solid.mixture(a).is_linear();
            let turned = || {
                let f = discrete.displacement_gradient(displacement, a) + Tensor::identity();
                !(tensor::determinant(&f) > 0.0)
            };
            !energy.is_finite() || !is_linear && turned()
        };
        let energy = |a: usize| {
            let own = discrete.energy_of(displacement, a).iter().sum::<f64>();
            let moving = self.inertia.as_ref();
            own + moving.map_or(0.0, |it| it.potential(discrete.solid.mass[a], a, &displacement[a]))
        };
        let rows = self.team.share_of(discrete.len());
        let [potential, broken] = self.team.sums::<[f64; 2]>(rows.len(), |k, sums| {
            let a = rows.start + k;
            let own = energy(a);
            sums[0] += own - dead[a].dot(&displacement[a]);
            sums[1] += f64::from(u8::from(is_broken(a, own)));
        });
        let first = || self.team.least(rows.clone().find(|&a| is_broken(a, energy(a))));
        let potential = potential + self.faces.potential(displacement, factor);
        Trial {
            potential: self.loads.pressed.is_empty().then_some(potential),
            broken: if broken > 0.0 { first() } else { None },
        }
    }

    #[inline(never)]
    fn residual(&mut self, factor: f64, x: &[f64], residual: &mut [f64]) -> f64 {
        let loads = self.balance(factor, x);
        let reduction = self.solver.reduction();
        reduction.restrict(&self.left, residual);
        let left = &self.left;
        let held = parallel::sum(left.len(), |a| reduction.held_part(a, &left[a]).norm_squared());
        let open = parallel::sum(residual.len(), |k| residual[k] * residual[k]);
        if open == 0.0 { 0.0 } else { (open / (loads + held)).sqrt() }
    }

    #[inline(never)]
    fn settle(&mut self, factor: f64, x: &[f64]) -> bool {
        self.displace(factor, x);
        self.faces.settle(&self.displacement, factor)
    }

    #[inline(never)]
    fn linearise(&mut self, factor: f64, x: &[f64], definite: bool) -> Result<(), LinearError> {
        self.displace(factor, x);
        let pressing = self.loads.pressing(self.discrete.len(), factor, false);
        if !(self.is_linear && pressing.is_empty()) {
            self.stiffness.load(&self.displacement, &pressing);
            return self.solver.load(&self.stiffness, definite && pressing.is_empty());
        }
        let wanted = (self.stiffness.inertia(), definite);
        let is_known = self.loaded.is_some_and(|(inertia, was_definite)| {
            inertia == wanted.0 && (was_definite == definite || !self.solver.is_shifted())
        });
        if !is_known {
            self.loaded = None;
            self.solver.load(&self.stiffness, definite)?;
            self.loaded = Some(wanted);
        }
        Ok(())
    }

    fn solve(
        &mut self,
        right: &[f64],
        tolerance: f64,
        solution: &mut [f64],
    ) -> Result<LinearReport, LinearError> {
        self.solver.solve(&mut self.stiffness, right, tolerance, solution)
    }
}

impl<const D: usize> LoadedEquations for Statics<D> {
    fn load_rate(&mut self, factor: f64, rate: &mut [f64]) {
        let mut forces = self.loads.dead(&self.discrete.solid, factor, true);
        let pressing = self.loads.pressing(self.discrete.len(), factor, true);
        press(&self.discrete.operator, &self.displacement, &pressing, &mut forces);
        self.faces.add_rates(factor, &mut forces);
        let held = self.supports.values(factor, true);
        self.restricted(&held, forces, rate);
    }

    fn step_residual(&mut self, from: f64, to: f64, residual: &mut [f64]) {
        self.fill_internal();
        let mut forces = self.outside(to);
        forces.iter_mut().zip(&self.left).for_each(|(force, left)| *force += left);
        let (before, after) = (self.supports.values(from, false), self.supports.values(to, false));
        let moved: Vec<Vector<D>> = after.iter().zip(&before).map(|(a, b)| a - b).collect();
        self.restricted(&moved, forces, residual);
    }

    fn stability(&mut self) -> Stability {
        self.solver.stability(&mut self.stiffness)
    }
}
