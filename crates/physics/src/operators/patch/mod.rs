//! Gradients under which a constant stress is in equilibrium on any cloud.

mod linear;
mod splines;
mod unrolled;

use super::directed::DirectedSupport;
use super::dual_gradient::DualGradient;
use super::error::OperatorError;
use crate::geometry::Particles;
use crate::{Tensor, Vector, parallel};
use linear::LinearFunctions;
use splines::Splines;
use unrolled::Unrolled;

/// Steps of conjugate gradients after which the correction is given up; tens are usual.
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
    /// singular but consistent system, by conjugate gradients with a preconditioner on particles and on
    /// splines. The paper has no such correction.
    ///
    /// # Errors
    /// [`OperatorError::Areas`] where the areas do not close the volumes of a body: they must sum
    /// to zero, and `sum_b N_b (x) X_b` to the volume times the identity, but for axes along which it goes on for ever.
    /// [`OperatorError::NoConvergence`] where the system has no solution that is found.
    pub fn patch_consistent(
        mut self,
        particles: &Particles<D>,
        support: &DirectedSupport<D>,
        areas: &[Vector<D>],
    ) -> Result<Self, OperatorError> {
        let unrolled = Unrolled::new(support, &particles.position);
        check_areas(particles, &unrolled, areas)?;
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
        let system = System::new(&self, particles, support, unrolled);
        let multipliers = system.solve(wanted, TOLERANCE * scale)?;
        let mut changed = self.coefficients.clone();
        system.change(&multipliers, &mut changed);
        self.coefficients = changed;
        self.is_plain = false;
        Ok(self)
    }
}

/// Whether areas and volumes of each of the parts that hang together belong to one surface.
fn check_areas<const D: usize>(
    particles: &Particles<D>,
    unrolled: &Unrolled<D>,
    areas: &[Vector<D>],
) -> Result<(), OperatorError> {
    for (part, endless) in unrolled.endless.iter().enumerate() {
        let own = || (0..particles.len()).filter(|&a| unrolled.part_of[a] as usize == part);
        let body = own().next().map_or(0, |a| particles.body[a]);
        let volume: f64 = own().map(|a| particles.volume[a]).sum();
        let size: f64 = own().map(|a| areas[a].norm()).sum();
        let sum: Vector<D> = own().map(|a| areas[a]).sum();
        let moment: Tensor<D> = own().map(|a| areas[a] * unrolled.places[a].transpose()).sum();
        let mut misfit = moment / volume - Tensor::identity();
        (0..D).filter(|&axis| endless[axis]).for_each(|axis| misfit.column_mut(axis).fill(0.0));
        let misfit = misfit.amax();
        if !(sum.amax() <= MISFIT * size && misfit <= MISFIT) {
            return Err(OperatorError::Areas { body, sum: sum.iter().copied().collect(), misfit });
        }
    }
    Ok(())
}

/// The equations of the multipliers, of which each direction has the same matrix. A multiplier is a
/// vector with a number for each direction.
struct System<'a, const D: usize> {
    gradient: &'a DualGradient<D>,
    particles: &'a Particles<D>,
    support: &'a DirectedSupport<D>,
    unrolled: Unrolled<D>,
    /// `V_a o_ab` of each entry of the list in m^D.
    weights: Vec<f64>,
    /// The same in the order of the dual list.
    dual_weights: Vec<f64>,
    /// `sum_b V_a o_ab X_ab` of each particle.
    arms: Vec<Vector<D>>,
    /// Diagonal of the equations but for what the slope takes away.
    diagonal: Vec<f64>,
}

/// Scratch of [`System::apply`].
struct Scratch<const D: usize> {
    slopes: Vec<Tensor<D>>,
    /// What changes of the coefficients of a particle take from its own area.
    taken: Vec<Vector<D>>,
}

impl<'a, const D: usize> System<'a, D> {
    fn new(
        gradient: &'a DualGradient<D>,
        particles: &'a Particles<D>,
        support: &'a DirectedSupport<D>,
        unrolled: Unrolled<D>,
    ) -> Self {
        let (list, volume) = (&support.list, &particles.volume);
        let mut weights = Vec::with_capacity(list.pairs());
        for (a, volume) in volume.iter().enumerate() {
            let row = gradient.weights(list.range(a));
            let share = volume / row.iter().sum::<f64>();
            weights.extend(row.iter().map(|weight| share * weight));
        }
        let dual_weights: Vec<f64> =
            support.dual_entries.iter().map(|&entry| weights[entry as usize]).collect();
        let mut arms = vec![Vector::zeros(); particles.len()];
        let mut diagonal = volume.clone();
        parallel::for_each_pair_of_chunks(&mut arms, &mut diagonal, |first, arms, diagonal| {
            for (offset, (arm, diagonal)) in arms.iter_mut().zip(diagonal).enumerate() {
                let a = first + offset;
                for (&b, entry) in list.row(a).iter().zip(list.range(a)) {
                    *arm += support.separation(&particles.position, a, b) * weights[entry];
                }
                *diagonal += dual_weights[support.dual.range(a)].iter().sum::<f64>();
            }
        });
        Self { gradient, particles, support, unrolled, weights, dual_weights, arms, diagonal }
    }

    /// `sum_b V_a o_ab |X_ab|^4/(4 D (D + 2))` of each particle.
    fn fourth_moments(&self) -> Vec<f64> {
        let list = &self.support.list;
        let mut moments = vec![0.0; self.particles.len()];
        parallel::for_each_chunk(&mut moments, |first, moments| {
            for (offset, moment) in moments.iter_mut().enumerate() {
                let a = first + offset;
                for (&b, entry) in list.row(a).iter().zip(list.range(a)) {
                    let separation = self.support.separation(&self.particles.position, a, b);
                    *moment += self.weights[entry] * separation.norm_squared().powi(2);
                }
                *moment /= (4 * D * (D + 2)) as f64;
            }
        });
        moments
    }

    /// Adds the changes that multipliers make to all coefficients.
    fn change(&self, multipliers: &[Vector<D>], coefficients: &mut [[f64; D]]) {
        let (list, volume) = (&self.support.list, &self.particles.volume);
        let slopes = self.slopes(multipliers);
        for (a, slope) in slopes.iter().enumerate() {
            for (&b, entry) in list.row(a).iter().zip(list.range(a)) {
                let separation = self.support.separation(&self.particles.position, a, b);
                let rise = multipliers[b as usize] - multipliers[a] - slope * separation;
                let change = rise * (self.weights[entry] / volume[a]);
                coefficients[entry].iter_mut().zip(&change).for_each(|(g, change)| *g += change);
            }
        }
    }

    fn slopes(&self, multipliers: &[Vector<D>]) -> Vec<Tensor<D>> {
        let mut scratch = self.scratch();
        self.strain(multipliers, &mut scratch);
        scratch.slopes
    }

    fn scratch(&self) -> Scratch<D> {
        let count = self.particles.len();
        Scratch { slopes: vec![Tensor::zeros(); count], taken: vec![Vector::zeros(); count] }
    }

    /// The slopes of multipliers, row by row those of a direction, and
    /// `sum_b V_a o_ab (m_b - m_a - (grad m)_a X_ab)`.
    fn strain(&self, multipliers: &[Vector<D>], scratch: &mut Scratch<D>) {
        let list = &self.support.list;
        let Scratch { slopes, taken } = scratch;
        parallel::for_each_pair_of_chunks(slopes, taken, |first, slopes, taken| {
            for (offset, (slope, taken)) in slopes.iter_mut().zip(taken).enumerate() {
                let a = first + offset;
                let (mut sum, mut rises) = (Tensor::<D>::zeros(), Vector::<D>::zeros());
                let (range, own) = (list.range(a), multipliers[a]);
                let weights = self.weights[range.clone()].iter();
                let coefficients = self.gradient.coefficients(range).iter().zip(weights);
                for (&b, (coefficient, weight)) in list.row(a).iter().zip(coefficients) {
                    let rise = multipliers[b as usize] - own;
                    rises += rise * *weight;
                    for (j, coefficient) in coefficient.iter().enumerate() {
                        for i in 0..D {
                            sum[(i, j)] += rise[i] * coefficient;
                        }
                    }
                }
                *slope = sum;
                *taken = rises - sum * self.arms[a];
            }
        });
    }

    /// The change of the areas by multipliers: symmetric, and zero for linear ones.
    fn apply(&self, multipliers: &[Vector<D>], scratch: &mut Scratch<D>, result: &mut [Vector<D>]) {
        self.strain(multipliers, scratch);
        let Scratch { slopes, taken } = &*scratch;
        let (dual, positions) = (&self.support.dual, &self.particles.position);
        parallel::for_each_chunk(result, |first, result| {
            for (offset, result) in result.iter_mut().enumerate() {
                let a = first + offset;
                let (mut sum, own) = (-taken[a], multipliers[a]);
                let weights = &self.dual_weights[dual.range(a)];
                for (&b, weight) in dual.row(a).iter().zip(weights) {
                    let separation = self.support.separation(positions, b as usize, a as u32);
                    let b = b as usize;
                    sum += (own - multipliers[b] - slopes[b] * separation) * *weight;
                }
                *result = sum;
            }
        });
    }

    /// Multipliers whose change of the areas is `right` but for `tolerance`: conjugate gradients for each direction,
    /// side by side. A direction that is done is left as it is.
    fn solve(
        &self,
        right: Vec<Vector<D>>,
        tolerance: f64,
    ) -> Result<Vec<Vector<D>>, OperatorError> {
        let count = right.len();
        let (mut splines, linear) = (Splines::new(self), LinearFunctions::new(self));
        let mut precondition = |residual: &[Vector<D>], scaled: &mut [Vector<D>]| {
            parallel::for_each_chunk(scaled, |first, scaled| {
                for (k, scaled) in scaled.iter_mut().enumerate() {
                    *scaled = residual[first + k] / self.diagonal[first + k];
                }
            });
            splines.add(residual, scaled);
        };
        let (mut solution, mut residual) = (vec![Vector::zeros(); count], right);
        let mut scaled = vec![Vector::zeros(); count];
        linear.remove(&self.unrolled.places, &mut residual);
        precondition(&residual, &mut scaled);
        let mut direction = scaled.clone();
        let mut product = vec![Vector::zeros(); count];
        let mut scratch = self.scratch();
        let mut energy = dots(&residual, &scaled);
        let mut steps = 0;
        loop {
            let left = Vector::<D>::from_fn(|i, _| {
                parallel::maximum(count, 0.0, |k| residual[k][i].abs())
            });
            if left.amax() <= tolerance {
                return Ok(solution);
            }
            let is_left = left.map(|left| left > tolerance);
            self.apply(&direction, &mut scratch, &mut product);
            let of_direction = dots(&direction, &product);
            // Without a positive energy along a direction there is no least change, and no step leads further.
            let is_broken = (0..D).any(|i| is_left[i] && !(of_direction[i] > 0.0));
            if is_broken || steps == MOST_STEPS {
                return Err(OperatorError::NoConvergence { steps, left: left.amax(), tolerance });
            }
            steps += 1;
            let length = Vector::<D>::from_fn(|i, _| match is_left[i] {
                true => energy[i] / of_direction[i],
                false => 0.0,
            });
            let pair = (&mut solution[..], &mut residual[..]);
            parallel::for_each_part(count, pair, |first, (solution, residual)| {
                for (k, (solution, residual)) in solution.iter_mut().zip(residual).enumerate() {
                    *solution += direction[first + k].component_mul(&length);
                    *residual -= product[first + k].component_mul(&length);
                }
            });
            linear.remove(&self.unrolled.places, &mut residual);
            precondition(&residual, &mut scaled);
            let next = dots(&residual, &scaled);
            let turn = Vector::<D>::from_fn(|i, _| match is_left[i] {
                true => next[i] / energy[i],
                false => 0.0,
            });
            energy = next;
            parallel::for_each_chunk(&mut direction, |first, direction| {
                for (k, direction) in direction.iter_mut().enumerate() {
                    *direction = scaled[first + k] + direction.component_mul(&turn);
                }
            });
        }
    }
}

/// The products of two arrays, direction by direction.
fn dots<const D: usize>(one: &[Vector<D>], other: &[Vector<D>]) -> Vector<D> {
    let add = |k: usize, sums: &mut [f64; D]| {
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum += one[k][i] * other[k][i];
        }
    };
    parallel::sums(one.len(), add).into()
}
