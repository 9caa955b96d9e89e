//! Boundary faces of cells that are held where no particle lies.

use std::sync::Arc;

use super::StaticsError;
use crate::Vector;
use crate::boundaries::{PrescribedFaces, SpaceTime, padded};
use crate::operators::Trace;
use crate::schemes::input::check_index;

/// Stiffness of a held face, times shear modulus and area over the size of its cell, all in one
/// number: high enough that multipliers settle in a few iterations.
const STIFFNESS: f64 = 1e3;

/// What holds a face along a direction: a stiffness that goes into the tangent.
pub(super) struct Spring<const D: usize> {
    /// The particle of its cell.
    pub owner: u32,
    /// Its center in m.
    pub place: Vector<D>,
    /// Unit vector n.
    pub direction: Vector<D>,
    /// Particles with their coefficients in the value on the face, theory (52): the owner, and then
    /// its support in order.
    pub row: Vec<(u32, f64)>,
    /// k in N/m.
    pub stiffness: f64,
}

/// A face with a component that is held: `n . u_f = value` by an augmented potential
/// `mu gap + k gap^2/2`, in which the multiplier mu ends as the force.
#[derive(Clone)]
struct Held {
    /// mu in N.
    multiplier: f64,
    value: Arc<dyn SpaceTime>,
    condition: usize,
}

/// All held faces.
#[derive(Clone)]
pub(super) struct Faces<const D: usize> {
    names: Vec<String>,
    springs: Arc<Vec<Spring<D>>>,
    held: Vec<Held>,
}

impl<const D: usize> Faces<D> {
    /// Binds conditions to the faces of a trace; `shear` is the shear modulus of a particle in Pa.
    pub fn new(
        trace: Option<&Trace<D>>,
        conditions: Vec<PrescribedFaces<D>>,
        shear: impl Fn(usize) -> f64,
    ) -> Result<Self, StaticsError> {
        let (mut names, mut springs, mut held) = (Vec::new(), Vec::new(), Vec::new());
        for (condition, PrescribedFaces { name, faces, direction, value }) in
            conditions.into_iter().enumerate()
        {
            let length = direction.norm();
            if !(length > 0.0 && length.is_finite()) {
                return Err(StaticsError::Direction { name });
            }
            for index in faces {
                let known = trace.map_or(0, |trace| trace.faces().len());
                check_index(|| format!("`{name}`: face"), index as usize, known)?;
                let Some(trace) = trace else { continue };
                let face = trace.faces()[index as usize];
                // Area over size of the cell is as the size to the power of D - 2.
                let area = face.area.norm();
                let size = if D == 1 { 1.0 } else { area.powf(1.0 / (D as f64 - 1.0)) };
                springs.push(Spring {
                    owner: face.owner,
                    place: face.place,
                    direction: direction / length,
                    row: trace.row(index as usize),
                    stiffness: STIFFNESS * shear(face.owner as usize) * area / size,
                });
                held.push(Held { multiplier: 0.0, value: value.clone(), condition });
            }
            names.push(name);
        }
        Ok(Self { names, springs: Arc::new(springs), held })
    }

    /// What goes into the tangent.
    pub fn springs(&self) -> &Arc<Vec<Spring<D>>> {
        &self.springs
    }

    /// Which of `count` particles the held faces act on.
    pub fn particles(&self, count: usize) -> Vec<bool> {
        let mut found = vec![false; count];
        for (a, _) in self.springs.iter().flat_map(|spring| &spring.row) {
            found[*a as usize] = true;
        }
        found
    }

    /// Forgets all multipliers.
    pub fn reset(&mut self) {
        self.held.iter_mut().for_each(|face| face.multiplier = 0.0);
    }

    /// Adds the forces of the faces on particles.
    pub fn add_forces(&self, u: &[Vector<D>], factor: f64, forces: &mut [Vector<D>]) {
        for (spring, held) in self.springs.iter().zip(&self.held) {
            spring.spread(-held.force(spring, u, factor), forces);
        }
    }

    /// Adds what the rates of the values do to the forces.
    pub fn add_rates(&self, factor: f64, forces: &mut [Vector<D>]) {
        for (spring, held) in self.springs.iter().zip(&self.held) {
            let rate = held.value.rate(padded(&spring.place), factor);
            spring.spread(spring.stiffness * rate, forces);
        }
    }

    /// The augmented potential in J.
    pub fn potential(&self, u: &[Vector<D>], factor: f64) -> f64 {
        let of = |(spring, held): (&Spring<D>, &Held)| {
            let gap = held.gap(spring, u, factor);
            (held.multiplier + 0.5 * spring.stiffness * gap) * gap
        };
        self.springs.iter().zip(&self.held).map(of).sum()
    }

    /// Moves multipliers to the forces of a state; whether there are any.
    pub fn settle(&mut self, u: &[Vector<D>], factor: f64) -> bool {
        for (spring, held) in self.springs.iter().zip(&mut self.held) {
            held.multiplier = held.force(spring, u, factor);
        }
        !self.held.is_empty()
    }

    /// The force of each condition on the body in N.
    pub fn reactions(&self, u: &[Vector<D>], factor: f64) -> Vec<(String, Vector<D>)> {
        let mut forces = vec![Vector::zeros(); self.names.len()];
        for (spring, held) in self.springs.iter().zip(&self.held) {
            forces[held.condition] -= spring.direction * held.force(spring, u, factor);
        }
        self.names.iter().cloned().zip(forces).collect()
    }
}

impl Held {
    fn gap<const D: usize>(&self, spring: &Spring<D>, u: &[Vector<D>], factor: f64) -> f64 {
        spring.along(u) - self.value.value(padded(&spring.place), factor)
    }

    /// Force against the direction that holds it.
    fn force<const D: usize>(&self, spring: &Spring<D>, u: &[Vector<D>], factor: f64) -> f64 {
        self.multiplier + spring.stiffness * self.gap(spring, u, factor)
    }
}

impl<const D: usize> Spring<D> {
    /// The component of a field on the face.
    fn along(&self, field: &[Vector<D>]) -> f64 {
        let value: Vector<D> = self.row.iter().map(|&(k, r)| field[k as usize] * r).sum();
        self.direction.dot(&value)
    }

    /// Adds a force along the direction.
    fn spread(&self, force: f64, forces: &mut [Vector<D>]) {
        for &(k, r) in &self.row {
            forces[k as usize] += self.direction * (force * r);
        }
    }

    /// Adds the product of its stiffness with a direction of displacements.
    pub fn add_product(&self, direction: &[Vector<D>], product: &mut [Vector<D>]) {
        self.spread(self.stiffness * self.along(direction), product);
    }
}
