//! Local frames and held components of particles.

use std::sync::Arc;

use super::StaticsError;
use crate::boundaries::{PrescribedDisplacement, SpaceTime, Tie, padded};
use crate::geometry::Particles;
use crate::schemes::input::check_selected;
use crate::solve::Reduction;
use crate::{Tensor, Vector};

/// Two directions are the same if the sine of the angle between them is less.
const SAME: f64 = 1e-9;

/// What holds the particles of a body.
#[derive(Clone)]
pub(super) struct Supports<const D: usize> {
    conditions: Vec<PrescribedDisplacement<D>>,
    ties: Vec<Tie>,
    frames: Vec<Tensor<D>>,
    held: Vec<[bool; D]>,
    entries: Vec<Held>,
}

/// A held local component of a particle.
#[derive(Clone)]
pub(super) struct Held {
    pub particle: usize,
    /// Local component.
    pub component: usize,
    /// The condition whose reaction acts there.
    pub condition: usize,
    place: [f64; 3],
    /// Its value as a sum over conditions.
    terms: Vec<(f64, Arc<dyn SpaceTime>)>,
}

impl<const D: usize> Supports<D> {
    /// Makes the frames. Where two conditions prescribe the same direction of a particle the later
    /// one holds.
    pub fn new(
        particles: &Particles<D>,
        conditions: Vec<PrescribedDisplacement<D>>,
        ties: Vec<Tie>,
    ) -> Result<Self, StaticsError> {
        let count = particles.len();
        let mut all: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (index, condition) in conditions.iter().enumerate() {
            let length = condition.direction.norm();
            if !(length > 0.0 && length.is_finite()) {
                return Err(StaticsError::Direction { name: condition.name.clone() });
            }
            check_selected(&condition.name, &condition.particles, count)?;
            for &a in &condition.particles {
                all[a as usize].push(index);
            }
        }
        let mut supports = Self {
            frames: vec![Tensor::identity(); count],
            held: vec![[false; D]; count],
            entries: Vec::new(),
            conditions,
            ties: Vec::new(),
        };
        for (a, indices) in all.iter().enumerate().filter(|(_, indices)| !indices.is_empty()) {
            supports.hold(particles, a, indices)?;
        }
        supports.tie(particles, ties)?;
        Ok(supports)
    }

    /// Makes the frame of a particle from the directions of its conditions.
    fn hold(
        &mut self,
        particles: &Particles<D>,
        a: usize,
        indices: &[usize],
    ) -> Result<(), StaticsError> {
        let place = padded(&particles.position[a]);
        let mut axes: Vec<(Vector<D>, Held)> = Vec::new();
        let mut taken: Vec<Vector<D>> = Vec::new();
        for &index in indices.iter().rev() {
            let condition = &self.conditions[index];
            let direction = condition.direction.normalize();
            let same = |other: &Vector<D>| (direction - other * direction.dot(other)).norm() < SAME;
            if taken.iter().any(same) {
                continue;
            }
            // Gram and Schmidt, on directions and values alike.
            let mut rest = direction;
            let mut terms = vec![(1.0, condition.value.clone())];
            for (axis, held) in &axes {
                let along = direction.dot(axis);
                rest -= axis * along;
                let others = held.terms.iter();
                terms.extend(others.map(|(factor, value)| (-along * factor, value.clone())));
            }
            let length = rest.norm();
            if !(length > 1e-6) {
                let (id, position) = (particles.id[a], particles.position[a]);
                let position = position.iter().copied().collect();
                let name = condition.name.clone();
                return Err(StaticsError::Overconstrained { id, position, name });
            }
            terms.iter_mut().for_each(|(factor, _)| *factor /= length);
            taken.push(direction);
            let held = Held { particle: a, component: 0, condition: index, place, terms };
            axes.push((rest / length, held));
        }
        self.frames[a] = frame(&axes.iter().map(|(axis, _)| *axis).collect::<Vec<_>>());
        for (axis, mut held) in axes {
            let along = self.frames[a].tr_mul(&axis);
            held.component = along.iamax();
            let sign = along[held.component].signum();
            held.terms.iter_mut().for_each(|(factor, _)| *factor *= sign);
            self.held[a][held.component] = true;
            self.entries.push(held);
        }
        Ok(())
    }

    fn tie(&mut self, particles: &Particles<D>, ties: Vec<Tie>) -> Result<(), StaticsError> {
        let count = particles.len();
        let mut tied = vec![[false; D]; count];
        for tie in ties {
            if tie.component >= D {
                return Err(StaticsError::Direction { name: tie.name });
            }
            check_selected(&tie.name, &tie.particles, count)?;
            for &a in &tie.particles {
                let row = a as usize;
                let is_turned = self.frames[row] != Tensor::<D>::identity();
                if is_turned || self.held[row][tie.component] || tied[row][tie.component] {
                    let position = particles.position[row].iter().copied().collect();
                    let (id, component) = (particles.id[row], tie.component);
                    return Err(StaticsError::Tie { name: tie.name, id, position, component });
                }
                tied[row][tie.component] = true;
            }
            if !tie.particles.is_empty() {
                self.ties.push(tie);
            }
        }
        Ok(())
    }

    /// The unknowns of rows in an order.
    pub fn reduction(&self, order: &[u32]) -> Reduction<D> {
        let ties: Vec<(usize, Vec<u32>)> =
            self.ties.iter().map(|tie| (tie.component, tie.particles.clone())).collect();
        Reduction::new(self.frames.clone(), &self.held, &ties, order)
    }

    /// Local values of held components in m at a load factor, or their rates by it.
    pub fn values(&self, factor: f64, rate: bool) -> Vec<Vector<D>> {
        let mut values = vec![Vector::zeros(); self.frames.len()];
        for entry in &self.entries {
            let terms = entry.terms.iter().map(|(weight, value)| match rate {
                true => weight * value.rate(entry.place, factor),
                false => weight * value.value(entry.place, factor),
            });
            values[entry.particle][entry.component] = terms.sum();
        }
        values
    }

    /// Names of the conditions.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.conditions.iter().map(|condition| condition.name.as_str())
    }

    /// The held components.
    pub fn entries(&self) -> &[Held] {
        &self.entries
    }

    /// The frame of a particle.
    pub fn frame(&self, a: usize) -> &Tensor<D> {
        &self.frames[a]
    }

    /// The ties.
    pub fn ties(&self) -> &[Tie] {
        &self.ties
    }
}

/// An orthonormal frame with some given columns: the axes where these are axes.
fn frame<const D: usize>(given: &[Vector<D>]) -> Tensor<D> {
    let is_axis = |direction: &Vector<D>| direction.amax() > 1.0 - 1e-14;
    if given.iter().all(is_axis) {
        return Tensor::identity();
    }
    let mut columns = given.to_vec();
    while columns.len() < D {
        let rest = |axis: usize| {
            let unit = Vector::<D>::from_fn(|i, _| f64::from(u8::from(i == axis)));
            columns.iter().fold(unit, |rest, column| rest - column * column.dot(&unit))
        };
        let longest = (0..D).map(rest).fold(Vector::zeros(), |best: Vector<D>, next| {
            if next.norm() > best.norm() { next } else { best }
        });
        columns.push(longest.normalize());
    }
    Tensor::from_columns(&columns)
}
