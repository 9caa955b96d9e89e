//! Linear functions, which the equations of the correction do not see.

use super::System;
use super::unrolled::Unrolled;
use crate::{Tensor, Vector, parallel};

/// The constant and the linear functions on each part of the particles that hang together, along axes on which it
/// ends: multipliers without effect.
///
/// A residual has a share of them from rounding alone, which no step of conjugate gradients can reduce. It is
/// taken out at each, or they would follow it instead of what is left.
pub(super) struct LinearFunctions<const D: usize> {
    parts: Vec<Part<D>>,
    /// The part of each particle.
    part_of: Vec<u32>,
}

struct Part<const D: usize> {
    members: Vec<u32>,
    center: Vector<D>,
    /// What of a place makes D functions that are orthogonal to each other, and of norm 1.
    frame: Tensor<D>,
}

/// Products with the constant and with each linear function, direction by direction.
type Products<const D: usize> = [[f64; 4]; D];

impl<const D: usize> LinearFunctions<D> {
    pub fn new(system: &System<'_, D>) -> Self {
        let Unrolled { places, part_of, endless } = &system.unrolled;
        let mut members = vec![Vec::new(); endless.len()];
        part_of.iter().enumerate().for_each(|(a, &part)| members[part as usize].push(a as u32));
        let part = |(members, endless): (Vec<u32>, &[bool; D])| {
            let mean = members.iter().map(|&a| places[a as usize]).sum::<Vector<D>>();
            let center = mean / members.len() as f64;
            let mut gram = Tensor::<D>::zeros();
            for &a in &members {
                let arm = places[a as usize] - center;
                gram += arm * arm.transpose();
            }
            let endless = || (0..D).filter(|&axis| endless[axis]);
            for axis in endless() {
                gram.row_mut(axis).fill(0.0);
                gram.column_mut(axis).fill(0.0);
                gram[(axis, axis)] = 1.0;
            }
            let lower = gram.cholesky().map(|gram| gram.l());
            let mut frame =
                lower.and_then(|lower| lower.try_inverse()).unwrap_or_else(Tensor::zeros);
            endless().for_each(|axis| frame.row_mut(axis).fill(0.0));
            Part { members, center, frame }
        };
        let parts = members.into_iter().zip(endless).map(part).collect();
        Self { parts, part_of: part_of.clone() }
    }

    /// Takes them out of the values of particles.
    pub fn remove(&self, places: &[Vector<D>], values: &mut [Vector<D>]) {
        let of_part = |part: &Part<D>| -> Products<D> {
            parallel::sums(part.members.len(), |k, sums: &mut Products<D>| {
                let a = part.members[k] as usize;
                let along = part.frame * (places[a] - part.center);
                for (sums, value) in sums.iter_mut().zip(&values[a]) {
                    sums[0] += value;
                    (0..D).for_each(|axis| sums[1 + axis] += value * along[axis]);
                }
            })
        };
        let all: Vec<Products<D>> = self.parts.iter().map(of_part).collect();
        parallel::for_each_chunk(values, |first, values| {
            for (offset, value) in values.iter_mut().enumerate() {
                let a = first + offset;
                let number = self.part_of[a] as usize;
                let part = &self.parts[number];
                let along = part.frame * (places[a] - part.center);
                for (value, products) in value.iter_mut().zip(&all[number]) {
                    let linear: f64 = (0..D).map(|axis| products[1 + axis] * along[axis]).sum();
                    *value -= products[0] / part.members.len() as f64 + linear;
                }
            }
        });
    }
}
