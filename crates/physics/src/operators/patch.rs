//! Gradients under which a constant stress is in equilibrium on any cloud.

use super::directed::DirectedSupport;
use super::dual_gradient::{DualGradient, dual_row};
use super::error::OperatorError;
use crate::geometry::Particles;
use crate::{Vector, parallel};

/// Steps of conjugate gradients after which the correction is given up; 240 to 800 are usual.
const MOST_STEPS: usize = 20_000;

/// Largest deviation of an area that is left, over the largest area.
const TOLERANCE: f64 = 1e-12;

/// Largest relative misfit between areas and volumes that is taken for rounding.
const MISFIT: f64 = 1e-8;

impl<const D: usize> DualGradient<D> {
    /// The least change of the coefficients that makes `sum_a V_a G_ab = N_b`, theory (46), for
    /// boundary area vectors N in m^(D-1), and keeps linear fields exact: theory (45).
    ///
    /// The change minimises `sum dG_ab^2/o_ab` with `o_ab = s_ab/(V_a sum_b s_ab)`, direction by
    /// direction, and is `V_a o_ab (m_b - m_a - (grad m)_a X_ab)` with multipliers m that solve a
    /// singular but consistent system, by conjugate gradients. The paper has no such correction.
    ///
    /// # Errors
    /// [`OperatorError::Areas`] where the areas do not close the volumes of a body: they must sum
    /// to zero, and `sum_b N_b (x) X_b` to the volume times the identity.
    /// [`OperatorError::NoConvergence`] where the system has no solution that is found.
    pub fn patch_consistent(
        mut self,
        particles: &Particles<D>,
        support: &DirectedSupport<D>,
        areas: &[Vector<D>],
    ) -> Result<Self, OperatorError> {
        if support.domain.is_open() {
            check_areas(particles, &support.list.parts(), areas)?;
        }
        let system = System::new(&self, particles, support);
        let wanted: Vec<Vector<D>> = self
            .areas(support, &particles.volume)
            .iter()
            .zip(areas)
            .map(|(have, area)| area - have)
            .collect();
        let largest = |vectors: &[Vector<D>]| vectors.iter().map(Vector::amax).fold(0.0, f64::max);
        let scale = largest(areas).max(largest(&wanted));
        if scale == 0.0 {
            return Ok(self);
        }
        let mut changes = Vec::with_capacity(D);
        for direction in 0..D {
            let right: Vec<f64> = wanted.iter().map(|wanted| wanted[direction]).collect();
            let multipliers = system.solve(&right, TOLERANCE * scale)?;
            changes.push(system.changes(&multipliers));
        }
        for (direction, changes) in changes.iter().enumerate() {
            for (coefficient, change) in self.coefficients.iter_mut().zip(changes) {
                coefficient[direction] += change;
            }
        }
        self.is_plain = false;
        Ok(self)
    }
}

/// Whether areas and volumes of each of the `parts` that hang together belong to one surface.
fn check_areas<const D: usize>(
    particles: &Particles<D>,
    parts: &[u32],
    areas: &[Vector<D>],
) -> Result<(), OperatorError> {
    let count = parts.iter().max().map_or(0, |&part| part + 1);
    for part in 0..count {
        let own = || (0..particles.len()).filter(|&a| parts[a] == part);
        let body = own().next().map_or(0, |a| particles.body[a]);
        let volume: f64 = own().map(|a| particles.volume[a]).sum();
        let size: f64 = own().map(|a| areas[a].norm()).sum();
        let sum: Vector<D> = own().map(|a| areas[a]).sum();
        let moment: crate::Tensor<D> =
            own().map(|a| areas[a] * particles.position[a].transpose()).sum();
        let misfit = (moment / volume - crate::Tensor::identity()).amax();
        if !(sum.amax() <= MISFIT * size && misfit <= MISFIT) {
            return Err(OperatorError::Areas { body, sum: sum.iter().copied().collect(), misfit });
        }
    }
    Ok(())
}

/// The equations of the multipliers of one direction.
struct System<'a, const D: usize> {
    gradient: &'a DualGradient<D>,
    particles: &'a Particles<D>,
    support: &'a DirectedSupport<D>,
    /// `sum_b s_ab / tr L_a` of each particle.
    row_weight: Vec<f64>,
    /// Diagonal of the equations but for what the slope takes away.
    diagonal: Vec<f64>,
}

impl<'a, const D: usize> System<'a, D> {
    fn new(
        gradient: &'a DualGradient<D>,
        particles: &'a Particles<D>,
        support: &'a DirectedSupport<D>,
    ) -> Self {
        let rows = 0..particles.len();
        let row_weight: Vec<f64> =
            rows.clone().map(|a| gradient.weights(support.list.range(a)).iter().sum()).collect();
        let volume = &particles.volume;
        let diagonal = rows.map(|a| {
            let others = dual_row(support, a).map(|(&b, &entry)| {
                volume[b as usize] * gradient.weight(entry) / row_weight[b as usize]
            });
            volume[a] + others.sum::<f64>()
        });
        let diagonal = diagonal.collect();
        Self { gradient, particles, support, row_weight, diagonal }
    }

    /// Changes of all coefficients that multipliers make.
    fn changes(&self, multipliers: &[f64]) -> Vec<f64> {
        let slopes = self.slopes(multipliers);
        let mut changes = Vec::with_capacity(self.support.list.pairs());
        for a in 0..slopes.len() {
            let row = self.support.list.row(a).iter().zip(self.support.list.range(a));
            changes.extend(row.map(|(&b, entry)| self.change(multipliers, &slopes, (a, b), entry)));
        }
        changes
    }

    fn slopes(&self, multipliers: &[f64]) -> Vec<Vector<D>> {
        let mut slopes = vec![Vector::zeros(); multipliers.len()];
        let list = &self.support.list;
        parallel::for_each_chunk(&mut slopes, |first, slopes| {
            for (offset, slope) in slopes.iter_mut().enumerate() {
                let a = first + offset;
                for (&b, g) in list.row(a).iter().zip(self.gradient.coefficients(list.range(a))) {
                    *slope += Vector::from(*g) * (multipliers[b as usize] - multipliers[a]);
                }
            }
        });
        slopes
    }

    #[inline]
    fn change(
        &self,
        multipliers: &[f64],
        slopes: &[Vector<D>],
        (a, b): (usize, u32),
        entry: usize,
    ) -> f64 {
        let separation = self.support.separation(&self.particles.position, a, b);
        let rise = multipliers[b as usize] - multipliers[a] - slopes[a].dot(&separation);
        self.gradient.weights[entry] / self.row_weight[a] * rise
    }

    /// The change of the areas by multipliers: symmetric, and zero for linear ones.
    fn apply(&self, multipliers: &[f64], result: &mut [f64]) {
        let slopes = self.slopes(multipliers);
        let (list, volume) = (&self.support.list, &self.particles.volume);
        parallel::for_each_chunk(result, |first, result| {
            for (offset, result) in result.iter_mut().enumerate() {
                let a = first + offset;
                let mut sum = 0.0;
                for (&b, &entry) in dual_row(self.support, a) {
                    let pair = (b as usize, a as u32);
                    sum += volume[b as usize]
                        * self.change(multipliers, &slopes, pair, entry as usize);
                }
                for (&b, entry) in list.row(a).iter().zip(list.range(a)) {
                    sum -= volume[a] * self.change(multipliers, &slopes, (a, b), entry);
                }
                *result = sum;
            }
        });
    }

    /// Multipliers whose change of the areas is `right` but for `tolerance`.
    fn solve(&self, right: &[f64], tolerance: f64) -> Result<Vec<f64>, OperatorError> {
        let count = right.len();
        let dot = |a: &[f64], b: &[f64]| parallel::sum(count, |k| a[k] * b[k]);
        let precondition = |residual: &[f64]| -> Vec<f64> {
            residual.iter().zip(&self.diagonal).map(|(r, d)| r / d).collect()
        };
        let mut solution = vec![0.0; count];
        let mut residual = right.to_vec();
        let mut direction = precondition(&residual);
        let mut product = vec![0.0; count];
        let mut energy = dot(&residual, &direction);
        for _ in 0..MOST_STEPS {
            if residual.iter().all(|r| r.abs() <= tolerance) {
                return Ok(solution);
            }
            self.apply(&direction, &mut product);
            let length = energy / dot(&direction, &product);
            for k in 0..count {
                solution[k] += length * direction[k];
                residual[k] -= length * product[k];
            }
            let scaled = precondition(&residual);
            let next = dot(&residual, &scaled);
            let turn = next / energy;
            energy = next;
            direction.iter_mut().zip(&scaled).for_each(|(d, s)| *d = s + turn * *d);
        }
        let left = residual.iter().fold(0.0_f64, |largest, r| largest.max(r.abs()));
        Err(OperatorError::NoConvergence { steps: MOST_STEPS, left, tolerance })
    }
}
