//! Forces on the mass of a body.

use std::sync::Arc;

use super::function::{SpaceTime, padded};
use crate::Vector;

/// A force on the mass of a body, as an acceleration in m/s^2.
#[derive(Clone)]
pub struct BodyForce<const D: usize> {
    /// The body it acts on; all if `None`.
    pub body: Option<u32>,
    /// Its components.
    pub acceleration: [Arc<dyn SpaceTime>; D],
}

impl<const D: usize> BodyForce<D> {
    /// The sum of those of `forces` that act on a body, in m/s^2, at place `x` in m and time `t`
    /// in s.
    pub fn sum(forces: &[Self], body: u32, x: &Vector<D>, t: f64) -> Vector<D> {
        let place = padded(x);
        let mut sum = Vector::zeros();
        for force in forces.iter().filter(|force| force.body.is_none_or(|b| b == body)) {
            for (component, value) in force.acceleration.iter().enumerate() {
                sum[component] += value.value(place, t);
            }
        }
        sum
    }

    /// Whether it is the same at all places.
    pub fn is_uniform(&self) -> bool {
        self.acceleration.iter().all(|component| component.is_uniform())
    }

    /// Whether it is the same at all times.
    pub fn is_steady(&self) -> bool {
        self.acceleration.iter().all(|component| component.is_steady())
    }
}
